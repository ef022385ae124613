"""How the nodes on the outline of a section's mesh move when a dimension of the pin changes.

Every node keeps its place on its own edge: the fraction of a straight edge's length, of an arc's
angle. Where a straight edge is cut at some distance from its end (the reach of an excluded zone, in
proportion to the radius there), the node on the cut stays on it, and others keep their fraction
between cuts. Edges move with the pin's own outline, so that all this is exact for any pin that has
the same edges; the rate is by differences of fourth order, to 1e-10.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from geometry.mesh.section_mesh import MeridianMesh
from geometry.shape.dimensions import Dimension
from geometry.shape.pin import GeometryError, Pin
from geometry.shape.profile import RZ, Arc, Edge, meridian
from pinbase.arrays import Floats, Ints

RELATIVE_STEPS = 1e-4, 1e-6  # of a dimension: the next one where the first gives another shape
MIN_CUT_POSITION, MAX_CUT_POSITION = 0.001, 0.999  # of an edge, as gmsh is given them


@dataclass(frozen=True)
class Reach:
    """A distance (m) from a vertex (r, z) of the outline at which edges are cut."""

    at: RZ
    distance: float


class OtherShapeError(Exception):
    """With the dimension a little larger or smaller the outline has other edges."""


DIFFERENCE_STEPS = -2.0, -1.0, 1.0, 2.0  # steps at which differences are taken


def rate(at: Callable[[float], Floats], step: float) -> Floats:
    """Derivative at 0 by central differences of fourth order."""
    return rate_of([at(x * step) for x in DIFFERENCE_STEPS], step)


def rate_of(values: Sequence[Floats], step: float) -> Floats:
    """The same of values at the places."""
    first, second, third, fourth = values
    return np.asarray((8.0 * (third - second) - (fourth - first)) / (12.0 * step))


@dataclass(frozen=True)
class NodeMotion:
    """Of the outline's nodes, (B, 2) m per m of a dimension, by its key. pins: with the dimension
    at DIFFERENCE_STEPS times `step` (m) more.
    """

    key: str
    velocity: Floats
    pins: tuple[Pin, ...]
    step: float


class OutlineNodes:
    """The nodes on a mesh's outline, the axis included. rows: (B,) their numbers."""

    def __init__(self, mesh: MeridianMesh, pin: Pin, reaches: Iterable[Reach] = ()) -> None:
        self._shape = _shape(meridian(pin))
        self._reach = {reach.at: reach.distance / reach.at[0] for reach in reaches}
        rows, places = [], []
        nodes = mesh.nodes
        axis = {None: mesh.axis}
        named = axis | {name: np.unique(found) for name, found in mesh.edges.items()}
        for k, edge in enumerate(meridian(pin)):
            here = _on(edge, nodes, named[edge.name])
            rows.append(here)
            places.append(_Place(k, self._cuts(edge), edge, nodes[here]))
        self.rows: Ints = np.concatenate(rows)
        self._places = places

    def at(self, pin: Pin, reach: Mapping[RZ, float] | None = None) -> Floats:
        """Where they are, (B, 2) in m, on a pin with the same edges. reach: the distances of cuts
        there over the radius, by the vertices of the mesh's own pin; as on that by default.

        Raises: OtherShapeError.
        """
        outline, reach = meridian(pin), self._reach if reach is None else reach
        if _shape(outline) != self._shape:
            raise OtherShapeError
        return np.concatenate(
            [p.at(outline[p.edge], _cuts_of(p, outline, reach)) for p in self._places]
        )

    def motion(self, dimension: Dimension) -> NodeMotion:
        """Of every node with a dimension.

        Raises: OtherShapeError where there is no such pin on both sides of it.
        """
        for part in RELATIVE_STEPS:
            step = part * dimension.value
            try:
                pins = tuple(
                    dimension.changed(dimension.value + x * step) for x in DIFFERENCE_STEPS
                )
                return self.among(dimension.key, pins, step)
            except (GeometryError, OtherShapeError):
                continue
        raise OtherShapeError

    def among(self, key: str, pins: tuple[Pin, ...], step: float) -> NodeMotion:
        """With pins at DIFFERENCE_STEPS times a step. Raises: OtherShapeError."""
        return NodeMotion(key, rate_of([self.at(pin) for pin in pins], step), pins, step)

    def _cuts(self, edge: Edge) -> list[tuple[int, float]]:
        """The end from which each cut is measured and its fraction of the edge, by fraction."""
        if isinstance(edge, Arc):
            return []
        length = math.dist(edge.start, edge.end)
        found = [
            (end, part if end == 0 else 1.0 - part)
            for end, at in enumerate((edge.start, edge.end))
            if (ratio := self._reach.get(at)) and (part := ratio * at[0] / length)
        ]
        found = sorted(
            (x for x in found if MIN_CUT_POSITION < x[1] < MAX_CUT_POSITION), key=lambda x: x[1]
        )
        return (
            found if len(found) < 2 or found[1][1] - found[0][1] > MIN_CUT_POSITION else found[:1]
        )


def _cuts_of(place: _Place, outline: tuple[Edge, ...], reach: Mapping[RZ, float]) -> list[float]:
    """The fractions at which the edge of a place is cut now."""
    edge = outline[place.edge]
    length = math.dist(edge.start, edge.end)
    out = []
    for (end, _), ratio in zip(place.cuts, place.ratios(reach), strict=True):
        part = ratio * (edge.end if end else edge.start)[0] / length
        out.append(1.0 - part if end else part)
    return out


class _Place:
    """Nodes on one edge of the outline, by its number."""

    def __init__(self, edge: int, cuts: list[tuple[int, float]], on: Edge, nodes: Floats) -> None:
        self.edge, self.cuts, self._ends = edge, cuts, (on.start, on.end)
        if isinstance(on, Arc):
            a, b = np.array(on.start) - on.centre, nodes - on.centre
            angle = np.arctan2(a[0] * b[:, 1] - a[1] * b[:, 0], b @ a)
            self._part = angle / on.turn
            return
        along = np.array(on.end) - np.array(on.start)
        part = (nodes - np.array(on.start)) @ along / (along @ along)
        knots = np.array([0.0, *(x for _, x in cuts), 1.0])
        self._between = np.clip(np.searchsorted(knots, part) - 1, 0, len(knots) - 2)
        low, high = knots[self._between], knots[self._between + 1]
        self._part = (part - low) / (high - low)

    def ratios(self, reach: Mapping[RZ, float]) -> list[float]:
        """Of the cuts' distances to the radius where they are measured from."""
        return [reach[self._ends[end]] for end, _ in self.cuts]

    def at(self, edge: Edge, cuts: list[float]) -> Floats:
        """Where the nodes are on the edge now, which is cut there, (.., 2)."""
        start = np.array(edge.start)
        if isinstance(edge, Arc):
            angle, (x, y) = self._part * edge.turn, start - edge.centre
            c, s = np.cos(angle), np.sin(angle)
            return np.asarray(np.stack([c * x - s * y, s * x + c * y], axis=1) + edge.centre)
        knots = np.array([0.0, *cuts, 1.0])
        low, high = knots[self._between], knots[self._between + 1]
        part = low + self._part * (high - low)
        return np.asarray(start + part[:, None] * (np.array(edge.end) - start))


def _shape(outline: tuple[Edge, ...]) -> list[tuple[str | None, bool]]:
    return [(edge.name, isinstance(edge, Arc)) for edge in outline]


def _on(edge: Edge, nodes: Floats, named: Ints) -> Ints:
    """Which of the nodes of its name are on an edge: all, unless others have that name too."""
    if edge.name:
        return named
    z = nodes[named, 1]
    low, high = sorted((edge.start[1], edge.end[1]))
    little = 1e-9 * (high - low)
    return np.asarray(named[(z >= low - little) & (z <= high + little)])

"""Motion of the nodes on the outline of a section's mesh when a dimension of the pin changes.

Every node keeps its place on its own edge: the fraction of a straight edge's length, or of an arc's
angle. A straight edge may be cut at some distance from its end (the reach of an excluded zone, in
proportion to the radius there). Then the node at the cut stays at the cut, and other nodes keep
their fraction between cuts. Edges move with the pin's own outline, so the motion is exact for any
pin with the same edges. Rates come from differences of fourth order, accurate to 1e-10.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from geometry.mesh.section_mesh import MeridianMesh
from geometry.shape.band import GeometryError
from geometry.shape.dimensions import Dimension
from geometry.shape.pin import Pin
from geometry.shape.profile import RZ, Arc, Edge, meridian
from pinbase.arrays import Floats, Ints

RELATIVE_STEPS = 1e-4, 1e-6  # of a dimension; the second if the first gives another shape
MIN_CUT_POSITION, MAX_CUT_POSITION = 0.001, 0.999  # of an edge, the same as in the mesh of gmsh


@dataclass(frozen=True)
class Reach:
    """A distance (m) from a vertex (r, z) of the outline at which edges are cut."""

    at: RZ
    distance: float


class OtherShapeError(Exception):
    """The outline has other edges where the dimension is a little larger or smaller."""


DIFFERENCE_STEPS = -2.0, -1.0, 1.0, 2.0  # steps at which differences are taken


def rate(at: Callable[[float], Floats], step: float) -> Floats:
    """Derivative at 0 by central differences of fourth order."""
    return rate_of([at(x * step) for x in DIFFERENCE_STEPS], step)


def rate_of(values: Sequence[Floats], step: float) -> Floats:
    """Derivative at 0 from the values at DIFFERENCE_STEPS times `step`."""
    first, second, third, fourth = values
    return np.asarray((8.0 * (third - second) - (fourth - first)) / (12.0 * step))


@dataclass(frozen=True)
class NodeMotion:
    """The motion of the outline's nodes with a dimension.

    key: key of the dimension.
    velocity: (B, 2) movement of the nodes per change of the dimension, m per m.
    pins: pins whose dimension is larger by DIFFERENCE_STEPS times `step` (m).
    """

    key: str
    velocity: Floats
    pins: tuple[Pin, ...]
    step: float


class OutlineNodes:
    """The B nodes on a mesh's outline, including the axis. rows: (B,) numbers of the nodes."""

    def __init__(self, mesh: MeridianMesh, pin: Pin, reaches: Iterable[Reach] = ()) -> None:
        self._shape = _shape(meridian(pin))
        self._reach = {reach.at: reach.distance / reach.at[0] for reach in reaches}
        rows, places = [], []
        nodes = mesh.nodes
        axis = {None: mesh.axis}
        named = axis | {name: np.unique(edge) for name, edge in mesh.edges.items()}
        for k, edge in enumerate(meridian(pin)):
            here = _on(edge, nodes, named[edge.name])
            rows.append(here)
            places.append(_Place(k, self._cuts(edge), edge, nodes[here]))
        self.rows: Ints = np.concatenate(rows)
        self._places = places

    def at(self, pin: Pin) -> Floats:
        """The places of the nodes, (B, 2) m, on a pin with the same edges.

        Raises: OtherShapeError for a pin with other edges.
        """
        outline = meridian(pin)
        if _shape(outline) != self._shape:
            raise OtherShapeError
        return np.concatenate([p.at(outline[p.edge]) for p in self._places])

    def motion(self, dimension: Dimension) -> NodeMotion:
        """The motion of every node with a dimension.

        Raises: OtherShapeError where a slightly larger or smaller dimension gives other edges.
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
        """The motion of every node, from pins whose dimension differs by steps.

        key, pins, step: as for `NodeMotion`.

        Raises: OtherShapeError for a pin with other edges.
        """
        return NodeMotion(key, rate_of([self.at(pin) for pin in pins], step), pins, step)

    def _cuts(self, edge: Edge) -> list[tuple[int, float]]:
        """The cuts of a straight edge, in their order along it.

        Each has the end (0 or 1) from which it is measured, and its distance from this end over the
        radius at this end.
        """
        if isinstance(edge, Arc):
            return []
        along = []
        for end, at in enumerate((edge.start, edge.end)):
            if ratio := self._reach.get(at):
                along.append((_cut_at(edge, end, ratio), end, ratio))
        along = sorted(cut for cut in along if MIN_CUT_POSITION < cut[0] < MAX_CUT_POSITION)
        if len(along) > 1 and along[1][0] - along[0][0] <= MIN_CUT_POSITION:
            along = along[:1]
        return [(end, ratio) for _, end, ratio in along]


def _cut_at(edge: Edge, end: int, ratio: float) -> float:
    """The fraction of a straight edge at which it is cut."""
    part = ratio * (edge.end if end else edge.start)[0] / math.dist(edge.start, edge.end)
    return 1.0 - part if end else part


class _Place:
    """Nodes on one edge of the outline. edge: number of the edge. on: the edge."""

    def __init__(self, edge: int, cuts: list[tuple[int, float]], on: Edge, nodes: Floats) -> None:
        self.edge, self._cuts = edge, cuts
        if isinstance(on, Arc):
            a, b = np.array(on.start) - on.centre, nodes - on.centre
            angle = np.arctan2(a[0] * b[:, 1] - a[1] * b[:, 0], b @ a)
            self._part = angle / on.turn
            return
        along = np.array(on.end) - np.array(on.start)
        part = (nodes - np.array(on.start)) @ along / (along @ along)
        knots = self._knots(on)
        self._between = np.clip(np.searchsorted(knots, part) - 1, 0, len(knots) - 2)
        low, high = knots[self._between], knots[self._between + 1]
        self._part = (part - low) / (high - low)

    def _knots(self, edge: Edge) -> Floats:
        """The fractions of the edge at its ends and cuts."""
        return np.array([0.0, *(_cut_at(edge, end, ratio) for end, ratio in self._cuts), 1.0])

    def at(self, edge: Edge) -> Floats:
        """The places of the nodes, (.., 2) m, on the same edge of another shape."""
        start = np.array(edge.start)
        if isinstance(edge, Arc):
            angle, (x, y) = self._part * edge.turn, start - edge.centre
            c, s = np.cos(angle), np.sin(angle)
            return np.asarray(np.stack([c * x - s * y, s * x + c * y], axis=1) + edge.centre)
        knots = self._knots(edge)
        low, high = knots[self._between], knots[self._between + 1]
        part = low + self._part * (high - low)
        return np.asarray(start + part[:, None] * (np.array(edge.end) - start))


def _shape(outline: tuple[Edge, ...]) -> list[tuple[str | None, bool]]:
    return [(edge.name, isinstance(edge, Arc)) for edge in outline]


def _on(edge: Edge, nodes: Floats, named: Ints) -> Ints:
    """The nodes on an edge, among the nodes with its name.

    All of these are on the edge, except on the axis, of which several edges may be parts.
    """
    if edge.name:
        return named
    z = nodes[named, 1]
    low, high = sorted((edge.start[1], edge.end[1]))
    little = 1e-9 * (high - low)
    return np.asarray(named[(z >= low - little) & (z <= high + little)])

"""Meshes of sections of almost the same shape: one of them is meshed, and its nodes are moved.

Every dimension is rounded to one of DIMENSION_STEPS values in each factor of two. That shape is
meshed as fine as asked for, by amounts that are rounded too, and kept. On the shape itself every
node of the outline keeps its place on its own edge (outline_motion), exactly, and those inside
move by a harmonic function. Where the rounded shape has other edges, or edges of quite another
length (what a fillet leaves of a shoulder is a small difference of large dimensions), or moved
elements are poor, the edges are rounded instead; where that does no better, the shape itself is
meshed. So the mesh depends on the shape alone, whatever was meshed before it.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import TYPE_CHECKING

import numpy as np

from geometry.mesh.gmsh_session import GMSH_LOCK
from geometry.mesh.moved.outline_motion import OutlineNodes, Reach
from geometry.mesh.section_mesh import (
    MIN_JACOBIAN_RATIO,
    MeridianMesh,
    SharedByMeshes,
    meridian_mesh,
)
from geometry.mesh.sizing import Grade, SectionSize, Spot
from geometry.shape.pin import GeometryError, Pin
from geometry.shape.polygon import Leg
from geometry.shape.profile import RZ, Arc, Edge, meridian
from geometry.shape.segment import Segment
from pinbase.arrays import Floats, Ints

if TYPE_CHECKING:
    import scipy.sparse as sp

DIMENSION_STEPS = 12  # rounded dimensions in a factor of two
SIZE_STEPS = 8  # rounded sizes of elements in a factor of two
PLACE_STEPS = 32  # rounded places on the smallest diameter
MAX_EDGE_STRETCH = (
    1.4  # times which an edge may be longer or shorter than that of the rounded shape
)
RATIO_DIGITS = 9  # of ratios that are the same for all shapes
MAX_KEPT_NODES = 20_000  # that are kept


def near_mesh(
    pin: Pin,
    size: SectionSize,
    spots: Iterable[Spot] = (),
    finer: Iterable[Grade] = (),
    quiet: Collection[int] = (),
) -> MeridianMesh:
    """As geometry.mesh.section_mesh.meridian_mesh, by moving the mesh of a rounded shape.

    Raises: MeshError when the section cannot be meshed within reason.
    """
    spots, finer, quiet = tuple(spots), tuple(finer), tuple(quiet)
    found = _moved(pin, size, spots, finer, quiet)
    return meridian_mesh(pin, size, spots, finer, quiet) if found is None else found


def _moved(
    pin: Pin,
    size: SectionSize,
    spots: tuple[Spot, ...],
    finer: tuple[Grade, ...],
    quiet: tuple[int, ...],
) -> MeridianMesh | None:
    reaches = [Reach((spot.r, spot.z), spot.reach) for spot in spots]
    for between in map(partial(_near_shape, pin), (False, True)):
        if between is None:
            continue
        try:
            there = tuple(between.spot(spot) for spot in spots)
        except KeyError:  # one that is at no vertex of the outline
            return None
        grades = tuple(between.grade(grade) for grade in finer)
        found = _KEPT_MESHES.mesh((between.other, size, there, grades, quiet)).on(
            pin, reaches, between
        )
        if found is not None:
            return found
    return None


@lru_cache(64)
def _near_shape(pin: Pin, edges: bool) -> _Between | None:
    """Of rounded dimensions or of rounded edges, where there is such a shape."""
    other = rounded_edges(pin) if edges else rounded(pin)
    return None if other is None else _Between.of(pin, other)


def rounded(pin: Pin) -> Pin | None:
    """The pin with rounded dimensions; None where there is no such pin."""
    return _made(pin, [_rounded(segment) for segment in pin.segments])


def rounded_edges(pin: Pin) -> Pin | None:
    """The pin of which what roundings leave of cylinders and shoulders is rounded, and what they
    take; None where there is no such pin.
    """
    sides = iter(pin.legs[1:])  # from the start face on, each segment's after its shoulder's

    def side(name: str) -> float:
        return _side(next(leg for leg in sides if leg.name == name))

    segments: list[Segment] = []
    for i, (s, plain) in enumerate(zip(pin.segments, map(_rounded, pin.segments), strict=True)):
        start = plain.diameter
        if segments:
            before, now = pin.segments[i - 1].diameters[1], s.diameter
            shoulder = side(f"shoulder {i}") if now != before else 0.0
            start = segments[-1].diameters[1] + math.copysign(2.0 * shoulder, now - before)
        along, more = side(pin.labels[i]), s.diameters[1] - s.diameter
        length = plain.length if s.cone else along
        end = start + math.copysign(step(abs(more)), more) if s.cone else None
        segments.append(replace(plain, length=length, diameter=start, end_diameter=end))
    return _made(pin, segments)


def _made(pin: Pin, segments: Iterable[Segment]) -> Pin | None:
    try:
        return replace(pin, segments=tuple(segments), fillet=step(pin.fillet))
    except GeometryError:
        return None


def _side(leg: Leg) -> float:
    """The length of a side whose parts are rounded, m."""
    straight = math.dist(leg.start, leg.end)
    return step(straight) + sum(map(step, leg.taken))


def _rounded(s: Segment) -> Segment:
    def some(x: float | None) -> float | None:
        return None if x is None else step(x)

    return replace(
        s,
        length=step(s.length),
        diameter=step(s.diameter),
        bore=step(s.bore),
        fillet=some(s.fillet),
        end_diameter=some(s.end_diameter),
        end_bore=some(s.end_bore),
        edge_radii=(step(s.edge_radii[0]), step(s.edge_radii[1])),
        bore_radii=(step(s.bore_radii[0]), step(s.bore_radii[1])),
    )


def step(x: float, steps: int = DIMENSION_STEPS) -> float:
    """The nearest of so many values in a factor of two."""
    return float(2.0 ** (round(math.log2(x) * steps) / steps)) if x > 0.0 else x


def _digits(x: float) -> float:
    """Without what round-off makes of a ratio."""
    return float(f"{x:.{RATIO_DIGITS}g}")


@dataclass(frozen=True)
class _Between:
    """A shape and the rounded one. vertices: of the outline, by those of the shape. r, z: what the
    lines through vertices have in both, rising.
    """

    other: Pin
    vertices: dict[RZ, RZ]
    r: tuple[Floats, Floats]
    z: tuple[Floats, Floats]

    @classmethod
    def of(cls, pin: Pin, other: Pin) -> _Between | None:
        """None where these have other edges, or edges of quite another length."""
        ours, theirs = meridian(pin), meridian(other)
        if len(ours) != len(theirs) or not all(map(_alike, ours, theirs)):
            return None
        vertices = {a.start: b.start for a, b in zip(ours, theirs, strict=True)}
        lines = []
        for k in range(2):
            pairs = {a[k]: b[k] for a, b in sorted(vertices.items(), key=lambda at: at[0][k])}
            one, to = np.array(list(pairs)), np.array(list(pairs.values()))
            if not (np.diff(to) > 0.0).all():
                return None
            lines.append((one, to))
        return cls(other, vertices, *lines)

    def spot(self, spot: Spot) -> Spot:
        """On the rounded shape. Raises: KeyError where it is at no vertex."""
        r, z = self.vertices[spot.r, spot.z]
        return Spot(r, z, _digits(spot.size / spot.r) * r, _digits(spot.reach / spot.r) * r)

    def grade(self, grade: Grade) -> Grade:
        """On the rounded shape, rounded."""
        part = self.other.smallest_diameter / PLACE_STEPS
        points = tuple(
            (part * round(float(np.interp(r, *self.r)) / part),
             part * round(float(np.interp(z, *self.z)) / part))
            for r, z in grade.points
        )  # fmt: skip
        near, flat = (step(x, SIZE_STEPS) for x in (grade.near, grade.flat))
        return Grade(points, near, flat, grade.growth)


def _alike(one: Edge, other: Edge) -> bool:
    if one.name != other.name or isinstance(one, Arc) != isinstance(other, Arc):
        return False
    ratio = math.dist(one.start, one.end) / math.dist(other.start, other.end)
    return 1.0 / MAX_EDGE_STRETCH < ratio < MAX_EDGE_STRETCH


class _RoundedMesh:
    """The mesh of a rounded shape, and how its inner nodes follow those on the outline."""

    def __init__(self, pin: Pin, mesh: MeridianMesh, spots: tuple[Spot, ...]) -> None:
        self.mesh, self._shared = mesh, SharedByMeshes(still=mesh)
        self._outline = OutlineNodes(mesh, pin, [Reach((s.r, s.z), s.reach) for s in spots])
        corners = mesh.elements[:, :3]
        self._count = int(corners.max()) + 1
        on = np.zeros(len(mesh.nodes), dtype=bool)
        on[self._outline.rows] = True
        self._inner = np.flatnonzero(~on[: self._count])
        self._middles, first = np.unique(mesh.elements[:, 3:], return_index=True)
        self._ends = corners[:, [[0, 1], [1, 2], [0, 2]]].reshape(-1, 2)[first]
        self._solve, self._coupled = _harmonic(mesh.nodes[: self._count], corners, self._inner)

    def on(self, pin: Pin, reaches: list[Reach], between: _Between) -> MeridianMesh | None:
        """The mesh of a shape; None where an element would be poor."""
        still = self.mesh.nodes
        now = [Reach(between.vertices[x.at], x.distance / x.at[0]) for x in reaches]
        rows, at = self._outline.rows, self._outline.at(pin, {x.at: x.distance for x in now})
        moved = np.zeros_like(still)
        moved[rows] = at - still[rows]
        moved[self._inner] = self._solve(-(self._coupled @ moved[: self._count]))
        middles = moved[self._ends].mean(axis=1)
        inside = np.ones(len(still), dtype=bool)
        inside[rows] = False
        free = inside[self._middles]
        moved[self._middles[free]] = middles[free]
        nodes = still + moved
        nodes[rows] = at
        nodes[self.mesh.axis, 0] = 0.0
        found = replace(self.mesh, nodes=nodes, shared=self._shared)
        return found if found.distortion().min() > MIN_JACOBIAN_RATIO else None


def _harmonic(
    nodes: Floats, corners: Ints, inner: Ints
) -> tuple[Callable[[Floats], Floats], sp.csr_matrix]:
    """Linear harmonic functions on triangles: a function that finds the values (I, k) at inner
    nodes of what the others bring (I, k), and the matrix (I, N) that says what these do.
    """
    import scipy.sparse as sp
    from scipy.sparse.linalg import splu

    x = nodes[corners]
    sides = x[:, [2, 0, 1]] - x[:, [1, 2, 0]]
    area = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    each = sides @ sides.swapaxes(1, 2) / (2.0 * area[:, None, None])
    row, column = np.repeat(corners, 3, axis=1).ravel(), np.tile(corners, 3).ravel()
    matrix = sp.csr_matrix((each.ravel(), (row, column)), (len(nodes), len(nodes)))[inner]
    if not len(inner):
        return lambda b: b, matrix
    return splu(matrix[:, inner].tocsc(), permc_spec="MMD_AT_PLUS_A").solve, matrix


_Key = tuple[Pin, SectionSize, tuple[Spot, ...], tuple[Grade, ...], tuple[int, ...]]


class _Kept:
    """Meshes of rounded shapes that were asked for last, MAX_KEPT_NODES of them at most."""

    def __init__(self) -> None:
        self._meshes = OrderedDict[_Key, _RoundedMesh]()
        self._nodes = 0

    def mesh(self, key: _Key) -> _RoundedMesh:
        with GMSH_LOCK:
            found = self._meshes.pop(key, None)
            if found is None:
                found = _RoundedMesh(key[0], meridian_mesh(*key), key[2])
                self._nodes += len(found.mesh.nodes)
            self._meshes[key] = found
            while len(self._meshes) > 1 and self._nodes > MAX_KEPT_NODES:
                self._nodes -= len(self._meshes.popitem(last=False)[1].mesh.nodes)
            return found


_KEPT_MESHES = _Kept()

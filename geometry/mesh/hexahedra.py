"""A body of revolution as quadratic hexahedra of 20 nodes, structured, all of it or a sector.

The disc of the smallest radius is a square surrounded by a fan; rings between the radii of the
segments follow. Each layer along the axis has the cells that its segment fills. At a fillet the
nodes about the sharp corner move out along the diagonal, until those on its sides are on the arc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from skfem import ElementHexS2

from geometry.shape.pin import Pin
from pinbase.arrays import Floats, Ints

SIDE_BULGE = 0.2  # by which the sides of the square are bent outwards, of its size
SQUARE_SIZE_RATIO = 0.55  # its size over the radius of the disc
# Of a fillet's radius, the least room behind its corner; without it that stays sharp.
MIN_FILLET_DEPTH = 0.6
FACE_CORNER_ORDER = (
    (0.0, 0.0),
    (1.0, 0.0),
    (1.0, 1.0),
    (0.0, 1.0),
)  # corners of a face, in their order
NODE_TOLERANCE = 1e-7  # of the length: nodes closer than this are one


@dataclass(frozen=True)
class HexSize:
    """around: cells in a quarter turn, even. along: length of a layer over the diameter, at most;
    half of that next to corners and ends of bands that are further apart.
    """

    around: int = 4
    along: float = 0.25


@dataclass(frozen=True)
class HexMesh:
    """nodes: (N, 3) m. elements: (M, 20) in the order of skfem's ElementHexS2, whose first axis is
    radial outside the square, the second runs around and the third along. outside: cells (by
    segment) whose far side along the first axis is on its outer surface. quarters: of a turn, from
    x towards y.
    """

    nodes: Floats
    elements: Ints
    outside: tuple[Ints, ...]
    quarters: int


@dataclass(frozen=True)
class _Patch:
    """Cells of a quarter disc, (P, 20, 2) positions of their nodes, between two radii (m)."""

    position: Floats
    inner: float
    outer: float


def hexahedra(pin: Pin, fineness: HexSize, quarters: int = 4) -> HexMesh:
    """Mesh a pin, or as many quarters of it."""
    patches = _patches(pin, fineness)
    layers = _layers(pin, fineness)
    segment = np.searchsorted(pin.stations[1:-1], layers.mean(axis=1), side="right")
    local = np.asarray(ElementHexS2().doflocs)
    cells, outside, count = [], [[np.zeros(0, dtype=np.int64)] for _ in pin.segments], 0
    for quarter in range(quarters):
        c, s = round(math.cos(quarter * math.pi / 2)), round(math.sin(quarter * math.pi / 2))
        turn = np.array([[c, s], [-s, c]], dtype=float)
        for (low, high), i in zip(layers, segment, strict=True):
            z = low + local[:, 2] * (high - low)
            for patch in patches:
                a, b = pin.segments[i].bore / 2.0, pin.segments[i].diameter / 2.0
                if not (patch.inner >= a - pin.tolerance and patch.outer <= b + pin.tolerance):
                    continue
                xy = patch.position @ turn
                along = np.broadcast_to(z[None, :, None], (*xy.shape[:2], 1))
                cells.append(np.concatenate([xy, along], axis=2))
                count += len(xy)
                if patch.outer > b - pin.tolerance:
                    radius = np.linalg.norm(patch.position[:, local[:, 0] == 1.0], axis=2)
                    rim = np.flatnonzero(radius.min(axis=1) > b * (1.0 - 1e-9))
                    outside[i].append(count - len(xy) + rim)
    points = _filleted(pin, np.concatenate(cells))
    nodes, elements = _merged(points, NODE_TOLERANCE * pin.smallest_diameter)
    return HexMesh(nodes, elements, tuple(np.concatenate(o) for o in outside), quarters)


def twenty() -> Ints:
    """Which of skfem's nodes are those of other programs (VTK, CalculiX), in their order: corners,
    middles of edges below, above and between.
    """
    ours = [tuple(x) for x in np.asarray(ElementHexS2().doflocs).tolist()]
    edges = zip(FACE_CORNER_ORDER, (*FACE_CORNER_ORDER[1:], FACE_CORNER_ORDER[0]), strict=True)
    middles = [((a + c) / 2, (b + d) / 2) for (a, b), (c, d) in edges]
    theirs = [(*xy, z) for z in (0.0, 1.0) for xy in FACE_CORNER_ORDER]
    theirs += [(*xy, z) for z in (0.0, 1.0) for xy in middles]
    theirs += [(*xy, 0.5) for xy in FACE_CORNER_ORDER]
    return np.array([ours.index(x) for x in theirs])


def _merged(points: Floats, tolerance: float) -> tuple[Floats, Ints]:
    flat = points.reshape(-1, 3)
    key = np.round(flat / tolerance).astype(np.int64)
    for axis in range(3):  # so that no two of one node round differently
        order = np.argsort(key[:, axis], kind="stable")
        jump = np.diff(key[order, axis], prepend=key[order[0], axis]) > 2
        key[order, axis] = np.cumsum(jump)
    _, first, number = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return flat[first], number.reshape(points.shape[:2]).astype(np.int64)


@dataclass(frozen=True)
class _Fillet:
    """About a corner at radius r and z, of a shaft that goes along `way` (1 or -1) from it. depth:
    behind the corner, to which nodes move, m.
    """

    r: float
    z: float
    way: int
    radius: float
    depth: float

    def moved(self, r: Floats, z: Floats) -> Floats:
        """By how much nodes move along both axes, m.

        With a and b the distances from the corner along shaft and face, b - a stays the same and
        tells the place on the arc, from one tangent point (-radius) to the other (radius). Behind
        the sides nodes move less, by how deep they are.
        """
        a, b = (z - self.z) * self.way, r - self.r
        place = np.clip((b - a) / self.radius, -1.0, 1.0)
        reach = 1.0 - np.abs(place) / 2.0 - np.sqrt(0.5 - place**2 / 4.0)
        deep = -np.minimum(a, b) / self.depth
        left = np.where(deep > -NODE_TOLERANCE, np.clip(1.0 - deep, 0.0, 1.0), 0.0)
        return np.asarray(self.radius * reach * left)


def _fillets(pin: Pin) -> list[_Fillet]:
    """Those with room for them."""
    found = []
    for i, (left, right) in enumerate(pairwise(pin.segments)):
        radius = pin.fillet_at(i)
        thin, thick, way = (left, right, -1) if left.diameter < right.diameter else (right, left, 1)
        wall = (thin.diameter - max(thin.bore, thick.bore)) / 2.0
        depth = min(radius, wall, thick.length)
        if radius and depth >= MIN_FILLET_DEPTH * radius:
            at = thin.diameter / 2.0, pin.stations[i + 1]
            found.append(_Fillet(*at, way, radius, depth))
    return found


def _filleted(pin: Pin, points: Floats) -> Floats:
    """Nodes (..., 3) of cells with sharp corners where those with fillets have them."""
    r, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
    outwards, along = np.zeros_like(r), np.zeros_like(z)
    for fillet in _fillets(pin):
        move = fillet.moved(r, z)
        outwards, along = outwards + move, along + fillet.way * move
    stretch = 1.0 + np.divide(outwards, r, out=np.zeros_like(r), where=r > 0.0)
    return np.stack([points[..., 0] * stretch, points[..., 1] * stretch, z + along], axis=-1)


def _layers(pin: Pin, fineness: HexSize) -> Floats:
    """Bottom and top (L, 2) of the layers, m."""
    ends = {*pin.stations, *(e for band in pin.bands for e in (band.z0, band.z1))}
    z: list[float] = []
    for low, high in pairwise(sorted(ends)):
        if high - low < pin.tolerance:
            continue
        i = int(np.searchsorted(pin.stations[1:-1], (low + high) / 2.0))
        longest = fineness.along * pin.segments[i].diameter
        count = math.ceil((high - low) / longest)
        steps = np.arange(count) if count == 1 else [0.0, 0.5, *range(1, count), count - 0.5]
        z += [low + (high - low) * x / count for x in steps]
    return np.array(list(pairwise([*z, pin.length])))


def _patches(pin: Pin, fineness: HexSize) -> list[_Patch]:
    ends = [fillet.r + fillet.radius for fillet in _fillets(pin)]
    every = sorted({*ends, *(x / 2.0 for s in pin.segments for x in (s.diameter, s.bore) if x)})
    radii = [r for below, r in pairwise([0.0, *every]) if r - below > pin.tolerance]
    n, first, patches = fineness.around // 2, radii[0], []
    if any(s.bore == 0.0 for s in pin.segments):
        fan = max(1, n // 2)
        patches += [
            _grid(n, n, lambda u, v: _square(first, u / n, v / n), 0.0, first),
            _grid(fan, 2 * n, lambda u, v: _fan(first, u / fan, v / n), 0.0, first),
        ]
    for a, b in pairwise(radii):
        thickness = math.pi / 2.0 * b / fineness.around
        count = max(1 if a in ends or b in ends else 2, math.ceil((b - a) / thickness))
        for low, high in pairwise(np.linspace(a, b, count + 1)):
            patches.append(_ring(low, high, 2 * n, a, b))
    return patches


def _ring(low: float, high: float, around: int, a: float, b: float) -> _Patch:
    def polar(u: Floats, v: Floats) -> Floats:
        radius, angle = low + u * (high - low), v * math.pi / 2.0 / around
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)

    return _grid(1, around, polar, a, b)


def _grid(rows: int, columns: int, position: object, inner: float, outer: float) -> _Patch:
    local = np.asarray(ElementHexS2().doflocs)
    i, j = np.divmod(np.arange(rows * columns), columns)
    u, v = i[:, None] + local[:, 0], j[:, None] + local[:, 1]
    assert callable(position)
    return _Patch(position(u, v), inner, outer)


def _square(radius: float, u: Floats, v: Floats) -> Floats:
    """Positions on the bulged square, 0 <= u, v <= 1."""
    size = SQUARE_SIZE_RATIO * radius
    return np.stack(
        [size * u * (1.0 - SIDE_BULGE * v**2), size * v * (1.0 - SIDE_BULGE * u**2)], axis=-1
    )


def _fan(radius: float, t: Floats, around: Floats) -> Floats:
    """Positions between the square (t = 0) and the circle (t = 1), 0 <= around <= 2."""
    start = _square(radius, np.minimum(1.0, 2.0 - around), np.minimum(1.0, around))
    angle = around * math.pi / 4.0
    end = radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return start + t[..., None] * (end - start)

"""A structured mesh of a body of revolution, or a sector of it, by 20-node hexahedra.

The disc of the smallest radius is a square surrounded by a fan. Rings between the radii of the
segments follow. Each layer along the axis has the cells that its segment fills. At a fillet, nodes
around the sharp corner move outwards along the diagonal, until the nodes on the corner's sides lie
on the arc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from skfem import ElementHexS2

from geometry.shape.pin import Pin
from pinbase.arrays import Floats, Ints

SIDE_BULGE = 0.2  # outward bulge of the square's sides, over the size of the square
SQUARE_SIZE_RATIO = 0.55  # size of the square over the radius of the disc
# Least depth of material behind a corner over the fillet's radius; with less, it stays sharp.
MIN_FILLET_DEPTH = 0.6
FACE_CORNER_ORDER = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
NODE_TOLERANCE = 1e-7  # of the smallest diameter: nodes closer than this are merged


@dataclass(frozen=True)
class HexSize:
    """The fineness of a mesh of hexahedra.

    around: number of cells in a quarter turn, even.
    along: largest length of a layer over the diameter; next to corners and ends of bands, layers
    have half of this length, unless a single layer fills the space.
    """

    around: int = 4
    along: float = 0.25


@dataclass(frozen=True)
class HexMesh:
    """A mesh of hexahedra.

    nodes: (N, 3) m.
    elements: (M, 20) node numbers in the order of skfem's ElementHexS2; its first axis is radial
    outside the square, the second runs around and the third along the pin.
    outside: for each segment, numbers of the cells whose far side along the first axis lies on its
    outer surface.
    quarters: number of quarter turns meshed, from x towards y.
    """

    nodes: Floats
    elements: Ints
    outside: tuple[Ints, ...]
    quarters: int


@dataclass(frozen=True)
class _Patch:
    """Cells of a quarter disc between two radii.

    position: (P, 20, 2) x and y of the nodes of P cells, m. inner, outer: the two radii, m.
    """

    position: Floats
    inner: float
    outer: float


def hexahedra(pin: Pin, fineness: HexSize, quarters: int = 4) -> HexMesh:
    """The mesh of a pin, or of the first `quarters` quarters of it, from x towards y."""
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
    points = filleted(pin, np.concatenate(cells))
    nodes, elements = _merged(points, NODE_TOLERANCE * pin.smallest_diameter)
    return HexMesh(nodes, elements, tuple(np.concatenate(o) for o in outside), quarters)


def twenty() -> Ints:
    """Numbers (20,) of skfem's nodes in the order of other programs (VTK, CalculiX).

    The order of these programs is: corners, then midside nodes of the edges below, above and
    between.
    """
    skfem_nodes = [tuple(x) for x in np.asarray(ElementHexS2().doflocs).tolist()]
    edges = zip(FACE_CORNER_ORDER, (*FACE_CORNER_ORDER[1:], FACE_CORNER_ORDER[0]), strict=True)
    middles = [((a + c) / 2, (b + d) / 2) for (a, b), (c, d) in edges]
    order = [(*xy, z) for z in (0.0, 1.0) for xy in FACE_CORNER_ORDER]
    order += [(*xy, z) for z in (0.0, 1.0) for xy in middles]
    order += [(*xy, 0.5) for xy in FACE_CORNER_ORDER]
    return np.array([skfem_nodes.index(x) for x in order])


def _merged(points: Floats, tolerance: float) -> tuple[Floats, Ints]:
    """Nodes (N, 3) and elements (M, 20), from nodes (M, 20, 3) of each cell."""
    flat = points.reshape(-1, 3)
    key = np.round(flat / tolerance).astype(np.int64)
    for axis in range(3):  # equal coordinates that round to neighbouring keys get the same key
        order = np.argsort(key[:, axis], kind="stable")
        jump = np.diff(key[order, axis], prepend=key[order[0], axis]) > 2
        key[order, axis] = np.cumsum(jump)
    _, first, number = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return flat[first], number.reshape(points.shape[:2]).astype(np.int64)


@dataclass(frozen=True)
class Fillet:
    """A fillet at the corner of a shaft and a shoulder.

    r, z: position of the corner, m.
    direction: direction of the shaft from the corner, 1 or -1 along z.
    radius: m.
    depth: distance behind the corner within which nodes move, m.
    """

    r: float
    z: float
    direction: int
    radius: float
    depth: float

    def moved(self, r: Floats, z: Floats) -> Floats:
        """Displacement of nodes at r and z, equal along both axes, m.

        Let a and b be the distances from the corner along shaft and face. Then b - a does not
        change, and gives the place on the arc, from one tangent point (-radius) to the other
        (radius). Behind the sides of the corner the displacement decreases linearly with depth.
        """
        a, b = (z - self.z) * self.direction, r - self.r
        place = np.clip((b - a) / self.radius, -1.0, 1.0)
        reach = 1.0 - np.abs(place) / 2.0 - np.sqrt(0.5 - place**2 / 4.0)
        depth = -np.minimum(a, b) / self.depth
        weight = np.where(depth > -NODE_TOLERANCE, np.clip(1.0 - depth, 0.0, 1.0), 0.0)
        return np.asarray(self.radius * reach * weight)


def fillets_of(pin: Pin) -> list[Fillet]:
    """The fillets of a pin whose corners have enough material behind them."""
    fillets = []
    for i, (left, right) in enumerate(pairwise(pin.segments)):
        radius = pin.fillet_at(i)
        thin, thick, direction = (
            (left, right, -1) if left.diameter < right.diameter else (right, left, 1)
        )
        wall = (thin.diameter - max(thin.bore, thick.bore)) / 2.0
        depth = min(radius, wall, thick.length)
        if radius and depth >= MIN_FILLET_DEPTH * radius:
            at = thin.diameter / 2.0, pin.stations[i + 1]
            fillets.append(Fillet(*at, direction, radius, depth))
    return fillets


def filleted(pin: Pin, points: Floats) -> Floats:
    """Nodes (..., 3), m, moved onto fillets. points: nodes for sharp corners, m."""
    r, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
    outwards, along = np.zeros_like(r), np.zeros_like(z)
    for fillet in fillets_of(pin):
        move = fillet.moved(r, z)
        outwards, along = outwards + move, along + fillet.direction * move
    stretch = 1.0 + np.divide(outwards, r, out=np.zeros_like(r), where=r > 0.0)
    return np.stack([points[..., 0] * stretch, points[..., 1] * stretch, z + along], axis=-1)


def _layers(pin: Pin, fineness: HexSize) -> Floats:
    """Bottom and top z of the layers, (L, 2) m."""
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
    """Square, fan and rings of a quarter disc, between all radii that occur."""
    ends = [fillet.r + fillet.radius for fillet in fillets_of(pin)]
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
    """A ring of cells between radii low and high, part of the patch from a to b."""

    def polar(u: Floats, v: Floats) -> Floats:
        radius, angle = low + u * (high - low), v * math.pi / 2.0 / around
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)

    return _grid(1, around, polar, a, b)


def _grid(rows: int, columns: int, position: object, inner: float, outer: float) -> _Patch:
    """A grid of cells; `position` maps u and v, counted in cells, to x and y."""
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

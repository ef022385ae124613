"""A body of revolution as quadratic hexahedra of 20 nodes, structured, all of it or a sector.

The disc of the smallest radius is a square surrounded by a fan; rings between the radii of the
segments follow. Each layer along the axis has the cells that its segment fills. Fillets are left
out: corners are sharp.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from skfem import ElementHexS2

from geometry.arrays import Floats, Ints
from geometry.shape.pin import Pin

BULGE = 0.2  # by which the sides of the square are bent outwards, of its size
SQUARE = 0.55  # its size over the radius of the disc
SAME = 1e-7  # of the length: nodes closer than this are one


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
    points = np.concatenate(cells)
    nodes, elements = _merged(points, SAME * pin.smallest_diameter)
    return HexMesh(nodes, elements, tuple(np.concatenate(o) for o in outside), quarters)


def _merged(points: Floats, tolerance: float) -> tuple[Floats, Ints]:
    flat = points.reshape(-1, 3)
    key = np.round(flat / tolerance).astype(np.int64)
    for axis in range(3):  # so that no two of one node round differently
        order = np.argsort(key[:, axis], kind="stable")
        jump = np.diff(key[order, axis], prepend=key[order[0], axis]) > 2
        key[order, axis] = np.cumsum(jump)
    _, first, number = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return flat[first], number.reshape(points.shape[:2]).astype(np.int64)


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
    radii = sorted({x / 2.0 for s in pin.segments for x in (s.diameter, s.bore) if x})
    n, first, patches = fineness.around // 2, radii[0], []
    if any(s.bore == 0.0 for s in pin.segments):
        fan = max(1, n // 2)
        patches += [
            _grid(n, n, lambda u, v: _square(first, u / n, v / n), 0.0, first),
            _grid(fan, 2 * n, lambda u, v: _fan(first, u / fan, v / n), 0.0, first),
        ]
    for a, b in pairwise(radii):
        thickness = math.pi / 2.0 * b / fineness.around
        count = max(2, math.ceil((b - a) / thickness))
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
    size = SQUARE * radius
    return np.stack([size * u * (1.0 - BULGE * v**2), size * v * (1.0 - BULGE * u**2)], axis=-1)


def _fan(radius: float, t: Floats, around: Floats) -> Floats:
    """Positions between the square (t = 0) and the circle (t = 1), 0 <= around <= 2."""
    start = _square(radius, np.minimum(1.0, 2.0 - around), np.minimum(1.0, around))
    angle = around * math.pi / 4.0
    end = radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return start + t[..., None] * (end - start)

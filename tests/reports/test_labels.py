"""Labels of points: where they are placed, and how the time grows with their number."""

from __future__ import annotations

import time
from itertools import product

import numpy as np
import pytest

from pinbase.dimensions import Floats
from reports.format.drawing import svg_labels
from reports.format.drawing.svg_labels import LABEL_DIRECTIONS, LABEL_REACHES, label_offsets

PICTURE = (400.0, 300.0)
GAP = 9.0


def picture(seed: int, joints: int, frames: int) -> tuple[Floats, Floats, Floats]:
    """Points, sizes of their labels, and lines between them; some points coincide."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-10.0, [PICTURE[0] + 10.0, PICTURE[1] + 10.0], (frames, joints, 2))
    points[:, ::7] = points[:, :1]
    sizes = np.column_stack([rng.uniform(8.0, 60.0, joints), np.full(joints, 13.0)])
    pairs = rng.integers(0, joints, (2 * joints // 3, 2))
    return points, sizes, points[:, pairs]


def cost(offset: Floats, j: int, placed: Floats, drawn: tuple[Floats, Floats, Floats]) -> float:
    """What a label costs at an offset, point by point as the constants say, without its reach."""
    points, sizes, lines = drawn
    half, total = 0.5 * sizes[j], 0.0
    for frame, at in enumerate(points):
        x = at[j] + offset

        def covers(p: Floats, more: Floats | float, x: Floats = x) -> bool:
            return bool(abs(p[0] - x[0]) < (half + more)[0] and abs(p[1] - x[1]) < (half + more)[1])

        inked = [a + s * (b - a) for a, b in lines[frame] for s in np.linspace(0.0, 1.0, 24)]
        total += svg_labels.LINE_COST * sum(covers(p, 2.0) for p in inked) / 24 * 8.0
        total += svg_labels.POINT_COST * sum(covers(p, 4.0) for p in at)
        total += svg_labels.OUTSIDE_COST * (
            not all(c - h >= 0.0 and c + h <= most
                    for c, h, most in zip(x, half, PICTURE, strict=True))
        )  # fmt: skip
        total += svg_labels.LABEL_COST * sum(
            covers(at[i] + placed[i], 0.5 * sizes[i]) for i in range(j)
        )
    return total / len(points)


@pytest.mark.parametrize(("seed", "joints", "frames"), [(1, 16, 1), (2, 7, 3), (3, 24, 1)])
def test_each_label_costs_least(seed: int, joints: int, frames: int) -> None:
    drawn = picture(seed, joints, frames)
    offsets = label_offsets(*drawn, GAP, PICTURE)
    for j in range(joints):
        half, best, where = 0.5 * drawn[1][j], np.inf, np.zeros(2)
        for reach, direction in product(LABEL_REACHES, LABEL_DIRECTIONS):
            slant = 0.8 if direction.all() else 1.0
            offset = direction * (half + slant * reach * GAP)
            here = 0.5 * (reach - 1.0) + cost(offset, j, offsets, drawn)
            if here < best - 1e-9:
                best, where = here, offset
        assert np.array_equal(offsets[j], where), j


def test_no_points_and_no_lines() -> None:
    none = np.zeros((3, 0, 2)), np.zeros((0, 2)), np.zeros((3, 0, 2, 2))
    assert label_offsets(*none, GAP, PICTURE).shape == (0, 2)
    one = label_offsets(np.full((1, 1, 2), 100.0), np.ones((1, 2)), np.zeros((1, 0, 2, 2)), GAP,
                        PICTURE)  # fmt: skip
    assert one[0].tolist() == [0.5 + 0.8 * GAP, -0.5 - 0.8 * GAP]  # to the right and above


def test_time_of_a_large_linkage() -> None:
    """150 joints in 12 frames took 16 s where every pair of labels was compared by itself."""
    drawn = picture(4, 150, 12)
    start = time.process_time()
    label_offsets(*drawn, 13.0, PICTURE)
    assert time.process_time() - start < 5.0

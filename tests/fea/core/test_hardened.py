"""Depth below a hardened surface, and the parts of one yield strength."""

import numpy as np
import pytest

from fea.core.hardened import (
    Hardened,
    core_boundary,
    depth_below,
    hardened_edges,
    linear_strength,
    strength_parts,
)
from geometry import ArgumentError, Pin, Segment

SHAFT = Pin("P", (Segment(0.1, 0.04, bore=0.01, fillet=0.004), Segment(0.05, 0.06, bore=0.01)))


def test_depth_is_normal_to_cylinder_shoulder_and_fillet() -> None:
    edges = hardened_edges(SHAFT, Hardened(0.0, 0.15, 9e8, 5e8, 0.001))
    # The fillet's centre is 4 mm outside of the shaft and before the shoulder; 2 mm beyond its arc.
    away = 0.006 / np.sqrt(2.0)
    points = np.array(
        [[0.018, 0.05], [0.027, 0.103], [0.024 - away, 0.096 + away], [0.005, 0.05], [0.0, 0.0]]
    )
    assert depth_below(edges, points) == pytest.approx([0.002, 0.003, 0.002, 0.015, 0.02])


def test_neither_bore_nor_end_faces_are_hardened() -> None:
    case = Hardened(0.0, 0.15, 9e8, 5e8, 0.002)
    hard, soft = strength_parts((case,), None, SHAFT.length)
    points = np.array([[0.0051, 0.05], [0.01, 0.0], [0.0199, 0.05], [0.0179, 0.05]])
    assert hard.holds(SHAFT, points).tolist() == [False, False, True, False]
    assert soft.holds(SHAFT, points).tolist() == [True, True, False, True]


def test_core_begins_at_its_depth_below_everything() -> None:
    case = Hardened(0.0, 0.15, 9e8, 5e8, 0.002)
    points = core_boundary(SHAFT, (case,))
    depth = depth_below(hardened_edges(SHAFT, case), points)
    assert len(points) > 200
    assert depth.min() >= 0.002
    # Each has its depth but where an inner corner is nearer; none is far from the boundary.
    assert np.quantile(depth, 0.9) == pytest.approx(0.002, rel=1e-4)
    arc = np.hypot(points[:, 0] - 0.024, points[:, 1] - 0.096)
    assert (np.abs(arc - 0.006) < 1e-7).sum() > 10


def test_shoulder_to_what_is_not_hardened_is_not() -> None:
    case = Hardened(0.0, 0.1, 9e8, 5e8, 0.001)
    parts = strength_parts((case,), 6e8, SHAFT.length)
    assert [part.part for part in parts] == ["case", "core", "unhardened"]
    assert parts[2].stretches[0] == pytest.approx((0.1, 0.15))
    point = np.array([[0.027, 0.1005]])  # half a millimetre from the shoulder's face
    assert [part.holds(SHAFT, point)[0] for part in parts] == [False, False, True]


def test_linear_stress_yields_at_the_crossover_depth_in_both() -> None:
    # R (1 - core / surface) deep, case and core yield together.
    for depth, strength in ((0.002, 5e8 / 0.9), (0.02 * 4 / 9, 9e8), (0.015, 9e8)):
        parts = strength_parts((Hardened(0.0, 1.0, 9e8, 5e8, depth),), None, 1.0)
        assert linear_strength(parts, 0.02) == pytest.approx(strength)


@pytest.mark.parametrize("wrong", [(9e8, 5e8, 0.0), (5e8, 9e8, 0.001), (9e8, 0.0, 0.001)])
def test_impossible_case_is_refused(wrong: tuple[float, float, float]) -> None:
    with pytest.raises(ArgumentError, match="positive depth"):
        Hardened(0.0, 1.0, *wrong)

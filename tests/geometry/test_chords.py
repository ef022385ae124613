"""Points of a curve that its polyline leaves out, and what is missed by that."""

from __future__ import annotations

import numpy as np

from geometry.shape.chords import needed
from pinbase.arrays import Floats


def missed(at: Floats, values: Floats, allowed: float, kept: list[int]) -> tuple[float, int]:
    must = np.isin(np.arange(len(at)), kept)
    keep = needed(at, values, np.full(values.shape, allowed), must)
    assert keep[[0, -1, *kept]].all()
    lines = [np.interp(at, at[keep], column[keep]) for column in values.T]
    return float(np.abs(np.stack(lines, axis=1) - values).max()), int(keep.sum())


def test_what_is_left_out_is_on_the_lines_between_the_others() -> None:
    at = np.linspace(0.0, 1.0, 400) ** 2
    values = np.stack([np.sin(9.0 * at), np.exp(-((at - 0.3) ** 2) / 1e-3)], axis=1)
    worst, count = missed(at, values, 1e-2, [17])
    assert worst <= 1e-2
    assert count < 60
    finer, more = missed(at, values, 1e-3, [17])
    assert finer <= 1e-3
    assert more > 2 * count


def test_straight_lines_need_their_ends_and_jumps_both_sides() -> None:
    at = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 4.0])
    assert missed(at[:3], 3.0 * at[:3, None], 1e-9, [])[1] == 2
    jump = np.array([0.0, 1.0, 2.0, 7.0, 7.0, 7.0])[:, None]
    must = np.zeros(6, dtype=bool)
    keep = needed(at, jump, np.full(jump.shape, 1e-9), must)
    assert keep.tolist() == [True, False, True, True, False, True]

"""No surface has more stress than its row says and its error: pins drawn at random, in two to four
lugs, whose surface is read by another reader (benchmarks/joints/random_pins.py), which superposes
the unit fields itself and leaves out nothing but pressed cells and those next to them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.joints.random_pins import Checked, check, pin_trials, read_surface
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.core.requirement import Requirement
from fea.harmonic.fields import MeridianFields
from tests.support.each import sampled

TRIALS = pin_trials(20, 7)


@pytest.mark.parametrize("k", sampled(range(len(TRIALS)), every=7))
def test_rows_on_large_cells(k: int) -> None:
    """Rows on the largest cells, whose error is largest."""
    found = check(TRIALS[k], Requirement(cells="rough"))
    assert not found.violates, found


@pytest.mark.slow
@pytest.mark.parametrize("k", sampled(range(len(TRIALS)), every=10, first=3))
def test_rows(k: int) -> None:
    found = check(TRIALS[k])
    assert not found.violates, found
    assert found.read > 0.6 * found.row  # it reads something


def test_what_is_drawn() -> None:
    """Two to four lugs, tubes, motions, every kind of gap, in balance."""
    trials = pin_trials(60, 7)
    assert {len(t.given.lugs) for t in trials} == {2, 3, 4}
    names = " ".join(t.name for t in trials)
    assert all(x in names for x in ("touching", "gap", "step", "shoulder", "groove", "a tube"))
    assert any(t.given.between for t in trials)
    for t in trials:
        (loads,) = t.given.cases
        assert np.abs(loads.forces.sum(axis=1)).max() < 1e-9 * np.abs(loads.forces).max()


def test_the_reader_sees_what_is_free_and_nothing_else() -> None:
    """A line of five points under bending, s = cos(angle) z Pa: largest at the last; with that one
    pressed on one side, the other is read; with both, the third point, for the fourth is too near.
    """
    z = np.linspace(0.1, 0.5, 5)
    bending = np.zeros((5, 6, 1))
    bending[:, 2, 0] = z
    load = UnitLoad("A", "force", 1)
    points = np.stack([np.full(5, 1.0), z], axis=1)
    fields = MeridianFields(points, (load,), bending, np.zeros((0, 3, 1)), 5, 0)
    pull = PinLoads("case", ("A",), np.array([[[1.0, 0.0, 0.0]]]))
    assert read_surface(fields, pull, 0, [])[:2] == pytest.approx((0.5, 0.5))
    value, at, angle = read_surface(fields, pull, 0, [(0.45, 0.55, -20.0, 20.0)])
    assert (value, at, angle) == pytest.approx((0.5, 0.5, 180.0))
    both = [(0.45, 0.55, -20.0, 20.0), (0.45, 0.55, 160.0, 200.0)]
    assert read_surface(fields, pull, 0, both)[:2] == pytest.approx((0.3, 0.3))


def test_a_row_that_is_too_low_is_told() -> None:
    found = Checked(100.0, 2.0, "surface", "converged", 101.9, 0.0, 0.0)
    assert not found.violates
    assert replace(found, read=102.1).violates

"""A motion in batches of instants is the same as at once, and takes no more memory with more."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from benchmarks.motion.scissor import HIGH, LOW, SPAN, lift
from loads import Course, CycloidalDrive, ledger, motion_reactions
from loads.motion import loop_equations
from pinbase.arrays import Floats

LAW = CycloidalDrive(LOW, HIGH, SPAN)


def test_batches_join_to_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    course = Course(lift(3), [LAW], 0.0, SPAN)
    times = np.linspace(0.0, SPAN, 50)
    once = motion_reactions("lift", course.at(times))
    monkeypatch.setattr(
        loop_equations, "MATRIX_BATCH_ENTRIES", 7 * course.loops.rows * course.loops.columns
    )
    parts = motion_reactions("lift", course.at(times))
    assert len(course.loops.parts(50)) == 8
    assert parts.reactions.times is not None
    assert np.array_equal(parts.reactions.times, times)
    for key in ("forces", "turn"):
        ours, other = (getattr(d.reactions, key) for d in (parts, once))
        assert ours == pytest.approx(other, rel=1e-11, abs=1e-11 * np.abs(other).max())
    assert parts.drive == pytest.approx(once.drive, rel=1e-11)
    assert parts.sliders.normal == pytest.approx(once.sliders.normal, rel=1e-9, abs=1e-9)
    assert parts.motion.condition == pytest.approx(once.motion.condition, rel=1e-9)
    assert ledger(parts).violation < 1e-12


def test_a_lift_needs_the_force_of_virtual_work() -> None:
    """Held still, the foot's force times its way is the weights times theirs."""
    stages = 12
    linkage = lift(stages)
    found = motion_reactions("lift", Course(linkage, [LAW], 0.0, SPAN).at(np.array([0.0, SPAN])))
    for t, foot in enumerate((LOW, HIGH)):
        slope = -foot / np.sqrt(4.0 - foot**2)  # of a stage's height by the foot
        heights = np.arange(stages) + 0.5
        weight = 9.81 * (2.0 * 20.0 * heights.sum() + (150.0 + 4.0) * stages)
        assert found.drive[t, 0] == pytest.approx(weight * slope, rel=1e-11)


def test_memory_grows_with_the_results_alone() -> None:
    course = Course(lift(12), [LAW], 0.0, SPAN)

    def peak(count: int) -> tuple[int, int]:
        times: Floats = np.linspace(0.0, SPAN, count)
        tracemalloc.start()
        found = motion_reactions("lift", course.at(times))
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return most, found.reactions.forces.nbytes

    (few, small), (many, large) = peak(4000), peak(12000)
    assert many - few < 8 * (large - small)

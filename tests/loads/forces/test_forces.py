"""Forces by tables, springs and dampers: against scipy, energies and the same by other means."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from loads import (
    GROUND,
    Applied,
    Clock,
    ConstantDrive,
    CosineDrive,
    Course,
    Distance,
    Dynamics,
    ForceLaw,
    ForceTable,
    LinkageError,
    Load,
    Motion,
    OverTime,
    Position,
    Spring,
    Turn,
    Varying,
    ledger,
    motion_reactions,
    move,
    over_time,
)
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import four_bar, slider_crank

BAR = four_bar()
ROWS = (0.0, 1.0, 1.5, 3.0, 4.0), (2.0, 5.0, 5.0, -1.0, 2.0)


def turned(*loads: Load, samples: int = 201) -> Dynamics:
    times = np.linspace(0.0, 1.0, samples)
    return motion_reactions("x", move(BAR, [CosineDrive(0.9, 4.0, 1.0)], times), loads)


def steady(times: Floats) -> Motion:
    return move(BAR, [ConstantDrive(0.9, 4.0, 1.0)], times)


def resolved_turn(samples: int, *loads: Load) -> OverTime:
    course = Course(BAR, [ConstantDrive(0.9, 4.0, 1.0)], 0.0, 1.0)

    def solve(times: Floats) -> Dynamics:
        return motion_reactions("x", course.at(times), loads)

    return over_time(course, solve, solve(np.linspace(0.0, 1.0, samples)))


def test_the_monotone_cubic_is_that_of_scipy() -> None:
    at = np.linspace(0.0, 4.0, 101)
    ours = ForceTable(*ROWS, interpolation="monotone")(at)
    np.testing.assert_allclose(ours, PchipInterpolator(*ROWS)(at), atol=1e-13)
    two = ForceTable((0.0, 2.0), (1.0, 5.0), interpolation="monotone")
    np.testing.assert_allclose(two(at[:51]), 1.0 + 2.0 * at[:51], atol=1e-14)


def test_the_monotone_cubic_neither_overshoots_nor_turns_between_rows() -> None:
    """By properties that need no second program: the values of the rows, flat beside extremes, and,
    inside a rise, the slope that Fritsch and Carlson's weighted harmonic mean has.
    """
    flat = ForceTable(*ROWS, interpolation="monotone")
    np.testing.assert_allclose(flat(np.array(ROWS[0])), ROWS[1], atol=1e-14)
    for x, y in zip(pairwise(ROWS[0]), pairwise(ROWS[1]), strict=True):
        between = flat(np.linspace(*x, 50))
        assert min(y) - 1e-12 <= between.min() <= between.max() <= max(y) + 1e-12
        assert (np.diff(between) * (y[1] - y[0]) >= -1e-12).all()
    rising = ForceTable((0.0, 1.0, 3.0), (0.0, 1.0, 7.0), interpolation="monotone")
    step = 1e-6
    slope = float(np.diff(rising(np.array([1.0 - step, 1.0 + step])))[0]) / (2.0 * step)
    w1, w2 = 2.0 * 2.0 + 1.0, 2.0 + 2.0 * 1.0  # widths 1 and 2, slopes 1 and 3
    assert slope == pytest.approx((w1 + w2) / (w1 / 1.0 + w2 / 3.0), rel=1e-6)


@each("interpolation", ["linear", "monotone"])
def test_a_repeated_table_is_one_of_three_periods(interpolation: str) -> None:
    """In the middle of three copies the ends of the table are no ends."""
    x = [k * 4.0 + t for k in (-1, 0, 1) for t in ROWS[0][:-1]] + [8.0]
    thrice = ForceTable(tuple(x), ROWS[1][:-1] * 3 + (2.0,), interpolation)  # type: ignore[arg-type]
    again = ForceTable(*ROWS, interpolation, outside="repeat")  # type: ignore[arg-type]
    at = np.linspace(0.0, 4.0, 77)
    for period in (0.0, 8.0, -4.0):
        np.testing.assert_allclose(again(at + period), thrice(at), atol=1e-12)
    assert again.knots(3.5, 9.2).tolist() == [4.0, 5.0, 5.5, 7.0, 8.0, 9.0]


def test_outside_a_table() -> None:
    assert ForceTable(*ROWS, outside="hold")(np.array([-1.0, 9.0])).tolist() == [2.0, 2.0]
    held = ForceTable(*ROWS, name="gas", unit=("mm", 0.5))
    assert held(np.array([4.0 + 1e-12])) == pytest.approx(2.0)
    with raises(LinkageError, "outside-table", "gas goes from 0 mm to 8 mm, but 10 mm occurs"):
        held(np.array([1.0, 5.0]))
    with raises(LinkageError, "table-not-increasing", "row 3"):
        ForceTable((0.0, 1.0, 1.0), (0.0, 1.0, 2.0))
    with raises(LinkageError, "table-not-periodic"):
        ForceTable((0.0, 1.0), (0.0, 1.0), outside="repeat")
    with raises(LinkageError, "too-few-rows"):
        ForceTable((0.0,), (0.0,))


LINE = Distance(("rocker", GROUND), (BAR.joint("B").at, (0.3, 1.4)))
HINGE = Position(Turn("", "coupler", 0.0, "rocker"))


@pytest.mark.parametrize("between", [LINE, HINGE], ids=["line", "hinge"])
def test_a_spring_gives_back_its_energy_and_a_damper_takes_it(between: Distance | Position) -> None:
    """Power against the rate of the spring's energy and the damper's loss, at every instant."""
    spring = Spring("s", between, ForceLaw(30.0, 700.0, 0.4, 20.0))
    found = turned(spring)
    x, rate = between(found.motion)
    power = (30.0 - 700.0 * (x - 0.4) - 20.0 * rate) * rate
    np.testing.assert_allclose(ledger(found).applied, power, atol=1e-10 * np.abs(power).max())
    assert ledger(found).violation < 1e-13
    differences = np.gradient(x, found.motion.times)
    assert np.abs(differences - rate)[1:-1].max() < 2e-3 * np.abs(rate).max()


@pytest.mark.parametrize("between", [LINE, HINGE], ids=["line", "hinge"])
def test_the_drive_feels_a_spring_as_the_slope_of_its_energy(between: Distance | Position) -> None:
    """Virtual work: the change of the torque is d/d(angle) of k (x - x0)^2 / 2."""
    torque = (turned(Spring("s", between, ForceLaw(0.0, 700.0, 0.4))).drive - turned().drive)[:, 0]
    h = 1e-5
    for k in (30, 90, 170):
        angle = turned().motion.drives[k, 0]
        energy = [
            350.0 * (between(move(BAR, [ConstantDrive(a, a, 1.0)], np.zeros(1)))[0][0] - 0.4) ** 2
            for a in (angle - h, angle + h)
        ]
        assert torque[k] == pytest.approx((energy[1] - energy[0]) / (2 * h), rel=1e-6, abs=1e-5)


def test_a_spring_along_a_slider_is_one_between_its_points() -> None:
    linkage = slider_crank(offset=0.04)
    (guide,) = linkage.sliders
    law = ForceLaw(5.0, 300.0, 0.1, 7.0)
    times = np.linspace(0.0, 1.0, 31)
    motion = move(linkage, [ConstantDrive(0.7, 5.0, 1.0)], times)
    both = [
        motion_reactions("x", motion, [Spring("s", between, law)])
        for between in (
            Position(guide),
            Distance((GROUND, "block"), (guide.start, guide.end)),
        )
    ]
    np.testing.assert_allclose(both[0].drive, both[1].drive, atol=1e-12)
    np.testing.assert_allclose(both[0].reactions.forces, both[1].reactions.forces, atol=1e-11)


def test_a_table_of_the_angle_is_the_same_as_constant_loads() -> None:
    """At every instant the force is what a constant force of that size does."""
    table = ForceTable((0.0, 1.0, 2.0, 5.0), (0.0, 40.0, -10.0, 60.0))
    at, turn = BAR.joint("B").at, BAR.drives[0]
    law = Varying(Position(turn), table)
    found = turned(Applied("rocker", at, (0.6, 0.8), times=law), samples=21)
    for k in (0, 7, 13, 20):
        size = float(np.interp(found.motion.drives[k, 0], table.x, table.y))
        alone = turned(Applied("rocker", at, (0.6 * size, 0.8 * size)), samples=21)
        np.testing.assert_allclose(found.drive[k], alone.drive[k], atol=1e-11)
        np.testing.assert_allclose(found.reactions.forces[k], alone.reactions.forces[k], atol=1e-11)


def test_peaks_at_the_knots_of_a_table_are_found() -> None:
    """A spike a thousandth of the turn wide, between any samples: its tip is an instant."""
    turn = BAR.drives[0]
    spike = ForceTable((0.0, 2.0, 2.0015, 2.003, 5.0), (0.0, 0.0, 1e5, 0.0, 0.0))
    load = Applied("rocker", BAR.joint("B").at, (1.0, 0.0), times=Varying(Position(turn), spike))
    found = resolved_turn(5, load)
    tip = (2.0015 - 0.9) / 3.1
    assert found.drives[0].largest.time == pytest.approx(tip, abs=1e-9)
    there = motion_reactions(
        "x", move(BAR, [ConstantDrive(0.9, 4.0, 1.0)], np.array([tip])), [load]
    )
    assert found.drives[0].largest.value == pytest.approx(abs(there.drive[0, 0]), rel=1e-6)
    assert len(found.peaks.unresolved) == 0
    assert found.violation < 1e-12
    work = resolved_turn(5).drives[0].work[-1] - found.drives[0].work[-1]
    many = np.linspace(0.0, 1.0, 100_001)
    power = ledger(motion_reactions("x", steady(many), [load])).applied
    assert work == pytest.approx(np.trapezoid(power, many), rel=1e-5)


def test_a_load_that_is_switched_acts_only_between() -> None:
    at = BAR.joint("B").at
    pulse = ForceTable((0.3, 0.7), (1e4, 2e4))
    load = Applied("rocker", at, (1.0, 0.0), times=Varying(Clock(), pulse), begin=0.3, end=0.7)
    found = turned(load, samples=11)
    free = turned(samples=11)
    differs = np.abs(found.drive - free.drive)[:, 0] > 1.0
    assert differs.tolist() == [3 < k <= 7 for k in range(11)]
    over = resolved_turn(3, load)
    assert {0.3, 0.7} <= set(over.corners.tolist())
    just = motion_reactions("x", steady(np.array([0.7])), [load])
    assert over.drives[0].largest.value >= (1.0 - 1e-5) * abs(just.drive[0, 0])


def test_a_load_with_one_switch_acts_on_its_other_side() -> None:
    at, free = BAR.joint("B").at, turned(samples=11)
    until = turned(Applied("rocker", at, (1e4, 0.0), end=0.45), samples=11)
    since = turned(Applied("rocker", at, (1e4, 0.0), begin=0.45), samples=11)
    always = turned(Applied("rocker", at, (1e4, 0.0)), samples=11).drive
    before = np.arange(11)[:, None] <= 4
    assert until.drive == pytest.approx(np.where(before, always, free.drive), rel=1e-12)
    assert since.drive == pytest.approx(np.where(before, free.drive, always), rel=1e-12)
    assert np.abs(always - free.drive).max() > 1e3


def test_points_of_a_spring_that_coincide() -> None:
    at = BAR.joint("B").at
    spring = Spring("s", Distance(("rocker", "coupler"), (at, at)), ForceLaw(1.0))
    with raises(LinkageError, "no-direction", "spring s"):
        turned(spring)

"""One path for all instants: few samples, odd orders and detours change nothing."""

from __future__ import annotations

import numpy as np
import pytest

from loads import (
    GROUND,
    Body,
    Connection,
    ConstantDrive,
    CosineDrive,
    CycloidalDrive,
    Joint,
    Linkage,
    MotionBlocked,
    TableDrive,
    Turn,
    move,
)
from loads.motion.motion import Course
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import four_bar, slider_crank

TURNS = 10
MANY = 0.9 + 2.0 * np.pi * TURNS


@pytest.mark.parametrize(
    "samples",
    [
        2,
        *(pytest.param(count, marks=pytest.mark.slow) for count in (11,)),
        *(pytest.param(count, marks=[pytest.mark.slow, pytest.mark.long]) for count in (3, 4, 21)),
    ],
)
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_ten_turns_in_few_samples_stay_on_their_branch(samples: int, sense: float) -> None:
    times = np.linspace(0.0, 1.0, samples)
    for linkage, start in ((four_bar(angle=0.9), 0.9), (slider_crank(), 0.7)):
        law = ConstantDrive(start, start + sense * 2.0 * np.pi * TURNS, 1.0)
        few = move(linkage, [law], times)
        fine = move(linkage, [law], np.linspace(0.0, 1.0, 60 * (samples - 1) + 1))
        assert few.q == pytest.approx(fine.q[::60], abs=1e-12)
        drawn = move(linkage, [ConstantDrive(start, start + 1e-9, 1.0)], np.zeros(1))
        whole = np.round((few.q - drawn.q) / (2.0 * np.pi))
        if samples in (2, 3, 11):  # the crank is where it began, and so is the rest
            assert few.q - drawn.q == pytest.approx(2.0 * np.pi * whole, abs=1e-9)


def test_a_short_motion_from_rest_to_rest_has_a_pace() -> None:
    course = Course(four_bar(angle=0.9), [CycloidalDrive(0.8, 1.0, 1.0)], 0.0, 1.0)
    assert course.path.nodes.tolist() == [0.0, 1.0]  # at which nothing moves
    motion = course.at(np.linspace(0.0, 1.0, 101))
    fastest = float(np.abs(motion.v * motion.loops.scale).max())
    assert course.pace == pytest.approx(fastest, rel=0.05)


def test_an_instant_does_not_depend_on_the_others_nor_on_their_order() -> None:
    course = Course(four_bar(angle=0.9), [ConstantDrive(0.9, MANY, 1.0)], 0.0, 1.0)
    times = np.random.default_rng(1).uniform(0.0, 1.0, 50)
    together = course.at(times)
    for k in (0, 17, 49):
        alone = course.at(times[k : k + 1])
        assert alone.q[0] == pytest.approx(together.q[k], abs=1e-13)
        assert alone.a[0] == pytest.approx(together.a[k], rel=1e-9)
    order = np.argsort(times)
    assert course.at(times[order]).q == pytest.approx(together.q[order], abs=1e-13)


def test_an_excursion_between_two_samples_is_followed() -> None:
    """To beyond the dead point and back: the samples alone are both where it was drawn."""
    linkage = four_bar(1.0, 0.9, 0.5, 0.6, angle=0.5)
    there, none = (0.5, 2.0, 0.5), (0.0, 0.0, 0.0)
    with raises(MotionBlocked, "dead-point", "crank = 114"):
        move(linkage, [TableDrive((0.0, 0.5, 1.0), there, none, none)], np.array([0.0, 1.0]))


def five_bar() -> Linkage:
    """Two cranks of 0.5 m, a metre apart, and two rods of 0.85 m."""
    p, q = 0.5 * np.exp(1j * (np.pi + 1.5)), 1.0 + 0.5 * np.exp(1.5j)
    across = q - p
    c = 0.5 * (p + q) + 1j * across / abs(across) * np.sqrt(0.85**2 - 0.25 * abs(across) ** 2)
    return Linkage(
        bodies=tuple(
            Body(name, 1.0, (z.real, z.imag), 0.02)
            for name, z in (
                ("left", 0.5 * p),
                ("right", 0.5 * (1.0 + q)),
                ("rod", 0.5 * (p + c)),
                ("bar", 0.5 * (q + c)),
            )
        ),
        joints=(
            Joint("O", (0.0, 0.0), (Connection("O", "left"),), GROUND),
            Joint("E", (1.0, 0.0), (Connection("E", "right"),), GROUND),
            Joint("P", (p.real, p.imag), (Connection("P", "rod"),), "left"),
            Joint("Q", (q.real, q.imag), (Connection("Q", "bar"),), "right"),
            Joint("C", (c.real, c.imag), (Connection("C", "bar"),), "rod"),
        ),
        driven=("left", "right"),
        turns=(Turn("left", "left", np.pi + 1.5), Turn("right", "right", 1.5)),
        gravity=(0.0, -9.81),
    )


def test_drives_one_after_another_do_not_go_straight_from_sample_to_sample() -> None:
    """On the straight line both cranks would lie flat, two metres apart: the rods do not reach."""
    laws = [
        ConstantDrive(np.pi + 1.5, np.pi - 1.5, 1.0, begin=1.0),
        ConstantDrive(1.5, -1.5, 1.0),
    ]
    few = move(five_bar(), laws, np.array([0.0, 2.0]))
    fine = move(five_bar(), laws, np.linspace(0.0, 2.0, 201))
    assert few.q == pytest.approx(fine.q[[0, -1]], abs=1e-12)


def test_where_one_drive_ends_and_another_begins_only_one_of_them_accelerates() -> None:
    laws = [CosineDrive(np.pi + 1.5, np.pi + 1.9, 1.0, begin=1.0), CosineDrive(1.5, 1.9, 1.0)]
    motion = move(five_bar(), laws, np.array([0.0, 1.0 - 1e-7, 1.0, 1.0 + 1e-7, 2.0]))
    assert motion.rates[2] == pytest.approx(motion.rates[1], abs=1e-5)
    assert motion.a[2] == pytest.approx(motion.a[1], abs=1e-4)
    assert abs(motion.rates[3, 0]) > 1.0

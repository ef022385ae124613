"""Extremes and means over the time of a motion: few samples must give what many do."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from loads import (
    Applied,
    ConstantDrive,
    CosineDrive,
    Course,
    CycloidalDrive,
    Dynamics,
    JammingError,
    Linkage,
    OverTime,
    energy,
    motion_reactions,
    move,
    over_time,
)
from loads.forces.over_time import Exerted, ForceHistory, PeakForces
from loads.forces.reactions import Reactions, given_reactions
from loads.linkage.drives import Law
from pinbase.arrays import Floats
from pinstress.study.model.mechanism.drives import laws, span
from pinstress.study.reading.file import Study
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import four_bar, slider_crank

TURN = 2.0 * np.pi
Drive = ConstantDrive | CosineDrive | CycloidalDrive


def course_of(
    linkage: Linkage, laws: list[Law], last: float, samples: int, *applied: Applied
) -> tuple[Dynamics, OverTime]:
    course = Course(linkage, laws, 0.0, last)

    def solve(times: Floats) -> Dynamics:
        return motion_reactions("x", course.at(times), applied)

    found = solve(np.linspace(0.0, last, samples))
    return found, over_time(course, solve, found)


@cache
def dense(linkage: Linkage, law: Drive, last: float) -> OverTime:
    return course_of(linkage, [law], last, 1001)[1]


def same(found: OverTime, other: OverTime, rel: float = 1e-9) -> None:
    for name, peak in other.peaks.force.items():
        assert found.peaks.force[name].value == pytest.approx(peak.value, rel=rel)
    for ours, theirs in zip(found.drives, other.drives, strict=True):
        assert ours.largest.value == pytest.approx(theirs.largest.value, rel=rel)
        small = 1e-9 * theirs.largest.value
        assert (ours.mean, ours.rms) == pytest.approx((theirs.mean, theirs.rms), rel=rel, abs=small)
        assert ours.work[-1] == pytest.approx(theirs.work[-1], rel=1e-8, abs=1e-9)
    for key, low in other.transmission.items():
        assert found.transmission[key].value == pytest.approx(low.value, abs=1e-8)
    assert found.condition.value == pytest.approx(other.condition.value, rel=1e-6)


def test_ten_turns_with_eleven_samples_have_the_torque_of_all_the_time() -> None:
    """Every sample is at the same angle, so no sample shows more than that one torque."""
    law = ConstantDrive(0.9, 0.9 + 10.0 * TURN, 10.0)
    few, found = course_of(four_bar(angle=0.9), [law], 10.0, 11)
    many = motion_reactions("x", move(four_bar(angle=0.9), [law], np.linspace(0.0, 10.0, 20_001)))
    (torque,) = found.drives
    assert np.ptp(few.drive) < 1e-9
    assert torque.largest.value > 1.5 * np.abs(few.drive).max()
    assert torque.largest.value == pytest.approx(np.abs(many.drive).max(), rel=2e-5)
    assert torque.rms == pytest.approx(np.sqrt(np.mean(many.drive[1:] ** 2)), rel=1e-9)
    assert torque.mean == 0.0  # what the weights take on the way down they give on the way up
    for name, peak in found.peaks.force.items():
        sizes = many.reactions.magnitudes[:, many.reactions.connections.index(name)]
        assert peak.value == pytest.approx(sizes.max(), rel=2e-5)
        assert peak.value >= sizes.max() * (1.0 - 1e-12)


@pytest.mark.parametrize("samples", [2, 3, 5, 12])
@pytest.mark.parametrize(
    ("linkage", "law", "last"),
    [
        (four_bar(), CycloidalDrive(0.9, 0.9 - 3.0 * TURN, 2.0), 2.0),
        (four_bar(), CosineDrive(0.9, 2.0, 1.0, begin=0.5), 2.0),
        (slider_crank(friction=0.2), ConstantDrive(0.7, 0.7 + 2.0 * TURN, 0.2), 0.2),
        (slider_crank(offset=0.03, friction=0.3, bearing=0.2), CosineDrive(0.7, 7.0, 0.1), 0.1),
    ],
    ids=["four-bar", "rests", "rubs", "pads rub"],
)
def test_the_number_of_samples_changes_nothing(
    linkage: Linkage, law: Drive, last: float, samples: int
) -> None:
    _, few = course_of(linkage, [law], last, samples)
    assert not len(few.peaks.unresolved)
    same(few, dense(linkage, law, last))


def test_friction_counts_from_the_side_on_which_something_slides() -> None:
    """A block pushed onto its guide and driven from rest to rest: at both ends friction is zero,
    and just inside it is in full. Along the rod the force is then at its largest.
    """
    linkage = slider_crank(friction=0.2, masses=(0.0, 0.0, 1e-9))
    push, law = Applied("block", linkage.joints[2].at, (100.0, 0.0)), CosineDrive(0.7, 2.0, 1.0)
    rests, over = course_of(linkage, [law], 1.0, 5, push)
    inside = motion_reactions("x", move(linkage, [law], np.linspace(0.0, 1.0, 10_001)), [push])
    sizes = inside.reactions.magnitudes[:, inside.reactions.connections.index("C")]
    peak = over.peaks.force["C"]
    assert rests.sliders.friction[0, 0] == 0.0
    assert sizes[0] < 0.99 * sizes[1]
    assert peak.value == pytest.approx(sizes[1:-1].max(), rel=1e-4)
    assert peak.value >= sizes.max()


def test_a_jam_between_two_samples_is_reported() -> None:
    linkage = slider_crank(crank=0.1, rod=0.15, friction=1.2, masses=(1.0, 1.0, 1.0))
    with raises(JammingError, "friction-jams"):
        course_of(linkage, [ConstantDrive(0.1, 3.0, 1.0)], 1.0, 2)


def test_work_goes_into_energy() -> None:
    found, over = course_of(four_bar(), [CycloidalDrive(0.9, 4.0, 0.5)], 0.5, 7)
    stored = energy(found.motion)
    total = stored.kinetic + stored.potential
    assert over.drives[0].work == pytest.approx(total - total[0], rel=1e-8, abs=1e-8)


def test_twenty_one_samples_give_every_peak_of_the_landing_gear(
    gear: Study, gear_linkage: Linkage
) -> None:
    end = span(gear)
    fine, exact = course_of(gear_linkage, list(laws(gear)), end, 4001)
    coarse, found = course_of(gear_linkage, list(laws(gear)), end, 21)
    for name, best in exact.peaks.force.items():
        assert found.peaks.force[name].value == pytest.approx(best.value, rel=1e-10)
        assert found.peaks.force[name].time == pytest.approx(best.time, abs=1e-3)
    sizes, sampled = (d.reactions.magnitudes.max(axis=0) for d in (fine, coarse))
    peaks = np.array([p.value for p in exact.peaks.force.values()])
    assert np.all(peaks >= sizes * (1.0 - 1e-12))
    assert np.max(peaks / sampled) > 1.00005


def reactions(times: Floats, *forces: Floats) -> Reactions:
    names = "PQRS"[: len(forces)]
    one = given_reactions("x", dict.fromkeys(names, (0.0, 0.0)))
    all_forces = np.stack(forces, axis=1)
    turn = np.zeros(all_forces.shape[:2])
    return replace(one, times=times, forces=all_forces, moments=0.0 * all_forces, turn=turn)


def peak_forces(samples: Floats, at: Callable[[Floats], Reactions]) -> PeakForces:
    def exerted(times: Floats) -> Exerted:
        return Exerted(times, at(times), *np.zeros((2, len(times), 0)))

    history = ForceHistory.of([exerted(samples)], exerted, np.empty(0), (1.0, 0.0), moments=True)
    return history.peaks()


def test_a_known_maximum_between_samples() -> None:
    def at(times: Floats) -> Reactions:
        o = 0.0 * times
        crest = np.stack([3.0 - (times - 0.4321) ** 4, o, o], axis=1)
        rising = np.stack([o, np.exp(times), o], axis=1)
        return reactions(times, crest, rising)

    found = peak_forces(np.linspace(0.0, 1.0, 6), at)
    assert found.force["P"].value == pytest.approx(3.0, abs=1e-12)
    assert found.force["P"].time == pytest.approx(0.4321, abs=1e-2)  # flat to fourth order
    assert (found.force["Q"].value, found.force["Q"].time) == pytest.approx((math.e, 1.0))
    assert found.vector["Q"] == pytest.approx([0.0, math.e, 0.0])


def test_a_jump_that_nothing_announces_is_reported() -> None:
    def at(times: Floats) -> Reactions:
        o = 0.0 * times
        return reactions(times, np.stack([np.where(times < 1 / 3, 1.0, 2.0), o, o], axis=1))

    found = peak_forces(np.linspace(0.0, 1.0, 4), at)
    ((low, high),) = found.unresolved
    assert low <= 1 / 3 <= high
    assert found.force["P"].value == pytest.approx(2.0, rel=1e-9)

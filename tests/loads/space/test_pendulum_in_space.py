"""An arm about a tilted axis: extremes, means and work of its motion, and what locks it at rest, by
closed forms.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from loads import GROUND, CosineDrive, LinkageError, Reactions
from loads.space.acting import SpaceForce
from loads.space.dynamics import SpaceDynamics, space_reactions
from loads.space.holding import held, held_as_drawn
from loads.space.linkage import (
    JointAngle,
    PointDistance,
    RigidBody,
    SpaceJoint,
    SpaceLinkage,
    Vector,
)
from loads.space.motion import SpaceCourse
from loads.space.over_time import space_over_time
from tests.support.each import each
from tests.support.errors import raises

MASS, INERTIA, REACH = 3.0, 0.08, 0.6
AXIS, ALONG = np.array([1.0, 2.0, 2.0]) / 3.0, np.array([2.0, 1.0, -2.0]) / 3.0
SIDE = np.cross(AXIS, ALONG)


def vector(x: np.ndarray) -> Vector:
    a, b, c = x.tolist()
    return a, b, c


def arm(*driven: str) -> SpaceLinkage:
    """A symmetric body, REACH along ALONG from the axis; a strut can hold it."""
    inertia = tuple(vector(row) for row in INERTIA * np.eye(3))
    return SpaceLinkage(
        (RigidBody("arm", MASS, vector(REACH * ALONG), inertia),),  # type: ignore[arg-type]
        (SpaceJoint("O", "revolute", GROUND, "arm", (0.0, 0.0, 0.0), vector(AXIS)),),
        (
            JointAngle("motor", "O"),
            PointDistance("strut", (GROUND, "arm"), (vector(SIDE), vector(ALONG))),
            PointDistance("rod", (GROUND, "arm"), (vector(AXIS), vector(AXIS + ALONG))),
        ),
        driven,
    )


@dataclass(frozen=True)
class Solved:
    dynamics: SpaceDynamics

    @property
    def reactions(self) -> Reactions:
        return self.dynamics.reactions


def test_extremes_means_and_work_of_half_a_cosine() -> None:
    """Torque I a, force m r sqrt(a^2 + w^4), power I a w and work I w^2 / 2 of an angle
    A (1 - cos(p t)) / 2, though no sample is at the largest power.
    """
    angle, duration = 1.2, 0.8
    course = SpaceCourse(arm("motor"), [CosineDrive(0.0, angle, duration)], 0.0, duration)

    def solve(times: np.ndarray) -> Solved:
        return Solved(space_reactions("swing", course.at(times)))

    samples = np.linspace(0.0, duration, 8)
    over = space_over_time(course, solve, solve(samples), np.empty(0))
    p, about = math.pi / duration, INERTIA + MASS * REACH**2
    most = 0.5 * angle * p**2  # largest angular acceleration, at both ends
    (drive,) = over.drives
    assert drive.largest.value == pytest.approx(about * most, rel=1e-9)
    assert drive.mean == pytest.approx(0.0, abs=1e-9)
    assert drive.rms == pytest.approx(about * most / math.sqrt(2.0), rel=1e-6)
    assert drive.stroke == pytest.approx(angle)
    speed = 0.5 * angle * p * np.sin(p * samples)
    assert drive.work == pytest.approx(0.5 * about * speed**2, abs=1e-6)
    # sin and cos are alike at an eighth of the period.
    assert drive.power.value == pytest.approx(about * angle**2 * p**3 / 8.0, rel=1e-6)
    assert min(abs(drive.power.time - k * duration / 4.0) for k in (1, 3)) < 1e-4
    x = np.linspace(0.0, duration, 200_001)
    pull = MASS * REACH * np.hypot(most * np.cos(p * x), (0.5 * angle * p * np.sin(p * x)) ** 2)
    assert over.peaks.force["O"].value == pytest.approx(pull.max(), rel=1e-7)
    assert over.violation < 1e-12
    assert over.peaks.unresolved.size == 0


@each("by", ["motor", "strut"])
def test_what_holds_an_arm_at_rest(by: str) -> None:
    """Moments about the axis, of an arm that its motor turned, or as drawn without a drive."""
    push = 50.0 * SIDE + 7.0 * AXIS - 20.0 * ALONG
    load = [SpaceForce("arm", vector(ALONG), vector(push))]
    # From SIDE to ALONG, as drawn: the part of the strut's direction along SIDE is -1 / sqrt(2).
    expected = -50.0 if by == "motor" else 50.0 * math.sqrt(2.0)
    course = SpaceCourse(arm("motor"), [CosineDrive(0.0, 1.2, 1.0)], 0.0, 1.0)
    for motion in (held(course.at(np.zeros(1)), [by]), held_as_drawn(arm(), [by])):
        rest = space_reactions("rest", motion, load, timed=False)
        assert rest.drive[0, 0] == pytest.approx(expected)
        strut = (ALONG - SIDE) / math.sqrt(2.0) * expected * (by == "strut")
        assert -rest.reactions.forces[0, 0] == pytest.approx(-push - strut, abs=1e-9)


def test_what_cannot_hold_an_arm_is_told() -> None:
    """A rod parallel to the arm keeps its length; two locks are one too many."""
    course = SpaceCourse(arm("motor"), [CosineDrive(0.0, 1.2, 1.0)], 0.0, 1.0)
    for hold, code, words in (
        (
            ["rod"],
            "hold-free",
            "rod cannot hold the mechanism in this position: arm can still move",
        ),
        (["motor", "strut"], "hold-too-many", "2 for 1 degree"),
    ):
        with raises(LinkageError, code, words):
            held(course.at(np.zeros(1)), hold)
        with raises(LinkageError, code, words):
            held_as_drawn(arm(), hold)

"""What a linkage in space cannot be or cannot leave: what, where, and what to add."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import ConstantDrive, LinkageError, MotionBlocked, StateDrive
from loads.space.acting import SpaceForce
from loads.space.dynamics import space_reactions
from loads.space.kinds import Kind
from loads.space.linkage import JointAngle, SpaceJoint, SpaceLinkage, Vector
from loads.space.motion import space_move
from tests.loads.space.test_loops_in_space import bennett, rssr, slider_crank
from tests.support.each import each
from tests.support.errors import raises
from tests.support.mechanism.space import grounded, joint, light, unit, vector

Z: Vector = (0.0, 0.0, 1.0)
ORIGIN: Vector = (0.0, 0.0, 0.0)
NAN, INFINITE = float("nan"), float("inf")


def single(kind: Kind, axis: Vector | None = None, second: Vector | None = None) -> SpaceLinkage:
    """A body on the ground by one joint J."""
    return SpaceLinkage(
        (light("arm"),), (SpaceJoint("J", kind, "ground", "arm", ORIGIN, axis, second),)
    )


@each("axis", [ORIGIN, (1e-12, 0.0, 0.0), (NAN, 0.0, 1.0), (0.0, INFINITE, 1.0)])
def test_an_axis_that_is_no_direction(axis: Vector) -> None:
    for kind in ("revolute", "prismatic", "planar", "point-on-line"):
        with raises(LinkageError, "no-direction", "joint J", "axis", str(axis[0])):
            single(kind, axis)
    with raises(LinkageError, "no-direction", "joint J", "second_axis"):
        single("universal", Z, axis)


def test_an_axis_that_is_missing_or_not_needed() -> None:
    with raises(LinkageError, "no-direction", "joint J", "cylindrical", "needs axis"):
        single("cylindrical")
    with raises(LinkageError, "no-direction", "joint J", "needs second_axis"):
        single("universal", Z)
    with raises(LinkageError, "no-direction", "joint J", "spherical joint has no axis"):
        single("spherical", Z)


@each(
    ("second", "word"),
    [
        (Z, "parallel"),
        ((0.0, 0.0, -1.0), "parallel"),
        (unit((1.0, 0.0, 0.2)), "not at a right angle"),
    ],
)
def test_axes_of_a_universal_joint_that_make_no_cross(second: Vector, word: str) -> None:
    with raises(LinkageError, "axes-not-square", "joint J", word, "right angle to each other"):
        single("universal", Z, second)


def test_the_idle_spin_of_a_link_between_two_spherical_joints() -> None:
    """It loads nothing, but leaves the position open: the message says what to add."""
    linkage = rssr()
    ball = replace(linkage.joints[2], kind="spherical", axis=None, second_axis=None)
    joints = (*linkage.joints[:2], ball, linkage.joints[3])
    with raises(LinkageError, "underconstrained", "coupler can spin", "A", "B", "universal"):
        space_move(replace(linkage, joints=joints), [StateDrive(0.0)], np.zeros(1))


def test_a_loop_that_closes_as_drawn_alone() -> None:
    """Four hinges a millionth off Bennett's ratio, and shafts that do not meet at their joint."""
    alpha, beta, start = 0.7, 1.2, 0.9
    linkage = bennett(0.5, 0.5 * np.sin(beta) / np.sin(alpha), alpha, beta, start)
    for factor in (1.01, 1.000001):
        far = vector(factor * np.array(linkage.joints[3].at))
        joints = (*linkage.joints[:3], replace(linkage.joints[3], at=far))
        named = "only as drawn, at in = 51.5662 deg", "do not meet", "check the coordinates"
        with raises(MotionBlocked, "does-not-close", *named):
            space_move(
                replace(linkage, joints=joints), [ConstantDrive(start, 2.0, 1.0)], np.arange(2.0)
            )


def test_shafts_that_miss_their_universal_joint() -> None:
    """Only joints are said not to meet, not the angle that is driven."""
    linkage = SpaceLinkage(
        bodies=(light("input"), light("output")),
        joints=(
            grounded("I", "revolute", "input", (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
            joint("U", "universal", "input", "output", ORIGIN, Z, (0.0, 1.0, 0.0)),
            grounded("E", "revolute", "output", (1.0, 0.01, 0.0), (1.0, 0.3, 0.0)),
        ),
        measured=(JointAngle("turn", "I"),),
        driven=("turn",),
    )
    with pytest.raises(MotionBlocked) as caught:
        space_move(linkage, [ConstantDrive(0.0, 1.0, 1.0)], np.arange(2.0))
    assert caught.value.code == "does-not-close"
    assert set(caught.value.connections) <= {"I", "U", "E"}
    assert caught.value.connections


def test_more_drives_than_freedoms() -> None:
    linkage = replace(rssr(), driven=("in", "out"))
    with raises(LinkageError, "too-many-drives", "in, out", "remove one"):
        space_move(linkage, [StateDrive(0.0)] * 2, np.zeros(1))


def test_no_drive_and_a_body_that_hangs_on_nothing() -> None:
    with raises(LinkageError, "underconstrained", "no drive", "crank, coupler, rocker"):
        space_move(replace(rssr(), driven=()), [], np.zeros(1))
    floating = replace(rssr(), bodies=(*rssr().bodies, light("balloon")))
    with raises(LinkageError, "underconstrained", "6 degree", "balloon"):
        space_move(floating, [StateDrive(0.0)], np.zeros(1))


def test_a_redundancy_that_nothing_resolves() -> None:
    """A body clamped twice at one point, where no link has any give."""
    clamped = SpaceLinkage(
        bodies=(light("plate"),),
        joints=(grounded("F", "fixed", "plate", ORIGIN), grounded("G", "fixed", "plate", ORIGIN)),
    )
    motion = space_move(clamped, [], np.zeros(1))
    with raises(LinkageError, "sharing-incomplete", "F, G", "sharing"):
        space_reactions("clamp", motion, [SpaceForce("plate", ORIGIN, (1.0, 0.0, 0.0))])


def test_hinges_that_share_by_stiffness_give_their_range() -> None:
    """Bennett's linkage is threefold redundant: no stiffness is stated, so that of each link is
    varied; what the loads need stays the same.
    """
    linkage = bennett(0.5, 0.5 * np.sin(1.2) / np.sin(0.7), 0.7, 1.2, 0.9)
    motion = space_move(linkage, [StateDrive(0.9)], np.zeros(1))
    load = SpaceForce("coupler", linkage.bodies[1].centre, (10.0, 20.0, 30.0))
    found = space_reactions("load", motion, [load])
    assert found.shared == ("J0", "J1", "J2", "J3")
    varied = {text.split()[0] for text in found.range}
    assert varied == {"crank", "coupler", "rocker", "all"}
    several = [found.reactions, *found.range.values()]
    spread = np.ptp([r.forces for r in several], axis=0)
    assert spread.max() > 1e-3
    for r in several:  # the ground bears the load however it is shared
        total = r.force("J0")[0] + r.force("J3")[0]
        assert total == pytest.approx([10.0, 20.0, 30.0], abs=1e-9)


# --- positions that block the motion ----------------------------------------------------------


def test_a_dead_point_on_the_way() -> None:
    """A slider pulled beyond the reach of its crank: where crank and rod are in line with it."""
    r, (x, y, z) = 0.2, (0.8, 0.1, 0.3)
    linkage = replace(slider_crank(r, (x, y, z)), driven=("travel",))
    reach = np.sqrt((r + np.sqrt(x * x + y * y)) ** 2 - y * y) - r - x
    with pytest.raises(MotionBlocked) as caught:
        space_move(linkage, [ConstantDrive(0.0, 0.1, 1.0)], np.arange(2.0))
    assert caught.value.code == "dead-point"
    assert caught.value.reached[0] == pytest.approx(reach, rel=1e-3)
    assert set(caught.value.bodies) == {"crank", "rod"}


def in_line(driven: str) -> SpaceLinkage:
    """A slider-crank drawn with its crank in line with its rod."""
    a, b = (0.2, 0.0, 0.0), (1.0, 0.0, 0.0)
    linkage = slider_crank(0.2, (0.8, 0.0, 0.0))
    assert [j.at for j in linkage.joints] == [ORIGIN, a, b, b]
    return replace(linkage, driven=(driven,))


def test_a_dead_point_as_drawn() -> None:
    with raises(LinkageError, "dead-point", "travel", "crank, rod", "draw it in another position"):
        space_move(in_line("travel"), [ConstantDrive(0.0, -0.1, 1.0)], np.arange(2.0))
    motion = space_move(in_line("turn"), [ConstantDrive(0.0, 1.0, 1.0)], np.arange(2.0))
    travel = 0.2 * np.cos(1.0) + np.sqrt(0.8**2 - (0.2 * np.sin(1.0)) ** 2) - 1.0
    assert motion.coordinate("travel")[0][1] == pytest.approx(travel, abs=1e-12)


def parallel_cranks(start: float) -> SpaceLinkage:
    """Two cranks of 1 m about z, 2 m apart, and a coupler with a spherical and a universal end."""
    p = (float(np.cos(start)), float(np.sin(start)), 0.0)
    q = (2.0 + p[0], p[1], 0.0)
    return SpaceLinkage(
        bodies=(light("first", p), light("coupler", p), light("second", q)),
        joints=(
            grounded("O", "revolute", "first", ORIGIN, Z),
            joint("A", "spherical", "first", "coupler", p),
            joint("B", "universal", "second", "coupler", q, Z, (0.0, 1.0, 0.0)),
            grounded("D", "revolute", "second", (2.0, 0.0, 0.0), Z),
        ),
        measured=(JointAngle("turn", "O", start),),
        driven=("turn",),
    )


def test_a_change_point_on_the_way_and_as_drawn() -> None:
    with pytest.raises(MotionBlocked) as caught:
        space_move(parallel_cranks(0.5), [ConstantDrive(0.5, 3.5, 1.0)], np.arange(2.0))
    assert caught.value.code == "change-point"
    assert caught.value.reached[0] == pytest.approx(np.pi, abs=1e-3)
    assert set(caught.value.bodies) == {"coupler", "second"}
    with raises(LinkageError, "change-point", "coupler, second", "draw it in another position"):
        space_move(parallel_cranks(0.0), [ConstantDrive(0.0, 1.0, 1.0)], np.arange(2.0))

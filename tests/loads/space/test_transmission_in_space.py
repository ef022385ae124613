"""Transmission angles in space against statics, geometry and those of a linkage in a plane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import ConstantDrive, StateDrive, move
from loads.motion.transmission_angles import transmission_angles
from loads.space.acting import SpaceForce
from loads.space.dynamics import space_reactions
from loads.space.linkage import JointAngle, SpaceLinkage, Vector
from loads.space.motion import space_move
from loads.space.transmission import transmission_angles_in_space
from tests.loads.space.test_loops_in_space import bennett
from tests.support.each import each
from tests.support.mechanism.lift import lift
from tests.support.mechanism.mechanisms import four_bar
from tests.support.mechanism.space import about, grounded, joint, light, vector

# Cranks about the first two, with a rod between their balls.
INPUT, OUTPUT = (0.2, 0.1, 1.0), (0.9, 0.3, -0.2)
HOME: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (0.6, 0.2, 0.1))
BALLS: tuple[Vector, Vector] = ((0.12, 0.03, 0.05), (0.55, 0.45, 0.3))


def rssr(cross: bool = True, floating: bool = False) -> SpaceLinkage:
    """Two cranks about skew axes and a rod with a ball at one end, a cross or ball at the other.

    floating: with the rod's first pin a body of its own, fixed to the input.
    """
    middle = vector(0.5 * np.add(*BALLS))
    e = np.subtract(BALLS[1], BALLS[0])
    first = np.cross(e, (0.0, 0.0, 1.0))
    axes = (vector(first), vector(np.cross(e, first)))
    base = "pin" if floating else "input"
    bodies = [light("input", BALLS[0]), light("rod", middle), light("output", BALLS[1])]
    joints = [
        grounded("I", "revolute", "input", HOME[0], INPUT),
        joint("A", "universal", base, "rod", BALLS[0], *axes)
        if cross
        else joint("A", "revolute", base, "rod", BALLS[0], axes[1]),
        joint("B", "spherical", "rod", "output", BALLS[1]),
        grounded("O", "revolute", "output", HOME[1], OUTPUT),
    ]
    if floating:
        bodies.append(light("pin", BALLS[0]))
        joints.append(joint("A0", "fixed", "pin", "input", BALLS[0]))
    return SpaceLinkage(tuple(bodies), tuple(joints), (JointAngle("turn", "I"),), ("turn",))


@each("floating", [False, True])
def test_the_rod_of_two_cranks_is_loaded_by_statics_over_the_sine(floating: bool) -> None:
    """A couple T on the output: the rod's force is T over the arm of the ball and the sine."""
    linkage = rssr(floating=floating)
    motion = space_move(linkage, [ConstantDrive(-0.3, 0.5, 1.0)], np.linspace(0.0, 1.0, 7))
    angles = transmission_angles_in_space(motion)
    # The input is driven; the rod moves the output at its ball alone.
    assert list(angles) == [("rod", "B")]
    axis = np.array(OUTPUT) / np.linalg.norm(OUTPUT)
    arm = np.linalg.norm(np.cross(axis, np.subtract(BALLS[1], HOME[1])))
    load = SpaceForce("output", BALLS[1], couple=vector(7.0 * axis))
    found = space_reactions("couple", motion, [load]).reactions
    force = np.linalg.norm(found.forces[:, found.connections.index("B")], axis=1)
    assert np.sin(angles["rod", "B"]) == pytest.approx(7.0 / (arm * force), rel=1e-9)


def test_it_is_zero_where_the_rod_is_square_to_the_path_of_its_ball() -> None:
    """Geometry alone: at the dead point of the output's ball the angle falls to 0."""
    linkage = rssr()
    times = np.linspace(0.0, 1.0, 41)
    motion = space_move(linkage, [ConstantDrive(-0.3, 0.5, 1.0)], times)
    angles = transmission_angles_in_space(motion)["rod", "B"]
    out = motion.coordinate("turn")[0]
    first = about(INPUT, HOME[0], out, BALLS[0])
    second = motion.place("output", BALLS[1])
    path = np.cross(OUTPUT, second - HOME[1])
    rod = second - first
    cosine = np.sum(rod * path, axis=1) / np.linalg.norm(rod, axis=1) / np.linalg.norm(path, axis=1)
    assert angles == pytest.approx(0.5 * np.pi - np.arccos(np.abs(cosine)), abs=1e-9)


def test_between_a_pin_and_a_ball_the_best_force_decides() -> None:
    """Whatever loads the output, which turns and slides, the force at the ball is at most that near
    to the path of the ball, and for one load it is.
    """
    linkage = rssr(cross=False)
    slides = grounded("O", "cylindrical", "output", HOME[1], OUTPUT)
    linkage = replace(linkage, joints=(*linkage.joints[:3], slides))
    motion = space_move(linkage, [StateDrive(0.1, 1.0)], np.zeros(1))
    (angle,) = transmission_angles_in_space(motion)["rod", "B"]
    path = motion.point("rod", BALLS[1])[1][0]
    axis = np.array(OUTPUT) / np.linalg.norm(OUTPUT)
    near = []
    for mix in np.linspace(0.0, np.pi, 200):
        force, couple = vector(np.cos(mix) * axis), vector(0.2 * np.sin(mix) * axis)
        load = SpaceForce("output", HOME[1], force, couple)
        found = space_reactions("mix", motion, [load]).reactions
        rod = found.forces[0, found.connections.index("B")]
        near.append(abs(rod @ path) / np.linalg.norm(rod) / np.linalg.norm(path))
    assert max(near) == pytest.approx(np.sin(angle), rel=1e-3)
    assert max(near) < np.sin(angle) + 1e-9


def test_a_lifted_four_bar_keeps_its_angle() -> None:
    planar = four_bar()
    times = np.linspace(0.0, 1.0, 25)
    law = ConstantDrive(0.9, 7.0, 1.0)
    lifted, _ = lift(planar)
    ours = transmission_angles_in_space(space_move(lifted, [law], times))
    (theirs,) = transmission_angles(move(planar, [law], times)).values()
    assert list(ours) == [("coupler", "B4")]
    assert ours["coupler", "B4"] == pytest.approx(theirs, abs=1e-9)


def test_a_ball_at_the_near_end_leaves_the_angle_at_the_pin() -> None:
    """A folding stay: its lower half hangs in a ball on the leg and drives the upper at a pin."""
    planar = four_bar()
    lifted, _ = lift(planar)
    joints = tuple(
        replace(j, kind="spherical", axis=None) if j.name == "A3" else j for j in lifted.joints
    )
    times = np.linspace(0.0, 1.0, 25)
    law = ConstantDrive(0.9, 7.0, 1.0)
    hung = space_move(replace(lifted, joints=joints), [law], times)
    (theirs,) = transmission_angles(move(planar, [law], times)).values()
    assert transmission_angles_in_space(hung)["coupler", "B4"] == pytest.approx(theirs, abs=1e-9)


def test_a_bennett_linkage_has_no_line_of_force() -> None:
    """Between skew pins a link carries a bundle of wrenches, none of which decides."""
    linkage = bennett(0.5, 0.5 * np.sin(1.2) / np.sin(0.7), 0.7, 1.2, 0.6)
    motion = space_move(linkage, [StateDrive(0.6)], np.zeros(1))
    assert transmission_angles_in_space(motion) == {}

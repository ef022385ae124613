"""Teeth in space: spur, helical and bevel gears and racks, by moments about their shafts."""

from __future__ import annotations

import math

import numpy as np
import pytest

from loads import GROUND, LinkageError, StateDrive
from loads.space.acting import SpaceForce
from loads.space.dynamics import SpaceDynamics, space_reactions
from loads.space.gears import (
    Flanks,
    GearWheel,
    Mesh,
    axes_distance,
    gears_in_space,
    rack_in_space,
    vector,
)
from loads.space.linkage import JointAngle, RigidBody, SpaceJoint, SpaceLinkage
from loads.space.motion import space_move
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.errors import raises

UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
PHI, TORQUE = math.radians(20.0), 12.0
TURN = np.linalg.qr(np.random.default_rng(5).standard_normal((3, 3)))[0]
TURN = TURN * np.linalg.det(TURN)  # the axes of the drawing, in no direction of the world's


def wheel(body: str, at: tuple[float, ...], axis: tuple[float, ...]) -> GearWheel:
    along = TURN @ np.array(axis) / np.linalg.norm(axis)
    return GearWheel(body, vector(TURN @ np.array(at)), along)


def at_rest(mesh: Mesh, first: GearWheel, second: SpaceJoint | GearWheel) -> SpaceDynamics:
    """A couple on the first gear, held by what drives the second body."""
    joints = [
        SpaceJoint(w.body, "revolute", GROUND, w.body, w.centre, vector(w.axis))
        if isinstance(w, GearWheel) else w
        for w in (first, second)
    ]  # fmt: skip
    measured, ratio = mesh
    held = JointAngle("held", joints[1].name)
    measured = measured if isinstance(second, SpaceJoint) else (*measured, held)
    driven = measured[1].name if isinstance(second, SpaceJoint) else "held"
    bodies = tuple(RigidBody(j.moving, 1.0, j.at, UNIT) for j in joints)
    linkage = SpaceLinkage(bodies, tuple(joints), measured, (driven,), ratios=(ratio,))
    motion = space_move(linkage, [StateDrive(0.0)], np.zeros(1))
    load = SpaceForce(first.body, first.centre, couple=vector(TORQUE * first.axis))
    return space_reactions("rest", motion, [load], timed=False)


def drawn(vectors: Floats) -> Floats:
    """Components along the axes of the drawing."""
    return np.asarray(vectors @ TURN)


@each("psi", [0.0, 25.0, -15.0])
@each(("radii", "other"), [((0.02, 0.05), 0.07), ((-0.09, 0.03), 0.06), ((0.03, -0.09), -0.06)])
def test_gears_of_parallel_shafts(radii: tuple[float, float], other: float, psi: float) -> None:
    """External and internal ones: W_t = T / r, W_r = W_t tan(phi) / cos(psi), W_a = W_t tan(psi)
    (Shigley, 13-14 and 13-16), and moments about the shaft of the second.
    """
    first, second = wheel("a", (0, 0, 0.1), (0, 0, 1)), wheel("b", (other, 0, 0.3), (0, 0, 1))
    helix = math.radians(psi)
    mesh = gears_in_space("g", (first, second), GROUND, radii, None, Flanks(PHI, helix))
    found = at_rest(mesh, first, second)
    on_second = drawn(found.reactions.forces[0, 2])
    # From the first centre to the pitch point: that of a ring is on its centre's other side.
    at = math.copysign(radii[0], -other if radii[1] < 0.0 else other)
    tangential = TORQUE / at
    apart = abs(tangential) * math.tan(PHI) / math.cos(helix)
    outwards = math.copysign(apart, -at if radii[0] < 0.0 else at)  # a ring pushes inwards
    assert on_second[:2] == pytest.approx([outwards, tangential])
    assert abs(on_second[2]) == pytest.approx(abs(tangential * math.tan(helix)), abs=1e-9)
    # About the second shaft, which the drive holds: from the pitch point alone.
    assert found.drive[0, 0] == pytest.approx(-(at - other) * tangential)
    bearing = drawn(found.reactions.forces[0, :2])
    np.testing.assert_allclose(bearing, [-on_second, on_second], atol=1e-9)


def test_axes_have_a_distance_where_they_are_parallel() -> None:
    first, askew = wheel("a", (0, 0, 0.1), (0, 0, 1)), wheel("b", (1, 0, 0), (0, 1, 1))
    assert axes_distance(first, wheel("b", (0.3, 0.4, 7.0), (0, 0, -1))) == pytest.approx(0.5)
    assert axes_distance(first, askew) is None


@each("by", ["radius", "point"])
@each("shaft", [90.0, 55.0, 115.0])
def test_bevel_gears_by_their_pitch_cones(shaft: float, by: str) -> None:
    """W_r = W_t tan(phi) cos(gamma) and W_a = W_t tan(phi) sin(gamma) of the pinion (Shigley,
    13-38), with tan(gamma) = sin(sigma) / (N2 / N1 + cos(sigma)).
    """
    sigma, teeth, radius = math.radians(shaft), (17.0, 29.0), 0.04
    first = wheel("a", (0, 0, 0.2), (0, 0, 1))
    second = wheel("b", (0.3 * math.sin(sigma), 0, 0.3 * math.cos(sigma)),
                   (-math.sin(sigma), 0, -math.cos(sigma)))  # fmt: skip
    gamma = math.atan2(math.sin(sigma), teeth[1] / teeth[0] + math.cos(sigma))
    pitch = radius / math.sin(gamma) * np.array([math.sin(gamma), 0.0, math.cos(gamma)])
    size, at = (radius, None) if by == "radius" else (None, vector(TURN @ pitch))
    mesh = gears_in_space("g", (first, second), GROUND, teeth, size, Flanks(PHI), at)
    found = at_rest(mesh, first, second)
    on_second = drawn(found.reactions.forces[0, 2])
    tangential = TORQUE / radius
    radial, axial = (tangential * math.tan(PHI) * f(gamma) for f in (math.cos, math.sin))
    assert on_second == pytest.approx([radial, tangential, -axial], abs=1e-9 * tangential)
    assert abs(found.drive[0, 0]) == pytest.approx(TORQUE * teeth[1] / teeth[0])


@each("side", [1.0, -1.0])
def test_a_pinion_drives_a_rack(side: float) -> None:
    """The rack is pushed by T / r along its joint and by tan(phi) of that away from the pinion."""
    pinion, radius = wheel("a", (0, 0, 0), (0, 0, 1)), 0.05
    along = TURN @ np.array([1.0, 0.0, 0.0])
    slide = SpaceJoint("b", "prismatic", GROUND, "b", vector(TURN @ np.array([0, side * 0.1, 0])),
                       vector(along))  # fmt: skip
    mesh = rack_in_space("g", pinion, ("b", "b", along), GROUND, side * radius, Flanks(PHI),
                         vector(TURN @ np.array([0.0, 0.0, 0.02])))  # fmt: skip
    found = at_rest(mesh, pinion, slide)
    push = -side * TORQUE / radius  # left of the joint's direction, a turn about +z pushes to -x
    on_rack = drawn(found.reactions.forces[0, 2])
    expected = [push, side * abs(push) * math.tan(PHI), 0.0]
    assert on_rack == pytest.approx(expected, abs=1e-9)
    assert found.drive[0, 0] == pytest.approx(-push)


Z, X = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)


@each(
    ("second", "sizes", "radius", "at", "code", "words"),
    [
        (("b", (0, 0, 1), Z), (1.0, 2.0), None, None, "gears-apart", "axes coincide"),
        (("b", (0.2, 0, 0), Z), (-1.0, 1.0), None, None, "gears-apart", "ring and gear are equal"),
        (("b", (0.2, 0.1, 0), X), (1.0, 2.0), 0.1, None, "skew-gears", "pass each other 0.1 m"),
        (("b", (0.2, 0, 0), X), (-3.0, 2.0), 0.1, None, "gears-apart", "remove internal"),
        (("b", (0.2, 0, 0), X), (1.0, 2.0), None, None, "missing-key", "size of its pitch cones"),
        (("b", (0, 0, 0), X), (1.0, 2.0), 0.1, None, "missing-key", "joint of b"),
    ],
)
def test_gears_that_do_not_mesh_are_refused(
    second: tuple[str, tuple[float, ...], tuple[float, ...]],
    sizes: tuple[float, float],
    radius: float | None,
    at: None,
    code: str,
    words: str,
) -> None:
    first = wheel("a", (0, 0, 0.1), Z)
    with raises(LinkageError, code, words):
        gears_in_space("g", (first, wheel(*second)), GROUND, sizes, radius, Flanks(PHI), at)
    with raises(LinkageError, "axes-not-square", "right angle"):
        rack_in_space("g", first, ("b", "b", first.axis), GROUND, 0.1, Flanks(PHI))

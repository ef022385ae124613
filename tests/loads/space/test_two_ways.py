"""Forces out of the plane by two formulations: a planar linkage with what acts out of its plane,
and the same as a linkage in space.
"""

import numpy as np

from loads import (
    Applied,
    Body,
    Connection,
    CosineDrive,
    Joint,
    Linkage,
    Turn,
    motion_reactions,
    move,
)
from loads.space.acting import SpaceForce
from loads.space.dynamics import space_reactions
from loads.space.linkage import JointAngle, RigidBody, SpaceJoint, SpaceLinkage
from loads.space.motion import space_move
from loads.space.out_of_plane import Links, Offsets, OutOfPlane, SideLoad

A, B, C, D = (0.0, 0.0), (0.3, 0.4), (1.2, 0.7), (1.0, 0.0)
HEIGHTS = {"A": 0.01, "B": 0.05, "C": -0.02, "D": 0.03}
TIMES = np.linspace(0.0, 1.0, 21)
LAWS = [CosineDrive(0.0, 1.0, 1.0)]


def middle(p: tuple[float, float], q: tuple[float, float]) -> tuple[float, float]:
    return 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])


BODIES = (
    Body("crank", 1.0, middle(A, B), 0.02),
    Body("coupler", 2.0, middle(B, C), 0.1),
    Body("rocker", 1.5, middle(C, D), 0.05),
)
JOINTS = (("A", A, "crank", "ground"), ("B", B, "coupler", "crank"),
          ("C", C, "rocker", "coupler"), ("D", D, "rocker", "ground"))  # fmt: skip


def planar(friction: float) -> Linkage:
    joints = [Joint(n, at, (Connection(n, body, friction),), on) for n, at, body, on in JOINTS]
    turns = (Turn("crank", "crank", 0.0),)
    return Linkage(BODIES, tuple(joints), ("crank",), turns=turns, gravity=(0.0, -9.81))


def in_space(friction: float, heights: dict[str, float]) -> SpaceLinkage:
    bodies = [
        RigidBody(
            b.name,
            b.mass,
            (*b.centre, 0.0),
            ((i / 2, 0.0, 0.0), (0.0, i / 2, 0.0), (0.0, 0.0, i)),
        )
        for b in BODIES
        if (i := b.inertia or 0.0)
    ]
    joints = [
        SpaceJoint(n, "revolute", on, body, (*at, heights[n]), (0.0, 0.0, 1.0), friction=friction)
        for n, at, body, on in JOINTS
    ]
    measured = (JointAngle("crank", "A"),)
    gravity = (0.0, -9.81, 0.0)
    return SpaceLinkage(tuple(bodies), tuple(joints), measured, ("crank",), gravity)


def test_planar_motion_with_friction_is_the_same_in_space() -> None:
    flat = motion_reactions("motion", move(planar(0.01), LAWS, TIMES))
    solid = space_reactions(
        "motion", space_move(in_space(0.01, dict.fromkeys("ABCD", 0.0)), LAWS, TIMES)
    )
    size = np.abs(flat.reactions.forces).max()
    np.testing.assert_allclose(solid.reactions.forces, flat.reactions.forces, atol=1e-12 * size)
    np.testing.assert_allclose(solid.drive, flat.drive, atol=1e-12 * np.abs(flat.drive).max())
    np.testing.assert_allclose(solid.friction, flat.pin_friction, atol=1e-12 * size)
    assert np.abs(flat.pin_friction).max() > 0.1
    assert np.abs(solid.imbalance).max() < 1e-12 * np.abs(solid.power).max()


def test_a_load_out_of_the_plane_is_shared_alike_in_both() -> None:
    at_c = Applied("coupler", C, (0.0, 0.0))
    flat = motion_reactions("motion", move(planar(0.0), LAWS, TIMES), (at_c,))
    side = SideLoad(at_c, 0.04, 100.0, (3.0, -2.0))
    heights = Offsets(HEIGHTS, {b.name: 0.0 for b in BODIES})
    expected = OutOfPlane(flat, [side], heights).reactions(Links())
    load = SpaceForce("coupler", (*C, 0.04), (0.0, 0.0, 100.0), (3.0, -2.0, 0.0))
    solid = space_reactions("motion", space_move(in_space(0.0, HEIGHTS), LAWS, TIMES), [load])
    force, moment = (np.abs(x).max() for x in (expected.forces, expected.moments))
    # Both solve normal equations of an ill-scaled energy: half of the digits.
    np.testing.assert_allclose(solid.reactions.forces, expected.forces, atol=1e-7 * force)
    np.testing.assert_allclose(solid.reactions.moments, expected.moments, atol=1e-7 * moment)
    # What nobody stated matters here: with each link stiffer or softer the split is another.
    varied = {text.split()[0] for text in solid.range}
    assert varied == {"crank", "coupler", "rocker", "all"}
    spread = [np.abs(r.moments - solid.reactions.moments).max() for r in solid.range.values()]
    assert min(spread) > 0.01 * moment

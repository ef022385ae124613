"""Forces and moments in joints against statics and rigid-body dynamics by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from loads import GROUND, ConstantDrive, CycloidalDrive, StateDrive
from loads.space.acting import SpaceForce
from loads.space.dynamics import space_reactions
from loads.space.kinds import KINDS, Conditions
from loads.space.linkage import (
    JointAngle,
    JointTravel,
    PointDistance,
    RigidBody,
    SpaceLinkage,
    Vector,
)
from loads.space.motion import space_move
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.mechanism.space import grounded, joint, light, tensor, turned, unit, vector

G = 9.81


def rows(first: Floats, *others: Floats) -> Floats:
    """Vectors (T, 3) from three components (T,) or numbers."""
    return np.stack(np.broadcast_arrays(first, *others), axis=-1)


# --- a folding stay under a side load ---------------------------------------------------------


@each(
    ("a", "h", "share", "P"),
    [(0.5, 0.3, 0.0, 13300.0), (0.96, 0.2, 0.4, -8000.0), (0.4, 0.7, 0.5, 2.0e4)],
)
def test_a_folding_stay_under_side_load(a: float, h: float, share: float, P: float) -> None:
    """Two bars A-B-C in the plane z = 0 with a hinge along z at B; the side load P along z acts
    at `share` of the way from B to C. 12 equations, 12 unknowns: a universal joint at A carries a
    moment about x alone, a spherical one at C none. The moments of both bars about A give the
    force at C, those of the second bar about B the moments across its hinge pin.
    """
    A, B, C = (0.0, 0.0, 0.0), (a, -h, 0.0), (2.0 * a, 0.0, 0.0)
    Q = (a + share * a, -h + share * h, 0.0)
    linkage = SpaceLinkage(
        bodies=(light("upper", B), light("lower", C)),
        joints=(
            grounded("A", "universal", "upper", A, (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
            joint("B", "revolute", "upper", "lower", B, (0.0, 0.0, 1.0)),
            grounded("C", "spherical", "lower", C),
        ),
    )
    motion = space_move(linkage, [], np.zeros(1))
    found = space_reactions("side", motion, [SpaceForce("lower", Q, (0.0, 0.0, P))])
    on_lower_at_C = -P * Q[0] / (2.0 * a)  # along z; moments about the y axis through A
    ux, uy = Q[0] - B[0], Q[1] - B[1]
    forces, moments = found.reactions.forces[0], found.reactions.moments[0]
    assert forces[1] == pytest.approx([0.0, 0.0, P + on_lower_at_C], abs=1e-9 * abs(P))
    hinge = [h * on_lower_at_C + uy * P, -a * on_lower_at_C - ux * P, 0.0]
    assert moments[1] == pytest.approx(hinge, abs=1e-9 * abs(P))
    assert forces[2] == pytest.approx([0.0, 0.0, -on_lower_at_C], abs=1e-9 * abs(P))
    assert forces[0] == pytest.approx([0.0, 0.0, P + on_lower_at_C], abs=1e-9 * abs(P))
    assert moments[0] == pytest.approx([P * Q[1], 0.0, 0.0], abs=1e-9 * abs(P))
    assert np.abs(moments[2]).max() < 1e-9 * abs(P)


# --- rotors -----------------------------------------------------------------------------------


def rotor(inertia: Floats, centre: Vector = (0.0, 0.0, 0.0), mass: float = 3.0) -> SpaceLinkage:
    """A rotor about z in one bearing at the origin."""
    return SpaceLinkage(
        bodies=(RigidBody("rotor", mass, centre, tensor(inertia)),),
        joints=(grounded("bearing", "revolute", "rotor", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),),
        measured=(JointAngle("turn", "bearing"),),
        driven=("turn",),
    )


def skew(polar: float, across: float, tilt: float) -> Floats:
    """Inertia of a body of revolution whose axis is tilted from z towards x."""
    e = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    return across * np.eye(3) + (polar - across) * np.outer(e, e)


@each(("polar", "across", "tilt"), [(0.08, 0.05, 0.2), (0.02, 0.3, -0.7), (0.08, 0.05, 1.3)])
def test_a_skew_rotor_beats_its_bearing(polar: float, across: float, tilt: float) -> None:
    """The couple (I1 - I2) w^2 sin cos of a disc with a tilted axis, turning with it; at rest in
    its axes; and the drive has nothing to do at constant speed.
    """
    w = 40.0
    motion = space_move(
        rotor(skew(polar, across, tilt)),
        [ConstantDrive(0.0, 0.2 * w, 0.2)],
        np.linspace(0.01, 0.19, 11),
    )
    found = space_reactions("spin", motion)
    size = (polar - across) * w**2 * np.sin(tilt) * np.cos(tilt)
    theta = w * motion.times
    on_base = -size * rows(-np.sin(theta), np.cos(theta), np.zeros_like(theta))
    assert found.reactions.moments[:, 0] == pytest.approx(on_base, abs=1e-9 * abs(size))
    assert np.abs(found.drive).max() < 1e-9 * abs(size)
    assert np.abs(found.reactions.forces).max() < 1e-9 * abs(size)


def test_an_unbalanced_rotor_while_it_starts() -> None:
    """An eccentric centre of mass and products of inertia: m e w^2, m e alpha, and the couples
    I_xz, I_yz make with w^2 and alpha, plus those of the centre's height above the bearing.
    """
    m, e, z = 3.0, 0.02, 0.15
    xz, yz, zz = 0.004, -0.003, 0.06
    inertia = np.array([[0.05, 0.001, xz], [0.001, 0.05, yz], [xz, yz, zz]])
    law = CycloidalDrive(0.0, 12.0, 1.0)
    motion = space_move(rotor(inertia, (e, 0.0, z), m), [law], np.linspace(0.1, 0.9, 9))
    found = space_reactions("start", motion)
    theta, w, alpha = law(motion.times)
    radial = rows(np.cos(theta), np.sin(theta), 0.0 * theta)
    ahead = rows(-np.sin(theta), np.cos(theta), 0.0 * theta)
    force = m * e * (-(w**2)[:, None] * radial + alpha[:, None] * ahead)
    assert found.reactions.forces[:, 0] == pytest.approx(-force, abs=1e-9 * np.abs(force).max())
    # Rate of angular momentum of a turning product of inertia, about z with x along `radial`.
    couple = (xz * alpha - yz * w**2)[:, None] * radial + (yz * alpha + xz * w**2)[:, None] * ahead
    couple = couple + np.cross([0.0, 0.0, z], force)
    on_base = -couple
    assert found.reactions.moments[:, 0] == pytest.approx(on_base, abs=1e-9 * np.abs(couple).max())
    assert found.drive[:, 0] == pytest.approx((zz + m * e**2) * alpha, rel=1e-9, abs=1e-9)


@each("tilt", [np.pi / 2, 0.5, 2.2])
def test_a_gyroscope_in_its_gimbal(tilt: float) -> None:
    """Steady precession W about z of a disc that spins with n about an axis at `tilt` from z:
    couple (I (n + W cos) - I' W cos) W sin, square to both; the weight acts besides.
    """
    spin, W, polar, across, m, arm = 300.0, 2.5, 0.03, 0.017, 4.0, 0.25
    axis = (np.sin(tilt), 0.0, np.cos(tilt))
    disc = RigidBody("disc", m, vector(arm * np.array(axis)), tensor(skew(polar, across, tilt)))
    linkage = SpaceLinkage(
        bodies=(light("gimbal"), disc),
        joints=(
            grounded("yaw", "revolute", "gimbal", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
            joint("spin", "revolute", "gimbal", "disc", (0.0, 0.0, 0.0), axis),
        ),
        measured=(JointAngle("W", "yaw"), JointAngle("n", "spin")),
        driven=("W", "n"),
        gravity=(0.0, 0.0, -G),
    )
    brief = 0.02  # s
    laws = [ConstantDrive(0.0, rate * brief, brief) for rate in (W, spin)]
    motion = space_move(linkage, laws, brief * np.linspace(0.1, 0.9, 7))
    found = space_reactions("precession", motion)
    e = turned((0.0, 0.0, 1.0), W * motion.times, axis)
    ahead = np.cross([0.0, 0.0, 1.0], e)  # of size sin
    gyroscopic = (polar * (spin + W * np.cos(tilt)) - across * W * np.cos(tilt)) * W * ahead
    acceleration = W**2 * arm * np.cross([0.0, 0.0, 1.0], ahead)
    force = m * (acceleration - np.array([0.0, 0.0, -G]))
    wanted = gyroscopic + np.cross(arm * e, force)
    size = np.abs(wanted).max()
    assert found.reactions.moments[:, 1] == pytest.approx(-wanted, abs=1e-9 * size)
    assert found.reactions.forces[:, 1] == pytest.approx(-force, abs=1e-9 * size)
    assert found.drive == pytest.approx(np.zeros_like(found.drive), abs=1e-9 * size)


# --- cylindrical and planar joints ------------------------------------------------------------


def test_a_heavy_body_on_a_cylindrical_joint() -> None:
    """A body that climbs and turns about a vertical post: its drives carry weight and rise along
    the post and the torque about it, the joint all else, about the point that moves with it.
    """
    m, r, z = 12.0, 0.4, 0.1
    inertia = np.array([[0.5, 0.0, 0.07], [0.0, 0.4, -0.05], [0.07, -0.05, 0.3]])
    body = RigidBody("arm", m, (r, 0.0, z), tensor(inertia))
    linkage = SpaceLinkage(
        bodies=(body,),
        joints=(grounded("post", "cylindrical", "arm", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),),
        measured=(JointAngle("turn", "post"), JointTravel("climb", "post")),
        driven=("turn", "climb"),
        gravity=(0.0, 0.0, -G),
    )
    laws = [CycloidalDrive(0.0, 4.0, 1.0), CycloidalDrive(0.0, 0.6, 1.0)]
    motion = space_move(linkage, laws, np.linspace(0.1, 0.9, 9))
    found = space_reactions("climb", motion)
    theta, w, alpha = laws[0](motion.times)
    rise = laws[1](motion.times)[2]
    o = 0.0 * theta
    radial, ahead = rows(np.cos(theta), np.sin(theta), o), rows(-np.sin(theta), np.cos(theta), o)
    across = m * r * (-(w**2)[:, None] * radial + alpha[:, None] * ahead)
    lift = m * (rise + G)
    assert found.drive[:, 1] == pytest.approx(lift, rel=1e-10)
    assert found.drive[:, 0] == pytest.approx((0.3 + m * r**2) * alpha, rel=1e-9, abs=1e-9)
    size = np.abs(lift).max()
    assert found.reactions.forces[:, 0] == pytest.approx(-across, abs=1e-9 * size)
    couple = (0.07 * alpha + 0.05 * w**2)[:, None] * radial
    couple = couple + (-0.05 * alpha + 0.07 * w**2)[:, None] * ahead
    couple = couple + np.cross([0.0, 0.0, z], across) - (r * lift)[:, None] * ahead
    assert found.reactions.moments[:, 0] == pytest.approx(-couple, abs=1e-9 * size)


def test_a_joint_that_travels_has_its_moment_about_the_moving_point() -> None:
    """A force across a slide, at the drawn point of the body, after it has travelled 0.4 m: no
    moment. About the point as drawn in the base it would be 0.4 m times the force.
    """
    linkage = SpaceLinkage(
        bodies=(light("slide", (0.0, 0.0, 0.0)),),
        joints=(grounded("J", "prismatic", "slide", (0.1, 0.2, 0.0), (1.0, 0.0, 0.0)),),
        measured=(JointTravel("s", "J"),),
        driven=("s",),
    )
    motion = space_move(linkage, [StateDrive(0.4)], np.zeros(1))
    push = SpaceForce("slide", (0.1, 0.2, 0.0), (0.0, 500.0, -300.0))
    found = space_reactions("slide", motion, [push]).reactions
    assert found.forces[0, 0] == pytest.approx([0.0, 500.0, -300.0])
    assert found.moments[0, 0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


def test_a_body_on_a_slope() -> None:
    """A planar joint carries the weight's part along its normal and the moment of it and of the
    part down the slope; three struts in the plane of the joint's point carry the latter.
    """
    n = np.array(unit((0.0, -0.5, 1.0)))
    u = np.array([1.0, 0.0, 0.0])
    v = np.cross(n, u)

    def at(x: float, y: float, z: float = 0.0) -> Vector:
        return vector(x * u + y * v + z * n)

    m, centre = 25.0, (0.3, 0.2, 0.15)
    ends = {"s1": ((0.0, -0.5), (0.0, 0.0)), "s2": ((0.6, -0.5), (0.6, 0.0))}
    ends["s3"] = ((-0.8, 0.1), (0.0, 0.1))
    spans = tuple(
        PointDistance(k, (GROUND, "body"), (at(*p), at(*q))) for k, (p, q) in ends.items()
    )
    linkage = SpaceLinkage(
        bodies=(RigidBody("body", m, at(*centre), tensor(np.eye(3))),),
        joints=(grounded("slope", "planar", "body", (0.0, 0.0, 0.0), vector(n)),),
        measured=spans,
        driven=tuple(ends),
        gravity=(0.0, 0.0, -G),
    )
    motion = space_move(linkage, [StateDrive(s.drawn) for s in spans], np.zeros(1))
    found = space_reactions("slope", motion)
    weight = np.array([0.0, 0.0, -m * G])
    normal, down = float(weight @ n), float(weight @ v)
    assert found.reactions.forces[0, 0] == pytest.approx(normal * n, abs=1e-9 * m * G)
    moment = np.cross(centre[0] * u + centre[1] * v, normal * n)
    moment = moment + np.cross(centre[2] * n, down * v)
    assert found.reactions.moments[0, 0] == pytest.approx(moment, abs=1e-9 * m * G)
    # Struts: s1 and s2 hold the part down the slope at x = 0 and 0.6, s3 none of it.
    wanted = [-down * (1.0 - 0.3 / 0.6), -down * 0.3 / 0.6, 0.0]
    assert found.drive[0] == pytest.approx(wanted, abs=1e-9 * m * G)


def test_a_new_kind_of_joint_is_one_more_row(monkeypatch: pytest.MonkeyPatch) -> None:
    """A ball on a tilted plane pushes along the normal alone: on a post that may turn and climb, a
    body's weight W needs W / n_z, and the post carries its part across.
    """
    new: Any = "point-on-plane"
    monkeypatch.setitem(KINDS, new, Conditions(along=("w",), axes=1))
    n, weight, foot = np.array(unit((0.3, -0.2, 1.0))), 120.0, (0.4, 0.1, -0.2)
    linkage = SpaceLinkage(
        bodies=(light("table", (0.0, 0.0, 0.0)),),
        joints=(
            grounded("post", "cylindrical", "table", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
            grounded("foot", new, "table", foot, vector(n)),
        ),
        measured=(JointAngle("turn", "post"),),
        driven=("turn",),
    )
    motion = space_move(linkage, [StateDrive(0.6)], np.zeros(1))
    assert motion.mobility.kutzbach == 1
    load = SpaceForce("table", (0.0, 0.0, 0.0), (0.0, 0.0, -weight))
    found = space_reactions("rest", motion, [load])
    at = motion.point("table", foot)[0][0]
    assert n @ np.subtract(at, foot) == pytest.approx(0.0, abs=1e-12)
    push = found.reactions.force("foot")[0]  # of the table on the plane
    assert push == pytest.approx(-weight / n[2] * n)
    across = found.reactions.force("post")[0]
    assert across == pytest.approx(weight / n[2] * np.array([n[0], n[1], 0.0]))
    turning = np.cross(at, -push)[2]
    assert found.drive[0, 0] == pytest.approx(-turning)

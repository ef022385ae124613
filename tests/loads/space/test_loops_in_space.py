"""Closed loops in space against their input-output equations and virtual work."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.space.bodies import bennett_frames
from loads import ConstantDrive, StateDrive
from loads.space.acting import SpaceForce
from loads.space.dynamics import space_reactions
from loads.space.linkage import JointAngle, JointTravel, SpaceLinkage, Vector
from loads.space.motion import space_move
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.mechanism.space import about, grounded, joint, light, turned, unit, vector

ROUND_OFF = 1e-10  # of the largest value: equations of condition below 1e4


def bennett(a: float, b: float, alpha: float, beta: float, angle: float) -> SpaceLinkage:
    """Four links with hinges alone, a and b of twists alpha and beta; the ground is a link b."""
    points, axes = bennett_frames(a, b, alpha, beta, angle)
    p, w = [vector(x) for x in points], [vector(x) for x in axes]
    return SpaceLinkage(
        bodies=(light("crank", p[1]), light("coupler", p[2]), light("rocker", p[3])),
        joints=(
            grounded("J0", "revolute", "crank", p[0], w[0]),
            joint("J1", "revolute", "crank", "coupler", p[1], w[1]),
            joint("J2", "revolute", "coupler", "rocker", p[2], w[2]),
            grounded("J3", "revolute", "rocker", p[3], w[3]),
        ),
        measured=(JointAngle("in", "J0", angle), JointAngle("out", "J3")),
        driven=("in",),
    )


@each(("alpha", "beta"), [(0.7, 1.2), (0.3, 2.0), (-1.1, -0.6)])
def test_bennett_turns_fully_by_its_ratio(alpha: float, beta: float) -> None:
    """Overconstrained by Kutzbach to -2, it moves: tan(in / 2) tan(out / 2) is constant."""
    a, start = 0.5, 0.6
    linkage = bennett(a, a * np.sin(beta) / np.sin(alpha), alpha, beta, start)
    motion = space_move(
        linkage, [ConstantDrive(start, start + 2.0 * np.pi, 1.0)], np.linspace(0.0, 1.0, 41)
    )
    theta, rate, _ = motion.coordinate("in")
    out, out_rate, _ = motion.coordinate("out")
    ratio = np.sin(0.5 * (beta + alpha)) / np.sin(0.5 * (beta - alpha))

    def other(angle: Floats) -> Floats:
        return np.asarray(2.0 * np.arctan2(ratio * np.cos(0.5 * angle), np.sin(0.5 * angle)))

    wanted = other(theta) - other(np.array([start]))
    assert np.exp(1j * out) == pytest.approx(np.exp(1j * wanted), abs=ROUND_OFF)
    slope = -ratio / (np.sin(0.5 * theta) ** 2 + (ratio * np.cos(0.5 * theta)) ** 2)
    assert out_rate == pytest.approx(slope * rate, rel=1e-9)


def test_bennett_transmits_a_couple_by_virtual_work() -> None:
    """However its redundant hinges share, the drive's torque follows from the ratio."""
    alpha, beta, start = 0.7, 1.2, 0.9
    linkage = bennett(0.5, 0.5 * np.sin(beta) / np.sin(alpha), alpha, beta, start)
    axis = np.array(linkage.joint("J3").axis)
    motion = space_move(linkage, [StateDrive(start)], np.zeros(1))
    load = SpaceForce("rocker", linkage.bodies[2].centre, couple=vector(70.0 * axis))
    torque = space_reactions("couple", motion, [load]).drive[0, 0]
    ratio = np.sin(0.5 * (beta + alpha)) / np.sin(0.5 * (beta - alpha))
    slope = -ratio / (np.sin(0.5 * start) ** 2 + (ratio * np.cos(0.5 * start)) ** 2)
    assert torque == pytest.approx(-70.0 * slope, rel=1e-9)


# --- Hooke's joint ----------------------------------------------------------------------------


def hooke(beta: float, start: float = 0.0) -> tuple[SpaceLinkage, Floats]:
    """Shafts that cross at angle beta, drawn with the first one turned by `start` about x; and the
    direction of the second.
    """
    out = np.array([np.cos(beta), np.sin(beta), 0.0])
    phi = np.arctan2(np.cos(beta) * np.sin(start), np.cos(start))
    cross = vector(turned((1.0, 0.0, 0.0), start, (0.0, 0.0, 1.0))[0])
    other = vector(turned(vector(out), phi, (-np.sin(beta), np.cos(beta), 0.0))[0])
    linkage = SpaceLinkage(
        bodies=(light("input", (-0.2, 0.0, 0.0)), light("output", vector(0.3 * out))),
        joints=(
            grounded("I", "revolute", "input", (-0.4, 0.0, 0.0), (1.0, 0.0, 0.0)),
            joint("U", "universal", "input", "output", (0.0, 0.0, 0.0), cross, other),
            grounded("E", "point-on-line", "output", vector(0.6 * out), vector(out)),
        ),
        measured=(JointAngle("turn", "I", start),),
        driven=("turn",),
    )
    return linkage, out


@each("beta", [0.1, 0.6, 1.2])
def test_hookes_joint_turns_unevenly(beta: float) -> None:
    """Speed ratio cos b / (1 - sin^2 b sin^2 theta) (theta 0: cross axis normal)."""
    linkage, out = hooke(beta)
    motion = space_move(linkage, [ConstantDrive(0.0, 7.0, 1.0)], np.linspace(0.01, 0.99, 30))
    theta, rate, _ = motion.coordinate("turn")
    ratio = np.cos(beta) / (1.0 - (np.sin(beta) * np.sin(theta)) ** 2)
    assert motion.spin("output") @ out == pytest.approx(ratio * rate, rel=1e-10)
    slope = 2.0 * np.cos(beta) * np.sin(beta) ** 2 * np.sin(theta) * np.cos(theta)
    rising = slope / (1.0 - (np.sin(beta) * np.sin(theta)) ** 2) ** 2 * rate**2
    assert motion.spin_rate("output") @ out == pytest.approx(
        rising, abs=1e-9 * np.abs(rising).max()
    )
    moved = np.cross(motion.spin("output"), out)
    assert np.abs(moved).max() < 1e-9  # it turns about its own axis alone


@each(("beta", "theta"), [(0.3, 0.0), (0.3, 1.1), (0.9, 0.4), (0.9, np.pi / 2), (1.2, -2.0)])
def test_hookes_joint_transmits_a_couple_square_to_its_cross(beta: float, theta: float) -> None:
    """A torque T on the output: the joint's couple is along the normal of its cross, and so bends
    both shafts; the guide carries the bending of the second.
    """
    linkage, out = hooke(beta)
    T = 250.0
    motion = space_move(linkage, [ConstantDrive(0.0, theta, 1.0)], np.array([0.0, 1.0]))
    load = SpaceForce("output", (0.0, 0.0, 0.0), couple=vector(T * out))
    found = space_reactions("torque", motion, [load])
    phi = np.arctan2(np.cos(beta) * np.sin(theta), np.cos(theta))
    p = turned((1.0, 0.0, 0.0), theta, (0.0, 0.0, 1.0))[0]
    q = turned(vector(out), phi, (-np.sin(beta), np.cos(beta), 0.0))[0]
    n = np.cross(p, q)
    couple = T / (n @ out) * n
    on_input, force = found.reactions.moments[-1, 1], found.reactions.force("E")[-1]
    assert on_input == pytest.approx(couple, abs=1e-9 * T)
    # 0.6 out x (force on the output at E) balances what of the couples is square to the shaft.
    assert np.cross(0.6 * out, -force) == pytest.approx(couple - T * out, abs=1e-9 * T)
    ratio = np.cos(beta) / (1.0 - (np.sin(beta) * np.sin(theta)) ** 2)
    assert found.drive[-1, 0] == pytest.approx(-T * ratio, rel=1e-9)


# --- RSSR and slider-crank --------------------------------------------------------------------

CRANK: tuple[Vector, Vector] = (0.2, 1.0, 0.1), (0.0, 0.1, 0.2)  # axis and a point on it
ROCKER: tuple[Vector, Vector] = (0.3, 0.1, 1.0), (1.0, 0.2, 0.1)
A: Vector = (0.25, 0.1, 0.35)
B: Vector = (0.9, 0.75, 0.3)


def rssr() -> SpaceLinkage:
    """A four-bar in space with a massless coupler, whose spin a universal joint prevents."""
    first = unit((0.0, 0.3, 1.0))
    second = unit(vector(np.cross(first, (1.0, 0.2, 0.3))))
    return SpaceLinkage(
        bodies=(light("crank", A), light("coupler", A), light("rocker", B)),
        joints=(
            grounded("O", "revolute", "crank", CRANK[1], CRANK[0]),
            joint("A", "spherical", "crank", "coupler", A),
            joint("B", "universal", "rocker", "coupler", B, first, second),
            grounded("D", "revolute", "rocker", ROCKER[1], ROCKER[0]),
        ),
        measured=(JointAngle("in", "O"), JointAngle("out", "D")),
        driven=("in",),
    )


def rssr_output(theta: Floats) -> Floats:
    """Angle of the rocker: E cos psi + F sin psi = G from the coupler's constant length, the root
    that is 0 at theta = 0 followed by continuity.
    """
    e, d = np.array(unit(ROCKER[0])), np.array(ROCKER[1])
    arm = np.subtract(B, d)
    along, across = e * (e @ arm), arm - e * (e @ arm)
    length = float(np.linalg.norm(np.subtract(B, A)))
    a = about(CRANK[0], CRANK[1], theta, A) - d - along  # B - A = across(psi) - a
    E, F = a @ across, a @ np.cross(e, across)
    G = 0.5 * (np.sum(a**2, axis=1) + across @ across - length**2)
    middle, half = np.arctan2(F, E), np.arccos(G / np.hypot(E, F))
    a0 = np.array(A) - d - along
    sign = -1.0 if np.arctan2(a0 @ np.cross(e, across), a0 @ across) > 0.0 else 1.0
    return np.asarray(middle + sign * half)


def test_rssr_follows_its_input_output_equation() -> None:
    motion = space_move(rssr(), [ConstantDrive(0.0, 1.4, 1.0)], np.linspace(0.0, 1.0, 30))
    theta, psi = motion.coordinate("in")[0], motion.coordinate("out")[0]
    assert rssr_output(np.zeros(1))[0] == pytest.approx(0.0, abs=1e-12)
    assert psi == pytest.approx(rssr_output(theta), abs=1e-11)


def test_the_coupler_of_an_rssr_is_a_two_force_member() -> None:
    """A couple on the rocker: the coupler's force is along it, its size by the rocker's balance,
    the drive's torque by the crank's; the universal joint carries no couple.
    """
    M = 35.0
    e = np.array(unit(ROCKER[0]))
    motion = space_move(rssr(), [ConstantDrive(0.0, 1.0, 1.0)], np.linspace(0.0, 1.0, 7))
    found = space_reactions("couple", motion, [SpaceForce("rocker", B, couple=vector(M * e))])
    theta = motion.coordinate("in")[0]
    a = about(CRANK[0], CRANK[1], theta, A)
    b = about(ROCKER[0], ROCKER[1], rssr_output(theta), B)
    line = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    # Force size n along a -> b on the rocker balances M about its axis.
    n = -M / (np.cross(b - np.array(ROCKER[1]), line) @ e)
    assert found.reactions.force("B") == pytest.approx(n[:, None] * line, rel=1e-9, abs=1e-8)
    assert found.reactions.force("A") == pytest.approx(-n[:, None] * line, rel=1e-9, abs=1e-8)
    assert np.abs(found.reactions.moments[:, 2]).max() < 1e-8 * M
    k = np.array(unit(CRANK[0]))
    on_crank = np.cross(a - np.array(CRANK[1]), -n[:, None] * line) @ k
    assert found.drive[:, 0] == pytest.approx(-on_crank, rel=1e-9)


def slider_crank(r: float, offset: Vector) -> SpaceLinkage:
    """A crank about z and a slider along x whose line is offset in y and z."""
    a: Vector = (r, 0.0, 0.0)
    b: Vector = (r + offset[0], offset[1], offset[2])
    return SpaceLinkage(
        bodies=(light("crank", a), light("rod", a), light("slider", b)),
        joints=(
            grounded("O", "revolute", "crank", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
            joint("A", "spherical", "crank", "rod", a),
            joint("B", "universal", "slider", "rod", b, (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
            grounded("S", "prismatic", "slider", b, (1.0, 0.0, 0.0)),
        ),
        measured=(JointAngle("turn", "O"), JointTravel("travel", "S")),
        driven=("turn",),
    )


@each(("r", "offset"), [(0.2, (0.8, 0.1, 0.3)), (0.15, (0.5, -0.2, -0.1)), (0.3, (1.0, 0.0, 0.6))])
def test_a_slider_crank_in_space(r: float, offset: Vector) -> None:
    """Position, rate and forces of the slider under a push P along its line, over a whole turn."""
    P = -400.0
    linkage = slider_crank(r, offset)
    motion = space_move(linkage, [ConstantDrive(0.0, 6.0, 2.0)], np.linspace(0.05, 1.95, 23))
    theta, rate, _ = motion.coordinate("turn")
    length2 = float(np.dot(offset, offset))
    y = offset[1] - r * np.sin(theta)
    run = np.sqrt(length2 - y**2 - offset[2] ** 2)
    travel = r * np.cos(theta) + run - r - offset[0]
    slope = -r * np.sin(theta) + y * r * np.cos(theta) / run
    assert motion.coordinate("travel")[0] == pytest.approx(travel, abs=1e-12)
    assert motion.coordinate("travel")[1] == pytest.approx(slope * rate, abs=1e-11)
    push = SpaceForce("slider", linkage.joints[2].at, (P, 0.0, 0.0))
    found = space_reactions("push", motion, [push])
    rod = np.stack([run, y, np.full_like(y, offset[2])], axis=1)
    on_slider = -P / run[:, None] * rod  # along the rod, balancing P along x
    assert found.reactions.force("B") == pytest.approx(on_slider, rel=1e-9, abs=1e-9)
    side = on_slider * [0.0, 1.0, 1.0]
    assert found.reactions.force("S") == pytest.approx(side, rel=1e-9, abs=1e-9)
    assert np.abs(found.reactions.moments[:, 3]).max() < 1e-9 * abs(P)
    assert found.drive[:, 0] == pytest.approx(-P * slope, abs=1e-9 * abs(P))


def test_a_bead_on_a_line_pushes_square_to_it() -> None:
    """A tilted crank's pin slides along an arm on a universal joint, which lifts a force at its
    end: the pin bears the part of it square to the arm, times the ratio of the arms.
    """
    k, q, pin = (0.2, 0.1, 1.0), (-0.7, 0.0, 0.1), (0.3, 0.0, 0.0)
    d = unit(vector(np.subtract(pin, q)))
    first = unit(vector(np.cross(d, (0.0, 0.3, 1.0))))
    second = vector(np.cross(d, first))
    tip = vector(np.add(q, 1.4 * np.array(d)))
    linkage = SpaceLinkage(
        bodies=(light("crank", pin), light("arm", pin)),
        joints=(
            grounded("O", "revolute", "crank", (0.0, 0.0, 0.0), k),
            grounded("Q", "universal", "arm", q, first, second),
            joint("P", "point-on-line", "arm", "crank", pin, d),
        ),
        measured=(JointAngle("turn", "O"),),
        driven=("turn",),
    )
    motion = space_move(linkage, [ConstantDrive(0.0, 5.0, 1.0)], np.linspace(0.0, 1.0, 20))
    p = about(k, (0.0, 0.0, 0.0), motion.coordinate("turn")[0], pin)
    reach = np.linalg.norm(p - q, axis=1)[:, None]
    along = (p - q) / reach
    assert motion.point("arm", tip)[0] == pytest.approx(q + 1.4 * along, abs=1e-11)
    F = np.array([30.0, -50.0, 80.0])
    found = space_reactions("tip", motion, [SpaceForce("arm", tip, vector(F))])
    square = F - (along @ F)[:, None] * along
    # On the arm the pin gives -square 1.4 / reach, for no couple of the universal joint is square
    # to the arm; the force is of the moving body, the crank, on the arm.
    assert found.reactions.force("P") == pytest.approx(-1.4 / reach * square, abs=1e-8)
    axis = np.array(unit(k))
    torque = np.cross(p, 1.4 / reach * square) @ axis
    assert found.drive[:, 0] == pytest.approx(-torque, abs=1e-8)

"""Friction in pins: the friction circle, energies, a system put together by hand, and jamming."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    ConstantDrive,
    Course,
    Dynamics,
    JammingError,
    Joint,
    Linkage,
    LinkageError,
    StateDrive,
    Turn,
    ledger,
    motion_reactions,
    move,
    over_time,
)
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import four_bar, slider_crank

MU, RADIUS = 0.3, 0.02
CIRCLE = RADIUS * MU / np.hypot(1.0, MU)


def rubbing(linkage: Linkage, **circles: float) -> Linkage:
    """The same with friction at these connections."""
    joints = tuple(
        replace(
            j,
            connections=tuple(replace(c, friction=circles.get(c.name, 0.0)) for c in j.connections),
        )
        for j in linkage.joints
    )
    return replace(linkage, joints=joints)


def turning(linkage: Linkage, *loads: Applied, friction: bool = True) -> Dynamics:
    motion = move(linkage, [ConstantDrive(0.2, 0.2 + 2 * np.pi, 0.5)], np.linspace(0.0, 0.5, 41))
    return motion_reactions("x", motion, loads, friction=friction)


@each(("speed", "carrier", "body"), [(2.0, GROUND, "wheel"), (-2.0, GROUND, "wheel"),
                                     (2.0, "wheel", GROUND), (-2.0, "wheel", GROUND)])  # fmt: skip
def test_a_shaft_in_its_bearing(speed: float, carrier: str, body: str) -> None:
    """A wheel on a pin, or with its pin in a fixed bearing, pulled by a rope at radius R: the force
    passes at the friction circle, and rubbing between dry surfaces, mu N at radius r, gives the
    same couple.
    """
    wheel = Linkage(
        bodies=(Body("wheel", 1.0, (0.0, 0.0), 0.1),),
        joints=(Joint("O", (0.0, 0.0), (Connection("O", body, CIRCLE),), carrier),),
        driven=("wheel",),
        turns=(Turn("wheel", "wheel", 0.0),),
    )
    pull = Applied("wheel", (0.5, 0.0), (120.0, -300.0))
    found = motion_reactions("x", move(wheel, [StateDrive(0.0, speed)], np.zeros(1)), [pull])
    force = np.hypot(120.0, 300.0)
    normal = force / np.hypot(1.0, MU)
    couple = MU * normal * RADIUS
    on_body = -np.sign(speed) * couple * (1.0 if body == "wheel" else -1.0)
    assert found.pin_friction[0, 0] == pytest.approx(on_body, rel=1e-12)
    assert found.drive[0, 0] == pytest.approx(150.0 + np.sign(speed) * couple, rel=1e-12)


CRANK = rubbing(slider_crank(friction=0.1), O=0.004, A=0.006, C=0.005)
PUSH = Applied("block", CRANK.joint("C").at, (-300.0, 0.0))


def test_friction_takes_what_the_circles_say() -> None:
    """At every pin the couple is the circle's radius times the whole force, against the turning;
    the power that is lost balances the others.
    """
    found = turning(CRANK, PUSH)
    motion, powers = found.motion, ledger(found)
    for k, (joint, connection) in enumerate(CRANK.connections):
        spin = motion.angular_velocity(connection.body) - motion.angular_velocity(
            CRANK.carrier(joint)
        )
        size = found.reactions.magnitudes[:, k]
        expected = -np.sign(spin) * connection.friction * size
        np.testing.assert_allclose(found.pin_friction[:, k], expected, atol=1e-9)
    assert powers.violation < 1e-12
    assert powers.friction.max() <= 0.0
    lost = powers.drives - ledger(turning(CRANK, PUSH, friction=False)).drives
    np.testing.assert_allclose(lost, -powers.friction, atol=1e-8)


def test_crank_rod_and_block_by_hand() -> None:
    """Newton and Euler body by body, with the couples and the guide's friction as found by repeated
    substitution from the sizes of the forces.
    """
    found = turning(CRANK, PUSH)
    motion = found.motion
    centre, _, acceleration = motion.centres
    for t in (1, 9, 17, 30, 39):
        a, c = (complex(*motion.joint(j)[0][t]) for j in "AC")
        spins = [motion.angular_velocity(b)[t] for b in ("crank", "rod")]
        x: Floats = np.zeros(9)
        for _ in range(200):
            # O on crank; crank's pin on rod; block's pin on rod; guide on block; torque
            at_o, at_a, at_c = (np.hypot(*x[k : k + 2]) for k in (0, 2, 4))
            m_o = -np.sign(spins[0]) * 0.004 * at_o
            m_a = -np.sign(spins[1] - spins[0]) * 0.006 * at_a
            m_c = -np.sign(spins[1]) * 0.005 * at_c
            rubs = -0.1 * np.sign(motion.v[t, -1]) * abs(x[6])
            M, b = np.zeros((9, 9)), np.zeros(9)
            g2, g3 = centre[t, 0], centre[t, 1]
            M[0, 0] = M[1, 1] = 1.0
            M[0, 2] = M[1, 3] = -1.0
            M[2, :4] = g2.imag, -g2.real, (a - g2).imag, -(a - g2).real
            M[2, 7] = 1.0
            M[3, 2] = M[4, 3] = M[3, 4] = M[4, 5] = 1.0
            M[5, 2:6] = -(a - g3).imag, (a - g3).real, -(c - g3).imag, (c - g3).real
            M[6, 4] = M[7, 5] = -1.0
            M[7, 6] = 1.0
            M[8, 8] = 1.0
            for k, body in enumerate(motion.linkage.bodies):
                b[3 * k] = body.mass * acceleration[t, k].real
                b[3 * k + 1] = body.mass * acceleration[t, k].imag
                if k < 2:
                    alpha = motion.angular_acceleration(body.name)[t]
                    b[3 * k + 2] = (body.inertia or 0.0) * alpha
            b[2] -= m_o - m_a
            b[5] -= m_a + m_c
            b[6] -= -300.0 + rubs
            b[8] = 0.0
            M[6, 8] = 0.0
            x = np.asarray(np.linalg.solve(M, b), dtype=np.float64)
        assert found.drive[t, 0] == pytest.approx(x[7], abs=1e-8)
        assert found.sliders.normal[t, 0] == pytest.approx(x[6], abs=1e-8)
        assert found.reactions.force("A")[t, :2] == pytest.approx(-x[2:4], abs=1e-8)


def test_a_couple_is_passed_by_the_guide() -> None:
    """The friction of the gudgeon pin turns the block against its guide."""
    found = turning(rubbing(slider_crank(), C=0.005), PUSH)
    couple = found.sliders.couple[:, 0]
    np.testing.assert_allclose(couple, found.pin_friction[:, 2], atol=1e-9)


def test_peaks_where_a_pin_turns_back() -> None:
    """The rocker of a four-bar turns back twice a turn: its friction jumps there, and few samples
    give the same as many.
    """
    linkage = rubbing(four_bar(gravity=(0.0, -900.0)), F14=0.03, F12=0.02)
    course = Course(linkage, [ConstantDrive(0.9, 0.9 + 2 * np.pi, 1.0)], 0.0, 1.0)

    def solve(times: Floats) -> Dynamics:
        return motion_reactions("x", course.at(times), [])

    few, many = (over_time(course, solve, solve(np.linspace(0.0, 1.0, n))) for n in (5, 800))
    assert len(few.corners) == 2
    assert len(few.peaks.unresolved) == 0
    for ours, theirs in zip(few.drives, many.drives, strict=True):
        assert ours.largest.value == pytest.approx(theirs.largest.value, rel=1e-9)
        assert ours.work[-1] == pytest.approx(theirs.work[-1], rel=1e-8)
    assert few.violation < 1e-12


def test_a_toggle_jams_inside_its_friction_circles() -> None:
    """The block drives the crank. Without masses the rod's force is tangent to the circles at A and
    C, and its arm about O less that at O moves the crank: it jams where nothing is left.
    """
    rho = 0.006
    for angle, jams in ((0.30, False), (0.08, True)):
        linkage = slider_crank(angle=angle, masses=(1e-9, 1e-9, 1e-9))
        linkage = rubbing(linkage, O=rho, A=rho, C=rho)
        guide = linkage.sliders[0].name
        linkage = replace(linkage, driven=(guide,), turns=())
        load = Applied("crank", (0.0, 0.0), couple=5.0)
        motion = move(linkage, [StateDrive(linkage.sliders[0].drawn, 1.0)], np.zeros(1))
        if jams:
            with raises(JammingError, "friction-jams", "pin"):
                motion_reactions("x", motion, [load])
            continue
        found = motion_reactions("x", motion, [load])
        free = motion_reactions("x", motion, [load], friction=False)
        a = 0.1 * np.exp(1j * angle)
        c = complex(*linkage.joint("C").at)
        arm = abs(np.imag(np.conj(a) * (c - a))) / abs(c - a)
        size = free.reactions.magnitudes[0, 1]
        assert size == pytest.approx(5.0 / arm, rel=1e-6)
        # tangents of the circles: inner or outer as the bodies turn; force from the couples
        spins = [motion.angular_velocity(b)[0] for b in ("crank", "rod")]
        at_a, at_c = np.sign(spins[1] - spins[0]), np.sign(spins[1])
        tilt = np.arcsin(rho * (at_a + at_c) / 0.3)
        line = (c - a) / abs(c - a) * np.exp(1j * tilt)
        force = found.reactions.force("A")[0]
        turned = np.angle(complex(force[0], force[1]) / line)
        assert min(abs(turned), abs(abs(turned) - np.pi)) == pytest.approx(0.0, abs=1e-9)


def test_a_floating_pin_has_no_friction() -> None:
    with raises(LinkageError, "friction-floats"):
        rubbing(four_bar(), A2=0.01)

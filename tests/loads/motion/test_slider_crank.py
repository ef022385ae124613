"""Slider-cranks: the closed form, Coulomb friction on both sides of the guide, and jamming."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loads import (
    Applied,
    ConstantDrive,
    CosineDrive,
    Dynamics,
    JammingError,
    StateDrive,
    ledger,
    mobility,
    motion_reactions,
    move,
)
from loads.linkage.friction import contact_forces
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import slider_crank


def test_the_closed_form() -> None:
    crank, rod, offset = 0.1, 0.3, 0.04
    linkage = slider_crank(crank, rod, offset)
    assert (mobility(linkage).kutzbach, mobility(linkage).degrees) == (1, 1)
    motion = move(linkage, [ConstantDrive(0.7, 0.7 + 2 * np.pi, 1.0)], np.linspace(0.0, 1.0, 25))
    turn, w = motion.drives[:, 0], 2 * np.pi
    root = np.sqrt(rod**2 - (crank * np.sin(turn) - offset) ** 2)
    x, v, a = motion.joint("C")
    assert x[:, 0] == pytest.approx(crank * np.cos(turn) + root, abs=1e-13)
    assert x[:, 1] == pytest.approx(offset, abs=1e-15)
    speed = (
        -crank * w * np.sin(turn)
        - (crank * np.sin(turn) - offset) * crank * w * np.cos(turn) / root
    )
    assert v[:, 0] == pytest.approx(speed, abs=1e-12)
    h = 1e-4
    near = [
        move(linkage, [StateDrive(t, w)], np.zeros(1)).joint("C")[1][0, 0]
        for t in (turn[3] + w * h, turn[3] - w * h)
    ]
    assert a[3, 0] == pytest.approx((near[0] - near[1]) / (2 * h), rel=1e-6)


@settings(max_examples=30, deadline=None)
@given(
    rod=st.floats(0.15, 1.0),
    offset=st.floats(-0.04, 0.04),
    friction=st.floats(0.0, 0.3),
    load=st.floats(-500.0, 500.0),
    bearing=st.sampled_from([None, 0.3]),
)
def test_random_slider_cranks_obey_the_laws(
    rod: float, offset: float, friction: float, load: float, bearing: float | None
) -> None:
    linkage = slider_crank(0.1, rod, offset, 0.3, friction, bearing, gravity=(0.0, -9.81))
    c = linkage.joint("C").at
    motion = move(linkage, [CosineDrive(0.3, 4.0, 0.2)], np.linspace(0.0, 0.2, 17))
    found = motion_reactions("turn", motion, [Applied("block", c, (load, 0.0))])
    assert motion.joint("C")[0][:, 1] == pytest.approx(offset, abs=1e-14)
    assert ledger(found).violation < 1e-9
    slides = motion.v[:, -1]
    assert np.all(found.sliders.friction[:, 0] * slides <= 0.0)
    # Newton for the block, from the reactions as reported
    _, _, a = motion.joint("C")
    rod_on_block = found.reactions.force("C")
    along = rod_on_block[:, 0] + load + found.sliders.friction[:, 0]
    across = rod_on_block[:, 1] + found.sliders.normal[:, 0]
    assert along == pytest.approx(0.5 * a[:, 0], abs=1e-9 * (1 + abs(load)))
    assert across == pytest.approx(0.5 * 9.81, abs=1e-9 * (1 + abs(load)))


def turning(friction: float, load: float, mass: float = 0.5) -> Dynamics:
    linkage = slider_crank(friction=friction, masses=(1.0, 0.8, mass))
    motion = move(linkage, [ConstantDrive(0.2, 0.2 + 2 * np.pi, 0.5)], np.linspace(0.0, 0.5, 41))
    return motion_reactions("x", motion, [Applied("block", linkage.joint("C").at, (load, 0.0))])


def test_friction_is_mu_times_the_size_of_the_normal_force_whichever_its_sign() -> None:
    """The seed drops the absolute value; both signs of the normal force and of the speed occur."""
    found = turning(0.2, 0.0)
    normal, friction = found.sliders.normal[:, 0], found.sliders.friction[:, 0]
    speed = found.motion.v[:, -1]
    assert {(n > 0, v > 0) for n, v in zip(normal, speed, strict=True)} == {
        (True, True),
        (True, False),
        (False, True),
        (False, False),
    }
    assert friction == pytest.approx(-0.2 * np.abs(normal) * np.sign(speed))


def test_the_seeds_nine_by_nine_system() -> None:
    """Its own matrix, with the absolute value, solved at every instant by trying both signs."""
    mu, load = 0.25, -300.0
    found = turning(mu, load)
    motion = found.motion
    centre, _, acceleration = motion.centres
    for t in range(0, len(motion), 5):
        a, c = (complex(*motion.joint(j)[0][t]) for j in "AC")
        answers = []
        for sign in (1.0, -1.0):
            M, b = np.zeros((9, 9)), np.zeros(9)
            # crank: F12, -F23, T12; rod: F23, -F34; block: F34, F14
            g2, g3 = centre[t, 0], centre[t, 1]
            M[0, 0] = M[1, 1] = 1.0
            M[0, 2] = M[1, 3] = -1.0
            M[2, :4] = g2.imag, -g2.real, (a - g2).imag, -(a - g2).real
            M[2, 8] = 1.0
            M[3, 2] = M[4, 3] = 1.0
            M[3, 4] = M[4, 5] = -1.0
            M[5, 2:6] = -(a - g3).imag, (a - g3).real, (c - g3).imag, -(c - g3).real
            M[6, 4] = M[7, 5] = M[6, 6] = M[7, 7] = 1.0
            M[8, 6] = 1.0
            M[8, 7] = mu * sign * np.sign(motion.v[t, -1])
            for k, body in enumerate(motion.linkage.bodies):
                b[3 * k] = body.mass * acceleration[t, k].real
                b[3 * k + 1] = body.mass * acceleration[t, k].imag
                if k < 2:
                    spin = motion.angular_acceleration(body.name)[t]
                    b[3 * k + 2] = (body.inertia or 0.0) * spin
            b[6] -= load
            x = np.linalg.solve(M, b)
            if x[7] * sign >= 0.0:
                answers.append(x)
        assert len(answers) == 1
        assert found.drive[t, 0] == pytest.approx(answers[0][8], abs=1e-9)
        assert found.sliders.normal[t, 0] == pytest.approx(answers[0][7], abs=1e-9)
        assert found.reactions.force("A")[t, :2] == pytest.approx(-answers[0][2:4], abs=1e-9)


def pushed(friction: float, speed: float = -1.0, angle: float = 1.2) -> Dynamics:
    """A light linkage whose block is pushed inwards by the crank against 100 N outwards."""
    linkage = slider_crank(0.2, 0.3, 0.0, angle, friction, None, (1e-9, 1e-9, 1e-9))
    motion = move(linkage, [StateDrive(angle, -speed)], np.zeros(1))
    load = Applied("block", linkage.joint("C").at, (100.0, 0.0))
    return motion_reactions("push", motion, [load])


def test_at_the_edge_of_jamming_the_force_grows_without_bound() -> None:
    """Without mass the rod's force is P / (cos phi - mu sin phi): beyond mu = cot phi it jams."""
    phi = np.arcsin(0.2 * np.sin(1.2) / 0.3)
    for mu in (0.0, 0.3, 0.9 / np.tan(phi)):
        force = 100.0 / (np.cos(phi) - mu * np.sin(phi))
        assert pushed(mu).reactions.magnitudes[0, 2] == pytest.approx(force, rel=1e-6)
    with raises(JammingError, "friction-jams", "slider guide") as caught:
        pushed(1.1 / np.tan(phi))
    assert caught.value.none
    assert caught.value.grip == pytest.approx(1.1, rel=1e-6)


def test_a_motion_with_two_answers_is_not_decided() -> None:
    """Pushed the other way past the edge both contact sides agree: no number is given."""
    phi = np.arcsin(0.2 * np.sin(1.2) / 0.3)
    linkage = slider_crank(0.2, 0.3, 0.0, 1.2, 1.5 / np.tan(phi), None, (1e-9, 1e-9, 1e-9))
    motion = move(linkage, [StateDrive(1.2, 1.0)], np.zeros(1))
    c = linkage.joint("C").at
    with raises(JammingError, "friction-jams") as caught:
        motion_reactions("pull", motion, [Applied("block", c, (-100.0, 0.0))])
    assert not caught.value.none


@settings(max_examples=200, deadline=None)
@given(st.floats(-5.0, 5.0), st.floats(-3.0, 3.0))
def test_one_contact_has_the_answers_that_reasoning_gives(free: float, feedback: float) -> None:
    """n + b |n| = n0: one answer while |b| < 1; else two or none by the sign of n0."""
    if abs(abs(feedback) - 1.0) < 1e-6 or abs(free) < 1e-6:
        return
    arguments = np.array([[free]]), np.array([[[feedback]]])
    if abs(feedback) < 1.0:
        n = contact_forces(*arguments)[0, 0]
        assert n + feedback * abs(n) == pytest.approx(free)
        return
    with pytest.raises(JammingError) as caught:
        contact_forces(*arguments)
    assert caught.value.none == (free * feedback < 0.0)


def test_pads_of_a_short_bearing_rub_harder() -> None:
    """A couple on the block is carried by two pads: 2 mu C / bearing of friction without force."""
    linkage = slider_crank(friction=0.1, masses=(1e-9, 1e-9, 1e-9))
    c = linkage.joint("C").at
    load = Applied("block", c, couple=3.0)
    friction = []
    for bearing in (None, 0.2, 0.05):
        (guide,) = linkage.sliders
        other = replace(linkage, sliders=(replace(guide, bearing=bearing),))
        motion = move(other, [StateDrive(0.7, 1.0)], np.zeros(1))
        friction.append(abs(motion_reactions("twist", motion, [load]).sliders.friction[0, 0]))
    assert friction == pytest.approx([0.0, 2 * 0.1 * 3.0 / 0.2, 2 * 0.1 * 3.0 / 0.05], abs=1e-6)


def test_nothing_rubs_at_rest() -> None:
    linkage = slider_crank(friction=0.4)
    motion = move(linkage, [StateDrive(0.7)], np.zeros(1))
    found = motion_reactions("held", motion, [Applied("block", linkage.joint("C").at, (9.0, 0.0))])
    assert found.sliders.friction[0, 0] == 0.0

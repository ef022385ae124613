"""A lever on a fixed pivot, turned by a cylinder: everything has a closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    CosineDrive,
    Joint,
    Lever,
    Linkage,
    LinkageError,
    Motion,
    MotionBlocked,
    Slider,
    at_rest,
    mobility,
    motion_reactions,
    move,
)
from tests.support.each import each
from tests.support.errors import raises


def lever(
    arm: float = 0.4, base: float = 0.9, angle: float = 1.2, mass: float = 3.0, offset: float = 0.1
) -> Linkage:
    """Pivot D at the origin, cylinder's foot H at (0, base), its head G on the lever at `angle`
    from DH; the lever's centre beside the line DG.
    """
    end = (arm * np.sin(angle), arm * np.cos(angle))
    foot = (0.0, base)
    toward = np.subtract(end, foot)
    return Linkage(
        bodies=(
            Body("LEVER", mass, (end[0] / 2 + offset, end[1] / 2), 0.05),
            Body("CYL", 0.7, (foot[0] + 0.2 * toward[0], foot[1] + 0.2 * toward[1]), 0.02),
            Body("ROD", 0.4, (foot[0] + 0.8 * toward[0], foot[1] + 0.8 * toward[1]), 0.01),
        ),
        joints=(
            Joint("D", (0.0, 0.0), (Connection("D", "LEVER"),), GROUND),
            Joint("H", foot, (Connection("H", "CYL"),), GROUND),
            Joint("G", end, (Connection("G1", "LEVER"), Connection("G2", "ROD")), None, 0.2),
        ),
        sliders=(Slider("HG", "CYL", "ROD", foot, end),),
        driven=("HG",),
        gravity=(0.0, -9.81),
    )


def course(motion: Motion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return motion.drives[:, 0], motion.speeds[:, 0], motion.rates[:, 0]


def drive(linkage: Linkage, change: float = 0.15) -> CosineDrive:
    length = linkage.sliders[0].drawn
    return CosineDrive(length, length + change, 2.0)


@settings(max_examples=30, deadline=None)
@given(
    arm=st.floats(0.2, 0.7),
    base=st.floats(0.8, 1.5),
    angle=st.floats(0.5, 2.2),
    part=st.floats(-0.7, 0.7),
)
def test_the_closed_form(arm: float, base: float, angle: float, part: float) -> None:
    linkage = lever(arm, base, angle)
    drawn = linkage.sliders[0].drawn
    room = (base + arm - drawn) if part > 0 else (drawn - (base - arm))
    law = CosineDrive(drawn, drawn + part * room, 2.0)
    motion = move(linkage, [law], np.linspace(0.0, 2.0, 37))
    _, v, a = motion.joint("G")
    form = Lever(base, arm)
    speed, acceleration = form.point(arm, *course(motion))
    assert np.linalg.norm(v, axis=1) == pytest.approx(speed, abs=1e-10)
    assert np.linalg.norm(a, axis=1) == pytest.approx(acceleration, abs=1e-8)
    turn, _, _ = form.turn(*course(motion))
    assert -motion.angle("LEVER") == pytest.approx(turn - turn[0], abs=1e-10)


def test_velocities_and_accelerations_are_the_derivatives_of_positions() -> None:
    linkage = lever()
    h = 1e-4
    at = np.linspace(0.1, 1.9, 9)
    motion = {d: move(linkage, [drive(linkage)], at + d * h) for d in (-1, 0, 1)}
    first = (motion[1].q - motion[-1].q) / (2 * h)
    second = (motion[1].q - 2 * motion[0].q + motion[-1].q) / h**2
    assert np.abs(first - motion[0].v).max() < 1e-6  # h^2 times the third derivative
    assert np.abs(second - motion[0].a).max() < 1e-5


def test_static_forces_follow_from_moments_about_the_pivot() -> None:
    linkage = lever()
    length = linkage.sliders[0].drawn + 0.05
    load = Applied("LEVER", linkage.joints[2].at, (30.0, -500.0))
    motion = at_rest(replace(linkage, gravity=(0.0, 0.0)), [length])
    found = motion_reactions("held", motion, [load], timed=False)
    (g,) = found.motion.joint("G")[0]
    along = (g - np.array([0.0, 0.9])) / length
    moment = g[0] * -500.0 - g[1] * 30.0
    lever_arm = g[0] * along[1] - g[1] * along[0]
    assert found.drive[0, 0] == pytest.approx(-moment / lever_arm, rel=1e-12)
    assert found.reactions.force("G2")[0, :2] == pytest.approx(-moment / lever_arm * along)
    assert found.reactions.force("H")[0, :2] == pytest.approx(moment / lever_arm * along)
    total = sum(found.reactions.force(c)[0] for c in ("D", "H"))  # what the ground must bear
    assert np.asarray(total)[:2] == pytest.approx([30.0, -500.0])


def test_every_floating_pin_obeys_newton() -> None:
    linkage = lever()
    found = motion_reactions("swing", move(linkage, [drive(linkage)], np.linspace(0.0, 2.0, 21)))
    _, _, a = found.motion.joint("G")
    on_pin = found.reactions.force("G1") + found.reactions.force("G2")
    assert on_pin[:, :2] == pytest.approx(0.2 * (a - np.array([0.0, -9.81])), abs=1e-12)


def test_few_samples_end_where_many_do() -> None:
    linkage = lever()
    coarse = move(linkage, [drive(linkage)], np.array([0.0, 2.0]))
    fine = move(linkage, [drive(linkage)], np.linspace(0.0, 2.0, 101))
    assert np.abs(coarse.q[-1] - fine.q[-1]).max() < 1e-12


@each("change", [0.6, -0.6])
def test_a_length_that_cannot_be_reached_is_told(change: float) -> None:
    linkage = lever()
    with raises(MotionBlocked, "dead-point") as caught:
        move(linkage, [drive(linkage, change)], np.linspace(0.0, 2.0, 21))
    limit = 1.3 if change > 0 else 0.5  # base + arm, base - arm: the dead points
    assert caught.value.reached[0] == pytest.approx(limit, abs=1e-6)
    assert caught.value.bodies == ("LEVER", "CYL", "ROD")
    assert caught.value.connections == ("D", "H", "G1", "G2")  # all without bound


def test_an_unguided_body_is_named() -> None:
    linkage = lever()
    joints = tuple(replace(j, at=(5.0, 5.0)) if j.name == "X" else j for j in linkage.joints)
    loose = replace(
        linkage, bodies=(*linkage.bodies, Body("FLAG", 1.0, (1.0, 1.0), 0.1)), joints=joints
    )
    with raises(LinkageError, "not-joined", "FLAG"):
        move(loose, [drive(loose)], np.zeros(1))


def test_redundant_connections_need_a_rule() -> None:
    linkage = lever()
    d, h, g = linkage.joints
    twice = replace(
        linkage,
        bodies=(*linkage.bodies, Body("TWIN", 1.0, (0.1, 0.1), 0.1)),
        joints=(
            replace(d, connections=(*d.connections, Connection("D2", "TWIN"))),
            h,
            replace(g, connections=(*g.connections, Connection("G3", "TWIN"))),
        ),
    )
    assert mobility(twice).shared == ("D", "D2", "G1", "G3")
    with raises(LinkageError, "statically-indeterminate", "D, D2, G1, G3"):
        motion_reactions("swing", move(twice, [drive(twice)], np.zeros(1)))


@each(
    ("change", "code", "named"),
    [
        ({"driven": ("XY",)}, "unknown-drive", "'XY'"),
        ({"bodies": ()}, "unknown-body", "'LEVER'"),
        ({"joints": ()}, "no-joints", ""),
    ],
)
def test_contradictions_are_refused(change: dict[str, object], code: str, named: str) -> None:
    with raises(LinkageError, code, named):
        replace(lever(), **change)  # type: ignore[arg-type]

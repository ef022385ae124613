"""Who holds a linkage: two cylinders on a lever, a lock, a stop; against levers by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    CosineDrive,
    Dynamics,
    Joint,
    Linkage,
    LinkageError,
    Parallel,
    Slider,
    Turn,
    at_rest,
    ledger,
    motion_reactions,
    move,
)
from tests.support.each import each
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import four_bar

LOAD, TIP = 900.0, (2.0, 0.4)
FEET, EYES = ((0.6, -1.0), (-0.5, -0.8)), ((0.9, 0.1), (0.7, 0.0))


def lever(*parallel: Parallel) -> Linkage:
    """A massless lever on a pivot at the origin, moved by two cylinders; the first is driven."""
    light = Body("lever", 1e-12, (0.5, 0.0), 1e-12)
    bodies, sliders = [light], list[Slider]()
    joints = [Joint("O", (0.0, 0.0), (Connection("O", "lever"),), GROUND)]
    for k, (foot, eye) in enumerate(zip(FEET, EYES, strict=True), 1):
        middle = (0.5 * (foot[0] + eye[0]), 0.5 * (foot[1] + eye[1]))
        bodies += [Body(f"{part}{k}", 1e-12, middle, 1e-12) for part in ("barrel", "rod")]
        joints += [
            Joint(f"F{k}", foot, (Connection(f"F{k}", f"barrel{k}"),), GROUND),
            Joint(f"E{k}", eye, (Connection(f"E{k}", f"rod{k}"),), "lever"),
        ]
        sliders.append(Slider(f"c{k}", f"barrel{k}", f"rod{k}", foot, eye))
    stops = Turn("lock", "lever", 0.0), Turn("stop", "lever", 0.0, carries="negative")
    return Linkage(tuple(bodies), tuple(joints), ("c1",), tuple(sliders), stops, parallel=parallel)


PUSH = Applied("lever", TIP, (0.0, -LOAD))


def arms() -> tuple[float, float]:
    """Lever arms of the cylinders about O, as drawn: positive where pushing turns it up."""
    found = []
    for foot, eye in zip(FEET, EYES, strict=True):
        line = np.subtract(eye, foot) / np.linalg.norm(np.subtract(eye, foot))
        found.append(eye[0] * line[1] - eye[1] * line[0])
    return found[0], found[1]


def held(linkage: Linkage, *hold: str) -> Dynamics:
    motion = at_rest(linkage, [linkage.drives[0].drawn])
    return motion_reactions("x", motion, [PUSH], timed=False, hold=hold)


MOMENT = LOAD * TIP[0]


def test_one_cylinder_takes_all() -> None:
    a1, a2 = arms()
    for hold, arm in (((), a1), (("c1",), a1), (("c2",), a2)):
        found = held(lever(), *hold)
        assert found.drive == pytest.approx(np.array([[MOMENT / arm]]), rel=1e-9)
    idle = held(lever()).reactions
    assert np.linalg.norm(idle.force("E2")) == pytest.approx(0.0, abs=1e-6)


def test_equal_pressure_and_stiffness() -> None:
    a1, a2 = arms()
    areas = held(lever(Parallel(("c1", "c2"), (3.0, 2.0), "areas")))
    pressure = MOMENT / (3.0 * a1 + 2.0 * a2)
    assert areas.drive[0] == pytest.approx([3.0 * pressure, 2.0 * pressure], rel=1e-9)
    springs = held(lever(Parallel(("c1", "c2"), (3.0, 2.0), "stiffness")))
    turn = MOMENT / (3.0 * a1**2 + 2.0 * a2**2)
    assert springs.drive[0] == pytest.approx([3.0 * a1 * turn, 2.0 * a2 * turn], rel=1e-9)
    for found in (areas, springs):
        eyes = [np.linalg.norm(found.reactions.force(f"E{k}")) for k in (1, 2)]
        assert eyes == pytest.approx(np.abs(found.drive[0]), rel=1e-9)
        assert [a.name for a in found.actuators] == ["c1", "c2"]


@each("by", ["areas", "stiffness"])
def test_cylinders_in_parallel_put_in_the_work(by: str) -> None:
    """Of a motion with masses the powers of both balance all others."""
    rule = Parallel(("c1", "c2"), (3.0, 2.0), by)  # type: ignore[arg-type]
    linkage = lever(rule)
    heavy = tuple(replace(b, mass=20.0, inertia=3.0) for b in linkage.bodies)
    linkage = replace(linkage, bodies=heavy, gravity=(0.0, -9.81))
    drawn = linkage.drives[0].drawn
    motion = move(linkage, [CosineDrive(drawn, drawn + 0.3, 0.5)], np.linspace(0.0, 0.5, 31))
    found = motion_reactions("x", motion, [PUSH])
    powers = ledger(found)
    assert powers.violation < 1e-12
    np.testing.assert_allclose(found.power.sum(axis=1), powers.drives)
    assert np.abs(found.power).max(axis=0).min() > 10.0
    one = motion_reactions("x", motion, [PUSH], hold=("c1",))
    np.testing.assert_allclose(one.power.sum(axis=1), powers.drives, atol=1e-9)


def test_a_lock_carries_the_couple_and_the_cylinders_nothing() -> None:
    found = held(lever(), "lock")
    assert found.drive == pytest.approx(np.array([[MOMENT]]), rel=1e-9)
    for k in (1, 2):
        assert np.linalg.norm(found.reactions.force(f"E{k}")) == pytest.approx(0.0, abs=1e-6)
    assert found.reactions.force("O")[0] == pytest.approx([0.0, -LOAD, 0.0], abs=1e-6)


def test_what_cannot_hold() -> None:
    with raises(LinkageError, "stop-opens", "stop carries only negative couples"):
        held(lever(), "stop")
    with raises(LinkageError, "hold-too-many", "parallel"):
        held(lever(), "c1", "c2")
    both = lever(Parallel(("c1", "c2"), (3.0, 2.0), "areas"))
    assert held(both, "c1", "c2").drive == pytest.approx(held(both).drive)
    assert held(both, "c2").drive.shape == (1, 1)
    bar = replace(four_bar(), turns=(*four_bar().turns, Turn("joint", "crank", 0.0, "rocker")))
    motion = at_rest(bar, [0.9])
    assert motion_reactions("x", motion, hold=("joint",)).drive.shape == (1, 1)
    with raises(LinkageError, "one-must-drive"):
        lever(Parallel(("c2", "lock"), (1.0, 1.0), "areas"))
    with raises(LinkageError, "unknown-drive"):
        lever(Parallel(("c1", "c9"), (1.0, 1.0), "areas"))


def test_what_does_not_move_cannot_hold() -> None:
    """At a dead point of c2's lever arm: its axis through O."""
    linkage = lever()
    foot, eye = (-1.2, 0.0), (0.7, 0.0)
    slides = (linkage.sliders[0], replace(linkage.sliders[1], start=foot, end=eye))
    joints = tuple(replace(j, at=foot) if j.name == "F2" else j for j in linkage.joints)
    bodies = tuple(
        replace(b, centre=(-0.25, 0.0)) if b.name.endswith("2") else b for b in linkage.bodies
    )
    with raises(LinkageError, "hold-free", "lever"):
        held(replace(linkage, sliders=slides, joints=joints, bodies=bodies), "c2")

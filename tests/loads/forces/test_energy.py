"""Work, energy and shaking forces of a four-bar, each by another way."""

from __future__ import annotations

import numpy as np
import pytest

from loads import (
    GROUND,
    Applied,
    ConstantDrive,
    Distance,
    Dynamics,
    ForceLaw,
    Position,
    Spring,
    Turn,
    energy,
    ledger,
    motion_reactions,
    move,
)
from tests.support.mechanism.mechanisms import four_bar

BAR = four_bar()
TIMES = np.linspace(0.0, 1.0, 201)
LOADS = (
    Applied("rocker", BAR.joint("B").at, (30.0, -10.0)),
    Applied("coupler", (0.2, 0.4), (-5.0, 25.0), couple=3.0, follows=True),
)


@pytest.fixture(scope="module")
def turned() -> Dynamics:
    """Half a turn of the crank in one second."""
    drive = ConstantDrive(0.9, 0.9 + np.pi, 1.0)
    return motion_reactions("turn", move(BAR, [drive], TIMES), LOADS)


def test_powers_balance_also_under_loads_that_turn_with_a_body(turned: Dynamics) -> None:
    powers = ledger(turned)
    assert powers.violation < 1e-12
    assert np.abs(powers.applied).max() > 1.0
    assert not powers.friction.any()
    going_in = powers.drives + powers.gravity + powers.applied
    np.testing.assert_allclose(going_in, powers.kinetic_rate, atol=1e-9)


def test_applied_power_is_the_work_of_moving_points(turned: Dynamics) -> None:
    """By central differences of positions, which are off by the square of their 200 steps."""
    motion = turned.motion
    work = np.zeros(len(TIMES))
    for load in LOADS:
        at, _, _ = motion.point(load.body, load.at)
        force = np.broadcast_to(np.array(load.force) @ [1.0, 1.0j], len(TIMES))
        turn = motion.angle(load.body)
        if load.follows:
            force = force * np.exp(1j * turn)
        step = np.gradient(at @ [1.0, 1.0j], TIMES)
        work = work + np.real(np.conj(force) * step) + load.couple * np.gradient(turn, TIMES)
    found = ledger(turned).applied
    assert np.abs(found - work)[1:-1].max() < 1e-3 * np.abs(found).max()


def test_powers_that_are_round_off_grow_as_all_powers_do() -> None:
    """Of inertia alone, three times as fast: forces are 9 times as large and powers 27 times."""
    bar = four_bar(gravity=(0.0, 0.0))
    slow, fast = (
        ledger(motion_reactions("x", move(bar, [ConstantDrive(0.9, 2.9, T)], TIMES * T), ()))
        for T in (3.0, 1.0)
    )
    assert fast.drives == pytest.approx(27.0 * slow.drives, rel=1e-9)
    assert fast.min_power == pytest.approx(27.0 * slow.min_power, rel=1e-9)
    assert 0.0 < slow.min_power < 1e-4 * np.abs(slow.drives).max()


def test_work_goes_into_energy_and_loads(turned: Dynamics) -> None:
    """The works of drive and loads against the change of energy, by Simpson's rule."""
    stored = energy(turned.motion)
    total = stored.kinetic + stored.potential
    applied = ledger(turned).applied
    h = TIMES[1] - TIMES[0]
    power = applied + turned.power[:, 0]
    work = h / 3.0 * (power[:-2:2] + 4.0 * power[1:-1:2] + power[2::2]).cumsum()
    gained = (total - total[0])[2::2]
    np.testing.assert_allclose(work, gained, atol=1e-6 * np.abs(gained).max())


def test_energies_of_what_is_drawn(turned: Dynamics) -> None:
    """At the first instant, from masses, centres and rates one by one; pins of 0.1 and 0.2 kg."""
    motion = turned.motion
    kinetic, potential = 0.0, 0.0
    for item in BAR.items:
        at, v, _ = motion.point(item.name, item.centre)
        spin = motion.angular_velocity(item.name)[0]
        kinetic += 0.5 * item.mass * v[0] @ v[0] + 0.5 * (item.inertia or 0.0) * spin**2
        potential += 9.81 * item.mass * at[0, 1]
    found = energy(motion)
    assert (found.kinetic[0], found.potential[0]) == pytest.approx((kinetic, potential))
    assert sum(item.mass for item in BAR.items) == pytest.approx(2.0 + 3.0 + 1.5 + 0.1 + 0.2)


def test_the_ground_feels_its_pins_and_the_drive(turned: Dynamics) -> None:
    """Force and moment on the ground: what bodies do to its two pins, and the drive's reaction."""
    o2, o4 = (np.array(BAR.joint(j).at) for j in ("O2", "O4"))
    f2, f4 = (turned.reactions.force(c)[:, :2] for c in ("F12", "F14"))
    force, moment = turned.shaking(BAR.joint("O2").at)
    np.testing.assert_allclose(force, f2 + f4, atol=1e-9)
    lever = (o4 - o2)[0] * f4[:, 1] - (o4 - o2)[1] * f4[:, 0]
    np.testing.assert_allclose(moment, lever - turned.drive[:, 0], atol=1e-9)


def test_springs_to_the_ground_change_nothing_of_what_it_feels(turned: Dynamics) -> None:
    law = ForceLaw(preload=40.0, stiffness=20.0, damping=3.0)
    springs = (
        Spring("line", Distance((GROUND, "coupler"), ((-0.4, 0.1), (0.2, 0.4))), law),
        Spring("torsion", Position(Turn("torsion", "rocker", 0.0)), law),
    )
    sprung = motion_reactions("turn", turned.motion, (*LOADS, *springs))
    about = BAR.joint("O4").at
    for found, plain in zip(sprung.shaking(about), turned.shaking(about), strict=True):
        np.testing.assert_allclose(found, plain, atol=1e-9)

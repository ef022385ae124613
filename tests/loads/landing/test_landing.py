"""The drop of a leg, against closed forms, other integrators and its own energy."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from loads import ArgumentError
from loads.landing import (
    Drop,
    GasSpring,
    Landing,
    LandingError,
    Levered,
    LinearSpring,
    Oil,
    PowerTyre,
    Strut,
    TableTyre,
    Wheel,
    descent_velocity,
    land,
    required_velocity,
    spin_up_drag,
)
from loads.landing.drop import fall
from tests.support.each import each
from tests.support.errors import raises

G = 9.80665
GAS = GasSpring(8e5, 0.003, 0.008, 1.2, 1.01e5)
OIL = Oil(860.0, 0.006, 2.2e-4, 0.9, 1.2e-4)
WHEEL = Wheel(1.5, 0.3, 45.0, 0.7, 1.5e6, 60.0, 0.03)
LEVER = tuple(float(x) for x in np.linspace(0.0, 0.5, 33))
EVERYTHING = Drop(
    sprung=1050.0,
    unsprung=60.0,
    velocity=3.05,
    tyre=PowerTyre(1.2e6, 1.25, 0.05),
    strut=Strut(GAS, 0.34, OIL, 300.0),
    wheel=WHEEL,
    lift=0.9,
    duration=0.8,
    travel=Levered(LEVER, tuple(0.7 * x - 0.2 * x**2 for x in LEVER)),
)


def test_energy_is_kept_through_every_change_of_mode() -> None:
    """Breakout, reversal, sticking, the extension stop, lift-off, spin-up and spring-back."""
    found = land(EVERYTHING)
    for event in ("moves", "turns", "extended", "tyre", "rolls", "slides"):
        assert found.events(event), event
    energies = found.at(np.linspace(0.0, 0.8, 1001)).energies
    assert np.abs(energies.imbalance).max() < 1e-10
    for name in ("oil", "friction", "stop", "tyre_damping", "slip", "bending", "lift", "spring"):
        assert np.abs(getattr(energies, name)).max() > 1e-4 * energies.kinetic[0], name


def test_a_rigid_leg_on_a_linear_tyre_is_an_oscillator() -> None:
    """m z'' = m g (1 - L) - k z from V: the deflection d + sqrt(d^2 + m V^2 / k)."""
    mass, k, speed, lift = 500.0, 2e5, 3.0, 0.4
    found = land(Drop(450.0, 50.0, speed, PowerTyre(k), lift=lift))
    level, omega = mass * G * (1.0 - lift) / k, math.sqrt(k / mass)
    most = level + math.hypot(level, speed / omega)
    peak = found.peaks["vertical"]
    assert peak.value == pytest.approx(k * most, rel=1e-9)
    assert peak.time == pytest.approx(
        (math.pi - math.atan(speed / omega / level)) / omega, rel=1e-4
    )
    assert found.load_factor == pytest.approx(k * most / mass / G, rel=1e-9)
    assert mass * speed / found.equal_impulse_time == pytest.approx(peak.value)


def test_without_oil_two_masses_on_linear_springs_move_as_the_matrix_exponential_says() -> None:
    m1, m2, ks, kt, speed, lift = 400.0, 30.0, 3e4, 4e5, 2.5, 0.5
    found = land(
        Drop(m1, m2, speed, PowerTyre(kt), Strut(LinearSpring(ks), 1.0), lift=lift, duration=0.6)
    )
    begin, end = found.corners[:2]  # until the axle, which nothing damps, leaves the ground
    times = np.linspace(begin, end, 50)
    A = np.zeros((5, 5))  # u, z2, u', z2', 1
    A[0, 2] = A[1, 3] = 1.0
    A[3, :2] = ks / m2, -kt / m2
    A[3, 4] = G
    A[2, :2] = -ks / m1 - ks / m2, kt / m2
    A[2, 4] = -lift * (m1 + m2) * G / m1
    first = found.at(np.array([begin]))
    y0 = np.array([0.0, first.deflection[0], 0.0, first.sink_velocity[0], 1.0])
    exact = np.array([expm(A * (t - begin)) @ y0 for t in times])
    seen = found.at(times)
    np.testing.assert_allclose(seen.rise, exact[:, 0], atol=1e-9)
    np.testing.assert_allclose(seen.deflection, exact[:, 1], atol=1e-9)


def test_a_strut_of_high_preload_is_the_tyre_alone() -> None:
    alone = Drop(450.0, 50.0, 3.0, PowerTyre(2e5), duration=0.2)
    stiff = replace(alone, strut=Strut(LinearSpring(1e3, 1e6), 0.1))
    one, other = (land(drop).at(np.linspace(0.0, 0.2, 50)) for drop in (alone, stiff))
    np.testing.assert_allclose(one.forces.vertical, other.forces.vertical, atol=1e-6)
    assert not other.rise.any()


def rk4(steps: int, end: float) -> np.ndarray:
    """z1, z2 and their rates of a leg with oil, power tyre and spring, by the equations written
    anew and fixed steps.
    """

    def rate(y: np.ndarray) -> np.ndarray:
        z1, z2, v1, v2 = y
        strut = 5000.0 + 2e4 * (z1 - z2) + 4000.0 * (v1 - v2) * abs(v1 - v2)
        tyre = 1e6 * max(z2, 0.0) ** 1.5
        return np.array([v1, v2, G - strut / 400.0, G + (strut - tyre) / 20.0])

    y, h = START.copy(), end / steps
    for _ in range(steps):
        a = rate(y)
        b = rate(y + 0.5 * h * a)
        c = rate(y + 0.5 * h * b)
        y = y + h / 6.0 * (a + 2.0 * b + 2.0 * c + rate(y + h * c))
    return y


AREA = 1e-3
CLOSING = Oil(800.0, AREA, math.sqrt(800.0 * AREA**3 / 8000.0), 1.0)
OILED = Drop(
    400.0, 20.0, 3.0, PowerTyre(1e6, 1.5), Strut(LinearSpring(2e4, 5000.0), 1.0, CLOSING)
)  # fmt: skip
BEGIN = fall(OILED)[0].last
_FIRST = Landing(OILED, fall(OILED)).at(np.array([BEGIN]))
START = np.array([_FIRST.deflection[0]] * 2 + [_FIRST.sink_velocity[0]] * 2)


def test_fixed_steps_with_richardson_give_the_same() -> None:
    span = 0.08
    coarse, fine = rk4(2000, span), rk4(4000, span)
    exact = fine + (fine - coarse) / 15.0
    seen = land(OILED).at(np.array([BEGIN + span]))
    assert seen.deflection[0] == pytest.approx(exact[1], rel=1e-8)
    assert seen.rise[0] == pytest.approx(exact[0] - exact[1], rel=1e-8)
    assert seen.sink_velocity[0] == pytest.approx(exact[2], rel=1e-8)


@pytest.mark.long
@pytest.mark.slow
def test_an_implicit_integrator_gives_the_same_peaks() -> None:
    explicit, implicit = land(EVERYTHING), Landing(EVERYTHING, fall(EVERYTHING, "Radau"))
    for name, peak in explicit.peaks.items():
        assert implicit.peaks[name].value == pytest.approx(peak.value, rel=1e-6), name


def test_spin_up_ends_when_friction_has_given_the_wheel_its_momentum() -> None:
    """mu r times the impulse of the ground, which is the change of the falling momentum."""
    mass, wheel = 500.0, Wheel(0.9, 0.3, 40.0, 0.6)
    found = land(Drop(450.0, 50.0, 3.0, PowerTyre(2e5), wheel=wheel))
    (end,) = found.events("rolls")[:1]
    impulse = mass * (3.0 - found.at(np.array([end])).sink_velocity[0] + G * end)
    assert 0.6 * 0.3 * impulse == pytest.approx(0.9 * 40.0 / 0.3, rel=1e-9)
    drag = found.at(np.array([0.999 * end, 1.001 * end])).forces.drag
    assert drag[0] > 0.0
    assert drag[1] == 0.0


def test_a_rolling_wheel_springs_back_at_the_frequency_of_leg_and_wheel() -> None:
    wheel = Wheel(0.9, 0.3, 10.0, 0.8, 5e5, 40.0)
    found = land(Drop(450.0, 50.0, 3.0, PowerTyre(2e5), wheel=wheel, duration=0.3))
    (first,) = found.events("rolls")[:1]
    omega = math.sqrt(5e5 / (40.0 + 0.9 / 0.3**2))

    def on_leg(time: float) -> float:
        return float(found.at(np.array([time])).forces.on_leg[0])

    times = np.linspace(first, first + 2.2 * math.pi / omega, 200)
    assert not any(first < t < times[-1] for t in found.events("slides"))
    signs = np.flatnonzero(np.diff(np.sign([on_leg(t) for t in times])))
    one, two = (brentq(on_leg, times[k], times[k + 1], xtol=1e-14) for k in signs[:2])
    assert two - one == pytest.approx(math.pi / omega, rel=1e-8)
    assert found.peaks["spring_back"].value > 0.0


def test_friction_holds_the_strut_where_it_stops() -> None:
    """On a tyre that is nearly rigid the strut sticks, and carries what keeps the aircraft up."""
    strut = Strut(LinearSpring(3e4), 1.0, CLOSING, friction=3000.0)
    found = land(Drop(400.0, 20.0, 2.0, PowerTyre(1e6, 1.0, 2.0), strut, duration=1.5))
    late = found.at(np.array([1.4, 1.5]))
    assert late.rise[0] == late.rise[1] > 0.05
    spring = strut.spring.force(late.forces.stroke)
    assert np.all(np.abs(late.forces.along - spring) <= 3000.0)


def test_gas_stores_the_integral_of_its_force() -> None:
    for n in (1.0, 1.1, 1.4):
        gas = GasSpring(8e5, 0.003, 0.008, n, 1.01e5)
        strokes = np.linspace(0.0, 0.3, 20001)
        work = np.trapezoid(gas.force(strokes), strokes)
        assert gas.energy(strokes[-1:])[0] == pytest.approx(work, rel=1e-6)


@each(
    ("make", "code"),
    [
        (lambda: Strut(GAS, 0.375), "stroke-exceeds-gas"),
        (lambda: Oil(860.0, 1e-3, 1e-3), "orifice-too-large"),
        (lambda: TableTyre((0.0, 0.1), (0.0, 10.0)), "tyre-table"),
        (lambda: TableTyre((0.0, 0.1, 0.1), (0.0, 10.0, 20.0)), "not-increasing"),
        (lambda: TableTyre((0.0, 0.1, 0.2), (0.0, 10.0, 9.0)), "not-increasing"),
        (lambda: Levered((0.0, 0.1, 0.1), (0.0, 0.1, 0.2)), "axle-does-not-rise"),
        (lambda: required_velocity("23.473", None), "no-wing-loading"),
    ],
)
def test_what_cannot_be_is_refused(make: object, code: str) -> None:
    with pytest.raises(ArgumentError) as caught:
        make()  # type: ignore[operator]
    assert caught.value.code == code


def test_a_gas_allows_the_stroke_that_is_named() -> None:
    """0.98 x 3 l / 80 cm^2 = 367.5 mm."""
    assert Strut(GAS, 0.3675)
    with raises(ArgumentError, "stroke-exceeds-gas", "0.00304 m^3", "0.003 m^3", "0.3675 m"):
        Strut(GAS, 0.38)
    (plain,) = GasSpring(10.0, 0.003, 0.008, 1.0).force(np.array([0.1875]))  # no ambient pressure
    assert plain == pytest.approx(2.0 * 10.0 * 0.008)


def test_beyond_its_table_a_tyre_has_the_force_of_the_last_row() -> None:
    table = TableTyre((0.0, 0.02, 0.04), (0.0, 4e3, 9e3))
    assert table.max_deflection == 0.04
    assert table.force(np.array([-0.01, 0.02, 0.04, 0.06])) == pytest.approx([0.0, 4e3, 9e3, 9e3])


def test_a_leg_that_is_too_weak_is_named() -> None:
    short = Strut(LinearSpring(1e4), 0.05)
    table = TableTyre((0.0, 0.02, 0.04), (0.0, 4e3, 9e3))
    for drop, code in (
        (Drop(400.0, 20.0, 3.0, PowerTyre(1e6), short), "strut-bottoms"),
        (Drop(400.0, 20.0, 3.0, table), "tyre-exceeded"),
        (Drop(400.0, 20.0, 3.0, PowerTyre(1e4), duration=0.01), "drop-too-short"),
    ):
        with pytest.raises(LandingError) as caught:
            land(drop)
        assert caught.value.code == code


def test_numbers_of_14_cfr() -> None:
    foot, psf = 0.3048, 47.880259
    assert descent_velocity(16.0 * psf) == pytest.approx(8.8 * foot)
    assert descent_velocity(1.0 * psf) == pytest.approx(7.0 * foot)
    assert descent_velocity(100.0 * psf) == pytest.approx(10.0 * foot)
    assert required_velocity("25.723-reserve-energy", None) == pytest.approx(12.0 * foot)
    assert spin_up_drag(10.0, 0.5, 40.0, 1e4, 0.1) == pytest.approx(0.8e4)  # friction governs
    light = spin_up_drag(1e-3, 0.5, 40.0, 1e4, 0.1)
    assert light == pytest.approx(math.sqrt(2e-3 * 40.0 * 0.8 * 1e4 / 0.1) / 0.5)

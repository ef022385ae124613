"""Machines that ship, each against closed forms, energy or forces by hand.

Those that lift by cylinders are in test_lifting_machines.py.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from pinstress.study.model.cases import CaseLoads
from pinstress.study.reading.file import load_study
from pinstress.study.reading.in_python import changed_study
from tests.support.mechanism.machines import STUDIES, G, cross, drive, force, machine, slope, solved
from tests.support.mechanism.mechanisms import circles

# --- engine: closed form of the slider-crank, torque from the rate of the energy -----------------

R, L, SPEED = 0.043, 0.145, 2 * math.pi * 50.0
PIN = 7850.0 * 0.25 * math.pi * (0.022**2 - 0.012**2) * 0.06  # kg


def gas(angle: Any) -> Any:
    """Between the rows by scipy's cubic, over three periods so that 0 is no end."""
    rows = list(csv.DictReader((STUDIES / "engine/gas_force.csv").read_text().splitlines()))
    x = np.array([float(r["position_deg"]) for r in rows])
    y = np.array([float(r["force"]) for r in rows])
    x3 = np.concatenate([x[:-1] - 720.0, x[:-1], x + 720.0])
    return PchipInterpolator(x3, np.concatenate([y[:-1], y[:-1], y]))(np.degrees(angle))


def gudgeon(angle: Any) -> Any:
    return R * np.cos(angle) + np.sqrt(L**2 - (R * np.sin(angle)) ** 2)


def engine_energy(angle: Any) -> Any:
    """Kinetic, at constant speed, less that of the crank, which is constant."""
    h = 1e-4

    def rate(of: Callable[[Any], Any]) -> Any:
        return (8 * (of(angle + h) - of(angle - h)) - (of(angle + 2 * h) - of(angle - 2 * h))) / (
            12 * h
        )

    def centre(a: Any) -> Any:
        rod = gudgeon(a) - R * np.exp(1j * a)
        along, across = CENTRE
        return R * np.exp(1j * a) + rod / L * (along + 1j * across)

    def tilt(a: Any) -> Any:
        return np.arcsin(-R * np.sin(a) / L)

    return SPEED**2 * (
        0.5 * (0.36 + PIN) * rate(gudgeon) ** 2
        + 0.275 * np.abs(rate(centre)) ** 2
        + 0.0011 * rate(tilt) ** 2
    )


def _rod_centre() -> tuple[float, float]:
    """The stated centre of the rod in its own axes, from A to C as drawn."""
    a = R * np.exp(1j * math.radians(30.0))
    own = (complex(0.080258, 0.01505) - a) / (0.180636268 - a) * L
    return float(own.real), float(own.imag)


CENTRE = _rod_centre()


def engine_torque(angle: Any) -> Any:
    h = 1e-3
    kinetic = engine_energy
    ke = (
        8 * (kinetic(angle + h) - kinetic(angle - h))
        - (kinetic(angle + 2 * h) - kinetic(angle - 2 * h))
    ) / (12 * h)
    dx = -R * np.sin(angle) - R**2 * np.sin(angle) * np.cos(angle) / np.sqrt(
        L**2 - (R * np.sin(angle)) ** 2
    )
    return ke + gas(angle) * dx


def test_the_torque_of_the_engine() -> None:
    """Against the rate of the kinetic energy and the gas force, at the samples and at its peak."""
    case = machine("engine")["two_turns"]
    assert case.dynamics is not None
    assert case.over is not None
    angle = case.dynamics.motion.drives[:, 0]
    torque = drive(case)[:, 0]
    np.testing.assert_allclose(torque, engine_torque(angle), atol=1e-5 * np.abs(torque).max())
    dense = engine_torque(np.linspace(0.0, 4.0 * math.pi, 200_001))
    assert case.over.drives[0].largest.value == pytest.approx(np.abs(dense).max(), rel=1e-5)
    assert case.over.drives[0].mean == pytest.approx(dense[:-1].mean(), rel=1e-5)
    assert case.over.violation < 1e-12
    assert len(case.over.peaks.unresolved) == 0


def test_the_force_of_the_piston_is_gas_less_inertia() -> None:
    case = machine("engine")["two_turns"]
    assert case.dynamics is not None
    angle = case.dynamics.motion.drives[:, 0]
    h = 1e-4
    a = SPEED**2 * (gudgeon(angle + h) - 2 * gudgeon(angle) + gudgeon(angle - h)) / h**2
    along = case.reactions.force("C2")[:, 0]
    np.testing.assert_allclose(along, -gas(angle) - 0.36 * a, atol=0.02)


# --- main gear: forces by hand, without weights --------------------------------------------------


@pytest.fixture(scope="module")
def weightless() -> dict[str, CaseLoads]:
    study = load_study(STUDIES / "main_gear.toml")
    return solved(changed_study(study, {"mechanism.gravity": [0.0, 0.0]}))


B, K, C = 1.25 + 0.05j, 0.6632 - 0.5294j, 0.12 - 1.15j
GROUND_LOCK, M, W = 0.2263 - 0.118j, 0.4379 - 0.331j, -2.2j
LOAD = 40e3 + 90e3j


def test_driven_the_actuator_carries_the_load(weightless: dict[str, CaseLoads]) -> None:
    foot, eye = -0.75 + 0.05j, -0.1 - 0.55j
    arm = cross(eye, (eye - foot) / abs(eye - foot))
    case = weightless["driven"]
    assert drive(case)[0, 0] == pytest.approx(-cross(W, LOAD) / arm, rel=1e-7)
    assert abs(force(case, "C")) < 1e-6 * abs(force(case, "E"))


def test_locked_the_brace_carries_the_load(weightless: dict[str, CaseLoads]) -> None:
    """Brace arms are two-force members; the chain of lock links carries a force along GK, and the
    downlock its moment at M.
    """
    case = weightless["locked"]
    lower = (K - C) / abs(K - C)
    size = -cross(W, LOAD) / cross(C, lower)
    assert force(case, "C") == pytest.approx(-size * lower, rel=1e-6)
    upper, lock = (B - K) / abs(B - K), (GROUND_LOCK - K) / abs(GROUND_LOCK - K)
    system = np.array([[upper.real, lock.real], [upper.imag, lock.imag]])
    in_upper, in_lock = np.linalg.solve(system, [(size * lower).real, (size * lower).imag])
    assert abs(force(case, "B")) == pytest.approx(abs(in_upper), rel=1e-6)
    assert abs(force(case, "G")) == pytest.approx(abs(in_lock), rel=1e-6)
    couple = cross(M - GROUND_LOCK, in_lock * lock)
    assert abs(drive(case)[0, 0]) == pytest.approx(abs(couple), rel=1e-6)
    assert abs(force(case, "E")) < 1e-6 * abs(force(case, "C"))


# --- pump jack: energy, and the curvature of paths from their points -----------------------------


SHAFT, SADDLE = -2.0 + 0j, 0.5 + 4j
A0, B0 = SHAFT + 0.9, circles(SHAFT + 0.9, 3.9, SADDLE, 2.5, 1.0)


def jack(angle: float) -> dict[str, complex]:
    """Centres of mass and points, with the turns of pitman and beam as unit numbers."""
    a = SHAFT + 0.9 * np.exp(1j * angle)
    b = circles(a, 3.9, SADDLE, 2.5, 1.0)
    pitman, beam = (b - a) / (B0 - A0), (b - SADDLE) / (B0 - SADDLE)
    return {
        "crank": SHAFT + 0.75 * np.exp(1j * angle),
        "pitman": 0.5 * (a + b),
        "beam": SADDLE + (0.9 + 4.05j - SADDLE) * beam,
        "head": SADDLE + 3.0 * beam,
        "middle": a + (-1.475 + 1.921j - A0) * pitman,
        "pitman turn": pitman,
        "beam turn": beam,
    }


def jack_torque(angle: float) -> float:
    """d(kinetic + potential)/d(angle) less the power of the rod load."""
    speed = 2.0 * math.pi / 6.0
    bar = 7850.0 * 0.16 * 0.12 * 3.9
    bodies = (("crank", 4600.0), ("pitman", bar), ("beam", 1900.0))
    turns = (("pitman turn", bar * (3.9**2 + 0.16**2) / 12.0), ("beam turn", 4200.0))

    def energy(at: float) -> float:
        out = 0.0
        for key, mass in bodies:
            rate = jack_rate(key, at)
            out += 0.5 * mass * (speed * abs(rate)) ** 2 + mass * G * jack(at)[key].imag
        for key, inertia in turns:
            out += 0.5 * inertia * (speed * abs(jack_rate(key, at))) ** 2
        return out

    rows = ([0, 80, 105, 265, 290, 360], [22e3, 24e3, 42e3, 46e3, 25e3, 22e3])
    load = np.interp(math.degrees(angle) % 360.0, *rows)
    return slope(energy, angle, 1e-3) + load * jack_rate("head", angle).imag


def jack_rate(key: str, at: float) -> complex:
    return _rate(lambda t: jack(t)[key], at)


def _rate(of: Callable[[float], complex], at: float, h: float = 1e-3) -> complex:
    return (8 * (of(at + h) - of(at - h)) - (of(at + 2 * h) - of(at - 2 * h))) / (12 * h)


def test_the_torque_of_the_pump_jack() -> None:
    case = machine("pump_jack")["stroke"]
    assert case.dynamics is not None
    angles = case.dynamics.motion.drives[:, 0]
    expected = [jack_torque(a) for a in angles[::6]]
    found = drive(case)[::6, 0]
    np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(found).max())


def test_the_corners_of_the_rod_load_are_instants() -> None:
    """The drive turns uniformly: the knots of the table are at known times."""
    case = machine("pump_jack")["stroke"]
    assert case.over is not None
    expected = 6.0 / 360.0 * np.array([80.0, 105.0, 265.0, 290.0])
    np.testing.assert_allclose(np.sort(case.over.corners), expected, atol=1e-8)


def test_the_curvature_of_paths() -> None:
    """The horsehead goes on a circle of 3 m; the coupler curve is differentiated by its points."""
    case = machine("pump_jack")["stroke"]
    assert case.dynamics is not None
    motion = case.dynamics.motion
    head = motion.curvature("beam", (3.5, 4.0))
    np.testing.assert_allclose(np.abs(head), 1.0 / 3.0, rtol=1e-9)
    assert len(np.unique(np.sign(head))) == 2
    found = motion.curvature("pitman", (-1.475, 1.921))
    for k in (0, 17, 50, 101):
        t = motion.drives[k, 0]
        first = jack_rate("middle", t)
        second = _rate(lambda s: jack_rate("middle", s), t)
        assert found[k] == pytest.approx(cross(first, second) / abs(first) ** 3, rel=1e-6)


# --- planetary: Willis, energy, and the balance of a planet ---------------------------------------

RADIUS = 0.048  # m, of sun and planets; the ring's is three times that
SUN, ARM, PLANET, PLANET_MASS = 0.0025, 1.2, 0.002, 1.5


def test_the_drum_turns_a_quarter_as_fast_as_the_motor() -> None:
    found = machine("planetary")["lift"].dynamics
    assert found is not None
    motion = found.motion
    for of in (motion.angle, motion.angular_velocity, motion.angular_acceleration):
        largest = np.abs(of("sun")).max()
        assert np.abs(of("arm") - of("sun") / 4.0).max() < 1e-12 * largest
        assert np.abs(of("planet2") + of("sun") / 2.0).max() < 1e-12 * largest


def test_the_torque_of_the_motor() -> None:
    found = machine("planetary")["lift"].dynamics
    assert found is not None
    arm = ARM + 3.0 * PLANET_MASS * (2.0 * RADIUS) ** 2
    inertia = SUN + arm / 16.0 + 3.0 * PLANET / 4.0
    expected = 900.0 / 4.0 + inertia * found.motion.angular_acceleration("sun")
    assert found.drive[:, 0] == pytest.approx(expected, rel=1e-12)


def test_forces_on_a_planet() -> None:
    """At rest: a third of the torque at each sun gear; the ring's teeth carry as much, but for the
    weight of the planet, and with them the pin, on which radial forces cancel.
    """
    case = machine("planetary")["test_load"]
    tangential = 1350.0 / 4.0 / 3.0 / RADIUS
    teeth = tangential * complex(math.tan(math.radians(20.0)), 1.0)
    for k, name in enumerate(("planet1", "planet2", "planet3")):
        outwards = np.exp(1j * math.radians(90.0 + 120.0 * k))
        # On the pin: the sun drives the planets forwards, counter-clockwise about O.
        assert -force(case, f"sun_{name}") == pytest.approx(teeth * outwards, rel=1e-9)
        pin = 2.0 * tangential * 1j * outwards - 1j * PLANET_MASS * G
        assert -force(case, name) == pytest.approx(pin, rel=1e-9)

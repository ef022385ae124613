"""Machines that ship whose cylinders and struts raise something: virtual work and energy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from tests.support.mechanism.machines import G, drive, machine, slope
from tests.support.mechanism.mechanisms import circles

# --- cylinders on a body that turns about the origin: virtual work -------------------------------


def cylinder(foot: complex, eye: complex, *bodies: tuple[float, complex, bool]) -> Any:
    """Its length and the potential energy of its bodies (mass, centre as drawn, whether it is part
    of the rod), by the angle of the body that carries the eye.
    """
    drawn = (eye - foot) / abs(eye - foot)

    def at(turn: float) -> tuple[float, float]:
        line = eye * np.exp(1j * turn) - foot
        spun = line / abs(line) / drawn
        height = 0.0
        for mass, centre, rod in bodies:
            origin, pivot = (eye, eye * np.exp(1j * turn)) if rod else (foot, foot)
            height += mass * (pivot + (centre - origin) * spun).imag
        return abs(line), G * height

    return at


FRONT = cylinder(0.5 - 1.1j, 1.1 + 0.2j, (45.0, 0.65 - 0.775j, False), (25.0, 0.95 - 0.125j, True))
REAR = cylinder(0.35 - 1j, 0.85 + 0.2j, (45.0, 0.475 - 0.7j, False), (25.0, 0.725 - 0.1j, True))


def crane_energy(turn: float) -> float:
    boom, tip = ((z * np.exp(1j * turn)).imag for z in (2.0 + 0.48j, 4.2 + 0.9j))
    return float(FRONT(turn)[1] + REAR(turn)[1] + 420.0 * G * boom + (40.0 * G + 19613.0) * tip)


def raised_to(length: float) -> float:
    """The angle of the boom at which the front cylinder has a length."""
    low, high = -0.1, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if FRONT(middle)[0] < length else (low, middle)
    return low


def test_the_cylinders_of_the_crane_share_the_work() -> None:
    lift = slope(crane_energy, 0.0)
    arms = [slope(lambda t: FRONT(t)[0], 0.0), slope(lambda t: REAR(t)[0], 0.0)]
    both = lift / sum(arms)
    assert drive(machine("crane")["both"]) == pytest.approx(np.array([[both, both]]), rel=1e-8)
    assert drive(machine("crane")["burst"]) == pytest.approx(np.array([[lift / arms[1]]]), rel=1e-8)


def test_the_work_of_the_cylinders_of_the_crane_raises_the_load() -> None:
    """At rest at both ends: the sum of both works is the change of the potential energy."""
    case = machine("crane")["raise"]
    assert case.over is not None
    start, end = raised_to(1.43178), raised_to(1.8)
    raised = crane_energy(end) - crane_energy(start)
    work = [effort.work[-1] for effort in case.over.drives]
    assert sum(work) == pytest.approx(raised, rel=1e-6)
    assert case.over.drives[1].stroke == pytest.approx(REAR(end)[0] - REAR(start)[0], rel=1e-6)


# --- hood: virtual work with the gas force -------------------------------------------------------

STRUT = cylinder(
    0.78 - 0.1j, 0.25 + 0.013j, (0.9, 0.6397 - 0.0701j, False), (0.5, 0.3868 - 0.0162j, True)
)
SPRING = PchipInterpolator([0.535, 0.59, 0.64, 0.69, 0.745], [680, 630, 590, 556, 524])


def hood_energy(turn: float) -> float:
    return float(
        STRUT(turn)[1]
        + 22.0 * G * ((0.48 + 0.03j) * np.exp(1j * turn)).imag
        + 0.6 * G * math.sin(turn)
    )


def test_the_hand_on_the_hood() -> None:
    for name, angle in (("closed", 0.0), ("ajar", math.radians(25.0))):
        length, _ = STRUT(angle)
        moment = slope(hood_energy, angle) - SPRING(length) * slope(lambda t: STRUT(t)[0], angle)
        assert drive(machine("hood")[name])[0, 0] == pytest.approx(moment, rel=1e-8)


def test_the_work_of_the_hand_on_the_hood() -> None:
    """Weight, gas and damper take it; the damper's part from the drive's own cycloid."""
    case = machine("hood")["open"]
    assert case.over is not None
    end = math.radians(60.0)
    gas_work = SPRING.integrate(STRUT(0.0)[0], STRUT(end)[0])
    times = np.linspace(0.0, 3.0, 20_001)
    angles = end * (times / 3.0 - np.sin(2 * math.pi * times / 3.0) / (2 * math.pi))
    lengths = np.array([STRUT(a)[0] for a in angles])
    lost = 300.0 * np.trapezoid(np.gradient(lengths, times, edge_order=2) ** 2, times)
    raised = hood_energy(end) - hood_energy(0.0)
    assert case.over.drives[0].work[-1] == pytest.approx(raised - gas_work + lost, abs=1e-5)


# --- scissor lift and bucket: virtual work -------------------------------------------------------


def test_the_cylinder_of_the_scissor_lift() -> None:
    """The platform is at h = sqrt(4 - x^2), the middles of the arms at half of it."""
    x = 1.93649167
    lifted = 24.0 * G + 60.0 * G + 2.0 * G + 5000.0  # per metre of h
    h = math.sqrt(4.0 - x * x)
    assert drive(machine("scissor_lift")["lowest"])[0, 0] == pytest.approx(
        -lifted * x / h, rel=1e-6
    )
    over = machine("scissor_lift")["raise"].over
    assert over is not None
    gained = lifted * (math.sqrt(4.0 - 1.2**2) - h)
    assert over.drives[0].work[-1] == pytest.approx(gained, rel=1e-7)


def test_the_work_of_the_bucket_cylinder() -> None:
    """It raises the weights and overcomes the digging curve along the path of the tip."""
    case = machine("bucket")["dig"]
    assert case.over is not None
    y, w = -0.1 + 0.42j, -0.4 + 2.2j
    x0 = y + 0.6 * np.exp(1j * math.radians(10.0))
    z0 = circles(x0, 0.6, 0j, 0.45, 1.0)
    rows = ([1.8, 1.88, 2.0, 2.15, 2.24, 2.3], [0.0, 35e3, 70e3, 95e3, 60e3, 0.0])

    def at(length: float) -> tuple[complex, float]:
        """The bucket's turn as a unit number, and the potential energy."""
        x = circles(w, length, y, 0.6, 1.0)
        z = circles(x, 0.6, 0j, 0.45, 1.0)
        bucket, axis = z / z0, (x - w) / (x0 - w) * abs(x0 - w) / length
        barrel = w + (-0.2 + 1.8j - w) * axis
        rod = x + (0.3 + 0.9j - x0) * axis
        middles = 35.0 * (x + y) / 2 + 50.0 * (x + z) / 2 + 95.0 * barrel + 55.0 * rod
        return bucket, G * (650.0 * ((0.4 - 0.7j) * bucket) + middles).imag

    lengths = np.linspace(1.82, 2.29, 8001)
    turns = np.array([at(s)[0] for s in lengths])
    sizes = PchipInterpolator(*rows)(lengths)
    force = sizes * (0.9 + 0.43j) / abs(0.9 + 0.43j) * turns
    steps = np.gradient((-0.1 - 1.45j) * turns, lengths, edge_order=2)
    digging = np.trapezoid(np.real(np.conj(force) * steps), lengths)
    raised = at(2.29)[1] - at(1.82)[1]
    assert -digging > 5e4
    assert case.over.drives[0].work[-1] == pytest.approx(raised - digging, rel=1e-6)

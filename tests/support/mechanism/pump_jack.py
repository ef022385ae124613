"""The pump jack of examples/own_mechanism.py by Newton's and Euler's equations, body by body.

Positions are in closed form, accelerations by finite differences; points are complex numbers, in
SI.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complex128]
Floats = NDArray[np.float64]

PERIOD, STEP = 5.0, 1e-4
GROUND = 1.5 + 2.0j
LOAD, GRAVITY = -8000j, -9.81j


def forces(times: Floats) -> tuple[dict[str, Floats], Floats]:
    """Return the magnitude of the force at every joint, (T,) N, and the crank's torque,
    (T,) N m.
    """
    a, b = _joints(times)
    head = GROUND + 1.2 * (GROUND - b)
    crank, pitman, beam = _centres(times)
    inertia = 90.0 * (_second(lambda t: _centres(t)[1], times) - GRAVITY)
    beams = 500.0 * (_second(lambda t: _centres(t)[2], times) - GRAVITY)
    cranks = 600.0 * (_second(lambda t: _centres(t)[0], times) - GRAVITY)
    # Moments of the beam about its bearing and of the pitman about A give the force at B.
    about_o4 = 450.0 * _turning(lambda t: _joints(t)[1] - GROUND, times)
    about_o4 = about_o4 + _cross(beam - GROUND, beams) - _cross(head - GROUND, LOAD)
    about_a = 30.0 * _turning(lambda t: _joints(t)[1] - _joints(t)[0], times)
    about_a = -(about_a + _cross(pitman - a, inertia))
    p, q = b - GROUND, b - a
    rows = np.stack([np.stack([-p.imag, p.real], 1), np.stack([-q.imag, q.real], 1)], 1)
    fx, fy = np.linalg.solve(rows, np.stack([about_o4, about_a], 1)[..., None])[..., 0].T
    at_b = fx + 1j * fy
    at_a = inertia + at_b
    at_joints = {"O2": cranks + at_a, "A": at_a, "B": at_b, "O4": beams - at_b - LOAD}
    torque = _cross(crank, cranks) + _cross(a, at_a)
    return {name: np.abs(force) for name, force in at_joints.items()}, torque


def _joints(times: Floats) -> tuple[Complex, Complex]:
    """Return A and B, by the law of cosines in the triangle A, O4, B."""
    a = 0.5 * np.exp(1j * (np.pi / 3 + 2 * np.pi * times / PERIOD))
    way = GROUND - a
    inside = np.arccos((2.0**2 + np.abs(way) ** 2 - 1.5**2) / (2 * 2.0 * np.abs(way)))
    return a, a + 2.0 * np.exp(1j * (np.angle(way) + inside))


def _centres(times: Floats) -> tuple[Complex, Complex, Complex]:
    a, b = _joints(times)
    return -0.6 * a, 0.5 * (a + b), 0.5 * (GROUND + 1.2 * (GROUND - b) + b)


def _second(course: Callable[[Floats], Any], times: Floats) -> Any:
    return (course(times - STEP) - 2 * course(times) + course(times + STEP)) / STEP**2


def _turning(side: Callable[[Floats], Complex], times: Floats) -> Floats:
    """Return the angular acceleration of a side of a triangle."""
    return np.asarray(_second(lambda t: np.unwrap(np.angle(side(t))), times))


def _cross(p: Complex, q: Complex | complex) -> Floats:
    return np.asarray((np.conj(p) * q).imag)

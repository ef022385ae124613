"""The largest von Mises stress of a beam over all instants, all points and the circumference.

At a point the stress of an instant is s(theta) = a + b cos theta + c sin theta. So von Mises
squared is a trigonometric polynomial of degree 2, which is sampled; Newton's method then refines
the largest sample.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.beam.line_load import shares
from fea.beam.stress import BeamStress
from fea.core.pin_loads import Loads, PinLoads
from fea.core.solution import StressPoints
from fea.core.voigt import VON_MISES
from pinbase.arrays import Floats, Ints

ANGLE_COUNT = 48  # samples of the circumference; Newton's method starts from the best one
_THETA = 2.0 * np.pi * np.arange(ANGLE_COUNT) / ANGLE_COUNT
_SINE_COMPONENTS = np.array([3, 5])  # tz and rt vary as sin psi
_CURVATURE_TOLERANCE = 1e-9  # of the largest value: a crest with less curvature is not refined


@dataclass(frozen=True)
class VonMisesMaxima:
    """The largest von Mises stress over the circumference, (S, T) Pa, at each point and instant.

    theta: (S, T) rad, where it occurs.
    """

    von_mises: Floats
    theta: Floats

    @property
    def place(self) -> tuple[int, int]:
        """The numbers of the point and the instant of the largest stress."""
        point, instant = np.unravel_index(self.von_mises.argmax(), self.von_mises.shape)
        return int(point), int(instant)


def stress_points(points: Floats, stress: Floats) -> StressPoints:
    """The points (S, 2), r and z in m, at which a beam knows its stress.

    stress: (3, S, 6, T) Pa: the constant part, and the factors of cos theta and sin theta.
    """

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        constant, cosine, sine = stress[:, rows][..., instants]
        c, s = (x[:, None, None] for x in (np.cos(angles), np.sin(angles)))
        return np.asarray((constant + c * cosine + s * sine).swapaxes(1, 2))

    return StressPoints.on_meridian(points, points[:, 0] > 0.0, stress.shape[-1], at)


class StressAlongBeam:
    """The stress along a beam under any loads (fea.core.solution.StressField).

    at: points (S, 2), r and z in m, at which the stress is known.
    """

    at: Floats

    def harmonics(self, loads: Loads) -> Floats:
        """The stress (3, S, 6, T), Pa: the constant part, and factors of cos theta, sin theta."""
        raise NotImplementedError

    def maxima(self, loads: Loads, _: float = 0.0) -> Floats:
        """The largest von Mises stress (T,), Pa, at every instant."""
        return np.asarray(von_mises_maxima(self.harmonics(loads)).von_mises.max(axis=0))

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest von Mises stress over all instants, Pa, and the number of its instant."""
        top = von_mises_maxima(self.harmonics(loads))
        return float(top.von_mises[top.place]), top.place[1]

    def points(self, loads: PinLoads) -> StressPoints:
        """The stress at the beam's points, for fatigue."""
        return stress_points(self.at, self.harmonics(loads))

    def surface(self) -> None:
        """Return None, since a beam has no field over its surface."""

    def picture(self, loads: PinLoads, instant: int) -> None:
        """Return None, since a beam has no field over its surface."""

    def volume(self, loads: PinLoads, instant: int) -> None:
        """Return None, since a beam has no field in its volume."""


def harmonics(beam: BeamStress, loads: Loads) -> Floats:
    """The stress (3, S, 6, T), Pa: the constant part, and factors of cos theta, sin theta."""
    units = beam.forces.loads
    c = shares(units, loads)
    across = np.array([load.n == 1 for load in units], dtype=bool)
    first, second = (np.einsum("sik,tk->sit", beam.stress, c[:, p] * across) for p in (0, 1))
    even, odd = (np.einsum("sik,tk->sit", beam.stress, c[:, p] * ~across) for p in (0, 1))
    a, b, s = even, first.copy(), second.copy()
    a[:, _SINE_COMPONENTS], b[:, _SINE_COMPONENTS], s[:, _SINE_COMPONENTS] = (
        -odd[:, _SINE_COMPONENTS],
        -second[:, _SINE_COMPONENTS],
        first[:, _SINE_COMPONENTS],
    )
    return np.stack([a, b, s])


def von_mises_maxima(stress: Floats) -> VonMisesMaxima:
    """The largest von Mises stress over the circumference.

    stress: (3, S, 6, T) Pa, as from `harmonics`.
    """
    weighted = np.einsum("ij,bsjt->bsit", VON_MISES, stress)

    def form(a: int, b: int) -> Floats:
        return np.asarray(np.einsum("sit,sit->st", stress[a], weighted[b]))

    square, cosine, sine = form(0, 0), form(1, 1), form(2, 2)
    # f = q0 + q1 cos + q2 sin + q3 cos 2 + q4 sin 2
    q = [
        square + 0.5 * (cosine + sine),
        2.0 * form(0, 1),
        2.0 * form(0, 2),
        0.5 * (cosine - sine),
        form(1, 2),
    ]

    def once(t: Floats | float) -> Floats:
        return np.asarray(q[1] * np.cos(t) + q[2] * np.sin(t))

    def twice(t: Floats | float) -> Floats:
        return np.asarray(q[3] * np.cos(2.0 * t) + q[4] * np.sin(2.0 * t))

    best, at = np.full_like(q[0], -np.inf), np.zeros_like(q[0])
    for theta in _THETA:
        value = q[0] + once(theta) + twice(theta)
        at = np.where(value > best, theta, at)
        best = np.maximum(value, best)
    # Newton's method for the crest, where the curve bends downwards.
    t, quarter = at, 0.5 * np.pi
    for _ in range(4):
        slope = once(t + quarter) + 2.0 * twice(t + 0.5 * quarter)
        bend = -once(t) - 4.0 * twice(t)
        downwards = bend < -_CURVATURE_TOLERANCE * best
        t = np.where(downwards, t - slope / np.where(downwards, bend, 1.0), t)
    value = q[0] + once(t) + twice(t)
    at, best = np.where(value > best, t, at), np.maximum(value, best)
    return VonMisesMaxima(np.sqrt(np.maximum(best, 0.0)), at)

"""Findley's critical plane: the shear amplitude and a part of the largest normal stress, on the
plane where their damage is largest.

    f = tau_a + k sigma_n,max      equivalent amplitude 2 f / (k + sqrt(1 + k^2))

of every cycle of the shear stress in a direction of a plane. That is the amplitude of alternating
tension with the same f. k is such that pulsating tension has the amplitude times 1 + M, with the
mean stress sensitivity M: uniaxial stress of ratios -1 and 0 has the damage of the signed von Mises
stress. Planes and directions are searched on a grid; those with the largest cycle are counted.

Source: Findley, J. Eng. Ind. 81 (1959) 301.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import brentq

from fea.core.voigt import TENSOR
from fea.fatigue.flight import PASSES, Cycles, Flight, case_by_case, rainflow
from geometry.arrays import Floats

STEP = 7.5  # degrees between planes
WAYS = np.radians(np.arange(0.0, 180.0, 7.5))  # directions in a plane
COUNTED = 12  # planes and directions whose cycles are counted
NOTHING = np.zeros((1, 6))


@dataclass(frozen=True)
class PlaneCycles:
    """Cycles of shear stress, with their equivalent amplitudes (C,) Pa at stress ratio -1, on the
    plane of a normal (3,).
    """

    equivalent: Floats
    shear: Cycles
    normal: Floats


def findley_k(sensitivity: float) -> float:
    """k of Findley for a mean stress sensitivity M of 0 or more, below 1."""

    def excess(k: float) -> float:
        pulsating, alternating = (m * k + np.hypot(1.0, m * k) for m in (2.0, 1.0))
        return float(pulsating / alternating - 1.0 - sensitivity)

    return float(brentq(excess, 0.0, 1e3)) if sensitivity > 0.0 else 0.0


def plane_cycles(cases: Sequence[Floats], flight: Flight, k: float) -> list[PlaneCycles]:
    """On the planes and directions with the largest cycles, of the stress (T, 6) Pa of cases."""
    tensors = [np.concatenate([NOTHING, stress, NOTHING])[:, TENSOR] for stress in cases]
    every = np.concatenate([tensors[c] for c in dict.fromkeys(flight.order)])
    normals, first, second = _planes()
    traction = every @ normals.T  # (T, 3, P)
    along, u, v = (np.einsum("tap,pa->tp", traction, x) for x in (normals, first, second))
    c, s = np.cos(WAYS), np.sin(WAYS)
    shear = np.stack([np.ptp(a * u + b * v, axis=0) for a, b in zip(c, s, strict=True)])
    reach = 0.5 * shear + k * np.maximum(along.max(axis=0), 0.0)  # (D, P)
    found = []
    for d, p in zip(
        *np.unravel_index(np.argsort(-reach, axis=None)[:COUNTED], reach.shape), strict=True
    ):
        way = c[d] * first[p] + s[d] * second[p]
        found.append(_counted(tensors, flight, (normals[p], way), k))
    return found


def _counted(
    tensors: Sequence[Floats], flight: Flight, plane: tuple[Floats, Floats], k: float
) -> PlaneCycles:
    normal, way = plane
    shears, tops = [], []
    for stress in tensors:
        across = stress @ normal
        shear, turns = case_by_case((across @ way)[1:-1])
        shears.append(shear)
        tops.append(np.maximum.reduceat(across @ normal, turns)[:-1])  # up to the next turn
    cycles = rainflow(flight.sequence(shears))
    top = np.tile(flight.sequence(tops), PASSES)
    largest = np.array(
        [top[a : b + 1].max() for a, b in zip(cycles.first, cycles.last, strict=True)]
    )
    found = cycles.amplitude + k * np.maximum(largest, 0.0)
    return PlaneCycles(2.0 / (k + np.hypot(1.0, k)) * found, cycles, normal)


@cache
def _planes() -> tuple[Floats, Floats, Floats]:
    """Normals (P, 3) of planes on a half sphere, and two directions (P, 3) in each of them."""
    polar, turn = [], []
    for a in np.radians(np.arange(0.0, 90.0 + 0.5 * STEP, STEP)):
        # With the planes at 45 degrees to the axes.
        count = 8 * round(360.0 * np.sin(a) / STEP / 8.0) or 1
        polar += [a] * count
        turn += (2.0 * np.pi * np.arange(count) / count).tolist()
    (a, b), (c, s) = ((np.cos(x), np.sin(x)) for x in (np.array(polar), np.array(turn)))
    normals, first = (np.stack(x, axis=1) for x in ([b * c, b * s, a], [a * c, a * s, -b]))
    return normals, first, np.stack([-s, c, np.zeros_like(s)], axis=1)

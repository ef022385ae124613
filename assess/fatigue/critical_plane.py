"""Findley's critical plane: shear amplitude plus a part of the largest normal stress.

    f = tau_a + k sigma_n,max      equivalent amplitude 2 f / (k + sqrt(1 + k^2))

for every cycle of the shear stress in one direction of a plane. The equivalent amplitude is that of
alternating tension with the same f. k follows from the mean stress sensitivity M: the equivalent
amplitude of pulsating tension is its amplitude times 1 + M. Uniaxial stress at the stress ratios -1
and 0 therefore has the same damage as by the signed von Mises stress.

Cycles are counted for all directions in all planes of a grid (assess.fatigue.many_planes). The
search then starts from each grid maximum that may lead to the largest damage, and turns plane and
direction by ever smaller steps. The damage is not more than 0.5 % below that on a grid of 2 degrees
(`python -m benchmarks planes`).

Source: Findley, J. Eng. Ind. 81 (1959) 301.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from assess.fatigue.flight import RAINFLOW_PASSES, Cycles, Flight, case_by_case, rainflow
from assess.fatigue.many_planes import OnPlanes, on_planes
from assess.fatigue.sn_curve import Life
from fea.core.voigt import TENSOR_TO_VOIGT
from pinbase.arrays import Floats

# Parameters of the search; `python -m benchmarks planes` compares it with a grid of 2 degrees.
PLANE_STEP = 9.0  # degrees between planes of the grid
DIRECTION_STEP = 15.0  # degrees between directions in a plane
STARTS_PER_RANKING = 8  # grid maxima from which the search starts, for each ranking
STEP_HALVINGS = 6  # from half of PLANE_STEP to below 0.1 degrees
FINAL_PLANES = 3  # planes whose cycles are counted one by one
FRAME_ROTATIONS = np.array(list(product((0.0, 1.0, -1.0), repeat=3)))  # about the axes of a frame
ZERO_STRESS = np.zeros((1, 6))


@dataclass(frozen=True)
class PlaneCycles:
    """The cycles of shear stress on the plane with a normal (3,).

    equivalent: (C,) equivalent amplitudes at stress ratio -1, Pa.
    """

    equivalent: Floats
    shear: Cycles
    normal: Floats


def findley_k(sensitivity: float) -> float:
    """Return Findley's k for a mean stress sensitivity M from 0 to below 1."""

    def excess(k: float) -> float:
        pulsating, alternating = (m * k + np.hypot(1.0, m * k) for m in (2.0, 1.0))
        return float(pulsating / alternating - 1.0 - sensitivity)

    return float(brentq(excess, 0.0, 1e3)) if sensitivity > 0.0 else 0.0


def worst_plane(cases: Sequence[Floats], flight: Flight, k: float, life: Life) -> PlaneCycles:
    """Return the cycles on the plane and direction with the largest damage or, if no plane is
    damaged, with the largest equivalent amplitude.

    cases: stress (T, 6), Pa, of each load case.
    k: Findley's.
    life: S-N curve.
    """

    def rank(frames: Floats) -> OnPlanes:
        return on_planes(cases, flight, (frames[:, 0], frames[:, 1]), k, life)

    grid = _grid()
    # A pattern search from each maximum of the grid: turn the frame by a step about all axes, keep
    # the best, halve the step.
    frames = grid.reshape(-1, 3, 3)[_starts(grid, rank(grid.reshape(-1, 3, 3)))]
    for n in range(1, STEP_HALVINGS + 1):
        turned = Rotation.from_rotvec(
            0.5**n * PLANE_STEP * FRAME_ROTATIONS, degrees=True
        ).as_matrix()
        near = (turned[:, None] @ frames).swapaxes(0, 1)  # (starts, turns, 3, 3)
        on_near = rank(near.reshape(-1, 3, 3))
        ranks = (x.reshape(len(frames), -1) for x in (-on_near.largest, -on_near.damage))
        best = [np.lexsort(keys)[0] for keys in zip(*ranks, strict=True)]
        frames = near[np.arange(len(frames)), best]
    last = rank(frames).order()[:FINAL_PLANES]
    tensors = [
        np.concatenate([ZERO_STRESS, stress, ZERO_STRESS])[:, TENSOR_TO_VOIGT] for stress in cases
    ]
    every = [_counted(tensors, flight, (frames[j, 0], frames[j, 1]), k) for j in last]
    return max(every, key=lambda p: (life.damage(p.equivalent).sum(), p.equivalent.max(initial=0)))


def _starts(grid: Floats, on_grid: OnPlanes) -> list[int]:
    """Return the numbers of the grid maxima from which the search starts, the largest by each
    ranking.

    These are maxima over the directions of a plane: near a plane with a larger one, another
    direction may lead to the largest of all. Of several equal maxima only one is taken: under
    uniaxial tension all planes around its axis are equal.
    """
    chosen: dict[int, None] = {}
    for rank in (on_grid.damage, on_grid.softer, on_grid.largest):
        value = rank.reshape(grid.shape[:2])
        both = np.maximum(np.roll(value, 1, axis=1), np.roll(value, -1, axis=1))
        maxima = np.flatnonzero(value >= both)
        _, first = np.unique([f"{x:.3e}" for x in rank[maxima]], return_index=True)
        maxima = maxima[first]
        order = maxima[np.argsort(-rank[maxima], kind="stable")][:STARTS_PER_RANKING]
        chosen |= dict.fromkeys(order.tolist())
    return list(chosen)


def _counted(
    tensors: Sequence[Floats], flight: Flight, plane: tuple[Floats, Floats], k: float
) -> PlaneCycles:
    """Return the cycles on one plane by rainflow counting, with the largest normal stress in each.

    tensors: stress (T, 3, 3), Pa, of each load case, with a zero stress before and after it.
    plane: normal and direction.
    """
    normal, way = plane
    shears, tops = [], []
    for stress in tensors:
        across = stress @ normal
        shear, turns = case_by_case((across @ way)[1:-1])
        shears.append(shear)
        tops.append(np.maximum.reduceat(across @ normal, turns)[:-1])  # up to the next turn
    cycles = rainflow(flight.sequence(shears))
    top = np.tile(flight.sequence(tops), RAINFLOW_PASSES)
    largest = np.array(
        [top[a : b + 1].max() for a, b in zip(cycles.first, cycles.last, strict=True)]
    )
    findley = cycles.amplitude + k * np.maximum(largest, 0.0)
    return PlaneCycles(2.0 / (k + np.hypot(1.0, k)) * findley, cycles, normal)


@cache
def _grid() -> Floats:
    """Return frames (P, D, 3, 3) for P planes over a hemisphere and D directions in each. The rows
    of a frame are the normal, the direction, and the vector perpendicular to both.
    """
    polar, turn = [], []
    for a in np.radians(np.arange(0.0, 90.0 + 0.5 * PLANE_STEP, PLANE_STEP)):
        # A multiple of 8, so that the planes at 45 degrees to the axes are included.
        count = 8 * round(360.0 * np.sin(a) / PLANE_STEP / 8.0) or 1
        polar += [a] * count
        turn += (2.0 * np.pi * np.arange(count) / count).tolist()
    (a, b), (c, s) = ((np.cos(x), np.sin(x)) for x in (np.array(polar), np.array(turn)))
    normals, first = (np.stack(x, axis=1) for x in ([b * c, b * s, a], [a * c, a * s, -b]))
    second = np.stack([-s, c, np.zeros_like(s)], axis=1)
    ways = np.radians(np.arange(0.0, 180.0, DIRECTION_STEP))[None, :, None]
    c, s = np.cos(ways), np.sin(ways)
    first, second = (
        c * first[:, None] + s * second[:, None],
        c * second[:, None] - s * first[:, None],
    )
    return np.stack([np.broadcast_to(normals[:, None], first.shape), first, second], axis=2)

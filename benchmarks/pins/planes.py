"""The critical plane by our search, compared with all planes and directions of a grid of 2 degrees,
for random stress histories; and the times of both.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from assess.fatigue.critical_plane import findley_k, worst_plane
from assess.fatigue.flight import flight
from assess.fatigue.many_planes import on_planes
from assess.fatigue.sn_curve import SnCurve
from benchmarks.timing import table

Floats = NDArray[np.float64]

STEP = 2.0  # degrees
KINDS = ("all components", "tension and shear", "sines out of phase")
HEAD = ("history", "cases", "instants", "damage: ours / grid", "ours [s]", "grid [s]")
K = findley_k(0.25)


def planes() -> str:
    """Return the table."""
    rng = np.random.default_rng(34)
    return table(HEAD, (_row(kind, rng) for kind in KINDS for _ in range(2)))


def _row(kind: str, rng: np.random.Generator) -> tuple[object, ...]:
    cases = [_case(kind, rng) for _ in range(int(rng.integers(1, 4)))]
    order = flight(rng.choice([0.5, 1.0, 2.0, 5.0], len(cases)).tolist())
    life = SnCurve((150e6, 1e6), 5.0, 9.0).life()
    begin = time.perf_counter()
    ours = life.damage(worst_plane(cases, order, K, life).equivalent).sum()
    middle = time.perf_counter()
    whole = on_planes(cases, order, _grid(), K, life).damage.max()
    end = time.perf_counter()
    instants = sum(len(stress) for stress in cases)
    return kind, len(cases), instants, f"{ours / whole:.4f}", middle - begin, end - middle


def _case(kind: str, rng: np.random.Generator) -> Floats:
    stress = np.zeros((int(rng.choice([1, 5, 20])), 6))
    if kind == KINDS[0]:
        return np.asarray(150e6 * rng.normal(size=stress.shape))
    if kind == KINDS[1]:
        stress[:, 2:4] = 300e6 * rng.normal(size=(len(stress), 2))
        return stress
    times = np.linspace(0.0, 1.0, len(stress))[:, None]
    turns = 2.0 * np.pi * (times * rng.integers(1, 4, size=3) + rng.random(3))
    stress[:, 1:4] = 300e6 * rng.normal(size=3) * np.sin(turns)
    return stress


def _grid() -> tuple[Floats, Floats]:
    normals, ways = [], []
    turns = np.radians(np.arange(0.0, 180.0, STEP))[:, None]
    for a in np.radians(np.arange(0.0, 90.0 + STEP / 2.0, STEP)):
        count = max(1, round(360.0 * np.sin(a) / STEP))
        for b in 2.0 * np.pi * np.arange(count) / count:
            along = np.array([np.cos(b) * np.cos(a), np.sin(b) * np.cos(a), -np.sin(a)])
            ways.append(np.cos(turns) * along + np.sin(turns) * [-np.sin(b), np.cos(b), 0.0])
            normal = np.array([np.cos(b) * np.sin(a), np.sin(b) * np.sin(a), np.cos(a)])
            normals.append(np.broadcast_to(normal, ways[-1].shape))
    return np.concatenate(normals), np.concatenate(ways)

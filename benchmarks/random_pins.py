"""Pins drawn at random from a seed, on which the error estimate and the verdicts are tested."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import Distribution, PinLoads
from geometry import Pin, Segment

STEEL = Material("steel", 2.0e11, 0.3, 7850.0, 1.0e9)


@dataclass(frozen=True)
class Trial:
    """A pin with its clamps and one case of loads."""

    pin: Pin
    clamps: tuple[str, ...]
    loads: PinLoads


def trials(count: int, seed: int, fillet: tuple[float, float] | None = (0.04, 0.2)) -> list[Trial]:
    """Return pins with shoulders, one in three a tube, clamped at a thick root or loaded in
    equilibrium.

    fillet: range of the fillet radius over the thinner diameter; None for sharp corners.
    """
    rng = np.random.default_rng(seed)
    return [_trial(rng, k, fillet) for k in range(count)]


def _trial(rng: np.random.Generator, k: int, fillet: tuple[float, float] | None) -> Trial:
    d = float(rng.uniform(0.01, 0.05))
    thick = d * float(rng.uniform(1.2, 2.5))
    step = (thick - d) / 2.0
    rho = 0.0 if fillet is None else min(d * float(rng.uniform(*fillet)), 0.95 * step)
    bore = float(rng.uniform(0.2, 0.6)) * d if k % 3 == 2 else 0.0
    lengths = d * rng.uniform(0.6, 1.5, 4) + 2.0 * rho
    force = rng.normal(size=(5, 2, 3)) * [1.0, 1.0, 0.3] * 1e4
    distribution: Distribution = "cosine" if rng.random() < 0.4 else "uniform"
    if k % 2:  # a cantilever out of a thick root
        segments = (
            Segment(float(lengths[0]) + thick, thick, bore, name="root"),
            Segment(float(lengths[1]), d, bore, name="neck"),
            Segment(float(lengths[2]), d, bore, connection="A"),
        )
        loads = PinLoads("case", ("A",), force[:, :1], distribution=distribution)
        return Trial(Pin(f"cantilever {k}", segments, rho), ("start",), loads)
    segments = (
        Segment(float(lengths[0]), d, bore, connection="A"),
        Segment(float(lengths[1]), thick, bore, connection="B"),
        Segment(float(lengths[2]), d, bore, connection="C"),
    )
    rng.uniform(0.3, 0.7)  # unused, but keeps the numbers that are drawn after it
    share = float((lengths[1] + lengths[2]) / (lengths[0] + 2.0 * lengths[1] + lengths[2]))
    both = np.stack([-share * force[:, 0], force[:, 0], (share - 1.0) * force[:, 0]], axis=1)
    loads = PinLoads("case", ("A", "B", "C"), both, distribution=distribution)
    return Trial(Pin(f"floating {k}", segments, rho), (), loads)

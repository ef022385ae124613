"""Pins with cross holes drawn at random, seeded: what the error of the local solids is tried on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.pin_loads import PinLoads
from geometry import CutPin, Hole, Pin, Segment


@dataclass(frozen=True)
class CutTrial:
    """A pin with holes, what holds it, and one case of loads."""

    pin: CutPin
    clamps: tuple[str, ...]
    loads: PinLoads


def cut_trials(count: int, seed: int) -> list[CutTrial]:
    """Floating pins and cantilevers with a hole, or two, in a shaft, one in three next to a step
    with a fillet and one in four bored; loads in all directions.
    """
    rng = np.random.default_rng(seed)
    return [_trial(rng, k) for k in range(count)]


def _trial(rng: np.random.Generator, k: int) -> CutTrial:
    d = float(rng.uniform(0.01, 0.05))
    bore = float(rng.uniform(0.2, 0.5)) * d if k % 4 == 3 else 0.0
    step = k % 3 == 2
    thick = d * float(rng.uniform(1.1, 1.5)) if step else d
    rho = 0.4 * (thick - d)
    shaft = d * float(rng.uniform(2.0, 5.0))
    segments = (
        Segment(0.7 * d + rho, thick, bore, connection="A"),
        Segment(0.3 * d, thick, bore),
        Segment(shaft, d, bore, name="shaft"),
        Segment(d, d, bore, connection="B"),
    )
    holes = _holes(rng, d, segments[0].length + segments[1].length, shaft, rho, k)
    pin = CutPin(Pin(f"cut {k}", segments, rho), holes)
    force = rng.normal(size=(1, 2, 3)) * [1.0, 1.0, 3.0] * 1e4
    couple = rng.normal(size=(1, 2, 3)) * [0.0, 0.0, 0.3] * 1e4 * d
    if k % 2:
        return CutTrial(pin, ("start",), PinLoads("case", ("B",), force[:, :1], couple[:, :1]))
    middle = [segments[0].length / 2.0 + rho / 2.0, pin.length - d / 2.0]
    across = force[:, 0, :2] * (middle[1] - middle[0])
    force[:, 1] = -force[:, 0]  # the couple of both is carried by moments
    couple[:, 0, :2] = 0.5 * np.stack([-across[:, 1], across[:, 0]], axis=1)
    couple[:, 1] = couple[:, 0] * [1.0, 1.0, 0.0]
    couple[:, 1, 2] = -couple[:, 0, 2]
    return CutTrial(pin, (), PinLoads("case", ("A", "B"), force, couple))


def _holes(
    rng: np.random.Generator, d: float, start: float, shaft: float, rho: float, k: int
) -> tuple[Hole, ...]:
    size = d * float(rng.uniform(0.08, 0.35))
    angle = float(rng.uniform(0.0, np.pi)) if k % 2 else 0.0
    low, high = start + rho + 0.8 * size, start + shaft - 0.8 * size
    z = float(rng.uniform(low, high))
    if k % 5 == 4 and high - z > 1.5 * size:
        return Hole(z, size, angle), Hole(z + 1.5 * size, size, angle + np.pi / 2.0)
    return (Hole(z, size, angle),)

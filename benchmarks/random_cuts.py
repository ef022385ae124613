"""Pins with cuts drawn at random, seeded: what the error of the local solids is tried on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.pin_loads import PinLoads
from geometry import Bottom, Cut, CutPin, Flat, Hole, Pin, Segment, Slot


@dataclass(frozen=True)
class CutTrial:
    """A pin with cuts, what holds it, and one case of loads."""

    pin: CutPin
    clamps: tuple[str, ...]
    loads: PinLoads


def cut_trials(count: int, seed: int) -> list[CutTrial]:
    """Shafts with a hole, one in five with two, one in four bored; out of a thick root that is
    clamped, with a band on a thick end, or plain ones between two bands. Loads in all directions.
    """
    rng = np.random.default_rng(seed)
    return [_trial(rng, k) for k in range(count)]


def kind_trials(count: int, seed: int) -> list[CutTrial]:
    """The same with rounded flats, keyways, slots, blind, countersunk and rounded holes."""
    rng = np.random.default_rng(seed)
    return [_trial(rng, k, kinds=True) for k in range(count)]


def _trial(rng: np.random.Generator, k: int, kinds: bool = False) -> CutTrial:
    d = float(rng.uniform(0.01, 0.05))
    bore = float(rng.uniform(0.2, 0.5)) * d if k % 4 == 3 else 0.0
    thick = d * float(rng.uniform(1.4, 2.0))
    rho, shaft = 0.3 * (thick - d), d * float(rng.uniform(1.5, 4.0))
    root, end = (
        Segment(thick, thick, bore, name="root"),
        Segment(thick, thick, bore, connection="B"),
    )
    segments = (root, Segment(shaft + 2.0 * rho, d, bore, name="shaft"), end)
    if k % 2:
        segments = (Segment(thick, thick, bore, connection="A"), *segments[1:])
    cuts: tuple[Cut, ...] = _holes(rng, d, thick + rho, shaft, k)
    if kinds:
        cuts = (_cut(rng, d, thick + rho + 0.5 * shaft, k),)
    pin = CutPin.of(Pin(f"cut {k}", segments, rho), cuts)
    size = 1e4 * np.array([1.0, 1.0, 3.0])
    force = rng.normal(size=(1, 1, 3)) * size
    couple = rng.normal(size=(1, 1, 3)) * size * d
    if k % 2 == 0:
        return CutTrial(pin, ("start",), PinLoads("case", ("B",), force, couple))
    arm = pin.band("B").middle - pin.band("A").middle
    x, y, _ = force[0, 0] * arm
    other = -couple[0, 0] - np.array([-y, x, 0.0])
    both = np.stack([-force[:, 0], force[:, 0]], axis=1)
    return CutTrial(pin, (), PinLoads("case", ("A", "B"), both, np.stack([other, couple[0, 0]])))


def _holes(
    rng: np.random.Generator, d: float, start: float, shaft: float, k: int
) -> tuple[Hole, ...]:
    size = d * float(rng.uniform(0.08, 0.35))
    angle = float(rng.uniform(0.0, np.pi))
    low, high = start + 0.7 * size, start + shaft - 0.7 * size
    z = float(rng.uniform(low, high))
    if k % 5 == 4 and high - z > 1.5 * size:
        return Hole(z, size, angle), Hole(z + 1.5 * size, size, angle + np.pi / 2.0)
    return (Hole(z, size, angle),)


def _cut(rng: np.random.Generator, d: float, z: float, k: int) -> Cut:
    """At the middle of a shaft, not deeper than a bore leaves it."""
    size, angle = d * float(rng.uniform(0.12, 0.3)), float(rng.uniform(-np.pi, np.pi))
    deep, half = d * float(rng.uniform(0.12, 0.2)), d * float(rng.uniform(0.3, 0.6))
    rounded = size * float(rng.uniform(0.1, 0.2))
    match k % 6:
        case 0:
            return Flat(z - half, z + half, d / 2.0 - 0.6 * deep, angle, 0.4 * deep)
        case 1:
            return Slot(z - half, z + half, size, deep, angle, rounded)
        case 2:
            return Hole(z, size, angle, deep, Bottom(radius=rounded))
        case 3:
            return Slot(z - 0.6 * size, z + 0.6 * size, size, None, angle)
        case 4:
            return Hole(z, size, angle, chamfer=0.15 * size)
        case _:
            return Hole(z, size, angle, mouth_radius=0.15 * size)

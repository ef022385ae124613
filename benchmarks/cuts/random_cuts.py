"""Pins with cuts drawn at random from a seed, on which the error of local solids is tested."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fea.core.pin_loads import PinLoads
from geometry import Bottom, Cut, CutPin, Flat, Hole, Pin, Segment, Slot

KINDS = "clamped", "between", "held twice", "pressed"


@dataclass(frozen=True)
class CutTrial:
    """A pin with cuts, its clamps, and one case of loads."""

    pin: CutPin
    clamps: tuple[str, ...]
    loads: PinLoads


def cut_trials(count: int, seed: int) -> list[CutTrial]:
    """Return shafts with a hole, one in five with two holes, one in four bored, under loads in all
    directions.

    Their kinds alternate: with a thick root that is clamped; with bands on thick ends; clamped at
    both ends; and loaded on the shaft itself, about the hole, and held by bands on thick ends.
    """
    rng = np.random.default_rng(seed)
    return [_trial(rng, k) for k in range(count)]


def _trial(rng: np.random.Generator, k: int) -> CutTrial:
    d = float(rng.uniform(0.01, 0.05))
    bore = float(rng.uniform(0.2, 0.5)) * d if (k // 4 + k) % 4 == 3 else 0.0
    thick = d * float(rng.uniform(1.4, 2.0))
    rho, shaft = 0.3 * (thick - d), d * float(rng.uniform(1.5, 4.0))
    size = d * float(rng.uniform(0.08, 0.35))
    force = rng.normal(size=(1, 1, 3)) * 1e4 * np.array([1.0, 1.0, 3.0])
    couple = rng.normal(size=(1, 1, 3)) * 1e4 * np.array([1.0, 1.0, 3.0]) * d
    middle = Segment(shaft + 2.0 * rho, d, bore, name="shaft")
    kind = k % 4
    first, last = Segment(thick, thick, bore, "root"), Segment(thick, thick, bore, "tip")
    if kind % 2:
        first = replace(first, name=None, connection="A")
    if kind != 2:
        last = replace(last, name=None, connection="B")
    low, high = thick + rho + 0.7 * size, thick + rho + shaft - 0.7 * size
    if kind >= 2:  # a band about the hole
        middle = replace(middle, name=None, connection="C")
    holes = _holes(rng, size, low, high, k)
    pin = CutPin(Pin(f"cut {k} {KINDS[kind]}", (first, middle, last), rho), holes)
    if kind == 0:
        return CutTrial(pin, ("start",), PinLoads("case", ("B",), force, couple))
    if kind == 1:
        arm = pin.band("B").middle - pin.band("A").middle
        x, y, _ = force[0, 0] * arm
        other = -couple[0, 0] - np.array([-y, x, 0.0])
        both = np.stack([-force[:, 0], force[:, 0]], axis=1)
        loads = PinLoads("case", ("A", "B"), both, np.stack([other, couple[0, 0]])[None])
        return CutTrial(pin, (), loads)
    across = force * np.array([1.0, 1.0, 0.0])
    if kind == 2:
        loads = PinLoads("case", ("C",), across, distribution="cosine")
        return CutTrial(pin, ("start", "end"), loads)
    three = np.concatenate([-0.5 * across, across, -0.5 * across], axis=1)
    loads = PinLoads("case", ("A", "C", "B"), three, distribution="cosine")
    return CutTrial(pin, (), loads)


def _holes(
    rng: np.random.Generator, size: float, low: float, high: float, k: int
) -> tuple[Hole, ...]:
    angle = float(rng.uniform(0.0, np.pi))
    z = float(rng.uniform(low, high))
    if k % 5 == 4 and high - z > 1.5 * size:
        return Hole(z, size, angle), Hole(z + 1.5 * size, size, angle + np.pi / 2.0)
    return (Hole(z, size, angle),)


def kind_trials(count: int, seed: int) -> list[CutTrial]:
    """Return similar shafts with rounded flats, keyways, slots, and blind, countersunk and rounded
    holes.
    """
    rng = np.random.default_rng(seed)
    return [_kind_trial(rng, k) for k in range(count)]


def _kind_trial(rng: np.random.Generator, k: int) -> CutTrial:
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
    cuts = (_cut(rng, d, thick + rho + 0.5 * shaft, k),)
    pin = CutPin(Pin(f"cut {k}", segments, rho), cuts)
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


def _cut(rng: np.random.Generator, d: float, z: float, k: int) -> Cut:
    """Return a cut at the middle of a shaft, no deeper than its bore allows."""
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

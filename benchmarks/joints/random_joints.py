"""Pins in lugs drawn at random from a seed, on which smaller models of a joint are tested."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment

FORCE = 1e4


@dataclass(frozen=True)
class JointTrial:
    """A pin in its lugs under one instant of loads along x."""

    pin: Pin
    material: Material
    lugs: tuple[Lug, ...]
    loads: PinLoads


def joint_trials(count: int, seed: int) -> list[JointTrial]:
    """Return joints in single and double shear without clearance.

    Diameters are 5 to 100 mm; lugs are 0.3 to 3 diameters thick and 1.6 to 4 wide, with gaps of up
    to 0.3; moduli differ by up to a factor of 3. One pin in three is a tube with a bore of up to
    0.7, one in three has shoulders. Lugs are guided, free to tilt, or on the bending stiffness of a
    shank.
    """
    rng = np.random.default_rng(seed)
    return [_joint(rng, k) for k in range(count)]


def _joint(rng: np.random.Generator, k: int) -> JointTrial:
    d = 0.005 * 20.0 ** float(rng.random())
    names = "ABC" if rng.random() < 0.6 else "AB"
    held = int(rng.integers(len(names)))  # the lug that is not free to tilt, to react a couple
    material = Material("pin", 2.1e11, float(rng.uniform(0.25, 0.34)), 7850.0)
    bore = float(rng.uniform(0.1, 0.7)) * d if k % 3 == 1 else 0.0
    wide = d * (float(rng.uniform(1.05, 1.4)) if k % 3 == 2 else 1.0)
    segments = [Segment(d * float(rng.uniform(0.05, 0.5)), d, bore)]
    lugs: list[Lug] = []
    for b, name in enumerate(names):
        if b and rng.random() < 0.8:
            segments.append(Segment(d * float(rng.uniform(0.01, 0.3)), d, bore))
        thick = d * 0.3 * 10.0 ** float(rng.random())
        own = wide if b == 1 else d
        segments.append(Segment(thick, own, bore, connection=name))
        lugs.append(_lug(rng, name, own, thick, b != held))
    segments.append(Segment(d * float(rng.uniform(0.05, 0.5)), d, bore))
    share = float(rng.uniform(0.3, 0.7))
    forces = [-share, 1.0, share - 1.0] if len(names) == 3 else [-1.0, 1.0]
    along = FORCE * np.array(forces)[None, :, None] * [1.0, 0.0, 0.0]
    pin = Pin(f"joint {k}", tuple(segments))
    return JointTrial(pin, material, tuple(lugs), PinLoads("pull", tuple(names), along))


def _lug(rng: np.random.Generator, name: str, d: float, thick: float, free: bool) -> Lug:
    """Return a lug. free: whether it may be free to tilt."""
    stiff = 2.1e11 * 3.0 ** float(rng.uniform(-1.0, 1.0))
    across, arm = d * float(rng.uniform(1.6, 4.0)), float(rng.uniform(0.5, 1.5))
    shank = stiff * thick**3 / (12.0 * arm)  # as wide as the eye, held `arm` widths away
    tilt = (math.inf, shank, 0.0 if free else shank)[int(rng.integers(3))]
    return Lug(name, across, Material("lug", stiff, float(rng.uniform(0.25, 0.34))), tilt=tilt)


def filleted_trials(count: int, seed: int) -> list[JointTrial]:
    """Return joints whose pin has a middle 1.05 to 1.4 times as thick, with guided lugs.

    The fillets are 0.15 to 0.3 diameters from the edges of lugs, which are rounded by up to 0.05.
    """
    rng = np.random.default_rng(seed)
    return [_filleted(rng, k) for k in range(count)]


def _filleted(rng: np.random.Generator, k: int) -> JointTrial:
    d, names = 0.005 * 20.0 ** float(rng.random()), "AB" if k % 3 == 2 else "ABC"
    wide = d * float(rng.uniform(1.05, 1.4))
    fillet, apart = (
        0.5 * (wide - d) * float(rng.uniform(0.25, 0.9)),
        d * float(rng.uniform(0.15, 0.3)),
    )
    edge = d * float(rng.uniform(0.005, 0.05))
    material = Material("pin", 2.1e11, 0.3)
    segments, lugs = [Segment(0.2 * d, d)], []
    for name in names:
        own = wide if name == "B" else d
        thick = d * 0.3 * 8.0 ** float(rng.random())
        before = Segment(apart + fillet, d, fillet=fillet), Segment(apart, wide)
        after = Segment(apart, wide, fillet=fillet), Segment(apart + fillet, d)
        middle = Segment(thick, own, connection=name)
        segments += [*before, middle, *after] if name == "B" else [middle]
        across = own * float(rng.uniform(1.6, 4.0))
        lugs.append(Lug(name, across, material, edge_radius=min(edge, 0.2 * thick)))
    segments.append(Segment(0.2 * d, d))
    forces = [-0.5, 1.0, -0.5] if len(names) == 3 else [-1.0, 1.0]
    along = FORCE * np.array(forces)[None, :, None] * [1.0, 0.0, 0.0]
    pin = Pin(f"joint with fillets {k}", tuple(segments))
    return JointTrial(pin, material, tuple(lugs), PinLoads("pull", tuple(names), along))

"""What a check is made of: a pin, its lugs, its loads in a case, and the factors on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.joint.lugs.lug import Lug
from fea.joint.records import JointForces
from fea.strength.margin import Level
from geometry import Pin
from geometry.arrays import Floats

SUPPORTS = 2  # lugs of a structure whose forces follow from equilibrium


@dataclass(frozen=True)
class LoadFactors:
    """Factors on the loads of a study: at limit load (against yield), at ultimate load (against
    rupture and collapse), and of fittings, which multiplies both.

    Source: 14 CFR 25.301 and 25.303 (limit and ultimate loads), 25.625 (fitting factor).
    """

    limit: float = 1.0
    ultimate: float = 1.5
    fitting: float = 1.0

    def at(self, level: Level) -> float:
        """The factor on demands at a level."""
        return (self.limit if level == "limit" else self.ultimate) * self.fitting


@dataclass(frozen=True)
class Situation:
    """A pin in a case. lugs: those that the study gives; loads: on all bands that carry, in balance
    or with `clamps`. replaceable: whether the pin is meant to be replaced. joint: section forces by
    the joint model, if one supports the pin; even_governs: whether checks of bending and shear take
    the even loads of the formulas all the same.
    """

    pin: Pin
    material: Material
    loads: PinLoads
    clamps: tuple[str, ...] = ()
    lugs: tuple[Lug, ...] = ()
    factors: LoadFactors = LoadFactors()
    replaceable: bool = False
    joint: JointForces | None = None
    even_governs: bool = False

    @property
    def across(self) -> Floats:
        """Size of the force across the pin on each of C bands, (T, C) N."""
        return np.asarray(np.hypot(self.loads.forces[..., 0], self.loads.forces[..., 1]))

    def lug(self, band: str) -> Lug | None:
        """In which a band sits, if it was given."""
        return next((lug for lug in self.lugs if lug.connection == band), None)


def with_supports(pin: Pin, loads: PinLoads, structure: Sequence[str]) -> PinLoads | None:
    """The loads with the forces of the lugs of a structure, by equilibrium of forces and moments
    across the pin; None unless there are two. Without the weight of the pin, which the closing
    tractions of a balance carry.
    """
    if not structure:
        return loads
    if len(structure) != SUPPORTS:
        return None
    first, second = (pin.band(name).middle for name in structure)
    middles = np.array([pin.band(name).middle for name in loads.surfaces])
    force = loads.forces[:, :, :2]
    # About the first support, of forces and of couples, along x and y.
    couple = np.stack([loads.moments[..., 1], -loads.moments[..., 0]], axis=-1)
    moment = (force * (middles - first)[:, None] + couple).sum(axis=1)
    at_second = -moment / (second - first)
    at_first = -force.sum(axis=1) - at_second
    added = np.zeros((len(loads), SUPPORTS, 3))
    added[:, 0, :2], added[:, 1, :2] = at_first, at_second
    none = np.zeros_like(added)
    return replace(
        loads,
        surfaces=(*loads.surfaces, *structure),
        forces=np.concatenate([loads.forces, added], axis=1),
        moments=np.concatenate([loads.moments, none], axis=1),
    )

"""What a check is made of: a pin, its lugs, its loads in a case, and the factors on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from assess.strength.margin import Level
from fea.core.equilibrium import out_of_balance
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug
from fea.support.records import JointForces
from geometry import Pin
from pinbase.arrays import Floats

MAX_LEFT_COUPLE = 0.01  # couple that balance leaves, of the largest force times the pin's length
SUPPORT_COUNT = 2  # lugs of a structure whose forces follow from equilibrium


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
    the even loads of the formulas all the same. simple: the loads by the statics of formulas, where
    those of the joint differ.
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
    simple: PinLoads | None = None

    @property
    def by_formula(self) -> PinLoads:
        """The loads of which formulas make section forces."""
        return self.loads if self.simple is None else self.simple

    @cached_property
    def balanced(self) -> bool:
        """Whether these loads leave no couple across the pin that its bands would have to share."""
        if self.clamps:
            return True
        left = out_of_balance(self.pin, self.by_formula)
        return left.couple <= MAX_LEFT_COUPLE * left.largest * self.pin.length

    @property
    def joint_governs(self) -> bool:
        """Whether section forces of the joint govern: also beside even loads that are requested,
        where these leave out the couples of lugs.
        """
        return self.joint is not None and not (self.even_governs and self.balanced)

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
    if len(structure) != SUPPORT_COUNT:
        return None
    first, second = (pin.band(name).middle for name in structure)
    middles = np.array([pin.band(name).middle for name in loads.surfaces])
    force = loads.forces[:, :, :2]
    # About the first support, of forces and of couples, along x and y.
    couple = np.stack([loads.moments[..., 1], -loads.moments[..., 0]], axis=-1)
    moment = (force * (middles - first)[:, None] + couple).sum(axis=1)
    at_second = -moment / (second - first)
    at_first = -force.sum(axis=1) - at_second
    return _with_forces(loads, structure, np.stack([at_first, at_second], axis=1))


def with_solved(loads: PinLoads, structure: Sequence[str], joint: JointForces) -> PinLoads:
    """The loads, at the joint's instants, with the forces of a structure's lugs as the joint model
    has them.
    """
    own = [joint.lugs.index(name) for name in structure]
    return _with_forces(loads, structure, joint.forces[:, own])


def _with_forces(loads: PinLoads, structure: Sequence[str], across: Floats) -> PinLoads:
    """across: of the structure's lugs on the pin, (T, S, 2) N."""
    added = np.concatenate([across, np.zeros((*across.shape[:2], 1))], axis=2)
    none = np.zeros_like(added)
    return replace(
        loads,
        surfaces=(*loads.surfaces, *structure),
        forces=np.concatenate([loads.forces, added], axis=1),
        moments=np.concatenate([loads.moments, none], axis=1),
    )

"""Friction of a pin in its lugs, bounded by the pressures of contact without it.

Torque: where pin and lug turn on each other, friction is mu p on every cell, against the sliding:
the torque between them is at most mu times the integral of p R over the band. That is more than mu
F R, since pressures on an arc do not all point along their resultant. Which lugs turn on the pin,
and which way, is not known: a section's torque is at most that of all rings on one side of it, and
of all rings on the other, which react it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fea.core.pin_loads import UnitLoad
from fea.support.contact.contact import ContactState
from fea.support.contact.pressure_loads import PressureLoads
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from pinbase.arrays import Floats

TURNING = "links turning on the pin"
SENSES = 1.0, -1.0  # of the torque, which counts where a case has torques of its own


def rubs(lugs: Sequence[Lug]) -> bool:
    """Return whether any of the lugs has friction."""
    return any(lug.friction for lug in lugs)


def coefficient_words(lugs: Sequence[Lug]) -> str:
    """Return the coefficients of friction of lugs in words."""
    ends = dict.fromkeys(f"{f(lug.friction for lug in lugs):g}" for f in (min, max))
    return " to ".join(ends)


def ring_torques(model: ContactModel, states: Sequence[ContactState]) -> Floats:
    """The largest torque of friction between each ring and its lug, (T, R) N m."""
    bands = model.bands
    friction = np.array([lug.friction for lug in model.lugs])[bands.band]
    area = 2.0 * np.pi * bands.radius * bands.length
    mean = np.stack([state.pressure.mean(axis=1) for state in states])
    return np.asarray(mean * area * bands.radius * friction)


def band_torques(model: ContactModel, states: Sequence[ContactState]) -> Floats:
    """The largest torque of friction between the pin and each lug, (T, B) N m."""
    rings = ring_torques(model, states)
    each = [rings[:, model.bands.band == b].sum(axis=1) for b in range(len(model.lugs))]
    return np.stack(each, axis=1)


def opposed(torques: Floats, z: Floats) -> Floats:
    """The torques (R,) on rings, in balance, by which every section has the largest torque that
    friction can cause there.

    torques: the largest of each ring, (R,) N m. z: of their middles, (R,) m.
    """
    order = np.argsort(z)
    before = np.cumsum(torques[order])
    total = before[-1]
    at_ends = np.minimum(before, total - before)  # of each ring
    at_ends[-1] = 0.0
    most = at_ends.max()
    if most <= 0.0:
        return np.zeros_like(torques)
    # Within the ring where one half of all torque is reached, a section has that half.
    out = np.zeros_like(torques)
    out[order] = np.diff(at_ends, prepend=0.0) * (0.5 * total / most)
    return out


def turning(model: ContactModel, state: ContactState, loads: PressureLoads) -> list[PressureLoads]:
    """The loads of one instant with the torques of friction, in both senses."""
    torque = opposed(ring_torques(model, [state])[0], model.bands.z)
    return [with_torques(loads, sense * torque) for sense in SENSES]


def with_torques(loads: PressureLoads, torque: Floats) -> PressureLoads:
    """Loads on rings with further torques (R,) N m on them at every instant."""
    moments, acting = loads.moments.copy(), dict(loads.acting)
    moments[:, :, 2] += torque
    for r in np.flatnonzero(torque):
        unit = UnitLoad(loads.surfaces[r], "moment", 0)
        amount = np.zeros((len(loads), 2)) + acting.get(unit, 0.0)
        amount[:, 1] += torque[r]
        acting[unit] = amount
    return replace(loads, moments=moments, acting=acting)

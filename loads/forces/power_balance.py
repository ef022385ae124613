"""Energies of a linkage, and the balance of the powers that change them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.forces.acting import power
from loads.forces.inverse_dynamics import Dynamics
from loads.motion.complex_points import number
from loads.motion.motion import Motion
from pinbase.arrays import Floats

MIN_POWER_SHARE = 1e-6  # of the largest force times the pace: a smaller power is round-off


@dataclass(frozen=True)
class Energy:
    """Kinetic and potential energy, (T,) J."""

    kinetic: Floats
    potential: Floats


def energy(motion: Motion) -> Energy:
    """Energies of all items; the potential energy is zero at the world's origin."""
    centres, velocity, _ = motion.centres
    weight = motion.masses * number(motion.linkage.gravity)
    return Energy(
        kinetic=0.5 * (np.abs(velocity) ** 2 @ motion.masses + motion.spin**2 @ motion.inertias),
        potential=-np.real(centres @ np.conj(weight)),
    )


@dataclass(frozen=True)
class Ledger:
    """Powers supplied to a linkage and the rate of its kinetic energy, (T,) W each.

    applied: power of loads, springs and dampers.
    min_power: power below which powers are round-off, W.
    """

    drives: Floats
    gravity: Floats
    applied: Floats
    friction: Floats
    kinetic_rate: Floats
    min_power: float

    @property
    def violation(self) -> float:
        """Largest difference of power supplied and kinetic rate, relative to the largest power."""
        terms = (self.drives, self.gravity, self.applied, self.friction, self.kinetic_rate)
        largest = max(self.min_power, *(float(np.abs(t).max(initial=0.0)) for t in terms))
        gap = self.drives + self.gravity + self.applied + self.friction - self.kinetic_rate
        return float(np.abs(gap).max(initial=0.0)) / largest if largest else 0.0


def ledger(dynamics: Dynamics) -> Ledger:
    """The power balance at every instant."""
    motion = dynamics.motion
    _, velocity, acceleration = motion.centres
    pull = np.conj(number(motion.linkage.gravity))
    turns = np.stack([motion.turning(j, c) for j, c in motion.linkage.connections], axis=1)
    slides = motion.v[:, motion.loops.frames - 1 :]
    return Ledger(
        drives=dynamics.power.sum(axis=1),
        gravity=np.real(velocity * pull) @ motion.masses,
        applied=power(motion, dynamics.applied),
        friction=np.sum(dynamics.sliders.friction * slides, axis=1)
        + np.sum(dynamics.pin_friction * turns, axis=1),
        kinetic_rate=np.real(np.conj(velocity) * acceleration) @ motion.masses
        + (motion.spin * motion.spin_rate) @ motion.inertias,
        min_power=MIN_POWER_SHARE * motion.pace * float(np.abs(dynamics.reactions.forces).max()),
    )

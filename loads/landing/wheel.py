"""Spin-up and spring-back of a wheel that slides until it rolls, on a leg that bends.

The axes move with the aircraft, whose speed V is constant. x is the deflection of the axle aft, and
w is the angular velocity of the wheel. The tyre slides over the ground at V - x' - w r.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.arrays import Floats


@dataclass(frozen=True)
class Wheel:
    """A wheel that does not rotate at touch-down, on a leg that may bend.

    inertia: moment of inertia of the wheel, kg m^2.
    radius: rolling radius r of the loaded tyre, m.
    speed: speed V of the aircraft over the ground, m/s.
    friction: friction coefficient of the sliding tyre.
    stiffness: fore-and-aft stiffness of the leg at the axle, N/m; None for a rigid leg.
    mass: mass that moves with the axle as the leg bends, kg.
    damping: damping of the bending, ratio to critical.
    """

    inertia: float
    radius: float
    speed: float
    friction: float = 0.8
    stiffness: float | None = None
    mass: float = 0.0
    damping: float = 0.0

    @property
    def rate(self) -> float:
        """Coefficient of viscous damping of the leg's bending, N s/m."""
        return 2.0 * self.damping * float(np.sqrt((self.stiffness or 0.0) * self.mass))

    def slip(self, bend_rate: Floats, spin: Floats) -> Floats:
        """Sliding speed of the tyre, (T,) m/s, positive aft.

        bend_rate: x', (T,) m/s. spin: w, (T,) rad/s.
        """
        return np.asarray(self.speed - bend_rate - spin * self.radius)

    def bending_force(self, bend: Floats, bend_rate: Floats) -> Floats:
        """Forward force of the leg on the axle, (T,) N: the drag that a flexible leg passes on."""
        return np.asarray((self.stiffness or 0.0) * bend + self.rate * bend_rate)

    def rolling_drag(self, bend: Floats, bend_rate: Floats) -> Floats:
        """Drag (T,) N on a wheel that rolls while the leg bends."""
        if self.stiffness is None:
            return np.zeros_like(bend)
        rolling_mass = self.inertia / self.radius**2
        share = rolling_mass / (self.mass + rolling_mass)
        return np.asarray(share * self.bending_force(bend, bend_rate))

    def rates(self, drag: Floats, bend: Floats, bend_rate: Floats) -> tuple[Floats, Floats]:
        """Accelerations x'' (m/s^2) and w' (rad/s^2), (T,) each, due to the drag (T,) N."""
        if self.stiffness is None:
            bend_acceleration = np.zeros_like(drag)
        else:
            bend_acceleration = (drag - self.bending_force(bend, bend_rate)) / self.mass
        return np.asarray(bend_acceleration), np.asarray(drag * self.radius / self.inertia)

    def on_leg(self, drag: Floats, bend: Floats, bend_rate: Floats) -> Floats:
        """Drag (T,) N that the leg passes on to the aircraft; a rigid leg passes on all of it."""
        return drag if self.stiffness is None else self.bending_force(bend, bend_rate)

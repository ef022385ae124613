"""Spin-up and spring-back: the wheel that slides until it rolls, on a leg that bends.

Seen from the aircraft, which keeps its speed: x is how far the axle is bent aft, w the wheel's
angular velocity, and the tyre slides over the ground at V - x' - w r.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.arrays import Floats


@dataclass(frozen=True)
class Wheel:
    """A wheel that touches the ground without turning.

    inertia: kg m^2. radius: rolling radius of the loaded tyre, m. speed: of the aircraft over
    ground, m/s. friction: coefficient of the sliding tyre. stiffness: of the leg fore and aft at
    the axle, N/m; None: rigid. mass: that moves with the axle then, kg. damping: of its bending,
    ratio to critical.
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
        """Coefficient of the viscous damping, N s/m."""
        return 2.0 * self.damping * float(np.sqrt((self.stiffness or 0.0) * self.mass))

    def slip(self, bend_rate: Floats, spin: Floats) -> Floats:
        """Speed (T,) at which the tyre slides aft, m/s."""
        return np.asarray(self.speed - bend_rate - spin * self.radius)

    def bending_force(self, bend: Floats, bend_rate: Floats) -> Floats:
        """Of the leg on the axle, forward, (T,) N: also the drag that the leg passes on."""
        return np.asarray((self.stiffness or 0.0) * bend + self.rate * bend_rate)

    def rolling_drag(self, bend: Floats, bend_rate: Floats) -> Floats:
        """Drag (T,) N that keeps a rolling wheel rolling."""
        if self.stiffness is None:
            return np.zeros_like(bend)
        heavy = self.inertia / self.radius**2
        return np.asarray(heavy / (self.mass + heavy) * self.bending_force(bend, bend_rate))

    def rates(self, drag: Floats, bend: Floats, bend_rate: Floats) -> tuple[Floats, Floats]:
        """x'' and w', (T,), under the drag (T,) N of the ground."""
        if self.stiffness is None:
            bends = np.zeros_like(drag)
        else:
            bends = (drag - self.bending_force(bend, bend_rate)) / self.mass
        return np.asarray(bends), np.asarray(drag * self.radius / self.inertia)

    def on_leg(self, drag: Floats, bend: Floats, bend_rate: Floats) -> Floats:
        """Drag (T,) N that the leg passes on: of a rigid one, all of it."""
        return drag if self.stiffness is None else self.bending_force(bend, bend_rate)

"""The contact of a pin at one instant."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fea.core.pin_loads import Floats
from pinbase.arrays import Mask


@dataclass(frozen=True)
class ContactState:
    """The contact of a pin at one instant.

    pressure: (R, M), Pa, on the cells.
    gap: (R, M), m.
    shift: (B, 2), m, of the lugs against the pin along x and y.
    turn: (2,), slopes dx / dz and dy / dz of the pin.
    steps: number of active-set steps.
    angle: of the first cells' middle from the x axis, rad.
    """

    pressure: Floats
    gap: Floats
    shift: Floats
    turn: Floats
    steps: int
    angle: float = 0.0

    @property
    def active(self) -> Mask:
        """A mask (R, M) of the cells in contact."""
        return self.gap <= 0.0

    def times(self, factor: float) -> ContactState:
        """The state under so many times the loads, valid where there is no gap before loading."""
        return ContactState(
            factor * self.pressure,
            factor * self.gap,
            factor * self.shift,
            factor * self.turn,
            0,
            self.angle,
        )

    def turned(self, angle: float) -> ContactState:
        """The state turned about the axis by an angle, rad."""
        turn = rotation(angle).T
        return replace(
            self, shift=self.shift @ turn, turn=self.turn @ turn, angle=self.angle + angle
        )


def rotation(angle: float) -> Floats:
    """The matrix (2, 2) that rotates columns (x, y) by an angle, rad."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def wide_gap_half_angle(load: Floats, closing: Floats) -> Floats:
    """The half angle of contact, rad, of Persson's plane contact in the limit of large gaps,
    E* gap / load = 2 / (pi tan^2(half / 2)); too wide for small ones.

    load: per length, N/m, or all along a length, N.
    closing: E* times the gap on the radius, in the same unit; 4 R / E* is the tail of pin and lug
    together.
    """
    closed = np.sqrt(np.pi * np.maximum(closing, 0.0))
    return np.asarray(2.0 * np.arctan2(np.sqrt(2.0 * load), closed))

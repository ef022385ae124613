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

    pressure: on the cells, (R, M) Pa.
    gap: mean over the cells, (R, M) m.
    shift: of the lugs relative to the pin along x and y, (B, 2) m.
    turn: slopes dx / dz and dy / dz of the pin, (2,).
    steps: number of active-set steps.
    angle: of the middle of the first sector from the x axis, rad.
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
        """The state under the loads times a factor, valid only without a gap before loading."""
        return ContactState(
            factor * self.pressure,
            factor * self.gap,
            factor * self.shift,
            factor * self.turn,
            0,
            self.angle,
        )

    def turned(self, angle: float) -> ContactState:
        """The state rotated about the axis by an angle, rad."""
        turn = rotation(angle).T
        return replace(
            self, shift=self.shift @ turn, turn=self.turn @ turn, angle=self.angle + angle
        )


def rotation(angle: float) -> Floats:
    """The matrix (2, 2) that rotates columns (x, y) by an angle, rad."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def wide_gap_half_angle(load: Floats, closing: Floats) -> Floats:
    """The half angle of contact, rad, of Persson's plane contact in the limit of large gaps.

    E* gap / load = 2 / (pi tan^2(half / 2)); for small gaps this angle is too large.
    load: per length, N/m, or on a whole length, N.
    closing: E* times the radial gap, in the unit of the load. E* is 4 R over the tail of pin and
    lug together (ContactProblem): twice the usual contact modulus.
    """
    closed = np.sqrt(np.pi * np.maximum(closing, 0.0))
    return np.asarray(2.0 * np.arctan2(np.sqrt(2.0 * load), closed))

"""Positions and rotations of the bodies of a linkage in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.space.linkage import Vector
from pinbase.arrays import Floats, Ints

BODY_COORDINATES = 7  # position of the centre of mass, then four Euler parameters


@dataclass(frozen=True)
class SpacePose:
    """The position of a linkage of B bodies at T instants; the ground comes after the bodies.

    centre: (T, B + 1, 3) centres of mass, m.
    turn: (T, B + 1, 4) Euler parameters, of any length.
    rotation: (T, B + 1, 3, 3) rotations since the drawing.
    measured: (T, M) change of the measured coordinates since the drawing, rad or m.
    drawn: (B + 1, 3) m, centres of mass as drawn; the ground's is the origin.
    """

    centre: Floats
    turn: Floats
    rotation: Floats
    measured: Floats
    drawn: Floats

    def __getitem__(self, chosen: slice | Ints) -> SpacePose:
        return SpacePose(
            self.centre[chosen],
            self.turn[chosen],
            self.rotation[chosen],
            self.measured[chosen],
            self.drawn,
        )

    def arm(self, body: int, at: Vector) -> Floats:
        """Vector (T, 3) m from the centre of mass of a body to its point. at: as drawn, m."""
        return np.asarray(self.rotation[:, body] @ (np.asarray(at) - self.drawn[body]))


def rotations(p: Floats) -> Floats:
    """Rotation matrices (..., 3, 3) of Euler parameters (..., 4) of any length."""
    w, x, y, z = np.moveaxis(p, -1, 0) / np.sqrt(np.sum(p**2, axis=-1))
    return np.stack(
        [
            np.stack([w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)], -1),
            np.stack([2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)], -1),
            np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z], -1),
        ],
        -2,
    )


def turning(p: Floats) -> Floats:
    """Matrices (..., 3, 4), 2 E / |p|^2, from rates of Euler parameters p to angular velocities."""
    w, x, y, z = np.moveaxis(p, -1, 0)
    E = np.stack(
        [np.stack([-x, w, -z, y], -1), np.stack([-y, z, w, -x], -1), np.stack([-z, -y, x, w], -1)],
        -2,
    )
    return np.asarray(2.0 * E / np.sum(p**2, axis=-1)[..., None, None])

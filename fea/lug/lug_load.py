"""The load of a joint on one of its lugs."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fea.support.contact.bending import SAME_FORCE
from pinbase.arrays import Floats


@dataclass(frozen=True)
class LugLoad:
    """The load of a joint on one lug in one case, at T instants.

    force: (T, 2) N, of the pin on the lug, in the pin's axes.
    pressure: (N + 1, T, R, 2) Pa, harmonics of the pressure on its R rings, in the pin's axes.
    length: (R,) m, of the rings.
    angle: (T,) rad, of the shank from the pin's x axis.
    times: (T,) s; None without a motion.
    """

    force: Floats
    pressure: Floats
    length: Floats
    angle: Floats
    times: Floats | None = None

    @property
    def along_shank(self) -> Floats:
        """The components of the force along and across the shank, (T, 2) N."""
        return _turned(self.force, self.angle)

    @property
    def shares(self) -> Floats:
        """The load per length of each ring, over the mean of all rings, (T, R), in the direction of
        the force.
        """
        mean = np.einsum("trp,r->tp", self.first, self.length / self.length.sum())
        size = np.einsum("tp,tp->t", mean, mean)[:, None]
        along = np.einsum("trp,tp->tr", self.first, mean)
        return np.where(size > 0.0, np.maximum(along, 0.0) / np.where(size > 0.0, size, 1.0), 1.0)

    @property
    def first(self) -> Floats:
        """The first harmonic of pressure on the rings, (T, R, 2) Pa, the only one with a resultant
        force.
        """
        return self.pressure[1] if len(self.pressure) > 1 else np.zeros_like(self.pressure[0])

    def couple(self, radius: float) -> Floats:
        """The couple (T,), N m, that bends the shank.

        It is positive if the force along the shank is larger towards the end of the band.
        radius: m, of the bore.
        """
        along = _turned(self.first, self.angle[:, None])[..., 0]
        return np.asarray(math.pi * radius * (along * self.z) @ self.length)

    @property
    def z(self) -> Floats:
        """The positions (R,), m, of the middles of the rings, from the middle of the lug."""
        ends = np.cumsum(self.length)
        return np.asarray(ends - 0.5 * self.length - 0.5 * ends[-1])

    def without_round_off(self) -> LugLoad:
        """The load, with its force set to zero where that is round-off of the forces of its rings.

        The rings may still make a couple.
        """
        size = np.linalg.norm(self.first, axis=2) @ self.length
        force = np.linalg.norm(np.einsum("trp,r->tp", self.first, self.length), axis=1)
        return replace(self, force=self.force * (force > SAME_FORCE * size)[:, None])

    def at(self, instant: int) -> LugLoad:
        """The load at a single instant."""
        one = slice(instant, instant + 1)
        times = None if self.times is None else self.times[one]
        return LugLoad(self.force[one], self.pressure[:, one], self.length, self.angle[one], times)


def _turned(vectors: Floats, angle: Floats) -> Floats:
    """The components of vectors (.., 2) in axes that are turned by an angle (..), rad."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = np.moveaxis(vectors, -1, 0)
    return np.stack([c * x + s * y, c * y - s * x], axis=-1)

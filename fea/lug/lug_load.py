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

    force: of the pin on the lug, (T, 2) N in the pin's axes.
    pressure: harmonics (N + 1, T, R, 2) Pa of the pressure on its R rings, in the pin's axes.
    length: of the rings, (R,) m.
    angle: of the shank from the pin's x axis, (T,) rad.
    times: (T,) s, None without a motion.
    """

    force: Floats
    pressure: Floats
    length: Floats
    angle: Floats
    times: Floats | None = None

    @property
    def along_shank(self) -> Floats:
        """The force along the shank and across it, (T, 2) N."""
        return _turned(self.force, self.angle)

    @property
    def shares(self) -> Floats:
        """The load per length of each ring over the mean, (T, R), in the direction of the force."""
        mean = np.einsum("trp,r->tp", self.first, self.length / self.length.sum())
        size = np.einsum("tp,tp->t", mean, mean)[:, None]
        along = np.einsum("trp,tp->tr", self.first, mean)
        return np.where(size > 0.0, np.maximum(along, 0.0) / np.where(size > 0.0, size, 1.0), 1.0)

    @property
    def first(self) -> Floats:
        """The first harmonic of pressure on the rings, (T, R, 2) Pa, which alone has a force."""
        return self.pressure[1] if len(self.pressure) > 1 else np.zeros_like(self.pressure[0])

    def couple(self, radius: float) -> Floats:
        """The couple that bends the shank, (T,) N m: positive where a force along the shank is
        larger towards the end of the band. radius: of the bore, m.
        """
        along = _turned(self.first, self.angle[:, None])[..., 0]
        return np.asarray(math.pi * radius * (along * self.z) @ self.length)

    @property
    def z(self) -> Floats:
        """The middles of the rings, (R,) m from the middle of the lug."""
        ends = np.cumsum(self.length)
        return np.asarray(ends - 0.5 * self.length - 0.5 * ends[-1])

    def without_round_off(self) -> LugLoad:
        """The load without a force that is round-off of those of its rings, which make a couple."""
        size = np.linalg.norm(self.first, axis=2) @ self.length
        force = np.linalg.norm(np.einsum("trp,r->tp", self.first, self.length), axis=1)
        return replace(self, force=self.force * (force > SAME_FORCE * size)[:, None])

    def at(self, instant: int) -> LugLoad:
        """The load at one instant."""
        one = slice(instant, instant + 1)
        times = None if self.times is None else self.times[one]
        return LugLoad(self.force[one], self.pressure[:, one], self.length, self.angle[one], times)


def _turned(vectors: Floats, angle: Floats) -> Floats:
    """Vectors (.., 2) in axes that are turned by an angle (..), rad."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = np.moveaxis(vectors, -1, 0)
    return np.stack([c * x + s * y, c * y - s * x], axis=-1)

"""Fields on a body with mirror planes, as sums of fields that are even or odd about each plane.

Under a mirror M, a displacement of parity +1 or -1 is u(M x) = parity M u(x), a stress s(M x) =
parity M s(x) M. So one side of the planes is enough for each such field. On a plane, u has no
component across it if it is even, and none along it if it is odd.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fea.core.voigt import VOIGT_TO_TENSOR
from pinbase.arrays import Floats, Mask

AXIS_NAMES = "xyz"


@dataclass(frozen=True)
class Parities:
    """The symmetry of a body about mirror planes through the origin.

    mirrors: M planes, each named by the axis across it. A point has G = 2^M images, and fields fall
    into C = G parity classes.
    """

    mirrors: tuple[str, ...]

    @cached_property
    def classes(self) -> tuple[tuple[int, ...], ...]:
        """The parity about each mirror, for each class."""
        return tuple(itertools.product((1, -1), repeat=len(self.mirrors)))

    @cached_property
    def images(self) -> Floats:
        """The factors (G, 3) of a point's coordinates at its images; the first image is the point
        itself.
        """
        out = np.ones((len(self.classes), 3))
        for g, crossed in enumerate(self.classes):
            for mirror, sign in zip(self.mirrors, crossed, strict=True):
                out[g, AXIS_NAMES.index(mirror)] = sign
        return out

    @cached_property
    def characters(self) -> Floats:
        """The sign (C, G) of a class's field at an image, besides the mirroring of components."""
        crossed = np.array(self.classes).reshape(len(self.classes), -1) < 0
        odd = crossed  # the mirrors about which a class is odd; the same table
        return np.where((odd.astype(int) @ crossed.T.astype(int)) % 2, -1.0, 1.0)

    @cached_property
    def stress_signs(self) -> Floats:
        """The signs (G, 6) by which the mirrors of an image change the components of a stress."""
        return np.stack([self.images[:, a] * self.images[:, b] for a, b in VOIGT_TO_TENSOR], axis=1)

    def split(self, stress: Floats) -> Floats:
        """The part (C, P, 6, L) of each class in a stress at all images (G, P, 6, L)."""
        back = stress * self.stress_signs[:, None, :, None]
        return np.asarray(np.tensordot(self.characters, back, axes=1) / len(self.images))

    def split_vectors(self, displacement: Floats) -> Floats:
        """The part (C, P, 3, L) of each class in displacements at all images (G, P, 3, L)."""
        back = displacement * self.images[:, None, :, None]
        return np.asarray(np.tensordot(self.characters, back, axes=1) / len(self.images))

    def everywhere(self, displacement: Floats) -> Floats:
        """The displacements (G P, 3, L) at all images from those of each class, (C, P, 3, L)."""
        displaced = np.einsum(
            "cg,ga,cpal->gpal", self.characters, self.images, displacement, optimize=True
        )
        return np.asarray(displaced.reshape(-1, *displaced.shape[2:]))

    def fixed(self, parity: tuple[int, ...]) -> dict[str, tuple[int, ...]]:
        """The components of displacement that vanish on each mirror for a class."""
        out = {}
        for mirror, sign in zip(self.mirrors, parity, strict=True):
            across = AXIS_NAMES.index(mirror)
            along = tuple(a for a in range(3) if a != across)
            out[mirror] = (across,) if sign > 0 else along
        return out

    def rigid(self, parity: tuple[int, ...]) -> Mask:
        """A mask (6,) of the rigid-body motions of a class: translations along the axes and
        rotations about them.
        """
        out = np.ones(6, dtype=bool)
        for mirror, sign in zip(self.mirrors, parity, strict=True):
            across = np.arange(3) == AXIS_NAMES.index(mirror)
            shift = np.where(across, -1, 1)
            out &= np.concatenate([shift, -shift]) == sign
        return out

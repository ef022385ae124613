"""An isotropic linear-elastic material."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fea.core.hardened import Hardened, StrengthPart, strength_parts
from geometry import ArgumentError
from pinbase.arrays import Floats


@dataclass(frozen=True)
class Material:
    """An isotropic linear-elastic material with its strengths.

    youngs_modulus, strengths: Pa; shear_strength and bearing_strength are ultimate strengths.
    density: kg/m^3.
    hardening: pairs of equivalent plastic strain and yield stress, Pa; linear between these points
    from the yield strength on, and constant after the last.
    ultimate_strain: total strain at the ultimate strength.
    hardened: stretches of a pin whose surface is hardened, in order of z. The yield strength is
    then that of the weakest core or of the unhardened rest, for all uses of a single strength.
    unhardened: yield strength of the rest beside such stretches, Pa.
    failure_strain: equivalent plastic strain at which a lug breaks.
    thermal_expansion: mean coefficient, 1/K.
    strength_range: lower and upper end of the yield strength, Pa, where stated.

    Raises: ArgumentError outside -1 < poisson_ratio < 0.5, for a modulus that is not positive and
    finite, and for hardening whose strains do not increase or whose stresses decrease.
    """

    name: str
    youngs_modulus: float
    poisson_ratio: float
    density: float | None = None
    yield_strength: float | None = None
    ultimate_strength: float | None = None
    shear_strength: float | None = None
    bearing_strength: float | None = None
    hardening: tuple[tuple[float, float], ...] = ()
    ultimate_strain: float | None = None
    hardened: tuple[Hardened, ...] = ()
    unhardened: float | None = None
    failure_strain: float | None = None
    thermal_expansion: float | None = None
    strength_range: tuple[float, float] | None = None

    def at_end(self, end: int) -> Material:
        """The material at the lower (0) or upper (1) end of the range of its yield strength; the
        material itself without a range.

        The stresses of its hardening change in the same proportion.
        """
        if self.strength_range is None:
            return self
        strength = self.strength_range[end]
        ratio = strength / (self.yield_strength or strength)
        hardening = tuple((e, max(strength, ratio * s)) for e, s in self.hardening)
        return replace(self, yield_strength=strength, strength_range=None, hardening=hardening)

    @property
    def elastic_part(self) -> Material:
        """The material with only the properties on which linear stress depends, without a name."""
        return Material("", self.youngs_modulus, self.poisson_ratio, self.density)

    def __post_init__(self) -> None:
        if not 0.0 < self.youngs_modulus < np.inf:
            raise ArgumentError(
                f"material {self.name}: Young's modulus must be positive and finite", "not-positive"
            )
        if not -1.0 < self.poisson_ratio < 0.5:
            raise ArgumentError(
                f"material {self.name}: Poisson's ratio must be between -1 and 0.5, not "
                f"{self.poisson_ratio:g}",
                "out-of-range",
            )
        if self.hardening and not self._hardens():
            raise ArgumentError(
                f"material {self.name}: hardening needs a yield strength, plastic strains that "
                "increase from above 0, and stresses that do not decrease from the yield strength",
                "bad-hardening",
            )

    def _hardens(self) -> bool:
        if self.yield_strength is None:
            return False
        points = ((0.0, self.yield_strength), *self.hardening)
        return all(a < b and s <= t < np.inf for (a, s), (b, t) in pairwise(points))

    def strength_parts(self, length: float) -> tuple[StrengthPart, ...]:
        """The parts of a pin of a length (m) with hardened stretches; empty without these."""
        return strength_parts(self.hardened, self.unhardened, length)

    @property
    def lame(self) -> tuple[float, float]:
        """The Lame constants lambda and mu (the shear modulus), Pa."""
        E, nu = self.youngs_modulus, self.poisson_ratio
        return E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))

    @property
    def plane_compliance(self) -> float:
        """The compliance in plane strain, (1 - nu^2) / E, 1/Pa."""
        return (1.0 - self.poisson_ratio**2) / self.youngs_modulus

    def stress(self, strain: Floats) -> Floats:
        """The stress (..., 6), Pa, of strain (..., 6): xx, yy, zz, yz, xz, xy, tensor shears."""
        lam, mu = self.lame
        stress = 2.0 * mu * strain
        stress[..., :3] += lam * strain[..., :3].sum(axis=-1, keepdims=True)
        return stress

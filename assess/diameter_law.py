"""The growth of a pin's safety factor with its diameters, estimated from its section.

Where bending governs, the factor grows with the cube of the diameter; where shear or an axial force
governs, with its square. Beneath a contact surface, where pressure is force over diameter and
length, the factor grows only a little faster than the diameter itself. A pin whose diameter is
large compared with its length is compressed like a disc: its stress is about the mean pressure,
however much it is bent.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from fea.core.places import SectionPlace
from geometry import PinLike
from geometry.shape.features import outer_radius

BENDING_EXPONENT, SHEAR_EXPONENT = 3.0, 2.0
# Larger than the exponent 1 of a mean pressure, since the peaks at the lugs' edges even out as the
# pin becomes stiffer: 1.4 to 1.8 between one and three times the diameters of
# studies/landing_gear.toml
BEARING_EXPONENT = 1.5
# Largest stress of a pin with large diameters, relative to the mean pressure on a band: 0.9 to 1.4
# at three and four times the diameters of studies/landing_gear.toml and clevis.toml (benchmarks
# estimates)
DISC_STRESS = 1.2
SAME_STRESS = 0.01  # relative difference up to which two factors are of the same stress
STEP_DISTANCE = 1e-3  # distance to both sides of a section, relative to the length of the pin


def section_exponent(pin: PinLike, section: SectionPlace | None) -> float:
    """Return the exponent with which a factor grows with the diameters.

    The exponent is interpolated between bending and shear by the share of bending in the square of
    the section's stress. It is that of bending where the section or its stress is unknown.
    """
    profile = pin.profile
    if section is None or profile is None or not section.max_von_mises:
        return BENDING_EXPONENT
    # At a step of the diameter the thinner side counts.
    sides = section.z - STEP_DISTANCE * profile.length, section.z + STEP_DISTANCE * profile.length
    radius = min((r for z in sides if (r := outer_radius(profile, z))), default=0.0)
    if not radius:
        return BENDING_EXPONENT
    # Bending stress of a solid section; with a bore, the true share of bending is larger.
    bending = 4.0 * section.bending_moment / (math.pi * radius**3)
    part = min((bending / section.max_von_mises) ** 2, 1.0)
    return part * BENDING_EXPONENT + (1.0 - part) * SHEAR_EXPONENT


def beneath_exponent(factor: float, beneath: float, exponent: float) -> float:
    """Return the exponent of the factor against the stress beneath contact.

    factor, exponent: of the row. beneath: the factor beneath contact. If both factors agree within
    SAME_STRESS they belong to the same stress, for example in a fillet near a lug, and that stress
    follows the section.
    """
    same = math.isclose(factor, beneath, rel_tol=SAME_STRESS)
    return exponent if same else BEARING_EXPONENT


@dataclass(frozen=True)
class DiameterLaw:
    """The safety factors of a pin as functions of one scale on all its diameters.

    factor: of surface and section; it grows with `exponent`. beneath: of the stress beneath
    contact, inf without contact. disc: of the lugs' pressure on the pin as a disc, inf without
    pressure.
    """

    factor: float
    beneath: float
    exponent: float
    disc: float = math.inf

    @property
    def _laws(self) -> tuple[tuple[float, float], ...]:
        """The pairs of a factor and its exponent."""
        below = beneath_exponent(self.factor, self.beneath, self.exponent)
        return (self.factor, self.exponent), (self.beneath, below), (self.disc, 1.0)

    def factor_at(self, scale: float) -> float:
        """Return the lowest factor at a scale."""
        return min(float(factor * scale**exponent) for factor, exponent in self._laws)

    def scale(self, required: float) -> float:
        """Return the scale at which all factors reach the required one."""
        return max(float((required / factor) ** (1.0 / e)) for factor, e in self._laws)

    def times(self, share: float) -> DiameterLaw:
        """Return the law with all factors multiplied by a share."""
        return replace(
            self, factor=share * self.factor, beneath=share * self.beneath, disc=share * self.disc
        )


def disc_factor(strength: float, pressure: float, factor: float) -> float:
    """Return the safety factor of a pin that is compressed like a disc; inf without pressure.

    strength, pressure: yield strength and mean pressure, in the same unit. factor: the lowest
    factor of the pin's solution, which the result is never below.
    """
    return max(strength / (DISC_STRESS * pressure), factor) if pressure > 0.0 else math.inf

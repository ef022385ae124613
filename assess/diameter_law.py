"""How a pin's factor of safety grows with its diameters, by the law of its section.

A factor grows with the cube of the diameter where bending governs, with its square where shear or
an axial force does; what lies beneath contact, where pressure is force over diameter and length,
with little more than the diameter itself. A pin that is large beside its length is pressed as a
disc, with a stress of about its mean pressure, whatever bends it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from fea.core.places import SectionPlace
from geometry import PinLike
from geometry.shape.features import outer_radius

BENDING_EXPONENT, SHEAR_EXPONENT = 3.0, 2.0
# Larger than that of a mean pressure, 1, since peaks at the lugs' edges even out as the pin becomes
# stiffer: 1.4 to 1.8 between one and three times the diameters of studies/landing_gear.toml
BEARING_EXPONENT = 1.5
# Of the mean pressure on a band: the largest stress of a pin with large diameters; 0.9 to 1.4 at
# three and four times those of studies/landing_gear.toml and clevis.toml (benchmarks estimates)
DISC_STRESS = 1.2
SAME_STRESS = 0.01  # relative
STEP_DISTANCE = 1e-3  # of the length, from a section to both sides


def section_exponent(pin: PinLike, section: SectionPlace | None) -> float:
    """Return the exponent with which a factor grows with the diameters, by the part of bending in
    the square of the stress of a section; that of bending where there is no section.
    """
    profile = pin.profile
    if section is None or profile is None or not section.max_von_mises:
        return BENDING_EXPONENT
    # at a step, of the thinner side
    sides = section.z - STEP_DISTANCE * profile.length, section.z + STEP_DISTANCE * profile.length
    radius = min((r for z in sides if (r := outer_radius(profile, z))), default=0.0)
    if not radius:
        return BENDING_EXPONENT
    # of a solid section: a bore makes bending a larger part
    bending = 4.0 * section.bending_moment / (math.pi * radius**3)
    part = min((bending / section.max_von_mises) ** 2, 1.0)
    return part * BENDING_EXPONENT + (1.0 - part) * SHEAR_EXPONENT


def beneath_exponent(factor: float, beneath: float, exponent: float) -> float:
    """Return the exponent of a factor by the stress beneath contact.

    factor, exponent: of the row. Where both factors agree to SAME_STRESS they are of one stress,
    such as in a fillet near a lug, which follows the section.
    """
    same = math.isclose(factor, beneath, rel_tol=SAME_STRESS)
    return exponent if same else BEARING_EXPONENT


@dataclass(frozen=True)
class DiameterLaw:
    """The factors of a pin, which grow with the scale of all its diameters.

    factor: by surface and section, which grows with `exponent`. beneath: by the stress beneath
    contact, inf without any. disc: by the pressure of lugs, as on a disc, inf without any.
    """

    factor: float
    beneath: float
    exponent: float
    disc: float = math.inf

    @property
    def _laws(self) -> tuple[tuple[float, float], ...]:
        """Each factor with its exponent."""
        below = beneath_exponent(self.factor, self.beneath, self.exponent)
        return (self.factor, self.exponent), (self.beneath, below), (self.disc, 1.0)

    def factor_at(self, scale: float) -> float:
        """Return the lowest factor at a scale."""
        return min(float(factor * scale**exponent) for factor, exponent in self._laws)

    def scale(self, required: float) -> float:
        """Return the scale at which all factors reach the required one."""
        return max(float((required / factor) ** (1.0 / e)) for factor, e in self._laws)

    def times(self, share: float) -> DiameterLaw:
        """Return the law with all factors times a share."""
        return replace(
            self, factor=share * self.factor, beneath=share * self.beneath, disc=share * self.disc
        )


def disc_factor(strength: float, pressure: float, factor: float) -> float:
    """Return the factor of a pin as a disc under a mean pressure, in the unit of the strength.

    factor: the lowest by its solution, which is no larger than the disc's.
    """
    return max(strength / (DISC_STRESS * pressure), factor) if pressure > 0.0 else math.inf

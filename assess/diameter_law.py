"""How a pin's factor of safety grows with its diameters, by the law of its section.

A factor grows with the cube of the diameter where bending governs, with its square where shear or
an axial force does; what lies beneath contact, where pressure is force over diameter and length,
with little more than the diameter itself.
"""

from __future__ import annotations

import math

from fea.core.places import SectionPlace
from geometry import PinLike
from geometry.shape.features import outer_radius

BENDING_EXPONENT, SHEAR_EXPONENT = 3.0, 2.0
# Larger than that of a mean pressure, 1, since peaks at the lugs' edges even out as the pin becomes
# stiffer: 1.4 to 1.8 between one and three times the diameters of studies/landing_gear.toml
BEARING_EXPONENT = 1.5
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


def estimated_scale(factor: float, beneath: float, exponent: float, required: float) -> float:
    """Return the scale of all diameters at which a pin reaches a factor of safety, by these laws.

    factor: by surface and section, which grows with `exponent`. beneath: by the stress beneath
    contact, inf without any.
    """
    of_row: float = (required / factor) ** (1.0 / exponent)
    below = beneath_exponent(factor, beneath, exponent)
    of_contact: float = (required / beneath) ** (1.0 / below)
    return max(of_row, of_contact)

"""The bending strength of a pin beyond yield, by Cozzone or by a factor that the study states.

    F_b = k_b F_tu, or F_tu + f_0 (k - 1)

k is the ratio of the plastic to the elastic section modulus, 1.698 for a solid round pin. f_0 is
the stress at the neutral axis of a trapezoidal stress distribution that carries the same moment as
the Ramberg-Osgood curve up to the strain at the ultimate strength. k_b is read off a figure; a
study that states it (`bending_factor` of the pin) need not state the strain. For solid round pins
1.44, 1.50 and 1.56 are in use.

Source: a worked example by J. C. Banks (docs/evidence.md) after E. F. Bruhn, Analysis and Design of
Flight Vehicle Structures, C3.3, and F. P. Cozzone, J. Aero. Sci. (1943), which were not read.
"""

from __future__ import annotations

import math

from assess.margin import material_key, strength_key
from assess.situation import Situation
from assess.work import Work, work
from fea.beam.round_section import Circle
from fea.core.material import Material
from geometry import ArgumentError
from pinbase.keys import key_part

PIN_OMITS = "Not covered: shear together with bending, axial force, a bore that is crushed."
YIELD_OFFSET = 0.002  # plastic strain at the yield strength


def hardening_exponent(material: Material, ultimate_strain: float) -> float:
    """Return the Ramberg-Osgood exponent n of the curve through yield and ultimate strength.

    ultimate_strain: total strain at the ultimate strength.

    Raises: ArgumentError where the strengths or the strain do not give a curve.
    """
    fy, fu = material.yield_strength or 0.0, material.ultimate_strength or 0.0
    plastic = ultimate_strain - fu / material.youngs_modulus
    if not (0.0 < fy < fu and plastic > YIELD_OFFSET):
        raise ArgumentError(
            f"material {material.name}: Cozzone's bending strength needs an ultimate strength "
            f"above the yield strength, and a strain there of over {YIELD_OFFSET:g} beyond elastic",
            "out-of-range",
        )
    return math.log(plastic / YIELD_OFFSET) / math.log(fu / fy)


def trapezoid_stress(material: Material, ultimate_strain: float) -> float:
    """Return Cozzone's f_0 at the ultimate strength, Pa; arguments and errors as
    `hardening_exponent`.

    For a rectangular section of depth h, (6 / h^2) times the integral of stress times distance is
    F_tu + f_0 / 2 for the trapezoid. The integral over the curve is exact.
    """
    n, fu = hardening_exponent(material, ultimate_strain), material.ultimate_strength or 0.0
    x, total = fu / material.youngs_modulus, ultimate_strain
    p = total - x
    moment = x**2 / 3.0 + x * p * (n + 1.0) / (n + 2.0) + n * p**2 / (2.0 * n + 1.0)
    return 6.0 * fu * (moment - total**2 / 3.0) / total**2


def cozzone_strength(material: Material, section: Circle, ultimate_strain: float) -> Work:
    """Return Cozzone's bending strength F_b of a section, Pa; errors as `hardening_exponent`."""
    fu, f_0 = material.ultimate_strength or 0.0, trapezoid_stress(material, ultimate_strain)
    k = section.plastic_modulus / section.modulus
    return work(
        "F_b", fu + f_0 * (k - 1.0), "stress", "{F_tu} + {f_0} × ({k} − 1)",
        F_tu=(fu, "stress"), f_0=(f_0, "stress"), k=(k, "1"),
    )  # fmt: skip


def bending_strength(s: Situation, section: Circle) -> Work | list[str]:
    """Return the bending strength F_b of a section of the pin, Pa, or the missing keys.

    Raises: ArgumentError as `hardening_exponent`.
    """
    m = s.material
    if m.ultimate_strength is None:
        return [strength_key(m.name, "ultimate")]
    if s.bending_factor is not None:
        return work(
            "F_b", s.bending_factor * m.ultimate_strength, "stress", "{k_b} × {F_tu}",
            k_b=(s.bending_factor, "1"), F_tu=(m.ultimate_strength, "stress"),
        )  # fmt: skip
    if m.ultimate_strain is None:
        instead = material_key(m.name, "ultimate_strain")
        return [f"pin.{key_part(s.pin.name)}.bending_factor or {instead}"]
    if m.yield_strength is None:
        return [strength_key(m.name, "yield")]
    return cozzone_strength(m, section, m.ultimate_strain)

"""Rupture of a pin in shear and in bending: AFFDL-TR-69-42, and Cozzone's plastic bending.

    shear                P_us = A F_su in each plane
    bending              M_u = F_b W        F_b = k_b F_tu, or by Cozzone F_tu + f_0 (k - 1)

k is the plastic section modulus over the elastic one, 1.698 for a solid round pin. f_0 is the
stress at the neutral axis of the trapezoid that carries the same moment as the stress-strain curve
of Ramberg and Osgood up to the strain at the ultimate strength. k_b is read off a figure, and a
study that states it (`bending_factor` of the pin) does without the strain.

With even loads on the bands, M is that of equation 9-15: P/2 (t1/2 + t2/4 + g) in double shear.

Source: AFFDL-TR-69-42, 9.4, equations 9-12 to 9-15; F. P. Cozzone, Bending Strength in the Plastic
Range, J. Aero. Sci. 10 (1943); E. F. Bruhn, Analysis and Design of Flight Vehicle Structures, C3;
W. Ramberg & W. R. Osgood, NACA TN 902 (1943).
"""

from __future__ import annotations

import math

import numpy as np

from assess.check import CheckText, check
from assess.margin import Margin, material_key, strength_key
from assess.situation import Situation
from assess.work import Quantity, Work, work
from fea.beam.round_section import Circle
from fea.core.material import Material
from geometry import ArgumentError

YIELD_OFFSET = 0.002  # plastic strain at the yield strength
OMITS = "Not covered: shear together with bending, axial force, a bore that is crushed."


def hardening_exponent(material: Material, ultimate_strain: float) -> float:
    """Ramberg and Osgood's exponent n through the yield and the ultimate strength.

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
    """Cozzone's f_0 at the ultimate strength, Pa; arguments and errors as `hardening_exponent`.

    A rectangle of depth h carries (6 / h^2) integral of stress times distance, which the trapezoid
    gives as F_tu + f_0 / 2; the integral over the curve is exact.
    """
    n, fu = hardening_exponent(material, ultimate_strain), material.ultimate_strength or 0.0
    x, total = fu / material.youngs_modulus, ultimate_strain
    p = total - x
    moment = x**2 / 3.0 + x * p * (n + 1.0) / (n + 2.0) + n * p**2 / (2.0 * n + 1.0)
    return 6.0 * fu * (moment - total**2 / 3.0) / total**2


def cozzone_strength(material: Material, section: Circle, ultimate_strain: float) -> Work:
    """Cozzone's bending strength F_b of a section, Pa; errors as `hardening_exponent`."""
    fu, f_0 = material.ultimate_strength or 0.0, trapezoid_stress(material, ultimate_strain)
    k = section.plastic_modulus / section.modulus
    return work(
        "F_b", fu + f_0 * (k - 1.0), "stress", "{F_tu} + {f_0} × ({k} − 1)",
        F_tu=(fu, "stress"), f_0=(f_0, "stress"), k=(k, "1"),
    )  # fmt: skip


def bending_strength(s: Situation, section: Circle) -> Work | list[str]:
    """The bending strength F_b of a section of the pin, Pa, or the keys that the study lacks.

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
        return [f"pin.{s.pin.name}.bending_factor (or {instead}, for Cozzone's)"]
    if m.yield_strength is None:
        return [strength_key(m.name, "yield")]
    return cozzone_strength(m, section, m.ultimate_strain)


@check("pin shear, rupture", "AFFDL-TR-69-42, 9.4, eq. 9-12", kind="clause",
       takes="section forces", level="ultimate", dimension="force", omits=OMITS)  # fmt: skip
def pin_shear(text: CheckText, s: Situation) -> list[Margin]:
    """The shear force in every section against A F_su."""
    fsu = s.material.shear_strength
    if s.forces.kind == "concentrated":
        return []
    if fsu is None:
        return [text.lacks(s, strength_key(s.material.name, "shear"))]
    place, section = worst_section(s, "shear")
    allowed = work(
        "P_us", fsu * section.area, "force", "{A} × {F_su}",
        A=(section.area, "length^2"), F_su=(fsu, "stress"),
    )  # fmt: skip
    return [_of_section(text, s, "shear", place, (allowed,))]


@check("pin bending, rupture", "AFFDL-TR-69-42, 9.4, eq. 9-15; Cozzone", kind="clause",
       takes="section forces", level="ultimate", dimension="moment", omits=OMITS)  # fmt: skip
def pin_bending(text: CheckText, s: Situation) -> list[Margin]:
    """The bending moment in the worst section against F_b W."""
    if s.forces.kind == "concentrated":
        return []
    place, section = worst_section(s, "moment")
    try:
        strength = bending_strength(s, section)
    except ArgumentError as error:
        return [text.lacks(s, str(error))]
    if isinstance(strength, list):
        return [text.lacks(s, *strength)]
    F_b = strength.result.value
    moment = work(
        "M_u", F_b * section.modulus, "moment", "{F_b} × {W}",
        F_b=(F_b, "stress"), W=(section.modulus, "length^3"),
    )  # fmt: skip
    return [_of_section(text, s, "moment", place, (strength, moment))]


def worst_section(s: Situation, quantity: str) -> tuple[tuple[int, int], Circle]:
    """The instant and the station of the largest mean shear or elastic bending stress, and the
    section there.
    """
    forces, per = s.forces, "area" if quantity == "shear" else "modulus"
    stress = getattr(forces, quantity) / forces.of_sections(per)
    t, k = np.unravel_index(int(stress.argmax()), stress.shape)
    return (int(t), int(k)), forces.sections[int(k)]


def _of_section(
    text: CheckText, s: Situation, quantity: str, place: tuple[int, int], allowed: tuple[Work, ...]
) -> Margin:
    forces, (t, k) = s.forces, place
    return Margin(
        text.method, text.clause, text.kind, text.level, s.factors.at(text.level),
        float(getattr(forces, quantity)[t, k]), allowed[-1].result.value, text.dimension,
        forces.labels[k], float(forces.z[k]),
        None if forces.times is None else float(forces.times[t]), s.material.name, forces.basis,
        work=allowed, omits=text.omits, passing=_passing(text, s, quantity, place, allowed[-1]),
    )  # fmt: skip


def _passing(
    text: CheckText, s: Situation, quantity: str, place: tuple[int, int], allowed: Work
) -> Quantity | None:
    """The outer diameter that would just pass, with a bore in proportion: the resistance grows
    with its square in shear, with its cube in bending.
    """
    demand = s.factors.at(text.level) * float(getattr(s.forces, quantity)[place])
    if demand <= 0.0 or allowed.result.value <= 0.0:
        return None
    power = 2.0 if quantity == "shear" else 3.0
    d = 2.0 * s.forces.sections[place[1]].outer
    return Quantity("diameter", d * (demand / allowed.result.value) ** (1.0 / power), "length")

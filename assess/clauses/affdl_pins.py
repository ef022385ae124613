"""Rupture of a pin in shear and in bending by AFFDL-TR-69-42.

    shear                P_us = A F_su in each plane
    bending              M_u = F_b W

F_b is that of assess.clauses.cozzone. With even loads on the bands, M is that of equation 9-15:
P/2 (t1/2 + t2/4 + g) in double shear; assess.clauses.affdl_joint shifts the load to the faces.

Source: AFFDL-TR-69-42, Stress Analysis Manual, 9.4, equations 9-12 to 9-15.
"""

from __future__ import annotations

from dataclasses import replace
from operator import attrgetter

import numpy as np

from assess.check import CheckText, WorstPlace, check
from assess.clauses.affdl_joint import DoubleShear, joint_of
from assess.clauses.cozzone import bending_strength
from assess.margin import Margin, for_comparison, strength_key
from assess.situation import Situation
from assess.work import Work, wider, work
from fea.beam.round_section import Circle
from geometry import ArgumentError

PIN_OMITS = "Not covered: shear together with bending, axial force, a bore that is crushed."


@check("pin shear, rupture", "AFFDL-TR-69-42, 9.4, eq. 9-12", kind="clause",
       takes="section forces", level="ultimate", dimension="force", omits=PIN_OMITS)  # fmt: skip
def pin_shear(text: CheckText, s: Situation) -> list[Margin]:
    """The shear force in every section against A F_su."""
    fsu = s.material.shear_strength
    if s.forces.kind == "concentrated":
        return []
    if fsu is None:
        return [text.lacks(s, strength_key(s.material.name, "shear"))]
    place, section = _worst_section(s, "shear")
    allowed = work(
        "P_us", fsu * section.area, "force", "{A} × {F_su}",
        A=(section.area, "length^2"), F_su=(fsu, "stress"),
    )  # fmt: skip
    return [_of_section(text, s, "shear", place, (allowed,))]


@check("pin bending, rupture", "AFFDL-TR-69-42, 9.4, eq. 9-15; Cozzone", kind="clause",
       takes="section forces", level="ultimate", dimension="moment", omits=PIN_OMITS)  # fmt: skip
def pin_bending(text: CheckText, s: Situation) -> list[Margin]:
    """The bending moment in the worst section against F_b W.

    Even bearing is there for comparison where the joint is checked with the load at the faces.
    """
    if s.forces.kind == "concentrated":
        return []
    place, section = _worst_section(s, "moment")
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
    margin = _of_section(text, s, "moment", place, (strength, moment))
    shifts = s.forces.kind == "even" and s.governs and isinstance(joint_of(s), DoubleShear)
    return [for_comparison(margin) if shifts else margin]


def _worst_section(s: Situation, quantity: str) -> tuple[tuple[int, int], Circle]:
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
    time = None if forces.times is None else float(forces.times[t])
    margin = text.margin(
        s, float(getattr(forces, quantity)[t, k]), allowed[-1].result.value,
        WorstPlace(forces.labels[k], float(forces.z[k]), time), s.material.name, forces.basis,
        allowed,
    )  # fmt: skip
    power, per = (2.0, "area") if quantity == "shear" else (3.0, "modulus")
    passing = wider(forces.sections[k], margin.used, power, attrgetter(per))
    return replace(margin, passing=passing)

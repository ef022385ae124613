"""Rupture of a pin in shear and in bending by AFFDL-TR-69-42.

    shear                P_us = A F_su in each plane
    bending              M_u = F_b W

F_b is that of assess.clauses.cozzone. With even loads on the bands, M is that of equation 9-15:
P/2 (t1/2 + t2/4 + g) in double shear; assess.clauses.affdl_joint shifts the load to the faces.

Source: AFFDL-TR-69-42, Stress Analysis Manual, 9.4, equations 9-12 to 9-15.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from operator import attrgetter

import numpy as np

from assess.check import CheckText, WorstPlace, check
from assess.clauses.affdl_joint import DoubleShear, joint_of
from assess.clauses.cozzone import PIN_OMITS, bending_strength
from assess.clauses.melcon_hoblit_pin import peaking_bands
from assess.margin import Margin, for_comparison, strength_key
from assess.situation import Situation
from assess.work import Work, wider, work
from fea.beam.round_section import Circle
from geometry import ArgumentError
from pinbase.arrays import Floats


@check("pin shear, rupture", "AFFDL-TR-69-42, 9.4, eq. 9-12", kind="clause",
       takes="section forces", level="ultimate", dimension="force", omits=PIN_OMITS)  # fmt: skip
def pin_shear(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin of the shear force in the worst section against A F_su."""
    fsu = s.material.shear_strength
    if s.forces.kind == "concentrated":
        return []
    if fsu is None:
        return [text.lacks(s, strength_key(s.material.name, "shear"))]

    def resisted(section: Circle) -> tuple[Work, ...]:
        return (
            work(
                "P_us", fsu * section.area, "force", "{A} × {F_su}",
                A=(section.area, "length^2"), F_su=(fsu, "stress"),
            ),
        )  # fmt: skip

    return [_worst(text, s, s.forces.shear, resisted, ("area", 2.0))]


@check("pin bending, rupture", "AFFDL-TR-69-42, 9.4, eq. 9-15; Cozzone", kind="clause",
       takes="section forces", level="ultimate", dimension="moment", omits=PIN_OMITS)  # fmt: skip
def pin_bending(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin of the bending moment in the worst section against F_b W.

    With even bearing the margin is for comparison only if the joint is also checked with the load
    shifted to the faces, or with pressure peaks there (assess.clauses.melcon_hoblit_pin).
    """
    if s.forces.kind == "concentrated":
        return []
    strengths = dict[Circle, Work]()
    try:
        for section in set(s.forces.sections):
            strength = bending_strength(s, section)
            if isinstance(strength, list):
                return [text.lacks(s, *strength)]
            strengths[section] = strength
    except ArgumentError as error:
        return [text.lacks(s, str(error))]

    def resisted(section: Circle) -> tuple[Work, ...]:
        F_b = strengths[section].result.value
        moment = work(
            "M_u", F_b * section.modulus, "moment", "{F_b} × {W}",
            F_b=(F_b, "stress"), W=(section.modulus, "length^3"),
        )  # fmt: skip
        return strengths[section], moment

    margin = _worst(text, s, s.forces.moment, resisted, ("modulus", 3.0))
    even = s.forces.kind == "even" and s.governs
    shifts = even and (peaking_bands(s) is not None or isinstance(joint_of(s), DoubleShear))
    return [for_comparison(margin) if shifts else margin]


def _worst(
    text: CheckText,
    s: Situation,
    demand: Floats,
    resisted: Callable[[Circle], tuple[Work, ...]],
    grows: tuple[str, float],
) -> Margin:
    """Return the margin of the section with the highest utilisation.

    demand: (T, S). resisted: the works of a section's resistance; the last has the result. grows:
    the name of the section property to which the resistance is proportional, and the power of the
    diameter to which this property is proportional.
    """
    forces, (per, power) = s.forces, grows
    works = {section: resisted(section) for section in set(forces.sections)}
    allowable = np.array([works[section][-1].result.value for section in forces.sections])
    used = demand / allowable
    t, k = s.most_used(used)
    time, section = None if forces.times is None else float(forces.times[t]), forces.sections[k]
    margin = text.margin(
        s, float(demand[t, k]), float(allowable[k]),
        WorstPlace(forces.labels[k], float(forces.z[k]), time), s.material.name, forces.basis,
        works[section],
    )  # fmt: skip
    return replace(margin, passing=wider(section, margin.used, power, attrgetter(per)))

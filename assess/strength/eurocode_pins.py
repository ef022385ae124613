"""Pins by EN 1993-1-8:2005, 3.13: table 3.10 and figure 3.11.

    shear                 F_v,Rd = 0.6 A f_up / gamma_M2
    bearing               F_b,Rd = 1.5 t d f_y / gamma_M0
    bending               M_Rd = 1.5 W_el f_yp / gamma_M0
    shear and bending     (M_Ed / M_Rd)^2 + (F_v,Ed / F_v,Rd)^2 <= 1

and where a pin is meant to be replaced, at the loads of service,

    bearing               F_b,Rd,ser = 0.6 t d f_y / gamma_M6,ser
    bending               M_Rd,ser = 0.8 W_el f_yp / gamma_M6,ser
    contact               sigma_h,Ed = 0.591 sqrt(E F (d0 - d) / (d^2 t)) <= 2.5 f_y / gamma_M6,ser

The first group is checked at ultimate, the second at limit load. f_y is the lower of the pin's and
the lug's. For the interaction the largest moment and the largest shear of an instant are taken
together, wherever they are; its utilisation is the root of the sum, which rises as the loads do.
Contact stress rises as the root of the force, and so does the factor on it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from assess.strength.margin import RATIO_DIMENSION, Margin
from assess.strength.section_forces import SectionForces
from assess.strength.situation import Situation
from assess.strength.worst import Check, strength_key
from pinbase.arrays import Floats

GAMMA_M0, GAMMA_M2, GAMMA_M6_SER = 1.0, 1.25, 1.0  # recommended partial factors; 2.2 of the same

_CLAUSE = "EN 1993-1-8, 3.13"
_TABLE = f"{_CLAUSE}.2, table 3.10"
SHEAR_CHECK = Check("EN 1993 shear", _TABLE, "ultimate", "force")
BEARING_CHECK = Check("EN 1993 bearing", _TABLE, "ultimate", "force")
BENDING_CHECK = Check("EN 1993 bending", _TABLE, "ultimate", "moment")
INTERACTION_CHECK = Check("EN 1993 shear and bending", _TABLE, "ultimate", RATIO_DIMENSION)
BEARING_SER_CHECK = Check("EN 1993 bearing, replaceable", _TABLE, "limit", "force")
BENDING_SER_CHECK = Check("EN 1993 bending, replaceable", _TABLE, "limit", "moment")
CONTACT_SER_CHECK = Check("EN 1993 contact, replaceable", f"{_CLAUSE}.2(3)", "limit", "stress")


def shear_resistance(area: Floats | float, ultimate: float) -> Floats | float:
    """F_v,Rd in N of a shear plane of `area`, m^2, and ultimate strength, Pa."""
    return 0.6 * area * ultimate / GAMMA_M2


def bearing_resistance(
    thickness: Floats, diameter: Floats, strength: Floats, *, replaceable: bool = False
) -> Floats:
    """F_b,Rd in N, or F_b,Rd,ser of a replaceable pin; m, and the lower yield strength in Pa."""
    part = 0.6 / GAMMA_M6_SER if replaceable else 1.5 / GAMMA_M0
    return part * thickness * diameter * strength


def bending_resistance(
    modulus: Floats | float, strength: float, *, replaceable: bool = False
) -> Floats | float:
    """M_Rd in N m, or M_Rd,ser of a replaceable pin; section modulus in m^3, yield in Pa."""
    return (0.8 / GAMMA_M6_SER if replaceable else 1.5 / GAMMA_M0) * modulus * strength


def double_shear_moment(force: float, outer: float, middle: float, gap: float) -> float:
    """M_Ed of figure 3.11, N m: F (b + 4 c + 2 a) / 8; a: outer, b: middle, c: gap, m."""
    return force * (middle + 4.0 * gap + 2.0 * outer) / 8.0


@dataclass(frozen=True)
class PinInHole:
    """A pin of `diameter` in a hole of a plate of `thickness`, m; modulus: E, Pa."""

    diameter: Floats | float
    hole: Floats | float
    thickness: Floats | float
    modulus: Floats | float


def contact_stress(force: Floats | float, at: PinInHole) -> Floats:
    """sigma_h,Ed in Pa of a force in N."""
    play = np.asarray(at.hole) - at.diameter
    area = np.asarray(at.diameter) ** 2 * at.thickness
    return np.asarray(0.591 * np.sqrt(at.modulus * force * play / area))


def eurocode_bending(s: Situation, forces: SectionForces) -> list[Margin]:
    """Shear and bending of table 3.10."""
    bending = [_bending(s, forces, BENDING_SER_CHECK)] if s.replaceable else []
    return [*_resistances(s, forces), *bending]


def eurocode_bearing(s: Situation) -> list[Margin]:
    """Bearing and contact of table 3.10."""
    if not s.replaceable:
        return [_bearing(s, BEARING_CHECK)]
    return [_bearing(s, BEARING_CHECK), _bearing(s, BEARING_SER_CHECK), _contact(s)]


def _resistances(s: Situation, forces: SectionForces) -> list[Margin]:
    """Of the pin in shear, in bending and in both."""
    fu, fy = s.material.ultimate_strength, s.material.yield_strength
    bending = _bending(s, forces, BENDING_CHECK)
    needs = [
        strength_key(s.material.name, which)
        for which, value in (("ultimate", fu), ("yield", fy))
        if value is None
    ]
    if fu is None:
        return [SHEAR_CHECK.lacks(s, needs[0]), bending, INTERACTION_CHECK.lacks(s, *needs)]
    sheared = np.asarray(shear_resistance(forces.of_sections("area"), fu))
    shear = SHEAR_CHECK.along(s, forces, forces.shear, sheared)
    if fy is None:
        return [shear, bending, INTERACTION_CHECK.lacks(s, *needs)]
    bent = np.asarray(bending_resistance(forces.of_sections("modulus"), fy))
    used = np.hypot((forces.moment / bent).max(axis=1), (forces.shear / sheared).max(axis=1))
    note = "root of the sum of squares; the clause's sum is its square"
    return [shear, bending, INTERACTION_CHECK.along(s, forces, used[:, None], np.ones(1), note)]


def _bending(s: Situation, forces: SectionForces, check: Check) -> Margin:
    fy = s.material.yield_strength
    if fy is None:
        return check.lacks(s, strength_key(s.material.name, "yield"))
    modulus, ser = forces.of_sections("modulus"), check is BENDING_SER_CHECK
    resisted = np.asarray(bending_resistance(modulus, fy, replaceable=ser))
    return check.along(s, forces, forces.moment, resisted)


def _lower_strengths(s: Situation) -> tuple[list[float], list[str]]:
    """The lower yield strength of pin and lug at each band, and the keys that are missing."""
    found, lacking = [], []
    for name in s.loads.surfaces:
        lug = s.lug(name)
        both = [s.material] if lug is None else [s.material, lug.bearing]
        lacking += [strength_key(m.name, "yield") for m in both if m.yield_strength is None]
        found.append(min((m.yield_strength for m in both if m.yield_strength), default=0.0))
    return found, list(dict.fromkeys(lacking))


def _bearing(s: Situation, check: Check) -> Margin:
    strengths, lacking = _lower_strengths(s)
    if lacking:
        return check.lacks(s, *lacking)
    bands = [s.pin.band(name) for name in s.loads.surfaces]
    resisted = bearing_resistance(
        np.array([b.length for b in bands]),
        np.array([2.0 * b.radius for b in bands]),
        np.array(strengths),
        replaceable=check is BEARING_SER_CHECK,
    )
    bare = [name for name in s.loads.surfaces if s.lug(name) is None]
    basis = f"strength of the pin alone at {', '.join(bare)}: no lug given" if bare else ""
    return check.worst(s, s.across, resisted, s.loads.surfaces, basis)


def _contact(s: Situation) -> Margin:
    """Of bands in lugs with a clearance."""
    strengths, lacking = _lower_strengths(s)
    if lacking:
        return CONTACT_SER_CHECK.lacks(s, *lacking)
    lugs = [s.lug(name) for name in s.loads.surfaces]
    loose = [k for k, lug in enumerate(lugs) if lug is not None and lug.clearance > 0.0]
    if not loose:
        return CONTACT_SER_CHECK.lacks(s, f"a clearance in pin.{s.pin.name}.lug")
    holes = [_hole(s, s.loads.surfaces[k]) for k in loose]
    at = PinInHole(*(np.array(sizes) for sizes in zip(*holes, strict=True)))
    stress = contact_stress(s.across[:, loose], at)
    allowed = 2.5 / GAMMA_M6_SER * np.array(strengths)[loose]
    names = tuple(s.loads.surfaces[k] for k in loose)
    found = CONTACT_SER_CHECK.worst(
        s, stress, allowed, names, "the factor is the root of that on loads"
    )
    return replace(found, factor=math.sqrt(found.factor))


def _hole(s: Situation, name: str) -> tuple[float, float, float, float]:
    """Diameters, thickness and E of the softer-side mean of pin and lug, as they are in series."""
    lug, band = s.lug(name), s.pin.band(name)
    assert lug is not None
    E = 2.0 / (1.0 / s.material.youngs_modulus + 1.0 / lug.bearing.youngs_modulus)
    d = 2.0 * band.radius
    return d, d + lug.clearance, band.length, E

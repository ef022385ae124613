"""Pins by EN 1993-1-8:2005, 3.13: table 3.10 and figure 3.11.

    shear                 F_v,Rd = 0.6 A f_up / gamma_M2
    bearing               F_b,Rd = 1.5 t d f_y / gamma_M0
    bending               M_Rd = 1.5 W_el f_yp / gamma_M0, at most W_pl f_yp / gamma_M0
    shear and bending     (M_Ed / M_Rd)^2 + (F_v,Ed / F_v,Rd)^2 <= 1

and, for a pin that is meant to be replaced, at service loads,

    bearing               F_b,Rd,ser = 0.6 t d f_y / gamma_M6,ser
    bending               M_Rd,ser = 0.8 W_el f_yp / gamma_M6,ser
    contact               sigma_h,Ed = 0.591 sqrt(E F (d0 - d) / (d^2 t)) <= 2.5 f_y / gamma_M6,ser

1.5 W_el exceeds the fully plastic W_pl of a hollow pin whose bore is above 0.63 of its diameter, by
4.5 % at 0.75; no section resists more than W_pl (EN 1993-1-1, 6.2.5).

The first group is checked at ultimate load, the second at limit load. f_y is the lower yield
strength of pin and lug. The interaction combines the largest moment and the largest shear of an
instant, even if they act in different sections. Its utilisation is the root of the sum, which is
proportional to the loads. The contact stress is proportional to the root of the force, so the root
of the load factor multiplies it. The partial factors are the recommended ones, or those of a
national annex that the study states.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from assess.check import CheckText, Passing, check
from assess.codes import RECOMMENDED, PartialFactors
from assess.margin import RATIO_DIMENSION, Margin, strength_key
from assess.situation import Situation
from assess.work import Work, diameter_of_wall, scaled, wider, work
from fea.beam.round_section import Circle
from pinbase.arrays import Floats
from pinbase.keys import key_part

_CLAUSE = "EN 1993-1-8, 3.13"
_TABLE = f"{_CLAUSE}.2, table 3.10"
_OMITS = 'Not covered: axial force and torque (EN 1993-1-1, 6.2.8 to 6.2.10: code "civil").'
_BAND_OMITS = "Not covered: the plate about the hole (table 3.9), the pressure at edges."
_by_forces = partial(check, clause=_TABLE, kind="clause", takes="section forces", omits=_OMITS)
_by_bands = partial(check, clause=_TABLE, kind="clause", takes="statics", omits=_BAND_OMITS)


def shear_resistance(
    area: Floats | float, ultimate: float, partial: PartialFactors = RECOMMENDED
) -> Floats | float:
    """Return the shear resistance F_v,Rd, N, of one shear plane.

    area: m^2.
    ultimate: ultimate strength, Pa.
    """
    return 0.6 * area * ultimate / partial.M2


def bearing_resistance(
    thickness: Floats,
    diameter: Floats,
    strength: Floats,
    partial: PartialFactors = RECOMMENDED,
    *,
    replaceable: bool = False,
) -> Floats:
    """Return the bearing resistance F_b,Rd, N, or F_b,Rd,ser of a replaceable pin.

    thickness, diameter: m.
    strength: the lower yield strength of pin and lug, Pa.
    """
    part = 0.6 / partial.M6_ser if replaceable else 1.5 / partial.M0
    return part * thickness * diameter * strength


def bending_resistance(
    modulus: Floats | float,
    strength: float,
    partial: PartialFactors = RECOMMENDED,
    *,
    plastic: Floats | float = math.inf,
    replaceable: bool = False,
) -> Floats | float:
    """Return the bending resistance M_Rd, N m, or M_Rd,ser of a replaceable pin.

    modulus, plastic: elastic and plastic section modulus, m^3.
    strength: yield strength, Pa.
    """
    if replaceable:
        return 0.8 * modulus * strength / partial.M6_ser
    return np.minimum(1.5 * modulus, plastic) * strength / partial.M0


@dataclass(frozen=True)
class PinInHole:
    """A pin in the hole of a plate; diameters and thickness in m; modulus: E, Pa."""

    diameter: Floats | float
    hole: Floats | float
    thickness: Floats | float
    modulus: Floats | float


def contact_stress(force: Floats | float, at: PinInHole) -> Floats:
    """Return the contact stress sigma_h,Ed, Pa, of a force, N."""
    play = np.asarray(at.hole) - at.diameter
    area = np.asarray(at.diameter) ** 2 * at.thickness
    return np.asarray(0.591 * np.sqrt(at.modulus * force * play / area))


@_by_forces("EN 1993 shear", level="ultimate", dimension="force")
def eurocode_shear(text: CheckText, s: Situation) -> list[Margin]:
    """The shear force against F_v,Rd."""
    fu = s.material.ultimate_strength
    if s.forces.kind == "concentrated":
        return []
    if fu is None:
        return [text.lacks(s, strength_key(s.material.name, "ultimate"))]

    def shown(k: int) -> tuple[Work, Passing]:
        section = s.forces.sections[k]
        resisted = work(
            "F_v,Rd", float(shear_resistance(section.area, fu, s.partial)), "force",
            "0.6 × {A} × {f_up} / {γ_M2}", A=(section.area, "length^2"), f_up=(fu, "stress"),
            γ_M2=(s.partial.M2, "1"),
        )  # fmt: skip
        return resisted, lambda used: wider(section, used, 2.0, lambda x: x.area)

    return [text.along(s, s.forces.shear, _sheared(s, fu), shown=shown)]


@_by_forces("EN 1993 bending", level="ultimate", dimension="moment")
def eurocode_bending(text: CheckText, s: Situation) -> list[Margin]:
    """The bending moment against M_Rd."""
    return _bending(text, s)


@_by_forces("EN 1993 shear and bending", level="ultimate", dimension=RATIO_DIMENSION)
def eurocode_shear_and_bending(text: CheckText, s: Situation) -> list[Margin]:
    """The largest moment and the largest shear force of an instant together, against 1."""
    forces, fu, fy = s.forces, s.material.ultimate_strength, s.material.yield_strength
    if forces.kind == "concentrated":
        return []
    if fu is None or fy is None:
        strengths = ("ultimate", fu), ("yield", fy)
        missing = (strength_key(s.material.name, w) for w, value in strengths if value is None)
        return [text.lacks(s, *missing)]
    sheared, bent = _sheared(s, fu), _bent(s, fy)
    used = np.hypot((forces.moment / bent).max(axis=1), (forces.shear / sheared).max(axis=1))
    note = "root of the sum of squares; the clause's sum is its square"
    (margin,) = [text.along(s, used[:, None], np.ones(1), note)]
    t = int(used.argmax())
    i, k = int((forces.moment / bent)[t].argmax()), int((forces.shear / sheared)[t].argmax())
    M, V, sections = float(forces.moment[t, i]), float(forces.shear[t, k]), forces.sections
    both = work(
        "u", float(used[t]), RATIO_DIMENSION, "√(({M_Ed} / {M_Rd})² + ({F_v,Ed} / {F_v,Rd})²)",
        **{"M_Ed": (M, "moment"), "M_Rd": (float(bent[i]), "moment"), "F_v,Ed": (V, "force"),
           "F_v,Rd": (float(sheared[k]), "force")},
    )  # fmt: skip

    def of_wall(wall: float) -> float:
        in_bending, in_shear = (Circle(sections[x].inner + wall, sections[x].inner) for x in (i, k))
        W_el, W_pl = in_bending.modulus, in_bending.plastic_modulus
        m = M / float(bending_resistance(W_el, fy, s.partial, plastic=W_pl))
        v = V / float(shear_resistance(in_shear.area, fu, s.partial))
        return margin.factor * math.hypot(m, v)

    alike = sections[i] == sections[k]  # else there is more than one diameter
    passing = diameter_of_wall(sections[i], of_wall) if alike else None
    return [replace(margin, work=(both,), passing=passing)]


@_by_forces("EN 1993 bending, replaceable", dimension="moment")
def eurocode_bending_replaceable(text: CheckText, s: Situation) -> list[Margin]:
    """The bending moment of a replaceable pin against M_Rd,ser."""
    return _bending(text, s, replaceable=True) if s.replaceable else []


@_by_bands("EN 1993 bearing", level="ultimate", dimension="force")
def eurocode_bearing(text: CheckText, s: Situation) -> list[Margin]:
    """The force on each band against F_b,Rd of pin and lug."""
    return _bearing(text, s)


@_by_bands("EN 1993 bearing, replaceable", dimension="force")
def eurocode_bearing_replaceable(text: CheckText, s: Situation) -> list[Margin]:
    """The force on each band of a replaceable pin against F_b,Rd,ser of pin and lug."""
    return _bearing(text, s, replaceable=True) if s.replaceable else []


@check("EN 1993 contact, replaceable", f"{_CLAUSE}.2(3)", kind="clause", takes="statics",
       omits="Not covered: the edges of the hole, wear.")  # fmt: skip
def eurocode_contact_replaceable(text: CheckText, s: Situation) -> list[Margin]:
    """The contact stress of a replaceable pin in lugs with a clearance, against 2.5 f_y."""
    if not s.replaceable:
        return []
    strengths, lacking = _lower_strengths(s)
    if lacking:
        return [text.lacks(s, *lacking)]
    lugs = [s.lug(name) for name in s.loads.surfaces]
    loose = [k for k, lug in enumerate(lugs) if lug is not None and lug.loosest > 0.0]
    of_pin = f"pin.{key_part(s.pin.name)}.lug"
    if not loose:
        return [text.lacks(s, f"a clearance in {of_pin}")]
    holes = [_hole(s, s.loads.surfaces[k]) for k in loose]
    at = PinInHole(*(np.array(sizes) for sizes in zip(*holes, strict=True)))
    stress = contact_stress(s.across[:, loose], at)
    allowed = 2.5 / s.partial.M6_ser * np.array(strengths)[loose]
    names = tuple(s.loads.surfaces[k] for k in loose)
    margin = text.worst(s, stress, allowed, names, "the factor is the root of that on loads")
    margin = replace(margin, factor=math.sqrt(margin.factor))
    d, hole, t, E = holes[names.index(margin.at)]
    force = float(s.across[:, s.loads.surfaces.index(margin.at)].max())
    shown = work(
        "σ_h", margin.demand or 0.0, "stress",
        "0.591 × √({E} × {F} × ({d_0} − {d}) / ({d} × {d} × {t}))",
        E=(E, "stress"), F=(force, "force"), d_0=(hole, "length"), d=(d, "length"), t=(t, "length"),
    )  # fmt: skip
    margins = [replace(margin, work=(shown,), passing=scaled("thickness", t, margin.used, 0.5))]
    bands = zip(s.loads.surfaces, lugs, s.across.T, strict=True)
    unknown = [
        f"{of_pin}.{key_part(name)}.clearance"
        for name, lug, force in bands
        if lug is None and force.any()
    ]
    return [*margins, text.lacks(s, *unknown)] if unknown else margins


def _sheared(s: Situation, ultimate: float) -> Floats:
    return np.asarray(shear_resistance(s.forces.of_sections("area"), ultimate, s.partial))


def _bent(s: Situation, strength: float, *, replaceable: bool = False) -> Floats:
    W_el, W_pl = s.forces.of_sections("modulus"), s.forces.of_sections("plastic_modulus")
    return np.asarray(
        bending_resistance(W_el, strength, s.partial, plastic=W_pl, replaceable=replaceable)
    )


def _bending(text: CheckText, s: Situation, *, replaceable: bool = False) -> list[Margin]:
    fy = s.material.yield_strength
    if s.forces.kind == "concentrated":
        return []
    if fy is None:
        return [text.lacks(s, strength_key(s.material.name, "yield"))]

    def resistance(x: Circle) -> float:
        W_pl = x.plastic_modulus
        moment = bending_resistance(x.modulus, fy, s.partial, plastic=W_pl, replaceable=replaceable)
        return float(moment)

    def shown(k: int) -> tuple[Work, Passing]:
        section = s.forces.sections[k]
        W_el, W_pl, resisted = section.modulus, section.plastic_modulus, resistance(section)
        strength, moduli = {"f_yp": (fy, "stress")}, {"W_el": (W_el, "length^3")}
        if replaceable:
            formula = "0.8 × {W_el} × {f_yp} / {γ_M6}"
            moment = work("M_Rd,ser", resisted, "moment", formula, **moduli, **strength,
                          γ_M6=(s.partial.M6_ser, "1"))  # fmt: skip
        else:
            formula = "min(1.5 × {W_el}, {W_pl}) × {f_yp} / {γ_M0}"
            moment = work("M_Rd", resisted, "moment", formula, **moduli, **strength,
                          W_pl=(W_pl, "length^3"), γ_M0=(s.partial.M0, "1"))  # fmt: skip
        return moment, lambda used: wider(section, used, 3.0, resistance)

    bent = _bent(s, fy, replaceable=replaceable)
    return [text.along(s, s.forces.moment, bent, shown=shown)]


def _lower_strengths(s: Situation) -> tuple[list[float], list[str]]:
    """Return the lower yield strength of pin and lug at each band, and the missing keys."""
    strengths, lacking = [], []
    for name in s.loads.surfaces:
        lug = s.lug(name)
        both = [s.material] if lug is None else [s.material, lug.bearing]
        lacking += [strength_key(m.name, "yield") for m in both if m.yield_strength is None]
        strengths.append(min((m.yield_strength for m in both if m.yield_strength), default=0.0))
    return strengths, list(dict.fromkeys(lacking))


def _bearing(text: CheckText, s: Situation, *, replaceable: bool = False) -> list[Margin]:
    strengths, lacking = _lower_strengths(s)
    if lacking:
        return [text.lacks(s, *lacking)]
    bands = [s.pin.band(name) for name in s.loads.surfaces]
    resisted = bearing_resistance(
        np.array([b.length for b in bands]),
        np.array([2.0 * b.radius for b in bands]),
        np.array(strengths),
        s.partial,
        replaceable=replaceable,
    )
    bare = [name for name in s.loads.surfaces if s.lug(name) is None]
    basis = f"strength of the pin alone at {', '.join(bare)}: no lug given" if bare else ""
    factor = "0.6" if replaceable else "1.5"

    def shown(k: int) -> tuple[Work, Passing]:
        band, gamma = bands[k], s.partial.M6_ser if replaceable else s.partial.M0
        bears = work(
            "F_b,Rd", float(resisted[k]), "force", f"{factor} × {{t}} × {{d}} × {{f_y}} / {{γ}}",
            t=(band.length, "length"), d=(2.0 * band.radius, "length"),
            f_y=(strengths[k], "stress"), γ=(gamma, "1"),
        )  # fmt: skip
        return bears, lambda used: scaled("thickness", band.length, used, 1.0)

    return [text.worst(s, s.across, resisted, s.loads.surfaces, basis, shown)]


def _hole(s: Situation, name: str) -> tuple[float, float, float, float]:
    """Return the diameters of pin and hole and the thickness, m, and Young's modulus, Pa.

    The modulus is the harmonic mean of those of pin and lug, which deform in series.
    """
    lug, band = s.lug(name), s.pin.band(name)
    assert lug is not None
    E = 2.0 / (1.0 / s.material.youngs_modulus + 1.0 / lug.bearing.youngs_modulus)
    d = 2.0 * band.radius
    return d, d + lug.loosest, band.length, E

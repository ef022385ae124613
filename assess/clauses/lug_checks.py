"""Hand checks of the lugs in which a pin sits: net section, shear-out, bearing.

The nominal stresses of an eye of width W, bore D and thickness t on a pin of diameter d. The
largest force F of the case is assumed to pull along the shank:

    net section    F / (C_r 2 t b_eff),  b_eff = min(b, 4 t, 0.6 b F_u/F_y sqrt(D/b)), b = (W - D)/2
    shear-out      F / (2 L t),  L = sqrt(e^2 - (D/2 sin 40)^2) - D/2 cos 40
    bearing        F / (d t)

A wide net section is not fully used: the stress concentrates at the bore, and the lug breaks there
before the rest has yielded. b_eff and C_r, which is lower for a loose pin, are those of ASME BTH-1.
If the material has no ultimate strength, F_u = F_y is used, which is on the safe side. At W = 5 D,
F / ((W - D) t) would be about half of this stress.

The shear planes are parallel to the force. They start at the bore, 40 degrees off the direction of
the force, and end at the edge of the head, e from the centre of the bore; their length is
e - D/2 cos 40 if the end of the head is straight. The stresses are compared with yield, in shear
with yield over sqrt(3) (von Mises); yield as the strength in bearing is a convention. The stress
concentration at the bore and loads across the shank are not included.

Source: ASME BTH-1-2005, equations 3-45 to 3-51 (net section; by spreadsheets, docs/evidence.md),
after D. Duerr, J. Struct. Eng. 132(2), 2006, 182-194; R. G. Budynas & J. K. Nisbett,
Shigley's Mechanical Engineering Design, 8-12 (edge shear, bearing); E. F. Bruhn, Analysis and
Design of Flight Vehicle Structures, D1 (planes at 40 degrees); ANSI/AISC 360, J7 (the same area in
bearing).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from assess.check import CheckText, Rupture, check
from assess.clauses.bth1 import effective_width, pin_to_hole
from assess.clauses.eye import LoadedEye, PlateEye, loaded_eyes, place_of
from assess.clauses.eye_margin import DIMENSION_NAMES
from assess.margin import Margin
from assess.situation import Situation
from assess.strength.hand_checks import (
    BEARING_SOURCE,
    METHODS_BY_FORMULA,
    SHIGLEY_JOINTS,
    shear_yield,
)
from assess.work import Work, WorkQuantity, scaled, work
from fea.core.material import Material

BTH1 = "ASME BTH-1-2005, eq. 3-45 to 3-51; Duerr 2006"
BRUHN = "Bruhn, Analysis and Design of Flight Vehicle Structures, D1"
NET_SECTION_FORMULA = "F / (C_r 2 t b_eff)"
SHEAR_OUT_FORMULA = "F / (2 t (sqrt(e^2 - (D/2 sin 40°)^2) - D/2 cos 40°))"
SQUARE_SHEAR_OUT_FORMULA = "F / (2 t (e - D/2 cos 40°))"
BEARING_FORMULA = "F / (d t)"
SHEAR_PLANE_ANGLE = math.radians(40.0)  # of shear-out, off the direction of the force
LUG_CHECK_OMITS = "Not covered: stress concentration at the bore, forces across the shank, fatigue."
NET_SECTION = CheckText("lug, net section", BTH1, "hand", omits=LUG_CHECK_OMITS)
SHEAR_OUT = CheckText("lug, shear-out", BRUHN, "hand", omits=LUG_CHECK_OMITS)
BEARING = CheckText("lug, bearing", BEARING_SOURCE, "hand", omits=LUG_CHECK_OMITS)
OF_BUSHING = CheckText("lug, bearing, bushing", BEARING_SOURCE, "hand", omits=LUG_CHECK_OMITS)
_Stress = Callable[[PlateEye], Work]
_LugCheck = tuple[CheckText, _Stress, Material, float | None, Rupture, str, str]


def net_section_stress(force: float, ultimate_over_yield: float, eye: PlateEye) -> Work:
    """Return the tensile stress on the effective part of the net section, Pa.

    force: N. ultimate_over_yield: F_u / F_y of the lug.

    Source: as the module.
    """
    b_eff, C_r = effective_width(eye, ultimate_over_yield), pin_to_hole(eye)
    return work(
        "σ", force / (C_r * 2.0 * eye.thickness * b_eff), "stress",
        "{F} / ({C_r} × 2 × {t} × {b_eff})",
        F=(force, "force"), C_r=(C_r, "1"), t=(eye.thickness, "length"), b_eff=(b_eff, "length"),
    )  # fmt: skip


def shear_out_stress(force: float, eye: PlateEye) -> Work:
    """Return the shear stress on the two planes along which the pin would shear out of the eye, Pa.

    Arguments and source as `net_section_stress`.
    """
    across = eye.hole / 2.0 * math.sin(SHEAR_PLANE_ANGLE)
    along = eye.hole / 2.0 * math.cos(SHEAR_PLANE_ANGLE)
    length = (eye.e if eye.square else math.sqrt(eye.e**2 - across**2)) - along
    return work(
        "τ", force / (2.0 * length * eye.thickness), "stress", "{F} / (2 × {t} × {L})",
        F=(force, "force"), t=(eye.thickness, "length"), L=(length, "length"),
    )  # fmt: skip


def bearing_stress(force: float, eye: PlateEye) -> Work:
    """Return the bearing stress on the projected area of the bore, Pa; as `net_section_stress`."""
    return work(
        "σ", force / (eye.bearer * eye.thickness), "stress", "{F} / ({d} × {t})",
        F=(force, "force"), d=(eye.bearer, "length"), t=(eye.thickness, "length"),
    )  # fmt: skip


@check("lug", SHIGLEY_JOINTS, kind="hand", takes="loads")
def lug_checks(_: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of net section, shear-out and bearing of every loaded lug whose size is
    given, and of the bearing of the pin on its bushing.

    The instant is that of the largest transverse force on the pin, which is assumed along the shank
    whatever its direction. The thickness of the lug is the length of its band.
    """
    return [m for loaded in loaded_eyes(s) for m in _of_lug(s, loaded)]


@check("lug, as required", SHIGLEY_JOINTS, kind="hand", takes="loads")
def required_lug_checks(_: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of `lug_checks` that the study requires, for codes that omit them."""
    checks = {m: x for x, methods in METHODS_BY_FORMULA.items() for m in methods}
    return [m for m in lug_checks(s) if (checks.get(m.method), m.level) in s.required]


def _of_lug(s: Situation, loaded: LoadedEye) -> list[Margin]:
    t, material, eye = int(loaded.size.argmax()), loaded.lug, loaded.eye
    force, place, yields = float(loaded.size[t]), place_of(s, loaded, t), material.yield_strength
    ratio = 1.0
    if material.ultimate_strength is not None and yields is not None:
        ratio = material.ultimate_strength / yields
    out_formula = SQUARE_SHEAR_OUT_FORMULA if eye.square else SHEAR_OUT_FORMULA
    net = partial(net_section_stress, force, ratio)
    out, bears = partial(shear_out_stress, force), partial(bearing_stress, force)
    every: list[_LugCheck] = [
        (NET_SECTION, net, material, yields, "ultimate", NET_SECTION_FORMULA, "width"),
        (SHEAR_OUT, out, material, shear_yield(material), "shear", out_formula, "width"),
        (BEARING, bears, material, yields, "bearing", BEARING_FORMULA, "thickness"),
    ]
    if ring := loaded.bushing:
        inside = partial(_stress_in_bushing, force)
        yields = ring.yield_strength
        every += [(OF_BUSHING, inside, ring, yields, "bearing", BEARING_FORMULA, "thickness")]
    margins = []
    for text, stress, bearer, strength, ruptures, formula, dimension in every:
        shown = stress(eye)
        for m in text.at_levels(s, shown.result.value, place, bearer, strength, ruptures, formula):
            passing = _passing(eye, dimension, stress, m)
            margins.append(replace(m, work=(shown,), passing=passing, omits=text.omits))
    return margins


def _stress_in_bushing(force: float, eye: PlateEye) -> Work:
    """Return the bearing stress of the pin on a bushing, Pa."""
    return bearing_stress(force, replace(eye, bushed=False))


def _passing(eye: PlateEye, dimension: str, stress: _Stress, margin: Margin) -> WorkQuantity | None:
    """Return the dimension of an eye that would just pass; None if there is none."""
    allowable, factor, name = margin.allowable, margin.factor, DIMENSION_NAMES[dimension]
    if not allowable:
        return None
    if dimension == "thickness":
        return scaled(name, eye.thickness, margin.used, 1.0)
    value = eye.would_pass(dimension, lambda e: factor * stress(e).result.value / allowable)
    return value if value is None else WorkQuantity(name, value, "length")

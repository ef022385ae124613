"""Lugs under axial, transverse and oblique loads by the method of Melcon and Hoblit.

    shear-bearing    P_bru = k_br F_tux D t
    tension          P_tu = k_t F_tu (W - D) t
    yield            P_y = C (F_tyx / F_tux) min(P_bru, P_tu)
    bushing, yield   P_y = 1.85 F_cy Dp t
    transverse       P_tru = k_tru F_tux D t       P_try = k_try F_tyx D t
    oblique          (R_a^1.6 + R_tr^1.6)^0.625 <= 1

R_a and R_tr are the axial and the transverse component of the force over the allowable load in each
direction. The efficiency factors are read off the figures of the method, for which there is no
formula; the study states them. They hold only for the ratio of width to bore for which they were
read. The dimension that would just pass is therefore a thickness.

A study has one ultimate and one yield strength of a material. If the strengths across the grain
(F_tux, F_tyx) are lower, they are to be stated instead.

Source: M. C. Y. Niu, Airframe Stress Analysis and Sizing, 9.8, pp. 329-336, after Melcon & Hoblit,
whose paper was not read.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from assess.check import CheckText, check
from assess.clauses.eye import LoadedEye, PlateEye, loaded_eyes, place_of
from assess.clauses.eye_margin import eye_margin, strengths_of
from assess.margin import RATIO_DIMENSION, Margin, strength_key
from assess.situation import Situation
from assess.work import Work, scaled, work
from pinbase.arrays import Floats
from pinbase.keys import lug_key

NIU = "Niu, Airframe Stress Analysis, 9.8, after Melcon & Hoblit"
BUSHING_BEARING = 1.85  # of the bushing's yield strength in compression, at yield
OBLIQUE_EXPONENT = 1.6  # of the interaction; 0.625 is its inverse
NIU_OMITS = (
    "Not covered: elongations under 5 %, strength across the grain other than the material's, "
    "bending of the lug, fatigue."
)
AXIAL_KEYS, TRANSVERSE_KEYS = ("k_br", "k_t"), ("k_tru",)


def shear_bearing_load(k_br: float, ultimate: float, eye: PlateEye) -> Work:
    """Return P_bru, N. ultimate: ultimate strength across the grain, Pa."""
    return _on_bearing_area("P_bru", "k_br", eye, k_br, "F_tu", ultimate)


def tension_load(k_t: float, ultimate: float, eye: PlateEye) -> Work:
    """Return P_tu, N. ultimate: ultimate strength along the grain, Pa."""
    area = (eye.width - eye.hole) * eye.thickness
    return work(
        "P_tu", k_t * ultimate * area, "force", "{k_t} × {F_tu} × ({W} − {D}) × {t}",
        k_t=(k_t, "1"), F_tu=(ultimate, "stress"), W=(eye.width, "length"),
        D=(eye.hole, "length"), t=(eye.thickness, "length"),
    )  # fmt: skip


def yield_load(ultimate_load: float, C: float, yields: float, ultimate: float) -> Work:
    """Return P_y, N, from the lower ultimate load, N.

    yields, ultimate: strengths across the grain, Pa.
    """
    return work(
        "P_y", C * yields / ultimate * ultimate_load, "force", "{C} × ({F_ty} / {F_tu}) × {P_u}",
        C=(C, "1"), F_ty=(yields, "stress"), F_tu=(ultimate, "stress"),
        P_u=(ultimate_load, "force"),
    )  # fmt: skip


def bushing_yield_load(crushes: float, eye: PlateEye) -> Work:
    """Return P_y of a bushing, N. crushes: its yield strength in compression, Pa."""
    return work(
        "P_y", BUSHING_BEARING * crushes * eye.pin * eye.thickness, "force",
        "1.85 × {F_cy} × {D_p} × {t}",
        F_cy=(crushes, "stress"), D_p=(eye.pin, "length"), t=(eye.thickness, "length"),
    )  # fmt: skip


def transverse_load(k_tru: float, ultimate: float, eye: PlateEye) -> Work:
    """Return P_tru, N. ultimate: ultimate strength across the grain, Pa."""
    return _on_bearing_area("P_tru", "k_tru", eye, k_tru, "F_tu", ultimate)


def transverse_yield_load(k_try: float, yields: float, eye: PlateEye) -> Work:
    """Return P_try, N. yields: yield strength across the grain, Pa."""
    return _on_bearing_area("P_try", "k_try", eye, k_try, "F_ty", yields)


def oblique_ratio(axial: Floats | float, transverse: Floats | float) -> Floats:
    """Return (R_a^1.6 + R_tr^1.6)^0.625 for the ratios of the two components of a force."""
    n = OBLIQUE_EXPONENT
    return np.asarray((np.power(axial, n) + np.power(transverse, n)) ** (1.0 / n))


_of_lugs = partial(
    check, kind="clause", takes="loads", level="ultimate", dimension="force", omits=NIU_OMITS
)


@_of_lugs("Melcon-Hoblit shear-bearing", NIU)
def shear_bearing(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the axial force in shear-bearing, for eyes whose k_br is given."""
    return _along(text, s, "k_br", shear_bearing_load)


@_of_lugs("Melcon-Hoblit tension", NIU)
def tension(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the axial force on the net section, for eyes whose k_t is given."""
    return _along(text, s, "k_t", tension_load)


def _along(
    text: CheckText, s: Situation, factor: str, load: Callable[[float, float, PlateEye], Work]
) -> list[Margin]:
    """Return the margins of the axial force on every eye for which an efficiency factor is given.

    factor: the name of the efficiency factor.
    """
    margins = []
    for x in _pulled(s):
        k, ultimate = getattr(s.factors_of(x.connection), factor), x.lug.ultimate_strength
        if k is None:
            continue
        if not ultimate:
            margins.append(text.lacks(s, *strengths_of(x.lug).missing))
            continue
        margins.append(eye_margin(text, s, x, x.axial, partial(load, k, ultimate), "thickness"))
    return margins


@check("Melcon-Hoblit yield", NIU, kind="clause", takes="loads", dimension="force", omits=NIU_OMITS)
def lug_yield(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the axial force against the yield load, for eyes whose k_br or k_t is
    given.
    """
    margins = []
    for x in _pulled(s):
        k, strengths = s.factors_of(x.connection), strengths_of(x.lug)
        if not _axial_given(s, x):
            continue
        if k.k_br is None or k.k_t is None or k.C is None or strengths.missing:
            margins.append(text.lacks(s, *strengths.missing, *_lacking(s, x, *AXIAL_KEYS, "C")))
            continue

        def capacity(
            eye: PlateEye, k_br: float = k.k_br, k_t: float = k.k_t, C: float = k.C,
            fy: float = strengths.yields, fu: float = strengths.ultimate,
        ) -> Work:  # fmt: skip
            loads = shear_bearing_load(k_br, fu, eye), tension_load(k_t, fu, eye)
            return yield_load(min(load.result.value for load in loads), C, fy, fu)

        margins.append(eye_margin(text, s, x, x.axial, capacity, "thickness"))
    return margins


@check("Melcon-Hoblit bushing", NIU, kind="clause", takes="loads", dimension="force",
       omits=NIU_OMITS)  # fmt: skip
def bushing_yield(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the force against the yield load of the bushing, for bushed eyes whose
    k_br or k_t is given. The manual's ultimate load (assess.clauses.affdl_lugs) is lower.
    """
    margins = []
    for x in loaded_eyes(s):
        if x.bushing is None or not _axial_given(s, x):
            continue
        crushes = x.bushing.yield_strength
        if crushes is None:
            margins.append(text.lacks(s, strength_key(x.bushing.name, "yield")))
        else:
            capacity = partial(bushing_yield_load, crushes)
            margins.append(eye_margin(text, s, x, x.size, capacity, "thickness"))
    return margins


@_of_lugs("Melcon-Hoblit transverse", NIU)
def transverse(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the force across the shank of every eye against P_tru."""
    return _across(text, s, "k_tru", "ultimate")


@check("Melcon-Hoblit transverse yield", NIU, kind="clause", takes="loads", dimension="force",
       omits=NIU_OMITS)  # fmt: skip
def transverse_yield(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the force across the shank of every eye against P_try."""
    return _across(text, s, "k_try", "yield")


def _across(text: CheckText, s: Situation, key: str, which: str) -> list[Margin]:
    """Return the margins of the force across the shank of every eye.

    key: the name of the efficiency factor. which: the name of the strength that it multiplies.
    """
    margins = []
    for x in loaded_eyes(s):
        k = getattr(s.factors_of(x.connection), key)
        strength = getattr(x.lug, f"{which}_strength")
        if not x.transverse.any():
            continue
        if k is None or strength is None:
            missing = [strength_key(x.lug.name, which)] if strength is None else []
            margins.append(text.lacks(s, *_lacking(s, x, key), *missing))
            continue
        load = transverse_load if which == "ultimate" else transverse_yield_load
        margins.append(
            eye_margin(text, s, x, x.transverse, partial(load, k, strength), "thickness")
        )
    return margins


@check("Melcon-Hoblit oblique", NIU, kind="clause", takes="loads", level="ultimate",
       dimension=RATIO_DIMENSION, omits=NIU_OMITS)  # fmt: skip
def oblique(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the interaction of both components of an oblique force on every eye."""
    eyes = [x for x in loaded_eyes(s) if (x.axial * x.transverse).any()]
    return [_oblique(text, s, x) for x in eyes]


def _oblique(text: CheckText, s: Situation, x: LoadedEye) -> Margin:
    k, fu = s.factors_of(x.connection), x.lug.ultimate_strength
    if k.k_br is None or k.k_t is None or k.k_tru is None or fu is None:
        lacking = _lacking(s, x, *AXIAL_KEYS, *TRANSVERSE_KEYS)
        return text.lacks(s, *lacking, *(m for m in strengths_of(x.lug).missing if "ultim" in m))
    along = shear_bearing_load(k.k_br, fu, x.eye), tension_load(k.k_t, fu, x.eye)
    axial = min(load.result.value for load in along)
    return _combined(text, s, x, axial, (*along, transverse_load(k.k_tru, fu, x.eye)))


@check("Melcon-Hoblit oblique yield", NIU, kind="clause", takes="loads", dimension=RATIO_DIMENSION,
       omits=NIU_OMITS)  # fmt: skip
def oblique_yield(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the interaction at yield, for eyes whose k_br or k_t is given."""
    return [
        _oblique_yield(text, s, x)
        for x in loaded_eyes(s)
        if (x.axial * x.transverse).any() and _axial_given(s, x)
    ]


def _oblique_yield(text: CheckText, s: Situation, x: LoadedEye) -> Margin:
    k, strengths = s.factors_of(x.connection), strengths_of(x.lug)
    fy, fu = strengths.yields, strengths.ultimate
    if k.k_br is None or k.k_t is None or k.C is None or k.k_try is None or strengths.missing:
        return text.lacks(s, *_lacking(s, x, *AXIAL_KEYS, "C", "k_try"), *strengths.missing)
    loads = shear_bearing_load(k.k_br, fu, x.eye), tension_load(k.k_t, fu, x.eye)
    axial = yield_load(min(load.result.value for load in loads), k.C, fy, fu)
    across = transverse_yield_load(k.k_try, fy, x.eye)
    return _combined(text, s, x, axial.result.value, (*loads, axial, across))


def _combined(
    text: CheckText, s: Situation, x: LoadedEye, axial: float, works: tuple[Work, ...]
) -> Margin:
    """Return the margin of the interaction of both components of a force.

    axial: allowable load of the eye along its shank, N. works: the works of all allowable loads;
    the last is that across the shank.
    """
    across = works[-1].result.value
    used = oblique_ratio(x.axial / axial, x.transverse / across)
    t = int(used.argmax())
    place, R_a, R_tr = place_of(s, x, t), x.axial[t] / axial, x.transverse[t] / across
    both = work(
        "R", used[t], RATIO_DIMENSION, "({R_a}^1.6 + {R_tr}^1.6)^0.625", R_a=(R_a, "1"),
        R_tr=(R_tr, "1"),
    )  # fmt: skip
    passing = scaled("thickness", x.eye.thickness, s.factors.at(text.level) * float(used[t]), 1.0)
    return text.margin(s, float(used[t]), 1.0, place, x.lug.name, x.basis, (*works, both), passing)


def _pulled(s: Situation) -> list[LoadedEye]:
    """Return the eyes that are pulled along their shanks at any instant."""
    return [x for x in loaded_eyes(s) if x.axial.any()]


def _axial_given(s: Situation, x: LoadedEye) -> bool:
    """Whether the study gives any efficiency factor for axial pull."""
    return any(getattr(s.factors_of(x.connection), key) is not None for key in AXIAL_KEYS)


def _lacking(s: Situation, x: LoadedEye, *keys: str) -> list[str]:
    factors = s.factors_of(x.connection)
    return [
        lug_key(s.pin.name, x.connection, "factors", key)
        for key in keys
        if getattr(factors, key) is None
    ]


def _on_bearing_area(
    symbol: str,
    factor_symbol: str,
    eye: PlateEye,
    factor: float,
    strength_symbol: str,
    strength: float,
) -> Work:
    return work(
        symbol, factor * strength * eye.hole * eye.thickness, "force",
        f"{{{factor_symbol}}} × {{{strength_symbol}}} × {{D}} × {{t}}",
        **{factor_symbol: (factor, "1"), strength_symbol: (strength, "stress"),
           "D": (eye.hole, "length"), "t": (eye.thickness, "length")},
    )  # fmt: skip

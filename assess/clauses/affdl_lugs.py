"""Axially loaded lugs and their bushings by the Air Force's Stress Analysis Manual, chapter 9.

    bearing          P_bru = K (a/D) F D t      F = min(F_tux, 1.304 F_tyx), a/D not above 1
    net section      P_nu = K_n F (W - D) t     F = min(F_tu, 1.304 F_ty)
    bushing          P_u = 1.304 F_cy Dp t

1.304 is 1.5 / 1.15: with a higher ultimate load the lug would yield under limit load. All loads are
ultimate loads. The efficiency factors K and K_n are read off figures 9-2 to 9-4, for which there is
no formula; the study states them. The yield strength of the bushing is used as its strength in
compression, and the yield strength of the lug as that across the grain.

The example of the manual has e/D up to 1.5, a/D = 1. Beyond that a/D is kept at 1, which is on the
safe side of the formula. The text of the manual for this range was not read, nor were K and K_n
beyond the example.

Source: AFFDL-TR-69-42, Stress Analysis Manual (reprint of October 1986), equations 9-2a, 9-3b, 9-6
and 9-9 as in its example, 9.6 (docs/evidence.md), after the method of Melcon and Hoblit.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from assess.check import CheckText, check
from assess.clauses.eye import LoadedEye, PlateEye, loaded_eyes
from assess.clauses.eye_margin import EyeCapacity, eye_margin, not_axial, strengths_of
from assess.margin import Margin, strength_key
from assess.situation import Situation
from assess.work import Work, work
from pinbase.keys import lug_key

MANUAL = "AFFDL-TR-69-42"
ULTIMATE_OVER_YIELD = 1.304  # 1.5 / 1.15 as the manual has it
STRENGTH_FORMULA = "min({F_tu}, 1.304 × {F_ty})"
LUG_OMITS = (
    "Not covered: loads across the shank, elongations under 5 %, strength across the grain other "
    "than the material's, bending of the lug, fatigue. By the manual's example; for e/D above 1.5 "
    "a/D is kept at 1, which is not verified against the manual."
)


def lug_strength(yields: float, ultimate: float) -> float:
    """Return the lower of the ultimate strength and 1.304 times yield, Pa (9-3, 9-6)."""
    return min(ultimate, ULTIMATE_OVER_YIELD * yields)


def bearing_load(eye: PlateEye, K: float, yields: float, ultimate: float) -> Work:
    """Return the ultimate load of the lug in bearing, shear-out and hoop tension, N (9-1 to 9-3).

    K: from figure 9-2. yields, ultimate: strengths across the grain, Pa.
    """
    strength = lug_strength(yields, ultimate)
    value = K * min(eye.a / eye.hole, 1.0) * strength * eye.hole * eye.thickness
    return work(
        "P_bru", value, "force",
        f"{{K}} × min({{a}} / {{D}}, 1) × {STRENGTH_FORMULA} × {{D}} × {{t}}",
        K=(K, "1"), a=(eye.a, "length"), D=(eye.hole, "length"), F_tu=(ultimate, "stress"),
        F_ty=(yields, "stress"), t=(eye.thickness, "length"),
    )  # fmt: skip


def net_section_load(eye: PlateEye, K_n: float, yields: float, ultimate: float) -> Work:
    """Return the ultimate load of the net section, N (9-4 to 9-6).

    K_n: from figure 9-4. yields, ultimate: strengths, Pa.
    """
    strength = lug_strength(yields, ultimate)
    value = K_n * strength * (eye.width - eye.hole) * eye.thickness
    return work(
        "P_nu", value, "force", f"{{K_n}} × {STRENGTH_FORMULA} × ({{W}} − {{D}}) × {{t}}",
        K_n=(K_n, "1"), F_tu=(ultimate, "stress"), F_ty=(yields, "stress"),
        W=(eye.width, "length"), D=(eye.hole, "length"), t=(eye.thickness, "length"),
    )  # fmt: skip


def bushing_load(eye: PlateEye, crushes: float) -> Work:
    """Return the ultimate load of a bushing, N (9-8, 9-9).

    crushes: its yield strength in compression, Pa.
    """
    value = ULTIMATE_OVER_YIELD * crushes * eye.pin * eye.thickness
    return work(
        "P_u", value, "force", "1.304 × {F_cy} × {D_p} × {t}",
        F_cy=(crushes, "stress"), D_p=(eye.pin, "length"), t=(eye.thickness, "length"),
    )  # fmt: skip


_of_lugs = partial(
    check, kind="clause", takes="loads", level="ultimate", dimension="force", omits=LUG_OMITS
)


@_of_lugs("AFFDL lug bearing", f"{MANUAL}, 9.3, eq. 9-1 to 9-3")
def affdl_bearing(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the axial force on every eye in bearing and shear-out."""
    return _margins(text, s, bearing_capacity, "k_br")


@_of_lugs("AFFDL lug net section", f"{MANUAL}, 9.3, eq. 9-4 to 9-6")
def affdl_net_section(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the axial force on the net section of every eye."""
    return _margins(text, s, net_section_capacity, "k_t")


@_of_lugs("AFFDL bushing", f"{MANUAL}, 9.3, eq. 9-8 and 9-9")
def affdl_bushing(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the force on every bushed eye against yielding of the bushing."""
    margins = []
    for x in loaded_eyes(s):
        capacity = bushing_capacity(x)
        if isinstance(capacity, str):
            margins.append(text.lacks(s, capacity))
        elif capacity is not None:
            margins.append(eye_margin(text, s, x, x.size, capacity, "thickness"))
    return margins


def bearing_capacity(s: Situation, x: LoadedEye) -> EyeCapacity | list[str]:
    """Return the bearing load as a function of the eye, or the keys that the study lacks."""
    return _capacity(s, x, "K", bearing_load)


def net_section_capacity(s: Situation, x: LoadedEye) -> EyeCapacity | list[str]:
    """Return the load of the net section as a function of the eye, or the missing keys."""
    return _capacity(s, x, "K_n", net_section_load)


def _capacity(
    s: Situation, x: LoadedEye, key: str, load: Callable[[PlateEye, float, float, float], Work]
) -> EyeCapacity | list[str]:
    """Return a load as a function of the eye, or the missing keys.

    key: the name of the efficiency factor of the load.
    """
    factor, strengths = getattr(s.factors_of(x.connection), key), strengths_of(x.lug)
    if factor is None or strengths.missing:
        named = [lug_key(s.pin.name, x.connection, "factors", key)] if factor is None else []
        return [*named, *strengths.missing]
    return lambda eye: load(eye, factor, strengths.yields, strengths.ultimate)


def bushing_capacity(x: LoadedEye) -> EyeCapacity | str | None:
    """Return the load of a bushing as a function of the eye, or the missing key; None without a
    bushing.
    """
    if x.bushing is None:
        return None
    crushes = x.bushing.yield_strength
    if crushes is None:
        return strength_key(x.bushing.name, "yield")
    return partial(bushing_load, crushes=crushes)


def _margins(
    text: CheckText,
    s: Situation,
    capacity_of: Callable[[Situation, LoadedEye], EyeCapacity | list[str]],
    instead: str,
) -> list[Margin]:
    """Return the margins of the axial force on every eye.

    instead: the name of the factor of an equivalent check. If only that factor is given, a missing
    factor of this check is not reported.
    """
    margins = list[Margin]()
    for x in loaded_eyes(s):
        if not x.axial.any():
            if not x.transverse.any() and (pushed := not_axial(text, s, x)):
                margins.append(pushed)
            continue
        capacity = capacity_of(s, x)
        if not isinstance(capacity, list):
            margins.append(eye_margin(text, s, x, x.axial, capacity, "thickness"))
        elif getattr(s.factors_of(x.connection), instead) is None:
            margins.append(text.lacks(s, *capacity))
    return margins

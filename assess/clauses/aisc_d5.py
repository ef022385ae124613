"""Pin-connected members by ANSI/AISC 360, D5 and J7.

    tensile rupture      P_n = F_u 2 t b_e               phi 0.75    Omega 2.00
    shear rupture        P_n = 0.6 F_u 2 t (a + d/2)     phi 0.75    Omega 2.00
    bearing              P_n = 1.8 F_y d t               phi 0.75    Omega 2.00
    yielding             P_n = F_y w t                   phi 0.90    Omega 1.67

b_e = 2 t + 0.63 in, at most the width beside the hole; a is the distance from the hole to the end
of the plate. With load and resistance factors (LRFD) phi P_n is compared at ultimate load, whose
factor replaces those of the load combinations. With allowable strengths (ASD) P_n / Omega is
compared at limit load.

D5.2 requires a >= 1.33 b_e and, in a joint that rotates under load, a hole of at most d + 1/32 in;
w >= 2 b_e + d follows from b_e. Plates that do not meet these proportions are reported, because the
strengths hold only for plates that do.

Source: AISC Design Examples 15, D.7 (docs/evidence.md), which has the strengths P_n, phi = 0.75 and
Omega = 2.00; figure C-D5.1 of the commentary on ANSI/AISC 360-10, and D3 of the LRFD Specification
of 1999, for the proportions. ANSI/AISC 360-16 was not read: phi = 0.90 and Omega = 1.67 of yielding
and the numbers of its clauses are not verified.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from assess.check import CheckText, check
from assess.clauses.eye import ROUND_OFF, PlateEye, loaded_eyes
from assess.clauses.eye_margin import eye_margin, not_axial, strengths_of
from assess.codes import AiscDesign
from assess.margin import Margin
from assess.situation import Situation
from assess.work import Work, work

RUPTURE_PHI, YIELD_PHI = 0.75, 0.90  # resistance factors; the second is not verified
RUPTURE_OMEGA, YIELD_OMEGA = 2.00, 1.67  # safety factors; the second is not verified
WIDTH_BEYOND_THICKNESS = 0.63 * 0.0254  # constant term of b_e, m
MIN_END = 1.33  # smallest a over b_e
MAX_PLAY = 0.0254 / 32.0  # largest difference of the diameters of hole and pin, m
PLAY_NEEDED = "a hole at most 1/32 in wider than the pin (D5.2: if it turns under load) at lug"
AISC_D5_OMITS = (
    "Not covered: forces across the plate, corners cut off by more than 45 degrees, load "
    "combinations. phi = 0.90 and Omega = 1.67 of yielding are not verified against the "
    "specification."
)


def effective_width(eye: PlateEye) -> float:
    """b_e, m (D5.1a)."""
    return min(2.0 * eye.thickness + WIDTH_BEYOND_THICKNESS, eye.side)


def tensile_rupture(
    eye: PlateEye, yields: float, ultimate: float, design: AiscDesign = "LRFD"
) -> Work:
    """The design strength, N (D5-1). yields, ultimate: F_y and F_u, Pa."""
    b_e = effective_width(eye)
    return _designed(
        design, "P_n", ultimate * 2.0 * eye.thickness * b_e, "{F_u} × 2 × {t} × {b_e}",
        F_u=(ultimate, "stress"), t=(eye.thickness, "length"), b_e=(b_e, "length"),
    )  # fmt: skip


def shear_rupture(
    eye: PlateEye, yields: float, ultimate: float, design: AiscDesign = "LRFD"
) -> Work:
    """The design strength, N (D5-2); arguments as `tensile_rupture`."""
    area = 2.0 * eye.thickness * (eye.a + eye.bearer / 2.0)
    return _designed(
        design, "P_n", 0.6 * ultimate * area, "0.6 × {F_u} × 2 × {t} × ({a} + {d} / 2)",
        F_u=(ultimate, "stress"), t=(eye.thickness, "length"), a=(eye.a, "length"),
        d=(eye.bearer, "length"),
    )  # fmt: skip


def bearing(eye: PlateEye, yields: float, ultimate: float, design: AiscDesign = "LRFD") -> Work:
    """The design strength, N (J7-1); arguments as `tensile_rupture`."""
    return _designed(
        design, "R_n", 1.8 * yields * eye.bearer * eye.thickness, "1.8 × {F_y} × {d} × {t}",
        F_y=(yields, "stress"), d=(eye.bearer, "length"), t=(eye.thickness, "length"),
    )  # fmt: skip


def gross_yielding(
    eye: PlateEye, yields: float, ultimate: float, design: AiscDesign = "LRFD"
) -> Work:
    """The design strength, N (D2-1), of the head or of a narrower shank; arguments as
    `tensile_rupture`.
    """
    w = min(eye.width, eye.shank)
    return _designed(
        design, "P_n", yields * w * eye.thickness, "{F_y} × {w} × {t}",
        F_y=(yields, "stress"), w=(w, "length"), t=(eye.thickness, "length"), yielding=True,
    )  # fmt: skip


def _designed(
    design: AiscDesign,
    symbol: str,
    nominal: float,
    formula: str,
    *,
    yielding: bool = False,
    **quantities: tuple[float, str],
) -> Work:
    """The design strength of a nominal one, N, of rupture or of yielding."""
    if design == "LRFD":
        phi = YIELD_PHI if yielding else RUPTURE_PHI
        shown = f"{phi:.2f} × {formula}"
        return work(f"φ{symbol}", phi * nominal, "force", shown, **quantities)
    omega = YIELD_OMEGA if yielding else RUPTURE_OMEGA
    shown = f"{formula} / {omega:.2f}"
    return work(f"{symbol}/Ω", nominal / omega, "force", shown, **quantities)


def proportions(eye: PlateEye, connection: str) -> list[str]:
    """Return the requirements of D5.2 that a plate does not meet; connection: its lug."""
    short = eye.a / effective_width(eye)
    lacking = []
    if short < MIN_END * (1.0 - ROUND_OFF):
        lacking.append(
            f"an end of {MIN_END:g} b_e beyond the hole (D5.2; now {short:.3g} b_e) at lug "
            f"{connection}"
        )
    if eye.bearer + MAX_PLAY < eye.hole * (1.0 - ROUND_OFF):
        lacking.append(f"{PLAY_NEEDED} {connection}")
    return lacking


_FORMS = (
    ("tensile rupture", "D5.1(a)", tensile_rupture, "width"),
    ("shear rupture", "D5.1(b)", shear_rupture, "width"),
    ("bearing", "J7", bearing, "thickness"),
    ("yielding", "D2(a)", gross_yielding, "thickness"),
)


@check("AISC pin-connected member", "ANSI/AISC 360-16, D5", kind="clause", takes="loads",
       level="ultimate", dimension="force", omits=AISC_D5_OMITS)  # fmt: skip
def aisc_member(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the force on every plate against its limit states."""
    if s.aisc == "ASD":
        text = replace(text, level="limit")
    margins = []
    for x in loaded_eyes(s):
        strengths = strengths_of(x.lug)
        if strengths.missing:
            margins.append(text.lacks(s, *strengths.missing))
            continue
        other = not_axial(text, s, x)
        margins += [other] if other else []
        named = replace(text, method="AISC proportions", clause="ANSI/AISC 360-16, D5.2")
        margins += [named.lacks(s, need) for need in proportions(x.eye, x.connection)]
        for state, clause, strength, dimension in _FORMS:
            bears = strength is bearing
            if other and not bears:
                continue
            capacity = partial(
                strength, yields=strengths.yields, ultimate=strengths.ultimate, design=s.aisc
            )
            named = replace(text, method=f"AISC {state}", clause=f"ANSI/AISC 360-16, {clause}")
            force = x.size if bears else x.axial  # a pin bears in whatever direction it pushes
            margins.append(eye_margin(named, s, x, force, capacity, dimension))
    return margins

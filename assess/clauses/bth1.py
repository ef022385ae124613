"""Pin-connected plates by ASME BTH-1, Design of Below-the-Hook Lifting Devices.

    tension on the net section      P_t = C_r F_u 2 t b_eff / (1.2 N_d)
    fracture in one plane           P_b = C_r F_u (1.13 (R - D_h/2) + 0.92 b_e / (1 + b_e/D_h)) t
                                          / (1.2 N_d)
    shear in two planes             P_v = 0.70 F_u A_v / (1.2 N_d)
    bearing of the pin              P_p = 1.25 F_y D_p t / N_d

    b_eff = min(b_e, 4 t, 0.6 b_e (F_u/F_y) sqrt(D_h/b_e))      R = a + D_h/2
    C_r = 1 - 0.275 sqrt(1 - (D_p/D_h)^2)      A_v = 2 (a + D_p/2 (1 - cos phi) - Z') t
    phi = 55 degrees D_p/D_h      Z' = r - sqrt(r^2 - (D_p sin(phi) / 2)^2), 0 for a straight end

The strengths are compared at the loads of the study (limit load): the safety is in N_d, which the
study states. C_r is applied to every pin, however closely it fits its hole, which is on the safe
side.

b_eff accounts for the limited efficiency of a wide net section: width beyond it carries no load.

Source: five spreadsheets after ASME BTH-1-2005, equations 3-45 to 3-51 and C3-2, which were not
themselves read (docs/evidence.md); D. Duerr, Pinned Connection Strength and
Behavior, J. Struct. Eng. 132(2), 2006, 182-194.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from assess.check import CheckText, check
from assess.clauses.eye import PlateEye, loaded_eyes
from assess.clauses.eye_margin import eye_margin, not_axial, strengths_of
from assess.margin import Margin
from assess.situation import Situation
from assess.work import Work, work

CLAUSE = "ASME BTH-1-2005, eq. 3-45 to 3-51"
FRACTURE_FACTOR = 1.2  # factor on N_d for limit states of fracture
SHEAR_PLANE_DEGREES = 55.0  # phi for a pin that fills its hole
MAX_WIDTH_OVER_THICKNESS = 4.0  # limit of b_eff / t, against dishing
DESIGN_FACTOR_KEY = "analysis.design_factor (N_d of ASME BTH-1)"
BTH1_OMITS = (
    "Not covered: forces across the plate, bushings of their own strength, buckling out of plane "
    "beyond the limit of 4 t, stiffened plates, fatigue, the pin. By spreadsheets "
    "after the standard, not read itself."
)


def pin_to_hole(eye: PlateEye) -> float:
    """Return C_r, which is less than 1 for a pin smaller than its hole."""
    return 1.0 - 0.275 * math.sqrt(max(1.0 - (eye.bearer / eye.hole) ** 2, 0.0))


def effective_width(eye: PlateEye, ultimate_over_yield: float) -> float:
    """Return b_eff, m, of the net section on each side of the hole."""
    b = eye.side
    wide = 0.6 * b * ultimate_over_yield * math.sqrt(eye.hole / b)
    return min(b, MAX_WIDTH_OVER_THICKNESS * eye.thickness, wide)


def tension_strength(eye: PlateEye, yields: float, ultimate: float, design_factor: float) -> Work:
    """Return P_t, N. yields, ultimate: F_y and F_u, Pa. design_factor: N_d."""
    C_r, b_eff = pin_to_hole(eye), effective_width(eye, ultimate / yields)
    value = C_r * ultimate * 2.0 * eye.thickness * b_eff / (FRACTURE_FACTOR * design_factor)
    return work(
        "P_t", value, "force", "{C_r} × {F_u} × 2 × {t} × {b_eff} / (1.2 × {N_d})",
        C_r=(C_r, "1"), F_u=(ultimate, "stress"), t=(eye.thickness, "length"),
        b_eff=(b_eff, "length"), N_d=(design_factor, "1"),
    )  # fmt: skip


def fracture_strength(eye: PlateEye, yields: float, ultimate: float, design_factor: float) -> Work:
    """Return P_b, N; arguments as `tension_strength`."""
    C_r, b = pin_to_hole(eye), eye.side
    length = 1.13 * (eye.e - eye.hole / 2.0) + 0.92 * b / (1.0 + b / eye.hole)
    value = C_r * ultimate * length * eye.thickness / (FRACTURE_FACTOR * design_factor)
    return work(
        "P_b", value, "force",
        "{C_r} × {F_u} × (1.13 × ({R} − {D_h} / 2) + 0.92 × {b_e} / (1 + {b_e} / {D_h})) × {t} / "
        "(1.2 × {N_d})",
        C_r=(C_r, "1"), F_u=(ultimate, "stress"), R=(eye.e, "length"), D_h=(eye.hole, "length"),
        b_e=(b, "length"), t=(eye.thickness, "length"), N_d=(design_factor, "1"),
    )  # fmt: skip


def shear_area(eye: PlateEye) -> float:
    """Return A_v, m^2, the area of both shear planes beyond the pin."""
    phi = math.radians(SHEAR_PLANE_DEGREES * eye.bearer / eye.hole)
    beyond = eye.a + eye.bearer / 2.0 * (1.0 - math.cos(phi))
    if not eye.square:
        beyond -= eye.e - math.sqrt(eye.e**2 - (eye.bearer * math.sin(phi) / 2.0) ** 2)
    return 2.0 * beyond * eye.thickness


def shear_strength(eye: PlateEye, yields: float, ultimate: float, design_factor: float) -> Work:
    """Return P_v, N; arguments as `tension_strength`."""
    A_v = shear_area(eye)
    value = 0.70 * ultimate * A_v / (FRACTURE_FACTOR * design_factor)
    return work(
        "P_v", value, "force", "0.70 × {F_u} × {A_v} / (1.2 × {N_d})",
        F_u=(ultimate, "stress"), A_v=(A_v, "length^2"), N_d=(design_factor, "1"),
    )  # fmt: skip


def bearing_strength(eye: PlateEye, yields: float, ultimate: float, design_factor: float) -> Work:
    """Return P_p, N; arguments as `tension_strength`."""
    value = 1.25 * yields * eye.bearer * eye.thickness / design_factor
    return work(
        "P_p", value, "force", "1.25 × {F_y} × {D_p} × {t} / {N_d}",
        F_y=(yields, "stress"), D_p=(eye.bearer, "length"), t=(eye.thickness, "length"),
        N_d=(design_factor, "1"),
    )  # fmt: skip


_of_plates = partial(check, kind="clause", takes="loads", dimension="force", omits=BTH1_OMITS)
Strength = Callable[[PlateEye, float, float, float], Work]  # arguments as `tension_strength`


@_of_plates("BTH-1 plate, tension", CLAUSE)
def bth1_tension(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of every plate in tension on the net section."""
    return _margins(text, s, tension_strength, "width")


@_of_plates("BTH-1 plate, single-plane fracture", CLAUSE)
def bth1_fracture(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of every plate in single-plane fracture beyond the pin."""
    return _margins(text, s, fracture_strength, "width")


@_of_plates("BTH-1 plate, double-plane shear", CLAUSE)
def bth1_shear(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of every plate in double-plane shear beyond the pin."""
    return _margins(text, s, shear_strength, "width")


@_of_plates("BTH-1 plate, bearing", CLAUSE)
def bth1_bearing(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of every plate in bearing of its pin."""
    return _margins(text, s, bearing_strength, "thickness")


def _margins(text: CheckText, s: Situation, strength: Strength, dimension: str) -> list[Margin]:
    N_d, margins = s.design_factor, list[Margin]()
    for x in loaded_eyes(s):
        strengths, bears = strengths_of(x.lug), strength is bearing_strength
        if not bears and (other := not_axial(text, s, x)):
            margins.append(other)
        elif strengths.missing or N_d is None:
            lacking = [DESIGN_FACTOR_KEY] if N_d is None else []
            margins.append(text.lacks(s, *lacking, *strengths.missing))
        else:

            def capacity(
                eye: PlateEye,
                fy: float = strengths.yields,
                fu: float = strengths.ultimate,
                N_d: float = N_d,
            ) -> Work:
                return strength(eye, fy, fu, N_d)

            force = x.size if bears else x.axial  # a pin bears in whatever direction it pushes
            margins.append(eye_margin(text, s, x, force, capacity, dimension))
    return margins

"""Lugs by Ekvall's efficiency factors, which tests confirm.

    across the shank   P = K_BR F_tu D t        K_BR = -0.463 + 0.580 W/D
    at the bore        sigma = K_tb F / (D t)   K_tb = 2.75 (W/D - 1)^-0.675

for straight lugs. The first formula is for symmetric lugs, the second for axial pull. The second is
the elastic peak stress; it is compared with yield for comparison only, because a lug yields locally
long before it fails. K_BR in other directions is a curve over K_tb that is printed only as a
figure, so there is no check of axial strength here.

Source: J. C. Ekvall, Static Strength Analysis of Pin-Loaded Lugs, J. Aircraft 23(5), 1986, 438-443.
"""

from __future__ import annotations

from functools import partial

from assess.check import CheckText, check
from assess.clauses.eye import LoadedEye, PlateEye, loaded_eyes, place_of
from assess.clauses.eye_margin import eye_margin
from assess.margin import Margin, for_comparison, strength_key
from assess.situation import Situation
from assess.work import Work, work

EKVALL = "Ekvall, J. Aircraft 23 (1986) 438"
BORE_EXPONENT = -0.675  # of W/D - 1 in the stress at the bore
TESTED_WIDTHS = 1.33, 4.5  # W/D of the tests
SYMMETRY_TOLERANCE = 0.01  # by which 2 e/W may differ from 1 for the factor of a symmetric lug
SCATTER = (
    "243 tests: test over prediction 1.003 in the mean, standard deviation 0.065; 90 % of tests "
    "exceed 0.910, 99 % 0.837 times the prediction (95 % confidence)"
)
EKVALL_OMITS = (
    "Not covered: localised bearing failure, eccentric heads, W/D outside 1.33 to 4.5; pins that "
    "bend plastically lower the strength by up to 14 %."
)


def transverse_efficiency(eye: PlateEye) -> float:
    """Return K_BR of a straight symmetric lug under a load across its shank."""
    return -0.463 + 0.580 * eye.width / eye.hole


def transverse_load(eye: PlateEye, ultimate: float) -> Work:
    """Return the ultimate load across the shank, N. ultimate: ultimate strength, Pa."""
    value = transverse_efficiency(eye) * ultimate * eye.hole * eye.thickness
    return work(
        "P", value, "force", "(−0.463 + 0.580 × {W} / {D}) × {F_tu} × {D} × {t}",
        W=(eye.width, "length"), D=(eye.hole, "length"), F_tu=(ultimate, "stress"),
        t=(eye.thickness, "length"),
    )  # fmt: skip


def bore_factor(eye: PlateEye) -> float:
    """Return K_tb of a straight lug pulled axially: the elastic stress at the bore over
    F / (D t).
    """
    return float(2.75 * (eye.width / eye.hole - 1.0) ** BORE_EXPONENT)


def bore_stress(eye: PlateEye, force: float) -> Work:
    """Return the largest elastic stress at the bore, Pa, under an axial force, N."""
    value = bore_factor(eye) * force / (eye.hole * eye.thickness)
    return work(
        "sigma", value, "stress", "2.75 × ({W} / {D} − 1)^-0.675 × {F} / ({D} × {t})",
        W=(eye.width, "length"), D=(eye.hole, "length"), F=(force, "force"),
        t=(eye.thickness, "length"),
    )  # fmt: skip


@check("Ekvall transverse", f"{EKVALL}, K_BR", kind="clause", takes="loads", level="ultimate",
       dimension="force", scatter=SCATTER, omits=EKVALL_OMITS)  # fmt: skip
def ekvall_transverse(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the force across the shank of every symmetric lug."""
    margins = []
    for x in loaded_eyes(s):
        if not x.transverse.any():
            continue
        fu, low_high = x.lug.ultimate_strength, TESTED_WIDTHS
        if not _tested(x) or abs(2.0 * x.eye.e / x.eye.width - 1.0) > SYMMETRY_TOLERANCE:
            where = f"a symmetric lug with W/D from {low_high[0]:g} to {low_high[1]:g}"
            margins.append(text.lacks(s, f"{where}, at {x.connection}"))
        elif fu is None:
            margins.append(text.lacks(s, strength_key(x.lug.name, "ultimate")))
        else:
            capacity = partial(transverse_load, ultimate=fu)
            margins.append(eye_margin(text, s, x, x.transverse, capacity, "width"))
    return margins


@check("lug, elastic stress at the bore", f"{EKVALL}, K_tb", kind="clause", takes="loads",
       omits="Not covered: forces across the shank, fits, bending of the pin.")  # fmt: skip
def ekvall_bore_stress(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins against yield of the elastic peak stress at the bore of every axially
    loaded lug, for comparison.
    """
    margins = []
    for x in loaded_eyes(s):
        fy, t = x.lug.yield_strength, int(x.axial.argmax())
        if fy is None or not _tested(x) or not x.axial.any() or x.transverse.any():
            continue
        stress, place = bore_stress(x.eye, float(x.axial[t])), place_of(s, x, t)
        margin = text.margin(s, stress.result.value, fy, place, x.lug.name, x.basis, (stress,))
        margins.append(for_comparison(margin))
    return margins


def _tested(x: LoadedEye) -> bool:
    low, high = TESTED_WIDTHS
    return low <= x.eye.width / x.eye.hole <= high

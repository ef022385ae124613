"""Lugs in their plane, with the stresses at their bores by fea.lug and by CalculiX.

    python -m tests.support.pins.plane_lugs

stores CalculiX's figures anew.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from fea.core.material import Material
from fea.lug.lug_load import LugLoad
from fea.lug.lug_stress import LugInPlane, stresses_of
from fea.lug.slipping import SlippingBushing
from fea.lug.through_thickness import EyeStress
from fea.support.lugs.lug import Bushing, Lug, Shank
from pinbase.arrays import Floats
from pinbase.memo import Memo
from tests.support.pins.plane_lug_ccx import SECTORS, BoreAnswer, PlaneEye, ccx_answer

STORED = Path(__file__).parents[2] / "validation" / "plane_lugs_ccx.csv"
HEADER = "eye", "direction_deg", "clearance_mm", "hoop_MPa", "angle_deg", "pressure_MPa", "hole_MPa"
STEEL = Material("steel", 210e9, 0.3, 7850.0)
BRONZE = Material("bronze", 110e9, 0.34, 8800.0)
FORCE = 2.5e6  # N/m: 125 MPa over the bore's diameter
PRESSED = 0.05  # of the largest pressure; above it a node counts as beneath the pin
TIGHT = 0.04  # mm of clearance, 0.2 % of the bore
_ROUND = PlaneEye("round", 0.01, 0.050, 0.050, 0.060, 0.025, FORCE, 0.0, STEEL, STEEL)
EYES = {
    "round 1.8": replace(_ROUND, head=0.036, width=0.036, end=0.018),
    "round 2.5": _ROUND,
    "square 2.5": replace(_ROUND, shape="square"),
    "tapered 2.5 to 4": replace(_ROUND, shape="tapered", width=0.080),
    "eccentric 2.5": replace(_ROUND, end=0.65 * 0.050),
    "bushed 2.5": replace(_ROUND, hole=0.013, bushing=BRONZE),
    "pressed 2.5": replace(_ROUND, hole=0.013, bushing=BRONZE, misfit=3e-5),
    "slipping 2.5": replace(_ROUND, hole=0.013, bushing=BRONZE, misfit=3e-5, slips=True),
    "opening 2.5": replace(_ROUND, hole=0.013, bushing=BRONZE, misfit=8e-6, slips=True),
}
SLIPPING_SECTORS = 96  # for CalculiX with two contacts, which takes minutes
Case = tuple[str, float, float]  # name of the eye, direction of the force, degrees, clearance, mm
CASES: list[Case] = [
    ("round 2.5", 0.0, 0.0),
    ("round 1.8", 0.0, 0.0),
    ("square 2.5", 0.0, TIGHT),
    ("tapered 2.5 to 4", 0.0, 0.0),
    ("eccentric 2.5", 0.0, 0.0),
    ("bushed 2.5", 0.0, 0.0),
    ("round 2.5", 0.0, TIGHT),
    ("round 2.5", 90.0, TIGHT),
    ("round 1.8", 45.0, TIGHT),
    ("tapered 2.5 to 4", 45.0, TIGHT),
    ("tapered 2.5 to 4", 90.0, 0.0),
    ("slipping 2.5", 0.0, 0.0),
]


@dataclass(frozen=True)
class BoreFigures:
    """The figures of a lug that are compared, Pa and degrees from the shank.

    hoop: largest at the bore outside the contact with the pin. angle: where that is. pressure:
    largest.
    hole: largest hoop stress of the lug about a bushing, NaN without one.
    """

    hoop: float
    angle: float
    pressure: float
    hole: float


def case_of(name: str, direction: float, clearance: float) -> PlaneEye:
    """Return the lug and its load of a case."""
    turn = math.radians(direction)
    return replace(EYES[name], direction=turn, clearance=1e-3 * clearance)


def figures_of_ccx(answer: BoreAnswer) -> BoreFigures:
    """Return the figures from CalculiX's results.

    At the end of contact the hoop stress has a cusp, which is some percent above the values at the
    nodes. The sum of hoop stress and pressure has no cusp there, and the square of the pressure
    goes smoothly to zero. The end of contact is found by extrapolation of this square, and the sum
    there by interpolation, both from nodes that are not next to it.
    """
    M = len(answer.hoop)
    pressed = answer.pressure > PRESSED * answer.pressure.max()
    free = ~(pressed | np.roll(pressed, 1) | np.roll(pressed, -1))
    at = np.flatnonzero(free)
    candidates = [(float(answer.hoop[k]), float(k)) for k in at]
    for step in (1, -1):
        for first in np.flatnonzero(pressed & ~np.roll(pressed, step)):
            inside = answer.pressure[(first + step * np.arange(1, 4)) % M] ** 2
            curve = np.polynomial.Polynomial.fit([1.0, 2.0, 3.0], inside, 2).roots()
            end = float(min(curve.real, key=abs))
            near = np.array([-5, -4, -3, -2, 1, 2, 3, 4])
            both = (answer.hoop + answer.pressure)[(first + step * near) % M]
            smooth = np.polynomial.Polynomial.fit(near, both, 4)
            candidates.append((float(smooth(end)), first + step * end))
    hoop, k = max(candidates)
    return BoreFigures(
        hoop,
        360.0 * k / M % 360.0,
        float(answer.pressure.max()),
        float(answer.hole.max()) if len(answer.hole) else math.nan,
    )


def figures_of_ours(eye: PlaneEye) -> BoreFigures:
    """Return the figures of fea.lug under a pressure that is even through the thickness."""
    make, force = partial(_plane, eye, Memo()), -eye.force * _direction(eye)
    plane = make(around=96)
    if isinstance(plane, SlippingBushing):
        pressure = plane.pressures(force).bore
    else:
        pressure = plane.contact.pressures(force)
    first = np.zeros((2, 1, 1, 2))
    first[1, 0] = force / (math.pi * eye.radius)
    none = EyeStress(np.zeros((2, 1, 1)), np.zeros((2, 1, 1)))
    walls = stresses_of(make, none, LugLoad(force, first, np.ones(1), np.zeros(1)))
    free = next(x for x in walls if x.wall != "hole" and x.place == "free")
    hole = next((x.hoop for x in walls if x.wall == "hole"), math.nan)
    return BoreFigures(free.hoop, math.degrees(free.angle), float(pressure.max()), hole)


def _direction(eye: PlaneEye) -> Floats:
    return np.array([[math.cos(eye.direction), math.sin(eye.direction)]])


def lug_of(eye: PlaneEye) -> Lug:
    """Return the lug in the program's terms."""
    shank = Shank(eye.shape, eye.width, eye.length, eye.end)
    thickness = eye.hole - eye.radius
    bushing = Bushing(thickness, eye.bushing, eye.misfit) if eye.bushing else None
    return Lug("A", eye.head, eye.lug, eye.clearance, bushing=bushing, shank=shank)


def _plane(eye: PlaneEye, memo: Memo, around: int) -> LugInPlane | SlippingBushing:
    kind = SlippingBushing if eye.slips else LugInPlane
    return kind(lug_of(eye), eye.pin, 0.0, eye.radius, around=around, memo=memo)


def stored() -> dict[Case, BoreFigures]:
    """Return CalculiX's stored figures of all cases."""
    with STORED.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))[1:]
    out = {}
    for name, direction, clearance, hoop, angle, pressure, hole in rows:
        stresses = (1e6 * float(x or "nan") for x in (hoop, pressure, hole))
        largest, pressed, outside = stresses
        figures = BoreFigures(largest, float(angle), pressed, outside)
        out[(name, float(direction), float(clearance))] = figures
    return out


def store() -> None:
    """Run CalculiX on all cases and store its figures."""
    with STORED.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        for case in CASES:
            eye = case_of(*case)
            sectors = SLIPPING_SECTORS if eye.slips else SECTORS
            writer.writerow([*case, *_written(figures_of_ccx(ccx_answer(eye, sectors)))])
            file.flush()


def _written(figures: BoreFigures) -> list[str]:
    hoop, pressure, hole = (
        "" if math.isnan(x) else f"{1e-6 * x:.2f}"
        for x in (figures.hoop, figures.pressure, figures.hole)
    )
    return [hoop, f"{figures.angle:.2f}", pressure, hole]


if __name__ == "__main__":
    store()

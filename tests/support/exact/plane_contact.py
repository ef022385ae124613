"""Plane contacts with exact solutions: a disc in a hole of a plate, and a roller on a block."""

from __future__ import annotations

import csv
import math

import numpy as np

from fea.core.pin_loads import Floats
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from tests.conftest import ROOT

NU = 0.3
E_STAR = 1.0 / (1.0 - NU * NU)
ROLLER_LOAD, ROLLER_SECTORS, ROLLER_PIN = 35e3, 1440, 150.0  # N/mm; mm


def _persson() -> dict[float, tuple[float, float]]:
    path = ROOT / "studies" / "evidence" / "persson.csv"
    with path.open(encoding="utf-8", newline="") as file:
        return {
            float(row["gap"]): (float(row["half_angle_deg"]), float(row["peak"]))
            for row in csv.DictReader(file)
        }


# E* dR / Q: half angle of contact (deg) and p0 R / Q of a disc in a hole of an infinite plate of
# the same material, from E* dR / Q = [2 - ln(b^2 + 1) - 2 b^4] / (pi b^2 (b^2 + 1)) with
# b = tan(eps / 2): Persson 1964; Ciavarella & Decuzzi 2001.
PERSSON = _persson()


def disc_and_plate(highest: int) -> Floats:
    """Return the compliances (N + 1, 1, 1) under p cos n theta, for R = E = 1 in plane strain, by
    Muskhelishvili.

    Those of the disc are [k / (n + 1) + 1 / (n - 1)] / (4 mu), those of the hole the same with n +
    1 and n - 1 exchanged. n = 1 is left zero: it only shifts the disc, which is free to move.
    """
    mu, k = 0.5 / (1.0 + NU), 3.0 - 4.0 * NU
    out = np.zeros((highest + 1, 1, 1))
    out[0] = ((k - 1.0) + 2.0) / (4.0 * mu)
    for n in range(2, highest + 1):
        out[n] = (k + 1.0) * (1.0 / (n + 1.0) + 1.0 / (n - 1.0)) / (4.0 * mu)
    return out


def plane(
    clearance: float, sectors: int = 96, highest: int = 6, tail: float = 1.0
) -> ContactProblem:
    """Return the contact of a disc in a plate, of unit radius and thickness, with a radial
    clearance.
    """
    bands = Bands(np.zeros(1), np.ones(1), np.ones(1), np.zeros(1, int), np.array([clearance]))
    both = np.array([tail * 4.0 * (1.0 - NU * NU)])
    return ContactProblem(bands, disc_and_plate(highest), both, [math.inf], sectors)


def roller() -> tuple[float, float]:
    """Return the peak pressure, MPa, and the half width of contact, mm, of a cylinder of R = 50 mm
    on a plane of a third of its modulus.

    A pin of R = 150 mm with three times as much clearance has the same gap as the cylinder; that
    the shift enters the gap with the cosine of the angle changes the result by 0.2 %.

    Source: NAFEMS R0094, test 1: 35 kN/mm, 210 on 70 GPa, nu = 0.3.
    """
    weak = 1.0 / ((1.0 - NU * NU) * (1.0 / 210e3 + 1.0 / 70e3))
    pin, clearance = np.array([ROLLER_PIN]), np.array([450.0])
    bands = Bands(np.zeros(1), np.ones(1), pin, np.zeros(1, int), clearance)
    contact = ContactProblem(
        bands, np.zeros((2, 1, 1)), 2.0 * pin / weak, [math.inf], ROLLER_SECTORS
    )
    pressure = contact.solve(np.array([[-ROLLER_LOAD, 0.0]])).pressure
    width = np.count_nonzero(pressure) * math.pi / ROLLER_SECTORS * ROLLER_PIN
    return float(pressure.max()), float(width)

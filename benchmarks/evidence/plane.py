"""Plane problems with exact solutions, for which there are no studies, solved by the functions for
contact of pins and for stress of lugs.
"""

from __future__ import annotations

import numpy as np

from benchmarks.evidence.comparison import Printed, printed_numbers, records
from fea.lug.plane_fields import Elasticity, plane_fields
from geometry.shape.lug_outline import LugOutline
from tests.support.exact.plane_contact import E_STAR, plane, roller

SECTORS, HARMONICS = 384, 16
CELL_DEGREES = 180.0 / SECTORS  # half of a cell


def plane_predictions() -> dict[Printed, float]:
    """Return the predictions for the exact solutions."""
    peak, width = roller()
    values = {("hertz", "peak"): peak, ("hertz", "half width"): width}
    values |= {("press_fit", name): value for name, value in _press_fit().items()}
    out = {p: values[p.source, p.read] for p in printed_numbers() if (p.source, p.read) in values}
    return out | _persson()


def _persson() -> dict[Printed, float]:
    """Return the predictions for a pin in a plate, at every gap of persson.csv: peak pressure and
    half angle of contact.
    """
    out = {}
    for row in records("persson.csv"):
        contact = plane(float(row["gap"]) / E_STAR, SECTORS, HARMONICS)
        pressure = contact.solve(np.array([[-1.0, 0.0]])).pressure
        angle = CELL_DEGREES * np.count_nonzero(pressure)
        for name, column, unit, value, resolution in (
            ("peak pressure p0 R / Q", "peak", "1", pressure.max(), 0.0),
            ("half angle of contact", "half_angle_deg", "°", angle, 2.0 * CELL_DEGREES),
        ):
            quantity = f"{name}, E* dR / Q = {row['gap']}"
            printed = Printed(
                "persson", "", quantity, "", "", column, 1.0, row[column], unit,
                resolution=resolution,
            )  # fmt: skip
            out[printed] = float(value)
    return out


def _press_fit() -> dict[str, float]:
    """Return pressure and hoop stresses, psi, of a bushing pressed into a ring.

    Moduli 10.3e6 and 16.0e6 psi, nu 0.33, radii 0.1875, 0.25 and 0.75 in, interference 0.001 in on
    the diameter.
    """
    outline = LugOutline("ring", 0.375, 1.5, interface=0.5)
    fields = plane_fields(outline, Elasticity(0.33, 16.0 / 10.3, 0.33))
    stress = 0.001 / 0.5 * 10.3e6
    assert fields.hole is not None
    return {
        "pressure": -stress * float(fields.hole.radial[-1].mean()),
        "hoop": stress * float(fields.hole.hoop[-1].mean()),
        "bushing": stress * float(fields.bore.hoop[-1].mean()),
    }

"""Peak of pressure at the rounded edges of lugs: estimated from the pressure beside it, and
resolved by rings of a few thousandths of the radius.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

from benchmarks.joints.joint import COARSE, EYE, STEEL, USUAL, D, _model, _pull
from benchmarks.timing import table
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.joint.edge_peak import contact_edges
from fea.joint.lugs.lug import Lug
from fea.joint.solve_joint import JointContact

RESOLVED = replace(USUAL, beside=0.004)
ALUMINIUM = Material("aluminium", 70e9, 0.33)
# Inner, outer lugs and gap, mm; radius of the edges, of the diameter; clearance, mm; lugs of; load,
# of the usual one.
TRIED: tuple[tuple[tuple[float, float, float], float, float, Material, float], ...] = (
    ((20, 10, 1), 0.01, 0.0, STEEL, 1.0),
    ((20, 10, 1), 0.05, 0.0, STEEL, 1.0),
    ((20, 10, 1), 0.02, 0.0, STEEL, 0.1),
    ((20, 10, 1), 0.02, 0.05, STEEL, 1.0),
    ((20, 10, 1), 0.02, 0.0, ALUMINIUM, 1.0),
    ((40, 20, 2), 0.025, 0.0, STEEL, 1.0),
    ((10, 5, 0.5), 0.02, 0.02, ALUMINIUM, 1.0),
)
BANDS = ("outer", 0), ("inner", 1)


def edge_peak() -> str:
    """A row for each kind of lug of a clevis."""
    rows = []
    for (inner, outer, gap), radius, clearance, lugs, part in TRIED:
        lug = Lug("all", EYE, lugs, clearance / 1e3, edge_radius=radius * D)
        loads = _part(part)
        found = [
            _model(inner, outer, gap, lug, cells).solve(loads)
            for cells in (RESOLVED, USUAL, COARSE)
        ]
        for (name, band), about in product(BANDS, (f"{inner:g} / {outer:g}+{outer:g}",)):
            truth = found[0].largest_pressure[0, band]
            seen = found[1].largest_pressure[0, band] / truth
            numbers = [100.0 * (_estimated(c, band) / truth - 1.0) for c in found[1:]]
            what = (about, name, f"{radius:g}", f"{clearance:g}", lugs.name, f"{part:g}")
            off = [f"{number:+.0f}" for number in numbers]
            rows.append((*what, f"{truth / 1e6:.0f}", f"{seen:.2f}", *off))
    head = ("lugs [mm]", "lug", "edge radius / d", "clearance [mm]", "lugs of", "load / 50 kN")
    more = (
        "resolved [MPa]",
        "of it on the usual cells",
        "estimate off [%]",
        "on larger cells [%]",
    )
    return table((*head, *more), rows)


def _part(part: float) -> PinLoads:
    loads = _pull(np.zeros(1))
    return replace(loads, forces=part * loads.forces)


def _estimated(contact: JointContact, band: int) -> float:
    """The largest peak at either edge of a band, Pa."""
    edges = contact_edges(contact, STEEL)
    peaks = [e.max_pressure for e in edges if e.band == contact.lugs[band].connection]
    return max(x for x in peaks if x is not None)

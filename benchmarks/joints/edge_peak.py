"""The peak of pressure at the rounded edges of lugs, estimated from the pressure next to it.

Shrink fits are compared with finite elements of lugs whose edges are rounded, clevises with rings
of a few thousandths of the radius.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

from benchmarks.joints.joint import COARSE, EYE, STEEL, USUAL, D, model, pull
from benchmarks.joints.rounded_edge import ShrinkFit, edge_stress
from benchmarks.timing import table
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.contact.edge_peak import contact_edges
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment

ALUMINIUM = Material("aluminium", 70e9, 0.33)
# Shrink fits: radius of the edges and length over the diameter; elements over the radius.
FITS = tuple(product((STEEL, ALUMINIUM), (0.01, 0.02, 0.05), (0.5, 1.0, 2.0)))
INTERFERENCE, ELEMENT = 1e-3, 1.0 / 600.0
ALIKE = (
    Resolution(8, 6, 0),
    Resolution(4, 6, 0),
    Resolution(8, 6, 0, beside=1.0 / 300.0),
)  # axisymmetric
RESOLVED = Resolution(8, 24, 8, beside=1.0 / 200.0)
# Inner lug, outer lugs and gap, mm; radius of the edges over the diameter; clearance, mm; material
# of the lugs; load over the usual one.
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
    """Return the two tables."""
    return f"{_fits()}\n\n{_clevises()}"


def _fits() -> str:
    rows = []
    for material, radius, length in FITS:
        fit = shrink_fit(radius, length)
        truth = edge_stress(fit, STEEL, material, ELEMENT)
        usual, larger, resolved = (shrunk(fit, material, cells) for cells in ALIKE)
        numbers = (_estimated(usual, 0), _estimated(larger, 0), resolved.largest_pressure[0, 0])
        off = [f"{100.0 * (x / truth.pressure - 1.0):+.1f}" for x in numbers]
        about = material.name, f"{radius:g}", f"{length:g}"
        rows.append((*about, f"{truth.pressure / 1e6:.0f}", *off))
    head = ("lug of", "edge radius / d", "length / d", "by finite elements [MPa]")
    return table((*head, "estimate off [%]", "on larger cells [%]", "resolved rings [%]"), rows)


def shrink_fit(radius: float, length: float) -> ShrinkFit:
    """Return the shrink fit of a pin; radius of the edges and length of the lug in diameters."""
    return ShrinkFit(D, length * D, radius * D, EYE, INTERFERENCE * D, D)


def shrunk(fit: ShrinkFit, material: Material, cells: Resolution) -> JointContact:
    """Return the same fit solved by rings. material: of the lug."""
    over = Segment(fit.over, fit.diameter)
    pin = Pin("P", (over, Segment(fit.length, fit.diameter, connection="M"), over))
    lug = Lug("M", fit.outer, material, -fit.interference, edge_radius=fit.radius)
    return ContactModel(pin, STEEL, [lug], cells).solve(
        PinLoads("fit", ("M",), np.zeros((1, 1, 3)))
    )


def _clevises() -> str:
    """Return the table with a row for each kind of lug of a clevis."""
    rows = []
    for (inner, outer, gap), radius, clearance, lugs, part in TRIED:
        lug = Lug("all", EYE, lugs, clearance / 1e3, edge_radius=radius * D)
        loads = _part(part)
        found = [
            model(inner, outer, gap, lug, cells).solve(loads) for cells in (RESOLVED, USUAL, COARSE)
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
    loads = pull(np.zeros(1))
    return replace(loads, forces=part * loads.forces)


def _estimated(contact: JointContact, band: int) -> float:
    """Return the largest estimated peak at either edge of a band, Pa."""
    edges = contact_edges(contact, STEEL)
    peaks = [e.max_pressure for e in edges if e.band == contact.lugs[band].connection]
    return max(x for x in peaks if x is not None)

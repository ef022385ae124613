"""Stress of a pin in loose lugs under smaller and smaller loads, on narrower and narrower
arcs: how far off the usual cells are, and what they say of it.
"""

from __future__ import annotations

from dataclasses import replace

from benchmarks.joints.named_pins import clevis
from benchmarks.timing import table
from fea.core.requirement import Requirement
from fea.support.contact.held import RESOLUTIONS, ROUGH, profile_of
from fea.support.contact.solve_joint import ContactModel, Resolution
from fea.support.contact.variations import ResolutionComparison, compare, nowhere

CLEARANCE = 5e-5  # m, of the diameters
LOADS = 1.0, 0.3, 0.1, 0.03, 0.01  # of the clevis's
TRUTH = Resolution(8, 144, 48)
TRIED = (ROUGH, *RESOLUTIONS)


def narrow_arcs() -> str:
    """A table of a clevis 20 / 10+10 mm, gap 1, on a pin of 20 mm with 0.05 mm of clearance."""
    stress = {cells: _solved(cells) for cells in (TRUTH, *TRIED)}
    rows = []
    for k, load in enumerate(LOADS):
        truth = stress[TRUTH][k].stress.surface
        half = stress[TRUTH][k].half_angle
        told = []
        for cells in TRIED:
            known = stress[cells][k]
            off, error = truth / known.stress.surface - 1.0, known.cells.surface
            told.append(f"{100.0 * off:+.0f} ({100.0 * error:.0f})")
        rows.append((f"{50.0 * load:g}", f"{57.3 * half:.0f}", f"{truth / load / 1e6:.0f}", *told))
    sizes = (f"{x.rings} x {x.sectors} [%]" for x in TRIED)
    return table(("load [kN]", "half angle [deg]", "surface / load [MPa / 50 kN]", *sizes), rows)


def _solved(cells: Resolution) -> list[ResolutionComparison]:
    given = clevis()
    lugs = tuple(replace(lug, clearance=CLEARANCE) for lug in given.lugs)
    model = ContactModel(profile_of(given.pin), given.material, lugs, cells)
    (case,) = given.cases
    pulls = (model.solve(replace(case, forces=load * case.forces)) for load in LOADS)
    return [compare(model, [x], Requirement(), vary=nowhere)[0] for x in pulls]

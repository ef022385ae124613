"""The stress of a pin in loose lugs under ever smaller loads, on ever narrower arcs of contact: the
error on the usual cells, and its estimate.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

from benchmarks.joints.named_pins import clevis
from benchmarks.timing import table
from fea.core.requirement import Requirement
from fea.support.contact.contact_support import profile_of
from fea.support.contact.resolution import RESOLUTIONS, ROUGH, Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.contact.variations import ResolutionComparison, compare, nowhere
from fea.support.lugs.lug import Lug

CLEARANCE = 5e-5  # m, difference of the diameters
EDGE_RADIUS = 1e-3  # m
# Which lugs (outer, inner, outer) are loose, and the radius of all edges.
JOINTS = {
    "all": ((1, 1, 1), 0.0),
    "inner": ((0, 1, 0), 0.0),
    "outer": ((1, 0, 1), 0.0),
    "inner, round edges": ((0, 1, 0), EDGE_RADIUS),
}
LOADS = 1.0, 0.3, 0.1, 0.03, 0.01  # over that of the clevis
TRUTH = Resolution(8, 180, 90)
TRIED = (ROUGH, *RESOLUTIONS)
Place = Literal["surface", "beneath"]


def narrow_arcs() -> str:
    """Return the two tables, of the surface and of the stress beneath contact.

    The clevis has lugs of 20 / 10+10 mm, a gap of 1 mm, a pin of 20 mm and a clearance of 0.05 mm.
    """
    rows: dict[Place, list[tuple[str, ...]]] = {"surface": [], "beneath": []}
    for name, (loose, edge) in JOINTS.items():
        given = clevis().lugs
        lugs = tuple(
            replace(lug, clearance=CLEARANCE * x, edge_radius=edge)
            for lug, x in zip(given, loose, strict=True)
        )
        stress = {cells: _solved(lugs, cells) for cells in (TRUTH, *TRIED)}
        for place, of_place in rows.items():
            of_place += _rows(name, stress, place)
    sizes = (f"{x.rings} x {x.sectors} [%]" for x in TRIED)
    head = "loose lugs", "load [kN]", "half angle [deg]"
    per_load = "stress / load [MPa / 50 kN]", *sizes
    return "\n\n".join(
        f"{place.capitalize()}:\n\n{table((*head, *per_load), x)}" for place, x in rows.items()
    )


def _rows(
    name: str, stress: dict[Resolution, list[ResolutionComparison]], place: Place
) -> Iterator[tuple[str, ...]]:
    for k, load in enumerate(LOADS):
        truth = getattr(stress[TRUTH][k].stress, place)
        half = stress[TRUTH][k].half_angle
        told = []
        for cells in TRIED:
            known = stress[cells][k]
            off, error = truth / getattr(known.stress, place) - 1.0, getattr(known.cells, place)
            told.append(f"{100.0 * off:+.0f} ({100.0 * error:.0f})")
        yield (name, f"{50.0 * load:g}", f"{57.3 * half:.0f}", f"{truth / load / 1e6:.0f}", *told)


def _solved(lugs: tuple[Lug, ...], cells: Resolution) -> list[ResolutionComparison]:
    given = clevis()
    model = ContactModel(profile_of(given.pin), given.material, lugs, cells)
    (case,) = given.cases
    pulls = (model.solve(replace(case, forces=load * case.forces)) for load in LOADS)
    return [compare(model, [x], Requirement(), vary=nowhere)[0] for x in pulls]

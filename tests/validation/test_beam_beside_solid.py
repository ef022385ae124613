"""The beam's largest stress and its error beside 120 solid models, stubby and slender.

beam_beside_solid.csv: `segments_mm` length x diameter x bore and the surface's name if it has one,
`loads_N_Nm` force and moment on each band, `solid_MPa` the solid's largest von Mises stress further
than 0.1 diameters from edges of clamps, on one mesh (MeshSize(4, arc=2.5)): finer ones moved six of
them by up to 7 %.
The numbers of fea.beam.error_model were chosen on the set "fit"; the set "fresh" was made later.

No publication, but the reference is outside of what is tested. The error must hold the solid in all
pins, which is what an error is for; how good beams are of each kind is the table of docs/method.md,
rounded up; a solid solved again gives the file's number to 3 %, what gmsh's versions differ by.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fea.beam.error_model import BeamEstimate, beam_estimate
from fea.beam.line_load import acting
from fea.beam.stress import beam_stress
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from fea.singular.singularities import clamp_rims
from fea.solid.model import SolidModel
from fea.solid.model import acting as acting_on_solid
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.each import each, sampled

STEEL = Material("steel", 2.0e11, 0.3, 7850.0, 1.0e9)
SAME_MESH = 0.03
NEAR = 0.1  # of the diameter


@dataclass(frozen=True)
class Row:
    chosen_on: bool
    kind: str
    pin: Pin
    clamps: tuple[str, ...]
    loads: PinLoads
    solid: float


def _segment(text: str) -> Segment:
    length, _, diameter, _, bore, *name = text.split()
    size = float(length) / 1e3, float(diameter) / 1e3, float(bore) / 1e3
    if name and name[0].startswith("c"):
        return Segment(*size, name=name[0])
    return Segment(*size, connection=name[0] if name else None)


@cache
def rows() -> tuple[Row, ...]:
    out = []
    with (Path(__file__).parent / "beam_beside_solid.csv").open() as file:
        for r in csv.DictReader(file):
            segments = tuple(_segment(s) for s in r["segments_mm"].split(";"))
            loads = [x.split() for x in r["loads_N_Nm"].split(";")]
            values = np.array([[float(v) for v in x[1:]] for x in loads])
            names = tuple(x[0] for x in loads)
            case = PinLoads("case", names, values[None, :, :3], values[None, :, 3:])
            clamps = tuple(r["clamps"].split(";")) if r["clamps"] else ()
            pin = Pin("P", segments, float(r["fillet_mm"]) / 1e3)
            solid = 1e6 * float(r["solid_MPa"])
            out.append(Row(r["set"] == "fit", r["kind"], pin, clamps, case, solid))
    return tuple(out)


def estimate(row: Row) -> BeamEstimate:
    beam = beam_stress(row.pin, STEEL, acting(row.loads), row.clamps)
    return beam_estimate(beam, row.loads, row.clamps)


def off(row: Row) -> float:
    """By how much the solid is off, in errors of the beam."""
    found = estimate(row)
    assert found.error is not None
    return abs(row.solid - found.maximum) / found.error


@pytest.mark.parametrize("chosen_on", [True, False])
def test_the_error_holds_the_solid(chosen_on: bool) -> None:
    """All of 60 pins; were the error generous beyond need, none would come near it."""
    parts = [off(row) for row in rows() if row.chosen_on is chosen_on]
    assert len(parts) == 60
    assert max(parts) < 1.0
    assert max(parts) > 0.5


KINDS = {  # largest deviation from the solid, and largest median of the error, as parts of the beam
    "shoulder cantilever": (0.16, 0.3),
    "double shear": (0.06, 0.25),
    "thick middle": (0.25, 0.35),
    "cantilever or tube": (0.40, 0.45),
    "collars": (0.85, 1.1),
}


@each("kind", KINDS)
def test_how_good_beams_are(kind: str) -> None:
    """What docs/method.md says."""
    deviation, error = KINDS[kind]
    here = [(row, estimate(row)) for row in rows() if row.kind == kind]
    assert len(here) == 24
    assert max(abs(row.solid / e.maximum - 1.0) for row, e in here) < deviation
    assert np.median([(e.error or 0.0) / e.maximum for _, e in here]) < error


@pytest.mark.slow
@pytest.mark.parametrize("i", sampled([3, 21, 46, 60], every=4))
def test_the_solid_gives_what_the_file_says(i: int) -> None:
    """The same mesh again, but gmsh's differ a little between versions: 3 %."""
    row = rows()[i]
    loads = row.loads
    held = tuple(row.pin.surface(name) for name in row.clamps)
    rims = clamp_rims(row.pin, held)
    edges = [z for n in loads.surfaces for z in (row.pin.band(n).z0, row.pin.band(n).z1)]
    edges = list(dict.fromkeys([*edges, *(z for _, z in rims)]))
    mesh = solid_mesh(row.pin, MeshSize(across=4.0, arc=2.5), tuple(edges))
    fields = SolidModel(row.pin, mesh, STEEL, held).solve(acting_on_solid([loads]))
    nodes = fields.surface.nodes
    stress = von_mises(fields.stress[nodes] @ fields.coefficients(loads)[0])
    x = fields.space.nodes[nodes]
    for r, z in rims:
        near = np.hypot(np.hypot(x[:, 0], x[:, 1]) - r, x[:, 2] - z) <= NEAR * 2.0 * r
        stress[near] = 0.0
    assert stress.max() == pytest.approx(row.solid, rel=SAME_MESH)

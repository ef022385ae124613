"""A clevis whose ears also push apart the heads of its pin, beside contact in three dimensions.

axial_ccx.csv has what CalculiX finds by tests.support.pins.axial_ccx.opinion(pull, fineness) with
Fineness(rings=6, sectors=24, layers=3, eye=2), 64,434 unknowns, in 6 to 9 minutes: the largest
bending moment (N m) along the pin, and von Mises stress (MPa) at our largest on the tension side of
the middle and in the fillet beneath a head. Tolerance: 3 %, of which 2 % is for its mesh (with
36,174 unknowns 234.9 N m, 407.8 and 474.4 MPa under the pull).
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from assess.opinion.calculix_joint_mesh import Fineness
from fea.core.requirement import Requirement
from fea.harmonic.field import HarmonicField
from fea.harmonic.superposition import Circumference
from fea.solve.solve import solve_pin
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from tests.support.each import each
from tests.support.pins.axial_ccx import FILLET, HEAD, PIN, PULL, STEEL, D, deck_of, problem

TOLERANCE = 0.03
with (Path(__file__).parent / "axial_ccx.csv").open(encoding="utf-8", newline="") as table:
    TRUTH = {float(row["pull"]): row for row in csv.DictReader(table)}


@pytest.mark.slow
@each("pull", [*TRUTH])
def test_contact_in_three_dimensions(pull: float) -> None:
    lugs, loads = problem(pull)
    found = ContactModel(PIN, STEEL, lugs, Resolution(12, 48, 16)).solve(loads)
    along = np.linspace(0.0, PIN.length, 401)
    moment = np.linalg.norm(found.bending_moment(along)[0], axis=1).max()
    (solution,) = solve_pin(
        found.pin, STEEL, (), (found.loads,), Requirement(model="harmonic", tolerance=0.02)
    )
    assert isinstance(solution.answer, HarmonicField)
    fields = solution.answer.fields
    r, z = fields.points[:, :2].T
    corner = PIN.stations[1]
    regions = {
        "middle": np.abs(z - PIN.band("M").middle) < 0.003,
        "fillet": (z > corner - 1e-9) & (z < corner + FILLET) & (r > 0.99 * D / 2),
    }
    truth = TRUTH[pull]
    assert moment == pytest.approx(float(truth["bending_moment"]), rel=TOLERANCE)
    for what, region in regions.items():
        if truth[what]:  # without a pull the fillet is loaded by little else than bending
            stress = Circumference(fields, found.loads).top(region).value
            assert stress == pytest.approx(1e6 * float(truth[what]), rel=TOLERANCE), what


def test_the_deck_presses_both_heads_apart() -> None:
    """Its pressures times the areas of their faces, of the half that is modelled, are the pull."""
    fineness = Fineness(rings=2, sectors=16, layers=2, eye=1, scale=1.0)
    lugs, loads = problem(PULL)
    deck, _ = deck_of(lugs, loads, fineness)
    assert deck.half
    mesh = deck.pin.mesh
    for elements, face, pressure in deck.pressed:
        corners = mesh.nodes[
            mesh.elements[elements][:, [0, 1, 2, 3] if face == 1 else [4, 5, 6, 7]]
        ]
        assert np.ptp(corners[..., 2]) < 1e-12  # a plane face
        x, y = corners[..., 0], corners[..., 1]
        area = 0.5 * np.abs(np.sum(x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1), axis=1)).sum()
        # Chords instead of arcs: sin(2 a) / 2 a of a sector of 22.5 degrees is 0.974.
        assert pressure * area == pytest.approx(PULL / 2.0, rel=0.03)
        assert np.hypot(x, y).max() == pytest.approx(HEAD / 2.0)
    text = "\n".join(deck.lines())
    assert text.index("*DLOAD") < text.index("*CLOAD")

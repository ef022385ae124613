"""Links that state moments across the axis, beside contact in three dimensions by CalculiX.

moments_ccx.csv has the largest bending moment (N m) along the pin, and the largest von Mises stress
of its sections (MPa), by the forces of CalculiX's rings: steel, d = 20 mm, 50 kN, eyes of 50 mm
free to tilt under their stated moments, else on the spring of a shank 40 mm long; the deck of
assess.opinion.calculix_joint.joint_deck with Fineness(rings=6, sectors=24, layers=3, eye=2), 20,000
to 29,000 unknowns. Tolerance: 1.5 %, of which 1 % is for CalculiX's mesh.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from assess.opinion.calculix_in_lugs import PinInLugs, transverse
from assess.opinion.calculix_joint import joint_deck
from assess.opinion.calculix_joint_mesh import Fineness
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.section.section_stress import SectionField
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.foundation.foundation_model import PLAIN_MOMENT_ERROR, FoundationModel
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from tests.support.each import each
from tests.support.pins.clevis import CLEVIS_PIN

TABLE = Path(__file__).parent / "moments_ccx.csv"
STEEL, D, FORCE = Material("steel", 210e9, 0.3), 0.02, 50e3
CLEVIS = CLEVIS_PIN
SHEAR = Pin(
    "S",
    (
        Segment(0.002, D),
        Segment(0.020, D, connection="A"),
        Segment(0.002, D),
        Segment(0.020, D, connection="B"),
        Segment(0.002, D),
    ),
)
# Pin, clearance, forces along x (N) and moments about y (N m) by lug.
JOINTS = {
    "tilted": (CLEVIS, 0.0, (-FORCE / 2, FORCE, -FORCE / 2), (0.0, 150.0, 0.0)),
    "loose": (CLEVIS, 2e-5, (-FORCE / 2, FORCE, -FORCE / 2), (0.0, 150.0, 0.0)),
    "single": (SHEAR, 0.0, (FORCE / 2, -FORCE / 2), (0.0, 550.0)),
    "couple": (SHEAR, 0.0, (0.0, 0.0), (400.0, -400.0)),
}


def joint(name: str) -> tuple[Pin, tuple[Lug, ...], PinLoads]:
    pin, clearance, along, about = JOINTS[name]
    forces, moments = np.zeros((2, 1, len(along), 3))
    forces[0, :, 0], moments[0, :, 1] = along, about
    lugs = tuple(
        Lug(c, 0.05, STEEL, clearance, tilt=210e9 * 0.05 * pin.band(c).length ** 3 / (12 * 0.04))
        for c in pin.connections
    )
    return pin, lugs, PinLoads(name, pin.connections, forces, moments)


def truth(name: str) -> tuple[float, float]:
    with TABLE.open(encoding="utf-8", newline="") as file:
        (row,) = (row for row in csv.DictReader(file) if row["case"] == name)
    return float(row["bending_moment"]), float(row["section"])


@pytest.mark.slow
@each("name", [*JOINTS])
def test_contact_in_three_dimensions(name: str) -> None:
    pin, lugs, loads = joint(name)
    model = ContactModel(pin, STEEL, lugs, Resolution(12, 48, 16))
    contact = model.solve(loads)
    z = np.linspace(0.0, pin.length, 401)
    moment, section = truth(name)
    assert np.linalg.norm(contact.bending_moment(z)[0], axis=1).max() == pytest.approx(
        moment, rel=0.015
    )
    rings = contact.loads.on_rings
    stress = SectionField(model.pin, STEEL, (), [rings]).place(rings).value
    assert stress == pytest.approx(section * 1e6, rel=0.015)
    beam = FoundationModel(pin, STEEL, lugs).solve(loads).bending_moment(z)[0]
    assert np.linalg.norm(beam, axis=1).max() == pytest.approx(moment, rel=PLAIN_MOMENT_ERROR)


def test_the_deck_turns_lugs_by_their_moments() -> None:
    """Half of it, on the half of the joint, on a lug that no spring holds."""
    pin, lugs, loads = joint("single")
    fineness = Fineness(rings=2, sectors=8, eye=1, scale=1.0)
    balanced = transverse(PinInLugs(pin, STEEL, lugs), loads)
    deck, angle = joint_deck(pin, STEEL, lugs, balanced, fineness)
    assert deck.half
    assert [eye.tilt for eye in deck.eyes] == [pytest.approx(0.5 * lugs[0].tilt), 0.0]
    assert deck.eyes[1].couple == pytest.approx((0.5 * 550.0 * np.cos(angle), 0.0))

"""A hardened pin in contact with its lugs, beside the same pin of its core's strength."""

from pathlib import Path

import pytest

import pinstress
from reports.data.decision import beneath_factor
from reports.data.row import PinResult

CLEVIS = """
title = "Hardened clevis pin"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.29
{strength}
[material.forged]
youngs_modulus = "205 GPa"
poisson_ratio = 0.29
yield_strength = "400 MPa"
[lug_defaults]
outer_diameter = 50
edge_radius = 0.5
material = "forged"
[pin.P]
material = "steel"
profile = [
  {{ length = 2, diameter = 20 }},
  {{ length = 10, diameter = 20, connection = "A1" }},
  {{ length = 1, diameter = 20 }},
  {{ length = 20, diameter = 20, connection = "B" }},
  {{ length = 1, diameter = 20 }},
  {{ length = 10, diameter = 20, connection = "A2" }},
  {{ length = 2, diameter = 20 }},
]
[case.lift]
kind = "given"
forces = {{ A1 = [0.0, 25000.0], B = [0.0, -50000.0], A2 = [0.0, 25000.0] }}
[analysis]
required_safety_factor = 1.5
"""


def row(folder: Path, strength: str) -> PinResult:
    path = folder / "clevis.toml"
    path.write_text(CLEVIS.format(strength=strength))
    (pin,) = pinstress.run(pinstress.load_study(path)).pins
    return pin


@pytest.mark.slow
def test_core_of_a_clevis_pin_governs_by_its_section(tmp_path: Path) -> None:
    case = 'hardened = { surface = "1100 MPa", core = "600 MPa", depth = 1.5 }'
    hardened, plain = row(tmp_path, case), row(tmp_path, 'yield_strength = "600 MPa"')
    assert hardened.places is not None
    assert plain.places is not None
    assert plain.places.section is not None
    core, shell = hardened.places.hardened
    assert (core.part, core.place, shell.part) == ("core", "section", "case")
    # Pure bending at mid-span falls to 1 - depth / R of that at the surface.
    assert core.max_von_mises == pytest.approx(0.85 * plain.places.section.max_von_mises, rel=1e-6)
    assert shell.max_von_mises == pytest.approx(plain.places.surface.max_von_mises, rel=0.01)
    assert (hardened.safety_factor or 0.0) > (plain.safety_factor or 0.0)
    (bending,) = (m for m in hardened.margins if m.method == "bending, joint model")
    assert bending.allowable == pytest.approx(600.0 / 0.85)
    assert "case and core" in bending.basis


@pytest.mark.slow
def test_what_lies_beneath_contact_counts_with_the_core(tmp_path: Path) -> None:
    thin = row(tmp_path, 'hardened = { surface = "1100 MPa", core = "300 MPa", depth = 6 }')
    assert thin.places is not None
    contact = thin.places.contact
    assert contact is not None
    assert contact.strength == 300.0
    assert beneath_factor(thin) == pytest.approx(300.0 / contact.upper_end)
    # The core, 6 mm deep, has less stress than what is nearer to the surface.
    assert contact.beneath < thin.places.surface.max_von_mises
    crushing = contact.crushing
    assert crushing is not None
    assert crushing.depth >= 6.0
    (margin,) = (m for m in thin.margins if m.method == "case crushing")
    assert (margin.demand, margin.allowable) == (crushing.max_von_mises, 300.0)

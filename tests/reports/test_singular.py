"""Singular zones, hand checks, fields on surfaces: the same numbers everywhere, harmless text."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

from assess.margin import Margin
from fea.core.peak import SingularZone
from reports.data.fields import Field
from reports.data.results import Results
from reports.data.row import PinResult, Units
from reports.files import write_reports
from reports.tables.json_results import to_json
from reports.text.summary import summary
from reports.vtk.fields import write_vtu
from reports.vtk.render import render_pin
from reports.vtk.renderer import renderer_problem
from tests.support.results.rows import with_values

UNITS = Units("in", "lbf", "psi", "s")
ZONE = SingularZone(
    (0.6, 0.8, 2.0), "a sharp corner", ("<b>A", "shoulder 2"), 0.44, 0.4555, 0.2, True, 9e5,
    "a fillet <script>alert(1)</script>",
)  # fmt: skip
LOGARITHM = replace(ZONE, kind="the edge of a load", exponent=None, exponent_theory=0.0)
CHECK = Margin(
    "bending", "=Shigley", "hand", "limit", 1.0, 1234.5, 225e3, at="A", time=1.5, formula="M c / I"
)


@pytest.fixture
def singular(results: Results) -> Results:
    """The run with its first pin singular, and enough outside of the zones."""
    first = with_values(
        results.pins[0],
        verdict="singular",
        safety_factor=5.0,
        decided=None,
        singular_at=(ZONE, LOGARITHM),
        margins=(CHECK,),
        why="harmonic: a beam is never known to 2.0%",
    )
    return replace(results, pins=(first, *results.pins[1:]))


def test_files_and_json_say_the_same(singular: Results, tmp_path: Path) -> None:
    page = write_reports(singular, tmp_path).read_text()
    pin = json.loads((tmp_path / "results.json").read_text())["pins"][0]
    assert pin == to_json(singular)["pins"][0]
    assert pin["verdict"] == "singular"
    assert pin["why"] in page
    zone, logarithm = pin["singular_at"]
    assert zone["exponent"] == 0.44
    assert zone["exponent_theory"] == 0.4555
    assert zone["governs"] is True
    assert (logarithm["exponent"], logarithm["exponent_theory"]) == (None, 0.0)
    rows = list(csv.DictReader((tmp_path / "singular_zones.csv").read_text().splitlines()))
    assert len(rows) == 2
    assert float(rows[0]["radius"]) == pytest.approx(1.0)
    assert float(rows[0]["excluded_radius"]) == zone["excluded_radius"]
    assert rows[1]["exponent"] == ""
    (check,) = csv.DictReader((tmp_path / "hand_checks.csv").read_text().splitlines())
    assert float(check["factor"]) == pin["hand_checks"][0]["factor"] == 225e3 / 1234.5
    assert check["source"] == "'=Shigley"  # no formula for a spreadsheet
    assert "<script>alert(1)" not in page
    assert "&lt;b&gt;A / shoulder 2" in page
    assert "1,234" in page or "1,235" in page


@pytest.mark.parametrize(
    ("factor", "meets", "expected"), [(5.0, None, "not decided"), (0.8, False, "fails")]
)
def test_a_singular_row_can_only_miss(
    singular: Results, factor: float, meets: bool | None, expected: str
) -> None:
    """Too little outside the zones is too little; enough there says nothing of the zones."""
    pin: PinResult = with_values(singular.pins[0], safety_factor=factor, decided=meets)
    assert pin.outcome == expected
    text = summary(replace(singular, pins=(pin,)))
    assert ("fails: A" in text) == (expected == "fails")
    assert "no maximum exists" in text


@pytest.fixture
def surface() -> Field:
    """Four corners of a strip; no stress at one of them."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    value = np.array([0.0, 1.0, 2.0, 4.0]) * 1e3
    stress = np.zeros((4, 6))
    stress[:, 2] = value
    return Field(
        "A", "case", points, np.array([[0, 1, 2, 3]]), 0.0 * points, stress, value, value,
        "quad", 8e3, (2e3, (1.0, 1.0, 0.0)),
    )  # fmt: skip


def test_a_surface_has_its_factor_of_safety(surface: Field, tmp_path: Path) -> None:
    write_vtu(surface, tmp_path / "a.vtu", UNITS)
    mesh = meshio.read(tmp_path / "a.vtu")
    assert mesh.cells[0].type == "quad"
    factor = mesh.point_data["factor of safety"]
    assert factor[1:] == pytest.approx([8.0, 4.0, 2.0])
    assert factor[0] > 1e30
    assert np.isfinite(factor).all()


def test_a_surface_can_be_drawn(surface: Field, tmp_path: Path) -> None:
    if (problem := renderer_problem()) is not None:
        pytest.fail(problem)
    render_pin(surface, tmp_path / "a.png", UNITS, "a strip")
    assert (tmp_path / "a.png").stat().st_size > 5000

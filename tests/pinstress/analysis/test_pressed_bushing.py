"""A pressed bushing in a run: both interfaces in the table, its own yield judged, a temperature."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

import pinstress
from reports.data.headline import worst_checks
from reports.files import write_reports
from tests.support.mechanism.machines import STUDIES

CLEVIS = (STUDIES / "clevis.toml").read_text(encoding="utf-8")
BRONZE = """
[material.bronze]
youngs_modulus = "110 GPa"
poisson_ratio = 0.34
yield_strength = "150 MPa"
thermal_expansion = "18e-6 1/K"

[case.hot]
kind = "given"
temperature = "70 degC"
forces = { LEFT = [-25000, 0], EYE = [50000, 0], RIGHT = [-25000, 0] }

[analysis]
"""
EYE = """lug.EYE = { tilt = "guided", shank = {}, bushing = { thickness = 3, material = "bronze", \
interference = 0.03 } }"""


@pytest.fixture(scope="module")
def clevis(tmp_path_factory: pytest.TempPathFactory) -> tuple[pinstress.RunResults, Path]:
    folder = tmp_path_factory.mktemp("bushing")
    text = CLEVIS.replace("\n[analysis]\n", BRONZE).replace('lug.EYE = { tilt = "guided" }', EYE)
    strength = 'yield_strength = { value = "700 MPa"'
    text = text.replace(strength, f'thermal_expansion = "12e-6 1/K"\n{strength}')
    path = folder / "clevis.toml"
    path.write_text(text, encoding="utf-8")
    results = pinstress.run(pinstress.load_study(path))
    write_reports(results, folder / "run")
    return results, folder / "run"


def rows(folder: Path, case: str) -> dict[tuple[str, str], dict[str, str]]:
    with (folder / "lugs.csv").open(encoding="utf-8", newline="") as file:
        return {(x["wall"], x["place"]): x for x in csv.DictReader(file) if x["case"] == case}


def test_the_hole_is_stressed_as_much_as_without_friction(
    clevis: tuple[pinstress.RunResults, Path],
) -> None:
    hole = rows(clevis[1], "pull")["hole", "bushing"]
    assert hole["interface"] == "frictionless"
    assert float(hole["max_von_mises"]) > 1.05 * float(hole["other_interface"])
    assert float(hole["error_estimate"]) < 0.05 * float(hole["max_von_mises"])
    page = (clevis[1] / "report.html").read_text(encoding="utf-8")
    assert "frictionless" in page


def test_a_bushing_is_judged_against_its_own_yield(
    clevis: tuple[pinstress.RunResults, Path],
) -> None:
    row = clevis[0]["P", "pull"]
    margins = {m.method: m for m in row.margins if m.level == "limit"}
    bushing = margins["lug, von Mises stress at the bore, bushing"]
    assert bushing.allowable == pytest.approx(150.0)
    assert bushing.material == "bronze"
    assert bushing.governs
    assert margins["lug, von Mises stress at the bore, hole"].allowable == pytest.approx(700.0)


def test_heat_presses_the_bushing_and_closes_its_bore(
    clevis: tuple[pinstress.RunResults, Path],
) -> None:
    """Bronze in steel: 6e-6 of 26 mm by 50 K are 0.0078 mm more interference."""
    cold, hot = (rows(clevis[1], case)["bushing", "free"] for case in ("pull", "hot"))
    assert float(hot["max_von_mises"]) > 1.1 * float(cold["max_von_mises"])
    joint = clevis[0]["P", "hot"].joint
    assert joint is not None
    bands = {band.name: band for band in joint.bands}
    assert bands["LEFT"].clearance == pytest.approx(0.05)
    A, B, C = 10.0, 13.0, 25.0  # mm; p by the Air Force manual, 9.16
    lug = B / 210e3 * ((C * C + B * B) / (C * C - B * B) + 0.3)
    bush = B / 110e3 * ((B * B + A * A) / (B * B - A * A) - 0.34)
    p = 6e-6 * 50.0 * B / (lug + bush)
    closed = 2.0 * 2.0 * p * B * B * A / (110e3 * (B * B - A * A))
    assert bands["EYE"].clearance == pytest.approx(0.05 + 6e-6 * 20.0 * 50.0 - closed, rel=1e-9)


def test_a_press_fit_without_a_shank_is_judged_by_lame(tmp_path: Path) -> None:
    """It was judged nowhere: bronze at 671 MPa of its 150 was safe. Air Force manual, 9.16, on the
    ring of facts.md, D3: p 5618.2, hoop stress of the bore -25683 and of the hole 7022.7 psi.
    """
    hole, bore = {"youngs_modulus": 10.3e6, "yield_strength": 66e3}, {"youngs_modulus": 16.0e6}
    bore["yield_strength"] = 30e3
    ring = {"thickness": 0.0625, "material": "bronze", "interference": 0.001}
    lug = {"material": "plate", "outer_diameter": 1.5}
    profile = [{"length": 0.5, "diameter": 0.375, "connection": name} for name in "LR"]
    raw = {
        "title": "D3",
        "units": "in-lbf-s",
        "analysis": {"joints": "prescribed", "required_safety_factor": 1.25},
        "material": {
            "plate": {**hole, "poisson_ratio": 0.33},
            "bronze": {**bore, "poisson_ratio": 0.33},
        },
        "case": {"pull": {"kind": "given", "forces": {"L": [-10, 0], "R": [10, 0]}}},
        "pin": {
            "P": {
                "material": "plate",
                "profile": profile,
                "lug": {"L": lug, "R": {**lug, "bushing": ring}},
            }
        },
    }
    results = pinstress.run(pinstress.study_from(raw))
    margins = {m.method: m for m in results["P", "pull"].margins if "press fit" in m.method}
    bushing, eye = margins["press fit, bushing"], margins["press fit, eye"]
    assert bushing.demand == pytest.approx(25683.0, abs=1.0)
    assert bushing.margin == pytest.approx(30e3 / (1.25 * 25683.0) - 1.0, abs=1e-4)
    assert bushing.passing is not None
    assert bushing.passing.value == pytest.approx(1e-3 * 30e3 / (1.25 * 25683.0), rel=1e-4)
    hoop, p = 7022.7, 5618.2
    assert eye.demand == pytest.approx((hoop**2 + hoop * p + p**2) ** 0.5, abs=1.0)
    assert (bushing.at, eye.at) == ("R", "R")
    assert worst_checks(results)["P"].outcome == "fails"

"""A pressed bushing in a run: both interfaces in the table, its own yield judged, a temperature."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import pytest

import pinstress
from assess.margin import Margin
from fea.support.records import LugStress
from pinstress.study.reading.in_python import study_from
from reports.data.headline import worst_checks
from reports.files import write_reports
from tests.support.mechanism.machines import STUDIES
from tests.support.pins.remembered import remembered

CLEVIS = (STUDIES / "clevis.toml").read_text(encoding="utf-8")
HOT = """[case.hot]
kind = "given"
temperature = "70 degC"
forces = { LEFT = [-25000, 0], EYE = [50000, 0], RIGHT = [-25000, 0] }
"""
BRONZE = f"""
[material.bronze]
youngs_modulus = "110 GPa"
poisson_ratio = 0.34
yield_strength = "150 MPa"
thermal_expansion = "18e-6 1/K"

{HOT}
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
    results = remembered(pinstress.load_study(path))
    write_reports(results, folder / "run")
    return results, folder / "run"


def rows(folder: Path, case: str) -> dict[tuple[str, str], dict[str, str]]:
    with (folder / "lugs.csv").open(encoding="utf-8", newline="") as file:
        return {(x["wall"], x["place"]): x for x in csv.DictReader(file) if x["case"] == case}


@pytest.mark.seconds
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


@pytest.mark.seconds
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


HOOP, PRESSURE, BORE = 7022.7, 5618.2, 25683.0  # psi, at 0.001 in
HOLE = math.hypot(HOOP + PRESSURE / 2.0, math.sqrt(0.75) * PRESSURE)  # von Mises, in plane stress


def ring(bushing: dict[str, Any], **lug: Any) -> pinstress.RunResults:
    """The ring of AFFDL-TR-69-42, 9.16: radii 0.1875, 0.25 and 0.75 in."""
    plate = {"youngs_modulus": 10.3e6, "poisson_ratio": 0.33, "yield_strength": 66e3}
    bronze = {"youngs_modulus": 16.0e6, "poisson_ratio": 0.33, "yield_strength": 30e3}
    left: dict[str, Any] = {"material": "plate", "outer_diameter": 1.5}
    right = {**left, **lug, "bushing": {"thickness": 0.0625, "material": "bronze", **bushing}}
    profile = [{"length": 0.5, "diameter": 0.375, "connection": name} for name in "LR"]
    raw = {
        "title": "D3",
        "units": "in-lbf-s",
        "analysis": {"joints": "prescribed", "required_safety_factor": 1.25},
        "material": {"plate": plate, "bronze": bronze},
        "case": {"pull": {"kind": "given", "forces": {"L": [-10, 0], "R": [10, 0]}}},
        "pin": {
            "P": {"material": "plate", "profile": profile, "lug": {"L": left, "R": right}},
        },
    }
    return pinstress.run(pinstress.study_from(raw))


def press_fits(results: pinstress.RunResults) -> list[Margin]:
    """Of bushing and eye."""
    return [m for m in results["P", "pull"].margins if "press fit" in m.method]


def test_a_press_fit_without_a_shank_is_judged_by_lame() -> None:
    """It was judged nowhere: bronze at 671 MPa of its 150 was safe."""
    results = ring({"interference": 0.001})
    bushing, eye = press_fits(results)
    assert bushing.demand == pytest.approx(BORE, abs=1.0)
    assert bushing.margin == pytest.approx(30e3 / (1.25 * BORE) - 1.0, abs=1e-4)
    assert bushing.passing is not None
    assert bushing.passing.value == pytest.approx(1e-3 * 30e3 / (1.25 * BORE), rel=1e-4)
    assert eye.demand == pytest.approx(HOLE, abs=1.0)
    assert (bushing.at, eye.at) == ("R", "R")
    assert worst_checks(results)["P"].outcome == "fails"


def test_the_most_interference_of_a_range_counts() -> None:
    """In the middle of the range, 0.0006 in, both walls would pass."""
    results = ring({}, range={"interference": [0.0002, 0.001]})
    bushing, eye = press_fits(results)
    assert bushing.demand == pytest.approx(BORE, abs=1.0)
    assert eye.demand == pytest.approx(HOLE, abs=1.0)
    assert worst_checks(results)["P"].outcome == "fails"
    (bushing, _) = press_fits(ring({"interference": 0.0006}))
    assert bushing.demand == pytest.approx(0.6 * BORE, abs=1.0)
    assert (bushing.margin or 0.0) > 0.0


def test_the_most_interference_of_a_fit_counts() -> None:
    """H7/s6 at 12.7 mm: 0 to 18 and 28 to 39 micrometres."""
    (bushing, _) = press_fits(ring({"fit": "H7/s6"}))
    assert bushing.demand == pytest.approx(0.039 / 25.4 / 0.001 * BORE, rel=1e-4)


@pytest.mark.slow
def test_the_stress_of_a_lug_is_the_largest_over_the_range(
    clevis: tuple[pinstress.RunResults, Path],
) -> None:
    """Of each wall, as of runs at the ends alone, which know of no range."""
    most = walls(clevis[0])
    least, over = (
        walls(remembered(study_from(text(bushing))))
        for bushing in (
            ", interference = 0.002 }",
            " }, range = { interference = [0.002, 0.03] }",
        )
    )
    governs = {
        place: max((x[place].max_von_mises, at) for x, at in ((least, 0.002), (most, 0.03)))
        for place in over
    }
    for place, (stress, interference) in governs.items():
        assert over[place].max_von_mises == pytest.approx(stress, rel=1e-9)
        assert over[place].interference == pytest.approx(interference)
    # A press fit takes tension off the free bore, and adds to that of the hole.
    assert governs["bushing", "free"][1] == 0.002
    assert governs["hole", "bushing"][1] == 0.03


def text(bushing: str) -> str:
    """The study of the clevis whose eye has a bushing, without the hot case."""
    return CLEVIS.replace("\n[analysis]\n", BRONZE.replace(HOT, "")).replace(
        'lug.EYE = { tilt = "guided" }', EYE.replace(", interference = 0.03 }", bushing)
    )


def walls(results: pinstress.RunResults) -> dict[tuple[str, str], LugStress]:
    """The stress of the eye by wall and place."""
    joint = results["P", "pull"].joint
    assert joint is not None
    return {(x.wall, x.place): x for x in joint.lugs}

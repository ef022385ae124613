"""Fatigue and limit loads that are met as described, but not over what the study leaves open."""

from __future__ import annotations

from dataclasses import replace

import pytest

import pinstress
from assess.judgement import BELOW_YIELD, NOT_DECIDED
from assess.plastic.records import LimitLoad
from pinstress.analysis.results import RunResults
from pinstress.study.reading.in_python import study_from
from reports.data.headline import worst_checks
from reports.data.requirements import RequirementRow, requirement_rows
from reports.format.words import headline
from reports.tables.strength.fatigue import fatigue_sentence
from tests.conftest import ROOT
from tests.silent.test_checks_over_the_joint import LOOSE, RANGED, TEXT, TIGHT
from tests.support.pins.remembered import remembered

SPECTRUM = """
[material.steel.fatigue]
knee_stress = "100 MPa"
knee_cycles = 1e6
slope = 5
mean_stress_sensitivity = 0.2
[fatigue]
life = LIFE
[fatigue.occurrences]
pull = 1
[analysis]
"""
CLAMPED = f"""
title = "A clamp, whose edge is singular, and a fillet"
units = "mm-N-s"
[material.steel]
youngs_modulus = "206 GPa"
poisson_ratio = 0.3
{SPECTRUM.replace("LIFE", "1000")}
model = "harmonic"
tolerance = 0.1
[pin.P]
material = "steel"
clamp = ["start"]
profile = [
  {{ length = 40, diameter = 20, fillet = 3 }},
  {{ length = LENGTH, diameter = 14 }},
  {{ length = 10, diameter = 14, connection = "L" }},
]
[case.pull]
kind = "given"
forces = {{ L = [3000, 0] }}
"""
STRONG = '[material.steel]\nyield_strength = "3000 MPa"'
ASKED = '[[require]]\ncheck = "limit load"\nlevel = "limit"\nfactor = 4.0\n'
ALWAYS = """
[analysis]
limit_load = "always"
"""


def solved(clearance: str, life: float = 1000.0) -> RunResults:
    return of_joint(clearance, SPECTRUM.replace("LIFE", f"{life}"))


def of_joint(clearance: str, analysis: str, more: str = "") -> RunResults:
    text = TEXT.replace("CLEARANCE", clearance).replace("HALF", "20e3").replace("WHOLE", "40e3")
    return remembered(study_from(text.replace("[analysis]", analysis) + more))


def row_of(results: RunResults, check: str) -> RequirementRow:
    rows = [row for row in requirement_rows(results) if row.check == check]
    return next((row for row in rows if row.stated), rows[0])


def damages(results: RunResults) -> tuple[float, float]:
    """The largest damage as described, and over all that is open."""
    assert results.fatigue is not None
    points = results.fatigue.points
    return points[0].damage, max(p.largest_damage or 0.0 for p in points)


def test_a_life_that_a_loose_joint_does_not_reach_depends() -> None:
    """A run with the clearance at its end shows it; the requirement was said to be met."""
    (given, _), (there, _) = damages(solved(TIGHT)), damages(solved(LOOSE))
    assert there > 1.5 * given
    loose_alone = RANGED.replace("0.3] }", "0.3], stiffness = [1.0, 1.0] }")
    ranged = solved(loose_alone)
    assert ranged.fatigue is not None
    assert ranged.fatigue.points[0].damage == given
    worst = max(p.damage_over["joint"] for p in ranged.fatigue.points)
    assert there <= worst < 4.0 * there
    between = solved(loose_alone, life=(given * there) ** -0.5)
    assert (row_of(between, "fatigue").outcome, row_of(between, "fatigue").over) == (
        "depends", "joint"
    )  # fmt: skip
    assert between.fatigue is not None
    assert "by the range of its joint" in fatigue_sentence(between.fatigue)
    enough = solved(loose_alone, life=0.9 / damages(ranged)[1])
    assert row_of(enough, "fatigue").outcome == "met"
    stiff = solved(RANGED).fatigue  # whose stress grows more in the same clearance
    assert stiff is not None
    assert max(p.damage_over["joint"] for p in stiff.points) > worst


def test_a_life_within_the_error_of_the_stress_is_not_decided() -> None:
    results = solved(TIGHT)
    assert results.fatigue is not None
    (worst, *_) = results.fatigue.points
    (row,) = results.pins
    assert row.max_von_mises
    high = 1.0 + (row.error_estimate or 0.0) / row.max_von_mises
    assert high > 1.001
    assert worst.damage_over["error"] == pytest.approx(worst.damage * high**5, rel=1e-9)
    near = row_of(
        solved(TIGHT, life=0.5 / worst.damage + 0.5 / worst.damage_over["error"]), "fatigue"
    )
    assert (near.outcome, near.needs) == ("not decided", "a smaller error of the stress")


def test_a_life_has_the_error_of_the_surface_where_a_section_governs_a_singular_row() -> None:
    """It had none, as a section has none and a singular row an interval: a life that the mesh
    cannot tell was reached. Both leave a singular zone out, which only the latter said.
    """
    for length, row_is in ((60.0, ("converged", "surface")), (10.0, ("singular", "section"))):
        results = remembered(study_from(CLAMPED.replace("LENGTH", f"{length}")))
        (row,), fatigue = results.pins, results.fatigue
        assert fatigue is not None
        assert row.places is not None
        assert (row.verdict, row.places.governs) == row_is
        assert any(x.startswith("Cracks may start in singular zones") for x in fatigue.left_out)
        surface, worst = row.places.surface, fatigue.points[0]
        high = 1.0 + surface.error_estimate / surface.max_von_mises
        assert high > 1.001
        assert worst.damage_over["error"] == pytest.approx(worst.damage * high**5, rel=1e-9)


def test_a_life_within_the_error_decides_no_pin_either() -> None:
    """The requirement was not decided, and the headline said that the pin stays below yield."""
    text = CLAMPED.replace("LENGTH", "60").replace("[material.steel]", STRONG, 1)
    alone = remembered(study_from(text)).fatigue
    assert alone is not None
    ends = alone.points[0].damage, alone.points[0].damage_over["error"]
    for damage, decided in ((sum(ends) / 2.0, False), (1.01 * ends[1], True)):
        results = remembered(study_from(text.replace("life = 1000", f"life = {1.0 / damage}")))
        assert results.pins[0].outcome == BELOW_YIELD
        assert (worst_checks(results)["P"].outcome != NOT_DECIDED) == decided
        assert ("not decided" not in headline(results)) == decided


def test_a_limit_load_depends_on_the_joint() -> None:
    """The factor of the bracket's lower end is less than the joint may take from it."""
    results = of_joint(RANGED, '[analysis]\nlimit_load = "never"', ASKED)
    (row,) = results.pins
    growth = row.joint_growth
    assert growth > 1.1
    for lower, outcome, over in (
        (3.9, "not decided", ""),
        (4.1, "depends", "joint"),
        (4.1 * growth, "met", ""),
    ):
        limit = LimitLoad("solid", lower, 1.1 * lower)
        requirement = row_of(replace(results, pins=(replace(row, limit_load=limit),)), "limit load")
        assert (requirement.outcome, requirement.over) == (outcome, over)


@pytest.mark.long
def test_a_limit_load_that_a_loose_joint_does_not_reach_depends() -> None:
    """Runs with the clearance at its ends show it; the requirement was said to be met."""
    collapse = [of_joint(x, ALWAYS).pins[0].limit_load for x in (TIGHT, LOOSE)]
    tight, loose = (x and x.lower for x in collapse)
    assert tight
    assert loose
    assert loose < 0.95 * tight
    asked = ASKED.replace("4.0", f"{(tight * loose) ** 0.5}")
    row = row_of(of_joint(RANGED, ALWAYS, asked), "limit load")
    assert (row.outcome, row.over) == ("depends", "joint")


def test_a_landing_counts_over_its_range() -> None:
    """Beside a run of the worst landing that the study allows; all cycles are beyond the knee."""
    spectrum = SPECTRUM.replace("steel", '"AISI 4340"').replace("LIFE", "1000")
    spectrum = spectrum.replace("100 MPa", "1 psi").replace("pull = 1", "landing = 1")
    text = (ROOT / "studies" / "landing_gear.toml").read_text(encoding="utf-8")
    open_ = pinstress.study_from(text.replace("[analysis]", spectrum, 1), ROOT / "studies")
    impulse = "case.landing.apply[1].impulse"
    worst = {f"{impulse}.impulse_time": "0.1 s", f"{impulse}.pulse": "half-sine"}
    points = []
    for study in (open_, pinstress.changed_study(open_, worst)):
        results = pinstress.run(study, pins=["B"], cases=["landing"])
        assert results.fatigue is not None
        points.append(results.fatigue.points[0])
    stated, there = points
    assert there.damage > 50.0 * stated.damage
    assert stated.damage_over["landing"] == pytest.approx(there.damage, rel=1e-3)

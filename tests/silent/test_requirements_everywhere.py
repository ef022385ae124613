"""A requirement must not be forgotten wherever factors are judged: in motions, singular rows,
fatigue, designs and reliability.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from pinstress import Engine, run, study_from
from pinstress.analysis.results import RunResults
from pinstress.cli.commands import run_command_line
from reports.data.decision import factor_ends
from reports.data.governing import governing
from reports.data.headline import worst_checks
from reports.data.requirements import RequirementRow, requirement_rows
from reports.data.row import SharingRange
from reports.text.summary import caveats
from tests.conftest import ROOT
from tests.pinstress.analysis.test_margins import STRENGTHS, study
from tests.pinstress.explore.reliability.test_reliability import BAR
from tests.support.study_text import edited

STUDIES = ROOT / "studies"


def shipped(name: str, require: str, *changes: tuple[str, str]) -> str:
    """The text of a study with requirements, and with other texts in it."""
    text = (STUDIES / f"{name}.toml").read_text(encoding="utf-8")
    return f"{edited(text, changes)}\n{require}"


def require(**keys: Any) -> str:
    return "[[require]]\n" + "".join(f"{k} = {json.dumps(v)}\n" for k, v in keys.items())


def stated(results: RunResults) -> list[RequirementRow]:
    return [row for row in requirement_rows(results) if row.stated]


@pytest.mark.slow
def test_the_cases_of_a_motion_have_factors_of_their_own() -> None:
    """Of retract and of an instant in it, the second one stricter than is reached."""
    text = (STUDIES / "bowman2019.toml").read_text(encoding="utf-8")
    plain = run(study_from(text, STUDIES), pins=["A"], model="beam", tolerance=0.9)
    reached = {row.case: factor_ends(row) for row in plain.pins}
    assert len(reached) == 2
    strict = 1.1 * reached["snapshot"][1]
    both = require(pins=["A"], cases=["retract"], check="yield", factor=0.5)
    both += require(pins=["A"], cases=["snapshot"], check="yield", factor=strict)
    found = run(study_from(text + both, STUDIES), pins=["A"], model="beam", tolerance=0.9)
    rows = {row.case: row for row in found.pins}
    assert rows["snapshot"].outcome == "fails"
    assert rows["snapshot"].required == strict
    assert rows["retract"].required == 0.5
    assert rows["retract"].safety_factor == plain["A", "retract"].safety_factor
    assert {(r.case, r.required) for r in stated(found)} == {("retract", 0.5), ("snapshot", strict)}


def test_a_singular_row_misses_a_requirement_but_never_meets_it() -> None:
    sharp = ("fillet = 0.4", "fillet = 0.0")
    default = run(study_from(shipped("one_pin", "", sharp)))
    (row,) = default.pins
    assert row.verdict == "singular"
    low, high = row.safety_factor_interval or (0.0, None)
    assert high is not None
    for factor, outcome in ((0.5 * low, "not decided"), (1.1 * high, "missed")):
        text = shipped("one_pin", require(check="yield", level="proof", factor=factor), sharp)
        found = {r.level: r for r in stated(run(study_from(text)))}
        assert found["proof"].outcome == outcome
        assert found["proof"].reached == row.safety_factor


@pytest.fixture(scope="module")
def fatigue() -> RunResults:
    return run(study_from(shipped("fatigue", require(check="fatigue", factor=2.0))))


def test_fatigue_is_a_factor_on_life(fatigue: RunResults) -> None:
    assert fatigue.fatigue is not None
    life = 1.0 / max(point.damage for point in fatigue.fatigue.points)
    (row,) = (r for r in stated(fatigue) if r.check == "fatigue" and r.required == 2.0)
    assert row.reached == pytest.approx(life / 20000)
    assert row.outcome == ("met" if life >= 40000 else "missed")
    assert row.case == ""


@pytest.mark.slow
def test_fatigue_without_its_numbers() -> None:
    asked = require(check="fatigue", factor=2.0)
    for change, cases, outcome, needs in (
        (("life = 20000\n", ""), None, "not checked", "fatigue.life"),
        (("", ""), ["landing"], "not decided", "to be run"),
    ):
        results = run(study_from(shipped("fatigue", asked, change)), cases=cases)
        (row,) = (r for r in stated(results) if r.check == "fatigue" and r.required == 2.0)
        assert row.outcome == outcome
        assert row.needs.endswith(needs)


def test_designs_are_judged_by_their_requirement(tmp_path: Path) -> None:
    """A sweep over the factor of [[require]] itself: 2 is reached, 12 is not."""
    import pyarrow.parquet as pq
    import tomlkit

    tables = study(STRENGTHS, required_safety_factor=1.5)
    tables["require"] = [{"pins": ["P"], "check": "yield", "factor": 2.0}]
    steps = {"from": 2.0, "to": 12.0, "steps": 2}
    tables["vary"] = {"sample": "grid", "parameters": {"require[1].factor": steps}}
    (tmp_path / "s.toml").write_text(tomlkit.dumps(tables), encoding="utf-8")
    out = tmp_path / "out"
    command = ["sweep", str(tmp_path / "s.toml"), "--out", str(out), "--jobs", "1", "--quiet"]
    assert run_command_line(command) == 0
    table = pq.read_table(out / "designs.parquet")
    outcomes = [str(x).split(" as")[0] for x in table["outcome"].to_pylist()]
    assert outcomes == ["safe", "fails"]
    metadata = json.loads(table.schema.metadata[b"pinstress"])
    assert metadata["required_safety_factor"] == 2.0


@pytest.mark.slow
def test_reliability_keeps_its_own_factor(tmp_path: Path) -> None:
    """[reliability] states what failure is; a requirement beside it changes no number."""
    small = BAR.replace("samples = 200", "samples = 50").replace("= 300", "= 20")
    small = small.replace("sobol_samples = 16", "sobol_samples = 0")
    found: list[Any] = []
    for more in ("", require(check="yield", factor=1.2)):
        (tmp_path / "bar.toml").write_text(small + more, encoding="utf-8")
        out = tmp_path / f"out{len(found)}"
        command = ["reliability", str(tmp_path / "bar.toml"), "--out", str(out), "--quiet"]
        assert run_command_line([*command, "--jobs", "1"]) in (0, 1)
        written = json.loads((out / "reliability.json").read_text(encoding="utf-8"))
        found.append({key: x for key, x in written.items() if key not in ("study_sha256", "hash")})
    assert found[0] == found[1]


LANDED = """
title = "Two bars under a landing"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = 1000
[pin.C]
material = "steel"
profile = [
  { length = 10, diameter = 20, connection = "C1" },
  { length = 20, diameter = 20, connection = "C2" },
  { length = 10, diameter = 20, name = "far", ear_of = "C1" },
]
[mechanism]
gravity = [0, 0]
joint.A = { at = [0, 0], fixed_in = "ground", connections = { A = "a" } }
joint.B = { at = [800, 0], fixed_in = "ground", connections = { B = "b" } }
joint.C = { at = [400, 300], connections = { C1 = "a", C2 = "b" }, weight = 0 }
body.a = { mass = 0, inertia = 0 }
body.b = { mass = 0, inertia = 0 }
[case.landing]
kind = "static"
[[case.landing.apply]]
body = "a"
at = "C"
[case.landing.apply.impulse]
mass = "1000 kg"
velocity_change = "5 m/s"
impulse_time = 0.15
pulse = "rectangular"
direction = [0, -1]
range = { impulse_time = [0.05, 0.15], velocity_change = ["5 m/s"] }
"""


def test_checks_by_formula_hold_over_the_range_of_a_landing() -> None:
    """By hand: 1000 kg of 5 m/s in 0.15 s are 33.3 kN, 5/6 of which is in each bar; 1000 MPa over
    27.8 kN / (20 * 20 mm) is 14.4, and 4.8 in 0.05 s.
    """
    for factor, outcome in ((4.7, "met"), (4.9, "depends"), (14.5, "missed")):
        asked = require(check="bearing", factor=factor) + require(check="yield", factor=0.1)
        results = run(study_from(LANDED + asked), tolerance=0.2)
        (bearing,) = (r for r in stated(results) if r.check == "bearing")
        assert bearing.reached == pytest.approx(14.4, rel=1e-6)
        assert (bearing.outcome, bearing.over) == (outcome, "landing" * (outcome == "depends"))
        assert results["C", "landing"].outcome == "safe"
        (worst,) = worst_checks(results).values()
        assert worst.outcome == {"met": "safe", "missed": "fails"}.get(outcome, outcome)


OPPOSED = """
title = "A landing bends a pin against what a static load does"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = STRENGTH
[analysis]
tolerance = 0.2
[pin.A]
material = "steel"
clamp = ["start"]
profile = [
  { length = 10, diameter = 20 },
  { length = 10, diameter = 20, connection = "A1" },
  { length = 10, diameter = 20, connection = "A2" },
]
[mechanism]
gravity = [0, 0]
joint.A = { at = [0, 0], fixed_in = "ground", connections = { A1 = "a", A2 = "c" }, weight = 0 }
joint.B = { at = [800, 0], fixed_in = "ground", connections = { B1 = "b", B2 = "d" } }
joint.C = { at = [400, 300], connections = { C1 = "a", C2 = "b" } }
joint.D = { at = [400, 300], connections = { D1 = "c", D2 = "d" } }
body = { a = MASSLESS, b = MASSLESS, c = MASSLESS, d = MASSLESS }
[case.landing]
kind = "static"
[[case.landing.apply]]
body = "c"
at = "D"
force = [0, 20000]
[[case.landing.apply]]
body = "a"
at = "C"
[case.landing.apply.impulse]
mass = "1000 kg"
velocity_change = "5 m/s"
impulse_time = TIME
pulse = "rectangular"
direction = [0, -1]
"""


def test_checks_by_formula_hold_where_stress_grows_more_than_any_force() -> None:
    """The moment at the root is the difference of two that nearly cancel. In a landing of a third
    of the time one force is 3 times as large, and bending, by the run of that landing, 6 times:
    a strength that is missed there was enough by the force alone.
    """

    def bending(time: str, strength: float) -> RequirementRow:
        text = OPPOSED.replace("TIME", time).replace("STRENGTH", str(strength))
        results = run(study_from(text.replace("MASSLESS", "{ mass = 0, inertia = 0 }")))
        return next(r for r in requirement_rows(results) if r.check == "bending")

    there = bending("0.05", 1000.0).reached or 0.0
    over = bending("0.15\nrange = { impulse_time = [0.05, 0.15] }", 900.0 / there)
    assert (over.reached or 0.0) > 0.9 * 6.0
    assert (over.outcome, over.over) == ("depends", "landing")


def test_checks_by_formula_of_quick_answers_hold_over_the_range_of_a_landing() -> None:
    """By hand as above: of 0.1 s bearing reaches 9.6, and 4.8 in 0.05 s; quick answers met 5."""
    asked = require(check="bearing", factor=5.0)
    lugs = "[lug_defaults]\nouter_diameter = 80\nedge_radius = 0.5\n"
    rough = '[analysis]\njoints = "contact"\nlimit_load = "never"\ntolerance = 0.1\n'
    engine = Engine(study_from(LANDED + asked + lugs + rough))
    changes = {"case.landing.apply[1].impulse.impulse_time": 0.1}
    results = engine.answer(changes, accuracy="quick")
    (bearing,) = (r for r in stated(results) if r.check == "bearing")
    assert "scaled" in results["C", "landing"].note
    assert (bearing.outcome, bearing.over) == ("depends", "landing")


def test_checks_by_formula_hold_over_the_stiffness_of_links() -> None:
    """The range over links was of the row's stress alone."""
    asked = require(check="bearing", factor=5.0)
    landed = LANDED.replace("[0.05, 0.15]", "[0.15]")
    results = run(study_from(landed + asked), tolerance=0.2)
    for most, outcome in ((2.8, "met"), (2.9, "depends")):  # 14.4 / 5 = 2.88
        shared = SharingRange((1.0, 2.0), "", "a stiffer", most)
        changed = replace(results, pins=(replace(results.pins[0], sharing=shared),))
        (bearing,) = (r for r in requirement_rows(changed) if r.check == "bearing" and r.stated)
        assert (bearing.outcome, bearing.over) == (outcome, "links" * (outcome == "depends"))


@pytest.mark.slow
def test_formulas_that_leave_out_cuts_do_not_meet_requirements() -> None:
    """Of a pin with a hole in a band: shear is met where the model's stress meets it."""
    tree = study(model="auto", tolerance=0.3)
    pin = tree["pin"]["P"] | {"hole": [{"z": 16.5, "diameter": 4, "angle": "90 deg"}]}
    every = [{"check": "shear", "factor": 2}, {"check": "bearing", "factor": 1.1}]
    more = [{"check": "shear", "factor": 8, "level": "proof"}]
    tree |= {"pin": {"P": pin}, "require": every + more}
    results = run(study_from(tree))
    (low,) = (row.safety_factor for row in results.pins)
    assert low is not None
    assert 2.0 < low < 8.0
    found = {(row.level, row.check): row for row in stated(results)}
    assert found["limit", "shear"].outcome == "met"
    assert found["limit", "shear"].reached == pytest.approx(low)
    for key in (("proof", "shear"), ("limit", "bearing")):
        row = found[key]
        assert row.outcome == "not checked"
        assert "the cuts of the pin" in row.needs
        assert row.reached is not None
        assert row.reached > row.required
    every_row = {(row.level, row.check): row for row in requirement_rows(results)}
    for check in (("limit", "bending"), ("ultimate", "plastic bending and shear")):
        assert every_row[check].outcome == "met"  # by the stress of the model
    clause = every_row["ultimate", "EN 1993 bending"]
    assert clause.outcome == "not checked"
    assert "the cuts of the pin" in clause.needs
    assert not any(m.margin.omits_cuts for m in governing(results))
    omitting = {m.margin.method for m in results.margins if m.margin.omits_cuts}
    assert {"bearing", "single shear, mean", "bending"} <= omitting
    assert "Checks by formula leave out the cuts, which only the model has: pin P." in caveats(
        results
    )

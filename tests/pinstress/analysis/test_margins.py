"""Margins of safety from a study to the files of a run, and its exit status."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import pytest

from assess.strength.lug_stress import CONTACT_NEED
from assess.strength.model_stress import YIELD_METHOD
from pinstress import run, study_from
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.errors import InputError
from reports.data.governing import governing, skipped
from tests.support.each import each

STUDY: dict[str, Any] = {
    "title": "A pin in double shear",
    "units": "mm-N-s",
    "material": {"steel": {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3}},
    "analysis": {"model": "beam", "joints": "prescribed", "tolerance": 0.9},
    "case": {
        "pull": {
            "kind": "given",
            "forces": {"L": [-2500, 0], "M": [5000, 0], "R": [-2500, 0]},
        }
    },
    "pin": {
        "P": {
            "material": "steel",
            "profile": [
                {"length": 8, "diameter": 16, "connection": "L"},
                {"length": 1, "diameter": 16},
                {"length": 15, "diameter": 16, "connection": "M"},
                {"length": 1, "diameter": 16},
                {"length": 8, "diameter": 16, "connection": "R"},
            ],
        }
    },
}
STRENGTHS = {"yield_strength": "235 MPa", "ultimate_strength": "360 MPa",
             "shear_strength": "210 MPa", "bearing_strength": "540 MPa"}  # fmt: skip


def study(material: dict[str, Any] = STRENGTHS, **analysis: Any) -> dict[str, Any]:
    """With strengths of the material, and other keys of [analysis]."""
    of = {"steel": {**STUDY["material"]["steel"], **material}}
    return {**STUDY, "material": of, "analysis": {**STUDY["analysis"], **analysis}}


def test_results_in_the_units_of_the_study() -> None:
    """On paper: a pin of 16 mm in S235, 8 / 15 / 8 mm with gaps of 1 mm, 5 kN."""
    found = {(m.margin.method, m.margin.level): m.margin for m in run(study_from(study())).margins}
    shear = found["EN 1993 shear", "ultimate"]
    assert shear.demand == pytest.approx(2500.0)
    assert shear.allowable == pytest.approx(34743.5, rel=1e-5)
    bending = found["EN 1993 bending", "ultimate"]
    assert bending.demand == pytest.approx(5000.0 * 35.0 / 8.0)  # N mm
    assert bending.margin == pytest.approx(141_749.0 / (1.5 * 21_875.0) - 1.0, rel=1e-5)
    rupture = found["single shear, mean", "ultimate"]
    assert rupture.margin == pytest.approx(210.0 / (1.5 * 2500.0 / (math.pi * 64.0)) - 1.0)


def test_couples_alone_bend_a_pin() -> None:
    """Opposite moments of two links without forces: Mc / I between them, and no bearing."""
    case = {
        "kind": "given",
        "forces": {"L": [0, 0], "R": [0, 0]},
        "moments": {"L": [0, 50_000, 0], "R": [0, -50_000, 0]},
    }
    results = run(study_from(study() | {"case": {"twist": case}}))
    found = {m.margin.method: m.margin for m in results.margins if not m.margin.needs}
    assert found["bending"].demand == pytest.approx(50_000.0 / (math.pi / 32.0 * 16.0**3), rel=1e-3)
    assert "EN 1993 bending" in found
    assert "bearing" not in found


def test_lugs_of_a_pin_under_couples_need_the_contact() -> None:
    """Without a force across the pin nothing was said of their stress."""
    moments = {"L": [0, 50_000, 0], "R": [0, -50_000, 0]}
    case = {"kind": "given", "forces": {"L": [0, 0], "R": [0, 0]}, "moments": moments}
    changed = study() | {"case": {"twist": case}}
    shanked = {
        "material": "steel",
        "outer_diameter": 40.0,
        "shank": {"width": 40.0, "length": 60.0},
    }
    pin = {**changed["pin"]["P"], "lug": {"L": shanked, "R": shanked}}
    analysis = {**changed.get("analysis", {}), "joints": "prescribed"}
    results = run(study_from({**changed, "analysis": analysis, "pin": {"P": pin}}))
    assert CONTACT_NEED in {m.margin.needs for m in results.margins}


def test_fitting_factor_divides_and_is_not_an_assumption_when_given() -> None:
    plain = run(study_from(study()))
    fitted = run(study_from(study(limit_factor=1.0, ultimate_factor=1.5, fitting_factor=1.15)))
    for before, after in zip(plain.margins, fitted.margins, strict=True):
        assert after.used == pytest.approx(1.15 * before.used)
    assert [a for a in plain.assumptions if "ultimate_factor 1.5" in a]
    assert not [a for a in fitted.assumptions if "factor" in a]


def test_the_governing_check_and_those_for_want_of_data() -> None:
    results = run(study_from(study({"yield_strength": "235 MPa"})))
    (worst,) = governing(results)
    made = [m for m in results.margins if not m.margin.needs and m.margin.method != YIELD_METHOD]
    assert worst.used == max(m.used for m in made)
    assert set(skipped(results)) == {
        f"material.steel.{which}_strength" for which in ("ultimate", "shear", "bearing")
    }
    nothing = run(study_from(study({})))
    assert governing(nothing) == []
    assert all(m.margin.needs for m in nothing.margins)


def test_instants_of_a_table(tmp_path: Path) -> None:
    """The second instant is largest; the time of a check is its own, in the study's unit."""
    (tmp_path / "t.csv").write_text(
        "connection,fx,fy,time\n"
        + "".join(
            f"{name},{part * f},0,{t}\n"
            for t, f in ((0, 100.0), (0.5, 5000.0), (1, 200.0))
            for name, part in (("L", -0.5), ("M", 1.0), ("R", -0.5))
        )
    )
    swept = {**study(), "case": {"pull": {"kind": "given", "table": "t.csv"}}}
    found = run(study_from(swept, folder=tmp_path)).margins
    still = run(study_from(study())).margins
    assert {m.margin.time for m in found if not m.margin.needs} == {0.5}
    assert [m.used for m in found] == pytest.approx([m.used for m in still])


def test_a_pin_in_two_lugs_of_a_structure_is_a_beam_on_two_supports() -> None:
    """The lugs left and right are the structure's: half of the force each. Those of three lugs are
    the joint's.
    """
    bare = {**STUDY["pin"]["P"], "lug": {"left": {}, "right": {}, "M": {"outer_diameter": 40}}}
    profile = [dict(segment) for segment in bare["profile"]]
    for k, name in ((0, "left"), (4, "right")):
        profile[k] = {"length": 8, "diameter": 16, "name": name}
    pulled = {"pull": {"kind": "given", "forces": {"M": [5000, 0]}}}
    changed = {**study(model="auto", joints="foundation"), "case": pulled}
    results = run(study_from({**changed, "pin": {"P": {**bare, "profile": profile}}}))
    found = {(m.margin.method, m.margin.level): m.margin for m in results.margins}
    even = found["EN 1993 bending, for comparison", "ultimate"]
    assert even.demand == pytest.approx(5000.0 * 35.0 / 8.0)
    (arms,) = results.arms
    assert arms.layout == "double shear"
    assert arms.model == "foundation"
    assert arms.joint is not None
    assert arms.joint < arms.concentrated
    governs = found["EN 1993 bending", "ultimate"]
    assert governs.basis == "joint model"
    assert governs.demand == pytest.approx(arms.joint)
    analysis = {**changed["analysis"], "bending_moment": "formula"}
    strict = run(
        study_from({**changed, "analysis": analysis, "pin": {"P": {**bare, "profile": profile}}})
    )
    found = {(m.margin.method, m.margin.level): m.margin for m in strict.margins}
    assert found["EN 1993 bending", "ultimate"].demand == even.demand
    assert not found["EN 1993 bending, for comparison", "ultimate"].governs
    profile.append({"length": 8, "diameter": 16, "name": "third"})
    three = {**bare, "profile": profile, "lug": {**bare["lug"], "third": {}}}
    solved = run(study_from({**changed, "pin": {"P": three}}))
    assert not [key for key in skipped(solved) if "left, right, third" in key]
    assert "EN 1993 bending" in {m.margin.method for m in solved.margins if m.margin.governs}


@each(
    ("material", "analysis", "code"),
    [
        (
            {"yield_strength": "400 MPa", "ultimate_strength": "360 MPa"},
            {},
            "strengths-out-of-order",
        ),
        ({"ultimate_strength": 360, "shear_strength": 361}, {}, "strengths-out-of-order"),
        ({"ultimate_strength": 0}, {}, "not-positive"),
        ({}, {"ultimate_factor": 0.9}, "factors-out-of-order"),
        ({}, {"fitting_factor": 0.9}, "out-of-range"),
        ({}, {"limit_factor": 0}, "out-of-range"),
    ],
)
def test_bad_input(material: dict[str, Any], analysis: dict[str, Any], code: str) -> None:
    with pytest.raises(InputError) as caught:
        study_from(study(material, **analysis))
    assert caught.value.code == code


@each(
    ("strength", "required", "strict", "status"),
    [(235, "", True, 0), (60, "", True, 4), (60, "", False, 0), (235, 9.0, True, 4)],
)
def test_exit_status_and_files(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    strength: float,
    required: float | str,
    strict: bool,
    status: int,
) -> None:
    text = (
        'title = "t"\nunits = "mm-N-s"\n[material.steel]\nyoungs_modulus = "210 GPa"\n'
        f"poisson_ratio = 0.3\nyield_strength = {strength}\n[analysis]\n"
        'model = "beam"\njoints = "prescribed"\ntolerance = 0.9\n'
        + (f"required_safety_factor = {required}\n" if required else "")
        + '[case.pull]\nkind = "given"\n'
        "forces = { L = [-2500, 0], M = [5000, 0], R = [-2500, 0] }\n"
        '[pin.P]\nmaterial = "steel"\nprofile = [{ length = 8, diameter = 16, connection = "L" },'
        "{ length = 1, diameter = 16 }, "
        '{ length = 15, diameter = 16, connection = "M" }, { length = 1, diameter = 16 }, '
        '{ length = 8, diameter = 16, connection = "R" }]\n'
    )
    (tmp_path / "s.toml").write_text(text)
    command = ["run", str(tmp_path / "s.toml"), "--out", str(tmp_path / "out"), "--vtk", "none"]
    assert run_command_line(command + ["--fail-on-miss"] * strict) == status
    assert ("Negative margin" in capsys.readouterr().err) == (strict and strength == 60)
    rows = list(csv.DictReader((tmp_path / "out" / "margins.csv").read_text("utf-8").splitlines()))
    listed = json.loads((tmp_path / "out" / "results.json").read_text())["margins"]
    assert [float(r["margin"]) if r["margin"] else None for r in rows] == [
        m["margin"] for m in listed
    ]
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert 'id="margins"' in page


@pytest.mark.long
@pytest.mark.slow
def test_past_yield_from_the_study_to_the_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A stub that bends and stays bent: bracket, margin of collapse at ultimate load, field."""
    monkeypatch.chdir(tmp_path)
    profile = [
        {"length": 40, "diameter": 20},
        {"length": 10, "diameter": 20, "connection": "L"},
    ]
    given = {
        **study({"yield_strength": "235 MPa"}, limit_load="always"),
        "pin": {"P": {"material": "steel", "clamp": ["start"], "profile": profile}},
        "case": {"pull": {"kind": "given", "forces": {"L": [4500, 0]}}},
    }
    Path("study.toml").write_text(study_from(given).text)
    assert run_command_line(["run", "study.toml", "--out", "out"]) == 0
    written = json.loads(Path("out/results.json").read_text())
    (limit,) = [p["limit_load"] for p in written["pins"]]
    assert (limit["method"], limit["carries"]) == ("solid", True)
    assert 1.0 < limit["lower"] < limit["upper"]
    assert limit["upper"] - limit["lower"] <= 0.025 * (limit["upper"] + limit["lower"])
    assert all(mesh["charge"] > 0.0 for mesh in limit["meshes"])
    (row,) = [m for m in written["margins"] if m["method"] == "limit load, collapse"]
    assert row["margin"] == pytest.approx(limit["lower"] / 1.5 - 1.0)
    assert Path("out/vtk/P_pull.limit-load.vtu").is_file()


@pytest.mark.slow
def test_a_pin_held_in_a_hole_has_the_margins_of_its_model_alone() -> None:
    """The profile knows nothing of the hole, so no formula gives the forces."""
    pin = {
        "material": "steel",
        "clamp": ["hole 1"],
        "profile": [
            {"length": 20, "diameter": 20},
            {"length": 20, "diameter": 20, "connection": "M"},
        ],
        "hole": [{"z": 10, "diameter": 10}],
    }
    case = {"kind": "given", "forces": {"M": [5000, 0]}}
    tree = study(model="solid") | {"pin": {"P": pin}, "case": {"pull": case}}
    results = run(study_from(tree))
    (row,) = results.pins
    assert row.max_von_mises is not None
    assert {m.kind for m in row.margins if m.margin is not None} == {"model"}
    needs = [m.needs for m in row.worst if m.needs]
    assert any("the force that the clamp takes in hole 1" in text for text in needs), needs

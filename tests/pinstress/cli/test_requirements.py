"""[[require]] from the study to exit status, files and JUnit XML.

The pin of tests/reports/test_requirements.py: double shear, 12.434 MPa; its factor against yield is
about 4 by a beam, whose error and unknown lugs leave 2.2 to 9.4. Steel of 235 MPa, with all
strengths.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, parse

import pytest

from assess.plastic.solve import MESH_SIZES
from pinstress import Engine, run, study_from
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import Study
from reports.data.headline import worst_checks
from reports.data.requirements import requirement_rows
from reports.format.words import headline
from tests.pinstress.analysis.test_margins import STRENGTHS, study
from tests.support.each import each

YIELD_ALONE = {"yield_strength": "235 MPa"}


def required(
    *requirements: dict[str, Any], material: dict[str, Any] = STRENGTHS, **analysis: Any
) -> Study:
    return study_from({**study(material, **analysis), "require": list(requirements)})


def command(given: Study, folder: Path, *options: str) -> int:
    path = folder / "s.toml"
    path.write_text(given.text, encoding="utf-8")
    out = ["--out", str(folder / "out"), "--vtk", "none"]
    return run_command_line(["run", str(path), *out, *options])


@each(
    ("requirement", "strict", "status", "message"),
    [
        ({"check": "yield", "factor": 2}, True, 0, ""),
        ({"check": "yield", "factor": 12}, True, 4, "Required factor missed: P (pull)."),
        ({"check": "yield", "factor": 12}, False, 0, "--fail-on-miss makes it 4"),
        ({"check": "yield", "level": "proof", "factor": 12}, True, 4, "Required factor missed"),
        ({"check": "rupture", "factor": 40}, True, 4,
         "Requirement missed: P (pull): rupture at ultimate load, factor "),
        ({"check": "shear", "factor": 9}, True, 4,
         "Requirement missed: P (pull): shear at limit load, factor 8.18, 9 required."),
        ({"check": "shear", "factor": 8}, True, 0, ""),
        ({"check": "bearing", "level": "ultimate", "factor": 26}, True, 4, "factor 25.9, 26 req"),
        ({"check": "fatigue", "factor": 2}, True, 1,
         "Requirement not checked: fatigue life (needs fatigue): P."),
        ({"check": "rupture", "factor": 1}, False, 0, ""),
    ],
)  # fmt: skip
def test_exit_status(
    tmp_path: Path, capsys: pytest.CaptureFixture[str],
    requirement: dict[str, Any], strict: bool, status: int, message: str,
) -> None:  # fmt: skip
    assert command(required(requirement), tmp_path, *["--fail-on-miss"] * strict) == status
    said = capsys.readouterr()
    assert message in said.err
    if not message:
        assert "equirement" not in said.err


def test_what_is_stated_but_not_checked_is_never_green(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without [[require]] a missing strength is a note; with it the status is 1."""
    rupture = {"check": "rupture", "factor": 1.5}
    assert command(required(material=YIELD_ALONE), tmp_path) == 0
    assert command(required(rupture, material=YIELD_ALONE), tmp_path) == 1
    said = capsys.readouterr()
    text = "Requirement not checked: rupture at ultimate load (needs material.steel.ultimate_str"
    assert text in said.err
    results = run(required(rupture, material=YIELD_ALONE))
    assert headline(results).startswith("Whether pin P is safe is not decided: rupture at ultimate")
    assert worst_checks(results)["P"].outcome == "not decided"


def test_no_row_is_safe_that_misses_a_stricter_requirement() -> None:
    for level in ("limit", "proof"):
        strict = {"check": "yield", "level": level, "factor": 12.0}
        results = run(required(strict, required_safety_factor=1.5))
        (row,) = results.pins
        assert (row.required, row.outcome, row.meets_required) == (12.0, "fails", False)
        assert headline(results).endswith(" < 12 required (pull).")
        found = {(r.level, r.check): r for r in requirement_rows(results) if r.stated}
        assert found[level, "yield"].outcome == "missed"
        if level == "proof":
            assert found["limit", "yield"].outcome == "met"
    lax = run(required({"check": "yield", "factor": 1.2}, required_safety_factor=5.0))
    assert (lax.pins[0].required, lax.pins[0].outcome) == (1.2, "safe")


def test_the_files_have_the_requirements(tmp_path: Path) -> None:
    given = required({"check": "yield", "factor": 12}, {"check": "shear", "factor": 2})
    assert command(given, tmp_path) == 0
    written = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    rows = written["requirements"]
    assert list(rows[0]) == ["pin", "case", "level", "check", "required", "reached", "outcome",
                             "needs", "stated", "over"]  # fmt: skip
    first = rows[0]
    assert (first["pin"], first["case"], first["level"]) == ("P", "pull", "limit")
    assert (first["check"], first["required"], first["outcome"]) == ("yield", 12.0, "missed")
    assert first["reached"] == pytest.approx(written["pins"][0]["safety_factor"])
    listed = (tmp_path / "out" / "requirements.csv").read_text(encoding="utf-8")
    table = list(csv.DictReader(listed.splitlines()))
    assert [r["check"] for r in table] == [r["check"] for r in rows]
    assert [float(r["reached"]) for r in table] == [r["reached"] for r in rows]
    assert table[0]["stated"] == "yes"


def test_a_choice_of_pins_and_cases_is_no_failure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A requirement on what was left out is not checked, but was not asked for either."""
    tables: dict[str, Any] = study()
    tables["pin"] = {**tables["pin"], "Q": {**tables["pin"]["P"]}}
    profile = [
        {**s, "connection": s["connection"] * 2} if "connection" in s else s
        for s in tables["pin"]["P"]["profile"]
    ]
    tables["pin"]["Q"]["profile"] = profile
    forces = {"LL": [-2500, 0], "MM": [5000, 0], "RR": [-2500, 0]}
    pull = tables["case"]["pull"]
    tables["case"] = {
        "pull": {**pull, "forces": {**pull["forces"], **forces}}, "push": {**pull},
    }  # fmt: skip
    tables["require"] = [
        {"pins": ["P", "Q"], "cases": ["pull"], "check": "rupture", "factor": 1.5},
        {"pins": ["P"], "cases": ["push"], "check": "shear", "factor": 1.5},
    ]
    given = study_from(tables)
    assert command(given, tmp_path, "--pins", "P", "--cases", "pull", "--fail-on-miss") == 0
    assert "equirement" not in capsys.readouterr().err
    written = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    found = {(r["pin"], r["case"], r["check"]): r for r in written["requirements"] if r["stated"]}
    assert found["P", "pull", "rupture"]["outcome"] == "met"
    for key, needs in (
        (("Q", "pull", "rupture"), "pin Q to be run"),
        (("P", "push", "shear"), "case push to be run"),
    ):
        assert (found[key]["outcome"], found[key]["needs"]) == ("not checked", needs)


def test_a_stored_answer_has_no_stale_outcome(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Requirements that change are judged anew, where pins come from the cache, too."""
    monkeypatch.setenv("PINSTRESS_CACHE", str(tmp_path / "cache"))
    for requirement, outcome in (
        ({"check": "yield", "factor": 2.0}, "met"),
        ({"check": "yield", "factor": 12.0}, "missed"),
        ({"check": "rupture", "factor": 40.0}, "missed"),
        ({"check": "rupture", "factor": 2.0}, "met"),
        ({"check": "yield", "factor": 2.0}, "met"),
    ):
        command(required(requirement), tmp_path)
        written = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
        rows = [r for r in written["requirements"] if r["check"] == requirement["check"]]
        assert [r["outcome"] for r in rows if r["stated"]] == [outcome]


def test_an_engine_answers_with_other_factors() -> None:
    engine = Engine(required({"check": "yield", "factor": 2.0}, {"check": "rupture", "factor": 2}))
    for factor, outcome in ((2.0, "safe"), (12.0, "fails"), (2.0, "safe")):
        assert engine.answer({"require[1].factor": factor}).pins[0].outcome == outcome
    rows = requirement_rows(engine.answer({"require[2].factor": 40.0}))
    assert [r.outcome for r in rows if r.check == "rupture" and r.stated] == ["missed"]


def cases(element: Element) -> dict[str, Element]:
    found = {case.get("name", ""): case for case in element.iter("testcase")}
    assert len(found) == len(list(element.iter("testcase")))
    return found


def test_junit(tmp_path: Path) -> None:
    given = required(
        {"check": "yield", "factor": 2}, {"check": "shear", "factor": 9},
        {"check": "rupture", "factor": 1.2}, material=YIELD_ALONE,
    )  # fmt: skip
    file = tmp_path / "junit.xml"
    assert command(given, tmp_path, "--junit", str(file)) == 1
    root = parse(file).getroot()
    assert root.tag == "testsuites"
    (suite,) = root
    assert suite.tag == "testsuite"
    for element in (root, suite):
        for key, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
            assert int(element.get(key, "-1")) == len(list(element.iter(tag)))
        assert int(element.get("tests", "-1")) == len(list(element.iter("testcase")))
    rows = json.loads((tmp_path / "out" / "results.json").read_text("utf-8"))["requirements"]
    found = cases(root)
    assert len(found) == len(rows)
    assert list(found["yield at limit load, pull"]) == []
    (missed,) = found["shear at limit load, pull"]
    assert missed.tag == "failure"
    assert missed.get("message") == "missed: shear at limit load, factor 8.18, 9 required"
    (skipped,) = found["rupture at ultimate load, pull"]
    assert skipped.tag == "skipped"
    assert "needs material.steel.ultimate_strength" in (skipped.get("message") or "")
    assert {case.get("classname") for case in found.values()} == {"s.P"}
    assert command(given, tmp_path, "--junit", str(file)) == 1  # its own file may be replaced


@each(
    ("place", "message"),
    [
        ("out/junit.xml", "is inside the output folder"),
        ("nowhere/junit.xml", "there is no folder"),
        ("s.toml", "exists and has no JUnit results"),
        (".", "is a folder"),
    ],
)
def test_junit_never_harms_other_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], place: str, message: str
) -> None:
    given = required({"check": "yield", "factor": 2})
    assert command(given, tmp_path, "--junit", str(tmp_path / place)) == 2
    assert message in capsys.readouterr().err
    assert (tmp_path / "s.toml").read_text(encoding="utf-8") == given.text
    assert not (tmp_path / "out").exists()


def test_check_lists_what_is_required(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = required(
        {"pins": ["P"], "cases": ["pull"], "check": "rupture", "factor": 1.5},
        {"check": "fatigue", "factor": 4},
    )
    (tmp_path / "s.toml").write_text(given.text, encoding="utf-8")
    assert run_command_line(["check", str(tmp_path / "s.toml")]) == 0
    said = capsys.readouterr().out
    assert "requires rupture at ultimate load, factor 1.5: pin P in pull\n" in said
    assert "requires fatigue, factor 4: all pins\n" in said


@pytest.mark.slow
def test_a_required_limit_load_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stub whose factors against yield and collapse are 1.37 and 2.8, on two meshes: also
    where it does not yield, of which no limit load is computed otherwise.
    """
    monkeypatch.setattr("assess.plastic.solve.MESH_SIZES", MESH_SIZES[:2])
    profile = [
        {"length": 40, "diameter": 20},
        {"length": 10, "diameter": 20, "connection": "L"},
    ]
    pins = {"P": {"material": "steel", "clamp": ["start"], "profile": profile}}
    pull = {"kind": "given", "forces": {"L": [3000, 0]}}
    given = {**study(STRENGTHS), "pin": pins, "case": {"pull": pull}}
    for factor, outcome in ((1.5, "met"), (4.0, "missed")):
        need = {"check": "limit load", "factor": factor}
        results = run(study_from({**given, "require": [need]}))
        (row,) = [r for r in requirement_rows(results) if r.check == "limit load" and r.stated]
        assert row.outcome == outcome
        limit = results.pins[0].limit_load
        assert limit is not None
        assert limit.method == "solid"
        assert row.reached == limit.lower
    assert run(study_from(given)).pins[0].limit_load is None


def test_compare_ends_with_4_where_a_requirement_was_lost(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shear = {"check": "shear", "factor": 8}
    folders = []
    for name, requirements in (
        ("both", ({"check": "yield", "factor": 2}, shear)),
        ("stricter", ({"check": "yield", "factor": 2}, {**shear, "factor": 9})),
        ("one", ({"check": "yield", "factor": 2},)),
    ):
        (tmp_path / name).mkdir()
        command(required(*requirements), tmp_path / name)
        folders.append(str(tmp_path / name / "out"))
    both, stricter, one = folders
    capsys.readouterr()
    for first, second, status, sentence, message in (
        (both, both, 0, "No factor of a pin changed; no requirements newly met, none lost.", ""),
        (both, stricter, 4, "no requirements newly met, one lost.",
         "Requirement lost: P (pull): shear at limit load.\n"),
        (stricter, both, 0, "no requirements newly met, none lost, one asking for less.", ""),
        (both, one, 0, "one asking for less.", ""),  # the factor on limit loads still asks for 1
    ):  # fmt: skip
        assert run_command_line(["compare", first, second]) == status
        said = capsys.readouterr()
        assert sentence in said.out.partition("\nA: ")[0].replace("\n", " ").replace("  ", " ")
        assert said.err == message
    fatigue = required({"check": "yield", "factor": 2}, {"check": "fatigue", "factor": 2})
    (tmp_path / "fatigue").mkdir()
    command(fatigue, tmp_path / "fatigue")
    capsys.readouterr()
    assert run_command_line(["compare", str(tmp_path / "fatigue" / "out"), one]) == 4
    assert "Requirement gone: P: fatigue life.\n" in capsys.readouterr().err

"""The command `size`: its search, its edit of the study, and that a run confirms what it claims."""

from __future__ import annotations

import json
import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assess.judgement import SAFE
from fea.harmonic.evaluate import SECTION_MESHES
from pinstress import study_from
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.remedies.secant import FACTOR_TOLERANCE, MAX_TRIALS, NoSizeError, smallest
from pinstress.analysis.results import run
from pinstress.analysis.solve import judged
from pinstress.analysis.stored import PinOutcome
from pinstress.cli.commands import run_command_line
from pinstress.explore.size.judged_pin import JudgedPin
from pinstress.explore.size.pin_answers import CLEAR_RATIO, PinAnswer, SizedStudy, Tell
from pinstress.explore.size.scaled_study import moved, resized_study
from pinstress.explore.size.section_law import Accuracy
from pinstress.explore.size.size_pin import SizingGoal, SizingResult, size_pin
from pinstress.explore.size.size_pins import loaded_more
from pinstress.explore.size.standard_diameters import StandardDiameters
from pinstress.study.model.pins import pin, weight
from pinstress.study.reading.file import load_study, parse_study
from pinstress.study.schema.units import UNIT_SYSTEMS
from reports.data.decision import factor_ends
from tests.conftest import ROOT
from tests.pinstress.analysis.test_scaled import STUDY as THREE_LUGS
from tests.pinstress.analysis.test_scaled import TWO_CASES
from tests.support.described import describe
from tests.support.each import each
from tests.support.pins.studies import resized_text
from tests.support.programs.command_line import ONE_PIN, QUICK, Refused, sizes_nothing


@given(
    bending=st.floats(1e-3, 1e3),
    tension=st.floats(1e-3, 1e3),
    required=st.floats(0.5, 100.0),
)
def test_the_search_finds_the_root(bending: float, tension: float, required: float) -> None:
    """Stress a / s^3 + b / s^2 has one root; the scale is no smaller and little larger."""
    tried: list[float] = []

    def factor_at(scale: float) -> float:
        tried.append(scale)
        return 1.0 / (bending / scale**3 + tension / scale**2)

    try:
        found = smallest(factor_at, required)
    except NoSizeError:
        assert not 1.0 / required < bending / 0.05**3 + tension / 0.05**2 or (
            1.0 / required < bending / 20.0**3 + tension / 20.0**2
        )
        return
    assert found.scale in tried
    assert found.factor == factor_at(found.scale)
    assert required <= found.factor <= required * (1.0 + FACTOR_TOLERANCE)
    assert len(tried) <= MAX_TRIALS + 1


def test_the_search_gets_along_with_noise() -> None:
    """A factor known to 1 % only, so that it does not grow steadily: what is found is reached."""
    found = smallest(lambda s: 40.0 * s**3 * (1.0 + 0.01 * math.sin(900.0 * s)), 10.0)
    assert found.factor >= 10.0
    assert found.scale == pytest.approx(0.25 ** (1.0 / 3.0), rel=0.01)


def test_a_factor_that_does_not_grow_is_told() -> None:
    with pytest.raises(NoSizeError, match=r"factor is 2 and hardly grows"):
        smallest(lambda _: 2.0, 10.0)


def test_only_diameters_change_and_comments_stay() -> None:
    text = resized_text(ONE_PIN, {"B": 1.5}, UNIT_SYSTEMS["in-lbf-s"])
    changed = {
        old: new
        for old, new in zip(ONE_PIN.splitlines(), text.splitlines(), strict=True)
        if old != new
    }
    assert {" ".join(new.split()) for new in changed.values()} == {
        '{ length = 1.5, diameter = 6.0, name = "root" },',
        '{ length = 2.0, diameter = 3.0, connection = "B" }, # the band loaded by link B',
        "fillet = 0.6 # radius at every inner corner; default 0: sharp",
    }
    assert resized_text(ONE_PIN, {"B": 1.0}, UNIT_SYSTEMS["in-lbf-s"]) == ONE_PIN


def test_units_provenance_and_rounding() -> None:
    """In the unit in which it was written; up to a step, bores and fillets down."""
    text = """
[pin.B]
fillet = { value = "1.03 mm", provenance = "given" }
profile = [
  { length = 1.0, diameter = "100 mm", bore = 1.0, provenance = "assumed", note = "n" },
  { length = 1.0, diameter = 3.0 },
]
flat = [{ z = [0.0, 1.0], distance = 1.23456 }]
hole = [{ z = 1.0, diameter = 0.5 }]
"""
    step = StandardDiameters(step=5e-3)
    pin = tomllib.loads(resized_text(text, {"B": 1.11}, UNIT_SYSTEMS["in-lbf-s"], step, 4.0))
    first, second = pin["pin"]["B"]["profile"]
    assert first["diameter"] == {
        "value": "115 mm",
        "provenance": "derived",
        "note": "by pinstress size, from 100 mm",
    }
    assert first["bore"]["value"] == 1.11
    assert (first["length"], first["note"], second["length"]) == (1.0, "n", 1.0)
    assert second["diameter"] == pytest.approx(85.0 / 25.4)  # 84.58 mm
    assert pin["pin"]["B"]["fillet"]["value"] == "1.143 mm"  # of 1.1433
    assert pin["pin"]["B"]["flat"][0]["distance"] == 1.371  # of 1.37036
    assert pin["pin"]["B"]["hole"][0]["diameter"] == 0.5
    assert pin["analysis"]["required_safety_factor"] == 4.0


@pytest.mark.parametrize(
    "fillet", ["fillet = 2\n", 'fillet = { value = "2 mm", provenance = "given" }\n']
)
def test_a_fillet_as_large_as_its_step_fits_after_rounding(fillet: str) -> None:
    """Diameters are rounded up, some more than others: the step grows less than its fillet."""
    text = ONE_PIN.replace('units = "in-lbf-s"', 'units = "mm-N-s"')
    text = text.replace("diameter = 4.0", "diameter = 24").replace(
        "diameter = 2.0", "diameter = 20"
    )
    text = text.replace("length = 2.0", "length = 30")
    assert "fillet = 0.4 " in text
    text = text.replace("fillet = 0.4 ", f"{fillet}#")
    system = UNIT_SYSTEMS["mm-N-s"]
    for scale in (*[0.9 + 0.0123 * k for k in range(40)], 1.0):
        new = resized_text(text, {"B": scale}, system)
        thick, thin = (s["diameter"] for s in tomllib.loads(new)["pin"]["B"]["profile"])
        radius = parse_study(Path("B.toml"), new).table.pin["B"].fillet * 1e3
        assert 0.997 * scale * 2.0 < radius <= 0.5 * (thick - thin) * (1.0 + 1e-9)
        pin(parse_study(Path("B.toml"), new), "B")  # which refuses fillets that do not fit


def test_every_shipped_profile_can_be_resized() -> None:
    for path in sorted((ROOT / "studies").glob("*.toml")):
        text = path.read_text()
        study = parse_study(path, text)
        scales = {name: 1.3 for name, pin in study.table.pin.items() if pin.profile}
        again = parse_study(path, resized_text(text, scales, study.system)).table
        for name in scales:
            old, new = study.table.pin[name].profile or [], again.pin[name].profile or []
            for a, b in zip(old, new, strict=True):
                assert a.length == b.length
                for d, wider in zip(a.diameters, b.diameters, strict=True):
                    assert 1.3 * d <= wider * (1.0 + 1e-12) <= 1.3 * d * 1.002
        assert again.case.keys() == study.table.case.keys()


FILES = [path for path in sorted((ROOT / "studies").glob("*.toml")) if ".csv" in path.read_text()]


@each("path", FILES)
def test_a_study_written_elsewhere_names_the_same_files(path: Path, tmp_path: Path) -> None:
    study = load_study(path)
    target = tmp_path / "deep" / "new.toml"
    target.parent.mkdir()
    target.write_text(moved(study.text, path.parent, target.parent))
    assert (
        describe(load_study(target))[0].partition(":")[2] == (describe(study)[0].partition(":")[2])
    )
    assert moved(study.text, path.parent, path.parent) == study.text


def test_tables_that_state_their_columns_are_named_from_elsewhere_too(tmp_path: Path) -> None:
    """One, and several: the new study named them as if they lay beside it."""
    text = """
[case.one]
table = { file = "a.csv", B.fx = "x" }

[[case.two.table]]
file = "b.csv"

[[case.two.table]]
file = "c.xlsx"
sheet = "file"
"""
    (tmp_path / "deep").mkdir()
    case = tomllib.loads(moved(text, tmp_path, tmp_path / "deep"))["case"]
    assert case["one"]["table"] == {"file": "../a.csv", "B": {"fx": "x"}}
    assert case["two"]["table"] == [{"file": "../b.csv"}, {"file": "../c.xlsx", "sheet": "file"}]


def test_a_stated_weight_changes_with_the_shape() -> None:
    """By as much as the pin's own; not that of a pin fixed in a link, which is part of the link."""
    study = load_study(ROOT / "studies" / "grenier2008.toml")
    new = resized_study(study, {"J": 1.5, "B": 1.5})
    before, after = study.table.mechanism, new.table.mechanism
    assert before is not None
    assert after is not None
    density = study.table.material["AISI 4340"].density or 0.0
    more = weight(pin(new, "J"), density) - weight(pin(study, "J"), density)
    stated = [(x.joint["J"].weight or 0.0) for x in (before, after)]
    assert stated[1] > 2.0 * stated[0]
    assert stated[1] - stated[0] == pytest.approx(more, rel=1e-3)
    assert after.body == before.body


@each("stated", [True, False])
def test_a_pin_is_sized_again_for_the_weight_of_another(stated: bool) -> None:
    """Whether the weight of pin J is stated or that of its profile."""
    text = (ROOT / "studies" / "grenier2008.toml").read_text(encoding="utf-8")
    weight_of_j = "weight = { value = 7.576721476472222,"
    assert weight_of_j in text
    text = text if stated else text.replace(weight_of_j, f"# {weight_of_j}")
    study = parse_study(ROOT / "studies" / "grenier2008.toml", text)
    plan = prepare(study, pins=["A", "J"], cases=["landing"])
    near = JudgedPin("", "", "", "", SAFE, (("landing", 10.0),))
    sized = [
        SizingResult("A", 1.0, None, 10.0, "converged", judged=near, others=(("J", 1.0),)),
        SizingResult("J", 3.0, None, 10.0, "converged", judged=near, others=(("A", 1.0),)),
    ]
    assert "A" in loaded_more(plan, SizingGoal(10.0), sized)


def test_an_eye_that_becomes_too_narrow_grows() -> None:
    """To 1.5 times its bore, or as the study has it where that is less; others stay."""
    study = load_study(ROOT / "studies" / "clevis.toml")
    eye = study.table.pin["P"].lug["EYE"]
    assert eye.outer_diameter == 0.05
    for scale, outer in ((0.5, 0.05), (1.5, 0.05), (2.0, 0.06)):
        new = resized_study(study, {"P": scale}).table.pin["P"].lug["EYE"]
        assert new.outer_diameter == pytest.approx(outer)
        assert new.clearance == eye.clearance


@pytest.mark.slow
def test_a_floating_pin_of_a_linkage_is_sized_and_a_run_confirms_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The tutorial's pin M: its weight is in the loads of every trial; from another folder the
    study still runs. The factor is reached as described, by a run of its own; with prescribed
    loads the range over its joint is left, and said.
    """
    page = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    text = "\n".join(block for block in blocks if "[pin.M.lug" not in block)
    lift, target = tmp_path / "lift.toml", tmp_path / "deep" / "sized.toml"
    target.parent.mkdir()
    lift.write_text(text, encoding="utf-8")
    command = ["size", str(lift), "--out", str(target), "--jobs", "1"]
    assert run_command_line(command) == 1
    said = capsys.readouterr()
    assert "reached as described, but not within the range of the joint" in said.err
    (row,) = run(load_study(target)).pins
    low, _ = factor_ends(row)
    assert 4.0 <= low <= 4.0 * (1.0 + FACTOR_TOLERANCE)
    assert row.outcome == "depends"
    assert f"{row.safety_factor:.2f}" in said.out


def factor(study: str, name: str) -> tuple[float, str]:
    Path(f"{name}.toml").write_text(study)
    run_command_line(["run", f"{name}.toml", "--vtk", "none", "--quiet"])
    (pin,) = json.loads(Path(f"out/{name}/results.json").read_text())["pins"]
    return pin["safety_factor"], pin["verdict"]


def test_a_run_confirms_the_size_and_a_smaller_pin_misses(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK)
    assert run_command_line(["size", "study.toml", "--fos", "20"]) == 0
    said = capsys.readouterr()
    assert "safe" in said.out.split("\n")[1]
    assert "study_sized.toml" in said.err
    sized = Path("study_sized.toml").read_text()
    assert "required_safety_factor = 20.0" in sized
    found, verdict = factor(sized, "again")
    assert verdict == "converged"
    assert 20.0 <= found <= 20.0 * (1.0 + FACTOR_TOLERANCE)
    smaller, _ = factor(resized_text(sized, {"B": 0.99}, UNIT_SYSTEMS["in-lbf-s"]), "smaller")
    assert smaller < 20.0
    assert run_command_line(["size", "study.toml"]) == 2
    assert "study_sized.toml exists already" in capsys.readouterr().err
    (tmp_path / "study_sized.toml").unlink()
    (tmp_path / "study_sized.toml").symlink_to("nowhere.toml")
    assert run_command_line(["size", str(tmp_path / "study.toml")]) == 2
    assert "study_sized.toml exists already" in capsys.readouterr().err


def test_diameters_to_a_step(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """To the next eighth of an inch, in a file of its own, and not smaller than without."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK)
    command = ["size", "study.toml", "--fos", "4", "--step", "0.125", "--out", "s.toml"]
    assert run_command_line([*command, "--quiet"]) == 0
    assert "Written" not in capsys.readouterr().err
    profile = tomllib.loads(Path("s.toml").read_text())["pin"]["B"]["profile"]
    for segment in profile:
        assert segment["diameter"] / 0.125 == round(segment["diameter"] / 0.125)
    found, verdict = factor(Path("s.toml").read_text(), "again")
    assert verdict == "converged"
    assert found >= 4.0


def test_a_singular_pin_is_sized_but_nothing_is_claimed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK.replace("fillet = 0.4 ", "fillet = 0.0 "))
    assert run_command_line(["size", "study.toml", "--fos", "400"]) == 1
    said = capsys.readouterr()
    assert "0 of 1 pin reaches" in said.out
    assert "reached only outside the excluded zones; in landing the stress is singular" in said.err
    found, verdict = factor(Path("study_sized.toml").read_text(), "again")
    assert verdict == "singular"
    assert 400.0 <= found <= 400.0 * (1.0 + FACTOR_TOLERANCE)


def test_a_singular_pin_is_not_made_smaller(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is not shown to hold stays as it is: no study is written."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK.replace("fillet = 0.4 ", "fillet = 0.0 "))
    assert run_command_line(["size", "study.toml"]) == 1
    said = capsys.readouterr()
    assert "unchanged" in said.out
    assert "it is not made smaller, since with 0." in said.err
    assert not Path("study_sized.toml").exists()


@each(
    "refused",
    [
        Refused([], ("required_safety_factor = 10", ""), 2, "--fos 10"),
        Refused(["--step", "2 s"], ("", ""), 2, "--step: '2 s' is not a length"),
        Refused(["--step", "-1"], ("", ""), 2, "--step: must be positive"),
        Refused(["--out", "no/where.toml"], ("", ""), 2, "there is no folder no"),
        Refused(["--out", "study.toml/x.toml"], ("", ""), 2, "study.toml is a file, not a folder"),
        Refused(["--pins", "Q"], ("", ""), 2, "no pin 'Q'"),
        Refused([], ('yield_strength = "225 ksi"', ""), 1, "has no yield_strength"),
        Refused([], ('["start"]', "[]"), 1, "it is unconstrained in case landing"),
        Refused(["--fos", "1e7"], ("", ""), 1, "times its diameters"),
    ],
)
def test_what_cannot_be_sized_is_told(tmp_path: Path, refused: Refused) -> None:
    sizes_nothing(tmp_path, refused)


def test_a_size_whose_error_is_unknown_is_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One mesh does not tell it, and twice the stress is no bound."""
    monkeypatch.chdir(tmp_path)
    coarse = replace(SECTION_MESHES, max_unknowns=1)
    monkeypatch.setattr("fea.harmonic.evaluate.SECTION_MESHES", coarse)
    Path("study.toml").write_text(QUICK)
    assert run_command_line(["size", "study.toml"]) == 1
    assert "the error is unknown in case landing: only one mesh was" in capsys.readouterr().err


def test_cells_and_joint_are_compared_in_the_verification_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A trial needs the stress of the pin as described; a full solution, as a run, its error on
    larger cells and the range of the joint.
    """

    def compared(*_: object) -> None:
        raise AssertionError("the cells are compared")

    monkeypatch.setattr("fea.support.contact.variations.on_coarser_cells", compared)
    plan = prepare(load_study(ROOT / "studies" / "clevis.toml"))
    sized = SizedStudy(plan, "P", 1.5, {})
    accuracies: tuple[Accuracy, ...] = ("rough", "quick")
    for accuracy in accuracies:
        assert sized.quick(1.0, accuracy, None, lambda _: None).trial.factor > 2.0
    with pytest.raises(AssertionError, match="compared"):
        sized.full(1.0, ("pull",), lambda _: None)


def test_cases_that_do_not_count_are_solved_for_the_size_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Beside a case of a hundredth of the force, whose factor is a hundred times as large."""
    light = '\n[case.light]\nkind = "given"\nforces = { B = [0.0, -9.8886] }\n'
    plan = prepare(parse_study(Path("study.toml"), QUICK + light))
    sized, scales = SizedStudy(plan, "B", 10.0, {}), list[float]()
    first = sized.quick(1.0, "quick", None, lambda _: None)
    assert first.counting == ("landing",)
    answer = sized.full(1.0, first.counting, lambda _: None)
    assert answer.solution is not None
    assert [x.case for one in answer.solution.outcomes for x in one.rows] == ["landing"]
    whole = SizedStudy.whole

    def noted(of: SizedStudy, answer: PinAnswer, tell: Tell) -> PinAnswer:
        scales.append(answer.trial.scale)
        return whole(of, answer, tell)

    monkeypatch.setattr(SizedStudy, "whole", noted)
    result = size_pin(plan, "B", SizingGoal(20.0), {})
    assert result.judged is not None
    assert set(scales) == {result.scale}
    factors = dict(result.judged.cases)
    assert 20.0 <= factors["landing"] <= 20.0 * (1.0 + FACTOR_TOLERANCE)
    assert factors["light"] == pytest.approx(100.0 * factors["landing"], rel=0.5)  # by a beam


@each(("ratio", "cells"), [(1.0, ["rough"]), (0.99, ["rough", None])])
def test_rough_cells_decide_only_a_case_that_they_leave_no_doubt_about(
    monkeypatch: pytest.MonkeyPatch, ratio: float, cells: list[str | None]
) -> None:
    """A light case in narrow arcs, solved finely, took a third of the verification of a pin."""
    plan, solved = prepare(study_from(THREE_LUGS + TWO_CASES)), list[str | None]()

    def noted(plan: Plan, *others: Any) -> PinOutcome:
        solved.append(plan.requirement.cells)
        return judged(plan, *others)

    sized = SizedStudy(plan, "P", 2.0, {})
    full = sized.full(1.0, ("pull",), lambda _: None)
    monkeypatch.setattr("pinstress.explore.size.pin_answers.judged", noted)
    least = ratio * CLEAR_RATIO * 2.0
    monkeypatch.setattr("pinstress.explore.size.pin_answers.least_factor", lambda _: least)
    whole = sized.whole(full, lambda _: None)
    assert whole.solution is not None
    _, (light,) = (one.rows for one in whole.solution.outcomes)
    assert (light.case, light.outcome, solved) == ("light", "safe", cells)

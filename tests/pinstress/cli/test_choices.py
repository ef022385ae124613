"""What may be chosen for a run, and what is said otherwise: from Python as on the command line."""

from __future__ import annotations

import inspect
import math
import re
import shlex
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pinstress
from pinbase.processes.pool import processes
from pinstress.analysis.gather.gather import loads_only
from pinstress.cli.commands import run_command_line
from pinstress.cli.shared import names_in
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.errors import raises

STUDY = ROOT / "studies" / "one_pin.toml"
GUARD = 120.0  # s
WRONG: list[tuple[str, Any, str]] = [
    ("jobs", 0, "not-a-count"),
    ("jobs", -3, "not-a-count"),
    ("jobs", True, "not-a-count"),
    ("jobs", 1.5, "not-a-count"),
    ("jobs", "2", "not-a-count"),
    ("tolerance", 0, "out-of-range"),
    ("tolerance", 0.0, "out-of-range"),
    ("tolerance", -1, "out-of-range"),
    ("tolerance", 1.0, "out-of-range"),
    ("tolerance", math.nan, "out-of-range"),
    ("tolerance", math.inf, "out-of-range"),
    ("tolerance", True, "out-of-range"),
    ("tolerance", "0.02", "out-of-range"),
    ("model", "foo", "unknown-model"),
    ("model", "", "unknown-model"),
    ("model", 3, "unknown-model"),
    ("model", ["beam"], "unknown-model"),
    ("pins", [], "empty"),
    ("pins", "B", "not-a-list"),
    ("pins", "AB", "not-a-list"),
    ("pins", b"B", "not-a-list"),
    ("pins", 5, "not-a-list"),
    ("pins", [5], "unknown-pin"),
    ("pins", [["B"]], "unknown-pin"),
    ("pins", ["B", "Q"], "unknown-pin"),
    ("cases", [], "empty"),
    ("cases", "landing", "not-a-list"),
    ("cases", ["landin"], "unknown-case"),
    ("memory_limit", 0.0, "not-positive"),
    ("memory_limit", math.nan, "not-positive"),
    ("memory_limit", "1 GB", "not-positive"),
]


@pytest.fixture(scope="module")
def study() -> Study:
    return pinstress.load_study(STUDY)


@each(("name", "value", "code"), WRONG)
def test_a_wrong_choice_is_one_message(study: Study, name: str, value: Any, code: str) -> None:
    with raises(pinstress.InputError, code) as caught:
        pinstress.run(study, **{name: value})
    assert str(caught.value).startswith(f"{name}: ")
    assert "\n" not in str(caught.value)


def test_no_jobs_is_an_answer_and_no_endless_wait() -> None:
    code = (
        "import pinstress\nstudy = pinstress.load_study('studies/one_pin.toml')\n"
        "try: pinstress.run(study, jobs=0)\nexcept pinstress.InputError as error: print(error)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=GUARD
    )
    assert done.stdout == "jobs: must be a whole number of at least 1, not 0\n"


@each(
    ("arguments", "message"),
    [
        (["run", "--pins", "Q"], "--pins: the study has no pin 'Q'; there are B"),
        (["loads", "--cases", "Q"], "--cases: the study has no case 'Q'"),
        (["chart", "--pin", "Q", "--case", "landing"], "--pin: the study has no pin 'Q'"),
        (["chart", "--pin", "B", "--case", "Q"], "--case: the study has no case 'Q'"),
    ],
)
def test_the_command_line_says_the_same_of_its_options(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    command, *options = arguments
    assert run_command_line([command, str(STUDY), *options]) == 2
    assert capsys.readouterr().err.startswith(f"Error: {message}")
    assert list(tmp_path.iterdir()) == []


@each(
    "arguments",
    [
        "run --tolerance {}",
        "run --jobs {}",
        "run --memory-limit {}",
        "size --fos {}",
        "size --least-weight --wall {}",
        "size --least-weight --shoulder {}",
        "size --least-weight --probability {}",
        "chart --pin B --case landing --time-limit {}",
        "chart --pin B --case landing --meshes {}",
        "curve pin.B.fillet --points {}",
    ],
)
def test_options_take_finite_numbers_in_plain_digits(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    for number in ("nan", "inf", "1e999", "1_0", "0_.3", "\N{ARABIC-INDIC DIGIT THREE}", "0x3", ""):
        command, *options = arguments.split()
        options = [option.format(number) for option in options]
        assert run_command_line([command, str(STUDY), *options]) == 2
        said = capsys.readouterr().err
        assert f"Invalid value for '{options[-2]}': {number!r} is not a valid " in said
    assert list(tmp_path.iterdir()) == []


def test_a_hundred_thousand_names_are_looked_up_at_once(study: Study) -> None:
    with raises(pinstress.InputError, "unknown-pin", "'P0'"):
        pinstress.run(study, pins=[f"P{i}" for i in range(100_000)])
    found = loads_only(study, ["landing"] * 100_000)
    assert [table.case for table in found.reactions] == ["landing"]


@each("wrong", [None, 3, b"study.toml", 1.5, ["study.toml"]])
def test_what_is_no_path_is_no_study(wrong: Any) -> None:
    with raises(pinstress.InputError, "not-a-path"):
        pinstress.load_study(wrong)


def test_a_path_that_no_file_can_have() -> None:
    with raises(pinstress.InputError, "unreadable"):
        pinstress.load_study("a\0b.toml")


def test_a_path_in_place_of_a_study() -> None:
    with pytest.raises(pinstress.InputError, match=r"pinstress\.load_study reads one"):
        pinstress.run("studies/one_pin.toml")  # type: ignore[arg-type]


def test_a_misspelt_argument_is_pythons_error(study: Study) -> None:
    with pytest.raises(TypeError, match="tolerence"):
        pinstress.run(study, tolerence=0.1)  # type: ignore[call-arg]
    kinds = {p.kind for p in inspect.signature(pinstress.run).parameters.values()}
    assert inspect.Parameter.VAR_KEYWORD not in kinds


def test_numpys_numbers_and_any_iterable_are_choices(study: Study) -> None:
    assert processes(np.int64(3)) in (1, 3)  # type: ignore[arg-type]
    found = pinstress.run(study, pins=iter(["B"]), cases={"landing": 1}, tolerance=np.float64(0.3))
    assert [(p.pin, p.case) for p in found.pins] == [("B", "landing")]


def test_a_study_in_place_of_a_plan(study: Study) -> None:
    with raises(pinstress.InputError, "not-a-plan", "pinstress.prepare makes one"):
        pinstress.solve(study)  # type: ignore[arg-type]


def test_an_unknown_accuracy_is_no_quick_answer(study: Study) -> None:
    engine = pinstress.Engine(study)
    for ask in (engine.answer, engine.rows):
        with raises(pinstress.InputError, "unknown-accuracy", "'full' or 'quick', not 'fast'"):
            ask({}, accuracy="fast")  # type: ignore[arg-type]


def test_a_row_that_is_not_there_has_the_names_of_others(study: Study) -> None:
    engine = pinstress.Engine(study)
    for ask in (engine.row, partial(engine.slopes, keys=["pin.B.fillet"])):
        with raises(pinstress.InputError, "unknown-case", "pin B", "'land'", "landing"):
            ask({}, "B", "land")


@each(("pin", "case", "what"), [("Q", "landing", "pin 'Q'"), ("B", "Q", "case 'Q'")])
def test_an_argument_without_a_name_is_not_told_as_an_option(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], pin: str, case: str, what: str
) -> None:
    out = str(tmp_path / "deck.inp")
    arguments = ["export", str(STUDY), pin, case, "--deck", "abaqus", "--out", out]
    assert run_command_line(arguments) == 2
    assert capsys.readouterr().err.startswith(f"Error: the study has no {what}; ")


@each(
    ("text", "names"),
    [
        ("a,b", ["a", "b"]),
        (" b , a,", ["b", "a"]),
        ("lift, cold", ["lift, cold"]),
        ("a,lift, cold,b", ["a", "lift, cold", "b"]),
        ("a,'lift, cold'", ["a", "lift, cold"]),
        ("\"a\",'b'", ["a", "b"]),
        ("'a'", ["'a'"]),
        ("lift, hot", ["lift", "hot"]),
        ("'lift, hot',b", ["lift, hot", "b"]),
        (",", []),
    ],
)
def test_a_name_with_a_comma_is_one_name(text: str, names: list[str]) -> None:
    known = ["a", "b", "lift, cold"] + ["'a'"] * (text == "'a'")
    assert names_in(text, known) == names


def test_a_list_that_is_also_a_name_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`size --pins a,b` sized the pin "a,b" of a study that has pins a and b, too."""
    known = ["a", "b", "a,b"]
    with pytest.raises(InputError) as caught:
        names_in("a,b", known)
    said = [shlex.split(word)[0] for word in re.findall(r"'[^']*'", str(caught.value))]
    assert [names_in(text, known) for text in said] == [["a,b"], ["a", "b"]]


@each("command", ["run", "sweep", "reliability", "loads"])
def test_a_case_with_a_comma_in_its_name_can_be_chosen(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    command: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    text = STUDY.read_text(encoding="utf-8").replace("case.landing", 'case."landing, cold"')
    law = (
        '[vary]\nsample = "sobol"\n[vary.parameters]\n"pin.B.fillet" = { normal = [0.06, 0.01] }\n'
    )
    Path("study.toml").write_text(f"{text}\n{law}", encoding="utf-8")
    assert run_command_line([command, "study.toml", "--cases", "landing, cold,hot"]) == 2
    assert "the study has no case 'hot'; " in capsys.readouterr().err

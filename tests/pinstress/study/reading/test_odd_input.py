"""Input that fuzzing found to end in a traceback or not at all."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from pinstress.cli.commands import run_command_line
from tests.conftest import ROOT
from tests.support.each import each

LONG = [pytest.mark.slow, pytest.mark.long]
ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()


@each(
    ("old", "new", "message"),
    [
        ("length = 1.5", f"length = {'9' * 400}", "too large: the limit is 1e+18"),
        ("length = 1.5", f"length = {'9' * 5000}", "a whole number with too many digits"),
        (
            "length = 1.5",
            f"length = {'[' * 5000}{']' * 5000}",
            "brackets or dots more than 50 deep",
        ),
        ("length = 1.5", f"{'.'.join('a' * 3000)} = 1.5", "brackets or dots more than 50 deep"),
        ('"One pin"', '"a\\u0007b"', "title: has the control character U+0007; remove it"),
        (
            "fillet = 0.4",
            'fillet = { value = 0.4, provenance = "given", note = "\\u001b[2J" }',
            "pin.B.fillet: has the control character U+001B",
        ),
        (
            "forces = { B = [0.0, -988.86] }",
            'table = "gone.csv"',
            "study.toml:26: case.landing.table: ",
        ),
        ("length = 1.5", 'length = "1 m^(9^9^9^9)"', "cannot read the unit"),
        ("length = 1.5", "length = 1e308", "1e+308 is too large: the limit is 1e+18"),
        ("[pin.B]", '[pin."a\\nb"]', "pin.\"a\\nb\": 'a\\nb' has unprintable"),
        (
            "[pin.B]",
            '[pin."\u202eb"]',
            "pin.\"\\u202eb\": '\\u202eb' has unprintable",
        ),
        ("length = 1.5", 'length = "1 9**99999999 m"', "cannot read the unit"),
        ("forces = { B = [0.0, -988.86] }", 'table = "a\\u0000b"', "control character U+0000"),
    ],
)
def test_it_is_one_message(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, message: str
) -> None:
    (tmp_path / "study.toml").write_text(ONE_PIN.replace(old, new))
    assert run_command_line(["check", str(tmp_path / "study.toml")]) == 2
    assert message in capsys.readouterr().err


def test_a_byte_order_mark_is_no_mistake(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(ONE_PIN, encoding="utf-8-sig")
    assert run_command_line(["check", str(tmp_path / "study.toml")]) == 0


def test_another_encoding_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "study.toml").write_text(ONE_PIN.replace("One", "é"), encoding="latin-1")
    assert run_command_line(["check", str(tmp_path / "study.toml")]) == 2
    assert "save it with this encoding" in capsys.readouterr().err


def test_a_crank_that_turns_without_end_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (ROOT / "studies" / "slider_crank.toml").read_text()
    assert '"380 deg"' in text
    (tmp_path / "study.toml").write_text(text.replace('"380 deg"', '"3.8e8 deg"'))
    assert run_command_line(["check", str(tmp_path / "study.toml")]) == 2
    assert "more than 1000 turns" in capsys.readouterr().err


def test_a_folder_whose_name_is_too_long_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "study.toml").write_text(ONE_PIN)
    out = str(tmp_path / ("x" * 300))
    assert run_command_line(["run", str(tmp_path / "study.toml"), "--out", out]) == 2
    assert "File name too long" in capsys.readouterr().err


def test_a_study_of_nothing_lists_all_that_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "study.toml").write_text("")
    assert run_command_line(["check", str(tmp_path / "study.toml")]) == 2
    told = capsys.readouterr().err
    assert [f"{key}: is missing" in told for key in ("title", "units", "case")] == [True] * 3


@pytest.mark.parametrize(
    "length", [0, 40, 3000, *(pytest.param(n, marks=LONG) for n in (1, 200, 1000))]
)
@pytest.mark.parametrize("ending", [".msh", ".step"])
def test_a_file_that_was_cut_off_is_one_message(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], length: int, ending: str
) -> None:
    """A mesh of ours; a STEP file that ends in the middle of its header or is none."""
    whole = (ROOT / "studies" / "failures" / "turned_numbers.msh").read_text()
    if ending == ".step":
        whole = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('a pin'),'2;1');\n" * 100
    text = (ROOT / "studies" / "failures" / "turned_numbers.toml").read_text()
    assert '"turned_numbers.msh"' in text
    (tmp_path / "study.toml").write_text(text.replace("turned_numbers.msh", f"pin{ending}"))
    (tmp_path / f"pin{ending}").write_text(whole[:length])
    assert run_command_line(["check", str(tmp_path / "study.toml")]) == 2
    told = capsys.readouterr().err
    assert told.count("Error") == 1
    assert f"pin{ending}" in told


@each("model", ["auto", "harmonic"])
def test_no_force_makes_no_stress(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], model: str
) -> None:
    """A force of zero, and one whose square is none."""
    for i, force in enumerate(("0.0", "1e-320")):
        study = tmp_path / f"{i}.toml"
        study.write_text(ONE_PIN.replace("-988.86", force))
        out = str(tmp_path / "out")
        asked = ["--model", model, "--jobs", "1", "--out", out, "--json"]
        assert run_command_line(["run", str(study), *asked]) == 0
        (pin,) = json.loads(capsys.readouterr().out)["pins"]
        assert (pin["max_von_mises"], pin["safety_factor"]) == (0.0, None)

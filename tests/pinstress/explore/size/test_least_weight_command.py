"""`size --least-weight` on the command line: what it writes and prints, and what is refused."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

import pinstress
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import load_study
from tests.support.each import each
from tests.support.programs.command_line import QUICK, Refused, sizes_nothing

WITH_LAWS = (
    QUICK
    + """
[vary.parameters]
'material."AISI 4340".yield_strength' = { normal = ["225 ksi", "15 ksi"] }
"""
)


@pytest.mark.slow
def test_a_factor_at_a_probability(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Strength alone is random, so its quantile is that of the factor: 1 - 3.0902 of 15/225."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(WITH_LAWS)
    command = ["size", "study.toml", "--least-weight", "--fos", "4", "--probability", "1e-3"]
    assert run_command_line([*command, "--jobs", "1"]) == 0
    said = capsys.readouterr()
    assert "factor at p" in said.out
    (row,) = pinstress.run(load_study("study_sized.toml")).pins
    assert row.safety_factor is not None
    at = row.safety_factor * (1.0 - 3.0902 * 15.0 / 225.0)
    assert 4.0 <= at <= 4.08


def test_it_is_written_and_a_run_confirms_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Lighter than scaled, with its dimensions, what binds, and links that must follow."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK)
    assert run_command_line(["size", "study.toml", "--least-weight", "--jobs", "1"]) == 0
    said = capsys.readouterr()
    assert "1 of 1 pin reaches the safety factor 10" in said.out
    assert "binding, with multipliers" in said.out
    assert "the bores of its links must follow: B" in said.out
    (row,) = pinstress.run(load_study("study_sized.toml")).pins
    assert 10.0 <= (row.safety_factor or 0.0) <= 10.2


def test_to_a_step_shoulders_stay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK)
    command = ["size", "study.toml", "--least-weight", "--step", "0.25", "--jobs", "1", "--quiet"]
    assert run_command_line(command) == 0
    root, shaft = tomllib.loads(Path("study_sized.toml").read_text())["pin"]["B"]["profile"]
    for segment in (root, shaft):
        assert segment["diameter"] % 0.25 == 0.0
    assert root["diameter"] >= 1.2 * shaft["diameter"]
    (row,) = pinstress.run(load_study("study_sized.toml")).pins
    assert (row.safety_factor or 0.0) >= 10.0


@each(
    "refused",
    [
        Refused([], ("required_safety_factor = 10", ""), 2, "--fos 10"),
        Refused(
            ["--vary", "nuts"], ("", ""), 2, "--vary: 'nuts' is none of diameters, bores, fillets"
        ),
        Refused(["--vary", "bores", "--step", "0.1"], ("", ""), 2, "--step rounds diameters"),
        Refused(["--wall", "0.6"], ("", ""), 2, "--wall"),
        Refused(["--shoulder", "0.9"], ("", ""), 2, "--shoulder"),
        Refused(["--probability", "1e-3"], ("", ""), 2, "the study has no [vary]"),
        Refused(["--probability", "2"], ("", ""), 2, "--probability"),
        Refused(
            ["--vary", "bores"], ("", ""), 1, "it has no bores to vary, only diameters and fillets"
        ),
        Refused([], ('yield_strength = "225 ksi"', ""), 1, "has no yield_strength"),
        Refused([], ('["start"]', "[]"), 1, "it is unconstrained in case landing"),
        Refused(["--fos", "1e7"], ("", ""), 1, "times these dimensions"),
    ],
)
def test_what_cannot_be_had_is_told(tmp_path: Path, refused: Refused) -> None:
    sizes_nothing(tmp_path, refused, "--least-weight", "--jobs", "1")


def test_options_of_least_weight_need_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK)
    assert run_command_line(["size", "study.toml", "--wall", "0.2"]) == 2
    assert "--wall needs --least-weight" in capsys.readouterr().err


def test_a_law_that_does_not_move_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    law = '"pin.B.profile[2].diameter" = { normal = [2.0, 0.01] }\n'
    Path("study.toml").write_text(WITH_LAWS + law)
    command = ["size", "study.toml", "--least-weight", "--probability", "1e-3"]
    assert run_command_line(command) == 2
    assert "its law stays where it is" in capsys.readouterr().err

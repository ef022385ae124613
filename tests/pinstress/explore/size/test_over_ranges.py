"""Sizes that reach the factor over all ranges of a study, as runs of the new study judge them."""

from __future__ import annotations

from pathlib import Path

import pytest

from assess.judgement import DEPENDS, SAFE
from pinstress import changed_study, load_study, run
from pinstress.analysis.remedies.secant import FACTOR_TOLERANCE
from pinstress.cli.commands import run_command_line
from reports.data.decision import low_factor
from tests.conftest import ROOT
from tests.support.programs.command_line import QUICK

GIVEN = 'yield_strength = "225 ksi"'
RANGED = f'{GIVEN}\nrange = {{ yield_strength = ["150 ksi", "250 ksi"] }}'
LOW = {'material."AISI 4340".yield_strength': "150 ksi", 'material."AISI 4340".range': {}}


def test_the_factor_is_reached_with_the_least_strength(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A study with the least strength alone, which knows no range, has that factor and no more."""
    monkeypatch.chdir(tmp_path)
    assert QUICK.count(GIVEN) == 1
    Path("study.toml").write_text(QUICK.replace(GIVEN, RANGED))
    assert run_command_line(["size", "study.toml", "--fos", "20", "--out", "given.toml"]) == 1
    said = " ".join(capsys.readouterr().out.split())
    assert "as described, 0 over its ranges. --over-ranges finds larger pins" in said
    (row,) = run(load_study("given.toml")).pins
    assert row.outcome == DEPENDS
    assert run_command_line(["size", "study.toml", "--fos", "20", "--over-ranges"]) == 0
    assert "--over-ranges" not in capsys.readouterr().out
    sized = load_study("study_sized.toml")
    (row,) = run(sized).pins
    assert row.outcome == SAFE
    (least,) = run(changed_study(sized, LOW)).pins
    low = low_factor(least)
    assert low is not None
    assert 20.0 <= low <= 20.0 * (1.0 + FACTOR_TOLERANCE)


def test_many_steps_of_diameters_are_taken_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each full solution tried the next step only, and six were not enough."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK.replace(GIVEN, RANGED))
    command = ["size", "study.toml", "--fos", "20", "--over-ranges", "--step"]
    assert run_command_line([*command, "0.02 in"]) == 0
    sized = load_study("study_sized.toml")
    (row,) = run(sized).pins
    assert row.outcome == SAFE
    (least,) = run(changed_study(sized, LOW)).pins
    step = 0.02 * 3.0 / 1.0  # the factor grows with the cube of a diameter of more than 1 in
    assert 20.0 <= (low_factor(least) or 0.0) <= 20.0 * (1.0 + step)


@pytest.mark.slow
def test_a_loose_joint_is_counted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A run of the new study finds the pin of the clevis safe in every joint, and hardly more."""
    study, target = str(ROOT / "studies" / "clevis.toml"), tmp_path / "sized.toml"
    command = ["size", study, "--fos", "2", "--over-ranges", "--out", str(target)]
    assert run_command_line(command) == 0
    assert "depends" not in capsys.readouterr().out
    sized = load_study(target)
    (row,) = run(sized).pins
    assert row.outcome == SAFE
    (stricter,) = run(changed_study(sized, {"analysis.required_safety_factor": 2.2})).pins
    assert stricter.outcome == DEPENDS


def test_it_is_for_sizes_in_proportion(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "study.toml"
    path.write_text(QUICK)
    assert run_command_line(["size", str(path), "--over-ranges", "--least-weight"]) == 2
    assert "--over-ranges is not for --least-weight" in capsys.readouterr().err

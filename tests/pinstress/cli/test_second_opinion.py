"""`pinstress run --second-opinion ccx`: without CalculiX, with one that is wrong, and with it."""

from __future__ import annotations

import csv
import json
import os
import subprocess
from pathlib import Path
from unittest.mock import patch

import pytest

from pinstress.cli.commands import run_command_line
from tests.conftest import ROOT
from tests.support.programs.command_line import run_here

ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()


def run(folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    (folder / "study.toml").write_text(ONE_PIN.replace("tolerance = 0.05", "tolerance = 0.3"))
    command = "run study.toml --second-opinion ccx --out out"
    with patch.dict(os.environ, environment):
        return run_here(*command.split(), cwd=folder)


def put(folder: Path, script: str) -> dict[str, str]:
    """The environment with a `ccx` of ours first."""
    (folder / "ccx").write_text(f"#!/bin/sh\n{script}\n")
    (folder / "ccx").chmod(0o755)
    return {"PATH": f"{folder}:{os.environ['PATH']}"}


def opinion(folder: Path) -> dict[str, str]:
    (row,) = csv.DictReader((folder / "out" / "second_opinion.csv").read_text().splitlines())
    return row


def test_without_calculix_it_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Before anything else: the study is not even there."""
    monkeypatch.setenv("PATH", str(tmp_path))
    assert run_command_line(["run", str(tmp_path / "no.toml"), "--second-opinion", "ccx"]) == 2
    told = capsys.readouterr().err
    assert "sudo apt-get install --no-install-recommends calculix-ccx" in told
    assert "no.toml" not in told


@pytest.mark.slow
def test_a_calculix_that_fails_is_told_and_the_results_are_kept(tmp_path: Path) -> None:
    done = run(tmp_path, **put(tmp_path, "echo no luck; exit 201"))
    assert done.returncode == 1
    assert "No second opinion: pin B (landing): ccx ended with status 201" in done.stderr
    assert "CalculiX agrees in 0 of 1 rows" in done.stdout
    row = opinion(tmp_path)
    assert row["agrees"] == "no"
    assert "no luck" in row["note"]
    assert (tmp_path / "out" / "results.json").is_file()


@pytest.mark.slow
def test_a_joint_that_calculix_has_no_model_of_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """With the reason, in results.json too; what takes long is named before it starts."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", put(tmp_path, "exit 1")["PATH"])
    clevis = (ROOT / "studies" / "clevis.toml").read_text()
    tight = clevis.replace("edge_radius = 0.5", "").replace("clearance = 0.05", "clearance = -0.01")
    Path("study.toml").write_text(tight.replace("[analysis]", "[analysis]\ntolerance = 0.1"))
    command = "run study.toml --second-opinion ccx --no-cache --jobs 1 --out out"
    assert run_command_line(command.split()) == 1
    said = capsys.readouterr()
    assert "takes one to ten minutes a row: P (pull)." in said.err
    assert "No second opinion: pin P (pull): CalculiX's model has no interference" in said.err
    assert "not compared" in said.out
    (row,) = json.loads(Path("out/results.json").read_text())["pins"]
    assert row["second_opinion"]["agrees"] is False
    assert "interference" in row["second_opinion"]["note"]
    assert "not compared" in Path("out/report.html").read_text()


@pytest.mark.peers
def test_calculix_agrees(tmp_path: Path) -> None:
    done = run(tmp_path, TMPDIR=str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert "CalculiX agrees in 1 of 1 rows" in done.stdout
    row = opinion(tmp_path)
    assert (row["pin"], row["case"], row["agrees"], row["unit"]) == ("B", "landing", "yes", "psi")
    assert float(row["displacement_difference"]) < 1e-6
    ours, theirs = float(row["max_von_mises_same_mesh"]), float(row["max_von_mises_calculix"])
    assert theirs == pytest.approx(ours, rel=1e-4)
    assert theirs == pytest.approx(float(row["max_von_mises"]), rel=0.2)
    assert not list(tmp_path.glob("pinstress-ccx-*"))  # working files are gone


@pytest.mark.peers
def test_a_calculix_with_another_modulus_is_told(tmp_path: Path) -> None:
    """Its stresses are the same, its displacements are not."""
    real = subprocess.run(["which", "ccx"], capture_output=True, text=True, check=True)
    script = f"sed -i '/ELASTIC/{{n;s/^[^,]*/1e11/}}' job.inp && exec {real.stdout.strip()} \"$@\""
    done = run(tmp_path, **put(tmp_path, script))
    assert done.returncode == 1
    assert "displacements on the same mesh differ by" in done.stderr
    assert "von Mises" not in done.stderr
    assert opinion(tmp_path)["agrees"] == "no"

"""What a run answers: its files, numbers and verdicts, whatever the model and the units."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import pytest

from tests.support.programs.command_line import ONE_PIN, QUICK, pinstress, run_here


@pytest.fixture(scope="module")
def run_once(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, str]:
    folder = tmp_path_factory.mktemp("run")
    (folder / "study.toml").write_text(QUICK)
    done = pinstress("run", "study.toml", cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder, done.stdout, done.stderr


@pytest.mark.seconds
def test_run_writes_what_the_contract_names(run_once: tuple[Path, str, str]) -> None:
    folder, stdout, stderr = run_once
    out = folder / "out" / "study"
    for name in ("results.json", "safety_factors.csv", "safety_factors.md", "reactions.csv",
                 "vtk/B_landing.vtu", "report.html"):  # fmt: skip
        assert (out / name).is_file(), name
    assert sorted(p.name for p in (folder / "out").iterdir()) == ["study"]
    results = json.loads((out / "results.json").read_text())
    assert results["schema"] == "pinstress-results/2"
    assert results["units"] == {"length": "in", "force": "lbf", "stress": "psi", "time": "s"}
    (pin,) = results["pins"]
    assert (pin["pin"], pin["case"], pin["model"]) == ("B", "landing", "harmonic")
    assert pin["verdict"] == "converged"
    assert pin["error_estimate"] <= 0.3 * pin["max_von_mises"]
    assert pin["safety_factor"] == pytest.approx(225e3 / pin["max_von_mises"], rel=1e-12)
    assert pin["meets_required"] is True
    assert pin["yields"] is False
    assert pin["time"] is None
    # the peak of this pin sits in the fillet, on the line through the load
    assert 1.5 < pin["location"][2] < 2.0
    assert "landing" in stdout
    assert "Report: " in stderr
    assert "\x1b" not in stdout + stderr  # no colour, no bar without a terminal


def test_reactions_have_the_contracts_columns(run_once: tuple[Path, str, str]) -> None:
    path = run_once[0] / "out" / "study" / "reactions.csv"
    (row,) = csv.DictReader(path.read_text().splitlines())
    assert list(row) == ["case", "time", "connection", "body", "fx", "fy", "fz", "mx", "my", "mz"]
    assert float(row["fy"]) == pytest.approx(-988.86, rel=1e-14)


def test_moments_reach_the_pin_and_the_tables(tmp_path: Path) -> None:
    """500 lbf in bend a 2 in shaft to 32 M / (pi d^3) = 637 psi, its fillet to somewhat more."""
    text = QUICK.replace("forces = { B = [0.0, -988.86] }", 'moments = { B = ["0 N m", 500.0] }')
    (tmp_path / "study.toml").write_text(text)
    done = run_here("run", "study.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    out = tmp_path / "out" / "study"
    (row,) = csv.DictReader((out / "reactions.csv").read_text().splitlines())
    found = [float(row[k]) for k in ("fx", "fy", "fz", "mx", "my", "mz")]
    assert found == pytest.approx([0.0, 0.0, 0.0, 0.0, 500.0, 0.0])
    (pin,) = json.loads((out / "results.json").read_text())["pins"]
    assert 637.0 < pin["max_von_mises"] < 1.5 * 637.0
    assert 1.5 < pin["location"][2] < 2.0  # in the fillet


def test_a_tolerance_that_is_not_reached_is_status_1(tmp_path: Path) -> None:
    sharp = ONE_PIN.replace("fillet = 0.4 ", "fillet = 0.0 ")
    (tmp_path / "study.toml").write_text(sharp)
    done = run_here("run", "study.toml", cwd=tmp_path)
    assert done.returncode == 1
    last = done.stderr.strip().splitlines()[-1]
    where = "at a sharp corner (shoulder 1 / B)"
    assert last == f"Not decided, singular {where}: B (landing)."
    (pin,) = json.loads((tmp_path / "out" / "study" / "results.json").read_text())["pins"]
    assert pin["verdict"] == "singular"
    assert pin["meets_required"] is None  # enough outside says nothing of the corner
    assert pin["safety_factor"] > 10.0
    assert sum(pin["error_parts"].values()) <= 0.05 * pin["max_von_mises"]
    (corner,) = [zone for zone in pin["singular_at"] if zone["governs"]]
    assert corner["exponent"] == pytest.approx(0.456, abs=0.05)
    # The corner is at r = 1, z = 1.5; 0.1 of 2 is left out around it. The section at its foot has
    # more than what is left of the surface there, and the row stays singular.
    assert pin["governs"] == "section"
    x, y, z = pin["surface"]["location"]
    assert math.hypot(math.hypot(x, y) - 1.0, z - 1.5) > 0.199


@pytest.mark.slow
def test_all_models_answer(run_once: tuple[Path, str, str], tmp_path: Path) -> None:
    """Each by its name, off the harmonic model by less than their errors add to. The beam's 34 % is
    not within 30 %, so its status is 1.
    """
    (tmp_path / "study.toml").write_text(QUICK)
    (by_default,) = json.loads((run_once[0] / "out/study/results.json").read_text())["pins"]
    for model, status, verdict in (
        ("beam", 1, "unconverged"),
        ("harmonic", 0, "converged"),
        ("solid", 0, "converged"),
    ):
        done = run_here("run", "study.toml", "--model", model, cwd=tmp_path)
        assert done.returncode == status, done.stderr
        (pin,) = json.loads((tmp_path / "out/study/results.json").read_text())["pins"]
        assert (pin["model"], pin["verdict"]) == (model, verdict)
        off = abs(pin["max_von_mises"] - by_default["max_von_mises"])
        assert off <= pin["error_estimate"] + by_default["error_estimate"]
        assert (off == 0.0) == (model == "harmonic")


def test_what_is_asked_decides_how_far_it_goes(tmp_path: Path) -> None:
    """A factor of 120 is far above the 10 that is required, which three meshes decide; the
    tolerance would take more, but is not what was asked for.
    """
    text = ONE_PIN.replace("tolerance = 0.05", 'goal = "decide"\ntolerance = 0.001')
    (tmp_path / "study.toml").write_text(text)
    done = run_here("run", "study.toml", cwd=tmp_path)
    (pin,) = json.loads((tmp_path / "out/study/results.json").read_text())["pins"]
    assert (pin["model"], len(pin["history"])) == ("harmonic", 3)
    assert pin["verdict"] == "unconverged"
    assert pin["meets_required"] is True
    assert pin["safety_factor"] > 100.0
    assert done.returncode == 0
    assert "converged" not in done.stderr
    assert done.stdout.startswith("Pin B is safe: factor 120 ≥ 10 required (landing).")


@pytest.mark.seconds
def test_millimetres_and_inches_give_the_same_pin(
    run_once: tuple[Path, str, str], tmp_path: Path
) -> None:
    text = QUICK.replace('"in-lbf-s"', '"mm-N-s"')
    for inch in (
        "length = 1.5",
        "length = 2.0",
        "diameter = 4.0",
        "diameter = 2.0",
        "fillet = 0.4",
    ):
        key, value = inch.split(" = ")
        text = text.replace(inch, f'{key} = "{value} in"')
    text = text.replace("-988.86", '"-988.86 lbf"')
    (tmp_path / "study.toml").write_text(text)
    assert run_here("run", "study.toml", cwd=tmp_path).returncode == 0
    (mm,) = json.loads((tmp_path / "out" / "study" / "results.json").read_text())["pins"]
    (inch,) = json.loads((run_once[0] / "out" / "study" / "results.json").read_text())["pins"]
    assert mm["max_von_mises"] == pytest.approx(inch["max_von_mises"] * 6.894757293e-3, rel=1e-9)
    assert mm["safety_factor"] == pytest.approx(inch["safety_factor"], rel=1e-9)

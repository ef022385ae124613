"""Motions whose forces are resolved between their samples, and what is said where they are not."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from pinstress import load_study
from pinstress.analysis.gather.gather import loads_only
from reports.tables.json_results import to_json
from reports.text.loads import remarks
from reports.text.loads_summary import write_loads_summary
from tests.conftest import ROOT
from tests.support.each import each

STUDIES = ROOT / "studies"


def crank(tmp_path: Path, samples: int, turns: float = 10.0) -> Path:
    """A bar of 1.62 N m about its pivot, drawn where it takes 0.93 N m."""
    angle = float(np.degrees(np.arccos(0.93 / 1.62)))
    path = tmp_path / "crank.toml"
    path.write_text(
        f"""
title = "Crank"
units = "m-N-s"
[case.turn]
kind = "motion"
samples = {samples}
[mechanism]
gravity = [0, -10]
[mechanism.drive]
body = "crank"
line = ["O", "P"]
law = "constant"
start = "{angle!r} deg"
end = "{angle + 360.0 * turns!r} deg"
duration = {turns}
[mechanism.joint.O]
at = [0, 0]
fixed_in = "ground"
connections = {{ O = "crank" }}
[mechanism.joint.P]
at = {{ origin = "O", distance = 0.324, angle = "{angle!r} deg" }}
fixed_in = "crank"
connections = {{ P = "load" }}
[mechanism.body.crank]
mass = 0
centre = [0, 0]
inertia = 0.01
[mechanism.body.load]
mass = 0.5
""",
        encoding="utf-8",
    )
    return path


@each("samples", [2, 11, 41])
def test_the_torque_of_ten_turns_is_that_of_all_the_time(tmp_path: Path, samples: int) -> None:
    """Every sample of eleven shows 0.93 N m; a turn has 1.62 at most, 0 in the mean."""
    results = loads_only(load_study(crank(tmp_path, samples)))
    (drive,) = results.drive
    assert drive.largest == pytest.approx(1.62, rel=1e-9)
    assert drive.mean == 0.0
    assert drive.rms == pytest.approx(1.62 / np.sqrt(2.0), rel=1e-9)
    assert drive.work[-1] == pytest.approx(0.0, abs=1e-9)
    (line,) = (x for x in remarks(results) if "drive" in x)
    assert line == (
        "turn: drive crank, maximum torque 1.620 N m, mean 0, RMS 1.146; maximum power 10.18 N m/s,"
        " stroke 3,600 deg"
    )
    peak = next(p for p in results.reactions[0].largest if p.connection == "P")
    assert peak.force == pytest.approx(0.5 * (10.0 + 0.324 * (2.0 * np.pi) ** 2), rel=1e-9)
    assert peak.time is not None
    assert peak.position == pytest.approx(360.0 * (peak.time + 57.0 / 360.0), abs=5.0)
    assert np.sin(np.radians(peak.position or 0.0)) == pytest.approx(-1.0, abs=1e-6)  # below


BALANCED = """
title = "A flywheel"
units = "m-N-s"
[mechanism.joint.O]
at = [0.3, 0.1]
fixed_in = "ground"
connections = { O1 = "wheel" }
[mechanism.body.wheel]
mass = 5
centre = [0.3, 0.1]
inertia = 0.01
[mechanism.drive]
body = "wheel"
start = "0 deg"
end = "360 deg"
duration = 2
law = "constant"
[case.turn]
kind = "motion"
"""


def test_a_drive_without_work_is_resolved(tmp_path: Path) -> None:
    """A balanced flywheel at constant speed: its torque is round-off, which nobody can resolve."""
    path = tmp_path / "study.toml"
    path.write_text(BALANCED, encoding="utf-8")
    results = loads_only(load_study(path))
    assert not len(results.reactions[0].unresolved)
    (error,) = re.findall(r"power balance error ([^;]+);", " ".join(remarks(results)))
    assert float(error) < 1e-6


@pytest.mark.slow
def test_what_is_not_resolved_is_said(tmp_path: Path) -> None:
    """Three hundred turns take more instants than are looked at."""
    results = loads_only(load_study(crank(tmp_path, 11, turns=300.0)))
    assert results.reactions[0].unresolved
    said = " ".join(remarks(results))
    assert "turn: not resolved between " in said
    write_loads_summary(results, tmp_path / "loads.md")
    assert "not resolved between" in (tmp_path / "loads.md").read_text(encoding="utf-8")
    assert to_json(results)["loads"][0]["unresolved"]


def test_few_samples_of_the_leg_in_space_have_its_largest_force(tmp_path: Path) -> None:
    text = (STUDIES / "kuleuven2014.toml").read_text(encoding="utf-8")
    text = text.replace("kuleuven2014/spin.csv", str(STUDIES / "kuleuven2014" / "spin.csv"))
    found = []
    for samples in (2, 3, 501):
        path = tmp_path / f"leg{samples}.toml"
        path.write_text(re.sub(r"samples = \d+", f"samples = {samples}", text), encoding="utf-8")
        peak, _ = loads_only(load_study(path)).reactions[0].largest
        found.append((peak.force, peak.moment, peak.time))
    assert found[0] == pytest.approx(found[2], rel=1e-6)
    assert found[1][:2] == pytest.approx(found[2][:2], rel=1e-10)

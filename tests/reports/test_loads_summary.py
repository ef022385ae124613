"""What is written for a mechanism alone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reports.data.results import Results
from reports.files import write_loads
from reports.text.loads import remarks
from reports.text.loads_summary import write_loads_summary
from tests.support.results.four_bar_results import four_bar


@pytest.fixture(scope="module")
def turning() -> Results:
    return four_bar(61)


def summary(results: Results, directory: Path) -> str:
    write_loads_summary(results, directory / "loads.md")
    return (directory / "loads.md").read_text(encoding="utf-8")


def test_files_of_a_mechanism_alone(turning: Results, tmp_path: Path) -> None:
    assert write_loads(turning, tmp_path).name == "report.html"
    assert {path.name for path in tmp_path.iterdir()} == {
        "results.json",
        "report.html",
        "reactions.csv",
        "reactions_pin_axes.csv",
        "drive.csv",
        "motion.csv",
        "joints.csv",
        "transmission.csv",
        "linkage.csv",
        "sliders.csv",
        "loads.md",
        "tables.xlsx",
        "animation_turn.html",
    }


def test_summary_has_peaks_drives_and_checks(turning: Results, tmp_path: Path) -> None:
    text = summary(turning, tmp_path)
    # 150 N of F12 a quarter of the turn on, that is 0.75 s and 90 degrees.
    row = next(line for line in text.splitlines() if "F12" in line)
    assert [cell.strip() for cell in row.split("|")[1:-1]] == [
        "F12",
        "ground",
        "A",
        "150.0",
        "0.7500",
        "90.00",
    ]
    assert "drive crank [°]" in text
    drive = next(line for line in text.splitlines() if "torque" in line)
    # 100 + 50 sin: its mean over a turn is 100, its RMS sqrt(100^2 + 50^2 / 2).
    assert "100.0" in drive
    assert "106.1" in drive
    assert "relative to the largest power: 0.0e+00" in text
    assert "Minimum transmission angle: 60.0°, coupler at C at 0 s." in text
    assert "Maximum condition number: 2.00" in text


def test_summary_warns_of_poor_transmission(turning: Results, tmp_path: Path) -> None:
    low = np.linspace(80.0, 20.0, 61)
    motion = replace(turning.motion[0], transmission={"rod at B": low, "none": np.nan * low})
    text = summary(replace(turning, motion=(motion,)), tmp_path)
    assert "20.0°, rod at B at 3 s, below 40°" in text


def test_what_holds_at_rest_is_not_called_a_drive(turning: Results, tmp_path: Path) -> None:
    """A stop was: "drive downlock"."""
    lock = replace(turning.drive[0], name="downlock", time=None)
    table = replace(turning.reactions[0], case=lock.case, times=None, position=None)
    held = replace(turning, drive=(lock,), motion=(), reactions=(table,))
    assert any("torque of downlock " in line for line in remarks(held))
    assert not any("drive downlock" in line for line in remarks(held))
    assert "| drive or stop |" in summary(held, tmp_path)


def test_an_angle_that_is_too_small_is_not_rounded_to_the_limit(turning: Results) -> None:
    """It said "is 40 deg; below 40 deg forces increase rapidly"."""
    motion = replace(turning.motion[0], transmission={"rod at B": np.array([80.0, 39.97])})
    said = remarks(replace(turning, motion=(motion,)))
    assert any("of rod at B is 39.97 deg; below 40 deg" in line for line in said)


def test_summary_of_a_held_case_and_of_odd_names(turning: Results, tmp_path: Path) -> None:
    table = replace(
        turning.reactions[0],
        case="a|b",
        times=None,
        position=None,
        connections=("<i>", "_x_", "F"),
        forces=turning.reactions[0].forces[:1],
        moments=turning.reactions[0].moments[:1],
        note="held *still*",
    )
    text = summary(replace(turning, reactions=(table,), drive=(), motion=()), tmp_path)
    assert "## a\\|b" in text
    assert "&lt;i>" in text
    assert "\\_x\\_" in text
    assert "held \\*still\\*" in text
    assert "time" not in text

"""What a successor does first: a check of strength is one new file, and its name in the list.

Nothing else is changed, and the check is in margins.csv, hand_checks.csv, results.json, on the page
and on the terminal.
"""

from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT

FORCE, DIAMETER, LENGTH = 988.86, 2.0, 2.75  # lbf; in, of the thinner part and of the whole pin
STUDY = f"""
title = "A toy check"
units = "in-lbf-s"
[material.steel]
youngs_modulus = "28400 ksi"
poisson_ratio = 0.30
yield_strength = "225 ksi"
[pin.B]
material = "steel"
clamp = ["start"]
profile = [
  {{ length = 0.75, diameter = {DIAMETER}, name = "root" }},
  {{ length = 2.0, diameter = {DIAMETER}, connection = "B" }},
]
[case.pull]
kind = "given"
forces = {{ B = [0.0, {-FORCE}] }}
[analysis]
model = "beam"
tolerance = 0.5
"""
NEW_FILE = '''
"""The force of a pin's links over its whole shadow, against a thousandth of yield."""

from assess.check import CheckText, WorstPlace, check
from assess.margin import Margin
from assess.situation import Situation


@check("shadow pressure", "Toy manual, 1-1", kind="hand", takes="statics")
def shadow_pressure(text: CheckText, s: Situation) -> list[Margin]:
    """F / (d L) of the whole pin."""
    shadow = sum(segment.diameter * segment.length for segment in s.pin.segments)
    strength = s.material.yield_strength
    allowable = strength and 1e-3 * strength
    stress = float(s.across.sum(axis=1).max()) / shadow
    return text.at_levels(s, stress, WorstPlace("root"), s.material, allowable, formula="F / (d L)")
'''


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a run writes once the check is there, and what it prints (terminal.txt)."""
    house, work = tmp_path_factory.mktemp("house"), tmp_path_factory.mktemp("work")
    shutil.copytree(ROOT / "assess", house / "assess", ignore=shutil.ignore_patterns("__pycache__"))
    (house / "assess" / "strength" / "shadow_pressure.py").write_text(NEW_FILE, encoding="utf-8")
    listed = house / "assess" / "checks.py"
    text = listed.read_text(encoding="utf-8")
    start = "CHECKS: tuple[Check, ...] = (\n"
    assert text.count(start) == 1
    name = "shadow_pressure"
    imported = f"from assess.strength.{name} import {name}\n\n"
    listed.write_text(text.replace(start, f"{imported}{start}    {name},\n"), encoding="utf-8")
    (work / "s.toml").write_text(STUDY, encoding="utf-8")
    path = os.pathsep.join([str(house), str(ROOT)])
    done = subprocess.run(
        [sys.executable, "-m", "pinstress", "run", "s.toml", "--out", "out"],
        cwd=work, capture_output=True, text=True, check=False,
        env=os.environ | {"PYTHONPATH": path, "PINSTRESS_CACHE": "off"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    (work / "out" / "terminal.txt").write_text(done.stdout, encoding="utf-8")
    return work / "out"


def test_a_new_check_is_in_the_tables(folder: Path) -> None:
    stress = FORCE / (DIAMETER * LENGTH)
    for name, column, value, source in (
        ("margins", "method", "demand", "clause"),
        ("hand_checks", "check", "stress", "source"),
    ):
        text = (folder / f"{name}.csv").read_text(encoding="utf-8")
        (row,) = [r for r in csv.DictReader(text.splitlines()) if r[column] == "shadow pressure"]
        assert float(row[value]) == pytest.approx(stress)
        assert (row["at"], row[source], row["governs"]) == ("root", "Toy manual, 1-1", "yes")


@pytest.mark.seconds
def test_a_new_check_is_in_the_results(folder: Path) -> None:
    written = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    (margin,) = [m for m in written["margins"] if m["method"] == "shadow pressure"]
    assert margin["margin"] == pytest.approx(225.0 / (FORCE / (DIAMETER * LENGTH)) - 1.0)
    (pin,) = written["pins"]
    assert "shadow pressure" in [check["name"] for check in pin["hand_checks"]]


@pytest.mark.seconds
def test_a_new_check_that_governs_is_on_page_and_terminal(folder: Path) -> None:
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert page.count("shadow pressure") >= 3  # where it governs, among all margins, by hand
    assert "shadow pressure" in (folder / "terminal.txt").read_text(encoding="utf-8")

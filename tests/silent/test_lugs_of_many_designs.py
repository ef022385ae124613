"""Sweeps, curves and probabilities judge pins alone, and said so nowhere: a clevis whose lugs fail
by three times was safe in all of them.

Independent: 50 kN on an eye of 10 mm, 30 mm wide, leave 50 kN / (2 x 10 mm x 5 mm) = 500 MPa in its
net section, 3.1 times its yield strength.
"""

from __future__ import annotations

from pathlib import Path

import pytest

import pinstress
from pinstress.cli.commands import run_command_line
from pinstress.explore.sweep.design_columns import designs_of
from pinstress.explore.sweep.page import summary
from reports.data.headline import worst_checks
from tests.support.each import each
from tests.support.study_text import study_file

STUDY = """
title = "A clevis with an eye that fails"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "900 MPa"
[material.weak]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "160 MPa"
[analysis]
joints = "prescribed"
model = "beam"
tolerance = 0.5
required_safety_factor = 1.1
[case.pull]
kind = "given"
distribution = "uniform"
forces = { L = [-25000, 0], M = [50000, 0] }
[pin.P]
material = "steel"
balance = "R"
profile = [
  { length = 5, diameter = 20, connection = "L" },
  { length = 10, diameter = 20, connection = "M" },
  { length = 5, diameter = 20, connection = "R" },
]
lug.M = { outer_diameter = 30, material = "weak" }
[vary]
sample = "random"
count = 2
[vary.parameters]
"material.steel.yield_strength" = { normal = ["900 MPa", "1 MPa"], within = ["880 MPa", "920 MPa"] }
[reliability]
samples = 20
importance_samples = 0
sobol_samples = 0
"""
SAID = "The lugs of P are not checked here: `pinstress run` checks them, too."
KEY = "material.steel.yield_strength"
REQUIRED = """[[require]]
check = "rupture"
level = "ultimate"
factor = 100
"""
YIELD_ALONE = "Pins are checked against yield only: `pinstress run` also checks "
FORMULAS_SAID = f"{YIELD_ALONE}shear, bearing, bending."
REQUIRED_SAID = f"{YIELD_ALONE}rupture, shear, bearing, bending."
# 50 kN / (20 x 10 mm) = 250 MPa of bearing and 50 kN / (2 x 314 mm^2) = 80 MPa of shear at limit
# load, times 1.5 at ultimate; one flight has ten pulls of 191 MPa
LIFE = """
[fatigue]
unit = "flight"
life = 1e6
failure_probability = 0.1
[fatigue.occurrences]
pull = 10
"""
CURVE = """
[material.steel.fatigue]
knee_stress = "50 MPa"
knee_cycles = 1e6
slope = 5
scatter = 3.5
mean_stress_sensitivity = 0.2
"""


def on_page(study: pinstress.Study) -> str:
    return summary(designs_of(pinstress.sweep(study, jobs=1)))


def plain(said: str) -> str:
    """A sentence as the page has it, without the marks of commands."""
    return said.replace("`", "")


@each("command", [["sweep"], ["reliability"], ["curve", KEY, "--points", "2"]])
def test_what_judges_yield_alone_of_pins_alone_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: list[str]
) -> None:
    """Rows read "safe" while the run misses the required rupture."""
    path = study_file(tmp_path, f"{STUDY}{REQUIRED}")
    arguments = [command[0], str(path), *command[1:], "--out", str(tmp_path / "out"), "--quiet"]
    run_command_line([*arguments, "--jobs", "1"])
    said = " ".join(capsys.readouterr().out.split())
    assert f"{SAID} {REQUIRED_SAID}" in said
    if command == ["sweep"]:
        study = pinstress.load_study(path)
        assert on_page(study).endswith(plain(f" {REQUIRED_SAID}"))


def test_the_run_judges_the_lugs(tmp_path: Path) -> None:
    path = study_file(tmp_path, STUDY)
    study = pinstress.load_study(path)
    (row,) = pinstress.run(study).pins
    assert row.meets_required is True
    net = next(m for m in row.margins if m.method == "lug, net section" and m.level == "limit")
    assert net.demand == pytest.approx(500.0)
    assert on_page(study).endswith(plain(f". {SAID} {FORMULAS_SAID}"))


@each("more,check,said", [
    ('bearing_strength = "100 MPa"', "bearing", "shear, bearing, bending"),
    (f"{CURVE}{LIFE}", "fatigue life", "shear, bearing, bending, fatigue"),
])  # fmt: skip
def test_what_a_run_judges_besides_yield_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], more: str, check: str, said: str
) -> None:
    """Rows read "safe", and nothing said that a run of the same study fails by another check."""
    strong = 'yield_strength = "900 MPa"\n'
    alone = STUDY.replace('lug.M = { outer_diameter = 30, material = "weak" }\n', "")
    path = study_file(tmp_path, alone.replace(strong, f"{strong}{more}\n", 1))
    worst = worst_checks(pinstress.run(pinstress.load_study(path)))["P"]
    assert (worst.outcome, worst.check) == ("fails", check)
    arguments = ["curve", str(path), KEY, "--points", "2", "--out", str(tmp_path / "out")]
    assert run_command_line([*arguments, "--quiet", "--jobs", "1"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "safe" in printed
    assert f"{YIELD_ALONE}{said}." in printed

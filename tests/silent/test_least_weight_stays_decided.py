"""`size --least-weight` shrank a clamp's edge, or opened the step of a bore, until stress there
governed: a pin that was safe came back "not decided", singular, with status 1.

Independent values: the outcome of a plain run of what is written, beside that of the study as it
was; the diameter at the fillet by beam theory.
"""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import pinstress
from assess.judgement import SAFE
from pinstress.cli.commands import run_command_line
from pinstress.explore.size import least_weight
from pinstress.explore.size.least_weight import LightStudy, lighten
from pinstress.explore.size.lightest_pin import Lightest
from pinstress.explore.size.weight_search import WeightGoal
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import Study

HEAD = """
title = "stays decided"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m^3"
yield_strength = "500 MPa"
[analysis]
required_safety_factor = 2
[case.one]
kind = "given"
distribution = "cosine"
"""
CLAMP = """
forces = { D = [0, 10000] }
[pin.P]
material = "steel"
clamp = ["start"]
profile = [
  { length = 120, diameter = 90 },
  { length = 40, diameter = 45 },
  { length = 40, diameter = 45, connection = "D" },
]
fillet = 3
"""
BORE = """
forces = { A = [0, -20000], B = [0, 20000], C = [0, 20000], D = [0, -20000] }
[pin.P]
material = "steel"
profile = [
  { length = 40, diameter = 50, bore = 20, connection = "A" },
  { length = 60, diameter = 50, bore = 20 },
  { length = 40, diameter = 50, bore = 20.5, connection = "B" },
  { length = 60, diameter = 50, bore = 20.5 },
  { length = 40, diameter = 50, bore = 20.5, connection = "C" },
  { length = 60, diameter = 50, bore = 20 },
  { length = 40, diameter = 50, bore = 20, connection = "D" },
]
"""
SINGULAR = {"profile[1].diameter": 0.04345, "profile[2-3].diameter": 0.03555, "fillet": 0.002369}


def study(text: str) -> Study:
    return pinstress.study_from(HEAD + text)


def outcomes(of: Study) -> list[str]:
    """Of a plain run."""
    return [p.outcome for p in pinstress.run(of).pins]


def lighter(found: LightStudy, before: Study) -> float:
    """Its volume over that before."""
    return pin_of(found.study, "P").volume / pin_of(before, "P").volume


@pytest.mark.slow
def test_a_clamp_whose_edge_would_govern() -> None:
    """31 % of the volume; 29 % was singular. The shaft's diameter is that of beam theory for a
    stress concentration between 1.3 and 1.7, which fillets of a tenth of the diameter have.
    """
    before = study(CLAMP)
    assert outcomes(before) == [SAFE]
    found = lighten(before, WeightGoal(2.0))
    assert outcomes(found.study) == [SAFE]
    assert found.settled
    assert lighter(found, before) < 0.35
    (only,) = found.pins
    assert only.values is not None
    shaft = only.values["profile[2-3].diameter"]
    nominal = 32.0 * 10000.0 * 0.06 / (math.pi * shaft**3)
    assert 1.3 < 250e6 / nominal < 1.7
    assert "one, the edge of a clamp (start / segment 1)" in [name for name, _ in only.binding]


@pytest.mark.long
@pytest.mark.slow
def test_a_pin_that_fails_is_not_made_singular_either() -> None:
    """Under three times the load it fails; larger, it is safe, not merely undecided."""
    before = study(CLAMP.replace("10000", "30000"))
    assert outcomes(before) == ["fails"]
    found = lighten(before, WeightGoal(2.0))
    assert outcomes(found.study) == [SAFE]


@pytest.mark.long
@pytest.mark.slow
def test_a_bore_whose_step_would_govern() -> None:
    """85 % of the volume that scaling gives."""
    before = study(BORE)
    assert outcomes(before) == [SAFE]
    found = lighten(before, WeightGoal(2.0))
    assert outcomes(found.study) == [SAFE]
    (only,) = found.pins
    assert only.scaled is not None
    assert pin_of(found.study, "P").volume < 0.85 * only.scaled


def test_a_worse_one_is_not_returned(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Whatever a search may find: the pin that was safe stays, with the reason, and status 0."""

    def singular(*_: object) -> Lightest:
        return Lightest("P", dict(SINGULAR), before=3.757, factor=2.01)

    monkeypatch.setattr(least_weight, "lightest_pin", singular)
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(HEAD + CLAMP)
    assert run_command_line(["size", "study.toml", "--least-weight", "--jobs", "1"]) == 0
    said = capsys.readouterr()
    words = " ".join((said.out + said.err).split())
    reason = "left as it is: the lightest pin that was found is not decided in one, this one safe"
    assert reason in words
    assert "1 of 1 pin reaches the safety factor 2" in words
    assert not Path("study_sized.toml").exists()

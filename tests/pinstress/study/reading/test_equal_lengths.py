"""Lengths that are equal, written in different units, in a study: one shape, one answer."""

from __future__ import annotations

from pathlib import Path

import pytest

import pinstress
from pinstress import InputError, load_study
from pinstress.cli.commands import run_command_line
from pinstress.study.model.pins import pin as pin_of
from tests.support.described import describe
from tests.support.errors import raises
from tests.support.study_text import study_file

STUDY = """
title = "Equal lengths"
units = "mm-N-s"

[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m^3"
yield_strength = "350 MPa"

[pin.P]
material = "steel"
SHAPE

[case.push]
kind = "given"
forces = { A = [0.0, -500.0], B = [0.0, 1000.0], C = [0.0, -500.0] }
distribution = "cosine"

[analysis]
tolerance = 0.05
"""


def shape(diameters: tuple[str, str, str], bores: tuple[str, str, str], more: str = "") -> str:
    rows = (
        f'{{ length = {long}, diameter = "{d}", bore = "{b}", connection = "{c}" }}'
        for long, d, b, c in zip((10, 20, 10), diameters, bores, "ABC", strict=True)
    )
    return f"profile = [{', '.join(rows)}]\nfillet = 4.0\n{more}"


SAME = shape(("17.78 mm",) * 3, ("5.08 mm",) * 3)
MIXED = shape(("0.7 in", "17.78 mm", "1.778 cm"), ("0.2 in", "5.08 mm", "0.508 cm"))


def write(folder: Path, text: str) -> Path:
    return study_file(folder, STUDY.replace("SHAPE", text))


def test_mixed_units_answer_as_one_does(tmp_path: Path) -> None:
    one, other = (
        pinstress.run(load_study(write(tmp_path, text))).pins[0] for text in (SAME, MIXED)
    )
    assert other.verdict == one.verdict == "converged"
    assert one.max_von_mises is not None
    assert other.max_von_mises == pytest.approx(one.max_von_mises, rel=1e-9)
    assert "taken as equal" not in other.note


def test_with_a_hole_too(tmp_path: Path) -> None:
    hole = 'hole = [{ z = 20.0, diameter = "3 mm" }]\n'
    same, mixed = (
        pin_of(load_study(write(tmp_path, text + hole)), "P").volume for text in (SAME, MIXED)
    )
    assert mixed == pytest.approx(same, rel=1e-9)


def test_what_is_more_than_round_off_is_told(tmp_path: Path) -> None:
    near = shape(("17.78 mm", "17.780000010 mm", "17.78 mm"), ("0 mm",) * 3)
    told = "differ by up to 1e-08 mm, less than a billionth of its smallest diameter"
    study = load_study(write(tmp_path, near))
    assert told in describe(study)[0]
    assert told in pinstress.run(study).pins[0].note
    assert told not in describe(load_study(write(tmp_path, SAME)))[0]


def test_a_fillet_beside_a_real_step_is_measured_by_it(tmp_path: Path) -> None:
    step = shape(("17.78 mm", "17.7801 mm", "17.78 mm"), ("0 mm",) * 3)
    with raises(InputError, "fillet-too-large", "8e+04"):
        pin_of(load_study(write(tmp_path, step)), "P")


@pytest.mark.slow
def test_cuts_that_leave_nothing_of_a_band_are_refused_before_anything_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without a density nothing asked for its volume, and the run ended in a traceback."""
    profile = shape(("20 mm", "8 mm", "20 mm"), ("0 mm",) * 3).replace("fillet = 4.0", "")
    flats = ", ".join(
        f'{{ z = [5, 35], distance = 3, angle = "{angle} deg" }}' for angle in range(0, 360, 30)
    )
    path = write(tmp_path, f"{profile}flat = [{flats}]\n")
    path.write_text(path.read_text().replace('density = "7850 kg/m^3"\n', ""))
    for command in ("check", "run"):
        assert run_command_line([command, str(path)]) == 2
        assert "pin P: the cuts remove all of B" in capsys.readouterr().err

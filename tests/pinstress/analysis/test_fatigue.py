"""Fatigue of a study: histories of stress, damage, and spectra that cannot be used."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import pinstress
from fea.core.requirement import Model
from fea.core.voigt import von_mises
from pinstress.study.reading.errors import InputError
from tests.pinstress.test_import import loaded_by
from tests.support.each import each

PIN = """
title = "A pin"
units = "mm-N-s"
[material.steel]
youngs_modulus = "200 GPa"
poisson_ratio = 0.3
yield_strength = "800 MPa"
[pin.P]
material = "steel"
clamp = ["root"]
profile = [{ length = 20, diameter = 20, name = "root" },
           { length = 60, diameter = 20, connection = "L" }]
[case.up]
kind = "given"
distribution = "uniform"
forces = { L = [6000, 0] }
[case.down]
kind = "given"
distribution = "uniform"
table = "down.csv"
[analysis]
model = "beam"
tolerance = 0.5
"""
DOWN = "connection,fx,fy,time\nL,0,0,0\nL,-2000,0,1\nL,-4000,0,2\nL,-1000,0,3\n"
FATIGUE = """
[material.steel.fatigue]
knee_stress = "100 MPa"
knee_cycles = 1e6
slope = 5
scatter = 4
mean_stress_sensitivity = 0.2
[fatigue]
life = 1000
failure_probability = 0.1
[fatigue.occurrences]
up = 1
down = 2
"""
Write = Callable[[str], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def written(text: str) -> Path:
        (tmp_path / "down.csv").write_text(DOWN)
        path = tmp_path / "pin.toml"
        path.write_text(text)
        return path

    return written


@pytest.mark.parametrize(
    ("model", "agrees"),
    # The maximum of a solid is a mean over directions of the load about the axis.
    [("beam", 1e-6), ("harmonic", 1e-6), pytest.param("solid", 2e-3, marks=pytest.mark.slow)],
)
def test_the_history_at_a_governing_point_has_the_maximum(
    write: Write, model: Model, agrees: float
) -> None:
    results = pinstress.run(pinstress.load_study(write(PIN)), model=model)
    for case in ("up", "down"):
        row = results["P", case]
        assert row.location is not None
        at = np.array(row.location)
        (here,) = (h for h in results.histories if np.allclose(h.location, at))
        (course,) = (c for c in here.cases if c.case == case)
        assert course.von_mises.max() == pytest.approx(row.max_von_mises, rel=agrees)
        assert von_mises(course.stress) == pytest.approx(course.von_mises, rel=1e-12)
        assert abs(course.signed) == pytest.approx(course.von_mises)
    assert results.fatigue is None
    table = results.tables["stress_history"]
    assert table.keys == ["pin", "case", "time", "point", "von_mises", "signed"]
    times = {row[2] for row in table.cells() if row[1] == "down"}
    assert times >= {0.0, 1.0, 2.0, 3.0}


def test_damage_of_bending_by_hand(write: Write) -> None:
    results = pinstress.run(pinstress.load_study(write(PIN + FATIGUE)))
    assert results.fatigue is not None
    worst = results.fatigue.points[0]
    # 6 kN on a cantilever, 30 mm from its root: the stress of beams. Down is -2/3 of it; one cycle
    # goes from the one to the other, a second from zero to there. Mean stress: M = 0.2.
    top = 6000.0 * 30.0 / (np.pi * 20.0**3 / 32.0)
    assert worst.amplitudes[0] == pytest.approx((5.0 + 0.2) / 6.0 * top, rel=0.02)
    assert worst.amplitude == pytest.approx(top * 5.0 / 6.0, rel=0.02)
    assert worst.amplitudes[1:] == pytest.approx([(1.0 - 0.2) / 3.0 * top], rel=0.02)
    # At 10 % lives are shorter by 4^(1/2), and the knee lower by 4^(1/2/5).
    knee = 100.0 / 4.0**0.1
    damage = ((worst.amplitudes / knee) ** 5 / 1e6)[worst.amplitudes > knee].sum()
    assert worst.damage == pytest.approx(damage, rel=1e-4)
    assert worst.utilisation == pytest.approx(1000.0 * worst.damage)
    (margin,) = (m for m in results.margins if m.margin.method == "fatigue life")
    assert (margin.pin, margin.case) == ("P", "")
    assert margin.used == pytest.approx(worst.utilisation)


@pytest.mark.slow
def test_files_of_a_run(write: Write, tmp_path: Path) -> None:
    out = tmp_path / "out"
    loaded = loaded_by("run", str(write(PIN)), "--out", str(out), "--no-cache", "--quiet")
    assert not loaded & {"pylife", "pandas"}
    with (out / "stress_history.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["pin", "case", "time", "point", "von_mises", "signed"]
    assert not (out / "fatigue.csv").exists()


@each("method", ["signed-von-mises", "critical-plane", "fkm-p-ram"])
def test_every_method_has_an_answer(write: Write, method: str) -> None:
    more = FATIGUE.replace("life = 1000", f'method = "{method}"')
    more += '[material.steel.fkm]\ngroup = "Steel"\nroughness = "6 um"\nplastic_factor = 1.7\n'
    text = PIN.replace("[pin.P]", 'ultimate_strength = "900 MPa"\n[pin.P]')
    results = pinstress.run(pinstress.load_study(write(text + more)))
    assert results.fatigue is not None
    worst = results.fatigue.points[0]
    assert worst.method == method
    assert worst.amplitudes[0] > 0.0
    if worst.damage:
        early, middle, late = worst.lives
        assert 0.0 < (early or 0.0) < (middle or 0.0) < (late or 0.0)


@each(
    ("old", "new", "code"),
    [
        ("slope = 5\n", "", "missing-key"),
        ("mean_stress_sensitivity = 0.2\n", "", "missing-key"),
        ("down = 2", "sideways = 2", "unknown-case"),
        ("down = 2", "down = -2", "out-of-range"),
        ("down = 2", "down = 0.0123456", "not-a-fraction"),
        ("up = 1", "up = 9999.5", "too-many-occurrences"),
        ("life = 1000", 'method = "fkm-p-ram"', "no-fatigue-data"),
        ("life = 1000", 'method = "miner"', "not-a-choice"),
        ("scatter = 4", "scatter = 0.5", "out-of-range"),
        ("scatter = 4\n", "", "missing-key"),
    ],
)
def test_mistakes(write: Write, old: str, new: str, code: str) -> None:
    assert old in FATIGUE
    with pytest.raises(InputError) as caught:
        pinstress.load_study(write(PIN + FATIGUE.replace(old, new)))
    assert caught.value.code == code


def test_what_is_not_assessed_is_listed(write: Write) -> None:
    results = pinstress.run(pinstress.load_study(write(PIN + FATIGUE)), cases=["up"])
    assert results.fatigue is not None
    assert results.fatigue.not_decided == {"P": "case down was not run"}


def test_the_first_point_has_the_largest_range_not_the_largest_stress(write: Write) -> None:
    side = '[case.side]\nkind = "given"\nforces = { L = [0, 6500] }\n'
    results = pinstress.run(pinstress.load_study(write(PIN + side)))
    first = results.histories[0]
    assert first.chosen == "largest range of stress"
    # Up and down: from 6000 to -4000 N along x; sideways only from 0 to 6500 N, along y.
    assert abs(first.location[0]) == pytest.approx(10.0)
    top = max(results.pins, key=lambda row: row.max_von_mises or 0.0)
    assert top.case == "side"
    assert top.location is not None
    assert abs(top.location[1]) == pytest.approx(10.0)

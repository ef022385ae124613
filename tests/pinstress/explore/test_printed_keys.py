"""Every key that the program prints is accepted where keys are."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

import pinstress
from pinbase.keys import key_part
from pinstress.analysis.engine import Engine
from pinstress.analysis.plan import prepare
from pinstress.analysis.remedies.dimensions import dimensions_of
from pinstress.analysis.remedies.joint_parameters import joint_parameters
from pinstress.cli.commands import run_command_line
from pinstress.explore.curve import curve
from pinstress.explore.sweep.number import number_at
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.in_python import changed_study
from tests.support.each import each, sampled
from tests.support.pins.studies import BY_SEGMENTS_AND_CORNERS
from tests.support.programs.command_line import ONE_PIN

HEAD = """
title = "Keys"
units = "mm-N-s"
[material."steel 1.4301"]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
density = "7850 kg/m^3"
[analysis]
tolerance = 0.2
"""
QUOTED = BY_SEGMENTS_AND_CORNERS + "[analysis]\ntolerance = 0.2\n"
for old, new in (
    ("[material.steel]", '[material."steel 1.4301"]\ndensity = "7850 kg/m^3"'),
    ('material = "steel"', 'material = "steel 1.4301"'),
    ("[pin.P]", '[pin."P.1"]'),
):
    QUOTED = QUOTED.replace(old, new)
IN_LUGS = (
    HEAD
    + """
joints = "contact"
[pin.P]
material = "steel 1.4301"
profile = [
  { length = 20, diameter = 20, connection = "left 1.a" },
  { length = 30, diameter = 20, connection = "middle" },
  { length = 20, diameter = 20, connection = "right" },
]
[pin.P.lug.middle]
edge_radius = 0.5
[case.pull]
kind = "given"
forces = { "left 1.a" = [0, 5000], middle = [0, -10000], right = [0, 5000] }
"""
)
SHAPES = {"shapes": QUOTED, "one pin": ONE_PIN, "lugs": IN_LUGS}


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(SHAPES, every=2))
@pytest.mark.parametrize("step", sampled([16, 1], every=2))
def test_every_key_of_the_sensitivities_is_accepted(step: int, name: str, tmp_path: Path) -> None:
    """By the engine, where a changed number changes the answer as its derivative says, and by
    `curve`, which knows its value: one in so many is solved, by `curve` every other one of these.
    """
    path = tmp_path / "study.toml"
    path.write_text(SHAPES[name])
    arguments = ["run", str(path), "--sensitivities", "--out", str(tmp_path / "out"), "--quiet"]
    run_command_line(arguments)
    with (tmp_path / "out" / "sensitivities.csv").open() as file:
        rows = [r for r in csv.DictReader(file) if not r["key"].startswith(("force ", "moment "))]
    assert len(rows) > 8
    study = pinstress.load_study(path)
    engine = Engine(study)
    for k, row in enumerate(rows):
        key, pin, case = row["key"], row["pin"], row["case"]
        value, little = float(row["value"]), 0.4 * float(row["step"])
        changes = {key: value + little}
        before, after = (number_at(x, key).nominal for x in (study, changed_study(study, changes)))
        assert after > before, key
        assert after * value == pytest.approx(before * (value + little), rel=1e-9), key
        if k % step:
            continue
        high = engine.answer(changes)[pin, case].max_von_mises
        expected, maximum = little * float(row["stress_per_unit"]), float(row["max_von_mises"])
        assert high is not None
        if not key.endswith(".clearance"):  # at 0 it changes what touches
            noise = 0.003 * maximum  # of meshes and cells of contact
            assert high - maximum == pytest.approx(expected, rel=0.1, abs=noise), key
        if k % (2 * step) == 0 or step == 1:
            points = curve(study, key, (value, value + little), 2, [pin]).points
            assert points[0].value == pytest.approx(value, rel=1e-9), key
            assert points[-1].max_von_mises == pytest.approx(high, rel=1e-9), key


# Of all kinds, as bucket_pin with bushings and landing_gear with lugs of a structure.
WITH_PINS = [name for name in pinstress.shipped_studies() if name != "slider_crank_jammed"]


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(WITH_PINS, every=5, first=2))
def test_every_dimension_and_parameter_of_a_shipped_study_has_a_key(name: str) -> None:
    """It names the number that the model has, and may be changed by it."""
    study = pinstress.load_study(pinstress.shipped_studies()[name])
    for task in prepare(study).tasks:
        values = {d.key: d.value for d in dimensions_of(study, task.pin)}
        if task.lugs and task.pin.revolved:
            joint = (x.of_joint for x in joint_parameters(study, task))
            values |= {x.key: x.value for x in joint}
        pin = f"pin.{key_part(task.pin.name)}."
        numbers = {
            key: number_at(study, key if key.startswith("material.") else pin + key)
            for key in values
        }
        assert len(numbers) >= 4
        for key, number in numbers.items():
            assert number.nominal == pytest.approx(values[key], rel=1e-12, abs=1e-15), key
        changes = {n.key: n.in_study(n.shown(1.001 * n.nominal)) for n in numbers.values()}
        changed = changed_study(study, changes)
        for key, number in numbers.items():
            after = number_at(changed, number.key).nominal
            assert after == pytest.approx(1.001 * values[key], rel=1e-12, abs=1e-15), key


def test_a_key_with_a_range_changes_all_its_segments() -> None:
    study = pinstress.study_from(IN_LUGS)
    changed = changed_study(study, {"pin.P.profile[1-2].diameter": "22 mm"})
    profile = changed.table.pin["P"].profile
    assert profile is not None
    assert [s.diameter for s in profile] == pytest.approx([0.022, 0.022, 0.020])


def test_a_lug_without_a_table_has_its_defaults() -> None:
    """Named by its connection, quoted where that has a dot."""
    study, key = pinstress.study_from(IN_LUGS), 'pin.P.lug."left 1.a".clearance'
    assert (number_at(study, key).nominal, number_at(study, key).unit) == (0.0, "mm")
    lug = changed_study(study, {key: 0.05}).table.pin["P"].lug["left 1.a"]
    assert lug.clearance == pytest.approx(5e-5)
    with pytest.raises(InputError, match="lug"):
        changed_study(study, {"pin.P.lug.other.clearance": 0.05})


@each(
    ("key", "message"),
    [
        (
            "pin.P.profile[1-4].diameter",
            "there is no element 4 of its list; it has 3, counted from 1",
        ),
        ("pin.P.profile[2-1].diameter", r"\[2-1\] is no range; the smaller element first"),
        ("pin.P.lugs.left.clearance", "the study has no 'lugs' there"),
    ],
)
def test_keys_that_name_nothing_are_refused(key: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        changed_study(pinstress.study_from(IN_LUGS), {key: 1.0})

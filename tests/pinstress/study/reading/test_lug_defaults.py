"""[lug_defaults]: what all lugs of a study have in common, wherever a study is read or changed."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from fea.support.lugs.lug import Lug
from pinstress import Engine, InputError, prepare
from pinstress.explore.curve import curve
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.explore.sweep.number import number_at
from pinstress.study.reading.file import Study, parse_study
from pinstress.study.reading.in_python import changed_study
from tests.support.each import each
from tests.support.pins.studies import DOUBLE_SHEAR

STUDY = """
title = "Two pins, one of them clamped"
units = "mm-N-s"

[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "900 MPa"

[material.bronze]
youngs_modulus = "110 GPa"
poisson_ratio = 0.34

[analysis]
tolerance = 0.2
joints = "{joints}"

[case.pull]
kind = "given"
forces = {{ L = [-25000, 0], M = [50000, 0], R = [-25000, 0], C = [0, 100] }}

{defaults}
[pin.P]
material = "steel"
profile = {profile}
{pin}
[pin.Q]                 # clamped
material = "steel"
clamp = ["start"]
profile = [
  {{ length = 10, diameter = 20 }},
  {{ length = 10, diameter = 20, connection = "C" }},
]
"""
DEFAULTS = "[lug_defaults]\nouter_diameter = 50\nclearance = 0.02\n"
EVERY = ("L", "M", "R")


def study(defaults: str = DEFAULTS, pin: str = "", joints: str = "auto") -> Study:
    text = STUDY.format(profile=DOUBLE_SHEAR, defaults=defaults, pin=pin, joints=joints)
    return parse_study(Path("study.toml"), text)


def by_hand(tables: dict[str, str]) -> Study:
    """The same study with a table for every lug."""
    return study("", "".join(f"[pin.P.lug.{name}]\n{keys}\n" for name, keys in tables.items()))


def lugs(study: Study) -> dict[str, tuple[Lug, ...]]:
    return {task.pin.name: task.lugs for task in prepare(study).tasks}


def test_defaults_are_those_of_every_lug_of_a_pin_that_is_not_clamped() -> None:
    written = dict.fromkeys(EVERY, "outer_diameter = 50\nclearance = 0.02")
    assert lugs(study()) == lugs(by_hand(written))
    assert lugs(study())["Q"] == ()


def test_the_keys_of_a_lug_come_first_also_those_of_its_own_tables() -> None:
    defaults = DEFAULTS + 'bushing = { thickness = 1, material = "bronze" }\n'
    given = "lug.M = { clearance = 0, bushing = { thickness = 2 } }"
    own = 'outer_diameter = 50\nclearance = {}\nbushing = {{ thickness = {}, material = "bronze" }}'
    written = dict.fromkeys(EVERY, own.format(0.02, 1)) | {"M": own.format(0, 2)}
    assert lugs(study(defaults, given)) == lugs(by_hand(written))


@each("own", ["clearance = 0.1", 'fit = "H7/g6"'])
@each("default", ["clearance = 0.02", 'fit = "H8/e8"'])
def test_what_a_lug_says_of_its_clearance_replaces_what_the_defaults_say(
    own: str, default: str
) -> None:
    defaults = f"[lug_defaults]\n{default}\nrange = {{ tilt = ['free', 'free'] }}\n"
    written = dict.fromkeys(EVERY, default + "\nrange.tilt = ['free', 'free']")
    written["M"] = own + "\nrange.tilt = ['free', 'free']"
    assert lugs(study(defaults, f"lug.M = {{ {own} }}")) == lugs(by_hand(written))


@each("own", ["interference = 0.02", 'fit = "H7/s6"'])
def test_what_a_bushing_says_of_its_interference_replaces_what_the_defaults_say(own: str) -> None:
    ring, known = 'thickness = 1, material = "bronze"', "range = { interference = [0.01, 0.04] }\n"
    defaults = f"[lug_defaults]\nbushing = {{ {ring}, fit = 'H7/r6' }}\n"
    written = dict.fromkeys(EVERY, f"bushing = {{ {ring}, fit = 'H7/r6' }}")
    written["M"] = f"bushing = {{ {ring}, {own} }}"
    given = f"lug.M = {{ bushing = {{ {own} }} }}"
    assert lugs(study(defaults, given)) == lugs(by_hand(written))
    kept = {name: f"{keys}\n{known}" for name, keys in written.items()}
    if "fit" in own:  # which has a range of its own
        kept["M"] = written["M"]
    assert lugs(study(defaults + known, given)) == lugs(by_hand(kept))


def test_a_pin_that_says_so_gets_no_lugs_and_cannot_have_any() -> None:
    assert lugs(study(pin="lugs = false"))["P"] == ()
    with pytest.raises(InputError, match=r"pin.P: lugs = false, but lugs are given"):
        study(pin="lugs = false\nlug.M = {}")


def test_a_pin_that_a_case_clamps_gets_none() -> None:
    text = study().text.replace('"given"', '"given"\nclamp = { P = ["end"] }')
    assert not parse_study(Path("study.toml"), text).table.pin["P"].lug


def test_a_mistake_in_the_defaults_is_reported_once_at_their_line() -> None:
    for wrong, message in (
        ("edge_radius = -1", r"study.toml:\d+: lug_defaults.edge_radius: must not be negative"),
        ('material = "brass"', r"study.toml:\d+: lug_defaults.material: no material 'brass'"),
        ("gap = 1", r"study.toml:\d+: lug_defaults: unknown key 'gap'"),
    ):
        with pytest.raises(InputError, match=message) as caught:
            study(DEFAULTS + wrong)
        assert len(caught.value.lines) == 1


@each("pin", ["", "lug.M = {}", "[pin.P.lug.M]", "lug = { M = {} }"])
@each("name", EVERY)
def test_a_number_that_only_the_defaults_give_has_a_key(pin: str, name: str) -> None:
    key, old = f"pin.P.lug.{name}.clearance", study(pin=pin)
    assert number_at(old, key).nominal == pytest.approx(2e-5)
    (lug,) = (x for x in prepare(changed_study(old, {key: 0.05})).tasks[0].lugs
              if x.connection == name)  # fmt: skip
    assert lug.clearance == pytest.approx(5e-5)
    others = [x for x in prepare(changed_study(old, {key: 0.05})).tasks[0].lugs if x != lug]
    assert {x.clearance for x in others} == {2e-5}


def test_a_number_of_a_table_that_only_the_defaults_give_has_a_key() -> None:
    defaults = DEFAULTS + 'bushing = { thickness = 1, material = "bronze" }\n'
    old, key = study(defaults), "pin.P.lug.M.bushing.thickness"
    assert number_at(old, key).nominal == pytest.approx(1e-3)
    new = changed_study(old, {key: 2}).table.pin["P"].lug
    rings = [new[name].bushing for name in EVERY]
    assert [x and x.thickness for x in rings] == pytest.approx([1e-3, 2e-3, 1e-3])


def test_designs_of_a_sweep_are_those_of_the_changed_text() -> None:
    old = study()
    for key, changed in (("lug_defaults.clearance", EVERY), ("pin.P.lug.M.clearance", ("M",))):
        design = Evaluator(old, [number_at(old, key)], ["P"]).changed([1e-4])
        clearances = {lug.connection: lug.clearance for lug in prepare(design).tasks[0].lugs}
        assert clearances == {name: 1e-4 if name in changed else 2e-5 for name in EVERY}
        assert lugs(design) == lugs(changed_study(old, {key: "0.1 mm"}))


def test_a_curve_against_the_clearance_of_all_lugs_has_the_answers_of_the_engine() -> None:
    old = study(joints="foundation")
    (first, _, last) = curve(old, "lug_defaults.clearance", (0.0, 0.04), 3, ["P"]).points
    row = Engine(old).row({"lug_defaults.clearance": 0.04}, "P", "pull")
    assert last.max_von_mises == pytest.approx(row.max_von_mises, rel=1e-9)
    # The error of a beam on foundations grows with the clearance, its stress here does not.
    assert last.error_estimate == pytest.approx(row.error_estimate, rel=1e-9)
    assert first.error_estimate is not None
    assert row.error_estimate is not None
    assert first.error_estimate < 0.9 * row.error_estimate


def test_an_eye_that_the_defaults_give_grows_with_its_pin() -> None:
    """To 1.5 times its bore, in the text that `size` writes, and for this pin alone."""
    new = resized_study(study(), {"P": 2.0})
    eyes = [new.table.pin["P"].lug[name].outer_diameter for name in EVERY]
    assert eyes == pytest.approx([1.5 * 0.04] * 3)
    assert new.table.lug_defaults is not None
    assert math.isclose(new.table.lug_defaults.outer_diameter or 0.0, 0.05)
    assert lugs(parse_study(Path("study.toml"), new.text)) == lugs(new)


def test_friction_of_all_lugs_is_a_coefficient() -> None:
    assert study(DEFAULTS + "friction = 0.15").table.pin["P"].lug["M"].friction == 0.15
    for wrong, message in (
        ("friction = 1.5", "lug_defaults.friction: must be at most 1"),
        ("friction = -0.1", "lug_defaults.friction: must be at least 0"),
        ('friction = "15 %"', "lug_defaults.friction"),
    ):
        with pytest.raises(InputError, match=message):
            study(DEFAULTS + wrong)

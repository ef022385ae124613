"""What `check` finds before anything is solved: whatever would end or spoil a run later."""

from __future__ import annotations

from pathlib import Path

import pytest

import pinstress
from pinstress.cli.closing import report_missed
from pinstress.cli.commands import run_command_line
from pinstress.study.model.balance import given_warnings
from pinstress.study.reading.errors import InputError
from tests.support.described import describe
from tests.support.each import each

STUDIES = Path(__file__).parents[3] / "studies"
PIN = """title = "Link"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
[pin.P]
material = "steel"
CLAMP
profile = [
  { length = 10, diameter = 20, connection = "left" },
  { length = 20, diameter = 20, connection = "middle" },
  { length = 10, diameter = 20, connection = "right" },
]
[case.pull]
kind = "given"
FORCES
[analysis]
MODEL
"""
BALANCED = "forces = { left = [0, 1000], middle = [0, -2000], right = [0, 1000] }"
LUGS = "lug.left = {}\nlug.middle = {}\nlug.right = {}"
FREE = LUGS.replace("{}", '{ tilt = "free" }')


def study(clamp: str = "", forces: str = BALANCED, model: str = "") -> pinstress.Study:
    text = PIN.replace("CLAMP", clamp).replace("FORCES", forces).replace("MODEL", model)
    return pinstress.study_from(text)


@each(
    ("clamp", "forces", "says"),
    [
        ("", BALANCED, ""),
        ("", BALANCED.replace("-2000", "-1000"), "their resultant"),
        ("", f"{BALANCED}\nmoments = {{ middle = [20000, 0] }}", "their couple across the axis"),
        (LUGS, f"{BALANCED}\nmoments = {{ middle = [20000, 0] }}", ""),  # lugs resist tilting
        (FREE, f"{BALANCED}\nmoments = {{ middle = [20000, 0] }}", "their couple across the axis"),
        (LUGS, f"{BALANCED}\nmoments = {{ middle = [0, 0, 900] }}", "their torque about the axis"),
    ],
)
def test_loads_that_nothing_balances(clamp: str, forces: str, says: str) -> None:
    """By statics: lugs that resist tilting take couples across the axis; none takes a torque."""
    _, unheld, _ = describe(study(clamp, forces))
    assert bool(unheld) == bool(says)
    assert all(says in line for line in unheld)


@each("joints", ["contact", "foundation"])
@each(
    ("lugs", "forces"),
    [
        (FREE, f"{BALANCED}\nmoments = {{ middle = [20000, 0] }}"),
        (LUGS, BALANCED.replace("-2000", "-1000")),
        (LUGS, f"{BALANCED}\nmoments = {{ middle = [0, 0, 900] }}"),
        (LUGS, BALANCED.replace("-2000]", "-2000, 900]")),  # along the axis
    ],
)
def test_a_run_says_the_same_of_pins_that_nothing_holds(
    lugs: str, forces: str, joints: str
) -> None:
    """For whatever model of the lugs: it is the rule of statics, no failure of a solution."""
    asked = study(lugs, forces, f'joints = "{joints}"\ntolerance = 0.3')
    results = pinstress.run(asked)
    (row,) = results.pins
    assert (row.verdict, row.outcome, row.max_von_mises) == ("rigid", "not decided", None)
    assert report_missed(results, decide=False) == 1  # as `check`
    _, (said,), _ = describe(asked)
    assert row.note in said


def test_a_small_imbalance_is_a_warning() -> None:
    """Of 5 %, which the bands share."""
    (warning,) = given_warnings(study(forces=BALANCED.replace("-2000", "-1900")))
    assert "a force of 100 N" in warning


@each(
    ("clamp", "model", "code"),
    [
        (LUGS, 'model = "solid"', "model-without-contact"),
        (
            'hole = [{ z = 20, diameter = 5 }]\nclamp = ["start"]',
            'model = "harmonic"',
            "not-of-revolution",
        ),
        ('clamp = ["left", "middle", "right"]', "", "not-loaded"),
    ],
)
def test_cases_that_no_model_solves(clamp: str, model: str, code: str) -> None:
    """As a run would say, before it solves the others."""
    for command in (describe, pinstress.prepare):
        with pytest.raises(InputError) as error:
            command(study(clamp, model=model))
        assert error.value.code == code


@each(("key", "what"), [('pins = ["Q"]', "no pin 'Q'"), ('cases = ["push"]', "no case 'push'")])
def test_requirements_of_what_does_not_exist(key: str, what: str) -> None:
    with pytest.raises(InputError, match=what):
        study(model=f'[[require]]\n{key}\ncheck = "yield"\nfactor = 2')


def test_a_table_with_one_time_has_one_instant(tmp_path: Path) -> None:
    """It had "1 instants"."""
    (tmp_path / "one.csv").write_text(
        "time,left.fx,left.fy,middle.fx,middle.fy,right.fx,right.fy\n0,0,1000,0,-2000,0,1000\n"
    )
    text = PIN.replace("CLAMP", FREE).replace("FORCES", 'table = "one.csv"').replace("MODEL", "")
    summary, _, _ = describe(pinstress.study_from(text, tmp_path))
    assert "given, one instant, " in summary


def test_many_instants_have_commas(tmp_path: Path) -> None:
    rows = "".join(f"{t},0,1000,0,-2000,0,1000\n" for t in range(1000))
    header = "time,left.fx,left.fy,middle.fx,middle.fy,right.fx,right.fy\n"
    (tmp_path / "many.csv").write_text(header + rows)
    text = PIN.replace("CLAMP", FREE).replace("FORCES", 'table = "many.csv"').replace("MODEL", "")
    summary, _, _ = describe(pinstress.study_from(text, tmp_path))
    assert "given, 1,000 instants, " in summary


def test_a_case_without_loads_is_noted() -> None:
    nothing = "forces = { left = [0, 0], middle = [0, 0], right = [0, 0] }"
    note = "every force and moment on the pins is zero"
    for forces, noted in ((nothing, True), (BALANCED, False)):
        summary, unheld, warnings = describe(study(forces=forces))
        assert (note in summary) == noted
        assert not unheld
        assert not warnings


@each(("clamp", "noted"), [('["middle"]', False), ('["taper"]', True), ('["end", "taper"]', True)])
def test_a_clamp_on_a_cone_is_said_to_hold_more_than_a_taper(clamp: str, noted: bool) -> None:
    """The pull along the axis leaves a tapered seat, but not a clamp."""
    taper = '  { length = 10, diameter = [20, 16], name = "taper" },\n]\n[case'
    text = PIN.replace("CLAMP", f"clamp = {clamp}").replace("FORCES", "forces = { left = [0, 9] }")
    cone = pinstress.study_from(text.replace("MODEL", "").replace("]\n[case", taper))
    said = "The clamp on the cone taper of pin P holds it in every direction, as if bonded"
    assert (said in describe(cone)[0]) == noted


def test_a_body_with_two_loads_is_named_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (STUDIES / "excavator.toml").read_text(encoding="utf-8")
    load = text[text.index("[[case.dig.apply]]") :]
    load = load[: load.index("\n[", 5) + 1]
    (study := tmp_path / "study.toml").write_text(text.replace(load, load + load))
    assert run_command_line(["check", str(study)]) == 0
    assert "loads on bucket\n" in capsys.readouterr().out

"""A drop in a study: through the mechanism, with its clause, and what is refused."""

from __future__ import annotations

import csv
import json
import pickle
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pinstress import InputError, load_study, study_from
from pinstress.analysis.gather.gather import loads_only
from pinstress.analysis.plan import all_loads, prepare
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import Study
from tests.conftest import ROOT
from tests.support.described import describe
from tests.support.each import each
from tests.support.errors import raises

SHIPPED = ROOT / "studies" / "drop.toml"
PART_25 = ROOT / "studies" / "landing_gear_part25.toml"


def vertical_leg(**case: Any) -> dict[str, Any]:
    """A telescopic leg, vertical, whose sliding parts have the unsprung mass of the drop."""
    return {
        "title": "vertical leg",
        "units": "m-N-s",
        "case": {
            "fall": {
                "kind": "drop",
                "mass": 500.0,
                "unsprung": 30.0,
                "velocity": 3.0,
                "lift": 0.5,
                "body": "piston",
                "at": "W",
                "strut": {
                    "drive": "S",
                    "stroke": 0.3,
                    "gas": {"pressure": 8e5, "volume": 0.0015, "area": 4e-3},
                    "oil": {"density": 860.0, "area": 4e-3, "orifice": 1.2e-4},
                    "friction": 200.0,
                },
                "tyre": {"at": [0.08, 2e4], "exponent": 1.2},
                **case,
            }
        },
        "mechanism": {
            "drive": {"slider": "S"},
            "slider": {"S": {"bodies": ["ground", "piston"], "joints": ["T", "W"]}},
            "joint": {
                "T": {"at": [0.0, 0.0], "fixed_in": "ground", "connections": {"T": "brace"}},
                "W": {"at": [0.0, -1.0], "fixed_in": "piston", "connections": {"W": "wheel"}},
            },
            "body": {
                "piston": {"mass": 20.0, "centre": [0.0, -0.8], "inertia": 1.0},
                "wheel": {"mass": 10.0, "centre": [0.0, -1.0]},
                "brace": {"mass": 0.0, "centre": [0.0, 0.0]},
            },
        },
    }


def test_inverse_dynamics_in_falling_axes_give_the_force_of_the_strut() -> None:
    """The mechanism knows nothing of gas and oil: only the ground's force, masses, and motion."""
    loads = all_loads(study_from(vertical_leg()), ["fall"])["fall"]
    assert loads.dynamics is not None
    assert loads.landing is not None
    strut = loads.landing.at(loads.dynamics.motion.times).forces.along
    np.testing.assert_allclose(loads.dynamics.drive[:, 0], strut, atol=1e-8 * strut.max())
    length = loads.dynamics.motion.drives[:, 0]
    assert 1.0 - length.min() == pytest.approx(loads.landing.peaks["stroke"].value, rel=1e-3)


def test_a_drop_can_be_sent_to_another_process() -> None:
    loads = all_loads(study_from(vertical_leg()), ["fall"])["fall"]
    sent = pickle.loads(pickle.dumps(loads))
    times = np.array([0.05, 0.1])
    np.testing.assert_array_equal(sent.moving.at(times)[0].forces, loads.moving.at(times)[0].forces)  # type: ignore[union-attr]


def test_levers_carry_the_energy_of_the_strut() -> None:
    """Virtual work: the strut of the arm does at the wheel what it does along itself."""
    loads = all_loads(load_study(SHIPPED), ["landing"])["landing"]
    assert loads.landing is not None
    h = loads.landing.at(np.linspace(0.0, 0.6, 4001))
    moving = np.abs(h.rise_rate) > 1e-6
    power = h.forces.at_wheel * h.rise_rate
    np.testing.assert_allclose(
        power[moving], (h.forces.along * h.forces.speed)[moving], atol=1e-6 * power.max()
    )
    way = np.trapezoid(np.maximum(h.forces.speed, 0.0), h.times)
    assert way == pytest.approx(loads.landing.peaks["stroke"].value, rel=1e-4)


@pytest.fixture(scope="module")
def shipped() -> Study:
    return load_study(SHIPPED)


def test_the_record_states_clause_and_impulse(shipped: Study) -> None:
    results = loads_only(shipped)
    (drop,) = results.drops
    assert "23.473(d)" in drop.clause
    assert drop.imbalance < 1e-10
    peak = drop.peaks["vertical"].value
    assert drop.load_factor == pytest.approx(peak / (550.0 * 9.80665))
    assert drop.impulse_force * drop.impulse_time == pytest.approx(peak * drop.equal_impulse_time)
    assert peak >= drop.vertical.max()
    ground = next(r for r in results.reactions if r.case == "drag")
    assert "23.479(b)" in ground.note
    w = ground.forces[0, ground.connections.index("B")]
    assert np.linalg.norm(w) > peak


@pytest.mark.slow
def test_files_of_a_drop(tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert run_command_line(["loads", str(SHIPPED), "--out", str(out)]) == 0
    rows = list(csv.DictReader((out / "landing.csv").read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 301
    assert float(rows[0]["sprung_velocity"]) == pytest.approx(2654.6, abs=0.1)
    found = json.loads((out / "results.json").read_text(encoding="utf-8"))["drops"][0]
    assert found["peaks"]["vertical"]["value"] >= max(float(r["vertical"]) for r in rows)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert 'id="drop"' in page
    assert "equal" not in found["clause"]


def test_side_loads_are_stated_and_not_applied() -> None:
    table = vertical_leg()
    table["case"]["side"] = {
        "kind": "ground", "rule": "23.499-side", "reference": 1000.0, "body": "piston", "at": "W",
    }  # fmt: skip
    loads = all_loads(study_from(table), ["side"])["side"]
    assert "side 1.575 × 1,000 = 1,575 N left, at the axle" in loads.note
    assert loads.dynamics is not None
    assert loads.dynamics.drive[0, 0] == pytest.approx(2250.0 - 30.0 * 9.80665)


@each(
    ("case", "code"),
    [
        ({"velocity": None}, "no-velocity"),
        ({"weight": 5000.0}, "give-one"),
        ({"unsprung": 600.0}, "unsprung-too-large"),
        ({"tyre": {"deflection": [0, 0.1, 0.05], "force": [0, 1, 2]}}, "not-increasing"),
        ({"tyre": {"deflection": [0, 0.1], "force": [0, 1, 2]}}, "lengths-differ"),
        ({"tyre": {}}, "give-one"),
        ({"at": "nowhere"}, "unknown-joint"),
        ({"rule": "23.473", "velocity": None}, "no-wing-loading"),
    ],
)
def test_mistakes_have_codes(case: dict[str, Any], code: str) -> None:
    given = vertical_leg(**case)
    fall = given["case"]["fall"]
    given["case"]["fall"] = {key: value for key, value in fall.items() if value is not None}
    with pytest.raises(InputError) as caught:
        describe(study_from(given))
    assert code in caught.value.codes


@each(
    ("part", "values", "code", "named"),
    [
        ("gas", {"volume": -1.0}, "not-positive", ""),
        ("gas", {"volume": 1e-4}, "stroke-exceeds-gas", "the extended strut has 0.0001 {}^3"),
        ("oil", {"orifice": 0.0}, "not-positive", ""),
        ("oil", {"orifice": 1.0}, "orifice-too-large", "an orifice of 1 {}^2"),
    ],
)
def test_mistakes_of_the_strut(part: str, values: dict[str, float], code: str, named: str) -> None:
    """The message has the numbers as the study states them, in its own units."""
    for units, length in (("m-N-s", "m"), ("mm-N-s", "mm"), ("in-lbf-s", "in")):
        given = vertical_leg() | {"units": units}
        given["case"]["fall"]["strut"][part] |= values
        with raises(InputError, code, named.format(length)):
            describe(study_from(given))


def test_a_strut_that_bottoms_is_an_error_of_the_case() -> None:
    given = vertical_leg(velocity=9.0)
    with pytest.raises(InputError) as caught:
        all_loads(study_from(given), ["fall"])
    assert caught.value.codes == ("strut-bottoms",)


HELD_ARM = """
title = "An arm against a stop"
units = "in-lbf-s"
[mechanism]
gravity = [0, 0]
[mechanism.joint.O]
at = [0, 0]
fixed_in = "ground"
connections = { O = "arm" }
[mechanism.body.arm]
[mechanism.stop.rest]
bodies = ["ground", "arm"]
carries = "negative"
[case.pushed]
kind = "static"
hold = ["rest"]
apply = [{ body = "arm", at = [10, 0], force = [0, -25] }]
"""


def test_messages_of_loads_are_in_the_units_of_the_study() -> None:
    """25 lbf at 10 in need a couple of 250 lbf in; the strut of a leg in mm bottoms at 130 mm."""
    with raises(InputError, "stop-opens", "would have to carry 250 lbf in: it opens"):
        all_loads(study_from(tomllib.loads(HELD_ARM)), ["pushed"])
    fast = tomllib.loads(SHIPPED.read_text(encoding="utf-8"))
    fall = fast["case"]["landing"]
    del fall["rule"], fall["wing_loading"]
    fall |= {"velocity": "9 m/s", "lift": 0.5}
    with raises(InputError, "strut-bottoms", "bottoms at 130 mm ", " mm/s ", " N mm are left"):
        all_loads(study_from(fast), ["landing"])


def test_pins_fall_with_the_aircraft() -> None:
    """Pin C, which nothing holds, is in balance with its own mass times gravity less the
    deceleration, which is up to 3.25 times gravity; its weight in the linkage is that of its shape.
    """
    lines = PART_25.read_text(encoding="utf-8").splitlines()
    weighed = [x for x in lines if not x.startswith("weight = { value = 4.557257799558378")]
    assert len(weighed) == len(lines) - 1
    study = study_from("\n".join(weighed), PART_25.parent)
    plan = prepare(study, pins=["C"], cases=["landing-weight", "reserve-energy"])
    (task,) = plan.tasks
    mass = (task.material.density or 0.0) * task.pin.volume
    for loads, factor in zip(task.loads, (3.25, 3.9), strict=True):
        inertia = mass * np.broadcast_to(loads.body, (len(loads), 3))
        assert np.abs(inertia).max() == pytest.approx((1.0 + factor) * 9.80665 * mass, rel=0.01)
        residual = loads.forces.sum(axis=1) + inertia
        assert np.abs(residual[:, :2]).max() < 1e-6 * np.abs(inertia).max()

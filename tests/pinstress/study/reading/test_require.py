"""[[require]]: what it means for each pin and case, and what is said of mistakes in it."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from pinstress import changed_study, load_study, study_from
from pinstress.study.model.requirements import (
    required_factor,
    required_factors,
    stated_requirements,
)
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from tests.support.each import each

PIN = """
[pin.{name}]
material = "steel"
clamp = ["start"]
profile = [{{ length = 0.02, diameter = 0.02, connection = "{name}" }}]
"""
TEXT = (
    """
title = "Two pins, two cases"
units = "m-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "235 MPa"
[case.pull]
kind = "given"
forces = { P = [100, 0], Q = [100, 0] }
[case.push]
kind = "given"
forces = { P = [-100, 0] }
"""
    + PIN.format(name="P")
    + PIN.format(name="Q")
)
ROWS = [("P", "pull"), ("P", "push"), ("Q", "pull")]


def study(require: str, analysis: str = "") -> Study:
    return study_from(f"{TEXT}[analysis]\n{analysis}\n{require}")


def require(**keys: Any) -> str:
    lines = (f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
    return f"[[require]]\n{''.join(lines)}"


def test_the_factor_against_yield_of_each_row() -> None:
    """Another one at limit load replaces that of the study; proof load comes on top."""
    default = "required_safety_factor = 2"
    on_p = require(pins=["P"], cases=["push"], check="yield", factor=1.2)
    proof = require(check="yield", level="proof", factor=1.5)

    def factors(text: str, analysis: str) -> list[float | None]:
        return [required_factor(study(text, analysis), *row) for row in ROWS]

    assert factors("", "") == [None, None, None]
    assert factors("", default) == [2.0, 2.0, 2.0]
    assert factors(on_p, default) == [2.0, 1.2, 2.0]
    assert factors(on_p + proof, default) == [2.0, 1.5, 2.0]
    assert factors(proof, "") == [1.5, 1.5, 1.5]
    assert factors(require(check="rupture", factor=9.0), default) == [2.0, 2.0, 2.0]
    assert required_factors(study(on_p, default), "P", ["pull", "push"]) == {"push": 1.2}
    assert required_factors(study("", default), "P", ["pull", "push"]) == {}


def test_levels_by_default() -> None:
    text = "".join(
        require(check=check, factor=1.5)
        for check in ("yield", "rupture", "limit load", "bearing", "shear", "fatigue")
    )
    found = {r.check: r.level for r in stated_requirements(study(text), ROWS, "PQ", ["pull"])}
    assert found == {
        "yield": "limit", "rupture": "ultimate", "limit load": "ultimate", "bearing": "limit",
        "shear": "limit", "fatigue": "limit",
    }  # fmt: skip


def test_rows_that_are_required_and_what_is_left_out() -> None:
    text = require(pins=["P", "Q"], cases=["push"], check="rupture", factor=1.5)
    text += require(check="shear", factor=1.5) + require(pins=["Q"], check="fatigue", factor=2.0)
    found = {
        (r.check, r.pin, r.case): r.needs
        for r in stated_requirements(study(text), ROWS, ("P", "Q"), ("pull", "push"))
    }
    assert found == {
        ("rupture", "P", "push"): "",
        ("rupture", "Q", "push"): "a load on pin Q in case push",
        **{("shear", pin, case): "" for pin, case in ROWS},
        ("fatigue", "Q", ""): "",
    }
    found = {
        (r.check, r.pin, r.case): r.needs
        for r in stated_requirements(study(text), [("P", "pull")], ("P",), ("pull",))
    }
    assert found == {
        ("rupture", "P", "push"): "case push to be run",
        ("rupture", "Q", "push"): "pin Q to be run",
        ("shear", "P", "pull"): "",
        ("fatigue", "Q", ""): "pin Q to be run",
    }


@each(
    ("text", "message"),
    [
        (require(pins=["R"], check="yield", factor=2), r"require\[1\]\.pins: no pin 'R'; "),
        (require(cases=["pul"], check="yield", factor=2),
         r"require\[1\]\.cases: no case 'pul'; did you mean 'pull'\?"),
        (require(check="yield", factor=0), r"require\[1\]\.factor"),
        (require(check="yield", factor=-1.5), r"require\[1\]\.factor"),
        (require(check="yield"), r"require\[1\]\.factor is missing|require\[1\].*factor"),
        (require(factor=2), r"require\[1\].*check"),
        (require(check="yeild", factor=2), r"require\[1\]\.check"),
        (require(check="yield", factor=2, margin=1), r"require\[1\].*margin"),
        (require(pins=[], check="yield", factor=2), r"require\[1\]\.pins"),
        (require(check="yield", level="ultimate", factor=2),
         r"require\[1\]\.level: yield is not required at ultimate load; use 'limit' or 'proof'"),
        (require(check="rupture", level="limit", factor=2), r"require\[1\]\.level: rupture is not"),
        (require(check="fatigue", cases=["pull"], factor=2), r"require\[1\]\.cases: fatigue is"),
        (require(check="yield", factor=2) + require(pins=["P"], check="yield", factor=3),
         r"require\[2\]: yield of pin P in case pull is required at limit load by require\[1\]"),
        (require(check="fatigue", factor=2) + require(check="fatigue", factor=3),
         r"require\[2\]: fatigue of pin P is required"),
    ],
)  # fmt: skip
def test_mistakes_are_one_message_with_a_key(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "s.toml"
    path.write_text(TEXT + text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        load_study(path)
    said = str(error.value)
    assert len(error.value.lines) == 1, said
    assert re.match(rf"{re.escape(str(path))}:\d+: ", said), said
    assert re.search(message, said), said


def test_levels_and_places_do_not_clash() -> None:
    text = require(check="yield", factor=1.5) + require(check="yield", level="proof", factor=1.2)
    text += require(check="shear", factor=2.0, pins=["P"])
    text += require(check="shear", factor=3.0, pins=["Q"])
    assert len(study(text).table.require) == 4


def test_a_factor_can_be_changed_by_its_key() -> None:
    text = require(pins=["P"], check="yield", factor=1.5)
    changed = changed_study(study(text), {"require[1].factor": 2.5})
    assert required_factor(changed, "P", "pull") == 2.5

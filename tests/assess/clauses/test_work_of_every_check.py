"""Every check by formula shows its formula with numbers, what would just pass, and what it leaves
out; and what it says would pass does.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace

import pytest

from assess.checks import margins_of
from assess.margin import Margin
from assess.situation import Situation
from assess.work import Work
from fea.support.lugs.lug import Lug
from geometry import Pin
from tests.assess.clauses.test_affdl import joint_of_table
from tests.assess.clauses.test_melcon_hoblit import lug_at
from tests.assess.strength.test_strength import S235, in_double_shear
from tests.support.each import each
from tests.support.pins.plain_pins import double_shear

METAL = replace(S235, shear_strength=200e6, bearing_strength=500e6)


def clevis(d: float = 0.016, outer: float = 0.01, middle: float = 0.02) -> Situation:
    """A replaceable pin in loose lugs, by three codes."""
    s = in_double_shear(outer, 0.001, middle, d, 20e3, METAL)
    lugs = tuple(Lug(name, 0.05, METAL, clearance=0.0003) for name in "ABC")
    return replace(
        s, lugs=lugs, sized=lugs, replaceable=True, codes=("general", "civil", "lifting"),
        design_factor=2.0,
    )  # fmt: skip


def made(s: Situation) -> list[Margin]:
    by_formula = (m for m in margins_of(s) if m.kind in ("hand", "clause"))
    return [m for m in by_formula if not m.needs and m.governs]


@each("of", [clevis(), joint_of_table(), lug_at(45.0), lug_at(0.0)])
def test_work_and_what_would_pass(of: Situation) -> None:
    margins = made(of)
    assert not {m.method for m in margins if not m.work}
    assert not {m.method for m in margins if not m.omits}
    without = {m.method for m in margins if m.passing is None}
    assert without <= {"AISC shear rupture"}  # whose planes a round head of any width has


PYTHON = {"×": "*", "−": "-", "√3": "sqrt(3)", "√": "sqrt", "²": "**2", "^": "**", "π": "pi"}


def evaluated(shown: Work) -> float:
    """What a formula gives as it is printed; of one "with" others, what comes before them."""
    text = shown.formula.split(" with ")[0]
    for sign, python in PYTHON.items():
        text = text.replace(sign, python)
    numbers = {q.symbol: q.value for q in shown.quantities}
    text = re.sub(r"\{(.+?)\}", lambda m: f"({numbers[m[1]]!r})", text)
    names = {"sqrt": math.sqrt, "pi": math.pi, "min": min, "max": max}
    return float(eval(text, {"__builtins__": {}}, names))


@each("of", [clevis(), joint_of_table(), *(lug_at(x) for x in (0.0, 45.0, 90.0))])
def test_what_is_printed_gives_the_result(of: Situation) -> None:
    """Each formula with its numbers; the last of a check is what it demands or allows."""
    for m in made(of):
        for shown in m.work:
            assert evaluated(shown) == pytest.approx(shown.result.value, rel=1e-9), m.method
        last = m.work[-1].result.value
        assert any(x == pytest.approx(last, rel=1e-9) for x in (m.demand, m.allowable)), m.method


def test_the_forces_that_are_printed_are_those_of_statics() -> None:
    """Half of 20 kN goes to each side; the moments are those of Shigley's beam."""
    printed = {m.method: {q.symbol: q.value for q in m.work[0].quantities} for m in made(clevis())}
    assert printed["single shear, mean"]["V"] == pytest.approx(10e3)
    assert printed["single shear, at the neutral axis"]["V"] == pytest.approx(10e3)
    assert printed["double shear, mean"]["F"] == pytest.approx(20e3)
    assert printed["bending"]["M"] == pytest.approx(10e3 * (0.005 + 0.001 + 0.005))


@each(
    "method",
    [
        "double shear, mean", "bearing", "plastic bending and shear", "EN 1993 shear and bending",
        "EN 1993 contact, replaceable", "EN 1993-1-1 section",
    ],
)  # fmt: skip
def test_what_would_pass_passes(method: str) -> None:
    """Along with thickness the gap and the span change, which nominal stress on bands does not
    feel; for a diameter the pin alone changes.
    """
    first = max((m for m in made(clevis()) if m.method == method), key=lambda m: m.used)
    assert first.passing is not None
    value = first.passing.value
    changed = clevis(d=value)
    if first.passing.symbol == "thickness":
        scale = value / (0.02 if first.at == "B" else 0.01)
        changed = clevis(outer=0.01 * scale, middle=0.02 * scale)
    again = max(m.used for m in made(changed) if m.method == method)
    assert again == pytest.approx(1.0, rel=1e-3)


def test_the_diameter_of_an_affdl_joint() -> None:
    """Of the example, whose pin bends first; with it lugs and bushings govern at last."""
    s = joint_of_table()
    heavy = replace(s, loads=replace(s.loads, forces=1.1 * s.loads.forces))
    (joint,) = (m for m in made(heavy) if m.method == "AFFDL joint in double shear")
    assert joint.passing is not None
    thicker: Pin = double_shear(0.0127, 0.00254, 0.01905, joint.passing.value)
    (again,) = (
        m
        for m in made(replace(heavy, profile=thicker))
        if m.method == "AFFDL joint in double shear"
    )
    assert again.used == pytest.approx(1.0, abs=0.02)  # bushings are wider then, too
    assert again.used <= 1.0


@each("degrees", [30.0, 60.0])
def test_the_thickness_of_an_oblique_lug(degrees: float) -> None:
    (oblique,) = (m for m in made(lug_at(degrees)) if m.method == "Melcon-Hoblit oblique")
    assert oblique.passing is not None
    assert oblique.passing.symbol == "thickness"
    assert oblique.passing.value == pytest.approx(0.0127 * oblique.used)

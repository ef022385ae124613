"""Press fits whose interference has a range: what it says at its middle, or at its tightest end
alone, is not what its worst end does.
"""

from __future__ import annotations

from typing import Any

import pytest

import pinstress
from assess.margin import Margin
from pinstress.study.model.lost_fits import lost_fit_warnings
from reports.data.headline import worst_checks
from tests.support.each import each
from tests.support.pins.studies import DOUBLE_SHEAR

BORE = 25683.0  # psi: AFFDL-TR-69-42, 9.16, bronze pressed in by 0.001 in


def ring(**lug: Any) -> pinstress.RunResults:
    """The ring of AFFDL-TR-69-42, 9.16: radii 0.1875, 0.25 and 0.75 in."""
    plate = {"youngs_modulus": 10.3e6, "poisson_ratio": 0.33, "yield_strength": 66e3}
    bronze = {"youngs_modulus": 16.0e6, "poisson_ratio": 0.33, "yield_strength": 30e3}
    left: dict[str, Any] = {"material": "plate", "outer_diameter": 1.5}
    bushing = {"thickness": 0.0625, "material": "bronze", "interference": 0.001}
    profile = [{"length": 0.5, "diameter": 0.375, "connection": name} for name in "LR"]
    raw = {
        "title": "A pin pressed into a pressed bushing",
        "units": "in-lbf-s",
        "analysis": {"joints": "prescribed", "required_safety_factor": 1.25, "model": "beam",
                     "tolerance": 0.9},
        "material": {"plate": plate, "bronze": bronze},
        "case": {"pull": {"kind": "given", "forces": {"L": [-10, 0], "R": [10, 0]}}},
        "pin": {
            "P": {
                "material": "plate",
                "profile": profile,
                "lug": {"L": left, "R": {**left, "bushing": bushing, **lug}},
            },
        },
    }  # fmt: skip
    return pinstress.run(pinstress.study_from(raw))


def press_fits(results: pinstress.RunResults) -> list[Margin]:
    """Of the pin, if it is pressed in, bushing and eye."""
    return [m for m in results["P", "pull"].margins if "press fit" in m.method]


def pressed_bushing(results: pinstress.RunResults) -> list[Margin]:
    """The margins of bushing and eye."""
    return press_fits(results)[-2:]


def test_a_pin_that_may_be_pressed_in_does_not_relieve_its_bushing() -> None:
    """The bushing, pressed together by its hole, is widened by the pin: with the most interference
    of both it passed, 30 ksi over 1.25 being 24. With the least of the pin it has 25.7.
    """
    least, most, over = (
        ring(clearance=0.0),
        ring(clearance=-0.0003),
        ring(clearance=-0.0003, range={"clearance": [-0.0003, 0.0]}),
    )
    assert pressed_bushing(least)[0].demand == pytest.approx(BORE, abs=1.0)
    assert (pressed_bushing(most)[0].demand or 0.0) < 24e3
    for wall in (0, 1):
        ends = [pressed_bushing(x)[wall].demand or 0.0 for x in (least, most)]
        assert pressed_bushing(over)[wall].demand == pytest.approx(max(ends), rel=1e-9)
    assert (pressed_bushing(most)[0].margin or 0.0) > 0.0
    for results in (least, over):
        worst = worst_checks(results)["P"]
        assert (worst.outcome, worst.check) == ("fails", "press fit, bushing")


def test_a_hollow_pin_pressed_in_is_judged_with_prescribed_loads() -> None:
    """Lame: the hoop stress at the bore is 2 p b^2 / (b^2 - a^2), with p by the interference. No
    row of prescribed loads has it, and no margin had.
    """
    a, b, c, E, nu, interference = 8.0, 10.0, 25.0, 210e3, 0.3, 0.02  # mm, MPa
    eye = (c * c + b * b) / (c * c - b * b) + nu
    tube = (b * b + a * a) / (b * b - a * a) - nu
    p = interference / (2.0 * b) * E / (eye + tube)
    hoop = 2.0 * p * b * b / (b * b - a * a)
    steel = {"youngs_modulus": E, "poisson_ratio": nu, "yield_strength": 1.1 * hoop}
    profile = [{"length": 20, "diameter": 20, "bore": 16, "connection": x} for x in "LR"]
    lug = {"outer_diameter": 50, "clearance": -interference}
    raw = {
        "title": "A hollow pin pressed in",
        "units": "mm-N-s",
        "analysis": {"joints": "prescribed", "required_safety_factor": 1.25, "model": "beam",
                     "tolerance": 0.9},
        "material": {"steel": steel},
        "case": {"pull": {"kind": "given", "forces": {"L": [-10, 0], "R": [10, 0]}}},
        "pin": {"P": {"material": "steel", "profile": profile, "lug": {"L": lug, "R": lug}}},
    }  # fmt: skip
    results = pinstress.run(pinstress.study_from(raw))
    of_pin = [m for m in press_fits(results) if m.method == "press fit, pin"]
    assert [m.at for m in of_pin] == ["L", "R"]
    assert [m.demand for m in of_pin] == pytest.approx([hoop] * 2, rel=1e-9)
    assert [m.margin for m in of_pin] == pytest.approx([1.1 / 1.25 - 1.0] * 2)
    worst = worst_checks(results)["P"]
    assert (worst.outcome, worst.check) == ("fails", "press fit, pin")


HOT = f"""
title = "A pin pressed into aluminium"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "900 MPa"
thermal_expansion = "12e-6 1/K"
[material.aluminium]
youngs_modulus = "70 GPa"
poisson_ratio = 0.33
yield_strength = "400 MPa"
thermal_expansion = "23.4e-6 1/K"
[case.hot]
kind = "given"
temperature = "120 degC"
forces = {{ L = [-9000, 0], M = [18000, 0], R = [-9000, 0] }}
[lug_defaults]
outer_diameter = 50
material = "aluminium"
FIT
[pin.P]
material = "steel"
profile = {DOUBLE_SHEAR}
"""


@each("fit,opens", [
    ("clearance = -0.03", ""),
    ("clearance = -0.03\nrange = { clearance = [-0.04, -0.03] }", ""),
    ("clearance = -0.03\nrange = { clearance = [-0.04, -0.01] }", "63.9 degC"),
    ('clearance = "-0.00118110236 in"\nrange = { clearance = ["-0.04 mm", "-0.01 mm"] }',
     "63.9 degC"),
    ("clearance = -0.01\nrange = { clearance = [-0.04, -0.01] }", "63.9 degC"),
])  # fmt: skip
def test_a_press_fit_is_lost_with_the_least_of_its_interferences(fit: str, opens: str) -> None:
    """11.4e-6 of 20 mm by 100 K are 0.0228 mm: 0.03 mm of interference hold, 0.01 are lost at
    20 degC + 0.01 / (11.4e-6 x 20) K.
    """
    plan = pinstress.prepare(pinstress.study_from(HOT.replace("FIT", fit)))
    said = lost_fit_warnings(plan.study, plan.tasks)
    assert len(said) == bool(opens)
    assert all(f"L above {opens}" in text for text in said)


def test_the_interference_that_would_pass_is_that_of_the_worst_end() -> None:
    """The nominal one was scaled by what the end of the range has used."""
    ranged = {"thickness": 0.0625, "material": "bronze", "interference": 0.001}
    single, over = (
        pressed_bushing(ring(clearance=0.001, bushing=ranged, **more))[0]
        for more in ({}, {"range": {"interference": [0.001, 0.002]}})
    )
    assert single.passing is not None
    assert over.passing is not None
    assert over.used == pytest.approx(2.0 * single.used, rel=1e-9)
    assert over.passing.value == pytest.approx(single.passing.value, rel=1e-9)

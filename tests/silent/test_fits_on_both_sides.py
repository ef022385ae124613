"""Fits that press or leave play within their range, or by the temperature of a case: a beam on
foundations ended in a traceback, and sweeps called a pin safe that had come loose.
"""

from __future__ import annotations

from dataclasses import replace

import pinstress
from pinstress import InputError, study_from
from pinstress.explore.reliability.assess import assess
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.explore.sweep.number import number_at
from reports.data.reliability import Spread
from tests.support.each import each
from tests.support.errors import raises
from tests.support.pins.studies import DOUBLE_SHEAR

STUDY = f"""
title = "A pin in double shear"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "700 MPa"
thermal_expansion = "12e-6 1/K"
[material.aluminium]
youngs_modulus = "70 GPa"
poisson_ratio = 0.33
yield_strength = "400 MPa"
thermal_expansion = "23e-6 1/K"
[analysis]
tolerance = 0.2
required_safety_factor = 1.5
limit_load = "never"
joints = "JOINTS"
[case.pull]
kind = "given"
temperature = "TEMPERATURE"
forces = {{ L = [-2500, 0], M = [5000, 0], R = [-2500, 0] }}
[lug_defaults]
outer_diameter = 50
edge_radius = 0.5
material = "aluminium"
FIT
[pin.P]
material = "steel"
profile = {DOUBLE_SHEAR}
lug.L = {{}}
"""
LOW_END = ("clearance", "low end of its range")


def study(fit: str, joints: str = "auto", temperature: str = "20 degC") -> pinstress.Study:
    text = STUDY.replace("JOINTS", joints).replace("TEMPERATURE", temperature)
    return study_from(text.replace("FIT", fit))


def solved(fit: str, joints: str, temperature: str = "20 degC") -> pinstress.RunResults:
    return pinstress.run(study(fit, joints, temperature))


def test_a_pin_that_may_be_pressed_in_is_solved_by_contact() -> None:
    """H7/js6 has a clearance in the middle and an interference at its end, which counts."""
    row = solved('fit = "H7/js6"', "auto")["P", "pull"]
    assert row.joint is not None
    assert row.joint.range is not None
    assert row.joint.model == "contact"
    assert LOW_END in [(v.what, v.value) for v in row.joint.range.variations]


def test_foundations_are_refused_where_a_range_ends_in_an_interference() -> None:
    with raises(InputError, "beyond-foundations", "lug L has an interference within its range"):
        pinstress.prepare(study('fit = "H7/js6"', "foundation"))


@each(("fit", "temperature", "omitted"), [
    ('fit = "H7/js6"', "20 degC", "clearance low end of its range"),
    ("clearance = -0.01", "100 degC", "clearance twice the given"),
    ("clearance = 0.02", "-40 degC", "clearance none"),
])  # fmt: skip
def test_the_range_about_prescribed_loads_says_that_it_has_no_interference(
    fit: str, temperature: str, omitted: str
) -> None:
    row = solved(fit, "prescribed", temperature)["P", "pull"]
    assert row.joint is not None
    assert row.joint.range is not None
    assert {v.what for v in row.joint.range.variations} > {"tilt"}
    assert f"not included: {omitted}" in row.joint.remark


@each("joints", ["contact", "prescribed"])
def test_a_pin_that_comes_loose_depends_in_designs_as_in_a_run(joints: str) -> None:
    loose = study("clearance = -0.01", joints, "100 degC")
    (row,) = pinstress.run(loose)
    key = "material.steel.yield_strength"
    (design,) = Evaluator(loose, [number_at(loose, key)]).rows([700e6])
    assert row.outcome == design.outcome == "depends"
    assert "press fit lost in L above 65.5 degC" in design.depends_on
    assert design.safety_factor == row.safety_factor


VARYING = """
[vary.parameters]
"case.pull.temperature" = { normal = ["62 degC", "8 degC"] }
[reliability]
probability = 0.1
samples = 20
importance_samples = 0
sobol_samples = 0
"""


@each("required", ["1.5", "50"])
def test_a_pin_that_comes_loose_in_many_random_designs_is_not_safe(required: str) -> None:
    """It holds at the mean of the temperature and lets go at 65.5 degC, in a third of the
    designs; the factor that the study requires does not matter.
    """
    text = STUDY.replace("JOINTS", "prescribed").replace("TEMPERATURE", "62 degC")
    text = text.replace("FIT", "clearance = -0.01").replace("factor = 1.5", f"factor = {required}")
    varying = study_from(text + VARYING)
    nominal = pinstress.run(varying)
    found = assess(varying, nominal, 1, lambda _, __: None)
    (risk,) = found.risks
    assert nominal.pins[0].lost_fits == ()
    assert risk.loose is not None
    assert 0.1 < risk.loose.value < 0.5
    assert risk.failures == 0
    assert risk.loose.value > found.probability
    sure = replace(risk, sampled=Spread(0.0, 0.0, 0.01), mesh=None)
    assert sure.result(found.probability) == "depends"
    # So few samples may show less than it is.
    rarely = replace(sure, loose=Spread(0.05, 0.001, 0.25))
    assert rarely.result(found.probability) == "depends"
    assert replace(sure, loose=None).result(found.probability) == "safe"

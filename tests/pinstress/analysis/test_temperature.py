"""Cases with a temperature: what it does to fits, what is refused, and that nothing is confused."""

from __future__ import annotations

from functools import cache

import pytest

import pinstress
from pinstress import InputError, prepare
from pinstress.analysis.engine import Engine
from pinstress.explore.sweep.laws import Normal
from pinstress.explore.sweep.parameters import parameters_of
from pinstress.study.model.lost_fits import lost_fit_warnings
from pinstress.study.model.tasks import Task
from pinstress.study.reading.in_python import study_from
from reports.data.overview import pin_lines
from reports.data.requirements import requirement_rows
from reports.data.row import PinResult
from reports.data.unknowns import decided_by, unknowns
from reports.format.words import headline
from reports.text.overview import actions
from tests.support.each import each
from tests.support.errors import raises
from tests.support.pins.remembered import remembered
from tests.support.pins.studies import DOUBLE_SHEAR
from tests.support.study_text import edited

LOADS = 'kind = "given"\nforces = { L = [-9000, 0], M = [18000, 0], R = [-9000, 0] }\n'
STUDY = f"""
title = "A pin in double shear, cold and hot"
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
thermal_expansion = "13e-6 1/degF"
[analysis]
tolerance = 0.2
required_safety_factor = 1.5
[case.cold]
{LOADS}
[case.hot]
temperature = "120 degC"
{LOADS}
[lug_defaults]
outer_diameter = 50
edge_radius = 0.5
clearance = 0.02
material = "aluminium"
[pin.P]
material = "steel"
profile = {DOUBLE_SHEAR}
"""
GROWTH = (23.4e-6 - 12e-6) * 0.02 * 100.0  # m
FIT = "clearance = 0.02\n"
# In its middle it holds; its least is that of BUSHED.
RANGED = (
    'bushing = { thickness = 2, material = "steel" }\nrange = { interference = [0.02, 0.06] }\n'
)
BUSHED = 'bushing = { thickness = 2, material = "steel", interference = 0.02 }\n'


def tasks_of(text: str) -> dict[str, Task]:
    """The task of each case."""
    return {x.case: task for task in prepare(study_from(text)).tasks for x in task.loads}


def changed(*changes: tuple[str, str], text: str = STUDY) -> str:
    return edited(text, changes)


def test_a_temperature_changes_the_clearance_in_its_case_alone() -> None:
    tasks = tasks_of(STUDY)
    assert [lug.clearance for lug in tasks["cold"].lugs] == [2e-5] * 3
    assert [x.clearance for x in tasks["hot"].lugs] == pytest.approx([2e-5 + GROWTH] * 3)


@each("spelled", ["393.15 K", "120 °C", "248 degF"])
def test_a_temperature_may_have_any_unit(spelled: str) -> None:
    hot = tasks_of(changed(("120 degC", spelled)))["hot"]
    assert hot.lugs[0].growth == pytest.approx(GROWTH, rel=1e-12)


def test_the_reference_temperature_is_that_of_the_dimensions() -> None:
    text = changed(("[analysis]", '[analysis]\nreference_temperature = "120 degC"'))
    assert tasks_of(text)["hot"].lugs[0].growth == 0.0
    assert tasks_of(text)["cold"].lugs[0].growth == 0.0
    half = changed(("[analysis]", '[analysis]\nreference_temperature = "158 degF"'))
    assert tasks_of(half)["hot"].lugs[0].growth == pytest.approx(GROWTH / 2.0)


def test_one_expansion_leaves_the_fits_and_one_task() -> None:
    text = changed(('thermal_expansion = "13e-6 1/degF"', 'thermal_expansion = "12e-6 1/K"'))
    (task,) = prepare(study_from(text)).tasks
    assert [x.case for x in task.loads] == ["cold", "hot"]


@each(
    ("changes", "code", "named"),
    [
        (
            (('thermal_expansion = "12e-6 1/K"\n', ""),),
            "no-expansion",
            (
                "material steel has no thermal_expansion",
                "lug L",
                "case.hot.temperature: ",
                "pin P",
                "11.7e-6",
            ),
        ),
        (
            (('thermal_expansion = "13e-6 1/degF"\n', ""),),
            "no-expansion",
            ("material aluminium has no thermal_expansion", "case.hot.temperature"),
        ),
        (
            ((FIT, FIT + BUSHED),),
            "loose-bushing",
            ("lug L of pin P", "loose at 120 degC", "used up at 93.1 degC", "more than 0.0274 mm"),
        ),
        (
            ((FIT, FIT + RANGED),),
            "loose-bushing",
            ("loose at 120 degC", "used up at 93.1 degC", "more than 0.0274 mm"),
        ),
        ((('"120 degC"', "120"),), "missing-unit", ("120 needs a unit", "degF or K")),
        ((('"120 degC"', '"-300 degC"'),), "out-of-range", ("absolute zero",)),
        ((('"120 degC"', '"120 mm"'),), "unknown-unit", ("degC",)),
        ((("12e-6 1/K", "12 1/K"),), "out-of-range", ("thermal_expansion", "12e-6 1/K")),
        ((("12e-6 1/K", "12e-6"),), "missing-unit", ("thermal_expansion", "1/degF")),
        (
            (('"120 degC"', '"-260 degC"'), (FIT, "clearance = -0.5\n")),
            "interference-too-large",
            ("pin P at -260 degC", "times what makes pin"),
        ),
        (
            ((FIT, FIT + BUSHED.replace("thickness = 2", "thickness = 15")),),
            "bushing-too-thick",
            ("times as thick as the wall",),
        ),
    ],
)
def test_what_is_refused_and_what_would_be_right(
    changes: tuple[tuple[str, str], ...], code: str, named: tuple[str, ...]
) -> None:
    with raises(InputError, code, *named):
        prepare(study_from(changed(*changes)))


def test_pins_without_lugs_need_no_expansion() -> None:
    text = changed(("[pin.P]", "[pin.P]\nlugs = false"), ('thermal_expansion = "12e-6 1/K"\n', ""))
    (task,) = prepare(study_from(text)).tasks
    assert not task.lugs


def test_the_lugs_around_prescribed_loads_are_at_the_temperature() -> None:
    hot = tasks_of(changed(("[analysis]", '[analysis]\njoints = "prescribed"')))["hot"]
    assert not hot.lugs
    assert hot.surroundings is not None
    for lugs in (hot.surroundings.lugs, hot.given):
        assert [lug.clearance for lug in lugs] == pytest.approx([2e-5 + GROWTH] * 3)


def test_a_pressed_bushing_that_holds_has_less_interference() -> None:
    text = changed((FIT, FIT + BUSHED.replace("0.02", "0.05")))
    bushing = tasks_of(text)["hot"].lugs[0].bushing
    assert bushing is not None
    assert bushing.misfit == pytest.approx(5e-5 - 0.024 * 11.4e-6 * 100.0)


@pytest.fixture(scope="module")
def loosened() -> pinstress.RunResults:
    strong = (
        'yield_strength = "900 MPa"\n',
        'yield_strength = "900 MPa"\nultimate_strength = 1000\n',
    )
    return remembered(study_from(changed((FIT, "clearance = -0.01\n"), strong)))


def test_a_pin_that_comes_loose_is_strong_enough_but_depends(
    loosened: pinstress.RunResults,
) -> None:
    cold, hot = loosened["P", "cold"], loosened["P", "hot"]
    assert (cold.outcome, hot.as_described, hot.outcome) == ("safe", "safe", "depends")
    (lost,) = (d for d in hot.depends_on if d.what == "press fit lost in")
    assert lost.value == ", ".join(f"{x} above 63.9 degC" for x in "LMR")
    assert lost.factor == hot.safety_factor


@pytest.mark.seconds
def test_that_a_pin_comes_loose_is_said_once_as_what_it_is(
    loosened: pinstress.RunResults,
) -> None:
    """It neither yields nor breaks; nothing that is open would have to be measured."""
    lost = "press fit lost in L above 63.9 degC, M above 63.9 degC, R above 63.9 degC"
    assert f"; hot), but comes loose ({lost})." in headline(loosened)
    rows = requirement_rows(loosened)
    assert [x.outcome for x in rows if (x.case, x.check) == ("hot", "rupture")] == ["met"]
    assert not decided_by(unknowns(loosened.pins))
    (needed,) = actions(loosened, pin_lines(loosened)).repairs
    assert needed == (
        "P needs an interference of more than 0.0228 mm, or something else that retains it (hot)."
    )


def test_a_pin_without_load_comes_loose_too() -> None:
    """It was safe, since no load stresses it."""
    parts = changed((FIT, "clearance = -0.01\n")).split("[case.hot]")
    text = parts[0] + "[case.hot]" + parts[1].replace("9000", "0").replace("18000", "0")
    results = pinstress.run(study_from(text), cases=["hot"])
    (hot,) = results.pins
    assert (hot.as_described, hot.outcome) == ("safe", "depends")
    said = "Pin P is safe as described (no load stresses it; hot), but comes loose (press fit lost"
    assert headline(results).startswith(said)
    (needed,) = actions(results, pin_lines(results)).repairs
    assert "more than 0.0228 mm" in needed


def loosening(interference: float) -> list[str]:
    """The warnings of a pin with so much interference, mm."""
    plan = prepare(study_from(changed((FIT, f"clearance = -{interference}\n"))))
    return lost_fit_warnings(plan.study, plan.tasks)


def test_a_pin_that_comes_loose_is_warned_of_and_what_is_said_to_hold_it_does() -> None:
    (warning,) = loosening(0.01)
    assert "case.hot.temperature: pin P is no longer pressed in at 120 degC" in warning
    assert "L above 63.9 degC" in warning
    assert "use an interference of more than 0.0228 mm" in warning
    assert not loosening(0.02281)
    assert loosening(0.0227)


@pytest.mark.seconds
def test_the_assumption_of_the_reference_is_said(loosened: pinstress.RunResults) -> None:
    (said,) = (x for x in loosened.assumptions if "Dimensions, clearances" in x)
    assert "at 20 degC (assumed)" in said
    assert "hot (120 degC)" in said
    assert "gradients" in said


@pytest.fixture(scope="module")
def both() -> pinstress.RunResults:
    """The pin, cold and hot, with a spectrum of both cases."""
    sn = "[material.steel.fatigue]\nknee_stress = 200\nknee_cycles = 1e6\n"
    sn += "slope = 5\nmean_stress_sensitivity = 0.2\n"
    text = changed(("[material.aluminium]", sn + "[material.aluminium]"))
    text += '[fatigue]\nmethod = "signed-von-mises"\noccurrences = { cold = 100, hot = 100 }\n'
    return remembered(study_from(text))


def test_a_hot_case_is_the_same_as_its_clearance_alone(both: pinstress.RunResults) -> None:
    """Two cases of one pin, and one asked after the other: no solution of contact is shared."""
    grown = f"clearance = {0.02 + 1e3 * GROWTH!r}\n"
    loose = pinstress.run(study_from(changed((FIT, grown), ("temperature", "# temperature"))))
    hot, cold, as_hot = both["P", "hot"], both["P", "cold"], loose["P", "hot"]
    assert hot.max_von_mises == pytest.approx(as_hot.max_von_mises, rel=1e-9)
    assert hot.max_von_mises != pytest.approx(cold.max_von_mises, rel=1e-4)
    ranged = [(x.joint.range, x.joint.bands) for x in (hot, as_hot) if x.joint]
    # the study's range is about its own clearance: from growth to twice the clearance and growth
    lengths = [
        [v.length for v in r.variations if v.what == "clearance"]
        for r, _ in ranged
        if r is not None
    ]
    assert lengths[0] == pytest.approx([1e3 * GROWTH, 0.04 + 1e3 * GROWTH])
    assert lengths[1] == pytest.approx([0.0, 0.04 + 2e3 * GROWTH])


@cache
def hotter() -> PinResult:
    """The row of a run with another temperature."""
    hotter_study = study_from(changed(("120 degC", "200 degC")))
    return pinstress.run(hotter_study, cases=["hot"])["P", "hot"]


@pytest.mark.long
@pytest.mark.slow
@each("accuracy", ["full", "quick"])
def test_an_engine_answers_a_temperature_as_a_run_does(accuracy: str) -> None:
    engine = Engine(study_from(STUDY), cases=["hot"])
    other = {"case.hot.temperature": "200 degC"}
    before = engine.answer(accuracy=accuracy)["P", "hot"]  # type: ignore[arg-type]
    asked = engine.answer(other, accuracy=accuracy)["P", "hot"]  # type: ignore[arg-type]
    again = engine.answer(accuracy=accuracy)["P", "hot"]  # type: ignore[arg-type]
    assert again.max_von_mises == before.max_von_mises != asked.max_von_mises
    close = 1e-9 if accuracy == "full" else 0.1
    assert asked.max_von_mises == pytest.approx(hotter().max_von_mises, rel=close)
    assert asked.joint is not None
    assert asked.joint.bands[0].clearance == pytest.approx(0.02 + 1.8e3 * GROWTH)


def test_a_temperature_varies_and_its_deviation_is_a_difference() -> None:
    for law, spread in (('["120 degC", "9 degF"]', 5.0), ('["120 degC", "5 degC"]', 5.0)):
        vary = f'[vary.parameters]\n"case.hot.temperature" = {{ normal = {law} }}\n'
        (one,) = parameters_of(study_from(STUDY + vary), sampled=False)
        assert isinstance(one.law, Normal)
        assert (one.law.mean, one.law.deviation) == pytest.approx((393.15, spread))
        assert one.law_text == "normal, mean 120 degC, deviation 5 degC"
        assert (
            one.number.in_study(one.number.shown(353.15)) == "80.0 degC"
        )  # 353.15 - 273.15 is not 80
    vary = '[vary.parameters]\n"case.hot.temperature" = { tolerance = "±6 degC" }\n'
    (one,) = parameters_of(study_from(STUDY + vary), sampled=False)
    assert isinstance(one.law, Normal)
    assert (one.law.low, one.law.high) == pytest.approx((387.15, 399.15))


def test_damage_over_different_fits_is_not_decided(both: pinstress.RunResults) -> None:
    assert both.fatigue is not None
    assert "fits at their temperatures differ" in both.fatigue.not_decided["P"]


@pytest.mark.slow
def test_a_quick_row_has_the_range_of_its_case_at_the_changed_temperature() -> None:
    """That of the temperature before was scaled, with which a fit may be loose and no longer is."""
    row = Engine(study_from(STUDY), pins=["P"]).row(
        {"case.hot.temperature": "20 degC"}, "P", "hot", accuracy="quick"
    )
    assert row.joint is not None
    assert row.joint.range is not None
    lengths = [v.length for v in row.joint.range.variations if v.length is not None]
    assert lengths == pytest.approx([0.0, 0.04])

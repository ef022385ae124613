"""Which numbers of a study can vary, and what is said of those that cannot."""

from __future__ import annotations

import math

import numpy as np
import pytest

from pinstress import InputError, load_study, shipped_studies, study_from
from pinstress.explore.sweep.correlations import correlations_of
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.explore.sweep.laws import Uniform
from pinstress.explore.sweep.number import number_at, unit_of
from pinstress.explore.sweep.parameters import parameters_of
from pinstress.study.schema.units import DIMENSION_EXPONENTS, UNIT_SYSTEMS, to_si
from tests.support.each import each
from tests.support.programs.swept import DIAMETER, FORCE, ONE_PIN, STRENGTH, swept, varied

LANDING_GEAR = shipped_studies()["landing_gear"]


def _wrong(parameters: str, head: str = 'sample = "sobol"') -> tuple[str, str]:
    try:
        study = swept(parameters, head)
        correlations_of(study, parameters_of(study))
    except InputError as error:
        return error.code, str(error)
    return "", "nothing is wrong"


def test_any_number_has_its_dimension_and_unit() -> None:
    """Of a study with a linkage: in SI, in the unit that tables have."""
    gear = load_study(LANDING_GEAR)
    expected = {
        "pin.E.profile[2].diameter": ("length", "in"),
        "case.landing.apply.impulse.impulse_time": ("time", "s"),
        "case.landing.apply[1].impulse.velocity_change": ("velocity", "in/s"),
        "material.AISI 4340.poisson_ratio": ("", ""),
        "material.AISI 4340.youngs_modulus": ("stress", "psi"),
        "material.AISI 4340.density": ("density", "lbf s^2/in^4"),
    }
    for key, (dimension, unit) in expected.items():
        number = number_at(gear, key)
        assert (number.dimension, number.unit) == (dimension, unit), key
        written = number.shown(number.nominal)
        system = gear.system
        si = to_si(number.in_study(written), dimension, system) if dimension else written
        assert si == pytest.approx(number.nominal, rel=1e-15)


def test_what_neighbours_have_in_common_varies_as_one() -> None:
    gear = load_study(LANDING_GEAR)
    (parameter,) = parameters_of(
        study_from(
            varied(
                '"pin.H.profile[1-5].diameter" = { from = 2, to = 3, steps = 2 }', text=gear.text
            ),
            LANDING_GEAR.parent,
        )
    )
    number = parameter.number
    assert number.nominal == pytest.approx(2.0 * 0.0254)
    assert [path[3] for path in number.paths] == [0, 1, 2, 3, 4]
    evaluator = Evaluator(gear, [number], ["H"])
    changed = evaluator.changed([0.06]).table.pin["H"].profile
    assert changed is not None
    assert [segment.diameter for segment in changed] == pytest.approx([0.06] * 5)
    text = '"pin.H.profile[1-5].diameter" = { from = 2, to = 3 }\n'
    text += '"pin.H.profile[2].diameter" = { from = 2, to = 3 }'
    with pytest.raises(InputError, match="names the same number"):
        parameters_of(study_from(varied(text, text=gear.text), LANDING_GEAR.parent))


def test_an_angle_varies_in_degrees() -> None:
    crank = load_study(shipped_studies()["slider_crank"])
    number = number_at(crank, "mechanism.drive[1].start")
    assert (number.dimension, number.unit) == ("angle", "deg")
    assert number.factor == pytest.approx(math.pi / 180.0)
    assert str(number.in_study(12.5)) == "12.5 deg"


@each("dimension", DIMENSION_EXPONENTS)
@each("system", UNIT_SYSTEMS.values())
def test_the_unit_of_a_dimension_can_be_read(dimension: str, system: object) -> None:
    """What a table names as a unit is that unit; radians are numbers."""
    found = UNIT_SYSTEMS[getattr(system, "name", "")]
    unit = unit_of(found, dimension)
    if dimension in ("angle", "angular velocity", "angular acceleration"):
        return
    value = to_si(f"1 {unit}", dimension, found)
    assert value == pytest.approx(found.factor(dimension), rel=1e-12)


@each(
    ("parameters", "code", "text"),
    [
        ('"pin.B.material" = { from = 1, to = 2 }', "not-a-varying-number", "is the text"),
        ('"pin.B" = { from = 1, to = 2 }', "not-a-varying-number", "is a table"),
        ('"pin.B.profile" = { from = 1, to = 2 }', "not-a-varying-number", "is a list"),
        ('"pin.B.profile[3].length" = { from = 1, to = 2 }', "not-a-varying-number", "no [3]"),
        ('"pin.B.bore" = { from = 1, to = 2 }', "not-a-varying-number", "no 'bore' there"),
        ('"vary.count" = { from = 1, to = 2 }', "not-a-varying-number", "says how numbers vary"),
        (
            '"pin.B.profile[1-2].diameter" = { from = 1, to = 2 }',
            "not-a-varying-number",
            "pin.B.profile[1].diameter and pin.B.profile[2].diameter differ",
        ),
        ('"pin.B.profile[2-1].length" = { from = 1, to = 2 }', "not-a-range", "no range"),
        ('"pin.B.profile[1-3].length" = { from = 1, to = 2 }', "not-a-varying-number", "no [3]"),
        ('"pin.B..x" = { from = 1, to = 2 }', "not-a-key", "is not a key"),
        (f'"{DIAMETER}" = {{ from = 2, to = 1 }}', "limits-out-of-order", "must exceed"),
        (f'"{DIAMETER}" = {{ uniform = [2, 2] }}', "limits-out-of-order", "must exceed"),
        (f'"{DIAMETER}" = {{ triangular = [1, 3, 2] }}', "limits-out-of-order", "in this order"),
        (f'"{DIAMETER}" = {{ from = 1 }}', "give-both", "belong together"),
        (f'"{DIAMETER}" = {{ steps = 2 }}', "give-one", "give from and to, or one of"),
        (f'"{DIAMETER}" = {{ from = 1, to = "2 s" }}', "wrong-dimension", "is not a length"),
        (f'"{DIAMETER}" = {{ normal = [2, 0] }}', "not-positive", "deviation"),
        (f'"{DIAMETER}" = {{ lognormal = [-2, 1] }}', "not-positive", "mean"),
        (f'"{DIAMETER}" = {{ tolerance = "x" }}', "not-a-tolerance", "write for instance"),
        (f'"{DIAMETER}" = {{ tolerance = "+0.1 -0.05 mm" }}', "missing-unit", "give both theirs"),
        (f'"{FORCE}" = {{ tolerance = "h7" }}', "no-tolerance-class", "is for lengths"),
        (f'"{DIAMETER}" = {{ tolerance = "h3" }}', "no-tolerance-class", "5 to 16"),
        (f'"{DIAMETER}" = {{ from = 1, to = 2, within = [1, 2] }}', "not-applicable", "cuts off"),
        (
            f'"{DIAMETER}" = {{ normal = [2, 0.1], within = [4, 5] }}',
            "limits-far-off",
            "of the law's probability",
        ),
        (
            f'"{DIAMETER}" = {{ lognormal = [2, 0.1], within = [-1, 0] }}',
            "limits-far-off",
            "of the law's probability",
        ),
        (f'"{DIAMETER}" = {{ from = 1, to = 2, steps = 0 }}', "out-of-range", "at least 1"),
        (
            f'"{DIAMETER}" = {{ from = 1, to = 2 }}\n"pin.B.profile[2].\\"diameter\\"" '
            "= { from = 1, to = 2 }",
            "duplicate-parameter",
            "names the same number",
        ),
        (
            '"material.AISI 4340.poisson_ratio" = { from = "0.2 mm", to = 0.3 }',
            "not-a-number",
            "has no unit in the study",
        ),
    ],
)
def test_a_parameter_that_cannot_be_is_named(parameters: str, code: str, text: str) -> None:
    found, message = _wrong(parameters)
    assert found == code, message
    assert text in message
    assert "vary.parameters" in message or code == "not-a-key"


def test_whole_numbers_do_not_vary() -> None:
    text = LANDING_GEAR.read_text(encoding="utf-8")
    study = study_from(
        varied('"case.retract.samples" = { from = 10, to = 20 }', text=text), LANDING_GEAR.parent
    )
    with pytest.raises(InputError, match="is a whole number"):
        parameters_of(study)


def test_a_study_without_vary_says_how_it_would_look() -> None:
    with pytest.raises(InputError, match=r'"pin.B.profile\[1\].diameter"') as raised:
        parameters_of(study_from(ONE_PIN))
    assert raised.value.code == "no-vary"


def test_a_grid_needs_steps_and_has_a_limit() -> None:
    assert _wrong(f'"{DIAMETER}" = {{ from = 1, to = 2 }}', "")[0] == "missing-steps"
    huge = (
        f'"{DIAMETER}" = {{ from = 1, to = 2, steps = 10000 }}\n'
        f'"{FORCE}" = {{ from = -2, to = -1, steps = 1000 }}'
    )
    code, message = _wrong(huge, "")
    assert code == "too-large"
    assert "10,000,000 designs" in message


BELLS = "\n".join(f'"{key}" = {{ normal = [2.0, 0.1] }}' for key in (DIAMETER, FORCE, STRENGTH))


def _pair(first: str, second: str, coefficient: float) -> str:
    return (
        f'\n[[vary.correlations]]\nbetween = ["{first}", "{second}"]\ncoefficient = {coefficient}\n'
    )


@each(
    ("pairs", "code"),
    [
        (
            _pair(DIAMETER, FORCE, 0.9) + _pair(DIAMETER, STRENGTH, 0.9)
            + _pair(FORCE, STRENGTH, -0.9),
            "no-correlation-matrix",
        ),
        (_pair(DIAMETER, "pin.B.fillet", 0.5), "unknown-parameter"),
        (_pair(DIAMETER, DIAMETER, 0.5), "duplicate-parameter"),
        (_pair(DIAMETER, FORCE, 0.5) + _pair(FORCE, DIAMETER, 0.5), "duplicate-parameter"),
        (_pair(DIAMETER, FORCE, 1.0), "out-of-range"),
    ],
)  # fmt: skip
def test_correlations_must_be_possible(pairs: str, code: str) -> None:
    assert _wrong(BELLS + pairs)[0] == code


def test_only_normal_laws_are_correlated() -> None:
    law = f'"{DIAMETER}" = {{ from = 1, to = 2 }}\n"{FORCE}" = {{ normal = [2.0, 0.1] }}'
    assert _wrong(law + _pair(DIAMETER, FORCE, 0.5))[0] == "not-normal"
    grid = BELLS.replace("0.1]", "0.1], steps = 2")
    assert _wrong(grid + _pair(DIAMETER, FORCE, 0.5), "")[0] == "grid-with-correlations"


def test_errors_name_the_line() -> None:
    text = varied(f'"{DIAMETER}" = {{ from = 2, to = 1 }}')
    line = text[: text.index(f'"{DIAMETER}"')].count("\n") + 1
    with pytest.raises(InputError, match=rf"study:{line}: vary\.parameters\.\"pin\.B"):
        parameters_of(study_from(text))


def test_a_law_reads_in_the_units_of_the_study() -> None:
    (parameter,) = parameters_of(swept(f'"{DIAMETER}" = {{ from = "25.4 mm", to = 3 }}'))
    assert isinstance(parameter.law, Uniform)
    assert parameter.law_text == "uniform from 1 in to 3 in"
    assert parameter.nominal == pytest.approx(0.0508)
    np.testing.assert_allclose(parameter.quantile(np.array([0.5])), 0.0508)

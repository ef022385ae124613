"""The curve of factors against one number: points are those of runs, crossings are right."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import pytest

import pinstress
from pinstress.cli.commands import run_command_line
from pinstress.explore.curve import curve, values_between
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.in_python import changed_study, study_from
from reports.data.curve import CurvePoint, FactorCurve
from reports.tables.curve import worst_table
from reports.text.curve import reached_lines
from tests.pinstress.analysis.test_scaled import STUDY, TWO_CASES
from tests.support.each import each
from tests.support.programs.command_line import ONE_PIN

DIAMETER = "pin.B.profile[2].diameter"
LUG = "[pin.P.lug.middle]"
LOOSE = STUDY.replace(LUG, f"{LUG}\nclearance = 0.08") + TWO_CASES  # a heavy and a light load


def point(value: float, factor: float | None, pin: str = "P", case: str = "c") -> CurvePoint:
    stress = None if factor is None else 100.0 / factor
    return CurvePoint(value, pin, case, stress, 0.0, factor, "safe")


def of(*points: CurvePoint, required: float = 10.0) -> FactorCurve:
    return FactorCurve("s", "k", "mm", 1.0, required, "MPa", points)


@each(("nominal", "count"), [(6e-3, 9), (19e-3 / 3.0, 10), (12e-3, 9)])
def test_the_value_of_the_study_is_one_of_the_points_once(nominal: float, count: int) -> None:
    """6 mm, between 1 and 11 mm, is the middle but for the last digit."""
    values = values_between(1e-3, 11e-3, nominal, 9)
    assert len(values) == count
    assert (nominal in values) == (nominal < 11e-3)


@each(
    ("factors", "expected"),
    [
        ((5.0, 20.0), [(math.sqrt(2.0), True)]),  # half way between the logarithms
        ((40.0, 2.5), [(math.sqrt(2.0), False)]),
        ((5.0, 20.0, 20.0, 5.0), [(math.sqrt(2.0), True), (math.sqrt(12.0), False)]),
        ((11.0, 12.0), []),
        ((5.0, None, 20.0), []),  # nothing is known between
        ((10.0, 5.0), [(1.0, False)]),
    ],
)
def test_where_the_required_factor_is_reached(
    factors: tuple[float | None, ...], expected: list[tuple[float, bool]]
) -> None:
    points = [point(1.0 + k, factor) for k, factor in enumerate(factors)]
    reached = [(r.value, r.rising) for r in of(*points).reached]
    assert [rising for _, rising in reached] == [rising for _, rising in expected]
    assert [value for value, _ in reached] == pytest.approx([value for value, _ in expected])


def test_a_factor_between_two_values_is_a_power_of_the_number_unless_one_is_near_zero() -> None:
    """Bending of a pin goes with the cube of its diameter: over the diameter itself 10 would be
    reached at 1.4 in instead of 1.25. Of a clearance from almost nothing no power is known.
    """
    cubic = of(point(1.0, 10.0 / 1.25**3), point(2.0, 10.0 * (2.0 / 1.25) ** 3))
    assert [r.value for r in cubic.reached] == pytest.approx([1.25])
    loose = of(point(1e-6, 20.0), point(0.1, 5.0))
    assert [r.value for r in loose.reached] == pytest.approx([0.05], rel=1e-4)
    below = of(point(-20.0, 20.0), point(80.0, 5.0))  # a temperature
    assert [r.value for r in below.reached] == pytest.approx([30.0])


def test_the_case_that_counts_is_the_worst_or_one_of_which_nothing_is_known() -> None:
    worst = of(point(1.0, 3.0, case="a"), point(1.0, 2.0, case="b"), point(2.0, 4.0, case="a"),
               point(2.0, None, case="b"))  # fmt: skip
    assert [p.case for p in worst.least("P")] == ["b", "b"]
    idle = CurvePoint(1.0, "P", "rest", 0.0, 0.0, None, "safe")
    beside_idle = of(idle, point(1.0, 3.0, case="a"))
    assert [p.case for p in (*beside_idle.least("P"), *beside_idle.worst("P"))] == ["a", "a"]


def test_the_error_of_a_small_stress_is_in_proportion() -> None:
    """Of 0.0005 MPa the upper end of the factor was half of the factor itself."""
    point = CurvePoint(1.0, "P", "c", 5e-4, 5e-5, 4.0, "safe")
    assert point.factor_ends == pytest.approx((4.0 / 1.1, 4.0 / 0.9))
    assert replace(point, error_estimate=5e-4).factor_ends == pytest.approx((2.0, math.inf))


def test_a_singular_row_shows_no_error() -> None:
    """It has a range instead; "0 %" stood there."""
    singular = replace(point(1.0, 4.0), verdict="singular")
    grid = worst_table(of(singular)).grid()
    assert grid.body[0][grid.head.index("±")] == "–"


def test_a_curve_is_one_short_line_in_a_notebook() -> None:
    curve = of(point(1.0, 9.0), point(2.5, 11.0))
    assert repr(curve) == "<FactorCurve k 1 to 2.5 mm: pins: 1, values: 2>"


def test_reached_throughout_is_no_more_than_the_results_say() -> None:
    open_ = of(point(1.0, 10.1), replace(point(2.0, 10.2), outcome="not decided"))
    (told,) = reached_lines(open_)
    assert told.endswith("throughout as computed, but not every result is safe (not decided).")
    assert reached_lines(of(point(1.0, 10.1), point(2.0, 10.2)))[0].endswith("throughout.")


@each(
    ("factors", "outcome", "expected"),
    [
        ((5.0, 20.0), "depends", ") as computed, but not every result is safe (depends)."),
        ((5.0, None, 20.0), "safe", "at some values, between which there is no factor."),
        ((None, 20.0), "safe", "at every value with a factor."),
        ((None, 5.0), "fails", "at no value with a factor."),
        ((4.0, 5.0), "fails", "nowhere in this range."),
    ],
)
def test_reached_is_said_of_what_is_known(
    factors: tuple[float | None, ...], outcome: str, expected: str
) -> None:
    """With no factor between, one was reached nowhere; above a limit all was as safe as said."""
    last = len(factors)
    points = [
        replace(point(1.0 + k, x), outcome=outcome if k + 1 == last else "fails")
        for k, x in enumerate(factors)
    ]
    (told,) = reached_lines(of(*points))
    assert told.endswith(expected)


def test_a_row_is_of_the_case_that_fails_though_another_has_a_smaller_factor(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Twenty times the load has a smaller factor, of which less is required. A strength that
    nothing uses moves nothing, which is said; a sweep counts designs by their own factors.
    """
    text = ONE_PIN.replace("[case.landing]", MORE_CASES)
    (tmp_path / "two.toml").write_text(text, encoding="utf-8")
    command = ["curve", str(tmp_path / "two.toml"), "material.unused.yield_strength"]
    assert run_command_line([*command, "--points", "2", "--jobs", "1"]) == 0
    told = capsys.readouterr().out
    assert {line.split()[-2] for line in told.splitlines() if " B " in line} == {"fails"}
    assert "unused.yield_strength changes nothing here" in " ".join(told.split())
    assert "Required factors differ" in told
    out = ["--out", str(tmp_path / "out"), "--jobs", "1"]
    assert run_command_line(["sweep", str(tmp_path / "two.toml"), *out]) == 0
    assert "designs below their required factors: B 2" in capsys.readouterr().out


MORE_CASES = """
[[require]]
check = "yield"
cases = ["landing"]
factor = 1000
[[require]]
check = "yield"
cases = ["hard"]
factor = 1.5

[vary.parameters]
"material.unused.yield_strength" = { from = "200 ksi", to = "220 ksi", steps = 2 }

[material.unused]
youngs_modulus = "28400 ksi"
poisson_ratio = 0.3
yield_strength = "225 ksi"

[case.hard]
kind = "given"
forces = { B = [0.0, -20000.0] }

[case.landing]"""


def test_points_are_those_of_runs(tmp_path: Path) -> None:
    """Each is what `run` says about the study with that number; the one in the study is added."""
    study = pinstress.load_study(_study(tmp_path))
    points = curve(study, DIAMETER, ("1.6 in", 2.4), points=2).points
    assert curve(study, DIAMETER, ("1.6 in", 2.4), points=2, jobs=2).points == points
    assert [p.value for p in points] == pytest.approx([1.6, 2.0, 2.4])
    for p in points:
        (row,) = pinstress.run(changed_study(study, {DIAMETER: p.value})).pins
        assert p.max_von_mises == pytest.approx(row.max_von_mises, rel=1e-9)
        assert p.error_estimate == pytest.approx(row.error_estimate, rel=1e-9)
        assert p.safety_factor == pytest.approx(row.safety_factor, rel=1e-9)
        assert (p.outcome, p.verdict) == (row.outcome, row.verdict)


@pytest.fixture(scope="module")
def loose_run() -> pinstress.RunResults:
    return pinstress.run(study_from(LOOSE))


@pytest.mark.slow
def test_a_light_case_of_a_loose_pin_is_only_decided_as_in_a_run(
    loose_run: pinstress.RunResults,
) -> None:
    """On the narrow arcs of a light case, finer and finer cells took most of the time."""
    study, clearance = study_from(LOOSE), "pin.P.lug.middle.clearance"
    looser = pinstress.run(changed_study(study, {clearance: 0.1}))
    for point in curve(study, clearance, (0.08, 0.1), points=2).points:
        row = (loose_run if point.value == 0.08 else looser)[point.pin, point.case]
        assert point.max_von_mises == pytest.approx(row.max_von_mises, rel=1e-9)
        assert point.error_estimate == pytest.approx(row.error_estimate, rel=1e-9)


@pytest.mark.slow
def test_points_that_share_a_solution_have_their_light_case_solved_finely(
    loose_run: pinstress.RunResults,
) -> None:
    """A strength changes no stress, but decides how finely a run solves a light case."""
    points = curve(study_from(LOOSE), "material.steel.yield_strength", points=3).points
    light = [x for x in points if x.case == "light"]
    assert len({x.max_von_mises for x in light}) == 1
    rough = loose_run["P", "light"].error_estimate or 0.0
    assert (light[0].error_estimate or 0.0) < 0.5 * rough


def test_the_command_writes_table_and_picture_and_says_where_the_factor_is_reached(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study, out = _study(tmp_path), tmp_path / "out"
    key = "case.landing.forces.B[2]"
    options = ["--from", "-2000", "--to", "-20000 lbf", "--points", "3", "--jobs", "2"]
    assert run_command_line(["curve", str(study), key, *options, "--out", str(out)]) == 2
    assert "--to must exceed --from" in capsys.readouterr().err
    options = ["--from", "-20000", "--to", "-2000 lbf", "--points", "3", "--jobs", "2"]
    assert run_command_line(["curve", str(study), key, *options, "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "Pin B reaches the required factor 10 from about −12,100 lbf" in printed
    with (out / "curve.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["value"]) for row in rows] == [-20000.0, -11000.0, -2000.0]
    assert {(row["value_unit"], row["stress_unit"]) for row in rows} == {("lbf", "psi")}
    factors = [float(row["safety_factor"]) for row in rows]
    assert factors[0] * 20000.0 == pytest.approx(factors[2] * 2000.0, rel=1e-6)
    assert {path.name for path in out.iterdir()} >= {"curve.csv", "curve.svg", "curve.png"}


def test_a_required_factor_is_no_factor_that_is_reached(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Found by hand: it said "reaches the required factor 10 throughout" beside rows that fail."""
    arguments = ["curve", str(_study(tmp_path)), "analysis.required_safety_factor"]
    arguments += ["--from", "60", "--to", "180", "--points", "2", "--out", str(tmp_path / "o")]
    assert run_command_line(arguments) == 0
    printed = capsys.readouterr().out
    assert "Required factors differ; each result is by its own." in printed
    assert "reaches" not in printed
    assert [line.split()[-2] for line in printed.splitlines() if "converged" in line] == [
        "safe",
        "fails",
    ]


def test_designs_that_cannot_be_built_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["curve", str(_study(tmp_path)), DIAMETER, "--from", "3.3", "--to", "3.6"]
    assert run_command_line([*arguments, "--points", "2", "--out", str(tmp_path / "o")]) == 1
    said = capsys.readouterr()
    assert "No factor at 3.300: pin B: the fillet between segments 1 and 2" in said.out
    assert "Not decided: no value has a factor of safety." in said.err


@each(
    ("key", "message"),
    [
        ("pin.B.profile[3].diameter", "the study has no [3] there"),
        ("pin.B.profil[1].diameter", "did you mean 'profile'?"),
        ("pin.B", "is a table, not a number"),
        ("case.landing.forces.B[1]", "is 0 lbf in the study, so there is no usual range"),
        ("profile[2].diameter", "did you mean 'pin.B.profile[2].diameter'?"),
        ("title", "is the text 'One pin', not a number"),
    ],
)
def test_keys_that_are_no_numbers_are_refused(tmp_path: Path, key: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        curve(pinstress.load_study(_study(tmp_path)), key)
    assert f"{key}: " in str(caught.value)
    assert message in str(caught.value)


def _study(folder: Path) -> Path:
    path = folder / "one_pin.toml"
    path.write_text(ONE_PIN)
    return path


def hot(units: str, temperature: str) -> str:
    """The one pin with a temperature in its case."""
    text = ONE_PIN.replace('units = "in-lbf-s"', f'units = "{units}"')
    assert units in text
    return text.replace('kind = "given"', f'kind = "given"\ntemperature = "{temperature}"')


@each(
    ("units", "written", "unit", "value"),
    [
        ("mm-N-s", "120 degC", "degC", 120.0),
        ("mm-N-s", "393.15 K", "degC", 120.0),
        ("in-lbf-s", "120 degC", "degF", 248.0),
        ("in-lbf-s", "248 degF", "degF", 248.0),
    ],
)
def test_a_curve_has_temperatures_in_degrees(
    units: str, written: str, unit: str, value: float
) -> None:
    """Half and twice the rise above 20 degC, not of the kelvins."""
    result = curve(study_from(hot(units, written)), "case.landing.temperature", points=2)
    assert (result.unit, result.nominal) == (unit, value)
    base = 20.0 if unit == "degC" else 68.0
    assert result.values == (base + 0.5 * (value - base), value, base + 2.0 * (value - base))


def test_a_temperature_without_a_rise_has_no_usual_range() -> None:
    with pytest.raises(InputError, match="is 20 degC in the study, so there is no usual range"):
        curve(study_from(hot("mm-N-s", "20 degC")), "case.landing.temperature")

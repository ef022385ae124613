"""A study asked again, with changes: the same as a run of the changed study, solved once."""

from __future__ import annotations

from typing import Any

import pytest

import pinstress
from fea.solve import solve as solving
from fea.solve.solve import solve as solve_problem
from fea.support.support import PinProblem
from pinbase.memo import Memo
from pinbase.records import plain
from pinstress.analysis.engine import Engine
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.in_python import changed_study, study_from
from reports.tables.json_results import to_json
from tests.support.each import each
from tests.support.pins.studies import TWO_PINS

DIAMETER = "pin.A.profile[2].diameter"
IN_LUGS = (
    TWO_PINS.split("[pin.A]")[0]
    + """
[pin.P]
material = "steel"
profile = [
  { length = 10, diameter = 20, connection = "left" },
  { length = 20, diameter = 20, connection = "middle" },
  { length = 10, diameter = 20, connection = "right" },
]
[pin.P.lug.left]
[pin.P.lug.middle]
[pin.P.lug.right]
[case.pull]
kind = "given"
forces = { left = [0, 5000], middle = [0, -10000], right = [0, 5000] }
[analysis]
required_safety_factor = 2
tolerance = 0.2
"""
)


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of the pins that were solved, in their order."""
    names: list[str] = []

    def counted(problem: PinProblem, *rest: Any) -> Any:
        names.append(problem.pin.name)
        return solve_problem(problem, *rest)

    monkeypatch.setattr(solving, "solve", counted)
    return names


def numbers(results: Any) -> dict[str, Any]:
    """All of results.json but what depends on the clock and on the file."""
    content: dict[str, Any] = timeless(to_json(results))
    return content


def timeless(value: Any) -> Any:
    """A value without what depends on the clock."""
    if isinstance(value, dict):
        return {k: timeless(v) for k, v in value.items() if k not in ("seconds", "created")}
    return [timeless(v) for v in value] if isinstance(value, list) else value


def test_an_answer_is_a_run_of_the_changed_study(solved: list[str]) -> None:
    """Whatever was asked before; the run is made without an engine."""
    study = study_from(TWO_PINS)
    engine = Engine(study)
    engine.answer()
    ours = engine.answer({DIAMETER: "0.8 in", "pin.B.fillet": 2.5})
    theirs = pinstress.run(changed_study(study, {DIAMETER: "0.8 in", "pin.B.fillet": 2.5}))
    assert numbers(ours)["pins"] == numbers(theirs)["pins"]
    assert numbers(engine.answer())["pins"] == numbers(pinstress.run(study))["pins"]


@each("study", [TWO_PINS, IN_LUGS])
def test_a_row_alone_is_that_of_a_run(study: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """With its judgement, joint, margins and range, but without what only explains it."""
    ours = Engine(study_from(study))
    ran = pinstress.run(study_from(study))
    monkeypatch.setattr("assess.fatigue.critical_points.stress_histories", None)
    for row in ran.pins:
        alone = ours.row({}, row.pin, row.case)
        assert timeless(plain(alone)) == timeless(plain(row))


def test_what_a_change_does_not_touch_is_not_solved_again(solved: list[str]) -> None:
    engine = Engine(study_from(TWO_PINS))
    engine.answer()
    assert sorted(solved) == ["A", "B"]
    solved.clear()
    wide = engine.answer({DIAMETER: 22.0})
    assert solved == ["A"]
    again = engine.answer({DIAMETER: 22})  # the same number, written otherwise
    row = engine.row({DIAMETER: 22.0}, "A", "press")
    assert row.max_von_mises == again["A", "press"].max_von_mises
    assert solved == ["A"]
    assert numbers(again)["pins"] == numbers(wide)["pins"]


def test_a_memo_is_bounded_and_may_be_shared(solved: list[str]) -> None:
    """One that is smaller than two pins has the last one."""
    memo, study = Memo(1), study_from(TWO_PINS)
    Engine(study, pins=["A"], memo=memo).answer()
    Engine(study, pins=["A"], memo=memo).answer()
    assert solved == ["A"]
    Engine(study, pins=["B"], memo=memo).answer()
    Engine(study, pins=["A"], memo=memo).answer()
    assert solved == ["A", "B", "A"]


def test_slopes_are_those_of_finite_changes() -> None:
    """Of the diameter by central differences of answers on their own meshes, which scatter."""
    study = study_from(TWO_PINS.replace("tolerance = 0.2", "tolerance = 0.005"))
    engine = Engine(study)
    slopes = engine.slopes({}, "A", "press", [DIAMETER])
    assert isinstance(slopes, dict)
    high, low = (engine.row({DIAMETER: d}, "A", "press").max_von_mises for d in (20.4, 19.6))
    assert high is not None
    assert low is not None
    assert slopes[DIAMETER] == pytest.approx((high - low) / 0.8, rel=0.03)
    assert "no derivative" in str(engine.slopes({}, "A", "press", ["pin.A.colour"]))


def test_a_quick_answer_lies_within_its_error() -> None:
    engine = Engine(study_from(TWO_PINS.replace("tolerance = 0.2", "tolerance = 0.002")))
    full = engine.row({}, "A", "press").max_von_mises
    quick = engine.row({}, "A", "press", accuracy="quick")
    assert full is not None
    assert quick.max_von_mises is not None
    assert quick.error_estimate is not None
    assert abs(quick.max_von_mises - full) <= quick.error_estimate
    assert quick.error_estimate > 0.002 * quick.max_von_mises


def test_what_cannot_be_built_says_its_key() -> None:
    engine = Engine(study_from(TWO_PINS))
    with pytest.raises(InputError, match=r"pin\.A\.profile\[2\]\.diameter"):
        engine.answer({DIAMETER: -3.0})
    with pytest.raises(InputError, match=r"no 'C' there"):
        engine.row({"pin.C.fillet": 1.0}, "A", "press")

"""Loads of a mechanism are those computed anew, whatever was asked before, only where needed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pinbase.memo import Memo
from pinstress import Study, changed_study, load_study, shipped_studies, study_from
from pinstress.analysis import reused_loads as module
from pinstress.analysis.plan import all_loads
from pinstress.analysis.reused_loads import reused_loads
from pinstress.study.reading.file import raw_study

GEAR = "landing_gear"
TOUCHED: tuple[dict[str, Any], ...] = (
    {"case.landing.apply[1].impulse.impulse_time": 0.2},
    {"mechanism.body.EF.weight": 70.0},
    {"mechanism.gravity": [0, -300]},
)
UNTOUCHED: tuple[dict[str, Any], ...] = (
    {"pin.E.profile[2].diameter": 2.3},
    {"pin.E.lug.E1.clearance": 0.002},
    {'material."AISI 4340".yield_strength': "200 ksi"},
    {'material."AISI 4340".density': 5e-4},
    {"analysis.tolerance": 0.05},
)


@pytest.fixture
def computed(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The cases that were computed, each time."""
    calls: list[list[str]] = []

    def counted(study: Study, cases: list[str]) -> Any:
        calls.append(cases)
        return all_loads(study, cases)

    monkeypatch.setattr(module, "all_loads", counted)
    return calls


def test_only_what_loads_depend_on_computes_them_again(computed: list[list[str]]) -> None:
    study, memo = load_study(shipped_studies()[GEAR]), Memo()
    _require_same(study, memo)
    assert computed == [["landing"]]
    for changes in UNTOUCHED:
        _require_same(changed_study(study, changes), memo)
    assert len(computed) == 1
    for changes in TOUCHED:
        _require_same(changed_study(study, changes), memo)
    assert len(computed) == 1 + len(TOUCHED)
    _require_same(study, memo)
    assert len(computed) == 1 + len(TOUCHED)


@pytest.mark.parametrize("changes", UNTOUCHED[:1] + UNTOUCHED[3:4])
def test_a_joint_weighed_by_its_pin(changes: dict[str, Any], computed: list[list[str]]) -> None:
    """Without a weight of its own, a joint has that of its pin, by shape and density."""
    lines = load_study(shipped_studies()[GEAR]).text.splitlines()
    text = "\n".join(x for x in lines if not x.startswith("weight = { value = 14.1594216"))
    study, memo = study_from(text, shipped_studies()[GEAR].parent), Memo()
    before = _require_same(study, memo)
    after = _require_same(changed_study(study, changes), memo)
    assert len(computed) == 2
    assert not np.array_equal(before, after)


SIDE = """
[[case.landing.apply]]
body = "tyre"
at = "J"
force = [0, 0, 5000]
"""


def test_a_side_load_depends_on_where_links_bear_on_their_pins(computed: list[list[str]]) -> None:
    """Only with a side load: a longer spacer on pin E moves links apart, a thicker one does not.
    The link that carries pin B lies at its clamp.
    """
    text, folder = load_study(shipped_studies()[GEAR]).text, shipped_studies()[GEAR].parent
    longer, thicker = {"pin.E.profile[3].length": 5.0}, {"pin.E.profile[3].diameter": 3.5}
    plane, memo = study_from(text, folder), Memo()
    for changes in ({}, longer, thicker):
        _require_same(changed_study(plane, changes), memo)
    assert len(computed) == 1
    aside, memo = study_from(text + SIDE, folder), Memo()
    before = _require_same(aside, memo)
    assert np.array_equal(_require_same(changed_study(aside, thicker), memo), before)
    assert len(computed) == 2
    other_end: dict[str, Any] = {"pin.B.clamp[1]": "end"}
    for k, changes in enumerate((longer, other_end), 3):
        assert not np.array_equal(_require_same(changed_study(aside, changes), memo), before)
        assert len(computed) == k


def test_amounts_of_other_cases_leave_the_loads_of_a_case(computed: list[list[str]]) -> None:
    """A motion was solved again for another impulse of a landing."""
    study, memo = load_study(shipped_studies()[GEAR]), Memo()
    both = ["retract", "landing"]
    reused_loads(raw_study(study), memo)(study, both)
    changed = changed_study(study, {"case.landing.apply[1].impulse.impulse_time": 0.2})
    loads = reused_loads(raw_study(changed), memo)(changed, both)
    assert computed == [both, ["landing"]]
    anew = all_loads(changed, both)
    for name in both:
        assert np.array_equal(loads[name].reactions.forces, anew[name].reactions.forces)
    text, folder = study.text + SIDE, shipped_studies()[GEAR].parent  # moves links apart in all
    aside = study_from(text, folder)
    loads = reused_loads(raw_study(aside), memo)(aside, both)
    assert computed[2:] == [both]


def _require_same(study: Study, memo: Memo) -> Any:
    """The forces, which are the same as without a memo."""
    reused = reused_loads(raw_study(study), memo)(study, ["landing"])["landing"].reactions
    anew = all_loads(study, ["landing"])["landing"].reactions
    assert np.array_equal(reused.forces, anew.forces)
    return reused.forces

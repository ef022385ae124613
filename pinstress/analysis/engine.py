"""A study that can be asked again, with changes; what a change does not touch is not solved again.

Every answer is that of `pinstress.run` on the changed study, to the last bit, whatever was asked
before: what is remembered has the content of everything it depends on as its key, and nothing is
updated in place.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, Literal, TypeVar

from pinbase.memo import Memo
from pinbase.processes.threads import one_thread
from pinbase.records import pack, unpack
from pinstress.analysis.gather.gather import rows_of
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.results import RunResults, solve
from pinstress.analysis.reused_loads import reused_loads
from pinstress.analysis.solve import solve_tasks
from pinstress.study.reading.extras import require_fatigue
from pinstress.study.reading.file import Study, raw_study, with_raw
from pinstress.study.reading.in_python import changed_raw, changed_study
from reports.data.results import PinResult

T = TypeVar("T")
Accuracy = Literal["full", "quick"]
Changes = Mapping[str, float | str]  # "pin.E.profile[2].diameter": 2.4, in the study's units

AS_IS: Changes = MappingProxyType({})
TABLES_WITHOUT_ROWS = "vary", "beam_check", "motion_check", "report"
QUICK_TOLERANCE = 0.1  # of a quick answer, whose error says how far it is to be believed


class SolvedPins:
    """Solved pins by the content of all they depend on (pinstress.analysis.cache.OutcomeStore)."""

    def __init__(self, memo: Memo) -> None:
        self._memo = memo

    def key(self, inputs: object) -> str:
        """The name of what these inputs yield (pinbase.records packs them)."""
        return hashlib.sha256(pack(inputs)).hexdigest()

    def read(self, key: str, kind: type[T]) -> T | None:
        """The value of a key, a `kind`; None where nothing is remembered."""
        known = self._memo.read(key)
        return None if known is None else unpack(kind, known)

    def write(self, key: str, value: object) -> None:
        """Remember a value."""
        self._memo.write(key, pack(value))


class Engine:
    """A study, asked with changes. It lives in one process.

    pins, cases: names; all by default. memo: of solved pins, and of the flexibilities, meshes and
    unit fields of pins that have changed since; shared with other engines, perhaps.
    """

    def __init__(
        self,
        study: Study,
        *,
        pins: Iterable[str] | None = None,
        cases: Iterable[str] | None = None,
        memo: Memo | None = None,
    ) -> None:
        self.study = study
        self._pins = None if pins is None else list(pins)
        self._cases = None if cases is None else list(cases)
        self._memo = Memo() if memo is None else memo

    @cached_property
    def _raw(self) -> Mapping[str, Any]:
        """The content of the study, but for tables that no row needs."""
        return {k: v for k, v in raw_study(self.study).items() if k not in TABLES_WITHOUT_ROWS}

    def changed(self, changes: Changes = AS_IS) -> Study:
        """The study with other values by their keys, in its own units or as texts with a unit.

        Raises: InputError with the key and what is wrong with its value.
        """
        return changed_study(self.study, changes) if changes else self.study

    def answer(self, changes: Changes = AS_IS, *, accuracy: Accuracy = "full") -> RunResults:
        """All results, as from `pinstress.run`; a "quick" answer has a larger error, and says so.

        Raises: InputError for a study that cannot be built.
        """
        return self._solved(changes, self._pins, accuracy)

    def row(
        self, changes: Changes, pin: str, case: str, *, accuracy: Accuracy = "full"
    ) -> PinResult:
        """One row of the answer, for which no other pin is solved, and nothing that only explains
        it. Raises: InputError.
        """
        return self.rows(changes, [pin], accuracy=accuracy)[pin, case]

    def rows(
        self, changes: Changes, pins: Iterable[str] | None = None, *, accuracy: Accuracy = "full"
    ) -> dict[tuple[str, str], PinResult]:
        """The rows of some pins (all by default) by pin and case, as `row` has each.

        Raises: InputError.
        """
        raw = changed_raw(self.study, self._raw, changes)
        study = with_raw(self.study, raw)
        require_fatigue(study)
        plan = self._plan(study, raw, self._pins if pins is None else pins)
        plan = _with(replace(plan, explained=False), accuracy)
        with one_thread():
            outcomes = solve_tasks(plan, cache=SolvedPins(self._memo), memo=self._memo)
        return rows_of(plan, outcomes)

    def slopes(
        self, changes: Changes, pin: str, case: str, keys: Collection[str]
    ) -> dict[str, float] | str:
        """The derivatives of the largest stress of a row with respect to lengths and other numbers
        of its pin, by their keys ("pin.E.profile[2].diameter"), in the study's units; or, as a
        text, why there are none. Raises: InputError.
        """
        results = self._solved(changes, [pin], "full", sensitive=True)
        effects = next(s for s in results.sensitivities if (s.pin, s.case) == (pin, case))
        if effects.note:
            return effects.note
        by_key = {x.key: x.stress for x in effects.rows}
        missing = [key for key in keys if key not in by_key]
        if missing:
            return f"no derivative with respect to {', '.join(missing)}"
        return {key: by_key[key] for key in keys}

    def _solved(
        self,
        changes: Changes,
        pins: Iterable[str] | None,
        accuracy: Accuracy,
        sensitive: bool = False,
    ) -> RunResults:
        plan = self._plan(self.changed(changes), changed_raw(self.study, self._raw, changes), pins)
        plan = _with(replace(plan, sensitive=sensitive), accuracy)
        return solve(plan, cache=SolvedPins(self._memo), memo=self._memo)

    def _plan(self, study: Study, raw: Mapping[str, Any], pins: Iterable[str] | None) -> Plan:
        loads_of = reused_loads(raw, self._memo)
        return prepare(study, pins=pins, cases=self._cases, loads_of=loads_of)


def _with(plan: Plan, accuracy: Accuracy) -> Plan:
    """A plan of an accuracy: a quick one has a tolerance that few meshes meet, and rough cells of
    contact.
    """
    if accuracy == "full":
        return plan
    tolerance = max(plan.requirement.tolerance, QUICK_TOLERANCE)
    return replace(plan, requirement=replace(plan.requirement, tolerance=tolerance, cells="rough"))

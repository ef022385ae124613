"""A study that can be solved again with changes; what a change does not affect is not solved again.

A full answer equals that of `pinstress.run` on the changed study, to the last bit. A quick answer
scales a pin in contact from the study as it is (pinstress.analysis.scaled). A case in which contact
has moved, or arcs are too narrow for rough cells, is solved on usual cells, and in full if these
leave it open. A pin is solved in full if the stress of lugs or of a hardened surface is needed,
which requires fine cells. The range over the joint is scaled, too; if the change may alter it, it
is computed on rough cells instead. Neither answer depends on what was asked before: every stored
result has the content of everything it depends on as its key, and nothing is updated in place.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from types import MappingProxyType
from typing import Any, Literal, TypeVar, get_args

from assess.judgement import BELOW_YIELD, FAILS, SAFE, YIELDS
from fea.core.requirement import Requirement
from pinbase.memo import Memo
from pinbase.processes.threads import one_thread
from pinbase.records import pack, unpack
from pinstress.analysis.assessed.situations import assessed
from pinstress.analysis.gather.gather import rows_of
from pinstress.analysis.landing_scales import landing_scales
from pinstress.analysis.plan import Plan, for_task, needs_fine_cells, prepare
from pinstress.analysis.results import RunResults, run_results, solve
from pinstress.analysis.reused_loads import reused_loads
from pinstress.analysis.scaled import (
    coarse,
    comparable,
    contact_changed,
    elastic_task,
    has_own_range,
    range_may_widen,
    same_ranges,
    same_shape,
    scalable,
    scaled_row,
    too_rough,
)
from pinstress.analysis.solve import solve_tasks, unjudged
from pinstress.analysis.stored import PinOutcome, cache_key
from pinstress.study.model.tasks import Task
from pinstress.study.reading.choices import ChoiceError
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.extras import require_fatigue
from pinstress.study.reading.file import Study, raw_study, with_raw
from pinstress.study.reading.in_python import changed_raw, changed_study
from pinstress.study.schema.shown import as_text, near
from reports.data.row import PinResult

T = TypeVar("T")
Accuracy = Literal["full", "quick"]
Changes = Mapping[str, float | str]  # "pin.E.profile[2].diameter": 2.4, in the study's units

AS_IS: Changes = MappingProxyType({})
TABLES_WITHOUT_ROWS = "vary", "beam_check", "motion_check", "report"
# Bytes: twice what nine pins in contact need for quick answers (50 MB each).
ENGINE_MEMO_SIZE = 10**9
QUICK_TOLERANCE = 0.1  # of a quick answer, which states its own error


class SolvedPins:
    """A store of solved pins, each under the content of all it depends on (an OutcomeStore of
    pinstress.analysis.cache).
    """

    def __init__(self, memo: Memo) -> None:
        self._memo = memo

    def key(self, inputs: object) -> str:
        """The name of the result of these inputs (pinbase.records packs them)."""
        return hashlib.sha256(pack(inputs)).hexdigest()

    def read(self, key: str, kind: type[T]) -> T | None:
        """The value of a key, of type `kind`, or None if nothing is stored."""
        known = self._memo.read(key)
        return None if known is None else unpack(kind, known)

    def write(self, key: str, value: object) -> None:
        """Store a value."""
        self._memo.write(key, pack(value))


@dataclass(frozen=True)
class AsIs:
    """A pin of the study as it is: its tasks, and for each case its full and its coarse row."""

    tasks: list[Task]
    rows: dict[str, tuple[PinResult, PinResult]]


class Engine:
    """A study that answers questions with changes. It lives in one process.

    pins, cases: names; all by default.
    memo: a store of solved pins and of the flexibilities, meshes and unit fields of their variants,
    which other engines may share. By default the engine has two of its own, one of ENGINE_MEMO_SIZE
    and one for answers.
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
        # Large flexibilities and meshes must not displace answers, which are small.
        self._memo = Memo(ENGINE_MEMO_SIZE) if memo is None else memo
        self._answers = Memo() if memo is None else memo
        self._as_is: dict[str, AsIs] = {}

    @cached_property
    def _raw(self) -> Mapping[str, Any]:
        """The content of the study without the tables that no row needs."""
        return {k: v for k, v in raw_study(self.study).items() if k not in TABLES_WITHOUT_ROWS}

    def changed(self, changes: Changes = AS_IS) -> Study:
        """The study with other values, given by their keys, in its own units or as texts with a
        unit.

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
        """One row of the answer. No other pin is solved, and nothing that only explains the row.

        Raises: InputError, also for a pin or case without a row.
        """
        rows = self.rows(changes, [pin], accuracy=accuracy)
        _require_row(pin, case, [name for _, name in rows])
        return rows[pin, case]

    def rows(
        self, changes: Changes, pins: Iterable[str] | None = None, *, accuracy: Accuracy = "full"
    ) -> dict[tuple[str, str], PinResult]:
        """The rows of some pins (all by default) by pin and case, each as from `row`.

        Raises: InputError.
        """
        _require_accuracy(accuracy)
        raw = changed_raw(self.study, self._raw, changes)
        study = with_raw(self.study, raw)
        require_fatigue(study)
        plan = self._plan(study, raw, self._pins if pins is None else pins)
        plan = replace(plan, explained=False)
        with one_thread():
            return rows_of(plan, self._outcomes(plan, accuracy))

    def slopes(
        self, changes: Changes, pin: str, case: str, keys: Collection[str]
    ) -> dict[str, float] | str:
        """The derivatives of the largest stress of a row with respect to numbers of its pin.

        keys: of lengths and other numbers of the pin ("pin.E.profile[2].diameter").
        Returns the derivatives by key, in the study's units, or the reason why there are none, as a
        text.

        Raises: InputError.
        """
        results = self._solved(changes, [pin], "full", sensitive=True)
        _require_row(pin, case, [s.case for s in results.sensitivities])
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
        _require_accuracy(accuracy)
        plan = self._plan(self.changed(changes), changed_raw(self.study, self._raw, changes), pins)
        plan = replace(plan, sensitive=sensitive)
        if accuracy == "full":
            return solve(plan, cache=SolvedPins(self._answers), memo=self._memo)
        require_fatigue(plan.study)
        with one_thread():
            return run_results(plan, self._outcomes(plan, accuracy))

    def _plan(self, study: Study, raw: Mapping[str, Any], pins: Iterable[str] | None) -> Plan:
        loads_of = reused_loads(raw, self._answers)
        return prepare(study, pins=pins, cases=self._cases, loads_of=loads_of)

    def _outcomes(self, plan: Plan, accuracy: Accuracy) -> list[PinOutcome]:
        if accuracy == "full":
            return self._solve(plan, plan.tasks)
        return [self._quick(plan, task) for task in plan.tasks]

    def _quick(self, plan: Plan, task: Task) -> PinOutcome:
        """The outcome of a task, scaled or on rough cells where these suffice, otherwise in
        full.
        """
        if task.lugs and needs_fine_cells(task):
            return self._solve(plan, [task])[0]
        return (self._scaled(plan, task) if scalable(task) else None) or self._rough(plan, task)

    def _rough(self, plan: Plan, task: Task) -> PinOutcome:
        """The outcome of a task on rough cells, or in full if these are too large for its
        contact.
        """
        rough = replace(plan, requirement=_quick(plan.requirement))
        outcome = self._solve(rough, [task])[0]
        again = any(map(too_rough, outcome.rows))
        return self._solve(plan, [task])[0] if again else outcome

    def _solve(self, plan: Plan, tasks: list[Task]) -> list[PinOutcome]:
        plan = replace(plan, tasks=tasks)
        return solve_tasks(plan, cache=SolvedPins(self._answers), memo=self._memo)

    def _scaled(self, plan: Plan, task: Task) -> PinOutcome | None:
        """The outcome of a task, scaled from the study as it is; None if it cannot be scaled."""
        name = task.pin.name
        if name not in self._as_is:
            self._as_is[name] = self._both(name)
        tasks, as_is = self._as_is[name].tasks, self._as_is[name].rows
        if not all(comparable(as_is[x.case][0]) for x in task.loads if x.case in as_is):
            return None
        if not all(self._landing_scales(plan, task, case) for case in task.ranges):
            return None
        # Cases at other temperatures are separate tasks, with other clearances.
        cases = {loads.case for loads in task.loads}
        same = all(same_ranges(x, task) for x in tasks if cases & {y.case for y in x.loads})
        varied = () if same else [loads.case for loads in task.loads]
        now = self._coarse(plan, task, varied)
        if not now or not {row.case for row in now} <= as_is.keys():
            return None
        moved = {x.case for x in now if contact_changed(as_is[x.case][1], x)}
        if moved:
            return self._partly_scaled(plan, task, moved)
        if varied and not all(map(has_own_range, now)):
            return None
        rows = self._judged(plan, task, now)
        alike = any(same_shape(x, task) for x in tasks)
        widened = [x.case for x in rows if same and range_may_widen(as_is[x.case][0], x, alike)]
        if widened:
            again = self._coarse(plan, task, widened)
            if not all(has_own_range(x) for x in again if x.case in widened):
                return None
            rows = self._judged(plan, task, again)
        return PinOutcome(rows) if rows else None

    def _partly_scaled(self, plan: Plan, task: Task, moved: Collection[str]) -> PinOutcome | None:
        """The outcome of a task in some of whose cases contact has moved; only the others are
        scaled.
        """
        rows = list[PinResult]()
        if still := tuple(x for x in task.loads if x.case not in moved):
            scaled = self._scaled(plan, replace(task, loads=still))
            if scaled is None:
                return None
            rows += scaled.rows
        rows += (self._on_usual_cells(plan, task.of_case(x)) for x in task.loads if x.case in moved)
        order = [x.case for x in task.loads]
        return PinOutcome(tuple(sorted(rows, key=lambda x: order.index(x.case))))

    def _on_usual_cells(self, plan: Plan, task: Task) -> PinResult:
        """The row of a task with one case, on usual cells of contact; in full if their error is
        large and leaves open whether the pin is safe.

        On arcs too narrow for these cells their error is large, and says so.
        """
        usual = replace(plan, requirement=replace(_quick(plan.requirement), cells="usual"))
        (row,) = self._solve(usual, [task])[0].rows
        error, value = row.error_estimate, row.max_von_mises
        known = error is not None and value is not None and error <= QUICK_TOLERANCE * value
        if known or row.outcome in (SAFE, BELOW_YIELD, FAILS, YIELDS):
            return row
        return self._solve(plan, [task])[0].rows[0]

    def _landing_scales(self, plan: Plan, task: Task, case: str) -> bool:
        """Whether the range of a landing follows from that of the study as it is."""
        tasks, rows = self._as_is[task.pin.name].tasks, self._as_is[task.pin.name].rows
        before = next((x for x in tasks if case in x.ranges), None)
        over, known = plan.loads[case].range, rows[case][0].landing if case in rows else None
        if before is None or known is None or over is None:
            return False
        return landing_scales(
            (before, before.ranges[case], known.force), (task, task.ranges[case], over.forces)
        )

    def _judged(self, plan: Plan, task: Task, now: tuple[PinResult, ...]) -> tuple[PinResult, ...]:
        """The rows of a task, scaled by its coarse rows `now` and assessed; empty if one cannot be
        scaled.
        """
        as_is = self._as_is[task.pin.name].rows
        of = for_task(plan.study, task, plan.requirement)
        rows = [
            scaled_row(*as_is[x.case], x, task, of.of_case(x.case), plan.loads[x.case].range)
            for x in now
        ]
        judged = tuple(assessed(plan.study, task, row) for row in rows if row)
        return () if len(judged) < len(rows) else judged

    def _both(self, pin: str) -> AsIs:
        """The full and coarse rows of a pin of the study as it is; empty if the pin cannot be
        built.
        """
        try:
            plan = replace(self._plan(self.study, self._raw, [pin]), explained=False)
        except InputError:
            return AsIs([], {})
        out = {}
        for task, outcome in zip(plan.tasks, self._solve(plan, plan.tasks), strict=True):
            for full, row in zip(outcome.rows, self._coarse(plan, task), strict=False):
                out[row.case] = full, row
        return AsIs(plan.tasks, out)

    def _coarse(
        self, plan: Plan, task: Task, varied: Collection[str] = ()
    ) -> tuple[PinResult, ...]:
        """The coarse rows of a task, whose ratios are taken; empty if they cannot be solved.

        varied: the cases whose range over the joint is needed, too.
        """
        as_is = self._as_is.get(task.pin.name)  # None while it is being made
        lasting = as_is is None or any(same_shape(x, task) for x in as_is.tasks)
        task, rows = elastic_task(task), list[PinResult]()
        # With unit pressures each case is solved on its own, and again only if its loads change.
        for one in map(task.of_case, task.loads) if lasting else [task]:
            vary = any(loads.case in varied for loads in one.loads)
            requirement = coarse(plan.requirement, lasting, vary)
            of_one = replace(plan, requirement=requirement, explained=False)
            content = hashlib.sha256(pack(cache_key(of_one, one))).digest()
            known = self._answers.get(("coarse", content), partial(self._unjudged, of_one, one))
            if not known:
                return ()
            rows += known
        return tuple(rows)

    def _unjudged(self, plan: Plan, task: Task) -> tuple[PinResult, ...]:
        try:
            return unjudged(plan, task, self._memo)
        except ArithmeticError:  # MeshError, SolveError and what numpy raises
            return ()


def _quick(requirement: Requirement) -> Requirement:
    """A requirement with rough contact cells and a tolerance that a few meshes meet."""
    tolerance = max(requirement.tolerance, QUICK_TOLERANCE)
    return replace(requirement, tolerance=tolerance, cells="rough")


def _require_accuracy(accuracy: object) -> None:
    """Raise ChoiceError for an unknown accuracy, which would otherwise be taken for the
    quick one.
    """
    if accuracy not in get_args(Accuracy):
        text = f"accuracy: must be 'full' or 'quick', not {as_text(accuracy)}"
        raise ChoiceError(text, code="unknown-accuracy")


def _require_row(pin: str, case: str, cases: Collection[str]) -> None:
    """Raise ChoiceError for a case in which a pin has no row. cases: those in which the pin has a
    row.
    """
    if case not in cases:
        text = f"case: pin {pin} has no row in case {as_text(case)}; {near(case, cases)}"
        raise ChoiceError(text, code="unknown-case")

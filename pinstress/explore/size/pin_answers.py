"""A pin of a trial study, solved roughly, quickly, or fully as in a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import inf
from types import MappingProxyType

from assess.diameter_law import section_exponent
from fea.core.peak import Maximum
from pinbase.memo import Memo
from pinstress.analysis.engine import QUICK_TOLERANCE
from pinstress.analysis.gather.gather import results_of
from pinstress.analysis.plan import Plan, needs_fine_cells, prepare
from pinstress.analysis.remedies.secant import NoSizeError
from pinstress.analysis.reused_loads import reused_loads
from pinstress.analysis.solve import judged, solutions
from pinstress.analysis.stored import PinOutcome
from pinstress.explore.size.counted import beneath, why_unsolved
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.section_law import Accuracy, PinTrial
from pinstress.explore.size.standard_diameters import StandardDiameters
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study, raw_study
from reports.data.results import Results
from reports.data.unknowns import growth, least_factor

# Cases whose stress is below this share of the largest are solved only until it is decided that
# they reach the factor
COUNTING_SHARE = 0.5
# The least factor of a case that does not count, over the required one, from which rough cells of
# contact decide it: surface stress on them is wrong by up to 50 % (pinstress.analysis.scaled)
CLEAR_RATIO = 3.0

NO_GROWTH: Mapping[str, tuple[float, float]] = MappingProxyType({})

Tell = Callable[[str], None]


@dataclass(frozen=True)
class FullSolution:
    """A pin solved as in a run: the plan, and the outcomes of its first tasks, which count."""

    plan: Plan
    outcomes: tuple[PinOutcome, ...]

    @property
    def results(self) -> Results:
        """The rows, once every task has an outcome."""
        return results_of(self.plan, list(self.outcomes))


@dataclass(frozen=True)
class PinAnswer:
    """The result of one solution of a pin.

    trial: the factors.
    worst: the maximum that decides the factor.
    counting: the cases whose stress is near the largest.
    solution: for a full solution only, else None.
    """

    trial: PinTrial
    worst: Maximum
    counting: tuple[str, ...]
    solution: FullSolution | None = None


@dataclass(frozen=True)
class SizedStudy:
    """The study in which trial sizes of a pin are solved.

    plan: of the study as given.
    others: scales of the pins so far, by name.
    required: the factor to reach.
    memo: flexibilities and meshes that trials share.
    multiples: multiples of the factor that requirements demand, by case, as in SizingGoal.
    over_ranges: whether full solutions count the largest stress over all ranges of the study.
    """

    plan: Plan
    pin: str
    required: float
    others: Mapping[str, float]
    standard: StandardDiameters | None = None
    memo: Memo = field(default_factory=Memo)
    multiples: Mapping[str, float] = field(default_factory=dict)
    over_ranges: bool = False

    def at(self, scale: float, rounded: bool = False) -> Study:
        """Return the study with the pin at a scale.

        rounded: whether to round to standard diameters, if there are any.

        Raises: InputError for an impossible shape, NoSizeError if no standard diameter is large
        enough.
        """
        standard = self.standard if rounded else None
        scales = {**self.others, self.pin: scale}
        required = None if self.multiples else self.required
        return resized_study(self.plan.study, scales, standard, required)

    @property
    def in_lugs(self) -> bool:
        """Whether the pin is in contact with lugs in any case."""
        return any(task.lugs for task in self.plan.tasks if task.pin.name == self.pin)

    def quick(
        self, scale: float, accuracy: Accuracy, cases: tuple[str, ...] | None, tell: Tell
    ) -> PinAnswer:
        """Solve a pin without the error estimates of a full solution.

        Errors are limited to the tolerance, or assumed as large in contact, since a full solution
        will have an error within it (`design_stresses`).

        accuracy: "rough", with few contact cells, or "quick".
        cases: names of the load cases; all by default.
        """
        trial = self.at(scale)
        plan = self._plan(trial, cases)
        tolerance = plan.requirement.tolerance
        few = max(tolerance, QUICK_TOLERANCE)
        requirement = replace(plan.requirement, goal="value", tolerance=few)
        requirement = replace(requirement, compared=False, varied=False)
        if accuracy == "rough":
            requirement = replace(requirement, cells="rough")
        elif self.in_lugs:
            requirement = replace(requirement, cells="usual")
        peaks = [
            solution.peak
            for task in plan.tasks
            for solution in solutions(trial, task, requirement, tell, self.memo)
        ]
        return _answer(scale, accuracy, peaks, plan.tasks, tolerance, self.multiples)

    def full(self, scale: float, counting: tuple[str, ...], tell: Tell) -> PinAnswer:
        """Solve the cases of a pin that count as in a run, with standard diameters.

        counting: the names of these cases.
        """
        plan, rest = self._plan(self.at(scale, rounded=True), None), list[Task]()
        first = plan.tasks
        if plan.study.table.fatigue is None:
            first, rest = _split(first, counting)
        plan = replace(plan, tasks=first + rest)
        return self._full(scale, plan, [judged(plan, task, tell, self.memo) for task in first])

    def whole(self, answer: PinAnswer, tell: Tell) -> PinAnswer:
        """Solve the other cases of a full solution, until it is decided whether they reach the
        factor.
        """
        assert answer.solution is not None
        plan, outcomes = answer.solution.plan, answer.solution.outcomes
        decide = replace(plan, requirement=replace(plan.requirement, goal="decide"))
        left = plan.tasks[len(outcomes) :]
        others = [self._decided(decide, task, tell) for task in left]
        return self._full(answer.trial.scale, plan, [*outcomes, *others])

    def _decided(self, plan: Plan, task: Task, tell: Tell) -> PinOutcome:
        """Return the outcome of cases that do not count, on rough cells of contact if these leave
        no doubt.
        """
        if task.lugs and not needs_fine_cells(task):
            rough = replace(plan, requirement=replace(plan.requirement, cells="rough"))
            outcome = judged(rough, task, tell, self.memo)
            if all(least_factor(x) >= CLEAR_RATIO * (x.required or inf) for x in outcome.rows):
                return outcome
        return judged(plan, task, tell, self.memo)

    def _full(self, scale: float, plan: Plan, outcomes: list[PinOutcome]) -> PinAnswer:
        rows = [row for outcome in outcomes for row in outcome.rows]
        grown = {row.case: growth(row) for row in rows} if self.over_ranges else {}
        peaks = [row.maximum for row in rows]
        answer = _answer(scale, "full", peaks, plan.tasks, None, self.multiples, grown)
        return replace(answer, solution=FullSolution(plan, tuple(outcomes)))

    def _plan(self, trial: Study, cases: tuple[str, ...] | None) -> Plan:
        # A pin changes its own loads only if the linkage carries its weight.
        loads_of = reused_loads(raw_study(trial), self.memo)
        cases = cases or tuple(self.plan.loads)
        plan = prepare(trial, pins=[self.pin], cases=cases, loads_of=loads_of)
        return replace(
            plan, requirement=replace(plan.requirement, memory=self.plan.requirement.memory)
        )


def _split(tasks: list[Task], counting: tuple[str, ...]) -> tuple[list[Task], list[Task]]:
    """Return the tasks of the cases that count, and the tasks of the other cases."""
    parts: tuple[list[Task], list[Task]] = ([], [])
    for task in tasks:
        for part, counts in zip(parts, (True, False), strict=True):
            loads = tuple(x for x in task.loads if (x.case in counting) == counts)
            part += [replace(task, loads=loads)] if loads else []
    return parts


def _answer(
    scale: float,
    accuracy: Accuracy,
    peaks: list[Maximum],
    todo: list[Task],
    tolerance: float | None,
    multiples: Mapping[str, float],
    grown: Mapping[str, tuple[float, float]] = NO_GROWTH,
) -> PinAnswer:
    """Return the result of a pin from its maxima in all cases.

    tolerance: as in `design_stresses`.
    multiples: multiples of the factor, by case; the stress is multiplied by them.
    grown: factors on the stress of the row and on that beneath contact, by case.

    Raises: NoSizeError if the pin is not solved.
    """
    for peak in peaks:
        if why := why_unsolved(peak):
            raise NoSizeError(why)
        if accuracy == "full" and not peak.bounded:
            raise NoSizeError(f"the error is unknown in case {peak.case}: {peak.note}")
    loaded = [peak for peak in peaks if peak.max_von_mises]
    acting = [peak for peak in loaded if multiples.get(peak.case, 1.0)]
    if not acting:
        which = " in which a factor is required" if loaded else ""
        raise NoSizeError(f"no case{which} loads it")
    strength = todo[0].material.yield_strength
    assert strength is not None  # a pin without strength is refused before
    stresses = []
    for peak in acting:
        times = multiples.get(peak.case, 1.0)
        of_row, below = design_stresses(peak, tolerance)
        on_row, on_below = grown.get(peak.case, (1.0, 1.0))
        stresses.append((times * on_row * of_row, times * on_below * below))
    row, below = (max(each) for each in zip(*stresses, strict=True))
    largest = max(row, below)
    worst = next(p for p, s in zip(acting, stresses, strict=True) if max(s) == largest)
    highest = next(p for p, s in zip(acting, stresses, strict=True) if s[0] == row)
    section = highest.places.section if highest.places else None
    exponent = section_exponent(todo[0].pin, section)
    beneath_factor = strength / below if below else float("inf")
    trial = PinTrial(scale, strength / row, beneath_factor, exponent, accuracy)
    counting = tuple(
        peak.case
        for peak, stress in zip(acting, stresses, strict=True)
        if max(stress) >= COUNTING_SHARE * largest
    )
    return PinAnswer(trial, worst, counting)


def design_stresses(peak: Maximum, tolerance: float | None = None) -> tuple[float, float]:
    """Return the stresses that decide, Pa: of the row and beneath contact, with their errors.

    tolerance: None for the errors as found. Otherwise, in contact, this relative error is added to
    the stresses instead of their own (to a singular one none); without contact it is the largest
    error that counts.
    """
    if tolerance is None:
        return row_stress(peak), beneath(peak)
    row = (peak.max_von_mises or 0.0) * (1.0 + tolerance * (peak.verdict != "singular"))
    contact = peak.places and peak.places.contact
    if contact:  # the error of this stress is not known in a trial
        return row, contact.beneath * (1.0 + tolerance)
    return min(row_stress(peak), row), 0.0


def row_stress(peak: Maximum) -> float:
    """Return the stress of a row that decides, Pa: the maximum with its error.

    A singular row counts with the maximum outside the excluded zones, without an error.
    """
    return (peak.max_von_mises if peak.verdict == "singular" else peak.upper_end) or 0.0

"""The least weight of one pin that reaches a factor of safety in all its cases, under given loads.

First it is scaled as a whole, as `size` does; the search goes on from there, so that it is never
heavier. The result is rounded as it is written, and solved once more.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from pinbase.arrays import Floats
from pinstress.analysis.plan import Plan
from pinstress.analysis.remedies.dimensions import dimensions_of
from pinstress.analysis.remedies.secant import (
    FACTOR_TOLERANCE,
    MAX_SCALE_STEP,
    NoSizeError,
    smallest,
)
from pinstress.explore.size.contact_slopes import UndifferentiatedError
from pinstress.explore.size.optimise import (
    ACTIVE_TOLERANCE,
    ImpossibleError,
    Optimality,
    Optimum,
    StressPlace,
    least_weight,
    optimality,
)
from pinstress.explore.size.pin_shape import (
    DIMENSION_KINDS,
    MAX_DIMENSION_RATIO,
    Proportions,
    VariedShape,
    kind_of,
)
from pinstress.explore.size.pin_stress import (
    PinStress,
    SizingProblem,
    SolvedPin,
)
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.singular_places import decided
from pinstress.explore.size.standard_diameters import StandardDiameters
from pinstress.explore.size.written_dimensions import (
    LIMIT_ROUNDING_TOLERANCE,
    MAX_ROUNDING_STEPS,
    binding,
    rounded_values,
)
from pinstress.study.model.hardened import hardened_key, hardened_reason
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study

STRESS_MARGIN = 0.004  # of the stress, below what is allowed: noise of meshes, and rounding
WEIGHT_CONVERGENCE = 2e-3  # of the weight: what meshes are worth
SCALE_BRACKET_TOLERANCE = 5e-3  # a bracket of scales that is not looked into
SLOPE_RANGE = 0.06  # from the factor (its logarithm): nearer, its slope says which scale reaches it
# Of the stress of a pin in contact, below what is allowed: near enough
CONTACT_STRESS_TOLERANCE = 0.05
# STRESS_MARGIN and WEIGHT_CONVERGENCE in contact, where meshes and cells scatter
CONTACT_STRESS_MARGIN, CONTACT_WEIGHT_CONVERGENCE = 0.015, 1e-2
MAX_CORRECTIONS = 3  # of what rough cells say
MAX_SCALINGS = 10
# Of the weight of a pin that is only scaled, where that was found by slopes
SCALED_WEIGHT_DOUBT = 0.03
MAX_REPAIRS = 4
SCALED_AS_WHOLE_NOTE = (
    "scaled as a whole, because its stress has no derivatives by its dimensions{}"
)
CUTS_REASON = ": it has cuts, or is no body of revolution"
LEFT_AS_IT_IS = "left as it is: "

Tell = Callable[[str], None]


@dataclass(frozen=True)
class WeightGoal:
    """The goal of a search for the least weight.

    required: the factor.
    vary: kinds of dimensions (DIMENSION_KINDS) that may change.
    limits: geometric limits.
    step: step to which diameters are rounded up, m.
    more: as SizingGoal has it.
    likely: by pin and case, times that factor, which the nominal design needs so that a less likely
    one reaches it.
    """

    required: float
    vary: tuple[str, ...] = DIMENSION_KINDS
    limits: Proportions = field(default_factory=Proportions)
    step: float | None = None
    more: Mapping[tuple[str, str], float] = field(default_factory=dict)
    likely: Mapping[tuple[str, str], float] = field(default_factory=dict)

    @property
    def written(self) -> float | None:
        """The required factor of the new study; None where that keeps its own requirements."""
        return None if self.more else self.required

    @property
    def standard(self) -> StandardDiameters | None:
        """The diameters that are multiples of the step, if there is one."""
        return None if self.step is None else StandardDiameters(self.step)

    def of_pin(self, pin: str) -> dict[str, float]:
        """Return the multiples of the factor that a pin needs, by case, 0 for none."""
        return {
            place[1]: self.more.get(place, 1.0) * self.likely.get(place, 1.0)
            for place in self.more.keys() | self.likely.keys()
            if place[0] == pin
        }


@dataclass(frozen=True)
class Lightest:
    """The lightest form of a pin.

    values: its dimensions by key, m, as they are written; None if it is only scaled.
    scale: scale of a pin that is only scaled. Both are None where nothing reaches the factor, for
    the reason `why`.
    before: lower end of its factor as it was, in the case that governed.
    factor: the same with these dimensions, over what is demanded there, times the required one.
    scaled: its volume, m^3, were it only scaled; None where that is not known.
    whole: its dimensions, m, were it only scaled; None where they are not known.
    optimality: how far the result of the search meets the conditions of an optimum.
    binding: active constraints, in words, with their multipliers.
    solved: number of designs.
    way: why it is only scaled, or left as it is, or how the search ended if it did not converge.
    decided: as in Start.
    """

    pin: str
    values: dict[str, float] | None = None
    scale: float | None = None
    before: float | None = None
    factor: float | None = None
    scaled: float | None = None
    whole: tuple[float, ...] | None = None
    optimality: Optimality | None = None
    binding: tuple[tuple[str, float], ...] = ()
    solved: int = 0
    why: str = ""
    way: str = ""
    decided: frozenset[str] | None = None

    @property
    def kept(self) -> bool:
        """Return whether the pin is left as it is."""
        return self.way.startswith(LEFT_AS_IT_IS)


@dataclass(frozen=True)
class Start:
    """The start of a search for a pin, as found under other loads.

    values: its dimensions by key, m.
    scale: its scale, if it is only scaled.
    whole: its dimensions, m, were it only scaled.
    decided: cases in which no singularity may govern; by default those in which none does in the
    pin as it is given.
    """

    values: dict[str, float] | None = None
    scale: float | None = None
    whole: tuple[float, ...] | None = None
    decided: frozenset[str] | None = None


def lightest_pin(
    study: Study,
    plan: Plan,
    pin: str,
    aim: WeightGoal,
    start: Start | None = None,
    tell: Tell = lambda _: None,
) -> Lightest:
    """Find the lightest form of a pin of the study as it was given.

    plan: has the loads of the study as it is now.

    Failures are reported in the answer.
    """
    problem = problem_of(study, plan, pin, aim)
    if isinstance(problem, str):
        return Lightest(pin, why=problem)
    start = start or Start()
    stress = PinStress(problem, tell)
    before: float | None = None
    try:
        if start.scale is not None or not problem.shape.whole.revolved:
            raise UndifferentiatedError
        shape, known = problem.shape, start.values or {}
        values = np.array([known.get(d.key, d.value) for d in shape.dimensions])
        stress.at(values, SLOPE_RANGE)
        sure = stress.sure(values)
        before = problem.demanded(sure.governs) * float(np.exp(-sure.largest))
        stress.watched = decided(sure.peaks) if start.decided is None else start.decided
        start = replace(start, decided=stress.watched)
        first = stress.at(values)
        search = _Search(problem, stress, aim)
        if start.values is not None:
            result = _found(search, first, start.whole)
        else:
            near, whole = _scaled(search, first, roughly=len(values) > 1)
            result = _found(search, near, tuple(map(float, whole)))
        return replace(result, before=before, decided=stress.watched)
    except UndifferentiatedError:
        return _only_scaled(stress, aim, start)
    except ImpossibleError as error:
        failed = Lightest(pin, before=before, solved=stress.count, why=str(error))
        if before is None or not stress.watched:
            return failed
        if start.values is None and before >= problem.required and not _singular(stress):
            return as_it_is(study, aim, failed, str(error))
        return lightest_pin(study, plan, pin, aim, replace(start, decided=frozenset()), tell)


def _singular(stress: PinStress) -> bool:
    """Return whether a singularity governs in the design that was solved first."""
    return any(peak.verdict == "singular" for peak in stress.solved[0].peaks)


def as_it_is(study: Study, aim: WeightGoal, result: Lightest, why: str) -> Lightest:
    """Return the pin as it is in the study in place of a result that is decided worse."""
    shape = VariedShape(study, pin_of(study, result.pin), aim.vary, aim.limits)
    values = {d.key: d.value for d in shape.dimensions} or None
    scale = 1.0 if values is None else None
    return Lightest(
        result.pin, values, scale, result.before, result.before, solved=result.solved,
        way=LEFT_AS_IT_IS + why,
    )  # fmt: skip


def _only_scaled(stress: PinStress, aim: WeightGoal, start: Start) -> Lightest:
    """Scale all dimensions by one number, as `size` does, without derivatives."""
    problem, first = stress.problem, start.scale or 1.0
    factors: dict[float, float] = {}
    governs: list[str] = []
    stress.watched = start.decided or frozenset()

    def factor_at(scale: float) -> float:
        solution = stress.of(resized_study(problem.study, {problem.name: scale}, aim.standard))
        governs.append(solution.governs)
        if not factors and start.decided is None:
            stress.watched = decided(solution.peaks)
        factors[scale] = problem.required * float(np.exp(-solution.worst))
        return factors[scale]

    def before() -> float | None:
        times = problem.demanded(governs[0]) / problem.required if governs else 1.0
        return times * factors[first] if factors else None

    try:
        best = smallest(factor_at, problem.required, first)
        way = SCALED_AS_WHOLE_NOTE.format("" if problem.shape.whole.revolved else CUTS_REASON)
    except (NoSizeError, ImpossibleError, InputError) as error:
        return Lightest(problem.name, before=before(), solved=len(factors), why=str(error))
    return Lightest(
        problem.name, None, best.scale, before(), best.factor, solved=len(factors), way=way,
        decided=stress.watched,
    )  # fmt: skip


def problem_of(study: Study, plan: Plan, pin: str, aim: WeightGoal) -> SizingProblem | str:
    """Return the problem that is posed for a pin, or the reason why there is none."""
    table = study.table.pin[pin]
    if table.geometry is not None:
        return "its shape comes from a file, which has no dimensions to change"
    if key := hardened_key(study, pin):
        return hardened_reason(key)
    if study.table.material[table.material].yield_strength is None:
        return f"its material {table.material} has no yield_strength"
    shaft = pin_of(study, pin)
    shape = VariedShape(study, shaft, aim.vary, aim.limits)
    if not shape.dimensions and shaft.revolved:
        has = [
            kind
            for kind in DIMENSION_KINDS
            if any(kind_of(d.key) == kind for d in dimensions_of(study, shaft))
        ]
        return f"it has no {' or '.join(aim.vary)} to vary, only {' and '.join(has)}"
    more = aim.of_pin(pin)
    loads = {case: x for case, x in plan.loads.items() if more.get(case, 1.0)}
    if not loads:
        return "no factor is required of it"
    requirement = replace(plan.requirement, goal="value", varied=False)
    return SizingProblem(study, pin, shape, requirement, loads, aim.required, more)


class _Search:
    """The pin as a problem for pinstress.explore.size.optimise."""

    def __init__(self, problem: SizingProblem, stress: PinStress, aim: WeightGoal) -> None:
        self.problem, self.stress, self.aim = problem, stress, aim
        self.shape = problem.shape

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        now, far = np.log(self.shape.values), np.log(MAX_DIMENSION_RATIO)
        return now - far, now + far

    def weight(self, x: Floats) -> tuple[float, Floats]:
        values = np.exp(x)
        volume, slope = self.shape.volume(values)
        return float(np.log(volume)), slope * values / volume

    def limits(self, x: Floats) -> tuple[Floats, Floats]:
        values = np.exp(x)
        limits, slopes = self.shape.at_limits(values)
        return limits, slopes * values

    def stresses(self, x: Floats) -> tuple[StressPlace, ...]:
        return self.raised(self.stress.at(np.exp(x)))

    def raised(self, solved: SolvedPin) -> tuple[StressPlace, ...]:
        """Return the stresses of places with a margin added, so that the search aims a little
        low.
        """
        aim = CONTACT_STRESS_MARGIN if self.stress.in_contact else STRESS_MARGIN
        return tuple(replace(p, value=p.value + aim) for p in solved.every)

    def least_weight(self, start: Floats) -> Optimum:
        """Find the least weight from logarithms of dimensions."""
        return least_weight(
            self,
            start,
            CONTACT_WEIGHT_CONVERGENCE if self.stress.in_contact else WEIGHT_CONVERGENCE,
        )

    def volume(self, solved: SolvedPin) -> float:
        """Return the volume, m^3."""
        return float(self.shape.volume(solved.values)[0])

    def written(self, values: Floats) -> Floats:
        """Return dimensions as they are written."""
        metre = self.problem.study.system.factor("length")
        return rounded_values(self.shape, values, self.aim.step, metre)

    def keeps(self, values: Floats) -> bool:
        """Return whether geometric limits hold but for the digits that are written."""
        return float(self.shape.at_limits(values)[0].min(initial=0.0)) >= -LIMIT_ROUNDING_TOLERANCE


def _found(search: _Search, near: SolvedPin, whole: tuple[float, ...] | None) -> Lightest:
    """Search from a design near the factor.

    whole: dimensions of the pin that is only scaled, m, if known.
    """
    shape, aim = search.shape, search.aim
    optimum = _optimum(search, near)
    best = _written(search, optimum)
    before, as_whole = None, near.values if whole is None else np.array(whole)
    if set(aim.vary) == set(DIMENSION_KINDS):
        before = float(shape.volume(search.written(as_whole))[0])
        if before <= search.volume(best) * (1.0 + SCALED_WEIGHT_DOUBT):
            _, as_whole = _scaled(search, search.stress.at(as_whole), roughly=False)
            as_scaled = _repaired(search, as_whole)
            if as_scaled is not None:
                before = search.volume(as_scaled)
                best = min(as_scaled, best, key=search.volume)
    return Lightest(
        search.problem.name,
        dict(zip(shape.keys, map(float, best.values), strict=True)),
        factor=aim.required * float(np.exp(-best.largest)),
        scaled=before,
        whole=tuple(map(float, as_whole)),
        optimality=optimum.optimality,
        binding=tuple(binding(shape, optimum)),
        solved=search.stress.count,
        way=optimum.why,
    )


def _optimum(search: _Search, near: SolvedPin) -> Optimum:
    """Find the optimum from a design near the factor.

    For a pin in contact the stresses on rough cells are corrected at the optimum, and the search is
    repeated from there, until the finer ones agree.
    """
    if len(search.shape.dimensions) > 1 or not -ACTIVE_TOLERANCE <= near.worst <= 0.0:
        optimum = search.least_weight(np.log(near.values))
    else:
        x, places = np.log(near.values), near.every
        optimum = Optimum(x, search.weight(x)[0], places, optimality(search, x, places), 0)
    if search.stress.in_contact:
        for _ in range(MAX_CORRECTIONS):
            sure = search.stress.sure(search.written(np.exp(optimum.x)))
            if -CONTACT_STRESS_TOLERANCE <= sure.worst <= 0.0:
                break
            optimum = search.least_weight(optimum.x)
    return optimum


def _scaled(search: _Search, first: SolvedPin, roughly: bool) -> tuple[SolvedPin, Floats]:
    """Multiply all dimensions by one number until the factor is reached.

    Returns the solved design nearest to the factor, and the dimensions that reach it, `roughly` by
    the slope of stress there. The pin stays as it is where only bores change.

    Raises: ImpossibleError.
    """
    now, values = first, search.shape.values
    best: SolvedPin | None = None
    small, why = None, ""  # small: with which stress is too large
    for _ in range(MAX_SCALINGS):
        here = float(np.log(now.values[0] / values[0]))
        if now.worst <= 0.0:
            best = now
        else:
            small = here if small is None else max(small, here)
        if -FACTOR_TOLERANCE <= now.worst <= 0.0:
            break
        top = max((p for p in now.places if p.slope is not None), key=lambda p: p.value)
        assert top.slope is not None  # it was found with derivatives
        if top.slope.sum() > 0.0:  # of bores alone, which weaken it
            return first, first.values
        leap, rate = np.log(MAX_SCALE_STEP), min(float(top.slope.sum()), -0.5)
        target = here + float(np.clip((now.worst + STRESS_MARGIN) / -rate, -leap, leap))
        if roughly and abs(now.worst) <= SLOPE_RANGE:
            return now, values * np.exp(target)
        if best is not None:
            large = float(np.log(best.values[0] / values[0]))
            if large - (target if small is None else small) < SCALE_BRACKET_TOLERANCE:
                break
            if small is not None and not small < target < large:
                target = 0.5 * (small + large)
        if abs(target) > np.log(MAX_DIMENSION_RATIO):
            break
        try:
            tried = values * np.exp(target)
            now = search.stress.at(tried if roughly else search.written(tried), SLOPE_RANGE)
        except ImpossibleError as error:
            why = f"; with {np.exp(target):.3g} times: {error}"
            break
    if best is None:
        factor = search.aim.required * float(np.exp(-now.worst))
        times = float(now.values[0] / values[0])
        raise ImpossibleError(
            f"with {times:.3g} times these dimensions its factor is only {factor:.4g}{why}; its "
            "bands must be longer, its material stronger or its loads smaller"
        )
    return best, best.values


def _written(search: _Search, optimum: Optimum) -> SolvedPin:
    """Return the lightest design that was found and reaches the factor, as it is written.

    Raises: ImpossibleError.
    """
    stress, step = search.stress, search.aim.step
    candidates = [x for x in [_repaired(search, np.exp(optimum.x))] if x is not None]
    lighter = [x for x in stress.solved if x.worst <= 0.0 and search.keeps(x.values)]
    if lighter and step is None:
        best = min(lighter, key=search.volume)
        if not candidates or search.volume(best) < search.volume(candidates[0]):
            candidates += [x for x in [_repaired(search, best.values)] if x is not None]
    if not candidates:
        raise ImpossibleError("the dimensions found, and slightly larger ones, miss the factor")
    return min(candidates, key=search.volume)


def _repaired(search: _Search, values: Floats) -> SolvedPin | None:
    """Return a design whose written dimensions reach the factor, larger where need be; None where
    there is none.
    """
    step, more = search.aim.step, 0.0
    for k in range(MAX_REPAIRS if step is None else MAX_ROUNDING_STEPS):
        solution = search.stress.sure(search.written(values * (1.0 + more)))
        if solution.worst <= 0.0:
            return solution
        if step is None:  # by what stress exceeds, were it tension, which is enough
            more += 0.6 * solution.worst + 5e-4 * (k + 1)
        else:
            more += 0.5 * step / float(values.min())
    return None

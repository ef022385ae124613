"""The least weight at which one pin reaches a safety factor in all its load cases, under given
loads.

First the pin is scaled as a whole, as `size` does. The search continues from that design, so that
the result is never heavier. The result is rounded as it is written, and solved once more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pinstress.analysis.plan import Plan
from pinstress.analysis.remedies.dimensions import dimensions_of
from pinstress.analysis.remedies.secant import NoSizeError, smallest
from pinstress.explore.size.contact_slopes import UndifferentiatedError
from pinstress.explore.size.optimise import ImpossibleError, Optimality
from pinstress.explore.size.pin_shape import DIMENSION_KINDS, VariedShape, kind_of
from pinstress.explore.size.pin_stress import PinStress, SizingProblem, SolvedPin
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.singular_places import decided
from pinstress.explore.size.size_pin import why_fixed
from pinstress.explore.size.weight_search import (
    SLOPE_RANGE,
    WeightGoal,
    WeightSearch,
    optimum_of,
    repaired,
    scaled,
    written,
)
from pinstress.explore.size.written_dimensions import binding
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study

# Relative uncertainty of the weight of a pin that is only scaled, if slopes gave the scale
SCALED_WEIGHT_DOUBT = 0.03
SCALED_AS_WHOLE_NOTE = (
    "scaled as a whole, because its stress has no derivatives by its dimensions{}"
)
CUTS_REASON = ": it has cuts, or is no body of revolution"
LEFT_AS_IT_IS = "left as it is: "

Tell = Callable[[str], None]


@dataclass(frozen=True)
class Lightest:
    """The lightest design of a pin.

    values: its dimensions by key, m, as they are written; None if the pin is only scaled.
    scale: the scale of a pin that is only scaled. If both are None, no design reaches the factor,
    for the reason `why`.
    before: lower end of the pin's factor as given, in the case that governed.
    factor: lower end of the factor with the new dimensions, divided by the multiple demanded in the
    governing case.
    scaled: volume of the pin if it were only scaled, m^3; None if unknown.
    whole: dimensions of the pin if it were only scaled, m; None if unknown.
    optimality: how far the result meets the conditions of an optimum.
    binding: the active constraints, in words, with their multipliers.
    solved: number of solved designs.
    way: why the pin is only scaled, or left as given, or why the search did not converge.
    decided: cases in which no singularity may govern; None: those in which none governs in the pin
    as given.
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
        """Whether the pin is left as given."""
        return self.way.startswith(LEFT_AS_IT_IS)


def lightest_pin(
    study: Study,
    plan: Plan,
    pin: str,
    aim: WeightGoal,
    start: Lightest | None = None,
    tell: Tell = lambda _: None,
) -> Lightest:
    """Find the lightest design of a pin.

    study: the study as given. plan: has the loads of the study as changed so far. start: the last
    design, as found under other loads.

    Failures are reported in the result.
    """
    problem = problem_of(study, plan, pin, aim)
    if isinstance(problem, str):
        return Lightest(pin, why=problem)
    start = start or Lightest(pin)
    stress = PinStress(problem, tell)
    before: float | None = None
    try:
        if start.scale is not None or not problem.shape.whole.revolved:
            raise UndifferentiatedError
        shape, known = problem.shape, start.values or {}
        values = np.array([known.get(d.key, d.value) for d in shape.dimensions])
        stress.at(values, SLOPE_RANGE)
        fine = stress.verified(values)
        before = problem.demanded(fine.governs) * float(np.exp(-fine.largest))
        stress.watched = decided(fine.peaks) if start.decided is None else start.decided
        start = replace(start, decided=stress.watched)
        first = stress.at(values)
        search = WeightSearch(problem, stress, aim)
        if start.values is not None:
            result = _found(search, first, start.whole)
        else:
            near, whole = scaled(search, first, roughly=len(values) > 1)
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
    """Whether a singularity governs in the design that was solved first."""
    return any(peak.verdict == "singular" for peak in stress.solved[0].peaks)


def as_it_is(study: Study, aim: WeightGoal, result: Lightest, why: str) -> Lightest:
    """Return the pin as given in the study, to replace a result whose outcome is worse."""
    shape = VariedShape(study, pin_of(study, result.pin), aim.vary, aim.limits)
    values = {d.key: d.value for d in shape.dimensions} or None
    scale = 1.0 if values is None else None
    return Lightest(
        result.pin, values, scale, result.before, result.before, solved=result.solved,
        way=LEFT_AS_IT_IS + why,
    )  # fmt: skip


def _only_scaled(stress: PinStress, aim: WeightGoal, start: Lightest) -> Lightest:
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
    """Return the sizing problem of a pin, or the reason why there is none."""
    if why := why_fixed(study, pin):
        return why
    shaft = pin_of(study, pin)
    shape = VariedShape(study, shaft, aim.vary, aim.limits)
    if not shape.dimensions and shaft.revolved:
        has = [
            kind
            for kind in DIMENSION_KINDS
            if any(kind_of(d.key) == kind for d in dimensions_of(study, shaft))
        ]
        return f"it has no {' or '.join(aim.vary)} to vary, only {' and '.join(has)}"
    multiples = aim.of_pin(pin)
    loads = {case: x for case, x in plan.loads.items() if multiples.get(case, 1.0)}
    if not loads:
        return "no factor is required of it"
    requirement = replace(plan.requirement, goal="value", varied=False)
    return SizingProblem(study, pin, shape, requirement, loads, aim.required, multiples)


def _found(search: WeightSearch, near: SolvedPin, whole: tuple[float, ...] | None) -> Lightest:
    """Search from a design near the factor, and return the lightest design.

    whole: dimensions of the pin if it were only scaled, m; None if unknown.
    """
    shape, aim = search.shape, search.aim
    optimum = optimum_of(search, near)
    best = written(search, optimum)
    before, as_whole = None, near.values if whole is None else np.array(whole)
    if set(aim.vary) == set(DIMENSION_KINDS):
        before = float(shape.volume(search.written(as_whole))[0])
        if before <= search.volume(best) * (1.0 + SCALED_WEIGHT_DOUBT):
            _, as_whole = scaled(search, search.stress.at(as_whole), roughly=False)
            as_scaled = repaired(search, as_whole)
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

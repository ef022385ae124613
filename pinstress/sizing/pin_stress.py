"""The stresses of a pin with other dimensions, in all cases, and their derivatives where they may
govern: solved as a run solves them, so that what they say is what a run says.

Of a body of revolution the largest stress is found in both halves of each segment. In a row that is
singular stress is read half the excluded distance away, where the upper end of the reported range
is. All stresses of a row are raised by the ratio of what counts of it to the largest of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from fea.asked import Asked
from fea.core.linear_solver import SolveError
from fea.core.peak import Peak
from fea.derivatives.places import PartsOfSection, PartTop, halves
from fea.derivatives.records import SolvedCase
from fea.harmonic.evaluate import HarmonicAnswer
from fea.joint.solve_in_lugs import LugSolution
from fea.singular.singularities import VARIED
from fea.solve_pin import Solution
from geometry import ArgumentError, Pin
from geometry.arrays import Floats, Mask
from geometry.shape.dimensions import Dimension
from pinstress.analysis.solve import solutions
from pinstress.model.cases import CaseLoads
from pinstress.model.pins import pin as pin_of
from pinstress.model.tasks import Task, tasks
from pinstress.remedies.dimensions import dimensions_of
from pinstress.remedies.sensitivities import by_length, differentiated
from pinstress.sizing.optimise import ImpossibleError, StressPlace, worst
from pinstress.sizing.other_dimensions import paths_of, study_with
from pinstress.sizing.pin_shape import VariedShape
from pinstress.study.errors import InputError
from pinstress.study.file import Study, raw_study

WINDOW = 0.15  # of the logarithm of stress below the largest: where derivatives are found
UNKNOWN = 0.3  # the same of places where they are not yet known
BENDING = -3.0  # power of the diameter, where nothing is known

Tell = Callable[[str], None]


@dataclass(frozen=True)
class PinProblem:
    """A pin of a study under loads that do not change: its shape, what is asked, by case the loads
    and the part of the required factor that is needed there, mostly 1.
    """

    study: Study
    name: str
    shape: VariedShape
    asked: Asked
    loads: dict[str, CaseLoads]
    required: float
    more: dict[str, float]


@dataclass(frozen=True)
class SolvedPin:
    """Peaks and places at values (n,) of the dimensions, m; places by the logarithms of these."""

    values: Floats
    peaks: tuple[Peak, ...]
    places: tuple[StressPlace, ...]

    @property
    def worst(self) -> float:
        """The logarithm of the largest stress over what is allowed."""
        return worst(self.places)


@dataclass(frozen=True)
class _Found:
    """The largest stress of a part, Pa as it counts, and what its derivatives need."""

    name: str
    stress: float
    slopes: Callable[[], Floats]
    guess: Floats | None = None


def counted(peak: Peak) -> float:
    """The stress (Pa) that is compared with what is allowed: a converged one as it is, the upper
    end of any other.
    """
    stress = peak.max_von_mises or 0.0
    if peak.verdict == "converged":
        return stress
    return peak.interval[1] if peak.interval else stress + (peak.error_estimate or 0.0)


class UndifferentiatedError(Exception):
    """Stress has no derivatives by dimensions: of a pin with cuts, or of some in contact."""


class PinStress:
    """Solves a pin with other dimensions. scale: of all loads' allowed stress, below 1 to stay
    away from the limit.
    """

    def __init__(self, problem: PinProblem, tell: Tell) -> None:
        self.problem, self._tell = problem, tell
        self._raw: dict[str, Any] = raw_study(problem.study)
        shape = problem.shape
        self._paths = [paths_of(shape.pin, d) for d in shape.dimensions]  # none of other pins
        self._known: set[str] = set()
        self.solved: list[SolvedPin] = []
        self.count = 0  # of designs

    def study_at(self, values: Floats) -> Study:
        """Raises: InputError."""
        every = list(zip(self._paths, map(float, values), strict=True))
        return study_with(self.problem.study, self._raw, self.problem.name, every)

    def at(self, values: Floats, far: float = np.inf) -> SolvedPin:
        """Derivatives at all places that may govern; of the worst place only, where its stress is
        `far` from what is allowed (its logarithm). Raises: ImpossibleError, UndifferentiatedError.
        """
        for known in self.solved:
            if np.array_equal(known.values, values):
                return known
        try:
            found = self._solved(self.study_at(values), values, far)
        except InputError as error:
            raise ImpossibleError(str(error)) from None
        self.solved.append(found)
        return found

    def of(self, study: Study) -> SolvedPin:
        """Of the pin in a study, without derivatives. Raises: ImpossibleError."""
        return self._solved(study, None, 0.0)

    def _solved(self, study: Study, values: Floats | None, far: float) -> SolvedPin:
        self.count += 1
        self._tell(f"pin {self.problem.name}, design {self.count}")
        peaks: list[Peak] = []
        found: list[tuple[_Found, float]] = []
        try:
            for task in tasks(study, [pin_of(study, self.problem.name)], self.problem.loads):
                for peak, parts in self._of_task(study, task, values is not None):
                    peaks.append(peak)
                    found += [(part, self._allowed(task, peak)) for part in parts]
        except (InputError, ArgumentError, ArithmeticError, MemoryError) as error:
            raise ImpossibleError(str(error) or "out of memory") from None
        if not peaks:
            raise ImpossibleError("no case loads it")
        logs = [float(np.log(part.stress / allowed)) for part, allowed in found]
        top = max(logs)
        places = []
        for (part, _), value in zip(found, logs, strict=True):
            window = WINDOW if part.name in self._known else UNKNOWN
            slope = None
            if values is not None and value >= top - (window if abs(top) < far else 0.0):
                slope = values * self._slope(part)
                self._known.add(part.name)
            places.append(StressPlace(part.name, value, slope, part.guess))
        return SolvedPin(np.zeros(0) if values is None else values, tuple(peaks), tuple(places))

    def _slope(self, part: _Found) -> Floats:
        try:
            return part.slopes()
        except ArithmeticError as error:
            raise ImpossibleError(str(error)) from None

    def _allowed(self, task: Task, peak: Peak) -> float:
        """Stress, Pa."""
        strength = task.material.yield_strength
        assert strength is not None  # a pin without strength is refused before
        return strength / (self.problem.required * self.problem.more.get(peak.case, 1.0))

    def _of_task(
        self, study: Study, task: Task, differentiated: bool
    ) -> Iterator[tuple[Peak, list[_Found]]]:
        """Peaks and what is found of each."""
        if differentiated and not isinstance(task.pin, Pin):
            raise UndifferentiatedError
        dimensions = self._dimensions(study, task) if differentiated else ()
        section = PartsOfSection(dimensions)
        for each in solutions(study, task, self.problem.asked, lambda _: None):
            solution = each.solution if isinstance(each, LugSolution) else each
            peak = solution.peak
            _require_solved(peak)
            if not peak.max_von_mises:
                continue
            if not differentiated:
                yield peak, [_Found(peak.case, counted(peak), lambda: np.zeros(0))]
            elif isinstance(each, LugSolution):
                slopes = partial(self._in_contact, study, task, each, peak.max_von_mises)
                yield peak, [_Found(peak.case, counted(peak), slopes)]
            else:
                yield peak, self._parts(task, each, dimensions, section)

    def _in_contact(self, study: Study, task: Task, joined: LugSolution, maximum: float) -> Floats:
        """Relative derivatives of the largest stress, 1/m. Raises: UndifferentiatedError."""
        by = by_length(study, task, joined)
        if by is None:
            raise UndifferentiatedError
        return np.array([by.get(key, 0.0) for key in self.problem.shape.keys]) / maximum

    def _dimensions(self, study: Study, task: Task) -> tuple[Dimension, ...]:
        by = {d.key: d for d in dimensions_of(study, task.pin)}
        try:
            return tuple(by[key] for key in self.problem.shape.keys)
        except KeyError:
            raise ImpossibleError("two of its dimensions have become equal") from None

    def _parts(
        self,
        task: Task,
        solution: Solution,
        dimensions: tuple[Dimension, ...],
        parts: PartsOfSection,
    ) -> list[_Found]:
        """Of a row that no lugs hold."""
        peak, answer, pin = solution.peak, solution.answer, task.pin
        assert isinstance(pin, Pin)  # others are not differentiated
        if not isinstance(answer, HarmonicAnswer):

            def whole() -> Floats:
                made = differentiated(self.problem.asked, task, solution, dimensions)
                if made is None:
                    raise SolveError("no derivatives", "no-derivatives")
                slope = np.array([made.by_dimension.get(d.key, 0.0) for d in dimensions])
                return slope / made.maximum

            return [_Found(peak.case, counted(peak), whole)]
        zones = answer.singularities
        if peak.verdict != "converged" and peak.interval is not None:
            near = min(VARIED)
            zones = tuple(replace(zone, radius=near * zone.radius) for zone in zones)
        clamps = tuple(pin.surface(name) for name in task.clamps)
        solved = SolvedCase(pin, task.material, clamps, solution.loads, answer.solution, zones)
        masks = halves(pin.stations, answer.fields.points)
        tops = parts.tops(solved, solution.loads, masks)
        times = counted(peak) / max(top.top.value for top in tops)

        def slopes(top: PartTop, mask: Mask) -> Callable[[], Floats]:
            return lambda: parts.slopes(solved, solution.loads, top, mask) / top.top.value

        named = {name: (mask, k // 2) for k, (name, mask) in enumerate(masks)}
        return [
            _Found(
                f"{peak.case}, {top.part}",
                times * top.top.value,
                slopes(top, named[top.part][0]),
                BENDING * self.problem.shape.part_of_diameter(named[top.part][1]),
            )
            for top in tops
            if top.top.value > 0.0
        ]


def _require_solved(peak: Peak) -> None:
    """Raises: ImpossibleError."""
    if peak.verdict == "rigid":
        raise ImpossibleError(f"it is unconstrained in case {peak.case}: {peak.note}")
    if peak.verdict == "failed":
        raise ImpossibleError(f"the numerical solution failed in case {peak.case}: {peak.note}")

"""The stresses of a pin with changed dimensions in all load cases, and their derivatives.

Stresses are solved as in a run, so that a run confirms them. Derivatives are found where a stress
may govern.

For a body of revolution they are the largest stress in both halves of each segment and the largest
section stress. For a pin in contact they are the largest stress of the surface, of the sections and
beneath contact; all three must meet the factor. In a singular row stress is read at half the
excluded distance, where the upper end of the reported range is.

A pin in contact is searched on rough contact cells, which take at most a fifth of the time of the
finest. The difference to the usual cells is found where it matters (`verified`) and added to all
stresses on rough cells. Cases whose stress is far below the largest are left out until the pin has
changed much.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from assess.derivatives.places import PartsOfSection
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from geometry import ArgumentError
from geometry.shape.dimensions import Dimension
from pinbase.arrays import Floats
from pinbase.memo import Memo
from pinstress.analysis.remedies.dimensions import dimensions_of
from pinstress.analysis.solve import solutions
from pinstress.explore.size.contact_slopes import UndifferentiatedError
from pinstress.explore.size.counted import why_unsolved
from pinstress.explore.size.optimise import ImpossibleError, StressPlace, worst
from pinstress.explore.size.other_dimensions import paths_of, study_with
from pinstress.explore.size.pin_shape import VariedShape
from pinstress.explore.size.row_parts import RowPart, SizedRow, no_slopes, parts_in_lugs
from pinstress.explore.size.scaled_study import wider_eyes
from pinstress.explore.size.singular_places import CasePlace, SingularPlaces
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.tasks import Task, tasks
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study, raw_study

# Derivatives are found where the logarithm of stress is within this window below the largest
GRADIENT_WINDOW = 0.15
UNKNOWN_PLACE_WINDOW = 0.3  # the window for places whose derivatives are not known yet
# A case whose forces are below this share of the largest force in any case cannot govern
MIN_FORCE_SHARE = 0.05
CASE_WINDOW = 1.0  # a case is left out if its logarithm of stress is this far below the largest
# All cases are reviewed when the logarithm of any dimension has changed by this
CASE_REVIEW_DISTANCE = 0.7
DIMENSION_TOLERANCE = 1e-9  # relative
# Meshes on rough contact cells; more would only resolve the pressure steps between these cells.
# Tuned on pin E of studies/landing_gear.toml: a third of the time, and the same weight.
ROUGH_MESHES = 4

Tell = Callable[[str], None]


@dataclass(frozen=True)
class SizingProblem:
    """The problem of sizing a pin of a study under constant loads.

    shape: the shape of the pin.
    requirement: requirements on the solution.
    loads: by case, for the cases in which a factor is required.
    required: the required factor.
    multiples: the multiple of the required factor that a case needs, by case; usually 1.
    """

    study: Study
    name: str
    shape: VariedShape
    requirement: Requirement
    loads: dict[str, CaseLoads]
    required: float
    multiples: dict[str, float]

    def demanded(self, case: str) -> float:
        """Return the factor that is needed in a case."""
        return self.required * self.multiples.get(case, 1.0)


@dataclass(frozen=True)
class SolvedPin:
    """A solved pin.

    values: (n,) dimensions, m.
    places: stresses, with derivatives by the logarithms of the dimensions.
    governs: the case with the largest ratio of stress to allowed stress.
    singular: the places of unbounded stress that must not govern, with their cases.
    """

    values: Floats
    peaks: tuple[Maximum, ...]
    places: tuple[StressPlace, ...]
    governs: str
    singular: tuple[CasePlace, ...] = ()

    @property
    def every(self) -> tuple[StressPlace, ...]:
        """All places that limit the search."""
        return (*self.places, *(place for _, place in self.singular))

    @property
    def worst(self) -> float:
        """The largest value of all places that limit the search."""
        return worst(self.every)

    @property
    def largest(self) -> float:
        """The largest value of the bounded places: the logarithm of stress over allowed stress."""
        return worst(self.places)


class PinStress:
    """The solver of a pin with changed dimensions.

    Flexibilities and meshes that designs share are computed once.
    in_contact: whether the pin is held by lugs; known after the first solution.
    watched: cases in which no singularity may govern; none at first.
    """

    def __init__(self, problem: SizingProblem, tell: Tell) -> None:
        self.problem, self._tell = problem, tell
        self._raw: dict[str, Any] = raw_study(problem.study)
        shape = problem.shape
        self._paths = [paths_of(shape.pin, d) for d in shape.dimensions]  # none of other pins
        self._known: set[str] = set()
        self._found: list[SolvedPin] = []
        self._verified: list[SolvedPin] = []
        self._finer: dict[str, float] = {}  # amount that finer cells add to the logarithm, by place
        self.in_contact = False
        self.watched: frozenset[str] = frozenset()
        self._singular = SingularPlaces(shape)
        self._memo = Memo()
        self._cases: tuple[str, ...] = ()  # that may govern near the dimensions `_about`
        self._about: Floats | None = None
        self.count = 0  # of designs

    def study_at(self, values: Floats) -> Study:
        """Return the study with changed dimensions and all values that depend on them.

        Raises: InputError.
        """
        old, name = self.problem.study, self.problem.name
        every = list(zip(self._paths, map(float, values), strict=True))
        new = study_with(old, self._raw, name, every)
        eyes = wider_eyes(old, new, name)
        wider = [((("lug", at, "outer_diameter"),), least) for at, least in eyes.items()]
        return study_with(old, self._raw, name, [*every, *wider]) if wider else new

    @property
    def solved(self) -> list[SolvedPin]:
        """All solved designs, as `at` returns them."""
        return [self._as_finer(x) for x in self._found]

    def at(self, values: Floats, far: float = np.inf) -> SolvedPin:
        """Solve a design, with derivatives at all places that may govern.

        far: if the worst logarithm of stress over allowed stress is farther from 0 than this, only
        the worst place gets derivatives.

        Raises: ImpossibleError, UndifferentiatedError.
        """
        if (known := _among(self._found, values)) is None:
            known = self._solved(self._possible(values), values, far, "rough")
            self._found.append(known)
        return self._as_finer(known)

    def verified(self, values: Floats) -> SolvedPin:
        """Solve a design on the cells of a run, and correct the rough stresses of all designs by
        the difference.

        Raises: as `at`.
        """
        rough = self.at(values)
        if not self.in_contact:
            return rough
        if (known := _among(self._verified, values)) is None:
            solution = self._solved(self._possible(values), None, 0.0, "usual")
            known = replace(solution, values=values)
            self._verified.append(known)
        before = {p.name: p.value for p in rough.places}
        for place in known.places:
            if place.name in before:
                added = place.value - before[place.name]
                self._finer[place.name] = self._finer.get(place.name, 0.0) + added
        return self._watched(known)

    def of(self, study: Study) -> SolvedPin:
        """Solve the pin in a study, without derivatives.

        Raises: ImpossibleError.
        """
        return self._watched(self._solved(study, None, 0.0, "usual"))

    def _watched(self, solution: SolvedPin) -> SolvedPin:
        return replace(
            solution, singular=tuple(x for x in solution.singular if x[0] in self.watched)
        )

    def _as_finer(self, solution: SolvedPin) -> SolvedPin:
        add = self._finer
        places = (replace(p, value=p.value + add.get(p.name, 0.0)) for p in solution.places)
        return self._watched(replace(solution, places=tuple(places)))

    def _possible(self, values: Floats) -> Study:
        """Return the study with changed dimensions.

        Raises: ImpossibleError for an impossible shape.
        """
        try:
            return self.study_at(values)
        except InputError as error:
            raise ImpossibleError(str(error)) from None

    def _solved(
        self, study: Study, values: Floats | None, far: float, cells: Literal["rough", "usual"]
    ) -> SolvedPin:
        self.count += 1
        self._tell(f"pin {self.problem.name}, design {self.count}")
        peaks: list[Maximum] = []
        stresses: list[tuple[RowPart, float]] = []
        singular: list[CasePlace] = []
        under: list[CasePlace] = []
        requirement = replace(self.problem.requirement, cells=cells)
        if cells == "rough" and self.in_contact:
            most = min(requirement.meshes or ROUGH_MESHES, ROUGH_MESHES)
            requirement = replace(requirement, meshes=most)
        try:
            for task in self._tasks(study, values):
                for peak, parts in self._of_task(study, task, requirement, values is not None):
                    peaks.append(peak)
                    allowed = self._allowed(task, peak)
                    stresses += [(part, allowed) for part in parts]
                    singular += self._singular.of(task.pin, peak, allowed, values)
                    below = self._singular.beneath(task.pin, peak, allowed, values)
                    under += [(peak.case, place) for place in below]
        except (InputError, ArgumentError, ArithmeticError, MemoryError) as error:
            raise ImpossibleError(str(error) or "out of memory") from None
        if not peaks:
            raise ImpossibleError("no case loads it")
        logs = [float(np.log(part.stress / allowed)) for part, allowed in stresses]
        top = max([*logs, *(place.value for _, place in under)])
        of_case = [(part.case, log) for (part, _), log in zip(stresses, logs, strict=True)]
        of_case += [(case, place.value) for case, place in under]
        self._cases = tuple(dict.fromkeys(case for case, log in of_case if log > top - CASE_WINDOW))
        places = [place for _, place in under]
        for (part, _), value in zip(stresses, logs, strict=True):
            window = GRADIENT_WINDOW if part.name in self._known else UNKNOWN_PLACE_WINDOW
            slope = None
            if values is not None and value >= top - (window if abs(top) < far else 0.0):
                slope = values * self._slope(part) + part.added_slopes
                self._known.add(part.name)
            places.append(StressPlace(part.name, value, slope, part.guess))
        at = np.zeros(0) if values is None else values
        governs = max(of_case, key=lambda one: one[1])[0]
        return SolvedPin(at, tuple(peaks), tuple(places), governs, tuple(singular))

    def _tasks(self, study: Study, values: Floats | None) -> list[Task]:
        """Return the tasks of the pin for the cases that may govern."""
        pins, loads = [pin_of(study, self.problem.name)], self.problem.loads
        if values is None:
            chosen = self._cases
        elif (
            self._about is None or np.abs(np.log(values / self._about)).max() > CASE_REVIEW_DISTANCE
        ):
            self._about, chosen = values, ()
        else:
            chosen = self._cases
        if not chosen:
            every = tasks(study, pins, loads)
            largest = {x.case: _size(task, x) for task in every for x in task.loads}
            least = MIN_FORCE_SHARE * max(largest.values(), default=0.0)
            chosen = tuple(case for case, size in largest.items() if size >= least)
        return tasks(study, pins, {case: loads[case] for case in chosen})

    def _slope(self, part: RowPart) -> Floats:
        try:
            return part.slopes()
        except ArithmeticError as error:
            raise ImpossibleError(str(error)) from None

    def _allowed(self, task: Task, peak: Maximum) -> float:
        """Return the allowed stress of a row, Pa."""
        strength = task.material.yield_strength
        assert strength is not None  # a pin without strength is refused before
        return strength / self.problem.demanded(peak.case)

    def _of_task(
        self, study: Study, task: Task, requirement: Requirement, differentiated: bool
    ) -> Iterator[tuple[Maximum, list[RowPart]]]:
        """Yield the maximum of each row with the stresses of its parts."""
        if differentiated and not task.pin.revolved:
            raise UndifferentiatedError
        dimensions = self._dimensions(study, task) if differentiated else ()
        section = PartsOfSection(dimensions)
        for solution in solutions(study, task, requirement, lambda _: None, self._memo):
            self.in_contact |= solution.rings is not None
            peak = solution.peak
            if why := why_unsolved(peak):
                raise ImpossibleError(why)
            if not peak.max_von_mises:
                continue
            if task.lugs:
                yield peak, parts_in_lugs(self.problem.study, study, task, solution, dimensions)
            elif differentiated:
                of = SizedRow(self.problem.shape, self.problem.requirement, task, solution)
                yield peak, of.parts(dimensions, section)
            else:
                yield peak, [RowPart(peak.case, peak.case, peak.upper_end, no_slopes)]

    def _dimensions(self, study: Study, task: Task) -> tuple[Dimension, ...]:
        by = {d.key: d for d in dimensions_of(study, task.pin)}
        try:
            return tuple(by[key] for key in self.problem.shape.keys)
        except KeyError:
            raise ImpossibleError("two of its dimensions have become equal") from None


def _among(designs: Sequence[SolvedPin], values: Floats) -> SolvedPin | None:
    """Return the design that was solved with these values; None if there is none."""
    same = (x for x in designs if np.allclose(x.values, values, rtol=DIMENSION_TOLERANCE, atol=0.0))
    return next(same, None)


def _size(task: Task, loads: PinLoads) -> float:
    """Return the largest force of a case, N; a moment counts as a couple of forces over the length
    of the pin.
    """
    arm = task.pin.length
    return float(max(np.abs(loads.forces).max(), np.abs(loads.moments).max(initial=0.0) / arm))

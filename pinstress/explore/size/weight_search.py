"""The search for the least weight of a pin: from scaling the whole pin to written dimensions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from pinbase.arrays import Floats
from pinstress.analysis.remedies.secant import FACTOR_TOLERANCE, MAX_SCALE_STEP
from pinstress.explore.size.optimise import (
    ACTIVE_TOLERANCE,
    ImpossibleError,
    Optimum,
    StressPlace,
    least_weight,
    optimality,
)
from pinstress.explore.size.pin_shape import DIMENSION_KINDS, MAX_DIMENSION_RATIO, Proportions
from pinstress.explore.size.pin_stress import PinStress, SizingProblem, SolvedPin
from pinstress.explore.size.standard_diameters import StandardDiameters
from pinstress.explore.size.written_dimensions import (
    LIMIT_ROUNDING_TOLERANCE,
    MAX_ROUNDING_STEPS,
    rounded_values,
)

STRESS_MARGIN = 0.004  # relative margin below the allowed stress for mesh noise and rounding
WEIGHT_CONVERGENCE = 2e-3  # relative tolerance of the weight, which meshes justify
SCALE_BRACKET_TOLERANCE = 5e-3  # a narrower bracket of logarithmic scales is not searched
# Distance from the factor, in its logarithm, within which its slope gives the scale that reaches it
SLOPE_RANGE = 0.06
# Accepted relative distance below the allowed stress, for a pin in contact
CONTACT_STRESS_TOLERANCE = 0.05
# STRESS_MARGIN and WEIGHT_CONVERGENCE in contact, where meshes and cells scatter
CONTACT_STRESS_MARGIN, CONTACT_WEIGHT_CONVERGENCE = 0.015, 1e-2
MAX_CORRECTIONS = 3  # largest number of corrections of the stresses on rough cells
MAX_SCALINGS = 10
MAX_REPAIRS = 4


@dataclass(frozen=True)
class WeightGoal:
    """The goal of a search for the least weight.

    required: the factor.
    vary: kinds of dimensions (DIMENSION_KINDS) that may change.
    limits: geometric limits.
    step: step to which diameters are rounded up, m; None for no step.
    multiples: as in SizingGoal.
    extra_multiples: further multiples of the factor, by pin and case, that the nominal design needs
    so that less likely designs reach the factor.
    """

    required: float
    vary: tuple[str, ...] = DIMENSION_KINDS
    limits: Proportions = field(default_factory=Proportions)
    step: float | None = None
    multiples: Mapping[tuple[str, str], float] = field(default_factory=dict)
    extra_multiples: Mapping[tuple[str, str], float] = field(default_factory=dict)

    @property
    def written(self) -> float | None:
        """The required factor to write into the new study; None if its requirements remain."""
        return None if self.multiples else self.required

    @property
    def standard(self) -> StandardDiameters | None:
        """The diameters that are multiples of the step, if there is one."""
        return None if self.step is None else StandardDiameters(self.step)

    def of_pin(self, pin: str) -> dict[str, float]:
        """Return the multiples of the factor that a pin needs, by case; 0 for no factor."""
        return {
            place[1]: self.multiples.get(place, 1.0) * self.extra_multiples.get(place, 1.0)
            for place in self.multiples.keys() | self.extra_multiples.keys()
            if place[0] == pin
        }


class WeightSearch:
    """The least weight of a pin as a WeightProblem of pinstress.explore.size.optimise."""

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
        """Return the places with a margin added to their stresses, so that the search aims slightly
        below the allowed stress.
        """
        aim = CONTACT_STRESS_MARGIN if self.stress.in_contact else STRESS_MARGIN
        return tuple(replace(p, value=p.value + aim) for p in solved.every)

    def least_weight(self, start: Floats) -> Optimum:
        """Find the least weight; start: logarithms of the dimensions."""
        return least_weight(
            self,
            start,
            CONTACT_WEIGHT_CONVERGENCE if self.stress.in_contact else WEIGHT_CONVERGENCE,
        )

    def volume(self, solved: SolvedPin) -> float:
        """Return the volume of a solved pin, m^3."""
        return float(self.shape.volume(solved.values)[0])

    def written(self, values: Floats) -> Floats:
        """Return dimensions, m, rounded as they are written."""
        length_unit = self.problem.study.system.factor("length")
        return rounded_values(self.shape, values, self.aim.step, length_unit)

    def keeps(self, values: Floats) -> bool:
        """Whether the geometric limits hold within the rounding of written digits."""
        return float(self.shape.at_limits(values)[0].min(initial=0.0)) >= -LIMIT_ROUNDING_TOLERANCE


def optimum_of(search: WeightSearch, near: SolvedPin) -> Optimum:
    """Find the optimum from a design near the factor.

    For a pin in contact the stresses on rough cells are corrected at the optimum, and the search is
    repeated from there until the stresses on the finer cells meet the factor closely.
    """
    if len(search.shape.dimensions) > 1 or not -ACTIVE_TOLERANCE <= near.worst <= 0.0:
        optimum = search.least_weight(np.log(near.values))
    else:
        x, places = np.log(near.values), near.every
        optimum = Optimum(x, search.weight(x)[0], places, optimality(search, x, places), 0)
    if search.stress.in_contact:
        for _ in range(MAX_CORRECTIONS):
            fine = search.stress.verified(search.written(np.exp(optimum.x)))
            if -CONTACT_STRESS_TOLERANCE <= fine.worst <= 0.0:
                break
            optimum = search.least_weight(optimum.x)
    return optimum


def scaled(search: WeightSearch, first: SolvedPin, roughly: bool) -> tuple[SolvedPin, Floats]:
    """Multiply all dimensions by one number until the factor is reached.

    Return the solved design nearest to the factor, and the dimensions that reach it. If only bores
    change, the pin is returned as given, because larger bores weaken it.
    roughly: whether the last step may be extrapolated by the slope of the stress.

    Raises: ImpossibleError.
    """
    now, values = first, search.shape.values
    best: SolvedPin | None = None
    small, why = None, ""  # small: the largest known scale (logarithm) with too much stress
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
        if top.slope.sum() > 0.0:  # only bores change, and larger ones weaken the pin
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


def written(search: WeightSearch, optimum: Optimum) -> SolvedPin:
    """Return the lightest design found that reaches the factor with written dimensions.

    Raises: ImpossibleError if there is none.
    """
    stress, step = search.stress, search.aim.step
    candidates = [x for x in [repaired(search, np.exp(optimum.x))] if x is not None]
    lighter = [x for x in stress.solved if x.worst <= 0.0 and search.keeps(x.values)]
    if lighter and step is None:
        best = min(lighter, key=search.volume)
        if not candidates or search.volume(best) < search.volume(candidates[0]):
            candidates += [x for x in [repaired(search, best.values)] if x is not None]
    if not candidates:
        raise ImpossibleError("the dimensions found, and slightly larger ones, miss the factor")
    return min(candidates, key=search.volume)


def repaired(search: WeightSearch, values: Floats) -> SolvedPin | None:
    """Return a design whose written dimensions reach the factor; the values are enlarged if
    necessary. None if no design is found.
    """
    step, growth = search.aim.step, 0.0
    for k in range(MAX_REPAIRS if step is None else MAX_ROUNDING_STEPS):
        solution = search.stress.verified(search.written(values * (1.0 + growth)))
        if solution.worst <= 0.0:
            return solution
        if step is None:  # enlarge by more than the excess needs if the stress were tension
            growth += 0.6 * solution.worst + 5e-4 * (k + 1)
        else:
            growth += 0.5 * step / float(values.min())
    return None

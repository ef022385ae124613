"""The smallest diameters at which a pin reaches a safety factor.

The lengths of a pin, which are set by the links, and its transverse proportions do not change. The
search starts from the growth law of the pin's section and is corrected by secants on quick
solutions. The result is then solved as in a run, at most MAX_FULL times.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from assess.judgement import FAILS, NOT_DECIDED
from fea.core.peak import Maximum, Verdict
from geometry import ArgumentError
from pinstress.analysis.plan import Plan
from pinstress.analysis.remedies.changes import FROM_FILE
from pinstress.analysis.remedies.secant import (
    FACTOR_TOLERANCE,
    MAX_SCALE,
    MAX_SCALE_STEP,
    MIN_SCALE,
    MIN_SCALE_RATIO,
    MIN_SLOPE,
    NoSizeError,
)
from pinstress.explore.size.counted import beneath
from pinstress.explore.size.judged_pin import JudgedPin, judged_pin
from pinstress.explore.size.pin_answers import PinAnswer, SizedStudy, row_stress
from pinstress.explore.size.scaled_study import unit_of_diameter
from pinstress.explore.size.section_law import (
    Accuracy,
    PinTrial,
    governing_place,
    needed_scale,
    slope,
)
from pinstress.explore.size.size_limits import SizeLimit, largest_scale, too_small
from pinstress.explore.size.standard_diameters import StandardDiameters
from pinstress.study.model.hardened import hardened_key, hardened_reason
from pinstress.study.model.pins import material as material_of
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study

MAX_QUICK, MAX_FULL = 6, 3  # largest numbers of quick and full solutions of a pin
MAX_FULL_OVER_RANGES = 6  # since only full solutions show what the stress is over ranges
# Relative excess over the required factor, with its error, that is accepted. For pins in contact
# with lugs, a full solution takes ten times as long as a quick one and differs from it by -3.3 to
# 2.3 % (pins of studies/landing_gear.toml, sized for 2 and 10). For other pins, half of the usual
# tolerance, since their error is often as large
CONTACT_FACTOR_TOLERANCE = 0.06
PLAIN_FACTOR_TOLERANCE = 0.5 * FACTOR_TOLERANCE
# The search aims at this share of the tolerance above the required factor, because a factor below
# it is not accepted. The second value is for quick solutions of pins in contact; it leaves room for
# their difference from full solutions on either side
AIM_SHARE, CONTACT_AIM_SHARE = 0.25, 0.5
QUICK_STEP = 0.03  # relative change of the scale that is not worth another quick solution
# Relative difference of the factor between quick and full solutions: twice that measured (above)
QUICK_ERROR = 0.07
NEXT_DIAMETER = 1e-6  # relative step beyond a standard diameter to reach the next one

Tell = Callable[[str], None]


@dataclass(frozen=True)
class SizingResult:
    """The size of a pin.

    scale: the scale at which the pin reaches the factor; None if it does not, for the reason `why`.
    before: its factor before sizing, by a rough solution. factor: its factor at the new size, in
    the governing case.
    verdict: the verdict of that case.
    limited: whether limits of the study prevent the factor from being reached.
    judged: the judgement of the pin in the full solution.
    others: scales of the other pins in that solution.
    trials, full: number of all solutions, and of full solutions among them.
    """

    pin: str
    scale: float | None = None
    before: float | None = None
    factor: float | None = None
    verdict: Verdict | None = None
    why: str = ""
    limited: bool = False
    judged: JudgedPin | None = None
    others: tuple[tuple[str, float], ...] = ()
    trials: int = 0
    full: int = 0


@dataclass(frozen=True)
class SizingGoal:
    """The goal of sizing: the required factor, and the permitted diameters (None for any).

    multiples: multiples of the factor that requirements of the study demand, by pin and case; 0 for
    no required factor. Empty if the factor applies to all.
    over_ranges: whether the factor must be reached over all ranges of the study, instead of as
    described.
    """

    required: float
    standard: StandardDiameters | None = None
    multiples: Mapping[tuple[str, str], float] = field(default_factory=dict)
    over_ranges: bool = False

    @property
    def written(self) -> float | None:
        """The required factor to write into the new study; None if its requirements remain."""
        return None if self.multiples else self.required

    def of_pin(self, pin: str) -> dict[str, float]:
        """Return the multiples of the factor that a pin needs, by case."""
        return {case: x for (name, case), x in self.multiples.items() if name == pin}


@dataclass
class _Search:
    """A search for the size of a pin, with its solutions so far."""

    sized: SizedStudy
    tell: Tell
    label: str
    answers: list[PinAnswer] = field(default_factory=list)

    @property
    def trials(self) -> list[PinTrial]:
        return [answer.trial for answer in self.answers]

    @property
    def full(self) -> list[PinAnswer]:
        return [answer for answer in self.answers if answer.solution is not None]

    def solve(self, scale: float, accuracy: Accuracy) -> PinAnswer:
        """Solve the pin at a scale."""
        said = f"{self.label}, trial {len(self.answers) + 1}"
        how = "full solution" if accuracy == "full" else f"{accuracy} solution"
        self.tell(f"{said} (pin {self.sized.pin}, {scale:.3f} times its diameters, {how})")

        def tell(doing: str) -> None:
            self.tell(f"{said}: {doing}")

        # Over ranges another case may count than as described.
        seen = self.answers if self.sized.over_ranges else self.answers[:1]
        counting = tuple(dict.fromkeys(case for x in seen for case in x.counting)) or None
        if accuracy == "full":
            answer = self.sized.full(scale, counting or (), tell)
        else:
            answer = self.sized.quick(scale, accuracy, counting, tell)
        self.answers.append(answer)
        return answer

    def whole(self, answer: PinAnswer) -> PinAnswer:
        """Also solve the cases of a full solution that do not count."""
        whole = self.sized.whole(answer, self.tell)
        self.answers = [whole if x is answer else x for x in self.answers]
        return whole


def size_pin(
    plan: Plan,
    pin: str,
    goal: SizingGoal,
    others: Mapping[str, float],
    label: str = "",
    tell: Tell = lambda _: None,
) -> SizingResult:
    """Size one pin for all cases of a plan.

    others: scales of the pins so far, by name; that of this pin is the start of its search.
    label: the start of progress messages, "pin 2 of 5".

    Failures are reported in the result.
    """
    multiples = goal.of_pin(pin)
    problem = why_fixed(plan.study, pin)
    if multiples and not any(multiples.values()):
        problem = "no factor is required of it"
    if problem:
        return SizingResult(pin, why=problem)
    sized = SizedStudy(
        plan, pin, goal.required, others, goal.standard,
        multiples=multiples, over_ranges=goal.over_ranges,
    )  # fmt: skip
    search = _Search(sized, tell, label or f"pin {pin}")
    result = SizingResult(pin)
    try:
        first = search.solve(others.get(pin, 1.0), "rough")
        result = replace(result, before=_nominal(plan.study, first.worst))
        result = _verified(search, _quickly(search), result)
    except NoSizeError as error:
        over = "; factors are the lowest over all ranges" * bool(goal.over_ranges and search.full)
        result = replace(result, why=f"{error}{over}{_beneath_note(search.answers)}")
    except (InputError, ArithmeticError, ArgumentError) as error:
        tried = ", ".join(f"{x.factor:.4g} at {x.scale:.3g}" for x in search.trials) or "none"
        why = f"a trial fails (factors by times its diameters: {tried}): {error}"
        result = replace(result, why=why)
    return replace(result, trials=len(search.answers), full=len(search.full))


def _factor_tolerance(sized: SizedStudy) -> float:
    return CONTACT_FACTOR_TOLERANCE if sized.in_lugs else PLAIN_FACTOR_TOLERANCE


def _aim(sized: SizedStudy, accuracy: Accuracy) -> float:
    """Return the factor at which the choice of the next scale aims.

    accuracy: of the solutions from which the scale is chosen.
    """
    if sized.standard is not None:  # a larger aim would skip a diameter that reaches the factor
        return sized.required * (1.0 + AIM_SHARE * PLAIN_FACTOR_TOLERANCE)
    contact = sized.in_lugs and accuracy == "quick"
    share = CONTACT_AIM_SHARE if contact else AIM_SHARE
    return sized.required * (1.0 + share * _factor_tolerance(sized))


def _quickly(search: _Search) -> float:
    """Return the scale that is needed by quick solutions.

    Raises: NoSizeError if no scale suffices.
    """
    sized = search.sized
    required, close = sized.required, _factor_tolerance(sized)
    start = search.trials[0]
    if sized.standard is None and required <= start.factor <= required * (1.0 + close):
        return start.scale  # the pin is close enough as given
    aim, limit = _aim(sized, "quick"), largest_scale(sized)
    if limit.scale < MIN_SCALE:
        raise NoSizeError(f"[size] {limit.reason} leaves no room for it")
    for _ in range(MAX_QUICK):
        last = search.trials[-1]
        scale = _next(search.trials, aim)
        if last.scale == limit.scale < scale:
            break
        near = abs(scale / last.scale - 1.0) <= QUICK_STEP
        if near and last.accuracy == "quick":
            break
        search.solve(min(scale, limit.scale), "quick")
    return _next(search.trials, aim)


def _next(trials: list[PinTrial], aim: float) -> float:
    """Return the scale of the next trial.

    Raises: NoSizeError if larger diameters hardly help, or if the scale is out of range.
    """
    last, where = trials[-1], governing_place(trials, aim)
    scale = min(needed_scale(trials, aim), MAX_SCALE_STEP * last.scale)
    enlarged = len(trials) > 1 and last.scale > MIN_SCALE_RATIO * trials[-2].scale
    if last.factor < aim and enlarged and slope(trials, where) < MIN_SLOPE:
        raise NoSizeError(
            f"with {last.scale:.3g} times its diameters its factor is {last.factor:.4g} and hardly "
            "grows with them: its bands must be longer, its material stronger or its loads smaller"
        )
    if not MIN_SCALE < scale < MAX_SCALE:
        raise NoSizeError(
            f"even with {last.scale:.3g} times its diameters its factor is {last.factor:.4g}"
        )
    return scale


def _verified(search: _Search, scale: float, result: SizingResult) -> SizingResult:
    """Return the smallest size at which a full solution reaches the factor.

    After a full solution that is not accepted, the scale is corrected by a secant, or to the next
    standard diameter.

    Raises: NoSizeError if none of the permitted full solutions reaches the factor.
    """
    sized, limit = search.sized, largest_scale(search.sized)
    required, aim = sized.required, _aim(sized, "full")
    for _ in range(_max_full(sized)):
        if scale > limit.scale:
            last = search.answers[-1]
            if last.trial.factor < required * (1.0 - QUICK_ERROR):
                return _limited(search, limit, result)
            scale = limit.scale
        answer = search.solve(scale, "full")
        if _accepted(answer, search):
            answer = search.whole(answer)
        if _accepted(answer, search):
            break
        factor = answer.trial.factor
        if factor < required and scale == limit.scale:
            return _limited(search, limit, result)
        known = [x.trial for x in search.full if (x.trial.factor >= required)]
        # Quick solutions have the stress as described only.
        alike = [x.trial for x in search.full] if sized.over_ranges else search.trials
        if sized.standard is not None:
            # Over ranges the first full solution may be many standard diameters too small.
            needed = _next(alike, aim) if sized.over_ranges else 0.0
            scale = max(_next_standard(sized, scale), needed)
        else:
            scale = _next(alike, aim)
            # Stay between the known scales where the scatter of errors would lead out of them.
            most = min((x.scale for x in known), default=math.inf)
            least = max((x.trial.scale for x in search.full if x.trial not in known), default=0.0)
            if not least < scale < most:
                if known:
                    break
                scale = least * (aim / factor)
    return _reached(search, result)


def _max_full(sized: SizedStudy) -> int:
    return MAX_FULL_OVER_RANGES if sized.over_ranges else MAX_FULL


def _accepted(answer: PinAnswer, search: _Search) -> bool:
    """Whether a full solution reaches the factor and, if any diameter is permitted, does not exceed
    it by much. For pins without contact the accepted excess grows with the number of full
    solutions.
    """
    sized = search.sized
    close = _factor_tolerance(sized) * (1 if sized.in_lugs else len(search.full))
    most = math.inf if sized.standard else sized.required * (1.0 + close)
    return sized.required <= answer.trial.factor <= most


def _reached(search: _Search, result: SizingResult) -> SizingResult:
    """Return the result of the smallest size that reached the factor.

    Raises: NoSizeError if none did.
    """
    sized = search.sized
    full = sorted(search.full, key=lambda answer: answer.trial.scale)
    wholes = (search.whole(x) for x in full if x.trial.factor >= sized.required)
    best = next((x for x in wholes if x.trial.factor >= sized.required), None)
    if best is None or best.solution is None:
        last = search.trials[-1]
        raise NoSizeError(
            f"the factor is not reached in {_max_full(sized)} full solutions: with "
            f"{last.scale:.4g} times its diameters it is {last.factor:.4g}"
        )
    judged = judged_pin(best.solution.results, sized.pin)
    if best.trial.scale < 1.0 and judged.outcome in (FAILS, NOT_DECIDED):
        raise NoSizeError(
            f"it is not made smaller, since with {best.trial.scale:.4g} times its diameters "
            f"{judged.why}"
        )
    others = tuple((name, x) for name, x in sized.others.items() if name != sized.pin)
    return replace(
        result,
        scale=best.trial.scale,
        factor=best.trial.factor,
        verdict=best.worst.verdict,
        judged=judged,
        others=others,
    )


def _limited(search: _Search, limit: SizeLimit, result: SizingResult) -> SizingResult:
    last = search.answers[-1]
    why = too_small(search.sized, limit, last.trial, last.worst)
    return replace(result, factor=last.trial.factor, why=why, limited=True)


def _next_standard(sized: SizedStudy, scale: float) -> float:
    """Return the scale at which the smallest diameter is the next standard one."""
    study = sized.plan.study
    least = min(study.table.pin[sized.pin].diameters)
    assert sized.standard is not None
    unit = unit_of_diameter(study, sized.pin, least)
    return sized.standard.up(scale * least, unit) * (1.0 + NEXT_DIAMETER) / least


def _beneath_note(answers: list[PinAnswer]) -> str:
    """Return a text that names the stress beneath contact, if the last factor is of that stress;
    else empty.
    """
    if not answers or beneath(answers[-1].worst) < row_stress(answers[-1].worst):
        return ""
    case = answers[-1].worst.case
    return f"; it is by what lies beneath the contact with its lugs in case {case}"


def _nominal(study: Study, peak: Maximum) -> float:
    material = material_of(study, study.table.pin[peak.pin].material)
    factor = peak.safety_factor(material.yield_strength)
    assert factor is not None  # a pin without strength is refused before
    return factor


def why_fixed(study: Study, pin: str) -> str:
    """Return why the diameters of a pin cannot be chosen; empty if they can."""
    table = study.table.pin[pin]
    if table.geometry is not None:
        return FROM_FILE
    if key := hardened_key(study, pin):
        return hardened_reason(key)
    if study.table.material[table.material].yield_strength is None:
        return f"its material {table.material} has no yield_strength"
    return ""

"""The smallest diameters of every pin that reach a factor of safety.

A pin keeps its lengths, which the links set, and its proportions across the axis. Every trial is a
study of its own, with the loads that follow from its weights, and solved as any other, so that a
run of it gives the same result.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from fea.core.peak import Maximum, Verdict
from geometry import ArgumentError
from pinstress.analysis.plan import Plan, all_loads
from pinstress.analysis.remedies.secant import NoSizeError, smallest
from pinstress.analysis.solve import solutions
from pinstress.explore.size.counted import beneath
from pinstress.explore.size.scaled_study import resized_study
from pinstress.study.model.pins import material as material_of
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.tasks import tasks
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study

MAX_SIZING_STEPS = 8  # of diameters rounded to steps, until the factor is reached

Tell = Callable[[str], None]


@dataclass(frozen=True)
class SizingResult:
    """The size of a pin.

    scale: scale at which it reaches the factor, None where it does not, for the reason `why`.
    before, factor: its factor in the first trial, and then, in the case that governs.
    verdict: verdict of that case.
    """

    pin: str
    scale: float | None
    before: float | None
    factor: float | None
    verdict: Verdict | None
    why: str = ""


@dataclass(frozen=True)
class SizingGoal:
    """The factor to reach, and the step to which diameters are rounded up, m, if any."""

    required: float
    step: float | None = None


def size_pin(
    plan: Plan,
    pin: str,
    wish: SizingGoal,
    others: Mapping[str, float],
    tell: Tell = lambda _: None,
) -> SizingResult:
    """Size one pin for all cases of a plan.

    others: scales of the pins so far, also of this one, from which its search begins.

    Failures are reported in the answer.
    """
    study = plan.study
    problem = _problem(study, pin)
    if problem:
        return SizingResult(pin, None, None, None, None, problem)
    peaks: dict[float, Maximum] = {}
    factors: dict[float, float] = {}

    def factor_at(scale: float, rounding: float | None = None) -> float:
        if rounding is None and scale in factors:
            return factors[scale]
        tell(f"pin {pin}, {scale:.3f} times its diameters")
        trial = resized_study(study, {**others, pin: scale}, rounding)
        peaks[scale] = governing(plan, trial, pin, tell)
        factors[scale] = _factor(study, peaks[scale])
        return factors[scale]

    before: float | None = None
    start = others.get(pin, 1.0)
    try:
        factor_at(start)
        before = _nominal(study, peaks[start])
        best = smallest(factor_at, wish.required, start)
        scale, factor = best.scale, best.factor
        if wish.step is not None:
            least = min(study.table.pin[pin].diameters)
            scale, factor = _stepped(factor_at, scale, wish.step, least, wish.required)
    except NoSizeError as error:
        return SizingResult(pin, None, before, None, None, str(error) + _where(peaks))
    except (InputError, ArithmeticError, ArgumentError) as error:
        tried = ", ".join(f"{factor:.4g} at {s:.3g}" for s, factor in factors.items()) or "none"
        why = f"a trial fails (factors by times its diameters: {tried}): {error}"
        return SizingResult(pin, None, before, None, None, why)
    return SizingResult(pin, scale, before, factor, peaks[scale].verdict)


def _where(peaks: Mapping[float, Maximum]) -> str:
    """Name the place of the factor where that is not the row's own number, for a pin that was
    solved.
    """
    if not peaks:
        return ""
    last = list(peaks.values())[-1]
    if beneath(last) < design_stress(last):
        return ""
    return f"; it is by what lies beneath the contact with its lugs in case {last.case}"


def _stepped(
    factor_at: Callable[[float, float | None], float],
    scale: float,
    step: float,
    diameter: float,
    required: float,
) -> tuple[float, float]:
    """Return a scale at which the factor is reached with diameters rounded up to a step, and the
    factor.
    """
    for _ in range(MAX_SIZING_STEPS):
        factor = factor_at(scale, step)
        if factor >= required:
            return scale, factor
        scale += step / diameter  # rounding changes proportions, so notches may be sharper
    raise NoSizeError(f"the factor is not reached within {MAX_SIZING_STEPS} steps of the diameter")


def governing(plan: Plan, study: Study, pin: str, tell: Tell = lambda _: None) -> Maximum:
    """Return the peak with the lowest factor, as it counts, of a pin of `study` in the plan's
    cases.

    Raises: InputError for a shape that cannot be, NoSizeError when the pin is not solved.
    """
    loads = all_loads(study, list(plan.loads))
    requirement = replace(plan.requirement, goal="value")
    peaks: list[Maximum] = []
    for task in tasks(study, [pin_of(study, pin)], loads):
        peaks += [solution.peak for solution in solutions(study, task, requirement, tell)]
    for peak in peaks:
        if peak.verdict == "rigid":
            raise NoSizeError(f"it is unconstrained in case {peak.case}: {peak.note}")
        if peak.verdict == "failed":
            raise NoSizeError(f"the numerical solution failed in case {peak.case}: {peak.note}")
    acting = [peak for peak in peaks if peak.max_von_mises]
    if not acting:
        raise NoSizeError("no case loads it")
    return max(acting, key=design_stress)


def design_stress(peak: Maximum) -> float:
    """Return the stress that decides, Pa: the larger of the maximum and that beneath contact, each
    with its error.

    A singular maximum decides nothing; it is replaced by that outside the excluded zones.
    """
    stress = peak.max_von_mises if peak.verdict == "singular" else peak.upper_end
    return max(stress or 0.0, beneath(peak))


def _factor(study: Study, peak: Maximum) -> float:
    """Return the factor of that stress."""
    return _nominal(study, peak) * (peak.max_von_mises or 0.0) / design_stress(peak)


def _nominal(study: Study, peak: Maximum) -> float:
    material = material_of(study, study.table.pin[peak.pin].material)
    factor = peak.safety_factor(material.yield_strength)
    assert factor is not None  # a pin without strength is refused before
    return factor


def _problem(study: Study, pin: str) -> str:
    table = study.table.pin[pin]
    if table.geometry is not None:
        return "its shape comes from a file, which has no diameters to change"
    if study.table.material[table.material].yield_strength is None:
        return f"its material {table.material} has no yield_strength"
    return ""

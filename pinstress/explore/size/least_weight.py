"""The least weight of all pins of a study that reach a factor of safety, under loads that follow
from the weights.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from assess.judgement import OUTCOME_ORDER, SAFE
from pinbase.processes.pool import Job, ProcessDied, Progress, in_parallel, preload
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.remedies.secant import FACTOR_TOLERANCE
from pinstress.analysis.results import run
from pinstress.explore.size.lightest_pin import Lightest, Start, WeightGoal, as_it_is, lightest_pin
from pinstress.explore.size.other_dimensions import written_study
from pinstress.explore.size.pin_shape import VariedShape
from pinstress.explore.size.scaled_study import resized_study
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import Study
from reports.data.decision import low_factor
from reports.data.results import Results

MAX_PASSES = 5
LEAST_WEIGHT_MODULES = ("fea.solve.solve", "assess.derivatives.places", "scipy.optimize")


@dataclass(frozen=True)
class LightStudy:
    """The new study, the result for every pin, and the new study's run.

    passes: number of times that all loads were updated.
    settled: whether the run has the factors of the last search.
    at: by pin and case, the factor at a probability, if requested.
    """

    study: Study
    pins: tuple[Lightest, ...]
    results: Results
    passes: int
    settled: bool
    at: Mapping[tuple[str, str], float] = field(default_factory=dict)


def lighten(
    study: Study,
    aim: WeightGoal,
    pins: list[str] | None = None,
    jobs: int = 1,
    progress: Progress = lambda _, __: None,
) -> LightStudy:
    """Find every pin's least weight.

    Weights of pins change the loads of others, so all are searched again from where they are, under
    the loads of the new study, until its run confirms them.

    Raises: InputError.
    """
    plan = prepare(study, pins=pins)
    names = list(dict.fromkeys(task.pin.name for task in plan.tasks))
    starts: dict[str, Start] = {}
    first: dict[str, float | None] = {}
    for count in range(1, MAX_PASSES + 1):
        lightest = _all(study, plan, names, aim, starts, jobs, progress)
        first = {pin.pin: pin.before for pin in lightest} | first
        starts = {x.pin: Start(x.values, x.scale, x.whole, x.decided) for x in lightest}
        new = _written(study, aim, lightest)
        progress("run of the new study", 0.9)
        results = run(new, pins=names, jobs=jobs)
        settled = all(_agrees(pin, results, aim) for pin in lightest)
        if settled or count == MAX_PASSES:
            break
        plan = replace(plan, loads=prepare(new, pins=pins).loads)
    lightest_pins = tuple(replace(pin, before=first[pin.pin]) for pin in lightest)
    if worse := _worse(study, aim, lightest_pins, results, jobs):
        lightest_pins = tuple(
            as_it_is(study, aim, pin, worse[pin.pin]) if pin.pin in worse else pin
            for pin in lightest_pins
        )
        new = _written(study, aim, list(lightest_pins))
        results = run(new, pins=names, jobs=jobs)
    return LightStudy(new, lightest_pins, results, count, settled)


def _worse(
    study: Study, aim: WeightGoal, pins: tuple[Lightest, ...], results: Results, jobs: int
) -> dict[str, str]:
    """Explain by pin why its result is decided worse than the pin as it is.

    A row that is safe is better than one that is not decided, and this better than one that fails.
    Pins are compared as described: one that just reaches a factor does not over a range of its
    joint.
    """
    changed = {x.pin for x in pins if not x.kept and (x.values or x.scale is not None)}
    doubtful = {
        p.pin for p in results.pins if OUTCOME_ORDER[p.as_described] < OUTCOME_ORDER[SAFE]
    } & changed
    if not doubtful:
        return {}
    start = run(_written(study, aim, []), pins=sorted(doubtful), jobs=jobs)
    before = {(p.pin, p.case): p.as_described for p in start.pins}
    out: dict[str, str] = {}
    for p in results.pins:
        was, now = before.get((p.pin, p.case)), p.as_described
        if p.pin in doubtful and was is not None and OUTCOME_ORDER[now] < OUTCOME_ORDER[was]:
            out[p.pin] = f"the lightest pin that was found is {now} in {p.case}, this one {was}"
    return out


def _all(
    study: Study,
    plan: Plan,
    names: list[str],
    aim: WeightGoal,
    starts: Mapping[str, Start],
    jobs: int,
    progress: Progress,
) -> list[Lightest]:
    if jobs > 1:
        preload(*LEAST_WEIGHT_MODULES)
    heavy = sorted(names, key=lambda n: -len(study.table.pin[n].profile or ()))  # the longest first
    work = [
        Job(f"pin {n}", partial(lightest_pin, study, plan, n, aim, starts.get(n))) for n in heavy
    ]
    results = in_parallel(work, jobs, lambda message, part: progress(message, 0.9 * part))
    by_name = dict(zip(heavy, results, strict=True))
    return [
        Lightest(name, why=one.reason) if isinstance(one := by_name[name], ProcessDied) else one
        for name in names
    ]


def _written(study: Study, aim: WeightGoal, pins: list[Lightest]) -> Study:
    pins = [pin for pin in pins if not pin.kept]
    scales = {pin.pin: pin.scale for pin in pins if pin.scale is not None}
    scaled = resized_study(study, scales, aim.standard, aim.written)
    values = {pin.pin: pin.values for pin in pins if pin.values is not None}
    shapes = {}
    for name in values:
        shape = VariedShape(study, pin_of(study, name), aim.vary, aim.limits)
        shapes[name] = (shape.pin, shape.dimensions)
    return written_study(scaled, shapes, values, aim.step, aim.written)


def _agrees(pin: Lightest, results: Results, aim: WeightGoal) -> bool:
    """Return whether the run has the factor that was found for a pin, with little excess."""
    more = aim.of_pin(pin.pin)
    rows = [p for p in results.pins if p.pin == pin.pin]
    if any(p.verdict == "unconverged" and p.decided for p in rows):
        return all(p.decided is not False for p in rows)  # it ended where that was decided
    low = [
        f / times
        for p in rows
        if (f := low_factor(p)) is not None and (times := more.get(p.case, 1.0))
    ]
    if pin.factor is None or not low:
        return True
    return aim.required <= min(low) * (1.0 + 1e-9) <= pin.factor * (1.0 + FACTOR_TOLERANCE)

"""The least weight at which all pins of a study reach a safety factor; the loads follow from the
weights.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from assess.judgement import OUTCOME_ORDER, SAFE
from pinbase.processes.pool import Job, ProcessDied, Progress, in_parallel, preload
from pinstress.analysis.cache import user_cache
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.remedies.secant import FACTOR_TOLERANCE
from pinstress.analysis.results import solve
from pinstress.explore.size.lightest_pin import Lightest, as_it_is, lightest_pin
from pinstress.explore.size.other_dimensions import written_study
from pinstress.explore.size.pin_shape import VariedShape
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.search_log import SearchLog
from pinstress.explore.size.size_pins import changes_of_load
from pinstress.explore.size.weight_search import STRESS_MARGIN, WeightGoal
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import Study
from reports.data.decision import low_factor
from reports.data.results import Results

MAX_PASSES = 5
LEAST_WEIGHT_MODULES = ("fea.solve.solve", "assess.derivatives.places", "scipy.optimize")


@dataclass(frozen=True)
class LightStudy:
    """The new study, the result for every pin, and the results of the new study's run.

    passes: largest number of searches of any pin.
    settled: whether the run confirms all pins.
    at: the factor at a given probability, by pin and case, if requested.
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
    log: SearchLog | None = None,
) -> LightStudy:
    """Find every pin's least weight.

    The weight of a pin changes the loads of other pins, and a run has finer contact cells than a
    search. A pin is therefore searched again from its last design, under the loads of the new
    study, until a run of the new study confirms it. If the run finds a smaller factor, the next
    search aims at a correspondingly larger one.

    log: the finished searches, which are not repeated.

    Raises: InputError.
    """
    log = SearchLog() if log is None else log
    plan = prepare(study, pins=pins)
    names = list(dict.fromkeys(task.pin.name for task in plan.tasks))
    lightest: dict[str, Lightest] = {}
    searched: dict[str, dict[str, CaseLoads]] = {}
    raised = dict.fromkeys(names, 1.0)
    todo, passes = names, 0
    for _ in range(MAX_PASSES):
        passes += 1
        goal = _raised(aim, raised, plan.loads)
        for pin in _all(study, plan, todo, goal, lightest, jobs, progress, log):
            known = lightest.get(pin.pin, pin)
            lightest[pin.pin] = replace(pin, before=known.before)
            searched[pin.pin] = plan.loads
        new = _written(study, aim, list(lightest.values()))
        progress("run of the new study", 0.9)
        results, loads = _run(new, names, jobs)
        changes = {name: changes_of_load(new, name, searched[name], loads) for name in names}
        times = {
            name: _unconfirmed(pin, results, aim, raised[name], changes[name].values())
            for name, pin in lightest.items()
        }
        raised = {name: raised[name] * (times[name] or 1.0) for name in names}
        todo = [name for name in names if times[name] is not None]
        if not todo:
            break
        plan = replace(plan, loads=loads)
    final = tuple(lightest[name] for name in names)
    if worse := _worse(study, aim, final, results, jobs):
        final = tuple(
            as_it_is(study, aim, pin, worse[pin.pin]) if pin.pin in worse else pin for pin in final
        )
        new = _written(study, aim, list(final))
        results, _ = _run(new, names, jobs)
    return LightStudy(new, final, results, passes, not todo)


def _run(study: Study, pins: list[str], jobs: int) -> tuple[Results, dict[str, CaseLoads]]:
    """Run pins for their factors, without results that only explain the rows. Return the results
    and the loads. Unchanged pins under the same loads come from the user's cache.
    """
    plan = prepare(study, pins=pins)
    requirement = replace(plan.requirement, goal="value")
    plan = replace(plan, requirement=requirement, explained=False)
    return solve(plan, jobs=jobs, cache=user_cache()), plan.loads


def _raised(aim: WeightGoal, raised: Mapping[str, float], cases: Iterable[str]) -> WeightGoal:
    """Return the goal with the factors of each pin multiplied; raised: the multiple, by pin."""
    places = [(pin, case) for pin, times in raised.items() if times != 1.0 for case in cases]
    changed = {place: raised[place[0]] * aim.extra_multiples.get(place, 1.0) for place in places}
    return replace(aim, extra_multiples={**aim.extra_multiples, **changed})


def _unconfirmed(
    pin: Lightest, results: Results, aim: WeightGoal, raised: float, changes: Collection[float]
) -> float | None:
    """Return the ratio of the factor of a pin's next search to that of the last one; None if the
    run confirms the pin.

    raised: multiple of the required factor in the last search. changes: of the loads since then,
    one for each case.
    """
    multiples = aim.of_pin(pin.pin)
    rows = [p for p in results.pins if p.pin == pin.pin]
    ended = any(p.verdict == "unconverged" and p.decided and not p.minor for p in rows)
    if ended and all(p.decided is not False for p in rows):
        return None  # the row was solved only until it was decided
    low = [
        f / times
        for p in rows
        if (f := low_factor(p)) is not None and (times := multiples.get(p.case, 1.0))
    ]
    if pin.factor is None or not low:
        return None
    factor = min(low) * (1.0 + 1e-9)
    if factor < aim.required:
        return aim.required / factor * (1.0 + STRESS_MARGIN)
    # Under the same loads another search would end at the same design.
    moved = max(changes, default=0.0) > FACTOR_TOLERANCE
    return 1.0 if moved and factor > raised * pin.factor * (1.0 + FACTOR_TOLERANCE) else None


def _worse(
    study: Study, aim: WeightGoal, pins: tuple[Lightest, ...], results: Results, jobs: int
) -> dict[str, str]:
    """Return, for each pin whose outcome is worse than that of the pin as given, an explanation.

    A safe row is better than one that is not decided, which is better than one that fails. Pins are
    compared as described, because a pin that just reaches its factor does not reach it over the
    range of its joint.
    """
    changed = {x.pin for x in pins if not x.kept and (x.values or x.scale is not None)}
    doubtful = {
        p.pin for p in results.pins if OUTCOME_ORDER[p.as_described] < OUTCOME_ORDER[SAFE]
    } & changed
    if not doubtful:
        return {}
    start, _ = _run(_written(study, aim, []), sorted(doubtful), jobs)
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
    before: Mapping[str, Lightest],
    jobs: int,
    progress: Progress,
    log: SearchLog,
) -> list[Lightest]:
    log.begin()
    if jobs > 1:
        preload(*LEAST_WEIGHT_MODULES)

    heavy = sorted(names, key=lambda n: -len(study.table.pin[n].profile or ()))  # the longest first
    todo = [n for n in heavy if log.get(n) is None]
    work = [
        Job(f"pin {n}", partial(lightest_pin, study, plan, n, aim, before.get(n))) for n in todo
    ]
    died: dict[str, Lightest] = {}

    def done(number: int, one: Lightest | ProcessDied) -> None:
        if isinstance(one, ProcessDied):
            died[todo[number]] = Lightest(todo[number], why=one.reason)
        else:
            log.add(one)

    in_parallel(work, jobs, lambda message, part: progress(message, 0.9 * part), done=done)
    return [log.get(name) or died[name] for name in names]


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

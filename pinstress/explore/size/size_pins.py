"""Sizing of all pins of a study, repeated until the sizes no longer change each other's loads."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from pinbase.processes.pool import Job, ProcessDied, Progress, in_parallel
from pinstress.analysis.plan import Plan, all_loads
from pinstress.analysis.reused_loads import content_of_loads
from pinstress.analysis.solve import effort
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.size_pin import SizingGoal, SizingResult, size_pin
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import Study, raw_study

if TYPE_CHECKING:
    from pinstress.explore.sweep.cluster import Cluster

MAX_SIZING_PASSES = 4

Finished = Callable[[SizingResult], None]


def size_pins(
    plan: Plan,
    goal: SizingGoal,
    before: Sequence[SizingResult],
    finished: Finished,
    jobs: int,
    progress: Progress,
    cluster: Cluster | None = None,
) -> list[SizingResult]:
    """Size the pins of a plan.

    The weight of a pin changes the loads of other pins. A pin is therefore sized again if the loads
    in the new study could take it below the factor. The weights of links do not change.

    before: pins that were sized earlier.
    finished: called with every pin as soon as it is sized.
    jobs: number of pins sized in parallel on this machine. cluster: sizes the pins instead.

    Raises: InputError if the connection to the cluster is lost.
    """
    names = list(dict.fromkeys(task.pin.name for task in plan.tasks))
    order = sorted(names, key=lambda name: _effort(plan, name), reverse=True)  # the longest first
    sized = {result.pin: result for result in before if result.pin in names}
    todo = [name for name in order if name not in sized]
    for _ in range(MAX_SIZING_PASSES):
        _size(plan, goal, order, todo, sized, finished, jobs, progress, cluster)
        todo = loaded_more(plan, goal, list(sized.values()))
        if not todo:
            break
    for name in todo:
        why = "the loads still change with the sizes of other pins: size the new study again"
        sized[name] = replace(sized[name], judged=None, scale=None, why=why)
    return [sized[name] for name in names]


def _effort(plan: Plan, name: str) -> tuple[bool, int, int, int]:
    return max(effort(plan, task) for task in plan.tasks if task.pin.name == name)


def new_study(study: Study, goal: SizingGoal, sized: Sequence[SizingResult]) -> Study:
    """Return the study with the new sizes of pins."""
    scales = {result.pin: result.scale for result in sized if result.scale is not None}
    return resized_study(study, scales, goal.standard, goal.written)


def _size(
    plan: Plan,
    goal: SizingGoal,
    names: list[str],
    todo: list[str],
    sized: dict[str, SizingResult],
    finished: Finished,
    jobs: int,
    progress: Progress,
    cluster: Cluster | None,
) -> None:
    scales = {x.pin: x.scale for x in sized.values() if x.scale is not None}

    def done(number: int, outcome: SizingResult | ProcessDied) -> None:
        name = todo[number]
        if isinstance(outcome, ProcessDied):
            outcome = SizingResult(name, why=outcome.reason)
        first = sized.get(name)
        sized[name] = outcome if first is None else replace(outcome, before=first.before)
        finished(sized[name])

    if cluster is not None:
        from pinstress.explore.size.on_cluster import ClusterSizing, size_on

        size_on(cluster, ClusterSizing.of(plan, goal), todo, scales, done, progress)
        return
    work = [
        Job(f"pin {name}", partial(size_pin, plan, name, goal, scales, _label(names, name)))
        for name in todo
    ]
    in_parallel(work, jobs, progress, done=done)


def _label(names: list[str], name: str) -> str:
    return f"pin {names.index(name) + 1} of {len(names)}"


def loaded_more(plan: Plan, goal: SizingGoal, sized: Sequence[SizingResult]) -> list[str]:
    """Return the pins whose loads in the new study could take them below the factor.

    The stress is assumed to grow at most by the ratio of the largest change of a force at any
    instant to the largest force.
    """
    new, cases = new_study(plan.study, goal, sized), list(plan.loads)
    content = content_of_loads(new, raw_study(new))
    after: dict[str, CaseLoads] | None = None
    out = []
    for result in sized:
        if result.scale is None or result.judged is None:
            continue
        solved = resized_study(
            plan.study,
            {**dict(result.others), result.pin: result.scale},
            goal.standard,
            goal.written,
        )
        if content_of_loads(solved, raw_study(solved)) == content:
            continue
        after = after or all_loads(new, cases)
        multiples = goal.of_pin(result.pin)
        change = changes_of_load(new, result.pin, all_loads(solved, cases), after)
        growth = dict(result.judged.growth) if goal.over_ranges else {}
        if any(
            factor / (growth.get(case, 1.0) * (1.0 + change.get(case, 0.0)))
            < goal.required * multiples.get(case, 1.0)
            for case, factor in result.judged.cases
        ):
            out.append(result.pin)
    return out


def changes_of_load(
    study: Study, pin: str, before: Mapping[str, CaseLoads], after: Mapping[str, CaseLoads]
) -> dict[str, float]:
    """Return the largest change of a force on a pin relative to its largest force, by case."""
    out = {}
    for case, loads in after.items():
        named = [c for c in pin_of(study, pin).connections if c in loads.reactions.connections]
        if not named:
            continue
        old, new = (
            np.stack([x[case].reactions.in_pin_axes(c) for c in named], axis=1)
            for x in (before, after)
        )
        largest = float(np.linalg.norm(old, axis=-1).max())
        if old.shape == new.shape:
            change = float(np.linalg.norm(new - old, axis=-1).max())
        else:  # the motion is resolved at other instants
            change = abs(float(np.linalg.norm(new, axis=-1).max()) - largest)
        out[case] = change / largest if largest else float(change > 0.0)
    return out

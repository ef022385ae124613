"""From a study to its results: loads, then every pin by the model, then what reports need."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from pinstress import gather
from pinstress.plan import Plan, all_loads, prepare, select
from pinstress.published import read_published
from pinstress.solving import Solved, solve_tasks
from pinstress.study import Study
from reports.results import Results

__all__ = ["Plan", "all_loads", "loads_only", "prepare", "results_of", "run", "select", "solve"]


def results_of(plan: Plan, found: list[Solved]) -> Results:
    """A plan's results from what was found of its tasks."""
    study = plan.study
    pins, cases = list(study.table.pin), list(plan.loads)
    rows = [
        (task, peak) for task, made in zip(plan.tasks, found, strict=True) for peak in made.peaks
    ]
    rows.sort(key=lambda row: (pins.index(row[1].pin), cases.index(row[1].case)))
    beam = next((made.beam for made in found if made.beam is not None), None)
    results = gather.results(study, plan.loads, rows, beam, plan.published, plan.asked.tolerance)
    return replace(
        results,
        landing=tuple(r for made in found for r in made.landing),
        surfaces=tuple(made.surface for made in found if made.surface is not None),
    )


def solve(plan: Plan, jobs: int = 1) -> Results:
    """Solve every pin of a plan; jobs, and what becomes of those that fail: as in solve_tasks."""
    return results_of(plan, solve_tasks(plan, jobs=jobs))


def loads_only(study: Study, cases: Iterable[str] | None = None) -> Results:
    """The mechanics of a study without stresses. Raises: InputError for bad input."""
    published = read_published(study)
    loads = all_loads(study, select(study.table.case, cases, "case"))
    return gather.results(study, loads, [], None, published, study.table.analysis.tolerance)


def run(study: Study, *, jobs: int = 1, **chosen: Any) -> Results:
    """Analyse a study; `chosen` is what `prepare` takes, jobs: as in solve_tasks.

    Raises: InputError for bad input.
    """
    return solve(prepare(study, **chosen), jobs)

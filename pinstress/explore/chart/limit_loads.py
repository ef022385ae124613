"""The ladder of models of a limit load in a chart: hinges of the beam, elastic-plastic solid."""

from __future__ import annotations

from collections.abc import Callable

from fea.support.support import Solution
from geometry import Pin
from pinstress.analysis.assessed.limits import limit_asked, limit_rung
from pinstress.explore.chart.measured_process import Measure, Measured, MeasureJob
from pinstress.explore.chart.single_limit import LIMIT_RUNGS, LimitProblem, LimitRung
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from reports.data.chart import ChartPoint

LIMIT_LOAD_ELEMENT_NAMES = {"hinges": "Timoshenko beam", "elastic-plastic": "hexahedra, {} meshes"}


def limit_problem(study: Study, task: Task, found: Solution) -> LimitProblem | None:
    """None where a run computes no limit load."""
    peak = found.peak
    rung = limit_rung(study, task.pin.name)
    pin, loads = task.pin, peak.governing
    if rung is None or loads is None or not limit_asked(peak, task, rung):
        return None
    if task.lugs:
        if found.rings is None:
            return None
        pin, loads = found.rings, found.pressed(loads)
    if not isinstance(pin, Pin):
        return None
    return LimitProblem(pin, task.material, tuple(map(pin.surface, task.clamps)), loads)


def limit_points(
    problem: LimitProblem, measure: Measure, runs: int, tell: Callable[[str], None]
) -> tuple[ChartPoint, ...]:
    """All models, the cheapest first; the first that a run would end on is marked."""
    found = []
    for rung in LIMIT_RUNGS:
        tell(f"limit load, {rung.model}")
        found.append((rung, measure(MeasureJob(problem, rung, runs=runs))))
    ends = next((rung for rung, m in found if m.limit and m.limit.ends), LIMIT_RUNGS[-1])
    return tuple(_point(rung, measured, rung == ends) for rung, measured in found)


def _point(rung: LimitRung, measured: Measured, ends: bool) -> ChartPoint:
    name, limit = LIMIT_LOAD_ELEMENT_NAMES[rung.model].format(rung.meshes), measured.limit
    if limit is None:
        return ChartPoint(rung.model, name, failed=measured.failed)
    return ChartPoint(
        rung.model,
        name,
        limit.unknowns,
        measured.seconds,
        measured.memory,
        error=limit.error,
        chosen=ends,
        bracket=(limit.lower, limit.upper),
    )

"""Beam, harmonic and solid model for three different pins: the cost of an error of 1 %."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from benchmarks import ROOT
from benchmarks.timing import table
from fea.solve.single_mesh import ModelMesh
from pinstress import load_study
from pinstress.explore.chart.chart import ELEMENT_NAMES, ChartPlan, chart, plan_chart
from pinstress.explore.chart.measured_process import Measured, MeasureJob, MeasureLimits, measure
from pinstress.explore.chart.mesh_sequences import FIRST_SOLID_LEVEL
from reports.data.chart import Chart, ChartPoint, error
from reports.format.numbers import engineering, percent, seconds
from reports.plots.chart import chart_plot
from reports.plots.draw import draw
from reports.text.chart_summary import cost

PINS = (
    ("one_pin.toml", "B", "landing"),
    ("charted/hollow.toml", "P", "pulled"),
    ("charted/floating.toml", "P", "pressed"),
)
DRAWN = 1
TOLERANCE, MESHES, RUNS = 0.01, 4, 5
NEAR = 4.0  # errors within this factor of the tolerance are near it
LIMITS = MeasureLimits(seconds=300.0, memory=8000.0)
LARGEST = 140_000  # unknowns; no finer mesh of the solid is tried beyond this


def models() -> str:
    """Return the table; draw the chart of the second pin in docs/images."""
    rows = []
    for k, (study, pin, case) in enumerate(PINS):
        plan = plan_chart(load_study(ROOT / "studies" / study), pin, case, TOLERANCE)
        jobs: dict[int, MeasureJob] = {}
        found = chart(plan, partial(_noted, jobs, k == DRAWN), MESHES, RUNS)
        if k == DRAWN:
            draw([chart_plot(found)], ROOT / "docs" / "images")
        further = _further(plan, found)
        rows.append((f"`{study}`", *_row(_once_more(found, jobs), further)))
    head = ("study", "beam", "its error", "harmonic", "solid", "solid / harmonic", "memory")
    return (
        f"Time (and memory above the bare process) for an error of {percent(TOLERANCE)}, "
        "interpolated between meshes: medians of five runs, of one run for solid models without a "
        f"chart. Solid elements are the curved ones, for `{PINS[DRAWN][0]}` (in the chart) the "
        f"fastest kind. Where a model does not reach {percent(TOLERANCE)}, the table has the time "
        "and the error of its finest mesh:\n\n" + table(head, rows)
    )


def _measured(job: MeasureJob) -> Measured:
    """Return the median of a few runs; a solid, which takes seconds, is run once."""
    return measure(replace(job, runs=1) if job.rung.model == "solid" else job, LIMITS)


def _noted(jobs: dict[int, MeasureJob], drawn: bool, job: MeasureJob) -> Measured:
    """Return the measurement of a mesh; a charted harmonic mesh is added to the jobs by its
    unknowns.

    drawn: whether the pin's chart is drawn; then all meshes are measured as often as the chart
    states.
    """
    rung = job.rung
    if rung.model == "solid" and rung.element != "curved" and not drawn:
        return Measured(None, failed="not measured", over=True)
    found = measure(job, LIMITS) if drawn else _measured(job)
    if rung.model == "harmonic" and not job.reference and found.result:
        jobs[found.result.unknowns] = job
    return found


def _once_more(found: Chart, jobs: dict[int, MeasureJob]) -> Chart:
    """Return the chart with the mean of two measurements of the harmonic meshes near the tolerance.

    They are measured again after the solids, which take minutes, since other work on the machine
    varies.
    """
    points = [
        replace(p, seconds=((p.seconds or 0.0) + _measured(jobs[p.dofs]).seconds) / 2.0)
        if p.model == "harmonic"
        and p.dofs in jobs
        and TOLERANCE / NEAR < error(p) < TOLERANCE * NEAR
        else p
        for p in found.points
    ]
    return replace(found, points=tuple(points))


def _further(plan: ChartPlan, found: Chart) -> list[ChartPoint]:
    """Return curved solid elements on finer meshes than those of the chart, each measured once,
    until they reach the error or become too large.
    """
    stress, level = plan.study.system.factor("stress"), FIRST_SOLID_LEVEL["curved"] + MESHES
    points = [p for p in found.points if p.element == ELEMENT_NAMES["curved"] and not p.failed]
    more: list[ChartPoint] = []
    while error((points + more)[-1]) > TOLERANCE and ((points + more)[-1].dofs or 0) < LARGEST:
        made = _measured(MeasureJob(plan.problem, ModelMesh("solid", "curved", level)))
        if made.result is None:
            break
        value = made.result.maximum / stress
        off = abs(value / found.reference.max_von_mises - 1.0)
        more.append(
            replace(
                points[-1], dofs=made.result.unknowns, seconds=made.seconds, memory=made.memory,
                max_von_mises=value, error=off, chosen=False,
            )
        )  # fmt: skip
        level += 1
    return more


def _row(found: Chart, further: list[ChartPoint]) -> tuple[str, ...]:
    curves = found.curves
    curves["solid", ELEMENT_NAMES["curved"]] += further
    beam = next((c[0] for (model, _), c in curves.items() if model == "beam"), None)
    (plane,) = (c for (model, _), c in curves.items() if model == "harmonic")
    solids = [c for (model, _), c in curves.items() if model == "solid"]
    told: tuple[str, ...] = (
        ("-", "-") if beam is None else (seconds(beam.seconds), percent(error(beam)))
    )
    ours = cost(plane, TOLERANCE)
    if ours is None:
        return *told, "not reached", "-", "-", "-"
    reached = [c for curve in solids if (c := cost(curve, TOLERANCE))]
    if reached:
        body = min(reached, key=lambda c: c.seconds)
        told += (seconds(ours.seconds), seconds(body.seconds))
        spent, memory, more = body.seconds, body.memory, ""
    else:
        best = min((curve[-1] for curve in solids), key=error)
        spent, memory, more = best.seconds or 0.0, best.memory or 0.0, "more than "
        told += (seconds(ours.seconds), f"{seconds(spent)}, {percent(error(best))} off")
    ratios = (spent / ours.seconds, memory / ours.memory)
    return *told, *(f"{more}{engineering(r, 2)}" for r in ratios)

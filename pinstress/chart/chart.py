"""The speed-accuracy chart of one pin: every model on a ladder of meshes compared with a
reference.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace

from fea.core.peak import Peak
from fea.single_mesh import Problem, Rung
from fea.solve_pin import Asked, Solution, solve_pin
from fea.verdict import Seen
from geometry import Pin
from geometry.mesh.elements import Element
from pinstress.analysis.plan import all_loads
from pinstress.chart.measured_process import Measure, Measured
from pinstress.chart.mesh_sequences import (
    HARMONIC,
    USUAL,
    Climb,
    chosen,
    climb_harmonic,
    climb_solid,
    harmonic_reference,
    solid_reference,
)
from pinstress.model.pins import pin as pin_of
from pinstress.model.tasks import tasks
from pinstress.processes.pool import Progress
from pinstress.study.choices import require_tolerance, select
from pinstress.study.file import Study
from reports.data.chart import Chart, ChartPoint, Reference

NAMES = {
    "beam": "Timoshenko beam",
    "harmonic": "quadratic triangles",
    "linear": "linear tetrahedra",
    "straight": "straight quadratic tetrahedra",
    "curved": "curved quadratic tetrahedra",
}


@dataclass(frozen=True)
class ChartPlan:
    """What is to be charted, every input read and found usable. peak: what `auto` says of it on
    its first mesh. beam_error: relative, of the beam by itself.
    """

    study: Study
    problem: Problem
    asked: Asked
    peak: Peak
    beam_error: float | None


def plan_chart(study: Study, pin: str, case: str, tolerance: float | None = None) -> ChartPlan:
    """Raises: InputError for bad input, an unconstrained pin, or one without any stress."""
    select(study.table.pin, [pin], "pin", "pin")
    loads = all_loads(study, select(study.table.case, [case], "case", "case"))
    (task,) = tasks(study, [pin_of(study, pin)], loads)
    table = study.table.analysis
    asked = Asked(
        require_tolerance(tolerance) or table.tolerance,
        goal=table.goal,
        required=table.required_safety_factor,
        distance=table.excluded_distance,
    )
    clamps = tuple(task.pin.surface(c) for c in task.clamps)

    def first(model: Asked) -> Solution:
        found = solve_pin(
            task.pin, task.material, task.clamps, task.loads, model, between=task.between
        )
        return found[0]

    solution = first(replace(asked, meshes=1))
    peak = solution.peak
    problem = Problem(task.pin, task.material, clamps, solution.loads, asked.distance)
    if not peak.max_von_mises:
        why = peak.note if peak.verdict == "rigid" else "its loads cause no stress"
        text = f"pin {pin}, case {case}: there is nothing to chart: {why}"
        raise study.error(text, at=f"pin.{pin}", code="nothing-to-chart")
    beam_error = None
    if isinstance(task.pin, Pin):
        with suppress(ValueError, ArithmeticError):  # the chart will say why
            beam = first(replace(asked, model="beam")).peak
            if beam.max_von_mises and beam.error_estimate is not None:
                beam_error = beam.error_estimate / beam.max_von_mises
    return ChartPlan(study, problem, asked, peak, beam_error)


def chart(
    plan: ChartPlan,
    measure: Measure,
    meshes: int | None = None,
    runs: int = 3,
    progress: Progress = lambda _, __: None,
) -> Chart:
    """Climb all ladders. measure: of one rung. meshes: of each solid element, by default as many as
    are quick. runs: the times are their medians.

    Raises: SolveError when there is no reference.
    """
    about, behind = len(HARMONIC) + 3 * (meshes or USUAL) + 4, 0

    def tell(message: str) -> None:
        nonlocal behind
        progress(message, min(behind / about, 1.0))
        behind += 1

    climb = Climb(plan.problem, plan.asked, plan.peak.model, measure, runs, tell)
    pin = plan.problem.pin
    if isinstance(pin, Pin):
        climb.to(Rung("beam"))
        climb_harmonic(climb)
    else:
        other = Measured(None, failed=f"pin {pin.name} is not a body of revolution")
        climb.done += [(Rung("beam"), other), (Rung("harmonic"), other)]
    elements: tuple[Element, ...] = ("linear", "straight", "curved")
    for element in elements:
        climb_solid(climb, element, meshes)
    reference = harmonic_reference(climb) if isinstance(pin, Pin) else solid_reference(climb)
    return _joined(plan, climb, reference, runs)


def _joined(plan: ChartPlan, climb: Climb, reference: tuple[Rung, Seen], runs: int) -> Chart:
    at, seen = reference
    stress, best, ends = plan.study.system.factor("stress"), seen.results[-1], chosen(climb)

    def name(rung: Rung) -> str:
        return NAMES.get(rung.model, NAMES[rung.element])

    points = [
        ChartPoint(
            rung.model,
            name(rung),
            found.result.unknowns,
            found.seconds,
            found.memory,
            found.result.maximum / stress,
            abs(found.result.maximum / best.maximum - 1.0),
            rung == ends,
        )
        if found.result is not None
        else ChartPoint(rung.model, name(rung), failed=found.failed)
        for rung, found in climb.done
    ]
    return Chart(
        pin=plan.problem.pin.name,
        case=plan.problem.loads.case,
        stress_unit=plan.study.system.stress,
        tolerance=plan.asked.tolerance,
        points=tuple(points),
        reference=Reference(
            at.model, name(at), best.unknowns,
            best.maximum / stress, seen.relative,
        ),
        bare=max(m.bare for _, m in climb.done),
        runs=runs,
        beam_error=plan.beam_error,
        note=_note(plan.peak),
    )  # fmt: skip


def _note(peak: Peak) -> str:
    """Where the maximum is one of a part of the pin only."""
    governing = [zone for zone in peak.singular_at if zone.governs]
    if not governing:
        return ""
    worst = max(governing, key=lambda zone: zone.max_von_mises)
    return (
        f"No maximum exists: at {worst.kind} ({' / '.join(worst.between)}) stress grows without "
        "bound. The chart shows the maximum outside the excluded zones, which all models "
        "share."
    )

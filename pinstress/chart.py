"""The speed-accuracy chart of one pin: every model on a ladder of meshes beside a reference."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace

from fea.ladder import Asked, solve_pin
from fea.peak import Peak
from fea.rungs import Problem, Rung
from fea.verdict import Seen
from geometry import Pin
from geometry.elements import Element
from pinstress.climb import (
    HARMONIC,
    USUAL,
    Climb,
    chosen,
    climb_harmonic,
    climb_solid,
    harmonic_reference,
    solid_reference,
)
from pinstress.errors import InputError
from pinstress.own_process import Measure, Measured
from pinstress.pins import material as material_of
from pinstress.plan import all_loads, select
from pinstress.study import Study
from pinstress.tasks import tasks
from pinstress.workers import Progress
from reports.chart import Chart, ChartPoint, Reference

NAMES = {
    "beam": "Timoshenko beam",
    "harmonic": "quadratic triangles",
    "linear": "linear tetrahedra",
    "straight": "straight quadratic tetrahedra",
    "curved": "curved quadratic tetrahedra",
}


@dataclass(frozen=True)
class Plan:
    """What is to be charted, every input read and found usable. peak: what `auto` says of it on
    its first mesh. beam_error: relative, of the beam by itself.
    """

    study: Study
    problem: Problem
    asked: Asked
    peak: Peak
    beam_error: float | None


def prepare(study: Study, pin: str, case: str, tolerance: float | None = None) -> Plan:
    """Raises: InputError for bad input, a pin that nothing holds, or one without any stress."""
    select(study.table.pin, [pin], "pin", "--pin")
    loads = all_loads(study, select(study.table.case, [case], "case", "--case"))
    (task,) = tasks(study, [pin], loads)
    table = study.table.analysis
    asked = Asked(
        tolerance or table.tolerance,
        goal=table.goal,
        required=table.required_safety_factor,
        distance=table.excluded_distance,
    )
    material = material_of(study, study.table.pin[pin].material)
    clamps = tuple(task.pin.surface(c) for c in task.clamps)
    problem = Problem(task.pin, material, clamps, task.loads[0], asked.distance)

    def first(model: Asked) -> Peak:
        return solve_pin(task.pin, material, task.clamps, task.loads, model)[0].peak

    peak = first(replace(asked, meshes=1))
    if not peak.max_von_mises:
        why = peak.note if peak.verdict == "rigid" else "its loads make no stress"
        raise InputError(f"{study.path}: pin {pin}, case {case}: there is nothing to chart: {why}")
    beam_error = None
    if isinstance(task.pin, Pin):
        with suppress(ValueError, ArithmeticError):  # the chart will say why
            beam = first(replace(asked, model="beam"))
            if beam.max_von_mises and beam.error_estimate is not None:
                beam_error = beam.error_estimate / beam.max_von_mises
    return Plan(study, problem, asked, peak, beam_error)


def chart(
    plan: Plan,
    measure: Measure,
    meshes: int | None = None,
    runs: int = 3,
    progress: Progress = lambda _, __: None,
) -> Chart:
    """Climb all ladders. measure: of one rung. meshes: of each solid element, by default as many as
    are quick. runs: of which times are medians.

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
        other = Measured(None, failed=f"pin {pin.name} is no body of revolution")
        climb.done += [(Rung("beam"), other), (Rung("harmonic"), other)]
    elements: tuple[Element, ...] = ("linear", "straight", "curved")
    for element in elements:
        climb_solid(climb, element, meshes)
    reference = harmonic_reference(climb) if isinstance(pin, Pin) else solid_reference(climb)
    return _joined(plan, climb, reference, runs)


def _joined(plan: Plan, climb: Climb, reference: tuple[Rung, Seen], runs: int) -> Chart:
    at, seen = reference
    stress, best, ends = plan.study.system.factor("stress"), seen.looks[-1], chosen(climb)

    def name(rung: Rung) -> str:
        return NAMES.get(rung.model, NAMES[rung.element])

    points = [
        ChartPoint(
            rung.model,
            name(rung),
            found.look.unknowns,
            found.seconds,
            found.memory,
            found.look.maximum / stress,
            abs(found.look.maximum / best.maximum - 1.0),
            rung == ends,
        )
        if found.look is not None
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
        "bound. Charted is the largest outside of what is excluded, by one rule for all models."
    )

"""The speed-accuracy chart of one pin: every model on a sequence of meshes, compared with a
reference solution.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace

from fea.core.mesh_history import MeshHistory
from fea.core.peak import Maximum
from fea.core.requirement import Requirement
from fea.solve.refine import LOCAL_MODEL
from fea.solve.single_mesh import ModelMesh, Problem
from fea.solve.solve import solve_in_lugs, solve_pin
from fea.support.support import PinProblem, Solution
from geometry import body_of_revolution
from geometry.mesh.elements import Element
from pinbase.keys import key_part
from pinbase.processes.pool import Progress
from pinstress.analysis.plan import all_loads
from pinstress.explore.chart.in_lugs import chosen_in_lugs, climb_in_lugs, contact_reference
from pinstress.explore.chart.measured_process import Measure, Measured
from pinstress.explore.chart.mesh_sequences import (
    HARMONIC_LEVELS,
    SOLID_MESHES,
    Climb,
    chosen,
    climb_harmonic,
    climb_local,
    climb_solid,
    harmonic_reference,
    local_reference,
    solid_reference,
)
from pinstress.explore.chart.single_joint import JointProblem, JointRung
from pinstress.study.model.hardened import require_no_hardened
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.requirements import required_factor
from pinstress.study.model.tasks import Task, tasks
from pinstress.study.reading.choices import require_tolerance, select
from pinstress.study.reading.file import Study
from reports.data.chart import Chart, ChartPoint, Reference

ELEMENT_NAMES = {
    "beam": "Timoshenko beam",
    "harmonic": "quadratic triangles",
    "harmonic+local": "triangles and local tetrahedra",
    "linear": "linear tetrahedra",
    "straight": "straight quadratic tetrahedra",
    "curved": "curved quadratic tetrahedra",
}


@dataclass(frozen=True)
class ChartPlan:
    """The plan of a chart, with all input read and checked.

    peak: maximum by the automatic choice of the model on its first mesh; for a pin in its lugs, the
    maximum of a run.
    beam_error: relative error that the beam model estimates for itself.
    chosen: for a pin in its lugs, the mesh on which a run ends.
    """

    study: Study
    problem: Problem | JointProblem
    requirement: Requirement
    peak: Maximum
    beam_error: float | None = None
    chosen: JointRung | None = None


def plan_chart(study: Study, pin: str, case: str, tolerance: float | None = None) -> ChartPlan:
    """Read the input of a chart and return its plan.

    Raises: InputError for bad input, an unconstrained pin, or one without any stress.
    """
    select(study.table.pin, [pin], "pin", "pin")
    require_no_hardened(study, pin, "a chart")
    loads = all_loads(study, select(study.table.case, [case], "case", "case"))
    (task,) = tasks(study, [pin_of(study, pin)], loads)
    table = study.table.analysis
    requirement = Requirement(
        require_tolerance(tolerance) or table.tolerance,
        goal=table.goal,
        required=required_factor(study, pin, case),
        distance=table.excluded_distance,
    )
    if task.lugs:
        return _plan_in_lugs(study, task, requirement)
    clamps = tuple(task.pin.surface(c) for c in task.clamps)

    def first(model: Requirement) -> Solution:
        solutions = solve_pin(
            task.pin, task.material, task.clamps, task.loads, model, between=task.between
        )
        return solutions[0]

    solution = first(replace(requirement, meshes=1))
    peak = solution.peak
    problem = Problem(task.pin, task.material, clamps, solution.loads, requirement.distance)
    _require_stress(study, peak)
    beam_error = None
    if task.pin.revolved:
        with suppress(ValueError, ArithmeticError):  # the chart will say why
            beam = first(replace(requirement, model="beam")).peak
            if beam.max_von_mises and beam.error_estimate is not None:
                beam_error = beam.error_estimate / beam.max_von_mises
    return ChartPlan(study, problem, requirement, peak, beam_error)


def _require_stress(study: Study, peak: Maximum) -> None:
    if not peak.max_von_mises:
        why = "its loads cause no stress" if peak.verdict == "converged" else peak.note
        text = f"pin {peak.pin}, case {peak.case}: there is nothing to chart: {why}"
        raise study.error(text, at=f"pin.{key_part(peak.pin)}", code="nothing-to-chart")


def _plan_in_lugs(study: Study, task: Task, requirement: Requirement) -> ChartPlan:
    """Return the plan for a pin in its lugs, which is solved as in a run."""
    pin = body_of_revolution(task.pin)
    if pin is None:
        raise study.error(
            f"pin {task.pin.name} has cuts and is held by lugs; charts of contact are of pins "
            'without cuts: remove them, or set analysis.joints = "prescribed"',
            at=f"pin.{key_part(task.pin.name)}",
            code="not-axisymmetric",
        )
    given = PinProblem(pin, task.material, task.lugs, task.loads, task.between)
    (solution,) = solve_in_lugs(given, requirement)
    _require_stress(study, solution.peak)
    assert solution.joint is not None
    problem = JointProblem(
        pin,
        task.material,
        task.lugs,
        solution.loads.links,
        solution.instant,
        requirement.distance,
    )
    end = chosen_in_lugs(problem, solution.peak, solution.joint)
    return ChartPlan(study, problem, requirement, solution.peak, chosen=end)


def chart(
    plan: ChartPlan,
    measure: Measure,
    meshes: int | None = None,
    runs: int = 3,
    progress: Progress = lambda _, __: None,
    calculix: bool = False,
) -> Chart:
    """Solve all models on their meshes and return the chart.

    measure: a function that solves one mesh and measures time and memory.
    meshes: number of meshes for each solid element, by default as many as can be solved quickly.
    runs: number of runs of each mesh; times are medians over the runs.
    calculix: whether CalculiX also solves a pin in its lugs.

    Raises: SolveError if there is no reference.
    """
    about, behind = len(HARMONIC_LEVELS) + 3 * (meshes or SOLID_MESHES) + 4, 0

    def tell(message: str) -> None:
        nonlocal behind
        progress(message, min(behind / about, 1.0))
        behind += 1

    climb = Climb(plan.problem, plan.requirement, plan.peak.model, measure, runs, tell)
    if plan.chosen is not None:
        climb_in_lugs(climb, plan.chosen, calculix)
        rung, seen, cells = contact_reference(climb)
        return _joined(plan, climb, (rung, seen), cells)
    pin = plan.problem.pin
    if pin.revolved:
        climb.to(ModelMesh("beam"))
        climb_harmonic(climb)
    elif climb.auto == LOCAL_MODEL:
        climb_local(climb)
    else:
        other = Measured(None, failed=f"pin {pin.name} is not a body of revolution")
        climb.done += [(ModelMesh("beam"), other), (ModelMesh("harmonic"), other)]
    elements: tuple[Element, ...] = ("linear", "straight", "curved")
    for element in elements:
        climb_solid(climb, element, meshes)
    if pin.revolved:
        reference = harmonic_reference(climb)
    else:
        reference = local_reference(climb) if climb.auto == LOCAL_MODEL else solid_reference(climb)
    return _joined(plan, climb, reference)


def _joined(
    plan: ChartPlan,
    climb: Climb,
    reference: tuple[ModelMesh | JointRung, MeshHistory],
    cells: float = 0.0,
) -> Chart:
    """Return the chart of the solved meshes.

    cells: relative part of the reference's error that is due to the contact cells.
    """
    at, seen = reference
    stress, best = plan.study.system.factor("stress"), seen.results[-1]
    ends = plan.chosen or chosen(climb)

    def name(rung: ModelMesh | JointRung) -> str:
        if isinstance(rung, JointRung):
            return rung.element
        return ELEMENT_NAMES.get(rung.model, ELEMENT_NAMES[rung.element])

    points = [
        ChartPoint(
            rung.model,
            name(rung),
            measured.result.unknowns,
            measured.seconds,
            measured.memory,
            measured.result.maximum / stress,
            abs(measured.result.maximum / best.maximum - 1.0),
            rung == ends,
        )
        if measured.result is not None
        else ChartPoint(rung.model, name(rung), failed=measured.failed)
        for rung, measured in climb.done
    ]
    return Chart(
        pin=plan.problem.pin.name,
        case=plan.problem.loads.case,
        stress_unit=plan.study.system.stress,
        tolerance=plan.requirement.tolerance,
        points=tuple(points),
        reference=Reference(
            at.model, name(at), best.unknowns,
            best.maximum / stress, seen.relative + cells,
        ),
        bare=max(m.bare for _, m in climb.done),
        runs=climb.runs,
        beam_error=plan.beam_error,
        note=_note(plan.peak),
    )  # fmt: skip


def _note(peak: Maximum) -> str:
    """Return a note if the maximum is only that outside the excluded zones; else empty."""
    governing = [zone for zone in peak.singular_at if zone.governs]
    if not governing:
        return ""
    worst = max(governing, key=lambda zone: zone.max_von_mises)
    return (
        f"No maximum exists: at {worst.kind} ({' / '.join(worst.between)}) stress grows without "
        "bound. The chart shows the maximum outside the excluded zones, which all models "
        "share."
    )

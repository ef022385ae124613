"""Parallel solution of the tasks of a plan; only the small results of each task are kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import inf
from typing import TYPE_CHECKING

from assess.fatigue.records import PointHistory
from assess.opinion.opinions import Opinion
from fea.core.memory import allowed_memory, solid_memory
from fea.core.peak import Maximum
from fea.core.requirement import Requirement
from fea.support.records import JointResult
from pinbase.memo import Memo
from pinbase.processes.pool import Job, ProcessDied, Progress, Tell, in_parallel
from pinbase.records import Unit, in_units
from pinstress.analysis import checks
from pinstress.analysis.assessed.limits import limit_loads, limit_seconds, lug_collapses
from pinstress.analysis.assessed.situations import assessed
from pinstress.analysis.cache import OutcomeStore
from pinstress.analysis.plan import Plan, for_task
from pinstress.analysis.stored import Entry, PinOutcome, cache_key, independent_of_memory
from pinstress.study.model.pins import shape_notes
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from reports.data.fields import Field
from reports.data.row import PinResult

if TYPE_CHECKING:  # the solvers are imported only for tasks that are not in the cache
    from fea.support.support import PinProblem, Solution

# The change of a dimension, m, for which its effect on the stress is reported, by system of units.
DIMENSION_STEPS = {"in-lbf-s": 0.1 * 0.0254, "mm-N-s": 1e-3, "m-N-s": 1e-3}
NO_FRICTION = "not included: friction in lugs, which needs the pressures of contact"

Keep = Callable[[Field], None]
Ask = Callable[[Plan, Task, tuple[PinResult, ...], Tell], tuple[Opinion, ...]]


def _ask_none(_: Plan, __: Task, ___: tuple[PinResult, ...], ____: Tell) -> tuple[Opinion, ...]:
    return ()


def solve_tasks(
    plan: Plan,
    keep: Keep | None = None,
    progress: Progress = lambda _, __: None,
    ask: Ask = _ask_none,
    jobs: int = 1,
    cache: OutcomeStore | None = None,
    memo: Memo | None = None,
) -> list[PinOutcome]:
    """Return the outcome of every task of a plan, in their order.

    Tasks are solved in processes of their own (pinbase.processes.pool), `jobs` at a time; with 1,
    in this process. The results are bitwise the same. A task whose solution fails has the verdict
    `failed`; the others continue.

    keep: called with every field, in the study's units, as soon as it exists, in the task's
    process; without `keep` no fields are made.
    progress: called with the current step and the completed part of the work.
    ask: gives a second opinion on a task, in the task's process, and reports its progress.
    cache: where earlier tasks are looked up and new ones are stored.
    memo: flexibilities and meshes that tasks share, if they are solved in this process.
    """
    show = None if keep is None else partial(_in_units, plan.study.system.factor, keep)
    order = sorted(range(len(plan.tasks)), key=lambda i: effort(plan, plan.tasks[i]), reverse=True)
    work = [
        Job(f"pin {task.pin.name}", partial(_attempt, plan, task, show, ask, cache, memo))
        for task in (plan.tasks[i] for i in order)
    ]
    outcomes: dict[int, PinOutcome] = {}
    for i, outcome in zip(order, in_parallel(work, _together(plan, jobs), progress), strict=True):
        outcomes[i] = (
            _failed(plan, plan.tasks[i], outcome.reason)
            if isinstance(outcome, ProcessDied)
            else outcome
        )
    return [outcomes[i] for i in range(len(plan.tasks))]


def _in_units(unit: Unit, keep: Keep, field: Field) -> None:
    keep(in_units(field, unit))


def _together(plan: Plan, jobs: int) -> int:
    """Return the number of jobs that fit into memory, as if every job were a solid of the largest
    size.
    """
    if not any(effort(plan, task)[0] for task in plan.tasks):
        return jobs
    from fea.solid.evaluate import SOLID_MESHES

    room = allowed_memory(plan.requirement.memory) / solid_memory(SOLID_MESHES.max_unknowns)
    return max(1, min(jobs, int(room)))


def effort(plan: Plan, task: Task) -> tuple[bool, int, int, int]:
    """Return a sort key by effort: whether the pin is a solid, numbers of lugs, cases and instants.

    Lugs at connections, which move more than those of the structure, count twice.
    """
    solid = plan.requirement.model == "solid" or not task.pin.revolved
    lugs = len(task.lugs) + sum(lug.connection in task.pin.connections for lug in task.lugs)
    return solid, lugs, len(task.loads), sum(map(len, task.loads))


def _attempt(
    plan: Plan,
    task: Task,
    keep: Keep | None,
    ask: Ask,
    cache: OutcomeStore | None,
    memo: Memo | None,
    tell: Tell,
) -> PinOutcome:
    try:
        if cache is None:
            solved = _solve(plan, task, keep, memo, tell)
        else:
            solved = _solve_once(plan, task, keep, cache, memo, tell)
        opinions = {x.case: x for x in ask(plan, task, solved.rows, tell)}
        rows = (replace(row, second_opinion=opinions.get(row.case)) for row in solved.rows)
        return replace(solved, rows=tuple(assessed(plan.study, task, row) for row in rows))
    except MemoryError:
        return _failed(plan, task, "out of memory; a larger tolerance needs less")
    except ArithmeticError as error:  # MeshError, SolveError and what numpy raises
        return _failed(plan, task, str(error))


def _solve_once(
    plan: Plan, task: Task, keep: Keep | None, cache: OutcomeStore, memo: Memo | None, tell: Tell
) -> PinOutcome:
    """Return a task's outcome from the cache, or solve the task and store its outcome there.

    A plan that needs rows only also accepts an outcome that was stored with its explanations.
    """
    key, lacking = entry_keys(plan, task, cache)
    explained_keys = (
        () if plan.explained else entry_keys(replace(plan, explained=True), task, cache)
    )
    entries = (cache.read(x, Entry) for x in (key, lacking, *explained_keys) if x is not None)
    entry = next((x for x in entries if x is not None and x.answers(task)), None)
    if entry is not None:
        tell(f"pin {task.pin.name}, as solved before")
        if keep is not None:
            for field in entry.fields:
                keep(field)
        return replace(entry.solved, cached=True)
    fields: list[Field] = []

    def keep_both(field: Field) -> None:
        assert keep is not None
        keep(field)
        fields.append(field)

    solved = _solve(plan, task, keep_both if keep else None, memo, tell)
    if independent_of_memory(plan, task, [row.maximum for row in solved.rows]):
        stopped = any(row.limit_load is not None and row.limit_load.stopped for row in solved.rows)
        cache.write(lacking if lacking and stopped else key, Entry(solved, tuple(fields)))
    return solved


def entry_keys(plan: Plan, task: Task, cache: OutcomeStore) -> tuple[str, str | None]:
    """Return two names of a task's outcome in the cache: with all limit loads, and without a limit
    load that would take too long. The second is None where all limit loads are requested.

    An outcome of the second name does not answer a task that requests the missing limit load.
    """
    key, seconds = cache.key(cache_key(plan, task)), limit_seconds(plan)
    return key, None if seconds == inf else cache.key(cache_key(plan, task, seconds))


def _failed(plan: Plan, task: Task, reason: str) -> PinOutcome:
    name, model = task.pin.name, plan.requirement.model
    peaks = (Maximum(name, case.case, model, "failed", reason) for case in task.loads)
    return PinOutcome(tuple(assessed(plan.study, task, PinResult(peak)) for peak in peaks))


def solutions(
    study: Study, task: Task, requirement: Requirement, tell: Tell, memo: Memo | None = None
) -> tuple[Solution, ...]:
    """Return the solutions of a task's cases.

    memo: flexibilities, meshes and unit fields, shared with other tasks.

    Raises: ArgumentError, MeshError, SolveError.
    """
    from fea.solve.solve import solve

    return solve(problem_of(task, memo), for_task(study, task, requirement), tell)


def problem_of(task: Task, memo: Memo | None = None) -> PinProblem:
    """Return the problem that a task poses to the solvers; memo: as in `solutions`."""
    from fea.support.support import PinProblem

    return PinProblem(
        task.pin, task.material, task.lugs, task.loads, task.between, task.also, task.clamps,
        memo,
    )  # fmt: skip


def _solve(plan: Plan, task: Task, keep: Keep | None, memo: Memo | None, tell: Tell) -> PinOutcome:
    from pinstress.analysis import gather_fields
    from pinstress.analysis.gather.gather_surface import surfaces_of
    from pinstress.analysis.remedies.changes import change
    from pinstress.analysis.remedies.sensitivities import sensitivities

    study = plan.study
    solved = solutions(study, task, plan.requirement, tell, memo)
    if not plan.explained:
        return _bare(plan, task, solved, tell)
    pressures = [solution.pressure for solution in solved]
    if keep is not None:
        for solution, pressure in zip(solved, pressures, strict=True):
            case = plan.loads[solution.peak.case]
            field = gather_fields.field(task, solution, case, plan.also, pressure)
            if field is not None:
                tell(f"pin {task.pin.name}, pictures")
                keep(field)
    beam_check = None
    if task is plan.checked and study.table.beam_check is not None:
        tell(f"pin {task.pin.name}, beam check")
        beam_check = checks.beam_check(study, task)
    surfaces = surfaces_of(plan.loads, task, solved, pressures)
    histories, no_histories = _histories(task, solved)
    tell(f"pin {task.pin.name}, what to change")
    remedy = change(for_task(study, task, plan.requirement), task, solved)
    tell(f"pin {task.pin.name}, sensitivities")
    step = DIMENSION_STEPS[study.table.units]
    sensitive = sensitivities(study, plan.requirement, task, solved, step, plan.sensitive)
    rows = _rows(plan, task, solved, tell)
    return PinOutcome(rows, surfaces, histories, no_histories, sensitive, remedy, beam_check)


def _rows(
    plan: Plan, task: Task, solved: tuple[Solution, ...], tell: Tell
) -> tuple[PinResult, ...]:
    """Return the rows of a task with their joints, ranges and limit loads."""
    from pinstress.analysis.gather.gather_landing import landing_range, sharing_range

    ratio = plan.requirement.for_ratio  # one ratio serves for the whole range
    landing = [None if ratio else landing_range(plan.loads, task, s) for s in solved]
    sharing = [None if ratio else sharing_range(task, s) for s in solved]
    joints = _in_lugs(task, solved, tell) if task.lugs else _ranges_around(plan, task, solved)
    limits = limit_loads(plan, task, solved, tell)
    of_lugs = lug_collapses(plan, task, tell)
    parts = zip(solved, joints, limits, landing, sharing, strict=True)
    return tuple(
        PinResult(
            _with_notes(task, s.peak), joint=joint, limit_load=limit, landing=over,
            lug_collapses=of_lugs, sharing=links,
        )
        for s, joint, limit, over, links in parts
    )  # fmt: skip


def _in_lugs(
    task: Task, solved: tuple[Solution, ...], tell: Tell
) -> tuple[JointResult | None, ...]:
    """Return the joint of a pin in lugs for each case, with the stress of the lugs whose shank is
    known.
    """
    if not any(lug.shank for lug in task.lugs):
        return tuple(s.joint for s in solved)
    from fea.lug.in_joint import lug_stresses
    from fea.support.contact.held import HeldContact

    memo, out = Memo(), []
    for s in solved:
        joint, case = s.joint, s.peak.case
        if joint is not None and isinstance(s.held, HeldContact) and not s.held.alone:
            tell(f"pin {task.pin.name}, stress of its lugs")
            try:
                shanks = task.shanks.get(case, {})
                varied = joint.range is not None and bool(joint.range.variations)
                stress = lug_stresses(s.held.contact, case, shanks, varied, memo)
                joint = replace(joint, lugs=stress)
            except ArithmeticError as error:  # the pin's stress is valid without that of its lugs
                remark = f"no stress of the lugs: {error}"
                joint = replace(joint, remark=_joined(joint.remark, remark))
        out.append(joint)
    return tuple(out)


def unjudged(plan: Plan, task: Task, memo: Memo) -> tuple[PinResult, ...]:
    """Return the rows of a task before their assessment.

    Raises: ArgumentError, MeshError, SolveError.
    """
    return _rows(plan, task, solutions(plan.study, task, plan.requirement, _silent, memo), _silent)


def _silent(_: str) -> None:
    """Report no progress."""


def judged(plan: Plan, task: Task, tell: Tell, memo: Memo | None = None) -> PinOutcome:
    """Return the outcome of a task with everything that judges its rows, but without what only
    explains them: pictures, surfaces, remedies, sensitivities.

    Raises: ArgumentError, MeshError, SolveError.
    """
    outcome = _bare(plan, task, solutions(plan.study, task, plan.requirement, tell, memo), tell)
    return replace(outcome, rows=tuple(assessed(plan.study, task, row) for row in outcome.rows))


def _bare(plan: Plan, task: Task, solved: tuple[Solution, ...], tell: Tell) -> PinOutcome:
    """Return the rows of a task, and the stress histories if fatigue is to be judged."""
    rows = _rows(plan, task, solved, tell)
    if plan.study.table.fatigue is None:
        return PinOutcome(rows)
    histories, no_histories = _histories(task, solved)
    return PinOutcome(rows, histories=histories, no_histories=no_histories)


def _with_notes(task: Task, peak: Maximum) -> Maximum:
    """Return the maximum with the notes on the pin's shape."""
    return replace(peak, note="; ".join(filter(None, (peak.note, shape_notes(task.pin)))))


def _histories(task: Task, solved: tuple[Solution, ...]) -> tuple[tuple[PointHistory, ...], str]:
    """Return the histories of stress at the pin's critical points, and the reason if they fail.

    The failure is caught, so that the pin's stress is not lost.
    """
    from assess.fatigue.critical_points import stress_histories

    try:
        return stress_histories(task.pin.name, solved), ""
    except Exception as error:
        return (), f"{type(error).__name__}: {error}"


def _joined(*remarks: str) -> str:
    return "; ".join(filter(None, remarks))


def _ranges_around(
    plan: Plan, task: Task, solved: tuple[Solution, ...]
) -> tuple[JointResult | None, ...]:
    """Return, for each case, the range over the lugs around a pin with prescribed clamps
    and loads.
    """
    around = task.surroundings
    loads = [None if s.peak.governing is None else s.loads for s in solved]
    if around is None:
        return (None,) * len(solved)
    if around.pin is None:
        none = JointResult("prescribed", remark=around.why)
        return tuple(none if here is not None else None for here in loads)
    from fea.support.contact.friction import rubs
    from fea.support.foundation.variations import prescribed_ranges

    ranges = prescribed_ranges(
        around.pin, task.material, around.lugs, loads, (plan.requirement.distance, around.assumed)
    )
    if rubs(task.given):
        ranges = tuple(x and replace(x, remark=_joined(x.remark, NO_FRICTION)) for x in ranges)
    if not task.material.hardened:
        return ranges
    from fea.support.hardened_row import range_of_row

    return tuple(
        range_of_row(joint, solution.peak, task.material, around.pin)
        for joint, solution in zip(ranges, solved, strict=True)
    )

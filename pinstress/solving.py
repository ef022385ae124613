"""The tasks of a plan, solved side by side: of each there remains what is small."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from fea.ladder import MOST_UNKNOWNS, solve_pin
from fea.memory import allowed_memory, solid_memory
from fea.peak import Peak
from fea.second_opinion import Opinion
from pinstress import checks, gather
from pinstress.gather_surface import surface_of
from pinstress.pins import material as material_of
from pinstress.plan import Plan
from pinstress.tasks import Task
from pinstress.workers import Died, Job, Progress, Tell, side_by_side
from reports.results import BeamCheck, Field, LandingRange
from reports.surface import Surface

Keep = Callable[[Field], None]
Ask = Callable[[Task, tuple[Peak, ...], Tell], tuple[Opinion, ...]]


@dataclass(frozen=True)
class Solved:
    """A task's peaks in the order of its cases, and what else reports and CalculiX have to say."""

    peaks: tuple[Peak, ...]
    landing: tuple[LandingRange, ...] = ()
    beam: BeamCheck | None = None
    surface: Surface | None = None
    opinions: tuple[Opinion, ...] = ()


def solve_tasks(
    plan: Plan,
    keep: Keep = lambda _: None,
    progress: Progress = lambda _, __: None,
    ask: Ask = lambda _, __, ___: (),
    jobs: int = 1,
) -> list[Solved]:
    """What is found of every task of a plan, in their order, `jobs` of them at a time, each in its
    own process (pinstress.workers); with 1, in this one. The answers are the same to the last bit.

    keep: called with every field as soon as it is there. ask: for a second opinion on a task's
    peaks, told whom to tell what is being done. Both are called in the task's process. progress:
    called with what is being done and the part of the work that is behind.

    A task whose numerics fail has the verdict `failed`; the others go on.
    """
    order = sorted(range(len(plan.tasks)), key=lambda i: _effort(plan, plan.tasks[i]), reverse=True)
    work = [
        Job(f"pin {task.pin.name}", partial(_attempt, plan, task, keep, ask))
        for task in (plan.tasks[i] for i in order)
    ]
    found: dict[int, Solved] = {}
    for i, made in zip(order, side_by_side(work, _together(plan, jobs), progress), strict=True):
        found[i] = _failed(plan, plan.tasks[i], made.reason) if isinstance(made, Died) else made
    return [found[i] for i in range(len(plan.tasks))]


def _together(plan: Plan, jobs: int) -> int:
    """So many of the jobs as there is memory for, if they are solids as large as they may get."""
    if not any(_effort(plan, task)[0] for task in plan.tasks):
        return jobs
    room = allowed_memory(plan.asked.memory) / solid_memory(MOST_UNKNOWNS["solid"])
    return max(1, min(jobs, int(room)))


def _effort(plan: Plan, task: Task) -> tuple[bool, int, int]:
    """What takes longer has more of: tetrahedra, then cases, then instants."""
    solid = plan.asked.model == "solid" or not task.pin.revolved
    return solid, len(task.loads), sum(map(len, task.loads))


def _attempt(plan: Plan, task: Task, keep: Keep, ask: Ask, tell: Tell) -> Solved:
    try:
        return _solve(plan, task, keep, ask, tell)
    except MemoryError:
        return _failed(plan, task, "out of memory; a larger tolerance needs less")
    except ArithmeticError as error:  # MeshError, SolveError and what numpy raises
        return _failed(plan, task, str(error))


def _failed(plan: Plan, task: Task, reason: str) -> Solved:
    return Solved(
        tuple(Peak(task.pin.name, c.case, plan.asked.model, "failed", reason) for c in task.loads)
    )


def _solve(plan: Plan, task: Task, keep: Keep, ask: Ask, tell: Tell) -> Solved:
    study = plan.study
    material = material_of(study, study.table.pin[task.pin.name].material)
    found = solve_pin(task.pin, material, task.clamps, task.loads, plan.asked, tell)
    for solution in found:
        if (field := gather.field(study, task, solution)) is not None:
            tell(f"pin {task.pin.name}, pictures")
            keep(field)
    peaks = tuple(s.peak for s in found)
    ranges = (gather.landing_range(study, plan.loads, task, s) for s in found)
    landing = tuple(r for r in ranges if r is not None)
    opinions = ask(task, peaks, tell)
    beam = None
    if task is plan.checked and study.table.beam_check is not None:
        tell(f"pin {task.pin.name}, beam check")
        beam = checks.beam_check(study, task, material)
    return Solved(peaks, landing, beam, surface_of(study, plan.loads, task, found), opinions)

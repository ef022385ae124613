"""Tasks of designs, and the common solution of tasks that differ only by their loads."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from fea.core.material import Material
from fea.core.requirement import Requirement
from geometry import ArgumentError
from pinbase.memo import Memo
from pinbase.records import digest
from pinstress.analysis.plan import for_task
from pinstress.analysis.solve import problem_of
from pinstress.analysis.stored import shape_of
from pinstress.explore.sweep.outcomes import bare_row
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.requirements import required_factors
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from reports.data.row import PinResult

Rows = tuple[PinResult, ...]


@dataclass(frozen=True)
class PosedTask:
    """A pin of a design in some load cases, ready to be solved.

    loads: by case. alike: hash of all data except loads on which the result depends. key: hash of
    all data on which it depends.
    """

    study: Study
    task: Task
    requirement: Requirement
    loads: Mapping[str, CaseLoads]
    alike: str
    key: str


def posed_task(
    study: Study,
    task: Task,
    requirement: Requirement,
    loads: Mapping[str, CaseLoads],
    alike: str | None = None,
) -> PosedTask:
    """Return a task with the hashes of the data on which its result depends.

    alike: the hash of a task that differs only by its loads, if known.
    """
    alike = alike or _alike(study, task, requirement)
    factors = required_factors(study, task.pin.name, (x.case for x in task.loads))
    # The ranges are part of the key, because impulses with different ranges may have equal forces.
    ranges = [loads[x.case].range for x in task.loads]
    key = digest((alike, task.clamps, task.loads, task.also, task.shared, ranges, factors))
    return PosedTask(study, task, requirement, loads, alike, key)


def superposed(posed: Iterable[PosedTask], memo: Memo) -> dict[str, Rows]:
    """Return the rows, by key, of the tasks that can be solved together with others. The rows are
    the same as if each task were solved alone.

    memo: meshes and unit fields.
    """
    groups: dict[tuple[object, ...], dict[str, PosedTask]] = {}
    for one in posed:
        if len(one.task.loads) == 1 and not (one.task.lugs or one.task.also or one.task.between):
            (loads,) = one.task.loads
            bands = one.task.clamps, loads.case, loads.surfaces, loads.distribution, len(loads)
            groups.setdefault((one.alike, *bands), {})[one.key] = one
    out: dict[str, Rows] = {}
    for group in groups.values():
        if len(group) > 1:
            out |= _together(list(group.values()), memo)
    return out


def _together(group: Sequence[PosedTask], memo: Memo) -> dict[str, Rows]:
    """Return the rows of tasks that differ only by their loads, if these can be superposed."""
    from fea.support.support import Solution
    from pinstress.explore.sweep.solve_each import solve_each, superposable

    first = group[0]
    task = replace(first.task, material=elastic(first.task.material))
    problem, requirement = problem_of(task, memo), for_task(first.study, task, first.requirement)
    if not superposable(problem, requirement):
        return {}
    try:
        maxima = solve_each(problem, tuple(x.task.loads[0] for x in group), requirement)
    except (ArgumentError, ArithmeticError, MemoryError):
        return {}  # each task is solved alone and reports its own error
    return {
        one.key: (bare_row(one.task, Solution(maximum, None, one.task.loads[0]), one.loads),)
        for one, maximum in zip(group, maxima, strict=True)
        if maximum is not None
    }


def elastic(material: Material) -> Material:
    """Return a material without its strengths, on which the stress does not depend. A hardened
    material keeps them, because they decide where stress governs.
    """
    if material.hardened:
        return material
    return replace(material.elastic_part, name=material.name)


def _alike(study: Study, task: Task, requirement: Requirement) -> str:
    decides = requirement.goal == "decide" or bool(task.lugs and not requirement.every)
    return digest(
        (
            shape_of(task.pin),
            # Strengths of lugs judge only their own share, which `bare_row` drops.
            task.lugs if decides else tuple(lug.with_materials(elastic) for lug in task.lugs),
            study.table.analysis.joints,
            study.table.fatigue is not None,
            task.material if decides else elastic(task.material),
            replace(requirement, memory=None),
        )
    )

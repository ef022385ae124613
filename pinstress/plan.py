"""What is to be solved of a study, every input read and found usable."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

from fea.ladder import Asked, Model
from fea.memory import allowed_memory
from pinstress import checks
from pinstress.build import CaseLoads, case_loads
from pinstress.errors import InputError
from pinstress.measures import published_values
from pinstress.mechanism import linkage
from pinstress.published import Published, read_published
from pinstress.study import Study
from pinstress.tasks import Task, tasks


def select(
    names: Iterable[str], wanted: Iterable[str] | None, what: str, option: str = ""
) -> list[str]:
    """The wanted names, or all. option: which named them, --{what}s by default.

    Raises: InputError for one that is not there.
    """
    names = list(names)
    if wanted is None:
        return names
    for name in wanted:
        if name not in names:
            near = difflib.get_close_matches(name, names, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(names)}"
            raise InputError(f"{option or f'--{what}s'}: the study has no {what} {name!r}; {hint}")
    return [n for n in names if n in set(wanted)]


def all_loads(study: Study, cases: list[str]) -> dict[str, CaseLoads]:
    """The reactions of every case, by name."""
    mechanism = linkage(study) if study.table.mechanism else None
    return {name: case_loads(study, name, mechanism) for name in cases}


@dataclass(frozen=True)
class Plan:
    """All that is known before anything is solved: every input is read and found usable.

    checked: the task whose pin the beam check compares, if any.
    """

    study: Study
    asked: Asked
    loads: dict[str, CaseLoads]
    tasks: list[Task]
    published: Published
    checked: Task | None


def prepare(
    study: Study,
    *,
    pins: Iterable[str] | None = None,
    cases: Iterable[str] | None = None,
    model: Model | None = None,
    tolerance: float | None = None,
    memory: float | None = None,
) -> Plan:
    """Find the reactions and lay out what is to be solved.

    pins, cases: names; all by default. model, tolerance: instead of the study's. memory: MB that a
    solid may take, by default most of what is free now.

    Raises: InputError for bad input.
    """
    published = read_published(study)
    loads = all_loads(study, select(study.table.case, cases, "case"))
    checks.motion_check(study, loads, published)  # mistakes there should not wait for the stresses
    published_values(study, loads, published)
    todo = tasks(study, select(study.table.pin, pins, "pin"), loads)
    check, checked = study.table.beam_check, None
    if check is not None:
        choice = (t for t in todo if t.pin.name == check.pin and check.case in t.left_out)
        checked = next(choice, None)
        if checked is not None:
            checks.require_cantilever(study, checked, check.case)
    asked = _asked(study, model, tolerance, allowed_memory(memory))
    for task in todo:
        if asked.model in ("beam", "harmonic") and not task.pin.revolved:
            raise InputError(
                f"{study.path}: pin {task.pin.name} is no body of revolution, which the "
                f"{asked.model} model needs: use auto or solid"
            )
    return Plan(study, asked, loads, todo, published, checked)


def _asked(study: Study, model: Model | None, tolerance: float | None, memory: float) -> Asked:
    table = study.table.analysis
    return Asked(
        tolerance or table.tolerance,
        model or table.model,
        table.goal,
        table.required_safety_factor,
        table.excluded_distance,
        memory=memory,
    )

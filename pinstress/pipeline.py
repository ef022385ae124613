"""From a study to its results: loads, then every pin by the model, then what reports need."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fea.refine import Solution, refine
from fea.solid import PinLoads
from geometry import Pin
from pinstress import build, gather
from pinstress.build import CaseLoads
from pinstress.errors import InputError
from pinstress.limits import require_built
from pinstress.published import Published, read_published
from pinstress.study import Study
from reports.results import Field, Results

Progress = Callable[[str, float], None]
Keep = Callable[[Field], None]


@dataclass(frozen=True)
class Task:
    """One pin, held in one way, with its loads in all the cases where it is held so.

    left_out: by case, the connections whose force is not applied because their band is held.
    """

    pin: Pin
    clamps: tuple[str, ...]
    loads: tuple[PinLoads, ...]
    left_out: dict[str, tuple[str, ...]]


def select(names: Iterable[str], wanted: Iterable[str] | None, what: str) -> list[str]:
    """The wanted names, or all. Raises: InputError for one that is not there."""
    names = list(names)
    if wanted is None:
        return names
    for name in wanted:
        if name not in names:
            near = difflib.get_close_matches(name, names, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(names)}"
            raise InputError(f"--{what}s: the study has no {what} {name!r}; {hint}")
    return [n for n in names if n in set(wanted)]


def all_loads(study: Study, cases: list[str]) -> dict[str, CaseLoads]:
    """The reactions of every case, by name."""
    mechanism = build.linkage(study) if study.table.mechanism else None
    return {name: build.case_loads(study, name, mechanism) for name in cases}


def tasks(study: Study, pins: list[str], loads: dict[str, CaseLoads]) -> list[Task]:
    """What is to be solved: the pins that any case loads.

    Raises: InputError when nothing is, or when all forces on a pin are at what holds it.
    """
    out = []
    for name in pins:
        pin = build.pin(study, name)
        ways = dict.fromkeys(study.clamps(name, case) for case in loads)
        for clamps in ways:
            task = _task(study, pin, clamps, loads)
            if task.loads:
                out.append(task)
    if not out:
        raise InputError(f"{study.path}: none of the cases loads any of the pins")
    return out


def _task(study: Study, pin: Pin, clamps: tuple[str, ...], loads: dict[str, CaseLoads]) -> Task:
    held = {pin.surface(c) for c in clamps}
    cases, left_out = [], {}
    for case, given in loads.items():
        here = [c for c in pin.connections if c in given.reactions.connections]
        if not here or study.clamps(pin.name, case) != clamps:
            continue
        applied = [c for c in here if c not in held]
        if not applied:
            raise InputError(
                f"{study.path}: case.{case}: every force on pin {pin.name} is at a clamped band "
                f"({', '.join(here)}), so nothing loads it; clamp something else"
            )
        left_out[case] = tuple(c for c in here if c in held)
        forces = np.stack([given.reactions.in_pin_axes(c) for c in applied], axis=1)
        cases.append(PinLoads(case, tuple(applied), forces))
    return Task(pin, clamps, tuple(cases), left_out)


@dataclass(frozen=True)
class Plan:
    """All that is known before anything is solved: every input is read and found usable.

    checked: the task whose pin the beam check compares, if any.
    """

    study: Study
    tolerance: float
    loads: dict[str, CaseLoads]
    tasks: list[Task]
    published: Published
    checked: Task | None


def prepare(
    study: Study,
    *,
    pins: Iterable[str] | None = None,
    cases: Iterable[str] | None = None,
    model: str | None = None,
    tolerance: float | None = None,
) -> Plan:
    """Find the reactions and lay out what is to be solved.

    pins, cases: names; all by default. model, tolerance: instead of the study's.

    Raises: InputError for bad input.
    """
    require_built(study, model or study.table.analysis.model)
    published = read_published(study)
    loads = all_loads(study, select(study.table.case, cases, "case"))
    gather.motion_check(study, loads, published)  # a mistake there should not wait for the stresses
    todo = tasks(study, select(study.table.pin, pins, "pin"), loads)
    check, checked = study.table.beam_check, None
    if check is not None:
        asked = (t for t in todo if t.pin.name == check.pin and check.case in t.left_out)
        checked = next(asked, None)
        if checked is not None:
            gather.require_cantilever(study, checked, check.case)
    return Plan(
        study, tolerance or study.table.analysis.tolerance, loads, todo, published, checked
    )


def solve(
    plan: Plan,
    keep: Keep = lambda _: None,
    progress: Progress = lambda _, __: None,
) -> Results:
    """Solve every pin of a plan.

    keep: called with every pin's field as soon as it is there. progress: called with what is being
    done and the part of the work that is behind.

    Raises: ArithmeticError (MeshError, SolveError) when the numerics fail.
    """
    study = plan.study
    solutions: list[tuple[Task, Solution]] = []
    beam = None
    for i, task in enumerate(plan.tasks):

        def tell(message: str, part: float = i / len(plan.tasks)) -> None:
            progress(message, part)

        material = build.material(study, study.table.pin[task.pin.name].material)
        found = refine(task.pin, material, task.clamps, task.loads, plan.tolerance, progress=tell)
        for solution in found:
            if (field := gather.field(study, solution)) is not None:
                keep(field)
        if task is plan.checked and study.table.beam_check is not None:
            tell(f"pin {task.pin.name}, beam check")
            at = next(s for s in found if s.peak.case == study.table.beam_check.case)
            beam = gather.beam_check(study, task, material, at)
        solutions += [(task, Solution(s.peak, None, None)) for s in found]  # fields are large
    pins, cases = list(study.table.pin), list(plan.loads)
    solutions.sort(key=lambda s: (pins.index(s[1].peak.pin), cases.index(s[1].peak.case)))
    return gather.results(study, plan.loads, solutions, beam, plan.published, plan.tolerance)


def run(study: Study, **chosen: Any) -> Results:
    """Analyse a study; `chosen` is what `prepare` takes. Raises: as `prepare` and `solve`."""
    return solve(prepare(study, **chosen))

"""From a study to its results: loads, then every pin by the model, then what reports need."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from fea.refine import Solution, refine
from fea.solid import PinLoads
from geometry import Pin
from pinstress import build, gather
from pinstress.build import CaseLoads
from pinstress.errors import InputError
from pinstress.limits import require_built
from pinstress.published import read_published
from pinstress.study import Study
from reports.results import Field, Results

Progress = Callable[[str, float], None]
Keep = Callable[[Field], None]


@dataclass(frozen=True)
class Task:
    """One pin with its loads in all the cases that load it. left_out: forces on held bands."""

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
        clamps = tuple(study.table.pin[name].clamp)
        held = {pin.surface(c) for c in clamps}
        cases, left_out = [], {}
        for case, given in loads.items():
            here = [c for c in pin.connections if c in given.reactions.connections]
            applied = [c for c in here if c not in held]
            if not here:
                continue
            if not applied:
                raise InputError(
                    f"{study.path}: case.{case}: every force on pin {name} is at a clamped band "
                    f"({', '.join(here)}), so nothing loads it; clamp something else"
                )
            left_out[case] = tuple(c for c in here if c in held)
            forces = np.stack([given.reactions.in_pin_axes(c) for c in applied], axis=1)
            cases.append(PinLoads(case, tuple(applied), forces))
        if cases:
            out.append(Task(pin, clamps, tuple(cases), left_out))
    if not out:
        raise InputError(f"{study.path}: none of the cases loads any of the pins")
    return out


def run(
    study: Study,
    *,
    pins: Iterable[str] | None = None,
    cases: Iterable[str] | None = None,
    model: str | None = None,
    tolerance: float | None = None,
    keep: Keep = lambda _: None,
    progress: Progress = lambda _, __: None,
) -> Results:
    """Analyse a study.

    pins, cases: names; all by default. model, tolerance: instead of the study's. keep: called with
    every pin's field as soon as it is there. progress: called with what is being done and the part
    of the work that is behind.

    Raises: InputError for bad input; ArithmeticError (MeshError, SolveError) when the numerics fail.
    """
    model = model or study.table.analysis.model
    tolerance = tolerance or study.table.analysis.tolerance
    require_built(study, model)
    progress("reactions", 0.0)
    published = read_published(study)
    loads = all_loads(study, select(study.table.case, cases, "case"))
    gather.motion_check(study, loads, published)  # a mistake there should not wait for the stresses
    todo = tasks(study, select(study.table.pin, pins, "pin"), loads)
    check = study.table.beam_check
    checked = next((t for t in todo if check and t.pin.name == check.pin), None)
    if check is None or checked is None or check.case not in checked.left_out:
        checked = None
    else:
        gather.require_cantilever(study, checked, check.case)
    solutions: list[tuple[Task, Solution]] = []
    beam = None
    for i, task in enumerate(todo):

        def tell(message: str, part: float = i / len(todo)) -> None:
            progress(message, part)

        material = build.material(study, study.table.pin[task.pin.name].material)
        found = refine(task.pin, material, task.clamps, task.loads, tolerance, progress=tell)
        for solution in found:
            if (field := gather.field(study, solution)) is not None:
                keep(field)
        if task is checked and check is not None:
            tell(f"pin {task.pin.name}, beam check")
            at = next(s for s in found if s.peak.case == check.case)
            beam = gather.beam_check(study, task, material, at)
        solutions += [(task, Solution(s.peak, None, None)) for s in found]  # fields are large
    return gather.results(study, loads, solutions, beam, published, tolerance)

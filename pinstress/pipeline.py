"""From a study to its results: loads, then every pin by the model, then what reports need."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

from fea.ladder import Asked, Model, Solution, solve_pin
from fea.peak import Peak
from pinstress import checks, gather
from pinstress.build import CaseLoads, case_loads
from pinstress.errors import InputError
from pinstress.gather_surface import surfaces
from pinstress.measures import published_values
from pinstress.mechanism import linkage
from pinstress.pins import material as material_of
from pinstress.published import Published, read_published
from pinstress.study import Study
from pinstress.tasks import Task, tasks
from reports.results import Field, LandingRange, Results
from reports.surface import Surface

Progress = Callable[[str, float], None]
Keep = Callable[[Field], None]
Ask = Callable[[Task, tuple[Peak, ...], Callable[[str], None]], None]


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
) -> Plan:
    """Find the reactions and lay out what is to be solved.

    pins, cases: names; all by default. model, tolerance: instead of the study's.

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
    asked = _asked(study, model, tolerance)
    for task in todo:
        if asked.model in ("beam", "harmonic") and not task.pin.revolved:
            raise InputError(
                f"{study.path}: pin {task.pin.name} is no body of revolution, which the "
                f"{asked.model} model needs: use auto or solid"
            )
    return Plan(study, asked, loads, todo, published, checked)


def _asked(study: Study, model: Model | None, tolerance: float | None) -> Asked:
    table = study.table.analysis
    return Asked(
        tolerance or table.tolerance,
        model or table.model,
        table.goal,
        table.required_safety_factor,
        table.excluded_distance,
    )


def solve(
    plan: Plan,
    keep: Keep = lambda _: None,
    progress: Progress = lambda _, __: None,
    ask: Ask = lambda _, __, ___: None,
) -> Results:
    """Solve every pin of a plan.

    keep: called with every pin's field as soon as it is there. progress: called with what is being
    done and the part of the work that is behind. ask: called with every task, its peaks, and whom
    to tell what is being done.

    Raises: ArithmeticError (MeshError, SolveError) when the numerics fail.
    """
    study = plan.study
    solutions: list[tuple[Task, Solution]] = []
    landing: list[LandingRange] = []
    shown: list[Surface] = []
    beam = None
    for i, task in enumerate(plan.tasks):

        def tell(message: str, part: float = i / len(plan.tasks)) -> None:
            progress(message, part)

        material = material_of(study, study.table.pin[task.pin.name].material)
        found = solve_pin(task.pin, material, task.clamps, task.loads, plan.asked, tell)
        for solution in found:
            if (field := gather.field(study, task, solution)) is not None:
                keep(field)
        ask(task, tuple(s.peak for s in found), tell)
        if task is plan.checked and study.table.beam_check is not None:
            tell(f"pin {task.pin.name}, beam check")
            beam = checks.beam_check(study, task, material)
        landing += [r for s in found if (r := gather.landing_range(study, plan.loads, task, s))]
        shown += surfaces(study, plan.loads, task, found)
        solutions += [(task, Solution(s.peak, None)) for s in found]  # fields are large
    pins, cases = list(study.table.pin), list(plan.loads)
    solutions.sort(key=lambda s: (pins.index(s[1].peak.pin), cases.index(s[1].peak.case)))
    results = gather.results(
        study, plan.loads, solutions, beam, plan.published, plan.asked.tolerance
    )
    return replace(results, landing=tuple(landing), surfaces=tuple(shown))


def loads_only(study: Study, cases: Iterable[str] | None = None) -> Results:
    """The mechanics of a study without stresses. Raises: InputError for bad input."""
    published = read_published(study)
    loads = all_loads(study, select(study.table.case, cases, "case"))
    return gather.results(study, loads, [], None, published, study.table.analysis.tolerance)


def run(study: Study, **chosen: Any) -> Results:
    """Analyse a study; `chosen` is what `prepare` takes. Raises: as `prepare` and `solve`."""
    return solve(prepare(study, **chosen))

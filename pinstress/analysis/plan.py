"""Plan of an analysis with its tasks, made after every input has been read and checked."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

from fea.core.memory import allowed_memory
from fea.core.requirement import Joints, Model, Requirement
from pinstress.analysis import checks
from pinstress.analysis.published_quantities import published_values
from pinstress.study.model.cases import CaseLoads, case_loads
from pinstress.study.model.mechanism.linkage import any_linkage, determined
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.requirements import asks_more_than_yield, required_factors
from pinstress.study.model.sequence import chosen_cases, require_times
from pinstress.study.model.tasks import Task, require_models, tasks
from pinstress.study.reading.choices import (
    require_model,
    require_positive,
    require_tolerance,
    select,
)
from pinstress.study.reading.errors import Errors, InputError
from pinstress.study.reading.file import Study
from pinstress.study.reading.published_tables import Published, read_published
from pinstress.study.schema.cases import GivenCase
from pinstress.study.schema.shown import as_text

ExtraFields = Literal["motion", "solid"] | None
LoadsOf = Callable[[Study, list[str]], dict[str, CaseLoads]]  # the loads of named cases


def all_loads(study: Study, cases: list[str]) -> dict[str, CaseLoads]:
    """Return the reactions of every case, by name.

    Raises: InputError with the errors of all cases.
    """
    wrong = Errors(study.path)
    mechanism = wrong.attempt(lambda: any_linkage(study)) if study.table.mechanism else None
    if mechanism is not None:  # one error for the mechanism, instead of one for every case
        wrong.attempt(partial(determined, study, mechanism))
    given = [name for name in cases if isinstance(study.table.case[name], GivenCase)]
    possible = given if wrong.lines else cases
    attempts = {
        name: wrong.attempt(partial(case_loads, study, name, mechanism)) for name in possible
    }
    wrong.tell()
    loads = {name: loads for name, loads in attempts.items() if loads is not None}
    require_times(study, {name: case.reactions.times for name, case in loads.items()})
    return loads


@dataclass(frozen=True)
class Plan:
    """The inputs of an analysis before anything is solved; all have been read and checked.

    pins: names of the chosen pins, including those that no case loads.
    checked: the task whose pin the beam check compares, if any.
    also: the fields to keep in addition to those of the model at the governing instant.
    sensitive: whether to compute sensitivities of all cases instead of each pin's worst case only.
    limit_load: whether to compute the limit loads of all rows that yield, however long they take.
    explained: whether to compute what explains the rows: surfaces, histories, remedies,
    sensitivities.
    """

    study: Study
    requirement: Requirement
    loads: dict[str, CaseLoads]
    tasks: list[Task]
    published: Published
    checked: Task | None
    also: ExtraFields = None
    sensitive: bool = False
    limit_load: bool = False
    explained: bool = True
    pins: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<Plan of {self.study!r}: pins: {len(self.pins)}, cases: {len(self.loads)}>"


def prepare(
    study: Study,
    *,
    pins: Iterable[str] | None = None,
    cases: Iterable[str] | None = None,
    model: Model | None = None,
    tolerance: float | None = None,
    memory: float | None = None,
    also: ExtraFields = None,
    limit_load: bool = False,
    loads_of: LoadsOf = all_loads,
) -> Plan:
    """Compute the reactions and prepare the pins for `solve`.

    pins, cases: names; all by default.
    model, tolerance: override those of the study.
    memory: MB that a solid model may take, by default most of the free memory.
    also: additional fields, along the whole motion or of the whole volume of a revolved pin.
    limit_load: compute the limit load of every row that yields, however long it takes; otherwise
    the study decides, where "auto" gives each 20 s of processor time.
    loads_of: function that returns the loads of cases.

    Raises: InputError for bad input.
    """
    if not isinstance(study, Study):
        raise InputError(
            f"{as_text(study)} is not a study; pinstress.load_study reads one from a file",
            code="not-a-study",
        )
    names = select(study.table.pin, pins, "pin")
    chosen = chosen_cases(study, cases)
    requirement = requirement_of(study, require_model(model), require_tolerance(tolerance), memory)
    # A case with a low maximum may still damage a pin by its cycles.
    requirement = replace(requirement, every=study.table.fatigue is not None)
    wrong = Errors(study.path)
    published = wrong.attempt(lambda: read_published(study))
    loads = wrong.attempt(lambda: loads_of(study, chosen))
    shapes = {name: wrong.attempt(partial(pin_of, study, name)) for name in names}
    wrong.tell()
    assert published is not None
    assert loads is not None
    todo = tasks(study, [pin for pin in shapes.values() if pin is not None], loads)
    checked = _require_solvable(study, loads, todo, published, requirement.model)
    return Plan(
        study, requirement, loads, todo, published, checked, also, limit_load=limit_load,
        pins=tuple(names),
    )  # fmt: skip


def _require_solvable(
    study: Study,
    loads: dict[str, CaseLoads],
    todo: list[Task],
    published: Published,
    model: Model,
) -> Task | None:
    """Return the task whose pin the beam check compares, if any.

    Raises: InputError with all mistakes that would otherwise end a run after some of its solutions.
    """
    wrong = Errors(study.path)
    wrong.attempt(lambda: checks.motion_check(study, loads, published))
    wrong.attempt(lambda: published_values(study, loads, published))
    check, checked = study.table.beam_check, None
    if check is not None:
        choice = (t for t in todo if t.pin.name == check.pin and check.case in t.left_out)
        checked = next(choice, None)
        if checked is not None:
            wrong.attempt(partial(checks.require_cantilever, study, checked, check.case))
    wrong.attempt(lambda: require_models(study, todo, model))
    wrong.tell()
    return checked


def requirement_of(
    study: Study,
    model: Model | None = None,
    tolerance: float | None = None,
    memory: float | None = None,
) -> Requirement:
    """Return the requirement that a study places on a solution.

    model, tolerance, memory: as in `prepare`.
    """
    table = study.table.analysis
    return Requirement(
        tolerance or table.tolerance,
        model or table.model,
        table.goal,
        table.required_safety_factor,
        table.excluded_distance,
        memory=allowed_memory(require_positive("memory_limit", memory, endless=True)),
    )


def for_task(study: Study, task: Task, requirement: Requirement) -> Requirement:
    """Return a requirement with the joints and the required factors of a task."""
    factors = required_factors(study, task.pin.name, (loads.case for loads in task.loads))
    every = requirement.every or _needs_every_case(study, task)
    return replace(requirement, joints=_joints(study, task), factors=factors, every=every)


def needs_fine_cells(task: Task) -> bool:
    """Return whether contact needs fine cells in every case.

    The stress of lugs and of the parts of a hardened pin has no estimate of the error of the cells.
    """
    return bool(task.material.hardened) or any(lug.shank for lug in task.lugs)


def _needs_every_case(study: Study, task: Task) -> bool:
    """Return whether the maxima of minor cases are needed, too: for fine cells, or for requirements
    beyond a factor against yield.
    """
    if needs_fine_cells(task):
        return True
    pin, cases = task.pin.name, [loads.case for loads in task.loads]
    return any(asks_more_than_yield(study, pin, case) for case in cases)


def _joints(study: Study, task: Task) -> Joints:
    """Return the model of the joints by which lugs hold a pin."""
    joints = study.table.analysis.joints
    if joints == "contact" or joints == "foundation":
        return joints
    # A beam on foundations gives no pressure around the bores of lugs.
    if any(lug.shank for lug in task.lugs):
        return "contact"
    # A beam on foundations leaves out holes. Damage depends on the value of the stress, not only on
    # whether it is below a limit.
    return "auto" if task.pin.revolved and study.table.fatigue is None else "contact"

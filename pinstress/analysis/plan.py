"""What is to be solved of a study, every input read and found usable."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

from fea.core.memory import allowed_memory
from fea.core.requirement import Model, Requirement
from pinstress.analysis import checks
from pinstress.analysis.gather_fields import ExtraFields
from pinstress.analysis.published_quantities import published_values
from pinstress.study.model.cases import CaseLoads, case_loads
from pinstress.study.model.mechanism.linkage import determined, linkage
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.sequence import chosen_cases, require_times
from pinstress.study.model.tasks import Task, tasks
from pinstress.study.reading.choices import (
    require_model,
    require_positive,
    require_tolerance,
    select,
)
from pinstress.study.reading.errors import Errors, InputError
from pinstress.study.reading.file import Study
from pinstress.study.reading.published_tables import Published, read_published
from pinstress.study.schema.shown import as_text


def all_loads(study: Study, cases: list[str]) -> dict[str, CaseLoads]:
    """The reactions of every case, by name. Raises: InputError with what is wrong in any."""
    mechanism = linkage(study) if study.table.mechanism else None
    if mechanism is not None:
        determined(study, mechanism)  # once, not in every case
    wrong = Errors(study.path)
    attempts = {name: wrong.attempt(partial(case_loads, study, name, mechanism)) for name in cases}
    wrong.tell()
    loads = {name: loads for name, loads in attempts.items() if loads is not None}
    require_times(study, {name: case.reactions.times for name, case in loads.items()})
    return loads


@dataclass(frozen=True)
class Plan:
    """All that is known before anything is solved: every input is read and found usable.

    checked: the task whose pin the beam check compares, if any. also: which fields are wanted
    in addition to those of the model at the governing instant. sensitive: whether sensitivities of
    all cases are wanted, and not of each pin's worst one alone. limit_load: whether those of all
    rows that yield are, however long they take.
    """

    study: Study
    asked: Requirement
    loads: dict[str, CaseLoads]
    tasks: list[Task]
    published: Published
    checked: Task | None
    also: ExtraFields = None
    sensitive: bool = False
    limit_load: bool = False


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
) -> Plan:
    """Compute the reactions and prepare the pins for `solve`.

    pins, cases: names; all by default. model, tolerance: instead of the study's. memory: MB that a
    solid may take, by default most of what is free now. also: fields along the whole motion, or of
    all of a revolved pin. limit_load: find the limit load of every row that yields, however long it
    takes; otherwise as the study has it, where "auto" gives each 20 s of processor time.

    Raises: InputError for bad input.
    """
    if not isinstance(study, Study):
        raise InputError(
            f"{as_text(study)} is not a study; pinstress.load_study reads one from a file",
            code="not-a-study",
        )
    names = select(study.table.pin, pins, "pin")
    chosen = chosen_cases(study, cases)
    asked = requirement_of(study, require_model(model), require_tolerance(tolerance), memory)
    wrong = Errors(study.path)
    published = wrong.attempt(lambda: read_published(study))
    loads = wrong.attempt(lambda: all_loads(study, chosen))
    shapes = {name: wrong.attempt(partial(pin_of, study, name)) for name in names}
    wrong.tell()
    assert published is not None
    assert loads is not None
    checks.motion_check(study, loads, published)  # mistakes there should not wait for the stresses
    published_values(study, loads, published)
    todo = tasks(study, [pin for pin in shapes.values() if pin is not None], loads)
    check, checked = study.table.beam_check, None
    if check is not None:
        choice = (t for t in todo if t.pin.name == check.pin and check.case in t.left_out)
        checked = next(choice, None)
        if checked is not None:
            checks.require_cantilever(study, checked, check.case)
    for task in todo:
        if asked.model in ("beam", "harmonic") and not task.pin.revolved:
            raise study.error(
                f"pin {task.pin.name} is not a body of revolution, which the "
                f"{asked.model} model needs: use auto or solid",
                at=f"pin.{task.pin.name}",
                code="not-of-revolution",
            )
        if task.lugs:
            _require_model(study, asked.model, task.pin.name)
    return Plan(study, asked, loads, todo, published, checked, also, limit_load=limit_load)


def _require_model(study: Study, model: Model, pin: str) -> None:
    """Raises: InputError for a model that cannot answer for a pin in its lugs."""
    beam = study.table.analysis.joints == "foundation"
    how, fits = ("on foundations in", "beam") if beam else ("in contact with", "harmonic")
    if model not in ("auto", fits):
        raise study.error(
            f"pin {pin} is {how} its lugs, which requires the {fits} model: use auto or {fits}, "
            f'or analysis.joints = "prescribed" for the {model} model',
            at=f"pin.{pin}",
            code="model-without-contact",
        )


def requirement_of(
    study: Study,
    model: Model | None = None,
    tolerance: float | None = None,
    memory: float | None = None,
) -> Requirement:
    """What a study requests of a solution. model, tolerance, memory: as of `prepare`."""
    table = study.table.analysis
    return Requirement(
        tolerance or table.tolerance,
        model or table.model,
        table.goal,
        table.required_safety_factor,
        table.excluded_distance,
        memory=allowed_memory(require_positive("memory_limit", memory, endless=True)),
    )

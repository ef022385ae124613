"""The page that `check --open` draws of a checked study."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from pinbase.records import in_units
from pinstress.analysis.gather.gather import shape_of_task, units_of
from pinstress.analysis.mechanics.gather_motion import linkage_motion
from pinstress.analysis.mechanics.gather_space import skeleton_in_space
from pinstress.cli.check import Examination, support_of
from pinstress.cli.new_file import file_start
from pinstress.study.model.balance import given_warnings
from pinstress.study.model.tasks import Task
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.schema.landing import DropCase, GroundCase
from reports.data.check import CheckedPin, CheckedStudy, PlannedRow
from reports.format.numbers import DASH
from reports.page.check import write_check

HTML_HEAD = b"<!doctype html"


def require_page(path: Path) -> None:
    """Check that the path of a new page is free or has an earlier page.

    Raises: InputError.
    """
    start = file_start(path, "--out", len(HTML_HEAD))
    if start and start.lower() != HTML_HEAD:
        text = f"--out: {path} exists and is not a page; choose another file"
        raise InputError(text, code="exists")


def write_check_page(study: Study, examination: Examination, path: Path) -> None:
    """Write the page of a valid study.

    Raises: OSError.
    """
    first = {task.pin.name: task for task in reversed(examination.tasks)}
    in_si = CheckedStudy(
        title=study.table.title,
        study=study.path.name,
        units=units_of(study),
        summary=tuple(examination.lines[1:]),
        problems=(
            *examination.unheld,
            *examination.warnings,
            *given_warnings(study),
            *study.warnings,
        ),
        motions=tuple(
            linkage_motion(study, name, loads)
            for name, loads in examination.loads.items()
            if loads.dynamics is not None
        ),
        space=tuple(
            skeleton_in_space(study, name, loads.space)
            for name, loads in examination.loads.items()
            if loads.space is not None
        ),
        pins=tuple(
            CheckedPin(
                shape_of_task(first[name], ()),
                support_of(study, first[name].pin, first[name].clamps),
            )
            for name in study.table.pin
            if name in first
        ),
        rows=tuple(
            _row(study, task, k) for task in examination.tasks for k in range(len(task.loads))
        ),
        by_run=frozenset(filter(partial(_by_run, study), examination.loads)),
    )
    write_check(in_units(in_si, study.system.factor), path)


def _by_run(study: Study, name: str) -> bool:
    """Return whether only a run computes the forces of a case: a check does not simulate a drop."""
    case = study.table.case[name]
    return isinstance(case, DropCase) or (isinstance(case, GroundCase) and case.drop is not None)


def _row(study: Study, task: Task, k: int) -> PlannedRow:
    """Return the row of a task's case number k."""
    loads = task.loads[k]
    case = study.table.case[loads.case]
    by_run = _by_run(study, loads.case)
    sizes = np.linalg.norm(loads.forces, axis=2)
    at = int(sizes.max(axis=0).argmax())
    return PlannedRow(
        task.pin.name,
        loads.case,
        support_of(study, task.pin, task.clamps),
        _model(study, task),
        case.samples if isinstance(case, DropCase) else len(loads),
        None if by_run else float(sizes.max()),
        DASH if by_run else loads.surfaces[at],
    )


def _model(study: Study, task: Task) -> str:
    """Return the models that may solve a task, the quickest first."""
    table = study.table.analysis
    if table.model != "auto":
        return table.model
    if not task.pin.revolved:
        return "harmonic+local" if task.pin.cuts else "solid"
    return "beam" if task.lugs and table.joints == "foundation" else "beam or harmonic"

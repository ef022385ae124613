"""The outcome of a solved pin, the inputs on which it depends, and whether it may be stored for
other runs.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import inf

from assess.fatigue.records import PointHistory
from assess.opinion.records import BeamCheck
from fea.core.memory import too_much
from fea.core.peak import Maximum
from geometry import CutPin, Pin, PinLike
from loads import read_regular
from pinstress.analysis.assessed.limits import collapse_factors, lugs_asked, rung_of
from pinstress.analysis.plan import Plan, for_task
from pinstress.study.model.tasks import Task
from reports.data.changes import Remedy
from reports.data.fields import Field
from reports.data.row import PinResult
from reports.data.sensitivities import PinSensitivities
from reports.data.surface import Surface

# Tables whose keys appear in sensitivities, and whose defaults change with other dimensions.
DIMENSION_TABLES = "profile", "meridian", "bore_meridian", "band", "lug"


@dataclass(frozen=True)
class PinOutcome:
    """The solution of a task: a row for each of its cases, and the results of all cases.

    rows: in the order of the cases. Every run completes them again, as that takes little time and
    depends on more of the study (assessed.situations, gather).
    surfaces: the stress on the surface of the pin.
    histories: of the stress at the pin's critical points; no_histories: why there are none, if
    computing them failed.
    sensitivities: of the worst case, or of all.
    remedy: the change by which the pin reaches its factor, if it does not.
    beam_check: the comparison with a beam, if the study requests it for this pin.
    cached: whether the outcome comes from an earlier run.
    """

    rows: tuple[PinResult, ...]
    surfaces: tuple[Surface, ...] = ()
    histories: tuple[PointHistory, ...] = ()
    no_histories: str = ""
    sensitivities: tuple[PinSensitivities, ...] = ()
    remedy: Remedy | None = None
    beam_check: BeamCheck | None = None
    cached: bool = False


@dataclass(frozen=True)
class Entry:
    """The cached content for a task."""

    solved: PinOutcome
    fields: tuple[Field, ...]

    def answers(self, task: Task) -> bool:
        """Return whether the entry is of this pin and these cases, whose names the files get."""
        rows = [(task.pin.name, loads.case) for loads in task.loads]
        solved_rows = [(row.pin, row.case) for row in self.solved.rows]
        return solved_rows == rows and {(f.pin, f.case) for f in self.fields} <= set(rows)


def cache_key(plan: Plan, task: Task, seconds: float | None = None) -> object:
    """Return everything that the outcome of a task depends on, except versions and memory, as a
    value that pinbase.records packs.

    seconds: the time limit because of which the outcome lacks a limit load.
    """
    study, cases = plan.study, [plan.loads[loads.case] for loads in task.loads]
    check = study.table.beam_check if task is plan.checked else None
    return (
        shape_of(task.pin),
        study.table.pin[task.pin.name].model_dump(include=set(DIMENSION_TABLES)),
        task.clamps,
        task.lugs,
        task.surroundings,
        task.given,
        study.table.analysis.joints,
        study.table.fatigue is not None,
        rung_of(plan, task.pin.name),
        lugs_asked(plan, task),
        collapse_factors(study, task),
        task.loads,
        task.left_out,
        task.ranges,
        task.impulses,
        task.shanks,
        [(case.reactions.times, case.range) for case in cases],
        task.material,
        replace(for_task(study, task, plan.requirement), memory=None),
        plan.also,
        plan.sensitive,
        plan.explained,
        study.system,
        None if check is None else check.model_dump(),
        *(() if seconds is None else (seconds,)),
        *((task.shared,) if task.shared else ()),
    )


def shape_of(pin: PinLike) -> object:
    """Return a pin's shape, with the content of its file, as a value that pinbase.records packs."""
    if isinstance(pin, Pin | CutPin):
        return pin
    from geometry.imported.imported_pin import SolidBody
    from geometry.mesh.solid_mesh import MeshSize
    from pinstress.study.model.imported_pin import MAX_BODY_SIZE

    assert isinstance(pin, SolidBody)
    file = pin.file
    content = hashlib.sha256(read_regular(file.path, MAX_BODY_SIZE)).hexdigest()
    mesh = None
    if pin.meshed:  # some formats refer to other files, so the mesh that was read counts
        read = pin.mesh(MeshSize()).mesh
        mesh = read.doflocs, read.t, read.boundaries
    return file.name, file.path.suffix, file.unit, file.places, content, mesh


def independent_of_memory(plan: Plan, task: Task, peaks: Iterable[Maximum]) -> bool:
    """Return whether more memory would give the same outcome (memory limits the meshes of
    fea.solve.solve).
    """
    from fea.solve.refine import count_loads, sequence_of  # imports the models

    open_ = [
        (p, meshes)
        for p in peaks
        if (meshes := sequence_of(task.pin, p.model)) is not None
        and p.max_von_mises is not None
        and (p.own_error or inf) > plan.requirement.tolerance * p.max_von_mises
    ]
    if not open_:
        return True
    first, meshes = open_[0]
    if len(first.history) >= (plan.requirement.meshes or meshes.max_meshes):
        return True
    finer = meshes.unknowns_after(max(p.dofs for p, _ in open_))
    loads = count_loads(task.loads) if first.model == "harmonic" else 0
    return finer > meshes.max_unknowns or not too_much(finer, plan.requirement.memory, loads)

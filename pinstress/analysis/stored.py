"""Outcome of a solved pin, the inputs on which it depends, and whether it can be stored for other
runs.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from math import inf

from assess.fatigue.records import PointHistory
from assess.opinion.opinions import Opinion
from assess.opinion.records import BeamCheck
from assess.plastic.records import LimitLoad
from fea.core.memory import too_much
from fea.core.peak import Maximum
from fea.solve.refine import count_loads, sequence_of
from fea.support.records import JointResult
from geometry import CutPin, Pin, PinLike
from loads import read_regular
from pinstress.analysis.assessed.limits import rung_of
from pinstress.analysis.assessed.situations import Assessed
from pinstress.analysis.plan import Plan
from pinstress.study.model.tasks import Task
from reports.data.changes import Remedy
from reports.data.results import Field, LandingRange
from reports.data.sensitivities import PinSensitivities
from reports.data.surface import Surface

SHAPE_TABLES = "profile", "meridian", "bore_meridian", "band"  # whose keys sensitivities have


@dataclass(frozen=True)
class PinOutcome:
    """A task's peaks in the order of its cases, with the other results for reports and CalculiX.

    joints: in the same order, empty where nothing is in contact.
    change: the change by which the pin reaches its factor, if it does not.
    histories: of the stress at its critical points.
    before: whether it comes from an earlier run.
    limits: limit loads, in the order of the cases.
    sensitivities: of the worst case, or of all.
    no_histories: why there are no histories, if computing them failed.
    strength: in the order of the cases; computed by every run, as it takes little time and depends
    on more of the study.
    """

    peaks: tuple[Maximum, ...]
    landing: tuple[LandingRange, ...] = ()
    beam: BeamCheck | None = None
    surfaces: tuple[Surface, ...] = ()
    opinions: tuple[Opinion, ...] = ()
    joints: tuple[JointResult | None, ...] = ()
    change: Remedy | None = None
    histories: tuple[PointHistory, ...] = ()
    before: bool = False
    limits: tuple[LimitLoad | None, ...] = ()
    sensitivities: tuple[PinSensitivities, ...] = ()
    no_histories: str = ""
    strength: tuple[Assessed, ...] = ()


@dataclass(frozen=True)
class Entry:
    """The content of the cache for a task."""

    solved: PinOutcome
    fields: tuple[Field, ...]

    def answers(self, task: Task) -> bool:
        """Return whether the entry is of this pin in these cases, after which files are named."""
        rows = [(task.pin.name, loads.case) for loads in task.loads]
        solved_rows = [(p.pin, p.case) for p in self.solved.peaks]
        return solved_rows == rows and {(f.pin, f.case) for f in self.fields} <= set(rows)


def cache_key(plan: Plan, task: Task, seconds: float | None = None) -> object:
    """Return all that the answer to a task depends on, except versions and memory, as a value that
    pinstress.analysis.serialise packs.

    seconds: the time limit of an answer that lacks a limit load because of it.
    """
    study, cases = plan.study, [plan.loads[loads.case] for loads in task.loads]
    check = study.table.beam_check if task is plan.checked else None
    return (
        shape_of(task.pin),
        study.table.pin[task.pin.name].model_dump(include=set(SHAPE_TABLES)),
        task.clamps,
        task.lugs,
        task.surroundings,
        study.table.analysis.joints,
        rung_of(plan, task.pin.name),
        task.loads,
        task.left_out,
        task.ranges,
        task.impulses,
        [(case.reactions.times, case.range) for case in cases],
        task.material,
        replace(plan.requirement, memory=None),
        plan.also,
        plan.sensitive,
        study.system,
        None if check is None else check.model_dump(),
        *(() if seconds is None else (seconds,)),
    )


def shape_of(pin: PinLike) -> object:
    """Return a pin's shape, with the content of its file, as a value that
    pinstress.analysis.serialise packs.
    """
    if isinstance(pin, Pin | CutPin):
        return pin
    from geometry.imported.imported_pin import SolidBody
    from geometry.mesh.solid_mesh import MeshSize
    from pinstress.study.model.imported_pin import MAX_BODY_SIZE

    assert isinstance(pin, SolidBody)
    file = pin.file
    content = hashlib.sha256(read_regular(file.path, MAX_BODY_SIZE)).hexdigest()
    mesh = None
    if pin.meshed:  # some formats have other files beside them: what was read counts
        read = pin.mesh(MeshSize()).mesh
        mesh = read.doflocs, read.t, read.boundaries
    return file.name, file.path.suffix, file.unit, file.places, content, mesh


def independent_of_memory(plan: Plan, task: Task, peaks: tuple[Maximum, ...]) -> bool:
    """Return whether more memory would give the same answer (fea.solve.solve is limited by it)."""
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

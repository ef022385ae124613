"""What remains of a solved pin, what it depends on, and whether it can be kept for other runs."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from math import inf

from fea.ladder import MESHES, MOST_UNKNOWNS, unknowns_after
from fea.memory import too_much
from fea.peak import Peak
from fea.second_opinion import Opinion
from geometry import CutPin, Pin, PinLike
from pinstress.pins import material
from pinstress.plan import Plan
from pinstress.tasks import Task
from reports.results import BeamCheck, Field, LandingRange
from reports.surface import Surface


@dataclass(frozen=True)
class Solved:
    """A task's peaks in the order of its cases, and what else reports and CalculiX have to say.
    before: whether an earlier run found it.
    """

    peaks: tuple[Peak, ...]
    landing: tuple[LandingRange, ...] = ()
    beam: BeamCheck | None = None
    surface: Surface | None = None
    opinions: tuple[Opinion, ...] = ()
    before: bool = False


@dataclass(frozen=True)
class Entry:
    """What the cache has of a task."""

    solved: Solved
    fields: tuple[Field, ...]

    def answers(self, task: Task) -> bool:
        """Whether it is of this pin in these cases: files are named after them."""
        rows = [(task.pin.name, loads.case) for loads in task.loads]
        own = [(p.pin, p.case) for p in self.solved.peaks]
        return own == rows and {(f.pin, f.case) for f in self.fields} <= set(rows)


def question(plan: Plan, task: Task) -> object:
    """All that the answer to a task depends on, but for versions and memory, as what
    pinstress.packing takes.
    """
    study, cases = plan.study, [plan.loads[loads.case] for loads in task.loads]
    check = study.table.beam_check if task is plan.checked else None
    return (
        _shape(task.pin),
        task.clamps,
        task.loads,
        task.left_out,
        task.ranges,
        [(case.reactions.times, case.range) for case in cases],
        material(study, study.table.pin[task.pin.name].material),
        replace(plan.asked, memory=None),
        plan.also,
        study.system,
        None if check is None else check.model_dump(),
    )


def _shape(pin: PinLike) -> object:
    if isinstance(pin, Pin | CutPin):
        return pin
    from geometry.solid_body import SolidBody
    from geometry.solid_mesh import MeshSize

    assert isinstance(pin, SolidBody)
    file = pin.file
    content = hashlib.sha256(file.path.read_bytes()).hexdigest()
    mesh = None
    if pin.meshed:  # some formats have other files beside them: what was read counts
        read = pin.mesh(MeshSize()).mesh
        mesh = read.doflocs, read.t, read.boundaries
    return file.name, file.path.suffix, file.unit, file.places, content, mesh


def lasting(plan: Plan, task: Task, peaks: tuple[Peak, ...]) -> bool:
    """Whether more memory would not have given another answer (fea.ladder stops there)."""
    open_ = [
        p
        for p in peaks
        if p.model == "solid"
        and p.max_von_mises is not None
        and (p.error_estimate or inf) > plan.asked.tolerance * p.max_von_mises
    ]
    if not open_ or len(open_[0].history) >= (plan.asked.meshes or MESHES["solid"]):
        return True
    finer = unknowns_after(task.pin, "solid", max(p.dofs for p in open_))
    return finer > MOST_UNKNOWNS["solid"] or not too_much(finer, plan.asked.memory)

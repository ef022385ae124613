"""Outcomes of the pins of a design against their required factor, judged as in a run.

Only a run considers the range over the joint of a pin with prescribed loads: the solution of a beam
in assumed lugs takes longer than the pin itself. Such a pin is at most "safe as described" here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from assess.judgement import DEPENDS, against_yield
from fea.core.peak import Maximum
from fea.support.support import Solution
from pinbase.records import in_units
from pinstress.analysis.gather.gather_landing import landing_range, sharing_range
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.lost_fits import lost_fits
from pinstress.study.model.requirements import required_factor
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from pinstress.study.schema.units import UnitSystem
from reports.data.curve import AS_DESCRIBED
from reports.data.dependence import depends_on
from reports.data.row import PinResult, Units
from reports.format.words import depends_words


def bare_row(task: Task, solution: Solution, loads: Mapping[str, CaseLoads]) -> PinResult:
    """Return the row of one solution of a task, without meshes, zones, edges or cells. It does not
    depend on the strength, so it can be reused for any strength.
    """
    peak, joint = solution.peak, solution.joint
    joint = joint and replace(joint, along=None, bending_moments=())
    places = peak.places
    if places is not None and places.contact is not None:
        places = replace(places, contact=replace(places.contact, edges=(), bands=()))
    peak = replace(peak, history=(), singular_at=(), places=places)
    landing, sharing = landing_range(loads, task, solution), sharing_range(task, solution)
    return PinResult(peak, joint=joint, landing=landing, sharing=sharing)


def judged_row(row: PinResult, task: Task, study: Study) -> PinResult:
    """Return a row with its judgement and the ranges on which that depends.

    study: the study of the design.
    """
    required = required_factor(study, row.pin, row.case)
    row = replace(
        row,
        judgement=against_yield(row.maximum, task.material.yield_strength, required),
        strength_range=task.material.strength_range,
        lost_fits=lost_fits(study, task, row.case),
    )
    return replace(row, depends_on=depends_on(row))


def outcome_words(row: PinResult, task: Task, system: UnitSystem) -> tuple[str, str]:
    """Return the outcome, and in words and in the units of a study, what the outcome depends on."""
    if row.outcome == DEPENDS:
        units = Units(system.length, system.force, system.stress, system.time)
        return DEPENDS, depends_words([in_units(d, system.factor) for d in row.depends_on], units)
    joint_open = task.surroundings is not None and task.surroundings.pin is not None
    return (f"{row.outcome} {AS_DESCRIBED}" if row.decided and joint_open else row.outcome), ""


def stress_at(peak: Maximum) -> tuple[float | None, float | None, float | None, float | None]:
    """Return the largest stress of the surface, of the sections and beneath contact, and the error
    of the last, Pa; None where there is none.
    """
    places = peak.places
    section, contact = (places.section, places.contact) if places else (None, None)
    return (
        places.surface.max_von_mises if places else None,
        section.max_von_mises if section else None,
        contact.beneath if contact else None,
        contact.beneath_error if contact else None,
    )

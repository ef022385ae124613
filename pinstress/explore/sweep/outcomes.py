"""Outcomes of the pins of a design against their factor, judged as a run judges them.

Only a run considers the range over the joint of a pin with prescribed loads, a beam in assumed lugs
that takes longer than the pin itself. Such a pin is at most "safe as described".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from assess.judgement import against_yield
from fea.core.peak import Maximum
from fea.support.records import JointResult
from fea.support.support import Solution
from pinstress.analysis.gather.gather import landing_range
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.tasks import Task
from pinstress.study.schema.units import UnitSystem
from reports.data.decision import DEPENDS, in_words
from reports.data.dependence import Judged, dependences
from reports.data.in_units import in_units
from reports.data.results import LandingRange, Units
from reports.format.words import depends_words

AS_DESCRIBED = "as described"


@dataclass(frozen=True)
class DesignAnswer:
    """The remembered answer of a solved pin in a case: no meshes, zones, edges or cells."""

    peak: Maximum
    joint: JointResult | None
    landing: LandingRange | None


def bare_answer(task: Task, solution: Solution, loads: Mapping[str, CaseLoads]) -> DesignAnswer:
    """Return the remembered answer for one solution of a task."""
    peak, joint = solution.peak, solution.joint
    joint = joint and replace(joint, along=None, bending_moments=())
    places = peak.places
    if places is not None and places.contact is not None:
        places = replace(places, contact=replace(places.contact, edges=(), bands=()))
    peak = replace(peak, history=(), singular_at=(), places=places)
    return DesignAnswer(peak, joint, landing_range(loads, task, solution))


def outcome_of(
    answer: DesignAnswer, task: Task, required: float | None, system: UnitSystem
) -> tuple[str, str]:
    """Return the outcome, and in words, in the units of a study, what it depends on."""
    strength, around = task.material.yield_strength, task.surroundings
    peak, decided = answer.peak, against_yield(answer.peak, strength, required).decided
    outcome = in_words(decided, required)
    if not decided or strength is None or not peak.max_von_mises:
        return outcome, ""
    permitted = strength / (required or 1.0)
    judged = Judged(peak.lower_end, peak.max_von_mises, peak.upper_end, strength, permitted, True)
    contact = peak.places.contact if peak.places else None
    if on := dependences(judged, contact, answer.joint, answer.landing):
        units = Units(system.length, system.force, system.stress, system.time)
        dependences_in_units = [in_units(d, system.factor) for d in on]
        return DEPENDS, depends_words(dependences_in_units, units)
    joint_open = around is not None and around.pin is not None
    return (f"{outcome} {AS_DESCRIBED}" if joint_open else outcome), ""


def stress_at(peak: Maximum) -> tuple[float | None, float | None, float | None, float | None]:
    """Return the largest stress of surface and section and beneath contact, this with its error,
    Pa.
    """
    places = peak.places
    section, contact = (places.section, places.contact) if places else (None, None)
    return (
        places.surface.max_von_mises if places else None,
        section.max_von_mises if section else None,
        contact.beneath if contact else None,
        contact.beneath_error if contact else None,
    )

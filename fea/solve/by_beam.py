"""A case of a pin by the beam model."""

from __future__ import annotations

import time

from fea.beam.model import BeamField
from fea.core.over_time import rise_between, through_time
from fea.core.peak import NO_REASON, Reason
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.support.support import HeldPin, PinProblem, Solution, StressReading
from geometry import body_of_revolution


def by_beam(
    held: HeldPin,
    problem: PinProblem,
    case: PinLoads,
    requirement: Requirement,
    remark: Reason = NO_REASON,
) -> Solution:
    """The solution of a case by the beam model, with its own error.

    remark: appended to its note.
    """
    start, rise, pin = time.perf_counter(), 0.0, body_of_revolution(held.pin)
    assert pin is not None
    remarks = held.notes.get(case.case, NO_REASON) + remark
    loads = held.start(case.case)
    field = BeamField(pin, problem.material, held.clamps, loads)
    if between := problem.between.get(case.case):
        loads = through_time(field, loads, between, requirement.tolerance)
        rise = rise_between(field, loads, between)
        field = BeamField(pin, problem.material, held.clamps, loads)
    instant, spent = field.estimate.instant, time.perf_counter() - start
    reading = StressReading(field.evidence(spent, remarks, rise), field, loads, instant)
    return held.finished(reading, requirement)

"""Fields of pins, from SI to plain data in the study's units."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from fea.answer import Answer
from fea.harmonic_look import HarmonicAnswer
from fea.ladder import Solution
from fea.peak import Peak
from fea.pin_loads import PinLoads
from fea.revolved import revolve_solid
from fea.tensor import von_mises
from pinstress.build import CaseLoads
from pinstress.pins import material as material_of
from pinstress.study import Study
from pinstress.tasks import Task
from reports import results as plain

Also = Literal["motion", "solid"] | None
STILLS = 50  # of a motion, besides the governing instant


def field(
    study: Study, task: Task, solution: Solution, case: CaseLoads, also: Also = None
) -> plain.Field | None:
    """A pin's field at its governing instant; None if not solved, or if the model has none.

    also: with the other instants, at most STILLS of them, or with all of a revolved pin.
    """
    peak, unit = solution.peak, study.system.factor
    loads = next(x for x in task.loads if x.case == peak.case)
    shown = solution.answer.picture(loads, peak.instant) if solution.answer else None
    if solution.answer is None or shown is None:
        return None
    strength = material_of(study, study.table.pin[peak.pin].material).yield_strength
    stress = shown.stress / unit("stress")
    times = case.reactions.times
    return plain.Field(
        pin=peak.pin,
        case=peak.case,
        points=shown.points / unit("length"),
        cells=shown.cells,
        displacement=shown.displacement / unit("length"),
        stress=stress,
        von_mises=von_mises(stress),
        envelope=shown.envelope / unit("stress"),
        cell_type=shown.cell_type,
        yield_strength=None if strength is None else strength / unit("stress"),
        outside=_outside(study, peak),
        verdict=peak.verdict,
        time=None if times is None else float(times[peak.instant]),
        loads=_bands(study, task, loads, peak.instant),
        stills=()
        if times is None or also != "motion"
        else tuple(
            _still(study, task, solution.answer, loads, i, float(times[i]))
            for i in instants(len(loads), peak.instant)
        ),
        volume=_volume(study, solution.answer, loads, peak.instant) if also == "solid" else None,
    )


def _volume(study: Study, answer: Answer, loads: PinLoads, instant: int) -> plain.Volume | None:
    """All of a revolved pin; a solid model's field has it already."""
    if not isinstance(answer, HarmonicAnswer):
        return None
    unit, shown = study.system.factor, revolve_solid(answer.fields, loads, instant)
    stress = shown.stress / unit("stress")
    return plain.Volume(
        shown.points / unit("length"),
        shown.cells,
        shown.cell_type,
        shown.displacement / unit("length"),
        stress,
        von_mises(stress),
    )


def instants(count: int, governing: int) -> list[int]:
    """At most STILLS of `count` instants, evenly, and the governing one."""
    even = np.linspace(0, count - 1, min(count, STILLS)).round().astype(int)
    return sorted({*even.tolist(), governing})


def _still(
    study: Study, task: Task, answer: Answer, loads: PinLoads, instant: int, time: float
) -> plain.Still:
    unit = study.system.factor
    one = slice(instant, instant + 1)
    alone = replace(
        loads, forces=loads.forces[one], moments=loads.moments[one], body=loads.body[one]
    )
    shown = answer.picture(alone, 0)  # whose envelope is then of this instant only
    assert shown is not None
    return plain.Still(
        time,
        (shown.displacement / unit("length")).astype(np.float32),
        (von_mises(shown.stress) / unit("stress")).astype(np.float32),
        _bands(study, task, loads, instant),
    )


def _bands(study: Study, task: Task, loads: PinLoads, instant: int) -> tuple[plain.BandLoad, ...]:
    """Every band on which a link bears; those that are held carry no load here."""
    unit = study.system.factor
    out = []
    for name in (*loads.surfaces, *task.left_out[loads.case]):
        band, held = task.pin.band(name), name not in loads.surfaces
        force, moment = np.zeros(3), np.zeros(3)
        if not held:
            c = loads.surfaces.index(name)
            force = loads.forces[instant, c] / unit("force")
            moment = loads.moments[instant, c] / unit("energy")
        ends = (band.z0 / unit("length"), band.z1 / unit("length"))
        radius = band.radius / unit("length")
        out.append(plain.BandLoad(name, ends, radius, force, moment, held))
    return tuple(out)


def _outside(study: Study, peak: Peak) -> tuple[float, tuple[float, float, float]] | None:
    if peak.verdict != "singular" or peak.max_von_mises is None or peak.location is None:
        return None
    unit = study.system.factor
    x, y, z = (a / unit("length") for a in peak.location)
    return peak.max_von_mises / unit("stress"), (x, y, z)

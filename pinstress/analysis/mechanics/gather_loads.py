"""Results of the mechanics for reports, gathered in SI units from the dynamics."""

from __future__ import annotations

from typing import Any

import numpy as np

from loads import Dynamics, Slider, energy
from pinbase.arrays import Floats
from pinstress.analysis.checks import motion_check
from pinstress.analysis.mechanics.gather_drops import drop_record
from pinstress.analysis.mechanics.gather_motion import linkage_motion
from pinstress.analysis.mechanics.gather_sequences import sequence_tables
from pinstress.analysis.mechanics.gather_space import (
    bodies_in_space,
    drives,
    drives_in_space,
    note_in_space,
    positions_in_space,
    posture_in_space,
    shown_positions,
    skeleton_in_space,
)
from pinstress.analysis.mechanics.gather_wear import wear
from pinstress.analysis.published_quantities import published_values
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.mechanism.drives import drive_tables, mechanism_of
from pinstress.study.model.mechanism.space import place, space_mechanism
from pinstress.study.reading.file import Study
from pinstress.study.reading.published_tables import Published
from pinstress.study.schema.landing import GroundCase
from reports.data.mechanics import DriveTable, PeakReaction, ReactionTable, WheelLoad


def mechanics(study: Study, loads: dict[str, CaseLoads], published: Published) -> dict[str, Any]:
    """Return the parts of Results that follow without stresses."""
    dynamics = {n: c.dynamics for n, c in loads.items() if c.dynamics is not None}
    parts = {
        "reactions": tuple(_reactions(study, n, c, published) for n, c in loads.items()),
        "drive": (
            *(t for n, d in dynamics.items() for t in _drives(study, n, d, loads[n])),
            *(t for n, c in loads.items() if c.space for t in drives_in_space(study, n, c.space)),
        ),
        "motion": tuple(linkage_motion(study, n, loads[n]) for n in dynamics),
        "space": tuple(skeleton_in_space(study, n, c.space) for n, c in loads.items() if c.space),
        "space_postures": tuple(
            posture_in_space(study, n, c.space) for n, c in loads.items() if c.space
        ),
        "motion_check": motion_check(study, loads, published),
        "published": published_values(study, loads, published),
        "drops": tuple(drop_record(study, n, c) for n, c in loads.items() if c.landing),
        "wear": wear(study, loads),
        "bodies": tuple(
            t for n, c in loads.items() if c.space for t in bodies_in_space(study, n, c.space)
        ),
    }
    return parts | sequence_tables(study, parts)


def _actuators(dynamics: Dynamics) -> list[tuple[str, bool]]:
    """Return the name of every actuator, and whether it slides."""
    return [(actuator.name, isinstance(actuator, Slider)) for actuator in dynamics.actuators]


def _drive_positions(study: Study, dynamics: Dynamics) -> Floats:
    """Return the displayed positions (T, A) of the actuators."""
    return shown_positions(study, dynamics.course[0], _actuators(dynamics))


def drive_position(study: Study, case: CaseLoads) -> Floats | None:
    """Return the position (T,) of the drive along a motion; None unless there is exactly
    one drive.
    """
    dynamics = case.dynamics
    if case.space is not None and case.reactions.times is not None:
        shown = positions_in_space(study, case.space)
        return shown[:, 0] if shown.shape[1] == 1 else None
    if dynamics is None or case.reactions.times is None or dynamics.drive.shape[1] != 1:
        return None
    return _drive_positions(study, dynamics)[:, 0]


def position_unit(study: Study, case: CaseLoads) -> str:
    """Return the unit of `drive_position`: "deg", or empty for a length."""
    if drive_position(study, case) is None:
        return ""
    if case.space is not None:
        return "" if drive_tables(study)[0].slides else "deg"
    if case.dynamics is None:
        return ""
    (drive,) = case.dynamics.actuators
    return "" if isinstance(drive, Slider) else "deg"


def _reactions(study: Study, name: str, case: CaseLoads, published: Published) -> ReactionTable:
    r, dynamics = case.reactions, case.dynamics or (case.space and case.space.dynamics)
    on = {c: p for p in study.table.pin for c in study.connections(p)}
    return ReactionTable(
        case=name,
        times=r.times,
        position=drive_position(study, case),
        connections=r.connections,
        bodies=r.bodies,
        pins=tuple(on.get(c, "") for c in r.connections),
        forces=r.forces,
        moments=r.moments,
        shared=tuple(c for c in dynamics.shared if c in r.connections) if dynamics else (),
        published={c: f for (k, c), f in published.reactions.items() if k == name},
        note=case.note if case.space is None else note_in_space(study, case.space),
        peaks=_peaks(study, case),
        turn=r.turn,
        position_unit=position_unit(study, case),
        unresolved=_pairs(case.peaks.unresolved) if case.peaks else (),
        clause=case.ground.clause if case.ground else "",
        wheel_loads=_wheel_loads(study, name, case),
    )


def _wheel_loads(study: Study, name: str, case: CaseLoads) -> tuple[WheelLoad, ...]:
    """Return the factors and references that the ground forces are products of, each at its point
    of application, found from the position of the axle in the case.
    """
    of = study.table.case[name]
    if case.ground is None or not isinstance(of, GroundCase):
        return ()
    if case.space is not None:
        drawn = place(space_mechanism(study), of.at)
        x, y, z = case.space.dynamics.motion.place(of.body, drawn)[0].tolist()
    elif case.dynamics is not None:
        x, y = case.dynamics.motion.joint(of.joint)[0][0].tolist()
        z = mechanism_of(study).joint[of.joint].z or 0.0
    else:
        return ()
    return tuple(
        WheelLoad(
            force.component,
            force.factor,
            force.reference,
            force.factor * force.reference,
            force.towards,
            force.direction,
            force.place,
            (x + force.arm[0], y + force.arm[1], z + force.arm[2]),
        )
        for force in case.ground.forces
    )


def _peaks(study: Study, case: CaseLoads) -> tuple[PeakReaction, ...]:
    if case.peaks is None:
        return ()
    peaks = case.peaks
    position = _positions_at(study, case, [peak.time for peak in peaks.force.values()])
    return tuple(
        PeakReaction(
            name,
            peak.value,
            peak.time,
            tuple(peaks.vector[name].tolist()),
            position[c],
            peaks.moment[name].value,
            None if case.frictionless is None else case.frictionless.peaks.force[name].value,
        )
        for c, (name, peak) in enumerate(peaks.force.items())
    )


def _positions_at(study: Study, case: CaseLoads, times: list[float]) -> list[float | None]:
    """Return the position of the drive at each time (s); None unless there is exactly one drive."""
    if drive_position(study, case) is None:
        return [None] * len(times)
    if case.solve_space is not None:
        shown = positions_in_space(study, case.solve_space(np.array(times)))
    elif case.solve is not None:
        shown = _drive_positions(study, case.solve(np.array(times)))
    else:
        return [None] * len(times)
    return [float(position) for position in shown[:, 0]]


def _pairs(values: Floats) -> tuple[tuple[float, float], ...]:
    return tuple((float(low), float(high)) for low, high in values)


def _drives(study: Study, name: str, dynamics: Dynamics, case: CaseLoads) -> list[DriveTable]:
    stored, (_, speeds, rates) = energy(dynamics.motion), dynamics.course
    over, smooth = case.over, case.frictionless
    return drives(
        name,
        _actuators(dynamics),
        dynamics.reactions.times,
        (_drive_positions(study, dynamics), speeds, rates),
        (dynamics.drive, dynamics.power),
        (stored.kinetic, stored.potential),
        over.drives if over else None,
        smooth.drives if smooth else None,
    )

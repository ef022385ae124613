"""Results of the mechanics for reports, gathered in SI from the dynamics."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from loads import (
    GROUND,
    Applied,
    Dynamics,
    Effort,
    Gear,
    Linkage,
    Motion,
    OverTime,
    Rack,
    Slider,
    Teeth,
    energy,
    ledger,
)
from loads.linkage.linkage import Point
from loads.motion.loop_equations import pairs
from loads.motion.mobility import is_particle
from loads.motion.transmission_angles import transmission_angles
from pinbase.arrays import Floats
from pinstress.analysis.checks import motion_check
from pinstress.analysis.mechanics.gather_drops import drop_record
from pinstress.analysis.mechanics.gather_sequences import sequence_tables
from pinstress.analysis.mechanics.gather_wear import wear
from pinstress.analysis.published_quantities import published_values
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.mechanism.drives import offsets
from pinstress.study.model.mechanism.linkage import ground_joint
from pinstress.study.reading.file import Study
from pinstress.study.reading.published_tables import Published
from reports.data import results as plain
from reports.data.mechanics import AppliedForce, PitchCurve

LEG_VECTORS = {  # of loads.LegDynamics, and what they are
    "wheel_omega": "omega",
    "wheel_alpha": "alpha",
    "v_C": "v",
    "v_D": "v",
    "a_C": "a",
    "a_D": "a",
    "coriolis_C": "a",
    "p_leg": "p",
    "p_leg_rate": "p_rate",
    "p_wheel": "p",
    "p_wheel_rate": "p_rate",
    "L_leg": "L",
    "L_leg_rate": "L_rate",
    "L_wheel": "L",
    "L_wheel_rate": "L_rate",
    "F_B": "p_rate",
    "M_B": "L_rate",
}


LEG_DIMENSIONS = {
    "omega": "rad/s",
    "alpha": "rad/s^2",
    "v": "velocity",
    "a": "acceleration",
    "p": "force time",
    "p_rate": "force",
    "L": "force length time",
    "L_rate": "energy",
}
LEG_SCALARS = ("actuator", "spin_moment", "kinetic_energy")


def mechanics(study: Study, loads: dict[str, CaseLoads], published: Published) -> dict[str, Any]:
    """Return the parts of plain.Results that need no stresses."""
    dynamics = {n: c.dynamics for n, c in loads.items() if c.dynamics is not None}
    parts = {
        "reactions": tuple(_reactions(study, n, c, published) for n, c in loads.items()),
        "drive": tuple(t for n, d in dynamics.items() for t in _drives(study, n, d, loads[n])),
        "motion": tuple(linkage_motion(study, n, d, loads[n].over) for n, d in dynamics.items()),
        "motion_check": motion_check(study, loads, published),
        "published": published_values(study, loads, published),
        "drops": tuple(drop_record(study, n, c) for n, c in loads.items() if c.landing),
        "wear": wear(study, loads),
        "legs": tuple(_leg(study, n, c) for n, c in loads.items() if c.leg is not None),
    }
    return parts | sequence_tables(study, parts)


def _drive_positions(study: Study, dynamics: Dynamics) -> Floats:
    """Return the displayed positions (T, A): lengths less their offsets, angles in degrees."""
    shown, less = dynamics.course[0], offsets(study)
    for k, actuator in enumerate(dynamics.actuators):
        if isinstance(actuator, Slider):
            shown[:, k] = shown[:, k] - less.get(actuator.name, 0.0)
        else:
            shown[:, k] = np.degrees(shown[:, k])
    return shown


def drive_position(study: Study, case: CaseLoads) -> Floats | None:
    """Return the position (T,) of the only drive along a motion; None unless there is one."""
    dynamics = case.dynamics
    if dynamics is None or case.reactions.times is None or dynamics.drive.shape[1] != 1:
        return None
    return _drive_positions(study, dynamics)[:, 0]


def position_unit(study: Study, case: CaseLoads) -> str:
    """Return the unit of `drive_position`: "deg", or empty for a length."""
    if drive_position(study, case) is None or case.dynamics is None:
        return ""
    (drive,) = case.dynamics.actuators
    return "" if isinstance(drive, Slider) else "deg"


def _reactions(
    study: Study, name: str, case: CaseLoads, published: Published
) -> plain.ReactionTable:
    r, dynamics = case.reactions, case.dynamics
    on = {c: p for p in study.table.pin for c in study.connections(p)}
    return plain.ReactionTable(
        case=name,
        times=r.times,
        position=drive_position(study, case),
        connections=r.connections,
        bodies=r.bodies,
        pins=tuple(on.get(c, "") for c in r.connections),
        forces=r.forces,
        moments=r.moments,
        shared=dynamics.shared if dynamics else (),
        published={c: f for (k, c), f in published.reactions.items() if k == name},
        note=case.note,
        peaks=_peaks(study, case),
        turn=r.turn,
        position_unit=position_unit(study, case),
        unresolved=_pairs(case.peaks.unresolved) if case.peaks else (),
    )


def _peaks(study: Study, case: CaseLoads) -> tuple[plain.PeakReaction, ...]:
    if case.peaks is None:
        return ()
    peaks = case.peaks
    position: list[float | None] = [None] * len(peaks.force)
    if drive_position(study, case) is not None and case.solve is not None:
        dynamics = case.solve(np.array([peak.time for peak in peaks.force.values()]))
        position = list(_drive_positions(study, dynamics)[:, 0].tolist())
    return tuple(
        plain.PeakReaction(
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


def _pairs(values: Floats) -> tuple[tuple[float, float], ...]:
    return tuple((float(low), float(high)) for low, high in values)


def _drives(study: Study, name: str, dynamics: Dynamics, case: CaseLoads) -> list[plain.DriveTable]:
    motion = dynamics.motion
    stored, shown = energy(motion), _drive_positions(study, dynamics)
    power, (_, speeds, rates) = dynamics.power, dynamics.course
    tables = []
    for k, actuator in enumerate(dynamics.actuators):
        slides = isinstance(actuator, Slider)
        effort = None if case.over is None else case.over.drives[k]
        free = None if case.frictionless is None else case.frictionless.drives[k].largest.value
        tables.append(
            plain.DriveTable(
                case=name,
                name=actuator.name,
                kind="slider" if slides else "rotary",
                time=dynamics.reactions.times,
                position=shown[:, k],
                velocity=speeds[:, k],
                acceleration=rates[:, k],
                force=dynamics.drive[:, k],
                power=power[:, k],
                work=np.zeros(len(motion)) if effort is None else effort.work,
                kinetic_energy=stored.kinetic,
                potential_energy=stored.potential - stored.potential[0],
                effort=None if effort is None else _effort(effort, slides, free),
            )
        )
    return tables


def _effort(effort: Effort, slides: bool, frictionless: float | None) -> plain.DriveEffort:
    return plain.DriveEffort(
        effort.largest.value,
        effort.largest.time,
        effort.mean,
        effort.rms,
        effort.power.value,
        effort.power.time,
        effort.stroke if slides else float(np.degrees(effort.stroke)),
        frictionless,
    )


def _extremes(over: OverTime) -> plain.Extremes:
    return plain.Extremes(
        {
            f"{link} at {joint}": (float(np.degrees(low.value)), low.time)
            for (link, joint), low in over.transmission.items()
        },
        (over.condition.value, over.condition.time),
    )


def linkage_motion(
    study: Study, name: str, dynamics: Dynamics, over: OverTime | None
) -> plain.LinkageMotion:
    """Return the motion of the linkage in a case, SI.

    over: results of the whole motion, if they are known.
    """
    motion, linkage = dynamics.motion, dynamics.motion.linkage
    timed = dynamics.reactions.times is not None
    bodies = [b.name for b in linkage.bodies]
    centre, velocity, acceleration = (pairs(z[:, : len(bodies)]) for z in motion.centres)
    joints = list(motion.joints())
    joints += [motion.point(t.carrier, t.at) for t in linkage.teeth]
    at, v, a = (np.stack([j[k] for j in joints], axis=1) for k in range(3))
    about = ground_joint(linkage)
    force, moment = dynamics.shaking(linkage.joint(about).at)
    return plain.LinkageMotion(
        case=name,
        time=motion.times if timed else None,
        bodies=tuple(bodies),
        links=tuple(_joints_to_draw(linkage, b) for b in bodies),
        centre=centre,
        velocity=velocity,
        acceleration=acceleration,
        angle=np.stack([_direction(dynamics, b) for b in bodies], axis=1),
        angular_velocity=np.stack([motion.angular_velocity(b) for b in bodies], axis=1),
        angular_acceleration=np.stack([motion.angular_acceleration(b) for b in bodies], axis=1),
        joints=(*(j.name for j in linkage.joints), *(t.name for t in linkage.teeth)),
        ground=tuple(
            j.name
            for j in linkage.joints
            if j.fixed_in == GROUND or any(c.body == GROUND for c in j.connections)
        ),
        joint_position=at,
        joint_velocity=v,
        joint_acceleration=a,
        slides={
            s.name: np.stack(
                [motion.point(s.base, s.start)[0], motion.point(s.moving, s.end)[0]], axis=1
            )
            for s in linkage.sliders
        },
        connections=(
            *((c.name, c.body, j.name) for j, c in linkage.connections),
            *((t.name, t.bodies[0], t.name) for t in linkage.teeth),
        ),
        transmission={
            f"{link} at {joint}": np.degrees(angle)
            for (link, joint), angle in transmission_angles(motion).items()
        },
        condition=motion.condition,
        shaking_force=force,
        shaking_moment=moment,
        shaking_about=about,
        ledger=_ledger(dynamics, over),
        extremes=None if over is None else _extremes(over),
        slider_forces=_slider_forces(dynamics),
        paths=_paths(study, dynamics),
        pitch=_pitch_curves(motion),
        applied=_applied(dynamics),
    )


def _applied(dynamics: Dynamics) -> tuple[AppliedForce, ...]:
    """Return the forces that the case applies, without springs and loads that are couples alone."""
    loads = [load for load in dynamics.applied if isinstance(load, Applied)]
    forces = (
        AppliedForce(
            load.body,
            dynamics.motion.point(load.body, load.at)[0],
            pairs(load.along(dynamics.motion)[:, None])[:, 0],
        )
        for load in loads
    )
    return tuple(force for force in forces if force.force.any())


def _paths(study: Study, dynamics: Dynamics) -> dict[str, plain.PointPath]:
    mechanism, motion = study.table.mechanism, dynamics.motion
    assert mechanism is not None
    paths = {}
    for name, point in mechanism.point.items():
        at = point.at if not isinstance(point.at, str) else motion.linkage.joint(point.at).at
        position, velocity, _ = motion.point(point.body, at)
        speed = np.linalg.norm(velocity, axis=1)
        curvature = motion.curvature(point.body, at)
        paths[name] = plain.PointPath(position, velocity, speed, curvature)
    return paths


def _ledger(dynamics: Dynamics, over: OverTime | None) -> plain.PowerLedger:
    powers = ledger(dynamics)
    return plain.PowerLedger(
        drives=powers.drives,
        gravity=powers.gravity,
        applied=powers.applied,
        friction=powers.friction,
        kinetic_rate=powers.kinetic_rate,
        violation=powers.violation if over is None else over.violation,
    )


def _slider_forces(dynamics: Dynamics) -> dict[str, plain.GuideForces]:
    sliders = dynamics.sliders
    return {
        s.name: plain.GuideForces(
            sliders.normal[:, k], sliders.couple[:, k], sliders.friction[:, k]
        )
        for k, s in enumerate(dynamics.motion.linkage.sliders)
    }


def _leg(study: Study, name: str, case: CaseLoads) -> plain.LegTable:
    leg, times = case.leg, case.reactions.times
    assert leg is not None
    assert times is not None

    def quantity(key: str, dimension: str) -> plain.Dimensioned:
        return plain.Dimensioned(getattr(leg, key), dimension, study.system.unit(dimension))

    beta = plain.Dimensioned(np.degrees(leg.motion.beta), "degrees", "deg")
    axes = "x' to the aircraft's right, y' ahead, z' up from the slope"
    return plain.LegTable(
        name,
        times,
        {key: quantity(key, LEG_DIMENSIONS[kind]) for key, kind in LEG_VECTORS.items()},
        {"beta": beta, **{key: quantity(key, "energy") for key in LEG_SCALARS}},
        axes,
    )


def _joints_to_draw(linkage: Linkage, body: str) -> tuple[str, ...]:
    """Return the joints on a body, around their middle so that lines between them do not cross."""
    joints = linkage.joints_on(body)
    at = np.array([complex(*j.at) for j in joints])
    if len(joints) < 4:
        return tuple(j.name for j in joints)
    return tuple(joints[i].name for i in np.argsort(np.angle(at - at.mean()), kind="stable"))


def _direction(dynamics: Dynamics, body: str) -> Floats:
    """Return the direction of a body (T,), degrees from x; NaN for a particle.

    It is that of the line from the body's first joint to its second. With fewer joints it is the
    direction of the body's slider, or else the rotation since the drawing.
    """
    motion, linkage = dynamics.motion, dynamics.motion.linkage
    joints = linkage.joints_on(body)
    lines = [s.axis for s in linkage.sliders if body in (s.base, s.moving)]
    if len(joints) > 1:
        lines = [(joints[1].at[0] - joints[0].at[0], joints[1].at[1] - joints[0].at[1])]
    if not lines and is_particle(linkage, body):
        return np.full(len(motion), np.nan)
    x, y = lines[0] if lines else (1.0, 0.0)
    return np.asarray(np.degrees(np.arctan2(y, x) + motion.angle(body)))


def _pitch_curves(motion: Motion) -> tuple[PitchCurve, ...]:
    """Return the pitch circles of gears and pitch lines of racks as drawn, each circle once."""
    curves: dict[tuple[str, str, float], PitchCurve] = {}
    for teeth in motion.linkage.teeth:
        for side in teeth.sides:
            if isinstance(side, Rack):
                curves[side.body, side.slider, 0.0] = _pitch_line(motion, teeth, side)
                continue
            centre = motion.linkage.joint(side.joint).at
            radius = float(f"{math.dist(centre, teeth.at):.9g}")
            if (key := (side.body, side.joint, radius)) not in curves:
                curves[key] = PitchCurve(
                    side.body, _moving_points(motion, side, centre, teeth.at), True
                )
    return tuple(curves.values())


def _moving_points(motion: Motion, side: Gear | Rack, first: Point, second: Point) -> np.ndarray:
    """Return the positions (T, 2, 2) of two points of a body, m as drawn."""
    return np.stack([motion.point(side.body, p)[0] for p in (first, second)], axis=1)


def _pitch_line(motion: Motion, teeth: Teeth, rack: Rack) -> PitchCurve:
    """Return the part of the pitch line that meets the gear, extended by its radius at both
    ends.
    """
    slider = next(s for s in motion.linkage.sliders if s.name == rack.slider)
    gear = next(side for side in teeth.sides if isinstance(side, Gear))
    radius = math.dist(motion.linkage.joint(gear.joint).at, teeth.at)
    travel = motion.coordinate(slider)[0] - slider.drawn
    met = -travel if slider.moving == rack.body else travel
    (x, y), (ex, ey) = teeth.at, slider.axis
    far = (float(met.min()) - radius, float(met.max()) + radius)
    low, high = ((x + s * ex, y + s * ey) for s in far)
    return PitchCurve(rack.body, _moving_points(motion, rack, low, high), False)

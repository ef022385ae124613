"""The motion of a planar linkage for reports, gathered in SI units from its dynamics."""

from __future__ import annotations

import math

import numpy as np

from loads import GROUND, Applied, Dynamics, Gear, Linkage, Motion, OverTime, Rack, Teeth, ledger
from loads.forces.acting import Spring
from loads.forces.measures import Distance
from loads.linkage.parts import Point, Slider
from loads.motion.complex_points import pairs
from loads.motion.planar_equations import is_particle
from loads.motion.transmission_angles import transmission_angles
from pinbase.arrays import Floats
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.mechanism.linkage import ground_joint
from pinstress.study.reading.file import Study
from pinstress.study.schema.mechanism import MechanismTable
from reports.data.motion import (
    AppliedForce,
    Extremes,
    GuideForces,
    LinkageMotion,
    PitchCurve,
    PointPath,
    PowerLedger,
)


def _extremes(over: OverTime) -> Extremes:
    return Extremes(
        {
            f"{link} at {joint}": (float(np.degrees(low.value)), low.time)
            for (link, joint), low in over.transmission.items()
        },
        (over.condition.value, over.condition.time),
    )


def linkage_motion(study: Study, name: str, case: CaseLoads) -> LinkageMotion:
    """Return the motion of the linkage in a case, in SI units."""
    dynamics, over = case.dynamics, case.over
    assert dynamics is not None
    motion, linkage = dynamics.motion, dynamics.motion.linkage
    timed = dynamics.reactions.times is not None
    # In a case that is held, the drives carry no load, so there is nothing to transmit.
    held = getattr(study.table.case[name], "hold", None)
    bodies = [b.name for b in linkage.bodies]
    centre, velocity, acceleration = (pairs(z[:, : len(bodies)]) for z in motion.centres)
    joints = list(motion.joints())
    joints += [motion.point(t.carrier, t.at) for t in linkage.teeth]
    at, v, a = (np.stack([j[k] for j in joints], axis=1) for k in range(3))
    about = ground_joint(linkage)
    force, moment = dynamics.shaking(linkage.joint(about).at)
    return LinkageMotion(
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
        ground=tuple(j.name for j in linkage.joints_on(GROUND)),
        joint_position=at,
        joint_velocity=v,
        joint_acceleration=a,
        slides={s.name: _slider_ends(motion, s) for s in linkage.sliders},
        connections=(
            *((c.name, c.body, j.name) for j, c in linkage.connections),
            *((t.name, t.bodies[0], t.name) for t in linkage.teeth),
        ),
        transmission={
            f"{link} at {joint}": np.degrees(angle)
            for (link, joint), angle in ({} if held else transmission_angles(motion)).items()
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
        springs=_springs(dynamics),
        applied=_applied(dynamics),
        aside=_aside(motion, case),
    )


def _slider_ends(motion: Motion, slider: Slider) -> Floats:
    """Return the positions (T, 2, 2) of both ends of a slider, m."""
    ends = (slider.base, slider.start), (slider.moving, slider.end)
    return np.stack([motion.point(*end)[0] for end in ends], axis=1)


def _springs(dynamics: Dynamics) -> dict[str, Floats]:
    """Return the ends (T, 2, 2) of the springs between two points, m."""
    return {
        load.name: np.stack(
            [
                dynamics.motion.point(body, end)[0]
                for body, end in zip(load.between.items, load.between.points, strict=True)
            ],
            axis=1,
        )
        for load in dynamics.applied
        if isinstance(load, Spring) and isinstance(load.between, Distance)
    }


def _applied(dynamics: Dynamics) -> tuple[AppliedForce, ...]:
    """Return the forces that the case applies, without springs and without pure couples."""
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


def _aside(motion: Motion, case: CaseLoads) -> tuple[AppliedForce, ...]:
    """Return the forces that the case applies across the plane."""
    return tuple(
        AppliedForce(
            load.planar.body,
            motion.point(load.planar.body, load.planar.at)[0],
            load.planar.size(motion)[:, None] * np.array([0.0, 0.0, load.force]),
        )
        for load in (case.side.loads if case.side else ())
        if load.force
    )


def _paths(study: Study, dynamics: Dynamics) -> dict[str, PointPath]:
    mechanism, motion = study.table.mechanism, dynamics.motion
    assert isinstance(mechanism, MechanismTable)
    paths = {}
    for name, point in mechanism.point.items():
        at = point.at if not isinstance(point.at, str) else motion.linkage.joint(point.at).at
        position, velocity, _ = motion.point(point.body, at)
        speed = np.linalg.norm(velocity, axis=1)
        curvature = motion.curvature(point.body, at)
        paths[name] = PointPath(position, velocity, speed, curvature)
    return paths


def _ledger(dynamics: Dynamics, over: OverTime | None) -> PowerLedger:
    powers = ledger(dynamics)
    violation = powers.violation if over is None else over.violation
    terms = powers.drives, powers.gravity, powers.applied, powers.friction, powers.kinetic_rate
    return PowerLedger(*terms, violation=violation)


def _slider_forces(dynamics: Dynamics) -> dict[str, GuideForces]:
    sliders = dynamics.sliders
    return {
        s.name: GuideForces(sliders.normal[:, k], sliders.couple[:, k], sliders.friction[:, k])
        for k, s in enumerate(dynamics.motion.linkage.sliders)
    }


def _joints_to_draw(linkage: Linkage, body: str) -> tuple[str, ...]:
    """Return the joints on a body, in order around their centroid, so that lines between them do
    not cross.
    """
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
    """Return the part of the pitch line that meets the gear, extended by the gear's radius at both
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

"""From what the loads room found, in SI, to the plain data of reports."""

from __future__ import annotations

from typing import Any

import numpy as np

from loads import GROUND, Dynamics, Linkage, Slider, energy, ledger
from loads.linkage import Floats
from loads.loops import pairs
from loads.peaks import peak_forces
from loads.transmission import transmission_angles
from pinstress.build import CaseLoads
from pinstress.checks import motion_check
from pinstress.measures import published_values
from pinstress.mechanism import ground_joint, offsets
from pinstress.published import Published
from pinstress.study import Study
from reports import results as plain

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


def mechanics(study: Study, loads: dict[str, CaseLoads], published: Published) -> dict[str, Any]:
    """The parts of plain.Results that need no stresses."""
    made = {n: c.dynamics for n, c in loads.items() if c.dynamics is not None}
    timed = {n: d for n, d in made.items() if d.reactions.times is not None}
    return {
        "reactions": tuple(_reactions(study, n, c, published) for n, c in loads.items()),
        "drive": tuple(t for n, d in timed.items() for t in _drives(study, n, d)),
        "motion": tuple(_motion(study, n, d) for n, d in made.items()),
        "motion_check": motion_check(study, loads, published),
        "published": published_values(study, loads, published),
        "legs": tuple(_leg(study, n, c) for n, c in loads.items() if c.leg is not None),
    }


def _drive_positions(study: Study, dynamics: Dynamics) -> Floats:
    """(T, D) what is shown as positions: lengths less their offsets, angles in degrees."""
    shown = np.array(dynamics.motion.drives)
    for k, drive in enumerate(dynamics.motion.linkage.drives):
        if isinstance(drive, Slider):
            shown[:, k] = (shown[:, k] - offsets(study)[k]) / study.system.factor("length")
        else:
            shown[:, k] = np.degrees(shown[:, k])
    return shown


def drive_position(study: Study, case: CaseLoads) -> Floats | None:
    """(T,) position of the only drive along a motion; None without one or with several."""
    dynamics = case.dynamics
    if dynamics is None or case.reactions.times is None or dynamics.drive.shape[1] != 1:
        return None
    return _drive_positions(study, dynamics)[:, 0]


def _position_unit(study: Study, case: CaseLoads) -> str:
    """Unit of what `drive_position` gives; empty without it."""
    if drive_position(study, case) is None or case.dynamics is None:
        return ""
    (drive,) = case.dynamics.motion.linkage.drives
    return study.system.length if isinstance(drive, Slider) else "deg"


def _reactions(
    study: Study, name: str, case: CaseLoads, published: Published
) -> plain.ReactionTable:
    unit = study.system.factor
    r, dynamics = case.reactions, case.dynamics
    on = {c: p for p in study.table.pin for c in study.connections(p)}
    return plain.ReactionTable(
        case=name,
        times=None if r.times is None else r.times / unit("time"),
        position=drive_position(study, case),
        connections=r.connections,
        bodies=r.bodies,
        pins=tuple(on.get(c, "") for c in r.connections),
        forces=r.forces / unit("force"),
        moments=r.moments / unit("moment"),
        shared=dynamics.shared if dynamics else (),
        published={c: f for (k, c), f in published.reactions.items() if k == name},
        note=case.note,
        peaks=_peaks(study, case),
        turn=r.turn,
        position_unit=_position_unit(study, case),
    )


def _peaks(study: Study, case: CaseLoads) -> tuple[plain.PeakReaction, ...]:
    if case.at is None or len(case.reactions) < 3:
        return ()
    unit = study.system.factor
    found = peak_forces(case.reactions, case.at)
    return tuple(
        plain.PeakReaction(p.connection, p.force / unit("force"), p.time / unit("time"))
        for p in found
    )


def _drives(study: Study, name: str, dynamics: Dynamics) -> list[plain.DriveTable]:
    unit, motion = study.system.factor, dynamics.motion
    stored, shown = energy(motion), _drive_positions(study, dynamics)
    work, power, tables = dynamics.work, dynamics.power, []
    for k, drive in enumerate(motion.linkage.drives):
        slides = isinstance(drive, Slider)
        tables.append(
            plain.DriveTable(
                case=name,
                name=drive.name,
                kind="slider" if slides else "rotary",
                time=motion.times / unit("time"),
                position=shown[:, k],
                velocity=motion.speeds[:, k] / (unit("velocity") if slides else 1.0),
                acceleration=motion.rates[:, k] / (unit("acceleration") if slides else 1.0),
                force=dynamics.drive[:, k] / unit("force" if slides else "energy"),
                power=power[:, k] / unit("power"),
                work=work[:, k] / unit("energy"),
                kinetic_energy=stored.kinetic / unit("energy"),
                potential_energy=(stored.potential - stored.potential[0]) / unit("energy"),
            )
        )
    return tables


def _motion(study: Study, name: str, dynamics: Dynamics) -> plain.LinkageMotion:
    unit, motion, linkage = study.system.factor, dynamics.motion, dynamics.motion.linkage
    timed = dynamics.reactions.times is not None
    bodies = [b.name for b in linkage.bodies]
    centre, velocity, acceleration = (pairs(z[:, : len(bodies)]) for z in motion.centres)
    joints = [motion.joint(j.name) for j in linkage.joints]
    at, v, a = (np.stack([j[k] for j in joints], axis=1) for k in range(3))
    about = ground_joint(linkage)
    force, moment = dynamics.shaking(linkage.joint(about).at)
    powers = ledger(dynamics)
    return plain.LinkageMotion(
        case=name,
        time=motion.times / unit("time") if timed else None,
        bodies=tuple(bodies),
        links=tuple(_joints_to_draw(linkage, b) for b in bodies),
        centre=centre / unit("length"),
        velocity=velocity / unit("velocity"),
        acceleration=acceleration / unit("acceleration"),
        angle=np.stack([_direction(dynamics, b) for b in bodies], axis=1),
        angular_velocity=np.stack([motion.angular_velocity(b) for b in bodies], axis=1),
        angular_acceleration=np.stack([motion.angular_acceleration(b) for b in bodies], axis=1),
        joints=tuple(j.name for j in linkage.joints),
        ground=tuple(
            j.name
            for j in linkage.joints
            if j.fixed_in == GROUND or any(c.body == GROUND for c in j.connections)
        ),
        joint_position=at / unit("length"),
        joint_velocity=v / unit("velocity"),
        joint_acceleration=a / unit("acceleration"),
        slides={
            s.name: np.stack(
                [motion.point(s.base, s.start)[0], motion.point(s.moving, s.end)[0]], axis=1
            )
            / unit("length")
            for s in linkage.sliders
        },
        connections=tuple((c.name, c.body, j.name) for j, c in linkage.connections),
        transmission={
            f"{link} at {joint}": np.degrees(angle)
            for (link, joint), angle in transmission_angles(motion).items()
        },
        condition=motion.condition,
        shaking_force=force / unit("force"),
        shaking_moment=moment / unit("energy"),
        shaking_about=about,
        ledger=plain.PowerLedger(
            drives=powers.drives / unit("power"),
            gravity=powers.gravity / unit("power"),
            applied=powers.applied / unit("power"),
            friction=powers.friction / unit("power"),
            kinetic_rate=powers.kinetic_rate / unit("power"),
            violation=powers.violation,
        ),
        slider_forces={
            s.name: np.stack(
                [
                    dynamics.sliders.normal[:, k] / unit("force"),
                    dynamics.sliders.couple[:, k] / unit("energy"),
                    dynamics.sliders.friction[:, k] / unit("force"),
                ],
                axis=1,
            )
            for k, s in enumerate(linkage.sliders)
        },
    )


def _leg(study: Study, name: str, case: CaseLoads) -> plain.LegTable:
    s, found, times = study.system, case.leg, case.reactions.times
    assert found is not None
    assert times is not None
    momentum = s.factor("force") * s.factor("time")
    units = {
        "omega": ("rad/s", 1.0),
        "alpha": ("rad/s^2", 1.0),
        "v": (f"{s.length}/{s.time}", s.factor("velocity")),
        "a": (f"{s.length}/{s.time}^2", s.factor("acceleration")),
        "p": (f"{s.force} {s.time}", momentum),
        "p_rate": (s.force, s.factor("force")),
        "L": (f"{s.force} {s.length} {s.time}", momentum * s.factor("length")),
        "L_rate": (f"{s.force} {s.length}", s.factor("energy")),
    }
    vectors = {}
    for key, kind in LEG_VECTORS.items():
        unit, factor = units[kind]
        vectors[key] = (getattr(found, key) / factor, unit)
    scalars = {
        "beta": (np.degrees(found.motion.beta), "deg"),
        "actuator": (found.actuator / s.factor("energy"), f"{s.force} {s.length}"),
        "spin_moment": (found.spin_moment / s.factor("energy"), f"{s.force} {s.length}"),
        "kinetic_energy": (found.kinetic_energy / s.factor("energy"), f"{s.force} {s.length}"),
    }
    axes = "x' to the aircraft's right, y' ahead, z' up from the slope"
    return plain.LegTable(name, times / s.factor("time"), vectors, scalars, axes)


def _joints_to_draw(linkage: Linkage, body: str) -> tuple[str, ...]:
    """Joints on a body, around their middle so that lines between them do not cross."""
    joints = linkage.joints_on(body)
    at = np.array([complex(*j.at) for j in joints])
    if len(joints) < 4:
        return tuple(j.name for j in joints)
    return tuple(joints[i].name for i in np.argsort(np.angle(at - at.mean()), kind="stable"))


def _direction(dynamics: Dynamics, body: str) -> Floats:
    """(T,) degrees from x of the line from the body's first joint to its second, or with fewer
    joints of the slider it belongs to; NaN for a particle.
    """
    motion, linkage = dynamics.motion, dynamics.motion.linkage
    joints = linkage.joints_on(body)
    lines = [s.axis for s in linkage.sliders if body in (s.base, s.moving)]
    if len(joints) > 1:
        lines = [(joints[1].at[0] - joints[0].at[0], joints[1].at[1] - joints[0].at[1])]
    if not lines:
        return np.full(len(motion), np.nan)
    x, y = lines[0]
    return np.asarray(np.degrees(np.arctan2(y, x) + motion.angle(body)))

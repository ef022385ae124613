"""Results of a linkage in space for reports, gathered in SI units from its dynamics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace

import numpy as np

from loads import Effort
from loads.space.transmission import transmission_angles_in_space
from pinbase.arrays import Floats
from pinstress.analysis.mechanics.space_skeleton import space_skeleton
from pinstress.study.model.mechanism.drives import offsets
from pinstress.study.model.mechanism.space import pin_axes, space_mechanism
from pinstress.study.model.space_cases import MAX_POSTURES, InSpace, postures_of
from pinstress.study.reading.file import Study
from reports.data.mechanics import DriveEffort, DriveTable
from reports.data.motion import BodyMotion, Extremes, SpacePosture
from reports.data.skeleton import Skeleton

NEGLIGIBLE_RANGE = 1e-3  # of the largest force of the case: a smaller range is not reported
ROUND_OFF = 1e-12  # relative to the largest force or power of all drives
NO_ANGLE = 1e-12  # rad: a smaller angle is round-off of zero
MAX_BODY_LINES = 200_000  # of the table of bodies, 50 MB; a longer table is not written
NO_TABLES = "In space: no table of sliding on pins is written."


def shown_positions(study: Study, positions: Floats, moved: Sequence[tuple[str, bool]]) -> Floats:
    """Return the displayed positions (T, D): lengths minus their offsets, and angles in degrees.

    positions: (T, D) m or rad. moved: the name of every drive, and whether it slides.
    """
    less = offsets(study)
    shown = [
        position - less.get(name, 0.0)
        if slides
        else np.degrees(np.where(np.abs(position) < NO_ANGLE, 0.0, position))
        for position, (name, slides) in zip(positions.T, moved, strict=True)
    ]
    return np.stack(shown, axis=1) if shown else positions


def drives(
    case: str,
    moved: Sequence[tuple[str, bool]],
    times: Floats | None,
    course: tuple[Floats, Floats, Floats],
    exerted: tuple[Floats, Floats],
    energies: tuple[Floats, Floats],
    efforts: Sequence[Effort] | None,
    frictionless: Sequence[Effort] | None = None,
) -> list[DriveTable]:
    """Return the table of every drive of a case.

    moved: the name of every drive, and whether it slides.
    course: displayed positions, and speeds and accelerations in SI units, (T, D) each.
    exerted: forces or torques, and powers, (T, D) each.
    energies: kinetic and potential energy of the linkage, (T,) J each.
    efforts: of every drive over a whole motion. frictionless: the same without friction.
    """
    (force, power), (kinetic, potential) = exerted, energies
    if times is None:
        force, power = _without_round_off(force), _without_round_off(power)
    tables = []
    for k, (name, slides) in enumerate(moved):
        effort = efforts[k] if efforts else None
        free = frictionless[k].largest.value if frictionless else None
        position, velocity, acceleration = (values[:, k] for values in course)
        tables.append(
            DriveTable(
                case=case,
                name=name,
                kind="slider" if slides else "rotary",
                time=times,
                position=position,
                velocity=velocity,
                acceleration=acceleration,
                force=force[:, k],
                power=power[:, k],
                work=effort.work if effort else np.zeros(len(position)),
                kinetic_energy=kinetic,
                potential_energy=potential - potential[0],
                effort=_drive_effort(effort, slides, free) if effort else None,
            )
        )
    return tables


def _without_round_off(values: Floats) -> Floats:
    """Return the values of all drives at one instant, with zero for those that are round-off of the
    largest.
    """
    least = ROUND_OFF * np.abs(values).max(initial=0.0)
    return np.where(np.abs(values) > least, values, 0.0)


def _names(solved: InSpace) -> list[tuple[str, bool]]:
    """Return the name of every actuator, which drives or holds the linkage, and whether it
    slides.
    """
    equations = solved.dynamics.motion.equations
    return [(name, equations.slides(name)) for name in equations.actuators]


def positions_in_space(study: Study, solved: InSpace) -> Floats:
    """Return the displayed positions (T, D) of the actuators."""
    return shown_positions(study, solved.dynamics.motion.actuated[0], _names(solved))


def drives_in_space(study: Study, case: str, solved: InSpace) -> list[DriveTable]:
    """Return the table of every drive of a case in space."""
    dynamics = solved.dynamics
    exerted = dynamics.drive, dynamics.power
    course = (positions_in_space(study, solved), *dynamics.motion.actuated[1:])
    times, moved, smooth = dynamics.reactions.times, _names(solved), solved.frictionless
    free = smooth.drives if smooth else None
    return drives(case, moved, times, course, exerted, solved.energies, solved.efforts, free)


def bodies_in_space(study: Study, case: str, solved: InSpace) -> list[BodyMotion]:
    """Return the motion and momenta of every body of the study; empty for very long motions."""
    if _body_lines(study, solved) > MAX_BODY_LINES:
        return []
    names = {b.name: k for k, b in enumerate(solved.dynamics.motion.linkage.bodies)}
    bodies = solved.bodies
    each = [*(f.name for f in fields(bodies)), "kinetic_energy"]
    return [
        BodyMotion(
            case,
            name,
            solved.dynamics.reactions.times,
            *(getattr(bodies, key)[:, names[name]] for key in each),
        )
        for name in space_mechanism(study).body
    ]


def _body_lines(study: Study, solved: InSpace) -> int:
    """Return the number of lines of a case in the table of bodies."""
    return len(space_mechanism(study).body) * len(solved.dynamics.motion)


def _no_bodies(study: Study, solved: InSpace) -> str:
    """Return a sentence that a case is too long for the table of bodies; empty for other cases."""
    lines = _body_lines(study, solved)
    if lines <= MAX_BODY_LINES:
        return ""
    return (
        f"bodies.csv does not have this case: {lines:,} lines, above {MAX_BODY_LINES:,}; ask for "
        "fewer samples."
    )


def skeleton_in_space(study: Study, case: str, solved: InSpace) -> Skeleton:
    """Return the skeleton of a linkage, as it is drawn."""
    joints = space_mechanism(study).joint
    pins = {connection: name for name, joint in joints.items() for connection in joint.connections}
    axes = {
        name: pin_axes(joint)[:, 2]
        for name, joint in joints.items()
        if joint.axis is not None or joint.pin_axis is not None
    }
    return space_skeleton(case, solved.dynamics, pins, axes)


def note_in_space(study: Study, solved: InSpace) -> str:
    """Return the note of a case: its impulses, the range of its forces over the stiffness of links,
    and what is left out.
    """
    told = solved.note, _range(study, solved), NO_TABLES, _no_angles(solved)
    return " ".join(filter(None, (*told, _no_bodies(study, solved))))


def _no_angles(solved: InSpace) -> str:
    """Return a sentence that a case is too long for transmission angles; empty for other cases."""
    motion = solved.dynamics.motion
    if solved.held is not None or postures_of(motion.linkage, len(motion)) <= MAX_POSTURES:
        return ""
    return "The motion is too long for transmission angles; ask for fewer samples."


def posture_in_space(study: Study, case: str, solved: InSpace) -> SpacePosture:
    """Return the transmission angles and the condition of a case; no angles for very long
    motions.
    """
    joints = space_mechanism(study).joint
    pins = {connection: name for name, joint in joints.items() for connection in joint.connections}
    motion, times = solved.dynamics.motion, solved.dynamics.reactions.times
    few = postures_of(motion.linkage, len(motion)) <= MAX_POSTURES and solved.held is None
    angles = transmission_angles_in_space(motion) if few else {}
    condition, at = solved.dynamics.condition
    posture = SpacePosture(
        case,
        times,
        {_link(pins, key): np.degrees(angle) for key, angle in angles.items()},
        condition,
        None if times is None else at,
        solved.violation,
    )
    if not solved.transmission:
        return posture
    lowest = {
        _link(pins, key): (float(np.degrees(low.value)), low.time)
        for key, low in solved.transmission.items()
    }
    return replace(posture, extremes=Extremes(lowest, (condition, at)))


def _link(pins: Mapping[str, str], key: tuple[str, str]) -> str:
    """Return the name of a link at a joint. pins: the joint of the study for each connection."""
    link, joint = key
    return f"{link} at {pins.get(joint, joint)}"


def _range(study: Study, solved: InSpace) -> str:
    """Return sentences on the forces that depend on the unknown stiffness of links."""
    r, variants = solved.reactions, solved.dynamics.range
    if not variants:
        return ""
    size = float(r.magnitudes.max(initial=0.0)) or 1.0
    every = [solved.dynamics.reactions, *variants.values()]
    unit, factor = study.system.force, study.system.factor("force")
    told = []
    for name, pin in solved.pins.items():
        peaks = [float(one.magnitudes[:, pin.joint].max()) for one in every]
        if max(peaks) - min(peaks) > NEGLIGIBLE_RANGE * size:
            low, high = min(peaks) / factor, max(peaks) / factor
            told.append(f"{name} {low:,.4g} to {high:,.4g} {unit}")
    if not told:
        return ""
    return (
        "Statics does not determine all forces; with each link a tenth and ten times as stiff as "
        f"the others the largest are: {', '.join(told)}."
    )


def _drive_effort(effort: Effort, slides: bool, frictionless: float | None) -> DriveEffort:
    """Return the effort of a drive over its motion, with angles in degrees."""
    return DriveEffort(
        effort.largest.value,
        effort.largest.time,
        effort.mean,
        effort.rms,
        effort.power.value,
        effort.power.time,
        effort.stroke if slides else float(np.degrees(effort.stroke)),
        frictionless,
    )

"""From a study to the nouns of the rooms: pins, materials, the linkage, the loads of each case."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.material import Material
from geometry.pin import GeometryError, Pin, Segment
from loads import (
    Applied,
    Body,
    Connection,
    CosineDrive,
    Dynamics,
    Joint,
    Linkage,
    LinkageError,
    Reactions,
    Sharing,
    Slider,
    TableError,
    UnreachableError,
    given_reactions,
    impulse_force,
    motion_reactions,
    move,
    read_reactions,
    static_reactions,
)
from pinstress.errors import InputError
from pinstress.schema import ApplyTable, GivenCase, MotionCase, StaticCase
from pinstress.study import Study

STANDARD_GRAVITY = 9.80665


@dataclass(frozen=True)
class CaseLoads:
    """The reactions of one case, with the dynamics behind them where a mechanism made them."""

    reactions: Reactions
    dynamics: Dynamics | None
    note: str


def material(study: Study, name: str) -> Material:
    """A material of the study."""
    m = study.table.material[name]
    return Material(name, m.youngs_modulus, m.poisson_ratio, m.density, m.yield_strength)


def pin(study: Study, name: str) -> Pin:
    """A pin of the study. Raises: InputError for a shape that cannot be, or an unknown clamp."""
    p = study.table.pin[name]
    segments = tuple(
        Segment(s.length, s.diameter, s.bore, s.name, s.connection, s.fillet) for s in p.profile
    )
    try:
        made = Pin(name, segments, p.fillet)
        for clamp in (
            *p.clamp,
            *(c for k in study.table.case.values() for c in k.clamp.get(name, ())),
        ):
            made.surface(clamp)
    except GeometryError as error:
        raise InputError(f"{study.path}: {error}") from None
    return made


def linkage(study: Study) -> Linkage:
    """The study's mechanism. Raises: InputError when it contradicts itself."""
    mechanism = study.table.mechanism
    if mechanism is None:
        raise InputError(f"{study.path}: there is no [mechanism]")
    g = float(np.hypot(*mechanism.gravity)) or STANDARD_GRAVITY
    joints = mechanism.joint
    try:
        return Linkage(
            bodies=tuple(
                Body(
                    name,
                    b.mass if b.mass is not None else (b.weight or 0.0) / g,
                    b.centre,
                    b.inertia,
                )
                for name, b in mechanism.body.items()
            ),
            joints=tuple(
                Joint(
                    name,
                    j.at,
                    tuple(Connection(c, body) for c, body in j.connections.items()),
                    j.fixed_in,
                    _pin_mass(study, name, j.weight, g) if j.fixed_in is None else 0.0,
                )
                for name, j in joints.items()
            ),
            sliders=tuple(
                Slider(name, *s.bodies, joints[s.joints[0]].at, joints[s.joints[1]].at)
                for name, s in mechanism.slider.items()
            ),
            driven=mechanism.drive.slider,
            gravity=mechanism.gravity,
            sharing=tuple(
                Sharing(tuple(s.connections), tuple(s.stiffness)) for s in mechanism.sharing
            ),
        )
    except LinkageError as error:
        raise InputError(f"{study.path}: mechanism: {error}") from None


def _pin_mass(study: Study, joint: str, weight: float | None, gravity: float) -> float:
    """Mass of a floating pin: as stated, or of the profile of that name, or nothing."""
    if weight is not None:
        return weight / gravity
    if joint not in study.table.pin:
        return 0.0
    density = study.table.material[study.table.pin[joint].material].density
    return density * pin(study, joint).volume if density else 0.0


def drive(study: Study) -> CosineDrive:
    """The law of the study's drive."""
    mechanism = study.table.mechanism
    assert mechanism is not None
    d = mechanism.drive
    return CosineDrive(d.start, d.end, d.duration, d.position_offset)


def case_loads(study: Study, name: str, mechanism: Linkage | None) -> CaseLoads:
    """Reactions of a case. Raises: InputError for what the study or its tables got wrong."""
    case = study.table.case[name]
    try:
        match case:
            case GivenCase():
                return CaseLoads(_given(study, name, case), None, "")
            case MotionCase():
                assert mechanism is not None
                law = drive(study)
                times = np.linspace(0.0, law.duration, case.samples)
                dynamics = motion_reactions(name, move(mechanism, law, times))
                return CaseLoads(dynamics.reactions, dynamics, "")
            case StaticCase():
                assert mechanism is not None
                return _static(study, name, case, mechanism)
    except TableError as error:
        raise InputError(str(error)) from None
    except UnreachableError as error:
        unit, factor = study.system.length, study.system.factor("length")
        raise InputError(f"{study.path}: case.{name}: {error.message(unit, factor)}") from None
    except LinkageError as error:
        raise InputError(f"{study.path}: case.{name}: {error}") from None


def _given(study: Study, name: str, case: GivenCase) -> Reactions:
    if case.forces is not None:
        return given_reactions(name, {c: tuple(f) for c, f in case.forces.items()})
    known = {c for p in study.table.pin for c in study.connections(p)}
    return read_reactions(
        name,
        study.beside(case.table or ""),
        study.system.factor("force"),
        study.system.factor("time"),
        known,
    )


def _static(study: Study, name: str, case: StaticCase, mechanism: Linkage) -> CaseLoads:
    applied, notes = [], []
    for load in case.apply:
        force, note = _applied_force(study, load)
        at = load.at
        if isinstance(at, str):
            at = next(j.at for j in mechanism.joints if j.name == at)
        applied.append(Applied(load.body, at, force))
        notes.append(note)
    length = case.drive_length or mechanism.driven_slider.drawn_length
    dynamics = static_reactions(name, mechanism, length, tuple(applied))
    return CaseLoads(dynamics.reactions, dynamics, " ".join(n for n in notes if n))


def _applied_force(study: Study, load: ApplyTable) -> tuple[tuple[float, float], str]:
    """An applied force (N) and, for an impulse estimate, how it came about."""
    if load.force is not None:
        return load.force, ""
    impulse = load.impulse
    assert impulse is not None
    gravity = impulse.gravity if impulse.mass is None else 1.0
    size = impulse_force(
        impulse.weight if impulse.mass is None else impulse.mass,  # type: ignore[arg-type]
        gravity,
        impulse.velocity_change,
        impulse.impulse_time,
    )
    x, y = np.array(impulse.direction) / np.hypot(*impulse.direction)
    unit, factor = study.system.force, study.system.factor("force")
    note = (
        f"Impulse estimate on {load.body}: {size / factor:,.1f} {unit}, the mean force over "
        f"{impulse.impulse_time:g} s."
    )
    return (float(size * x), float(size * y)), note

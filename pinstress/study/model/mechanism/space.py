"""The linkage in space of a study's mechanism."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from loads import LinkageError
from loads.motion.mobility import Mobility, freedom_of, idle_sharing, require_driven
from loads.space.conditions import directions
from loads.space.equations import SpaceEquations
from loads.space.gears import Mesh
from loads.space.linkage import (
    BodyAngle,
    JointAngle,
    JointTravel,
    Measured,
    PointDistance,
    RigidBody,
    SpaceJoint,
    SpaceLinkage,
    Vector,
)
from loads.space.stiffness import LinkStiffness
from pinbase.arrays import Floats
from pinbase.keys import key_part
from pinstress.study.model.clevis import middle_of
from pinstress.study.model.mechanism.drives import mechanism_of, parallel_rules, sharing_rules
from pinstress.study.model.mechanism.masses import STANDARD_GRAVITY, friction_circle, pin_mass
from pinstress.study.model.mechanism.space_bodies import body_in_space
from pinstress.study.model.mechanism.space_gears import gear_in_space, rack_of, teeth_axes
from pinstress.study.model.mechanism.stiffness import RIGID, stated_stiffness
from pinstress.study.model.pins import pin
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import MechanismCase
from pinstress.study.schema.drives import drive_name
from pinstress.study.schema.shown import listed
from pinstress.study.schema.space import (
    AngleDrive,
    SpaceDrive,
    SpaceJointTable,
    SpaceMechanismTable,
    TravelDrive,
    drivable,
)


@dataclass(frozen=True)
class SpacePin:
    """The position of the pin of a connection, or of meshing teeth, and its axes.

    joint: index of its force in the linkage. carrier: the body that carries the pin, or GROUND.
    at: the joint's point as drawn, m.
    axes: (3, 3), the pin's axes as drawn, as columns. For teeth: out of the first gear, along its
    pitch circle, and perpendicular to both.
    """

    joint: int
    carrier: str
    at: Vector
    axes: Floats


def space_mechanism(study: Study) -> SpaceMechanismTable:
    """Return the study's mechanism, which is in space."""
    mechanism = mechanism_of(study)
    assert isinstance(mechanism, SpaceMechanismTable)
    return mechanism


def space_contradictions(study: Study) -> tuple[SpaceLinkage | None, list[Wrong]]:
    """Return the linkage of the study's mechanism in space, or None and all its contradictions."""
    mechanism = space_mechanism(study)
    g = math.hypot(*mechanism.gravity) or STANDARD_GRAVITY
    wrong: list[LinkageError] = []
    bodies, joints = list[RigidBody](), list[SpaceJoint]()
    for name, body in mechanism.body.items():
        try:
            bodies.append(body_in_space(study, mechanism, name, body))
        except LinkageError as error:
            wrong.append(error)
    for name, joint in mechanism.joint.items():
        if joint.fixed_in is None:
            mass = pin_mass(study, name, joint.weight, g)
            bodies.append(RigidBody(pin_body(name), mass, joint.at))
        joints += _joints(name, joint, _bands(study, name, joint))
    teeth = list[Mesh]()
    for make, tables in ((gear_in_space, mechanism.gear), (rack_of, mechanism.rack)):
        for name in tables:
            try:
                teeth.append(make(study, mechanism, name))
            except LinkageError as error:
                wrong.append(error)
    centres = {body.name: body.centre for body in bodies}
    joints += [
        SpaceJoint(f"weld of {name}", "fixed", body.welded_to, name, centres[name])
        for name, body in mechanism.body.items()
        if body.welded_to is not None and name in centres
    ]
    if wrong:
        return None, _located(study, wrong)
    try:
        return SpaceLinkage(
            tuple(bodies),
            tuple(joints),
            (*_measured(study, mechanism), *(m for measured, _ in teeth for m in measured)),
            tuple(drive_name(drive) for drive in mechanism.drive),
            mechanism.gravity,
            tuple(ratio for _, ratio in teeth),
            sharing=sharing_rules(mechanism.sharing),
            parallel=parallel_rules(mechanism.sharing),
            stiffness=_stiffness(mechanism, bodies, joints),
        ), []
    except LinkageError as error:
        return None, _located(study, error.each)


def _stiffness(
    mechanism: SpaceMechanismTable, bodies: Sequence[RigidBody], joints: Sequence[SpaceJoint]
) -> dict[str, LinkStiffness]:
    """Return the stiffness of the links that state one; floating pins are rigid.

    Raises: LinkageError.
    """
    arms: dict[str, list[Floats]] = {
        b.name: [np.subtract(j.at, b.centre) for j in joints if b.name in (j.base, j.moving)]
        for b in bodies
    }
    pins = {pin_body(n): RIGID for n, joint in mechanism.joint.items() if joint.fixed_in is None}
    return stated_stiffness(mechanism.link_stiffness, mechanism.body, arms) | pins


def determined_in_space(study: Study, linkage: SpaceLinkage, held: bool) -> Mobility:
    """Return the mobility of a linkage in space whose drives determine every position.

    held: whether every case names the locks that hold the linkage instead; locks are checked with
    the case.

    Raises: InputError if the drives do not, or if a sharing rule applies to no indeterminate force.
    """
    equations = SpaceEquations(linkage)
    try:
        freedom = freedom_of(equations) if held else require_driven(equations)
        if errors := list(idle_sharing(linkage.sharing, freedom)):
            raise LinkageError.all(errors)
    except LinkageError as error:
        raise study.errors(_located(study, error.each)) from None
    return freedom


def pins_in_space(study: Study, linkage: SpaceLinkage) -> dict[str, SpacePin]:
    """Return the pin of every connection of the study's mechanism, and the positions of teeth."""
    mechanism = space_mechanism(study)
    of = {c: joint for joint in mechanism.joint.values() for c in joint.connections}
    teeth = {
        ratio.name: SpacePin(len(linkage.joints) + k, t.carrier, t.at, teeth_axes(t))
        for k, (_, ratio, t) in enumerate(linkage.teeth)
    }
    return {
        joint.name: SpacePin(k, joint.base, joint.at, pin_axes(of[joint.name]))
        for k, joint in enumerate(linkage.joints)
        if joint.name in of
    } | teeth


def pin_axes(joint: SpaceJointTable) -> Floats:
    """Return the axes of a joint's pin as drawn, (3, 3), as columns.

    z is the axis of the pin or of the joint, or else the world's z. x is the world's x (y, if z is
    along x) without its component along z.
    """
    axes = directions(joint.pin_axis or joint.axis or (0.0, 0.0, 1.0))
    return np.stack([axes["u"], axes["v"], axes["w"]], axis=1)


def pin_body(joint: str) -> str:
    """Return the name of the body that is a joint's floating pin."""
    return f"pin {joint}"


def carrier(mechanism: SpaceMechanismTable, joint: str) -> str:
    """Return the body with which the pin of a joint moves."""
    return mechanism.joint[joint].fixed_in or pin_body(joint)


def place(mechanism: SpaceMechanismTable, end: str | Vector) -> Vector:
    """Return a point as drawn, m: that of a joint, or a stated point."""
    return mechanism.joint[end].at if isinstance(end, str) else end


def length_name(joints: tuple[str, str]) -> str:
    """Return the name of the measured distance between two joints."""
    return f"length {joints[0]} {joints[1]}"


def _bands(study: Study, name: str, table: SpaceJointTable) -> dict[str, float]:
    """Return the positions of links along the pin's z from the joint's point, m, by connection.

    The pin is that of the joint's name, or the pin whose bands carry these connections.

    Raises: InputError for a pin that cannot be built, and if several pins could be meant.
    """
    if table.z is None:
        return {}
    named = [name] if name in study.table.pin else list(study.table.pin)
    shapes = [pin(study, n) for n in named]
    shapes = [x for x in shapes if not table.connections.keys().isdisjoint(x.connections)]
    if len(shapes) > 1:
        which = listed(x.name for x in shapes)
        raise study.error(
            f"mechanism.joint.{key_part(name)}.z: may be the start of any of the pins {which}",
            code="ambiguous-pin",
        )
    ears = {c: ear for x in shapes for c, ear in study.table.pin[x.name].ears.items()}
    return {
        c: table.z + sum(middle_of(c, x, ears) for x in shapes if c in x.connections)
        for c in table.connections
    }


def _joints(name: str, table: SpaceJointTable, bands: dict[str, float]) -> Iterator[SpaceJoint]:
    """Yield a joint for every connection; a floating pin is fixed to the body of its first
    connection.

    bands: as from `_bands`.
    """
    base, along = table.fixed_in or pin_body(name), pin_axes(table)[:, 2]
    for connection, body in table.connections.items():
        x, y, z = (np.array(table.at) + bands.get(connection, 0.0) * along).tolist()
        if connection not in drivable(table):
            yield SpaceJoint(connection, "fixed", base, body, (x, y, z))
            continue
        yield SpaceJoint(
            connection,
            table.kind,
            base,
            body,
            (x, y, z),
            table.axis,
            table.second_axis,
            friction_circle(table.friction, table.diameter),
        )


def _measured(study: Study, mechanism: SpaceMechanismTable) -> Iterator[Measured]:
    """Yield the coordinates of drives, springs and stops, and the lengths that loads depend on."""
    for drive in mechanism.drive:
        yield _driven(mechanism, drive)
    for name, spring in mechanism.spring.items():
        if spring.slide is not None:
            (joint,) = drivable(mechanism.joint[spring.slide])
            yield JointTravel(spring_name(name), joint)
        elif spring.bodies is not None and spring.joints is not None:
            yield _span(mechanism, spring_name(name), spring.bodies, spring.joints)
    for name, torsion in mechanism.torsion_spring.items():
        along = spring_name(name, "torsion spring")
        yield _angle(mechanism, along, torsion.joint, torsion.connection)
    for name, stop in mechanism.stop.items():
        if stop.joint is not None:
            yield _angle(mechanism, name, stop.joint, stop.connection)
        elif stop.slide is not None:
            yield JointTravel(name, _connection(mechanism, stop.slide, stop.connection))
        elif stop.between is not None and stop.bodies is not None:
            yield _span(mechanism, name, stop.bodies, stop.between)
    lengths: dict[str, tuple[str, str]] = {}
    for case in study.table.case.values():
        for load in case.apply if isinstance(case, MechanismCase) else ():
            for law in (load.force_law, load.couple_law):
                if law is not None and law.length_between is not None:
                    lengths[length_name(law.length_between)] = law.length_between
    for name, ends in lengths.items():
        bodies = (carrier(mechanism, ends[0]), carrier(mechanism, ends[1]))
        yield _span(mechanism, name, bodies, ends)


def spring_name(name: str, kind: str = "spring") -> str:
    """Return the name of the coordinate along which a spring acts."""
    return f"{kind} {name}"


def _driven(mechanism: SpaceMechanismTable, drive: SpaceDrive) -> Measured:
    name = drive_name(drive)
    if isinstance(drive, AngleDrive):
        return _angle(mechanism, name, drive.joint, drive.connection)
    if isinstance(drive, TravelDrive):
        return JointTravel(name, _connection(mechanism, drive.slide, drive.connection))
    return _span(mechanism, name, drive.bodies, drive.between)


def _angle(
    mechanism: SpaceMechanismTable, name: str, joint: str, stated: str | None
) -> JointAngle | BodyAngle:
    """Return the angle of a connection at a joint.

    At a floating pin it is the angle between the two bodies, so that a couple along it does not go
    through the pin.
    """
    table, connection = mechanism.joint[joint], _connection(mechanism, joint, stated)
    if table.fixed_in is not None or table.axis is None:
        return JointAngle(name, connection)
    first = next(iter(table.connections.values()))
    return BodyAngle(name, first, table.connections[connection], table.axis)


def _connection(mechanism: SpaceMechanismTable, joint: str, stated: str | None) -> str:
    return stated or drivable(mechanism.joint[joint])[0]


def _span(
    mechanism: SpaceMechanismTable,
    name: str,
    bodies: tuple[str, str],
    ends: tuple[str | Vector, str | Vector],
) -> PointDistance:
    known = partial(place, mechanism)
    return PointDistance(name, bodies, (known(ends[0]), known(ends[1])))


def _located(study: Study, errors: Sequence[LinkageError]) -> list[Wrong]:
    """Return errors at their keys in the study; an error of a connection is at its joint."""
    mechanism = space_mechanism(study)
    of = {c: name for name, joint in mechanism.joint.items() for c in joint.connections}
    of |= {pin_body(name): name for name in mechanism.joint}
    out = []
    for error in errors:
        kind, *names = (str(part) for part in error.at) if error.at else ("",)
        if names and names[0] in of and names[0] not in mechanism.body:
            kind, names = "joint", [of[names[0]]]
        if kind == "drive" and len(mechanism.drive) < 2:
            names = []
        at = ".".join(key_part(part) for part in ("mechanism", kind, *names) if part)
        out.append(Wrong(f"mechanism: {error.told(study.system.told)}", at=at, code=error.code))
    return out

"""References by name within a mechanism in space, and keys that its cases cannot have."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from loads.space.kinds import Kind
from pinbase.keys import key_part
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.names import known_name, known_names, two_bodies
from pinstress.study.schema.drives import drive_name
from pinstress.study.schema.landing import DropCase, GroundCase
from pinstress.study.schema.shown import as_text, listed
from pinstress.study.schema.space import (
    AngleDrive,
    LengthDrive,
    SpaceMechanismTable,
    TravelDrive,
    drivable,
    has_motion,
)
from pinstress.study.schema.tables import StudyTable


def of_space(mechanism: SpaceMechanismTable) -> Iterator[Wrong]:
    """Yield the references of a mechanism in space to things that do not exist."""
    bodies = dict.fromkeys(["ground", *mechanism.body])
    names: dict[str, str] = {}
    for name, joint in mechanism.joint.items():
        where = f"mechanism.joint.{key_part(name)}"
        for connection, body in joint.connections.items():
            key = f"{where}.connections.{key_part(connection)}"
            if body == joint.fixed_in:
                text = f"{key}: {as_text(body)} carries the pin; name the body that moves on it"
                yield Wrong(text, code="fixed-and-turning")
            if connection in names:
                text = f"{key}: joint {names[connection]} has this connection too; rename one"
                yield Wrong(text, code="duplicate-name")
            names[connection] = name
    for name in mechanism.link_stiffness:
        where = f"mechanism.link_stiffness.{key_part(name)}"
        yield from known_name(where, "body", name, mechanism.body)
    known = partial(known_names, mechanism, "mechanism")
    yield from known("joint.fixed_in joint.connections body.welded_to", "body", bodies)
    yield from known(
        "body.bar.joints drive.between spring.joints stop.between", "joint", mechanism.joint
    )
    forces = [*names, *mechanism.gear, *mechanism.rack]
    yield from known("sharing.connections", "connection, gear or rack", forces)
    actuators = dict.fromkeys([*map(drive_name, mechanism.drive), *mechanism.stop])
    yield from known("sharing.parallel", "drive or stop", actuators)
    yield from known("rack.pinion", "body", mechanism.body)
    yield from known("gear.joints rack.joint", "joint", mechanism.joint)
    for name, gear in mechanism.gear.items():
        where = f"mechanism.gear.{key_part(name)}"
        yield from two_bodies(where, gear.bodies, bodies)
        for at in gear.joints:
            yield from _of_kind(f"{where}.joints", mechanism, at, "revolute")
    for name, rack in mechanism.rack.items():
        where = f"mechanism.rack.{key_part(name)}"
        yield from known_name(f"{where}.slide", "joint", rack.slide, mechanism.joint)
        yield from _of_kind(f"{where}.joint", mechanism, rack.joint, "revolute")
        yield from _of_kind(f"{where}.slide", mechanism, rack.slide, "prismatic")
    for i, drive in enumerate(mechanism.drive, 1):
        where = "mechanism.drive" + (f"[{i}]" if len(mechanism.drive) > 1 else "")
        match drive:
            case AngleDrive():
                yield from _moved(f"{where}.joint", mechanism, drive.joint, drive.connection, False)
            case TravelDrive():
                yield from _moved(f"{where}.slide", mechanism, drive.slide, drive.connection, True)
            case LengthDrive():
                yield from two_bodies(where, drive.bodies, bodies)
    for name, spring in mechanism.spring.items():
        where = f"mechanism.spring.{key_part(name)}"
        yield from two_bodies(where, spring.bodies, bodies)
        if spring.slide is not None:
            yield from _moved(f"{where}.slide", mechanism, spring.slide, None, True)
    for name, torsion in mechanism.torsion_spring.items():
        where = f"mechanism.torsion_spring.{key_part(name)}.joint"
        yield from _moved(where, mechanism, torsion.joint, torsion.connection, False)
    for name, stop in mechanism.stop.items():
        where = f"mechanism.stop.{key_part(name)}"
        yield from two_bodies(where, stop.bodies, bodies)
        if stop.joint is not None:
            yield from _moved(f"{where}.joint", mechanism, stop.joint, stop.connection, False)
        elif stop.slide is not None:
            yield from _moved(f"{where}.slide", mechanism, stop.slide, stop.connection, True)


def _of_kind(where: str, mechanism: SpaceMechanismTable, name: str, kind: Kind) -> Iterator[Wrong]:
    """Yield an error for a joint of another kind than teeth need."""
    joint = mechanism.joint.get(name)
    if joint is not None and joint.kind != kind:
        text = f"{where}: joint {name} is {joint.kind}; teeth need one that is {kind}"
        yield Wrong(text, code="joint-kind")


def _moved(
    where: str, mechanism: SpaceMechanismTable, name: str, connection: str | None, slides: bool
) -> Iterator[Wrong]:
    """Yield an error unless a joint has an angle, or travel, of exactly one connection."""
    yield from known_name(where, "joint", name, mechanism.joint)
    if (joint := mechanism.joint.get(name)) is None:
        return
    if not has_motion(joint.kind, slides):
        what, kinds = ("travel", "prismatic") if slides else ("angle", "revolute")
        text = (
            f"{where}: joint {name} is {joint.kind} and has no {what}; name one that is {kinds} "
            "or cylindrical"
        )
        yield Wrong(text, code="joint-kind")
    choices = drivable(joint)
    key = f"{where.rpartition('.')[0]}.connection"
    if connection is not None:
        yield from known_name(key, "connection that moves on the pin", connection, choices)
    elif len(choices) > 1:
        text = f"{where}: several bodies move on joint {name}; give connection, of {{}}"
        yield Wrong(text.format(listed(choices)), code="missing-key")


def _on_ground(where: str, case: GroundCase, mechanism: SpaceMechanismTable) -> Iterator[Wrong]:
    """Yield errors of a case of ground loads."""
    yield from known_name(f"{where}.body", "body", case.body, mechanism.body)
    if isinstance(case.at, str):
        yield from known_name(f"{where}.at", "joint", case.at, mechanism.joint)
    if isinstance(case.forward, str):
        text = f"{where}.forward: in space give [x, y, z], the direction of travel"
        yield Wrong(text, code="wrong-dimension")
    elif not any(case.forward):
        text = f"{where}.forward: must not be zero; give the direction of travel, [x, y, z]"
        yield Wrong(text, code="no-direction")
    if case.drop is not None:
        text = (
            f"{where}.drop: in space there is no drop; give its largest vertical reaction as "
            "reference instead, from a study of the leg in the plane of its stroke"
        )
        yield Wrong(text, code="wrong-dimension")


def cases_in_space(table: StudyTable, mechanism: SpaceMechanismTable) -> Iterator[Wrong]:
    """Yield errors for keys and kinds that cases of a linkage in space cannot have."""
    for name, case in table.case.items():
        where = f"case.{key_part(name)}"
        if isinstance(case, DropCase):
            text = (
                f"{where}: kind 'drop' needs a linkage in a plane; draw the leg in the plane of "
                "its stroke in a study of its own for the drop, and give the largest vertical "
                'reaction of that here, as the reference of a case of kind "ground"'
            )
            yield Wrong(text, code="wrong-dimension")
        if isinstance(case, GroundCase):
            yield from _on_ground(where, case, mechanism)
    if table.motion_check is not None:
        text = "motion_check: it needs a linkage in a plane; remove it"
        yield Wrong(text, code="wrong-dimension")

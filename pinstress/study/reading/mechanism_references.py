"""References by name within a mechanism in a plane, and those of the cases of any mechanism."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from functools import partial

from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.names import known_name, two_bodies
from pinstress.study.reading.space_references import cases_in_space
from pinstress.study.schema.cases import ApplyTable, GivenCase, MotionCase
from pinstress.study.schema.drives import RotaryDrive, SliderDrive, drive_name
from pinstress.study.schema.landing import AtWheel, DropCase, GroundCase
from pinstress.study.schema.mechanism import MechanismTable
from pinstress.study.schema.shown import as_text, near
from pinstress.study.schema.tables import AnyMechanism, StudyTable


def of_pins(table: StudyTable, mechanism: AnyMechanism, bears: dict[str, str]) -> Iterator[Wrong]:
    """Yield the connections on pins that the mechanism does not have. bears: pins by connection."""
    have = dict.fromkeys(c for joint in mechanism.joint.values() for c in joint.connections)
    if all(isinstance(case, GivenCase) for case in table.case.values()):
        return
    for connection, pin in bears.items():
        if connection not in have:
            text = f"pin.{pin}: connection {as_text(connection)} is not in the mechanism; "
            hint = partial(near, connection, have)
            yield Wrong(text, hint, code="unknown-connection", name=connection)


def _named_joints(mechanism: MechanismTable) -> Iterator[tuple[str, str]]:
    """Yield every key below [mechanism] that names a joint, with the name."""
    for name, slider in mechanism.slider.items():
        for joint in slider.joints:
            if isinstance(joint, str):
                yield f"slider.{name}.joints", joint
    for name, body in mechanism.body.items():
        for joint in body.bar.joints if body.bar is not None else ():
            yield f"body.{name}.bar.joints", joint
    for i, drive in enumerate(mechanism.drive, 1):
        for joint in () if isinstance(drive, SliderDrive) else _lines(drive):
            yield f"drive[{i}].line" if len(mechanism.drive) > 1 else "drive.line", joint
    for name, point in mechanism.point.items():
        if isinstance(point.at, str):
            yield f"point.{name}.at", point.at
    for name, spring in mechanism.spring.items():
        for end in spring.joints or ():
            if isinstance(end, str):
                yield f"spring.{name}.joints", end
    for name, gear in mechanism.gear.items():
        for joint in gear.joints:
            yield f"gear.{name}.joints", joint
    for name, rack in mechanism.rack.items():
        yield f"rack.{name}.joint", rack.joint


def _lines(drive: RotaryDrive) -> tuple[str, ...]:
    return (drive.line or ()) + (drive.against_line or ())


def of_plane(mechanism: MechanismTable) -> Iterator[Wrong]:
    """Yield the references of a mechanism in a plane to things that do not exist."""
    bodies = dict.fromkeys(["ground", *mechanism.body])
    for name, joint in mechanism.joint.items():
        where = f"mechanism.joint.{name}"
        for origin in joint.origins:
            yield from known_name(f"{where}.at", "joint", origin, mechanism.joint)
        if joint.fixed_in is not None:
            yield from known_name(f"{where}.fixed_in", "body", joint.fixed_in, bodies)
        for connection, body in joint.connections.items():
            yield from known_name(f"{where}.connections.{connection}", "body", body, bodies)
    for name, part in mechanism.body.items():
        where = f"mechanism.body.{name}.welded_to"
        yield from known_name(where, "body", part.welded_to or "ground", bodies)
    for name in mechanism.link_stiffness:
        yield from known_name(f"mechanism.link_stiffness.{name}", "body", name, mechanism.body)
    for place, named in _named_joints(mechanism):
        yield from known_name(f"mechanism.{place}", "joint", named, mechanism.joint)
    for i, drive in enumerate(mechanism.drive, 1):
        where = "mechanism.drive" + (f"[{i}]" if len(mechanism.drive) > 1 else "")
        if isinstance(drive, SliderDrive):
            yield from known_name(f"{where}.slider", "slider", drive.slider, mechanism.slider)
            continue
        yield from known_name(f"{where}.body", "body", drive.body, bodies)
        yield from known_name(f"{where}.against", "body", drive.against, bodies)
    for name, spring in mechanism.spring.items():
        where = f"mechanism.spring.{name}"
        if spring.slider is not None:
            yield from known_name(f"{where}.slider", "slider", spring.slider, mechanism.slider)
        yield from two_bodies(where, spring.bodies, bodies)
    for name, point in mechanism.point.items():
        yield from known_name(f"mechanism.point.{name}.body", "body", point.body, mechanism.body)
    for name, stop in mechanism.stop.items():
        yield from two_bodies(f"mechanism.stop.{name}", stop.bodies, bodies)
    for name, gear in mechanism.gear.items():
        yield from two_bodies(f"mechanism.gear.{name}", gear.bodies, bodies)
    for name, rack in mechanism.rack.items():
        where = f"mechanism.rack.{name}"
        yield from known_name(f"{where}.pinion", "body", rack.pinion, bodies)
        yield from known_name(f"{where}.slider", "slider", rack.slider, mechanism.slider)
    for name, torsion in mechanism.torsion_spring.items():
        yield from two_bodies(f"mechanism.torsion_spring.{name}", torsion.bodies, bodies)


def of_its_cases(table: StudyTable, mechanism: AnyMechanism) -> Iterator[Wrong]:
    """Yield the references of cases to what the mechanism does not have."""
    moves = all(d.moves for d in mechanism.drive)
    drives = [drive_name(drive) for drive in mechanism.drive]
    holders = dict.fromkeys(drives)
    positions = dict.fromkeys(drives)
    if isinstance(mechanism, MechanismTable):
        holders = dict.fromkeys([*drives, *mechanism.slider, *mechanism.stop])
        positions = dict.fromkeys([*mechanism.slider, *drives])
    else:
        yield from cases_in_space(table)
    for name, case in table.case.items():
        for hold_name in getattr(case, "hold", None) or ():
            what = "drive, slider or stop"
            yield from known_name(f"case.{name}.hold", what, hold_name, holders)
        if isinstance(case, MotionCase) and not moves:
            yield Wrong(
                f"case.{name}: a motion needs start, end and duration in [mechanism.drive]",
                code="drive-without-motion",
            )
        for i, load in enumerate(getattr(case, "apply", ()), 1):
            where = f"case.{name}.apply[{i}]"
            yield from known_name(f"{where}.body", "body", load.body, mechanism.body)
            if isinstance(load.at, str):
                yield from known_name(f"{where}.at", "joint", load.at, mechanism.joint)
            yield from _of_height(where, load, mechanism)
            yield from _of_dimension(where, load, mechanism.dimension)
            yield from _of_laws(where, load, mechanism, positions)
            yield from _of_time(where, load, isinstance(case, MotionCase))
        if mechanism.dimension == 2 and getattr(case, "ground_motion", None) is not None:
            text = (
                f"case.{name}.ground_motion: it is of linkages in space (dimension = 3); remove it"
            )
            yield Wrong(text, code="wrong-dimension")
        if isinstance(case, AtWheel) and isinstance(mechanism, MechanismTable):
            yield from _of_wheel(f"case.{name}", case, table, mechanism)
    if (check := table.motion_check) is not None:
        for field in ("joint", "pivot"):
            where = f"motion_check.{field}"
            yield from known_name(where, "joint", getattr(check, field), mechanism.joint)


def _of_dimension(where: str, load: ApplyTable, dimension: int) -> Iterator[Wrong]:
    """Yield errors for vectors of a load in space with two components, and for what is only known
    in space.
    """
    given: dict[str, object] = {
        "at": load.at,
        "force": load.force,
        "direction": load.direction,
        "impulse.direction": None if load.impulse is None else load.impulse.direction,
    }
    if dimension == 2:
        if load.couple_axis is not None:
            text = f"{where}.couple_axis: in a plane couples of a table are about z; remove it"
            yield Wrong(text, code="wrong-dimension")
        return
    for key, value in given.items():
        if isinstance(value, list) and len(value) < dimension:
            text = f"{where}.{key}: the linkage is in space (dimension = 3); give [x, y, z]"
            yield Wrong(text, code="wrong-dimension")
    if not isinstance(load.couple, tuple) and load.couple:
        text = f"{where}.couple: the linkage is in space (dimension = 3); give [mx, my, mz]"
        yield Wrong(text, code="wrong-dimension")
    if load.couple_law is not None and load.couple_axis is None:
        text = f"{where}.couple_law: in space give couple_axis = [x, y, z], its axis"
        yield Wrong(text, code="missing-key")


def _of_laws(
    where: str, load: ApplyTable, mechanism: AnyMechanism, positions: Collection[str]
) -> Iterator[Wrong]:
    """Yield errors for arguments of the tables of a load."""
    for key in ("force_law", "couple_law"):
        law = getattr(load, key)
        if law is None:
            continue
        here = f"{where}.{key}"
        if law.position_of is not None:
            what = "drive or slider" if mechanism.dimension == 2 else "drive"
            yield from known_name(f"{here}.position_of", what, law.position_of, positions)
        for joint in law.length_between or ():
            yield from known_name(f"{here}.length_between", "joint", joint, mechanism.joint)


def _of_time(where: str, load: ApplyTable, moves: bool) -> Iterator[Wrong]:
    """Yield an error for what depends on time in a case that is no motion."""
    timed = [key for key in ("begin", "end") if getattr(load, key) is not None]
    for key in ("force_law", "couple_law"):
        law = getattr(load, key)
        if law is not None and law.position_of is None and law.length_between is None:
            timed.append(key)
    if timed and not moves:
        yield Wrong(
            f'{where}.{timed[0]}: depends on time, which only a case of kind "motion" has; for a '
            "table of another argument give position_of or length_between",
            code="needs-motion",
        )


def _of_height(where: str, load: ApplyTable, mechanism: AnyMechanism) -> Iterator[Wrong]:
    """Yield an error for the z of a point where no pin of a planar mechanism has one."""
    if not isinstance(mechanism, MechanismTable) or not load.at_height:
        return
    if all(joint.z is None for joint in mechanism.joint.values()):
        yield Wrong(
            f"{where}.at: its z is measured from nowhere, as no pin has a place along z; give z of "
            "[mechanism.joint.NAME], or [x, y], which is in the plane of the body",
            code="no-height",
        )


def _of_wheel(
    key: str, case: AtWheel, table: StudyTable, mechanism: MechanismTable
) -> Iterator[Wrong]:
    yield from known_name(f"{key}.body", "body", case.body, mechanism.body)
    yield from known_name(f"{key}.at", "joint", case.at, mechanism.joint)
    if isinstance(case, DropCase) and case.strut is not None:
        slides = {d.slider: d for d in mechanism.drive if isinstance(d, SliderDrive)}
        yield from known_name(f"{key}.strut.drive", "slider drive", case.strut.drive, slides)
    if isinstance(case, GroundCase) and case.drop is not None:
        drops = {name: c for name, c in table.case.items() if isinstance(c, DropCase)}
        yield from known_name(f"{key}.drop", "drop case", case.drop, drops)

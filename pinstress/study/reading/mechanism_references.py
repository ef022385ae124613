"""References by name within a planar mechanism, and those of the cases of any mechanism."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from pinbase.keys import key_part
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.names import known_name, known_names, two_bodies
from pinstress.study.reading.space_references import cases_in_space
from pinstress.study.schema.cases import ApplyTable, GivenCase, MotionCase
from pinstress.study.schema.drives import SliderDrive, drive_name
from pinstress.study.schema.landing import AtWheel, DropCase, GroundCase
from pinstress.study.schema.mechanism import MechanismTable
from pinstress.study.schema.shown import as_text, near
from pinstress.study.schema.tables import AnyMechanism, StudyTable


def of_pins(table: StudyTable, mechanism: AnyMechanism, bears: dict[str, str]) -> Iterator[Wrong]:
    """Yield the connections on pins that the mechanism does not have. bears: the pin of each
    connection.
    """
    have = dict.fromkeys(c for joint in mechanism.joint.values() for c in joint.connections)
    if all(isinstance(case, GivenCase) for case in table.case.values()):
        return
    for connection, pin in bears.items():
        if connection not in have:
            text = (
                f"pin.{key_part(pin)}: connection {as_text(connection)} is not in the mechanism; "
            )
            hint = partial(near, connection, have)
            yield Wrong(text, hint, code="unknown-connection", name=connection)


# Keys of a planar [mechanism] that name its parts
BODY_PATHS = "joint.fixed_in joint.connections body.welded_to drive.body drive.against rack.pinion"
JOINT_PATHS = (
    "slider.joints body.bar.joints drive.line drive.against_line point.at spring.joints "
    "gear.joints rack.joint"
)
SLIDER_PATHS = "drive.slider spring.slider rack.slider"
# Keys of other tables that name its joints, and its drives or sliders
LOADED_JOINT_PATHS = (
    "case.apply.at case.apply.force_law.length_between case.apply.couple_law.length_between "
    "motion_check.joint motion_check.pivot"
)
POSITION_PATHS = "case.apply.force_law.position_of case.apply.couple_law.position_of"


def of_plane(mechanism: MechanismTable) -> Iterator[Wrong]:
    """Yield the references of a planar mechanism to things that do not exist."""
    bodies = dict.fromkeys(["ground", *mechanism.body])
    for name, joint in mechanism.joint.items():
        for origin in joint.origins:
            yield from known_name(
                f"mechanism.joint.{key_part(name)}.at", "joint", origin, mechanism.joint
            )
    for name in mechanism.link_stiffness:
        yield from known_name(
            f"mechanism.link_stiffness.{key_part(name)}", "body", name, mechanism.body
        )
    known = partial(known_names, mechanism, "mechanism")
    yield from known(BODY_PATHS, "body", bodies)
    yield from known("point.body", "body", mechanism.body)
    yield from known(JOINT_PATHS, "joint", mechanism.joint)
    yield from known(SLIDER_PATHS, "slider", mechanism.slider)
    for part in ("spring", "stop", "gear", "torsion_spring"):
        for name, table in getattr(mechanism, part).items():
            yield from two_bodies(f"mechanism.{part}.{key_part(name)}", table.bodies, bodies)


def of_its_cases(table: StudyTable, mechanism: AnyMechanism) -> Iterator[Wrong]:
    """Yield the references of cases to things that the mechanism does not have."""
    moves = all(d.moves for d in mechanism.drive)
    drives = [drive_name(drive) for drive in mechanism.drive]
    holders, what_holds = dict.fromkeys([*drives, *mechanism.stop]), "drive or stop"
    positions = dict.fromkeys(drives)
    if isinstance(mechanism, MechanismTable):
        holders = dict.fromkeys([*drives, *mechanism.slider, *mechanism.stop])
        what_holds = "drive, slider or stop"
        positions = dict.fromkeys([*mechanism.slider, *drives])
    else:
        yield from cases_in_space(table, mechanism)
    known = partial(known_names, table, "")
    yield from known("case.hold", what_holds, holders)
    yield from known("case.apply.body", "body", mechanism.body)
    yield from known(LOADED_JOINT_PATHS, "joint", mechanism.joint)
    what = "drive or slider" if mechanism.dimension == 2 else "drive"
    yield from known(POSITION_PATHS, what, positions)
    for name, case in table.case.items():
        if isinstance(case, MotionCase) and not moves:
            yield Wrong(
                f"case.{key_part(name)}: a motion needs start, end and duration in "
                "[mechanism.drive]",
                code="drive-without-motion",
            )
        for i, load in enumerate(getattr(case, "apply", ()), 1):
            where = f"case.{key_part(name)}.apply[{i}]"
            yield from _of_height(where, load, mechanism)
            yield from _of_dimension(where, load, mechanism.dimension)
            yield from _of_time(where, load, isinstance(case, MotionCase))
        if mechanism.dimension == 2 and getattr(case, "ground_motion", None) is not None:
            text = (
                f"case.{key_part(name)}.ground_motion: it is of linkages in space "
                "(dimension = 3); remove it"
            )
            yield Wrong(text, code="wrong-dimension")
        if isinstance(case, AtWheel) and isinstance(mechanism, MechanismTable):
            yield from _of_wheel(f"case.{key_part(name)}", case, table, mechanism)


def _of_dimension(where: str, load: ApplyTable, dimension: int) -> Iterator[Wrong]:
    """Yield errors for vectors with two components of a load in space, and for keys that are only
    for linkages in space.
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


def _of_time(where: str, load: ApplyTable, moves: bool) -> Iterator[Wrong]:
    """Yield errors for keys that depend on time in a case that is not a motion, and for the range
    of an impulse in a motion.
    """
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
    if moves and load.impulse is not None and load.impulse.range is not None:
        yield Wrong(
            f'{where}.impulse.range: a case of kind "motion" has the impulse as stated alone; '
            'remove it, or give a case of kind "static" or "instant" this range',
            code="needs-instant",
        )


def _of_height(where: str, load: ApplyTable, mechanism: AnyMechanism) -> Iterator[Wrong]:
    """Yield an error for the z of a point of a planar mechanism, if no pin has a z."""
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
    if isinstance(case.at, str):
        yield from known_name(f"{key}.at", "joint", case.at, mechanism.joint)
    else:
        yield Wrong(f"{key}.at: in a plane name the joint at the axle", code="wrong-dimension")
    if not isinstance(case.forward, str):
        text = f'{key}.forward: in a plane give "left" or "right"'
        yield Wrong(text, code="wrong-dimension")
    if isinstance(case, DropCase) and case.strut is not None:
        slides = {d.slider: d for d in mechanism.drive if isinstance(d, SliderDrive)}
        yield from known_name(f"{key}.strut.drive", "slider drive", case.strut.drive, slides)
    if isinstance(case, GroundCase) and case.drop is not None:
        drops = {name: c for name, c in table.case.items() if isinstance(c, DropCase)}
        yield from known_name(f"{key}.drop", "drop case", case.drop, drops)

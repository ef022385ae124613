"""The laws of a study's drives, and their values in a case."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

from loads import (
    ArgumentError,
    ConstantDrive,
    CosineDrive,
    CycloidalDrive,
    Law,
    LinkageError,
    TableDrive,
    TableError,
    read_table,
)
from loads.linkage.parts import Parallel, Sharing
from pinbase.keys import key_part
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import Coordinates, InstantCase, StaticCase
from pinstress.study.schema.drives import RotaryDrive, SliderDrive, SlidingDrive, drive_name
from pinstress.study.schema.landing import AtWheel
from pinstress.study.schema.mechanism import MechanismTable, SharingTable
from pinstress.study.schema.space import SpaceDrive
from pinstress.study.schema.tables import AnyMechanism
from pinstress.study.schema.units import to_si

DRIVE_LAWS: dict[str, type[CosineDrive | CycloidalDrive | ConstantDrive]] = {
    "cosine": CosineDrive,
    "cycloidal": CycloidalDrive,
    "constant": ConstantDrive,
}
AnyDriveTable = SliderDrive | RotaryDrive | SpaceDrive


class DrawnDrive(Protocol):
    """A driven coordinate: a slider or a rotation; in space a joint's angle or travel, or a
    distance.
    """

    @property
    def drawn(self) -> float:
        """Its value as drawn, m or rad."""
        ...


class Driven(Protocol):
    """A linkage in the plane or in space."""

    @property
    def drives(self) -> Sequence[DrawnDrive]:
        """The coordinates that drives prescribe."""
        ...


def mechanism_of(study: Study) -> AnyMechanism:
    """Return the study's mechanism.

    Raises: InputError if it has none.
    """
    if study.table.mechanism is None:
        raise study.error("the study has no [mechanism]; add one", code="no-mechanism")
    return study.table.mechanism


def plane_of(study: Study) -> MechanismTable:
    """Return the study's mechanism, which is in a plane."""
    mechanism = mechanism_of(study)
    assert isinstance(mechanism, MechanismTable)
    return mechanism


def laws(study: Study) -> tuple[Law, ...]:
    """Return the law of every drive.

    Raises: InputError for a table that cannot be used.
    """
    return tuple(_law(study, d) for d in drive_tables(study))


def offsets(study: Study) -> dict[str, float]:
    """Return, for each driven slider, the offset by which its displayed position is less than its
    length, m.
    """
    drives = drive_tables(study)
    return {drive_name(d): d.position_offset for d in drives if isinstance(d, SlidingDrive)}


def drive_tables(study: Study) -> list[AnyDriveTable]:
    """Return the drives of the study's mechanism."""
    return [*mechanism_of(study).drive]


def _law(study: Study, drive: AnyDriveTable) -> Law:
    if drive.law == "table":
        return drive_table(study, drive)
    assert drive.start is not None
    assert drive.end is not None
    assert drive.duration is not None
    return DRIVE_LAWS[drive.law](drive.start, drive.end, drive.duration, drive.begin)


def span(study: Study) -> float:
    """Return the time at which the last drive ends, s."""
    return max(float(law.finish) for law in laws(study))  # type: ignore[attr-defined]


def drive_table(study: Study, drive: AnyDriveTable) -> TableDrive:
    """Return the law of a drive with a table.

    Raises: InputError.
    """
    path = study.path_to(drive.table or "")
    slides = drive.slides
    length, time = study.system.factor("length"), study.system.factor("time")
    value = "position" if slides else "position_deg"
    unit, rates = (length, length) if slides else (math.pi / 180.0, 1.0)
    units = {
        "time": time,
        value: unit,
        "velocity": rates / time,
        "acceleration": rates / time**2,
    }
    try:
        rows = list(read_table(path, ("time", value), ("velocity", "acceleration")))
        columns = [c for c in units if c in rows[0].cells]
        if len(columns) == 3:
            raise TableError(
                f"{path}: give both velocity and acceleration, or neither", "give-both"
            )
        if rows[0].number("time") < 0.0:
            raise TableError(
                f"{rows[0].where}: time = {rows[0].cells['time']} is negative, but a motion begins "
                "at time 0; count from the first row",
                "negative",
            )
        return TableDrive(*(tuple(row.number(c) * units[c] for row in rows) for c in columns))
    except TableError as error:
        raise study.table_error("mechanism.drive.table", error) from None
    except LinkageError as error:
        raise InputError(f"{path}: {error}", code=error.code) from None


def state(
    study: Study, name: str, case: StaticCase | InstantCase | AtWheel, drawn: Driven
) -> list[tuple[float, float, float]]:
    """Return the position, velocity and acceleration of every drive in a case, in SI units.

    Raises: InputError.
    """
    drives = drive_tables(study)
    rates = (case.velocity, case.acceleration) if isinstance(case, InstantCase) else (0.0, 0.0)
    for key, stated in zip(DRIVE_DIMENSIONS, (case.position, *rates), strict=True):
        if stated and not drives:
            text = f"case.{key_part(name)}.{key}: there is no drive that has one; remove it"
            raise study.error(text, code="unknown-drive")
    return [
        (
            _coordinate(study, name, "position", case.position, drive, drawn.drives[k].drawn),
            _coordinate(study, name, "velocity", rates[0], drive, 0.0),
            _coordinate(study, name, "acceleration", rates[1], drive, 0.0),
        )
        for k, drive in enumerate(drives)
    ]


DRIVE_DIMENSIONS = {
    "position": ("length", "angle"),
    "velocity": ("velocity", "angular velocity"),
    "acceleration": ("acceleration", "angular acceleration"),
}


def _coordinate(
    study: Study,
    case: str,
    key: str,
    value: Coordinates | None,
    drive: AnyDriveTable,
    default: float,
) -> float:
    where = f"case.{key_part(case)}.{key}"
    names = [drive_name(d) for d in drive_tables(study)]
    if isinstance(value, dict):
        unknown = [n for n in value if n not in names]
        if unknown:
            raise study.error(
                f"{where}: no drive {unknown[0]!r}; there are {', '.join(names)}",
                code="unknown-drive",
            )
        value = value.get(drive_name(drive))
    elif value not in (None, 0.0) and len(names) > 1:
        raise study.error(
            f"{where}: there are several drives; give {{ {names[0]} = ..., {names[1]} = ... }}",
            code="drive-not-named",
        )
    if value is None or (value == 0.0 and key != "position"):
        return default
    slides = drive.slides
    try:
        coordinate = to_si(value, DRIVE_DIMENSIONS[key][0 if slides else 1], study.system)
    except ArgumentError as error:
        raise study.error(f"{where}: {error}", code=error.code) from None
    if key == "position" and isinstance(drive, RotaryDrive) and drive.line is not None:
        coordinate += 2.0 * math.pi * round((default - coordinate) / (2.0 * math.pi))
    return coordinate


def sharing_rules(tables: Sequence[SharingTable]) -> tuple[Sharing, ...]:
    """Return the rules by which redundant connections share their load."""
    return tuple(
        Sharing(tuple(rule.connections), tuple(rule.stiffness or ()))
        for rule in tables
        if rule.connections is not None
    )


def parallel_rules(tables: Sequence[SharingTable]) -> tuple[Parallel, ...]:
    """Return the rules by which drives in parallel divide their force."""
    return tuple(
        Parallel(
            tuple(rule.parallel),
            tuple(rule.areas or rule.stiffness or ()),
            "stiffness" if rule.areas is None else "areas",
        )
        for rule in tables
        if rule.parallel is not None
    )

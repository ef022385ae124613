"""Tables of a linkage's motion: bodies, joints, transmission angles, checks."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from pinbase.dimensions import Floats
from reports.data.motion import LinkageMotion, Posture
from reports.data.results import Results
from reports.tables.column import ArrayTable, Column, Table, fields

Names = Callable[[LinkageMotion], Iterable[str]]


def _columns(key: str, names: Names) -> list[Column[LinkageMotion]]:
    """Return the columns of case, time and name, with a line for each name at every instant."""
    return [
        *fields("case"),
        Column(
            "time", lambda m: None if m.time is None else m.time.repeat(len([*names(m)])), "time"
        ),
        Column(key, lambda m: [*names(m)] * len(m.condition)),
    ]


def _flat(key: str, values: Callable[[LinkageMotion], Floats], dimension: str) -> Column[Any]:
    """Return a column of values (T, N) of N names; the names of an instant follow each other."""
    return Column(key, lambda m: values(m).ravel(), dimension)


def _of_each(
    key: str, values: Callable[[LinkageMotion], list[Floats]], dimension: str
) -> Column[Any]:
    """Return a column of values, N arrays (T,); the names of an instant follow each other."""
    return Column(key, lambda m: np.array(values(m)).T.ravel(), dimension)


def _xy(keys: tuple[str, str], name: str, dimension: str) -> list[Column[Any]]:
    """Return the columns of both components of vectors (T, N, 2)."""

    def component(k: int) -> Callable[[LinkageMotion], Floats]:
        return lambda m: getattr(m, name)[:, :, k]

    return [_flat(key, component(k), dimension) for k, key in enumerate(keys)]


BODY_COLUMNS = [
    *_columns("body", lambda m: m.bodies),
    *_xy(("x", "y"), "centre", "length"),
    _flat("angle_deg", lambda m: m.angle, "degrees"),
    *_xy(("vx", "vy"), "velocity", "velocity"),
    _flat("omega", lambda m: m.angular_velocity, "rate of turn"),
    *_xy(("ax", "ay"), "acceleration", "acceleration"),
    _flat("alpha", lambda m: m.angular_acceleration, "rate of rate of turn"),
]
JOINT_COLUMNS = [
    *_columns("joint", lambda m: m.joints),
    *_xy(("x", "y"), "joint_position", "length"),
    *_xy(("vx", "vy"), "joint_velocity", "velocity"),
    *_xy(("ax", "ay"), "joint_acceleration", "acceleration"),
]
CHECK_COLUMNS: list[Column[LinkageMotion]] = [
    *fields("case"),
    *fields("time", "time"),
    Column("shaking_fx", lambda m: m.shaking_force[:, 0], "force"),
    Column("shaking_fy", lambda m: m.shaking_force[:, 1], "force"),
    *fields("shaking_moment", "moment"),
    *fields("condition"),
    *fields("power_drives=ledger.drives power_gravity=ledger.gravity", "power"),
    *fields("power_applied=ledger.applied power_friction=ledger.friction", "power"),
    *fields("ledger.kinetic_rate", "power"),
]
SLIDER_COLUMNS = [
    *_columns("slider", lambda m: m.slider_forces),
    _of_each("normal", lambda m: [f.normal for f in m.slider_forces.values()], "force"),
    _of_each("couple", lambda m: [f.couple for f in m.slider_forces.values()], "moment"),
    _of_each("friction", lambda m: [f.friction for f in m.slider_forces.values()], "force"),
]
PATH_COLUMNS = [
    *_columns("point", lambda m: m.paths),
    _of_each("x", lambda m: [p.position[:, 0] for p in m.paths.values()], "length"),
    _of_each("y", lambda m: [p.position[:, 1] for p in m.paths.values()], "length"),
    _of_each("vx", lambda m: [p.velocity[:, 0] for p in m.paths.values()], "velocity"),
    _of_each("vy", lambda m: [p.velocity[:, 1] for p in m.paths.values()], "velocity"),
    _of_each("speed", lambda m: [p.speed for p in m.paths.values()], "velocity"),
    _of_each("curvature", lambda m: [p.curvature for p in m.paths.values()], "curvature"),
]


def linkage_tables(results: Results) -> list[Table[LinkageMotion]]:
    """Return the tables of the linkage over all cases.

    These are motion, joints, transmission (also in space), linkage, sliders and, if points are
    named, paths.
    """
    paths = {"paths": PATH_COLUMNS} if any(m.paths for m in results.motion) else {}
    every = {
        "motion": BODY_COLUMNS,
        "joints": JOINT_COLUMNS,
        "linkage": CHECK_COLUMNS,
        "sliders": SLIDER_COLUMNS,
        **paths,
    }
    tables = [ArrayTable(name, columns, results.motion) for name, columns in every.items()]
    return [*tables[:2], transmission_table(results), *tables[2:]]


def transmission_table(results: Results) -> Table[Any]:
    """Return the transmission angles of all cases, in the plane and in space."""
    columns: list[Column[Posture]] = [
        *fields("case"),
        Column(
            "time", lambda p: None if p.time is None else p.time.repeat(len(p.transmission)), "time"
        ),
        Column("link", lambda p: [*p.transmission] * (1 if p.time is None else len(p.time))),
        _of_each("degrees", lambda p: [*p.transmission.values()], "degrees"),
    ]
    return ArrayTable("transmission", columns, results.postures)

"""The force of each body on its pin at every instant, computed, stated or tabulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from loads.tables.csv_table import TableError
from loads.tables.force_columns import Layout, Unit
from loads.tables.force_table import TabledForces, read_forces
from pinbase.arrays import Floats, Ints

TIME_TOLERANCE = 1e-9  # of the largest time: files of one run state times to 9 digits or more
Components = dict[str, tuple[float, ...]]


@dataclass(frozen=True)
class Reactions:
    """Forces and moments of the bodies on the pins, at T instants and C connections.

    case: name of the load case.
    times: (T,) s, or None for a case without time (T = 1).
    connections: (C,) names of the connections.
    bodies: (C,) name of the body at each connection.
    forces, moments: (T, C, 3) N and N m, world axes.
    turn: rotation of the pin's axes relative to the world: for a planar linkage (T, C) rad about z;
    for a linkage in space (T, C, 3, 3), the pin's axes in world axes as columns.

    Raises: ArithmeticError where a force, moment or rotation is not finite.
    """

    case: str
    times: Floats | None
    connections: tuple[str, ...]
    bodies: tuple[str, ...]
    forces: Floats
    moments: Floats
    turn: Floats

    def __post_init__(self) -> None:
        for name in ("forces", "moments", "turn"):
            if not np.isfinite(getattr(self, name)).all():
                raise ArithmeticError(f"case {self.case}: the {name} are not finite")

    def __len__(self) -> int:
        return len(self.forces)

    def at(self, rows: Ints) -> Reactions:
        """The reactions at some of the instants. rows: indices of the instants."""
        arrays = (self.forces[rows], self.moments[rows], self.turn[rows])
        times = None if self.times is None else self.times[rows]
        return Reactions(self.case, times, self.connections, self.bodies, *arrays)

    @property
    def magnitudes(self) -> Floats:
        """Magnitudes of the forces, (T, C) N."""
        return np.asarray(np.linalg.norm(self.forces, axis=2))

    def force(self, connection: str) -> Floats:
        """Force on the pin at a connection, world axes, (T, 3) N."""
        return self.forces[:, self.connections.index(connection)]

    def in_pin_axes(self, connection: str) -> Floats:
        """Force on the pin at a connection, in the pin's axes, (T, 3) N."""
        return self.to_pin_axes(self.forces[:, self.connections.index(connection)], connection)

    def moment_in_pin_axes(self, connection: str) -> Floats:
        """Moment on the pin at a connection, in the pin's axes, (T, 3) N m."""
        return self.to_pin_axes(self.moments[:, self.connections.index(connection)], connection)

    def to_pin_axes(self, vectors: Floats, connection: str) -> Floats:
        """Components in the axes of a connection's pin, (T, 3), of vectors (T, 3) in world axes."""
        turn = self.turn[:, self.connections.index(connection)]
        if turn.ndim > 1:
            return np.asarray((vectors[:, None, :] @ turn)[:, 0])
        cos, sin = np.cos(turn), np.sin(turn)
        x, y, z = vectors.T
        return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=1)


def joined(parts: Sequence[Any]) -> Any:
    """One result from the results of successive batches of instants.

    Arrays are joined along time, also inside dataclasses and dicts; any other value is taken from
    the first batch, because it is the same in all.
    """
    first: Any = parts[0]
    if all(part is first for part in parts):
        return first
    if isinstance(first, np.ndarray):
        return np.concatenate(parts)
    if isinstance(first, dict):
        return {key: joined([part[key] for part in parts]) for key in first}
    if is_dataclass(first) and not isinstance(first, type):
        keys = [field.name for field in fields(first)]
        return replace(first, **{key: joined([getattr(p, key) for p in parts]) for key in keys})
    return first


def given_reactions(case: str, forces: Components, moments: Components | None = None) -> Reactions:
    """Reactions at a single instant, from stated forces and moments.

    forces, moments: components (x, y[, z]) by connection, in the pin's axes, N and N m; zero where
    not stated.
    """
    moments = moments or {}
    names = tuple(dict.fromkeys((*forces, *moments)))
    force, moment = (
        np.array([(*stated.get(n, ()), 0.0, 0.0, 0.0)[:3] for n in names], dtype=float)
        for stated in (forces, moments)
    )
    return Reactions(
        case=case,
        times=None,
        connections=names,
        bodies=("",) * len(names),
        forces=force[None],
        moments=moment[None],
        turn=np.zeros((1, len(names))),
    )


def read_reactions(path: Path, layout: Layout, unit: Unit, known: set[str]) -> Reactions:
    """Reactions from a table of forces on pins, in the pins' axes.

    unit: function that returns the SI value of a unit.
    known: names of the connections of the study.

    Raises: TableError for a faulty table; also where a connection has no row at one of the times.
    """
    table = read_forces(path, layout, unit, known)
    return _tabled(layout.case, table)


def tabled_reactions(
    case: str, files: Sequence[tuple[Path, Layout]], unit: Unit, known: set[str]
) -> Reactions:
    """Reactions of a case from one or several tables, each with some of the connections.

    files: path and layout of each table.
    unit, known: as for `read_reactions`.

    Raises: TableError for a faulty table; also where a connection is in two tables, or the times
    differ.
    """
    tables = [(path, read_forces(path, layout, unit, known)) for path, layout in files]
    (first_path, first), *others = tables
    for path, table in others:
        twice = set(first.connections) & set(table.connections)
        if twice:
            raise TableError(
                f"{path}: connection {min(twice)} is in another table of the case, too; keep one",
                "duplicate-row",
            )
        if not same_times(first.times, table.times):
            raise TableError(
                f"{path}: has other times than {first_path}; all tables of a case need the same",
                "missing-row",
            )
        first = replace(
            first,
            connections=first.connections + table.connections,
            values=np.concatenate([first.values, table.values], axis=1),
        )
    return _tabled(case, first)


def same_times(times: Floats | None, others: Floats | None) -> bool:
    """Whether two tables have the same times (T,) s, except for rounding."""
    if times is None or others is None:
        return times is others
    near = TIME_TOLERANCE * float(np.abs(times).max())
    return len(times) == len(others) and bool((np.abs(times - others) <= near).all())


def _tabled(case: str, table: TabledForces) -> Reactions:
    first = given_reactions(case, dict.fromkeys(table.connections, (0.0, 0.0)))
    return replace(
        first,
        times=table.times,
        forces=table.values[:, :, :3],
        moments=table.values[:, :, 3:],
        turn=np.zeros(table.values.shape[:2]),
    )

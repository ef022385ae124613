"""Reactions: the force of each body on its pin at every instant; computed, stated or tabulated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from loads.tables.csv_table import TableError
from loads.tables.force_table import Layout, Unit, read_forces
from pinbase.arrays import Floats

Components = dict[str, tuple[float, ...]]


@dataclass(frozen=True)
class Reactions:
    """Forces and moments of the bodies on the pins, at T instants and C connections.

    case: name of the case.
    times: (T,) s, or None for a case without time (T = 1).
    connections, bodies: C names; of the body at each connection.
    forces, moments: (T, C, 3) N and N m, world axes.
    turn: (T, C) rad, rotation of the pin's axes about z against the world's.

    Raises: ArithmeticError where something is not finite.
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
        cos, sin = np.cos(turn), np.sin(turn)
        x, y, z = vectors.T
        return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=1)


def given_reactions(case: str, forces: Components, moments: Components | None = None) -> Reactions:
    """Reactions at a single instant, from stated forces and moments.

    forces, moments: (x, y[, z]) by connection, in the pin's axes, N and N m; zero where not stated.
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

    unit: gives the SI value of a unit.
    known: the connections of the study.

    Raises: TableError; also where a connection has no row at one of the times.
    """
    data: dict[float | None, dict[str, list[float]]] = {}
    for row in read_forces(path, layout, unit, known):
        instant = data.setdefault(row.time, {})
        if row.connection in instant:
            raise TableError(
                f"{row.where}: connection {row.connection} is given twice at the same time; keep "
                "one row",
                "duplicate-row",
            )
        instant[row.connection] = row.values
    if not data:
        raise TableError(f"{path}: no row belongs to a connection of a pin", "no-rows")
    names = list(next(iter(data.values())))
    for time, instant in data.items():
        missing = set(names).symmetric_difference(instant)
        if missing or (time is None and len(data) > 1):
            raise TableError(
                f"{path}: connection {sorted(missing or names)[0]} has no row at time "
                f"{(time or 0.0) / unit('', 'time'):g}; every connection needs one at every time",
                "missing-row",
            )
    first = given_reactions(layout.case, dict.fromkeys(names, (0.0, 0.0)))
    order = sorted(data, key=lambda t: t or 0.0)
    forces, moments = np.split(np.array([[data[t][n] for n in names] for t in order]), 2, axis=2)
    return replace(
        first,
        times=None if order == [None] else np.array(order, dtype=float),
        forces=forces,
        moments=moments,
        turn=np.zeros(forces.shape[:2]),
    )

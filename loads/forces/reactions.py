"""Reactions: what each body does to its pin, at every instant; and reading them from a table."""

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
    """Forces and moments on the pins: instants x connections.

    case: name. times: (T,) s, or None for a case without time (T = 1). connections, bodies: C
    names. forces: (T, C, 3) N and moments: (T, C, 3) N m, world axes. turn: (T, C) rad, how far the
    pin's own axes have turned about z from the world's.
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
        """(T, C) N."""
        return np.asarray(np.linalg.norm(self.forces, axis=2))

    def force(self, connection: str) -> Floats:
        """(T, 3) N, world axes."""
        return self.forces[:, self.connections.index(connection)]

    def in_pin_axes(self, connection: str) -> Floats:
        """Force on the pin in its own axes, (T, 3) N."""
        return self.turned_back(self.forces[:, self.connections.index(connection)], connection)

    def moment_in_pin_axes(self, connection: str) -> Floats:
        """Moment on the pin in its own axes, (T, 3) N m."""
        return self.turned_back(self.moments[:, self.connections.index(connection)], connection)

    def turned_back(self, vectors: Floats, connection: str) -> Floats:
        """Vectors (T, 3) in world axes in those of the connection's pin."""
        turn = self.turn[:, self.connections.index(connection)]
        cos, sin = np.cos(turn), np.sin(turn)
        x, y, z = vectors.T
        return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=1)


def given_reactions(case: str, forces: Components, moments: Components | None = None) -> Reactions:
    """One instant of stated forces (N) and moments (N m) by connection, in the pin's own axes:
    (x, y[, z]). Those not named are zero.
    """
    moments = moments or {}
    names = tuple(dict.fromkeys((*forces, *moments)))
    force, moment = (
        np.array([(*given.get(n, ()), 0.0, 0.0, 0.0)[:3] for n in names], dtype=float)
        for given in (forces, moments)
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
    """Reactions from a table of forces on pins, in their own axes. unit: SI value of a unit of a
    dimension. known: the connections of the study. With times the case is a sweep: every
    connection must be given at every time.

    Raises: TableError.
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
        raise TableError(f"{path}: no row is of a connection of the pins", "no-rows")
    names = list(next(iter(data.values())))
    for time, instant in data.items():
        gap = set(names).symmetric_difference(instant)
        if gap or (time is None and len(data) > 1):
            raise TableError(
                f"{path}: connection {sorted(gap or names)[0]} has no row at time "
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

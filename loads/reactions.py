"""Reactions: what each body does to its pin, at every instant; and reading them from a table."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from loads.linkage import Floats


class TableError(ValueError):
    """A table of reactions cannot be used; the message names the file, the line and the remedy."""


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
                raise ArithmeticError(f"case {self.case}: {name} that are not finite")

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
        c = self.connections.index(connection)
        cos, sin = np.cos(self.turn[:, c]), np.sin(self.turn[:, c])
        fx, fy, fz = self.forces[:, c].T
        return np.stack([cos * fx + sin * fy, cos * fy - sin * fx, fz], axis=1)


def given_reactions(case: str, forces: dict[str, tuple[float, ...]]) -> Reactions:
    """One instant of stated forces (N) per connection, in the pin's own axes: (fx, fy[, fz])."""
    values = np.array([(*f, 0.0)[:3] for f in forces.values()], dtype=float)
    names = tuple(forces)
    return Reactions(
        case=case,
        times=None,
        connections=names,
        bodies=("",) * len(names),
        forces=values[None],
        moments=np.zeros((1, len(names), 3)),
        turn=np.zeros((1, len(names))),
    )


def read_reactions(
    case: str, path: Path, force_unit: float, time_unit: float, known: set[str]
) -> Reactions:
    """Reactions from a CSV with the columns connection, fx, fy and optionally fz and time.

    force_unit, time_unit: the table's units in N and s. known: the connections of the study. With
    a time column the case is a sweep: every connection must be given at every time.

    Raises: TableError.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise TableError(f"{path}: no such file; tables are looked up beside the study") from None
    except (OSError, UnicodeDecodeError) as error:
        raise TableError(f"{path}: cannot be read as UTF-8 text ({error})") from None
    rows = csv.DictReader(text.splitlines(), skipinitialspace=True)
    columns = [name.strip() for name in rows.fieldnames or []]
    missing = [c for c in ("connection", "fx", "fy") if c not in columns]
    if missing:
        raise TableError(
            f"{path}: column {missing[0]!r} is missing; needed are connection,fx,fy "
            "and, if there are any, fz and time"
        )
    rows.fieldnames = columns
    data: dict[float | None, dict[str, tuple[float, float, float]]] = {}
    for row in rows:
        where = f"{path}, line {rows.line_num}"
        name = (row["connection"] or "").strip()
        if name not in known:
            raise TableError(
                f"{where}: unknown connection {name!r}; the study's pins have "
                f"{', '.join(sorted(known))}"
            )
        time = _number(row, "time", where) * time_unit if "time" in columns else None
        fz = _number(row, "fz", where) if "fz" in columns else 0.0
        force = (_number(row, "fx", where), _number(row, "fy", where), fz)
        instant = data.setdefault(time, {})
        if name in instant:
            raise TableError(f"{where}: connection {name} is given twice at the same instant")
        instant[name] = (force[0] * force_unit, force[1] * force_unit, force[2] * force_unit)
    if not data:
        raise TableError(f"{path}: the table has no rows")
    names = list(next(iter(data.values())))
    for time, instant in data.items():
        gap = set(names).symmetric_difference(instant)
        if gap:
            raise TableError(
                f"{path}: connection {sorted(gap)[0]} is not given at every time "
                f"(see time {(time or 0.0) / time_unit:g})"
            )
    first = given_reactions(case, dict.fromkeys(names, (0.0, 0.0)))
    order = sorted(data, key=lambda t: t or 0.0)
    forces = np.array([[data[t][n] for n in names] for t in order])
    return replace(
        first,
        times=np.array(order, dtype=float) if "time" in columns else None,
        forces=forces,
        moments=np.zeros_like(forces),
        turn=np.zeros(forces.shape[:2]),
    )


def _number(row: dict[str, str], column: str, where: str) -> float:
    text = row[column]
    try:
        value = float(text)
    except (TypeError, ValueError):
        raise TableError(f"{where}: {column} = {text!r} is not a number") from None
    if not math.isfinite(value):
        raise TableError(f"{where}: {column} = {text} is not finite")
    return value

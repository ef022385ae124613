"""Tables of reactions and drives along a motion, of the leg in space, and of the checks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice
from typing import overload

import numpy as np

from reports.data.results import (
    BeamCheck,
    DriveTable,
    Floats,
    LegTable,
    MotionCheck,
    ReactionTable,
    Results,
)
from reports.format.files.csv import Cell
from reports.tables.table import Table

REACTION_COLUMNS = ("case", "time", "connection", "body", "fx", "fy", "fz", "mx", "my", "mz")
DRIVE_COLUMNS = (
    "time",
    "position",
    "velocity",
    "acceleration",
    "force",
    "power",
    "work",
    "kinetic_energy",
    "potential_energy",
)
BEAM_CHECK_COLUMNS = (
    "z",
    "shear",
    "moment",
    "beam_axial_stress",
    "fea_axial_stress",
    "fea_axial_stress_axis_load",
)
MOTION_CHECK_COLUMNS = (
    "time",
    "speed",
    "acceleration",
    "closed_form_speed",
    "closed_form_acceleration",
)


def reactions_table(results: Results) -> Table:
    """The forces and moments on the pins, world axes: a row per instant and connection."""
    return Table("reactions", REACTION_COLUMNS, Instants(results.reactions))


def reactions_pin_axes_table(results: Results) -> Table:
    """The same in the axes of each pin, which turn with the body that carries it."""
    turned = tuple(
        replace(t, forces=_in_pin_axes(t, t.forces), moments=_in_pin_axes(t, t.moments))
        for t in results.reactions
    )
    return Table("reactions_pin_axes", REACTION_COLUMNS, Instants(turned))


def _in_pin_axes(table: ReactionTable, vectors: Floats) -> Floats:
    turn = np.zeros(vectors.shape[:2]) if table.turn is None else table.turn
    c, s = np.cos(turn), np.sin(turn)
    x, y, z = np.moveaxis(vectors, 2, 0)
    return np.stack([c * x + s * y, c * y - s * x, z], axis=2)


class Instants(Sequence[Sequence[Cell]]):
    """A row per instant and connection of some tables, made one by one: there may be
    millions.
    """

    def __init__(self, tables: Sequence[ReactionTable]) -> None:
        self._tables = tables

    def __len__(self) -> int:
        return sum(len(t.forces) * len(t.connections) for t in self._tables)

    @overload
    def __getitem__(self, k: int) -> Sequence[Cell]: ...

    @overload
    def __getitem__(self, k: slice) -> list[Sequence[Cell]]: ...

    def __getitem__(self, k: int | slice) -> Sequence[Cell] | list[Sequence[Cell]]:
        if isinstance(k, slice):
            return list(islice(self, *k.indices(len(self))))
        return next(islice(self, range(len(self))[k], None))

    def __iter__(self) -> Iterator[Sequence[Cell]]:
        for table in self._tables:
            names = list(zip(table.connections, table.bodies, strict=True))
            values = np.concatenate([table.forces, table.moments], axis=2)
            for t, instant in enumerate(values):
                time = None if table.times is None else float(table.times[t])
                for name, parts in zip(names, instant.tolist(), strict=True):
                    yield [table.case, time, *name, *parts]


def drive_table(results: Results) -> Table:
    """The drives in every case, with the case in the first column."""
    rows: Iterator[list[Cell]] = (
        [table.case, *_drive_values(table, t), table.name, table.kind]
        for table in results.drive
        for t in range(len(table.force))
    )
    turning = any(table.kind != "slider" for table in results.drive)
    mixed = ("position", "velocity", "acceleration", "force") if turning else ()
    return Table.of("drive", ("case", *DRIVE_COLUMNS, "drive", "kind"), rows, mixed)


def _drive_values(table: DriveTable, t: int) -> list[Cell]:
    """Of one instant; without time there is no work."""
    absent = ("time", "work") if table.time is None else ()
    return [None if name in absent else float(getattr(table, name)[t]) for name in DRIVE_COLUMNS]


def beam_check_table(check: BeamCheck) -> Table:
    """Shear, moment and axial stresses along the cantilever pin."""
    rows = zip(*(getattr(check, name) for name in BEAM_CHECK_COLUMNS), strict=True)
    return Table.of("beam_check", BEAM_CHECK_COLUMNS, rows)


def motion_check_table(check: MotionCheck) -> Table:
    """A joint's speed and acceleration, from the linkage and in closed form."""
    rows = zip(*(getattr(check, name) for name in MOTION_CHECK_COLUMNS), strict=True)
    return Table.of("motion_check", MOTION_CHECK_COLUMNS, rows)


def leg_table(tables: tuple[LegTable, ...]) -> Table:
    """The dynamics of a spatial leg, all cases: a row per instant, a column per component; the
    columns carry their units, vectors end in _x, _y, _z (primed axes).
    """
    first = tables[0]
    columns = ["case", "time"]
    columns += [f"{name} [{q.unit}]" for name, q in first.scalars.items()]
    columns += [f"{name}_{c} [{q.unit}]" for name, q in first.vectors.items() for c in "xyz"]
    rows: list[list[Cell]] = []
    for table in tables:
        for t, time in enumerate(table.time):
            row: list[Cell] = [table.case, float(time)]
            row += [float(q.values[t]) for q in table.scalars.values()]
            row += [float(x) for q in table.vectors.values() for x in q.values[t]]
            rows.append(row)
    return Table.of("leg", columns, rows)

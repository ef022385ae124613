"""Tables of forces on pins in the layouts that other programs write.

A table has a row for each connection and instant, or a column for each component of each
connection; it may have units in its header and several cases.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

import numpy as np

from loads.tables.csv_table import TableError
from loads.tables.force_columns import (
    FORCE_COMPONENTS,
    ForceColumn,
    Layout,
    Unit,
    column_index,
    force_columns,
)
from loads.tables.grid import TableGrid, text_of
from loads.tables.numbers import TableNumbers
from loads.tables.open_table import open_table, rows_by_case
from pinbase.arrays import Floats
from pinbase.grouped import grouped

OWN_TABLE_COLUMNS = {"case", "body"}  # a table with these columns is an output of this program

Indices = Sequence[int] | None  # indices of rows; None for all rows


@dataclass(frozen=True)
class TabledForces:
    """The forces and moments of a table.

    connections: (C,) names.
    times: (T,) s, ascending; None for one instant without a time. Where a time was given twice, for
    the values before and after a jump, the second is larger by the least distinguishable step.
    values: (T, C, 6) fx, fy, fz in N, mx, my, mz in N m, in pin axes.
    """

    connections: tuple[str, ...]
    times: Floats | None
    values: Floats


def table_cases(path: Path, layout: Layout) -> list[str]:
    """The names in a table's column `case`, in their order.

    Raises: TableError for a faulty table, without this column, or with a case without a name.
    """
    at = layout.columns.get("case", "case")
    grid = open_table(path, layout.file_reading)
    index = column_index(grid, "case", at)
    names = rows_by_case(path, layout.file_reading, index)
    if "" in names:
        raise TableError(f"{grid.where(names[''][0])}: the case has no name", "no-such-case")
    return list(names)


def read_forces(path: Path, layout: Layout, unit: Unit, known: set[str]) -> TabledForces:
    """The forces in a table.

    unit: function that returns the SI value of a unit.
    known: connections of the study. Other connections are an error, except in a table with labels
    or a table that this program wrote, where they are skipped.

    Raises: TableError for a faulty table; also where a connection has no row at one of the times.
    """
    grid = open_table(path, layout.file_reading)
    columns = force_columns(grid, layout, unit)
    rows = _rows_of_case(path, grid, layout)
    by_connection = _by_connection(grid, columns, rows, layout, known)
    if not by_connection:
        raise TableError(f"{path}: no row belongs to a connection of a pin", "no-rows")
    with_numbers = [c.index for c in columns if c.meaning in (*FORCE_COMPONENTS, "time")]
    cells = TableNumbers(grid, with_numbers, layout.reading.decimal)
    forces = _Forces(grid, cells, columns, layout, unit("", "time"))
    times, values = list[Floats | None](), list[Floats]()
    for name, (some, components) in by_connection.items():
        own = forces.times(name, some)
        order = slice(None, None, -1 if own is not None and own[0] > own[-1] else 1)
        times.append(None if own is None else own[order])
        force = layout.axes_of(name).in_pin_axes(forces.values(some, components))
        values.append(force[order])
    names = tuple(by_connection)
    forces.require_same_times(names, times)
    return TabledForces(names, _distinct(times[0]), np.stack(values, axis=1))


def _rows_of_case(path: Path, grid: TableGrid, layout: Layout) -> Indices:
    """The rows of the case, or all rows of a table without cases.

    Raises: TableError where no row has the case.
    """
    at = layout.columns.get("case", "case")
    if "case" not in layout.columns and "case" not in grid.names:
        return None
    cases = rows_by_case(path, layout.file_reading, column_index(grid, "case", at))
    if layout.case not in cases:
        names = ", ".join(sorted(cases)[:6])
        raise TableError(
            f"{path}: no row has the case {layout.case!r}; there are {names}", "no-such-case"
        )
    return cases[layout.case]


def _by_connection(
    grid: TableGrid, columns: list[ForceColumn], rows: Indices, layout: Layout, known: set[str]
) -> dict[str, tuple[Indices, list[ForceColumn]]]:
    """The rows of each connection and the columns of its components.

    Raises: TableError for an unknown connection.
    """
    first = 0 if rows is None else rows[0]
    at = next((c.index for c in columns if c.meaning == "connection"), None)
    every: dict[str, tuple[Indices, list[ForceColumn]]] = {}
    if at is None:
        for name in dict.fromkeys(c.connection for c in columns if c.connection is not None):
            every[name] = rows, [c for c in columns if c.connection == name]
    else:
        of_labels = {str(label): name for name, label in layout.labels.items()}
        components = [c for c in columns if c.meaning in FORCE_COMPONENTS]
        cells = grid.columns[at]
        chosen = range(len(cells)) if rows is None else rows
        groups = grouped((text_of(cells[k]), k) for k in chosen)
        every = {of_labels.get(label, label): (some, components) for label, some in groups.items()}
    others_skipped = bool(layout.labels) or set(grid.names) >= OWN_TABLE_COLUMNS
    for name, (some, _) in every.items():
        if name not in known and not others_skipped:
            where = grid.where(first if some is None else some[0], at)
            raise TableError(
                f"{where}: no pin has a connection {name[:40]!r}; there are "
                f"{', '.join(sorted(known))}",
                "unknown-connection",
            )
    return {name: part for name, part in every.items() if name in known}


@dataclass(frozen=True)
class _Forces:
    """The numbers of a table of forces. time: SI value of the unit of time, for messages."""

    grid: TableGrid
    numbers: TableNumbers
    columns: list[ForceColumn]
    layout: Layout
    time: float

    def values(self, rows: Indices, components: list[ForceColumn]) -> Floats:
        """Forces and moments in the table's axes, (R, 6) N and N m; zero without a column."""
        count = len(self.grid.places if rows is None else rows)
        out = np.zeros((count, len(FORCE_COMPONENTS)))
        for c in components:
            values = self.numbers.column(c.index, rows)
            out[:, FORCE_COMPONENTS.index(c.meaning)] = c.factor * values
        return out

    def times(self, name: str, rows: Indices) -> Floats | None:
        """Times of the rows of a connection, (R,) s; None for one row without a time.

        Raises: TableError for several rows without a time, or for times that neither ascend
        nor descend.
        """
        some = range(len(self.grid.places)) if rows is None else rows
        column = next((c for c in self.columns if c.meaning == "time"), None)
        if column is not None:
            cells = self.grid.columns[column.index]
            numbers = isinstance(cells, np.ndarray)
            without = [] if numbers else [k for k in some if cells[k] == ""]
            if without and len(without) < len(some):
                raise TableError(
                    f"{self.grid.where(without[0], column.index)}: connection {name} has no time "
                    "here, but other rows have; every row needs one",
                    "missing-row",
                )
            if not without:
                times = column.factor * self.numbers.column(column.index, rows)
                self._require_events(name, times, some)
                return np.asarray(times + self.layout.offset)
        if self.layout.step is not None:
            return np.asarray(np.arange(len(some)) * self.layout.step + self.layout.offset)
        if len(some) > 1:
            raise self._given_twice(name, some[1], "twice at the same time; keep one row")
        return None

    def _require_events(self, name: str, times: Floats, rows: Sequence[int]) -> None:
        """Raise TableError unless times ascend, or descend throughout.

        A time may occur twice, for the values before and after a jump, but not more often. Times
        that go back in between may come from a file of several runs, which sorting would mix up.
        """
        step = np.diff(times)
        if (step < 0.0).all():
            return  # rows in descending order
        if (step < 0.0).any():
            k = int(np.argmax(step < 0.0))
            before, after = times[k : k + 2] / self.time
            raise TableError(
                f"{self.grid.where(rows[k + 1])}: the time of connection {name} goes back from "
                f"{before:.12g} to {after:.12g}; sort the rows by time, and tell several runs in "
                "one file apart by a column 'case'",
                "time-goes-back",
            )
        thrice = (step[:-1] == 0.0) & (step[1:] == 0.0)
        if thrice.any():
            k = int(np.argmax(thrice))
            what = f"thrice at the same time {times[k] / self.time:.12g}"
            raise self._given_twice(
                name, rows[k + 2], f"{what}; keep the rows before and after the jump"
            )

    def _given_twice(self, name: str, row: int, what: str) -> TableError:
        where = self.grid.where(row)
        return TableError(f"{where}: connection {name} is given {what}", "duplicate-row")

    def require_same_times(self, names: Sequence[str], times: Sequence[Floats | None]) -> None:
        """Raise TableError where a connection has no row at a time of another connection."""
        for name, own in zip(names, times, strict=True):
            if own is times[0] or (
                own is not None and times[0] is not None and np.array_equal(own, times[0])
            ):
                continue
            time, lacking = _first_difference(names[0], times[0], name, own)
            raise TableError(
                f"{self.grid.source.file}: connection {lacking} has no row at time "
                f"{time / self.time:g}; every connection needs one at every time",
                "missing-row",
            )


def _first_difference(
    name: str, times: Floats | None, other: str, others: Floats | None
) -> tuple[float, str]:
    """The first time at which one of two connections lacks a row, and the name of that one."""
    here, there = (list[float]() if t is None else t.tolist() for t in (times, others))
    for a, b in zip_longest(here, there, fillvalue=np.inf):
        if a != b:
            return (b, name) if b < a else (a, other)
    return 0.0, name


def jump_times(times: Floats) -> Floats:
    """The times (J,) s at which a table has values before and after a jump. times: (T,) s."""
    return np.asarray(times[1:][np.diff(times) <= 2.0 * _least_step(times)])


def _least_step(times: Floats) -> float:
    """The least distinguishable step, s, of floating-point numbers of the size of these times."""
    return float(np.spacing(max(1.0, float(np.abs(times).max()))))


def _distinct(times: Floats | None) -> Floats | None:
    """Times (T,) s, in which every instant has a time of its own.

    The second of two equal times, after a jump, is larger by the least distinguishable step.
    """
    if times is None or np.diff(times).all():
        return times
    least = _least_step(times)
    again = np.concatenate([[False], np.diff(times) == 0.0])
    return np.where(again, np.maximum(times + least, np.nextafter(times, np.inf)), times)

"""The meaning of the columns of a table of forces, and their factors to SI."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from loads.tables.csv_table import TableError
from loads.tables.grid import FileReading, TableGrid, empty_columns, is_number, unique_names
from pinbase.arrays import Floats

FORCE_COMPONENTS = ("fx", "fy", "fz", "mx", "my", "mz")
TEXT_COLUMNS = ("case", "connection", "body")
COMPONENT_DIMENSIONS = {"f": "force", "m": "moment", "t": "time"}  # by a column's first letter
HEADER_PATTERN = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\]|\((?P<bracket>[^)]*)\))?\s*$")
WIDE_COLUMN_PATTERN = re.compile(r"(?P<connection>.+?)[. ](?P<component>[fm][xyz])$")
MAX_LISTED_COLUMNS = 12

Turn = tuple[tuple[float, float, float], ...]
SAME_AXES: Turn = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
Unit = Callable[[str, str], float]  # (unit, dimension) -> SI value; unit "": the table's default


@dataclass(frozen=True)
class JointAxes:
    """The axes and the reference point in which a table gives the force of a connection.

    turn: (3, 3) rows are the pin's axes x, y, z in the table's axes, negative where the table has
    the force of the pin on the link.
    arm: (3,) m, pin axes, vector from the middle of the band to the point about which the table's
    moments are taken.
    """

    turn: Turn = SAME_AXES
    arm: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def in_pin_axes(self, values: Floats) -> Floats:
        """Force and moment about the middle of the band (R, 6) from those of the table (R, 6)."""
        turn = np.array(self.turn)
        force, moment = values[:, :3] @ turn.T, values[:, 3:] @ turn.T
        return np.concatenate([force, moment + np.cross(self.arm, force)], axis=1)

    @property
    def needed(self) -> tuple[str, ...]:
        """The components of the table from which the pin's transverse force follows."""
        across = np.abs(np.array(self.turn)[:2]).max(axis=0) > 0.0
        return tuple(c for c, use in zip(FORCE_COMPONENTS, across, strict=False) if use)


@dataclass(frozen=True)
class Layout:
    """The meaning of a table's columns and labels.

    case: name of the load case to read from a table with a column `case`.
    columns: header of each column by its meaning, preceded by a minus where the sign differs; in a
    table without a header, the column's number from 1.
    labels: text in the column `connection` by the connection's name in the study.
    step: time between the rows of one connection in a table without times, s.
    offset: time added to all times, s.
    units: units stated in the study, by the meaning of a column or by dimension.
    unit_needed: meanings of columns, or dimensions, without a default unit.
    axes: axes by connection, where those of the table differ from the pin's; the key "" stands for
    all other connections.
    reading: properties of the file that the study states.
    """

    case: str
    columns: Mapping[str, str | int] = field(default_factory=dict)
    labels: Mapping[str, str | int] = field(default_factory=dict)
    step: float | None = None
    offset: float = 0.0
    units: Mapping[str, str] = field(default_factory=dict)
    unit_needed: frozenset[str] = frozenset()
    axes: Mapping[str, JointAxes] = field(default_factory=dict)
    reading: FileReading = field(default_factory=FileReading)

    @property
    def file_reading(self) -> FileReading:
        """The rules for reading the file, which needs no header if all columns are numbers."""
        columns = self.columns.values()
        numbered = bool(columns) and all(isinstance(c, int) for c in columns)
        texts = frozenset(self.columns.get(meaning, meaning) for meaning in TEXT_COLUMNS)
        return replace(self.reading, numbered=numbered, texts=texts)

    def axes_of(self, connection: str) -> JointAxes:
        """The axes in which the force of a connection is written."""
        return self.axes.get(connection) or self.axes.get("") or JointAxes()


@dataclass(frozen=True)
class ForceColumn:
    """A column of a table.

    index: number of the column, from 0.
    factor: factor from its numbers to SI, negative where the sign differs.
    connection: connection to which the component belongs, in a table with a column per component;
    otherwise None.
    meaning: fx, .., mz, time, case, connection or body.
    """

    index: int
    factor: float
    connection: str | None
    meaning: str


def column_index(grid: TableGrid, meaning: str, at: str | int) -> int:
    """The index of a stated column. Raises: TableError unless there is exactly one."""
    file, names = grid.source.file, list(grid.names)
    if isinstance(at, int):
        if not 1 <= at <= len(grid.columns):
            raise TableError(
                f"{file}: column {at} for {meaning} is missing; there are {len(grid.columns)}",
                "missing-column",
            )
        return at - 1
    wanted = " ".join(at.split())
    if names.count(wanted) > 1:
        numbers = " and ".join(str(k + 1) for k, name in enumerate(names) if name == wanted)
        raise TableError(
            f"{file}: column {wanted[:40]!r} for {meaning} occurs twice; give its number, "
            f"{numbers}",
            "duplicate-column",
        )
    if wanted not in names:
        there = ", ".join(names[:MAX_LISTED_COLUMNS]) or "no headers; give numbers"
        raise TableError(
            f"{file}: column {wanted!r} for {meaning} is missing; there are {there}",
            "missing-column",
        )
    return names.index(wanted)


def force_columns(grid: TableGrid, layout: Layout, unit: Unit) -> list[ForceColumn]:
    """The columns of a table with their meaning and factor to SI.

    unit: function that returns the SI value of a unit.

    Raises: TableError for unknown, missing or repeated columns, and for missing or conflicting
    units.
    """
    out = []
    for meaning, index, sign in _chosen(grid, layout):
        parts = HEADER_PATTERN.fullmatch(meaning)
        assert parts is not None
        wide = WIDE_COLUMN_PATTERN.fullmatch(parts["name"])
        component = wide["component"] if wide else parts["name"]
        if component not in (*FORCE_COMPONENTS, "time", *TEXT_COLUMNS):
            what = f"unknown column {component[:40]!r}"
            if not component:
                what = f"column {index + 1} has no header (the row numbers of pandas?)"
            raise TableError(
                f"{grid.source.file}: {what}; allowed: connection, {', '.join(FORCE_COMPONENTS)}, "
                "time, case, body; or B.fx for the force on connection B. To leave columns out, "
                'state those to read: columns = { time = "time", "B.fx" = "B.fx", ... }',
                "unknown-column",
            )
        factor = 1.0
        if component not in TEXT_COLUMNS:
            dimension = COMPONENT_DIMENSIONS[component[0]]
            factor = sign * _factor(grid, index, parts["name"], dimension, layout, unit)
        elif grid.units[index : index + 1] > ("",):
            raise TableError(
                f"{grid.source.at(grid.unit_place, index)}: the row has no number, and is not a "
                "row of units",
                "not-a-number",
            )
        out.append(ForceColumn(index, factor, wide["connection"] if wide else None, component))
    _require_components(grid, out, layout)
    return out


def _chosen(grid: TableGrid, layout: Layout) -> Iterator[tuple[str, int, float]]:
    """Meaning, index and sign of each column: as the layout states, or by the headers."""
    if not layout.columns:
        unique_names(grid)
        unused = empty_columns(grid)
        yield from ((h, k, 1.0) for k, h in enumerate(grid.names) if k not in unused)
        return
    for meaning, at in layout.columns.items():
        if isinstance(at, int):
            yield meaning, column_index(grid, meaning, abs(at)), -1.0 if at < 0 else 1.0
        elif at.startswith("-") and at not in grid.names:
            negative = int(at[1:]) if at[1:].isdigit() and not grid.names else at[1:]
            yield meaning, column_index(grid, meaning, negative), -1.0
        else:
            yield meaning, column_index(grid, meaning, at), 1.0


def _factor(
    grid: TableGrid, index: int, meaning: str, dimension: str, layout: Layout, unit: Unit
) -> float:
    """The factor of a column to SI, from the unit in the study, the header or the row of units.

    Raises: TableError where these units disagree, or where there is neither a unit nor a default.
    """
    stated = layout.units.get(meaning) or layout.units.get(dimension, "")
    where = grid.source.file
    header = HEADER_PATTERN.fullmatch(grid.names[index] if grid.names else "")
    assert header is not None
    written = {
        "header": header["unit"] or header["bracket"] or "",
        "row of units": grid.units[index] if grid.units else "",
    }
    factors = {}
    for place, text in written.items():
        if not text:
            continue
        try:
            factors[place] = unit(text, dimension)
        except TableError as error:
            if not stated:
                at = where if place == "header" else grid.source.at(grid.unit_place, index)
                raise TableError(f"{at}: {grid.name(index)}: {error}", error.code) from None
    if stated:
        factors = {"study": unit(stated, dimension), **factors}
    if not factors:
        if layout.unit_needed & {meaning, dimension}:
            raise TableError(
                f"{where}: column {grid.name(index)!r} for {meaning} has no unit; state "
                "moment_unit beside unit",
                "missing-unit",
            )
        return unit("", dimension)
    place, factor = next(iter(factors.items()))
    for other, value in factors.items():
        if not np.isclose(value, factor, rtol=1e-9, atol=0.0):
            raise TableError(
                f"{where}: column {grid.name(index)!r}: the {place} has another unit than the "
                f"{other}, {written.get(place, stated)!r} and {written[other]!r}; correct one",
                "units-differ",
            )
    return factor


def _require_components(grid: TableGrid, columns: list[ForceColumn], layout: Layout) -> None:
    """Raise TableError unless every component needed has one column, used for nothing else."""
    path = grid.source.file
    seen = [(c.connection, c.meaning) for c in columns]
    for key in seen:
        if seen.count(key) > 1:
            raise TableError(
                f"{path}: column {'.'.join(filter(None, key))!r} occurs twice; keep one",
                "duplicate-column",
            )
    first = dict[tuple[str | None, int], ForceColumn]()
    for c in columns:
        other = first.setdefault((c.connection, c.index), c)
        if other is not c:
            raise TableError(
                f"{path}: column {c.index + 1} is stated for {other.meaning} and {c.meaning}"
                f"{f' of {c.connection}' if c.connection else ''}; each has its own",
                "duplicate-column",
            )
    wide = {c.connection for c in columns if c.connection is not None}
    if not wide and (None, "connection") not in seen:
        numbers = bool(grid.names) and all(map(is_number, grid.names))
        raise TableError(
            f"{path}: column 'connection' is missing; needed: connection,fx,fy, or a column per "
            "component like B.fx,B.fy"
            + "; the first row has only numbers: state the columns by number"
            * numbers,
            "missing-column",
        )
    for connection in wide or (None,):
        axes = layout.axes_of(connection or "")
        for component in axes.needed:
            if (connection, component) not in seen:
                name = component if connection is None else f"{connection}.{component}"
                raise TableError(f"{path}: column {name!r} is missing", "missing-column")

"""Tables of forces on pins in the layouts that other programs write.

A table has a row for each connection and instant, or a column for each component of each
connection; it may have units in its header and several cases.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from loads.tables.csv_table import TableError, TableLine, read_table
from loads.tables.sent_files import stamp

FORCE_COMPONENTS = ("fx", "fy", "fz", "mx", "my", "mz")
COMPONENT_DIMENSIONS = {"f": "force", "m": "moment", "t": "time"}  # by a column's first letter
HEADER_PATTERN = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\]|\((?P<bracket>[^)]*)\))?\s*$")
WIDE_COLUMN_PATTERN = re.compile(r"(?P<connection>.+?)[. ](?P<component>[fm][xyz])$")
OWN_TABLE_COLUMNS = {"case", "body"}  # a table with these columns is one of our own outputs

Unit = Callable[[str, str], float]  # (unit, dimension) -> its SI value; "": the table's default


@dataclass(frozen=True)
class Layout:
    """The meaning of a table's columns and labels.

    case: name of the case to read from a table with a column `case`.
    columns: header of each column by its meaning, preceded by a minus where the sign differs; its
    number from 1 in a table without a header.
    labels: text in the column `connection` by the connection's name here.
    step: time between the rows of one connection in a table without times, s.
    """

    case: str
    columns: Mapping[str, str | int] = field(default_factory=dict)
    labels: Mapping[str, str | int] = field(default_factory=dict)
    step: float | None = None


def table_cases(path: Path, columns: Mapping[str, str | int]) -> list[str]:
    """The names in a table's column `case`, in their order. columns: as of a Layout.

    Raises: TableError.
    """
    names = dict[str, None]()
    at = str(columns.get("case", "case"))
    for row in read_table(path, (at,), free=True, numbered=_numbered(columns)):
        if not row.cells[at]:
            raise TableError(f"{row.where}: the case has no name", "no-such-case")
        names[row.cells[at]] = None
    return list(names)


def _numbered(columns: Mapping[str, str | int]) -> bool:
    """Whether columns are stated by number, which means that the table has no header."""
    return bool(columns) and all(isinstance(c, int) for c in columns.values())


@dataclass(frozen=True)
class GivenForce:
    """Force and moment on a connection, as a row of a table gives them.

    where: file and line, for messages.
    time: s, or None.
    values: fx, fy, fz in N, mx, my, mz in N m.
    """

    where: str
    connection: str
    time: float | None
    values: list[float]


@dataclass(frozen=True)
class _Column:
    """A column of a table.

    factor: from its numbers to SI, negative where the sign differs.
    connection: whose component it is, in a table with a column per component; otherwise None.
    meaning: fx, .., mz, time, case, connection or body.
    """

    header: str
    factor: float
    connection: str | None
    meaning: str


def read_forces(path: Path, layout: Layout, unit: Unit, known: set[str]) -> Iterator[GivenForce]:
    """The forces in a table.

    unit: gives the SI value of a unit.
    known: connections of the study; others are an error, except in a table with labels or one that
    this program wrote, where they are skipped.

    Raises: TableError.
    """
    names = {label: name for name, label in _labels(layout.labels)}
    count: dict[str, int] = {}
    columns: list[_Column] | None = None
    for row in _rows(path, layout):
        if columns is None:
            columns = _columns(path, list(row.cells), layout, unit)
        text = {c.meaning: row.cells[c.header] for c in columns if c.connection is None}
        is_own_table = set(row.cells) >= OWN_TABLE_COLUMNS
        for name, components in _by_connection(row, columns, text, names):
            if name not in known and (is_own_table or layout.labels):
                continue
            if name not in known:
                raise TableError(
                    f"{row.where}: no pin has a connection {name[:40]!r}; there are "
                    f"{', '.join(sorted(known))}",
                    "unknown-connection",
                )
            time = _time(row, columns, text, layout, count.setdefault(name, 0))
            count[name] += 1
            yield GivenForce(row.where, name, time, _values(row, components))


def _rows(path: Path, layout: Layout) -> Iterator[TableLine]:
    """The rows of the case, or all rows of a table without cases.

    Raises: TableError where no row has the case.
    """
    at, numbered = str(layout.columns.get("case", "case")), _numbered(layout.columns)
    cases = _by_case(path, stamp(path), at, numbered)
    if cases is None:
        yield from read_table(path, (), free=True, numbered=numbered)
        return
    if layout.case not in cases:
        names = ", ".join(sorted(cases)[:6])
        raise TableError(
            f"{path}: no row has the case {layout.case!r}; there are {names}", "no-such-case"
        )
    yield from cases[layout.case]


@lru_cache(maxsize=1)  # the cases of one table follow each other
def _by_case(path: Path, _: str, at: str, numbered: bool) -> dict[str, list[TableLine]] | None:
    """The rows of a table by case, or None without a column of cases.

    _: the file's stamp, which makes the cache notice a changed file.
    at: name of the column of cases.
    """
    cases: dict[str, list[TableLine]] = {}
    for row in read_table(path, (), free=True, numbered=numbered):
        if at not in row.cells:
            return None
        cases.setdefault(row.cells[at], []).append(row)
    return cases or None


def _labels(labels: Mapping[str, str | int]) -> Iterator[tuple[str, str]]:
    """Connections and their labels as text."""
    return ((name, str(label)) for name, label in labels.items())


def _columns(path: Path, headers: list[str], layout: Layout, unit: Unit) -> list[_Column]:
    """The columns of a table with their meaning and factor to SI. Raises: TableError."""
    # The header and sign of each column by its meaning: as the layout states, or by the headers.
    chosen: dict[str, tuple[str, float]] = {}
    for meaning, at in layout.columns.items():
        sign, header = (-1.0, str(at)[1:]) if str(at).startswith("-") else (1.0, str(at))
        if header not in headers:
            raise TableError(
                f"{path}: column {header!r} for {meaning} is missing; there are "
                f"{', '.join(headers[:12])}",
                "missing-column",
            )
        chosen[meaning] = (header, sign)
    out = []
    # Name and unit are separate: the layout may state the name, the file's header the unit.
    for meaning, (header, sign) in (chosen or {h: (h, 1.0) for h in headers}).items():
        parts, original = HEADER_PATTERN.fullmatch(meaning), HEADER_PATTERN.fullmatch(header)
        assert parts is not None
        assert original is not None
        name, unit_name = parts["name"], original["unit"] or original["bracket"] or ""
        wide = WIDE_COLUMN_PATTERN.fullmatch(name)
        component = wide["component"] if wide else name
        if component not in (*FORCE_COMPONENTS, "time", "case", "connection", "body"):
            raise TableError(
                f"{path}: unknown column {name[:40]!r}; allowed: connection, "
                f"{', '.join(FORCE_COMPONENTS)}, time, case, body; or B.fx for the force on "
                "connection B",
                "unknown-column",
            )
        is_number = component in (*FORCE_COMPONENTS, "time")
        factor = sign * unit(unit_name, COMPONENT_DIMENSIONS[component[0]]) if is_number else 1.0
        out.append(_Column(header, factor, wide["connection"] if wide else None, component))
    _require_components(path, out)
    return out


def _require_components(path: Path, columns: list[_Column]) -> None:
    """Raises: TableError unless every force has x and y components, each once."""
    seen = [(c.connection, c.meaning) for c in columns]
    for key in seen:
        if seen.count(key) > 1:
            raise TableError(
                f"{path}: column {'.'.join(filter(None, key))!r} occurs twice; keep one",
                "duplicate-column",
            )
    wide = {c.connection for c in columns if c.connection is not None}
    if not wide and (None, "connection") not in seen:
        raise TableError(
            f"{path}: column 'connection' is missing; needed: connection,fx,fy, or a column per "
            "component like B.fx,B.fy",
            "missing-column",
        )
    for connection in wide or (None,):
        for component in ("fx", "fy"):
            if (connection, component) not in seen:
                name = component if connection is None else f"{connection}.{component}"
                raise TableError(f"{path}: column {name!r} is missing", "missing-column")


def _by_connection(
    row: TableLine, columns: list[_Column], text: dict[str, str], names: dict[str, str]
) -> Iterator[tuple[str, list[_Column]]]:
    """The connections of a row, each with the columns of its components."""
    if "connection" in text:
        label = text["connection"]
        yield names.get(label, label), [c for c in columns if c.meaning in FORCE_COMPONENTS]
        return
    for name in dict.fromkeys(c.connection for c in columns if c.connection is not None):
        yield name, [c for c in columns if c.connection == name]


def _time(
    row: TableLine, columns: list[_Column], text: dict[str, str], layout: Layout, count: int
) -> float | None:
    """Time of a row, s; None where its cell is empty, as it is for cases without time.

    count: number of earlier rows of the same connection.
    """
    if text.get("time"):
        column = next(c for c in columns if c.meaning == "time")
        return row.number(column.header) * column.factor
    return None if layout.step is None else count * layout.step


def _values(row: TableLine, columns: list[_Column]) -> list[float]:
    """Force and moment of a row, six components in N and N m; zero without a column."""
    by_name = {c.meaning: c for c in columns}
    return [
        row.number(by_name[c].header) * by_name[c].factor if c in by_name else 0.0
        for c in FORCE_COMPONENTS
    ]

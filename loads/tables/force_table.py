"""Tables of forces on pins as they come: a row per connection and instant, or a column per
component; with units in the header, several cases, or the columns of another program.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from loads.tables.csv_table import Row, TableError, read_table
from loads.tables.sent_files import stamp

FORCE_COMPONENTS = ("fx", "fy", "fz", "mx", "my", "mz")
COMPONENT_DIMENSIONS = {"f": "force", "m": "moment", "t": "time"}  # by a column's first letter
HEADER_PATTERN = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\]|\((?P<bracket>[^)]*)\))?\s*$")
WIDE_COLUMN_PATTERN = re.compile(r"(?P<connection>.+?)[. ](?P<component>[fm][xyz])$")
OWN_TABLE_COLUMNS = {"case", "body"}  # a table with these columns is one of our own outputs

Unit = Callable[[str, str], float]  # SI value of a unit, "" for the table's own, of a dimension


@dataclass(frozen=True)
class Layout:
    """How a table is to be understood.

    case: of the rows to read, where it has a column `case`. columns: of our names, their header or
    their number from 1, with a minus where the sign differs; numbers where it has no header.
    labels: what a connection is called in its column. step: s, between rows of one connection in a
    table without times.
    """

    case: str
    columns: Mapping[str, str | int] = field(default_factory=dict)
    labels: Mapping[str, str | int] = field(default_factory=dict)
    step: float | None = None


def table_cases(path: Path, columns: Mapping[str, str | int]) -> list[str]:
    """The names in a table's column `case`, in their order. columns: as of a Layout. Raises:
    TableError.
    """
    names = dict[str, None]()
    at = str(columns.get("case", "case"))
    for row in read_table(path, (at,), free=True, numbered=_numbered(columns)):
        if not row.cells[at]:
            raise TableError(f"{row.where}: the case has no name", "no-such-case")
        names[row.cells[at]] = None
    return list(names)


def _numbered(columns: Mapping[str, str | int]) -> bool:
    return bool(columns) and all(isinstance(c, int) for c in columns.values())


@dataclass(frozen=True)
class GivenForce:
    """Force and moment on one connection, N and N m; time: s, or None."""

    where: str
    connection: str
    time: float | None
    values: list[float]


@dataclass(frozen=True)
class _Column:
    """A column of the file, the factor from its numbers to SI, and what it means to us."""

    header: str
    factor: float
    connection: str | None  # of a wide table
    meaning: str


def read_forces(path: Path, layout: Layout, unit: Unit, known: set[str]) -> Iterator[GivenForce]:
    """Rows of a table. Raises: TableError."""
    names = {label: name for name, label in _labels(layout.labels)}
    count: dict[str, int] = {}
    columns: list[_Column] | None = None
    for row in _rows(path, layout):
        if columns is None:
            columns = _columns(path, list(row.cells), layout, unit)
        text = {c.meaning: row.cells[c.header] for c in columns if c.connection is None}
        own = set(row.cells) >= OWN_TABLE_COLUMNS
        for name, own_columns in _by_connection(row, columns, text, names):
            if name not in known and (own or layout.labels):
                continue
            if name not in known:
                raise TableError(
                    f"{row.where}: no pin has a connection {name[:40]!r}; there are "
                    f"{', '.join(sorted(known))}",
                    "unknown-connection",
                )
            time = _time(row, columns, text, layout, count.setdefault(name, 0))
            count[name] += 1
            yield GivenForce(row.where, name, time, _values(row, own_columns))


def _rows(path: Path, layout: Layout) -> Iterator[Row]:
    """Those of the case, where the table has cases. Raises: TableError where none is."""
    at, numbered = str(layout.columns.get("case", "case")), _numbered(layout.columns)
    cases = _by_case(path, stamp(path), at, numbered)
    if cases is None:
        yield from read_table(path, (), free=True, numbered=numbered)
        return
    if layout.case not in cases:
        have = ", ".join(sorted(cases)[:6])
        raise TableError(
            f"{path}: no row has the case {layout.case!r}; there are {have}", "no-such-case"
        )
    yield from cases[layout.case]


@lru_cache(maxsize=1)  # the cases of one table follow each other
def _by_case(path: Path, _: str, at: str, numbered: bool) -> dict[str, list[Row]] | None:
    """The rows by the column of the case, `at`; None without it. _: the stamp of the file."""
    found: dict[str, list[Row]] = {}
    for row in read_table(path, (), free=True, numbered=numbered):
        if at not in row.cells:
            return None
        found.setdefault(row.cells[at], []).append(row)
    return found or None


def _labels(labels: Mapping[str, str | int]) -> Iterator[tuple[str, str]]:
    return ((name, str(label)) for name, label in labels.items())


def _columns(path: Path, headers: list[str], layout: Layout, unit: Unit) -> list[_Column]:
    """What the columns mean. Raises: TableError."""
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
    for meaning, (header, sign) in (chosen or {h: (h, 1.0) for h in headers}).items():
        parts, original = HEADER_PATTERN.fullmatch(meaning), HEADER_PATTERN.fullmatch(header)
        assert parts is not None
        assert original is not None
        name, of_unit = parts["name"], original["unit"] or original["bracket"] or ""
        wide = WIDE_COLUMN_PATTERN.fullmatch(name)
        what = wide["component"] if wide else name
        if what not in (*FORCE_COMPONENTS, "time", "case", "connection", "body"):
            raise TableError(
                f"{path}: unknown column {name[:40]!r}; allowed: connection, "
                f"{', '.join(FORCE_COMPONENTS)}, time, case, body; or B.fx for the force on "
                f"connection B",
                "unknown-column",
            )
        known = what in (*FORCE_COMPONENTS, "time")
        factor = sign * unit(of_unit, COMPONENT_DIMENSIONS[what[0]]) if known else 1.0
        out.append(_Column(header, factor, wide["connection"] if wide else None, what))
    _require(path, out)
    return out


def _require(path: Path, columns: list[_Column]) -> None:
    """Raises: TableError unless every force has x and y, each once."""
    seen = [(c.connection, c.meaning) for c in columns]
    for each in seen:
        if seen.count(each) > 1:
            raise TableError(
                f"{path}: column {'.'.join(filter(None, each))!r} occurs twice; keep one",
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
    row: Row, columns: list[_Column], text: dict[str, str], names: dict[str, str]
) -> Iterator[tuple[str, list[_Column]]]:
    """The connections of a row, each with the columns of its components."""
    if "connection" in text:
        label = text["connection"]
        yield names.get(label, label), [c for c in columns if c.meaning in FORCE_COMPONENTS]
        return
    for name in dict.fromkeys(c.connection for c in columns if c.connection is not None):
        yield name, [c for c in columns if c.connection == name]


def _time(
    row: Row, columns: list[_Column], text: dict[str, str], layout: Layout, count: int
) -> float | None:
    """s; none where the cell is empty, as for cases without time in our own tables."""
    if text.get("time"):
        column = next(c for c in columns if c.meaning == "time")
        return row.number(column.header) * column.factor
    return None if layout.step is None else count * layout.step


def _values(row: Row, columns: list[_Column]) -> list[float]:
    by_name = {c.meaning: c for c in columns}
    return [
        row.number(by_name[c].header) * by_name[c].factor if c in by_name else 0.0
        for c in FORCE_COMPONENTS
    ]

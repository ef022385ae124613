"""The columns of a sweep's table: parameters per design, results per row, texts as indices."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pinbase.dimensions import Floats
from pinstress.explore.sweep.table import METADATA_KEY, RESULT_COLUMNS
from reports.tables.column import in_order

if TYPE_CHECKING:
    import pyarrow as pa

ROW_COLUMNS = ("pin", "case", *(c.key for c in RESULT_COLUMNS if not c.numeric))  # texts
# In the order of the page
COLUMN_TITLES = {c.key: c.heading for c in in_order(RESULT_COLUMNS, "mass") if c.numeric}


@dataclass(frozen=True)
class DesignColumn:
    """A column of values, one for each design or row; NaN for none. A text is given as its index in
    `names`.
    """

    key: str
    title: str
    unit: str
    law: str
    values: Floats
    names: tuple[str, ...] | None

    @property
    def known(self) -> Floats:
        """The finite values."""
        return self.values[np.isfinite(self.values)]


@dataclass(frozen=True)
class Designs:
    """The designs of a sweep, with rows sorted by design.

    numbers: (D,) numbers of the designs, ascending.
    first: (D + 1,) number of the first row of each design, and the number of rows.
    required: the required safety factor; None if there is none.
    in_lugs: the pins whose lugs are not judged.
    other_checks: the checks that a run makes in addition to yield, which are not made here.
    """

    study: str
    required: float | None
    numbers: np.ndarray[Any, np.dtype[np.int64]]
    first: np.ndarray[Any, np.dtype[np.int64]]
    parameters: tuple[DesignColumn, ...]
    results: tuple[DesignColumn, ...]
    texts: dict[str, DesignColumn]  # by the names in ROW_COLUMNS
    in_lugs: tuple[str, ...] = ()
    other_checks: tuple[str, ...] = ()

    @property
    def failed_rows(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """The mask of the rows that have no maximum but a reason why."""
        lacking = np.isfinite(self.texts["reason"].values)
        for column in self.results:
            if column.key == "max_von_mises":
                lacking &= ~np.isfinite(column.values)
        return lacking

    @property
    def failed(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """The mask (D,) of the designs that have such a row."""
        rows = self.failed_rows
        return np.logical_or.reduceat(rows, self.first[:-1]) if len(rows) else rows


def designs_of(table: pa.Table) -> Designs:
    """Return the columns of a table as `pinstress sweep` writes it.

    Raises: ValueError for another table.
    """
    text = (table.schema.metadata or {}).get(METADATA_KEY)
    if text is None or "design" not in table.column_names:
        raise ValueError("the table is not that of a sweep: no column design or no metadata")
    metadata = json.loads(text)
    number = table.column("design").to_numpy()
    order = np.argsort(number, kind="stable")
    numbers, first = np.unique(number[order], return_index=True)
    ends = np.append(first, len(order)).astype(np.int64)
    laws: dict[str, dict[str, Any]] = metadata.get("parameters", {})
    keys = [key for key in laws if key in table.column_names]
    every = {
        name: _column(table, name, order, laws.get(name, {}))
        for name in table.column_names
        if name != "design"
    }
    texts = {name: every.get(name, _nothing(name, len(order))) for name in ROW_COLUMNS}
    in_lugs, pins = metadata.get("pins_in_lugs", ()), texts["pin"].names or ()
    return Designs(
        study=str(metadata.get("title") or metadata.get("study", "")),
        required=metadata.get("required_safety_factor"),
        numbers=numbers.astype(np.int64),
        first=ends,
        parameters=tuple(_per_design(every[key], ends) for key in keys),
        results=tuple(every[name] for name in _results(list(every), keys)),
        texts=texts,
        in_lugs=tuple(name for name in in_lugs if name in pins),
        other_checks=tuple(metadata.get("other_checks", ())),
    )


def _results(names: list[str], parameters: list[str]) -> list[str]:
    """Return the names of results that the page knows, in its order, then all others."""
    known = [name for name in COLUMN_TITLES if name in names]
    return known + [n for n in names if n not in {*parameters, *known, *ROW_COLUMNS}]


def _column(table: pa.Table, name: str, order: Any, law: dict[str, Any]) -> DesignColumn:
    import pyarrow as pa

    field, data = table.schema.field(name), table.column(name).combine_chunks()
    if pa.types.is_dictionary(data.type):
        data = data.dictionary_decode()
    names = None
    if name in ROW_COLUMNS or not _numeric(data.type):
        coded = _texts(data).dictionary_encode()
        names = tuple(coded.dictionary.to_pylist())
        data = coded.indices
    values = data.cast(pa.float64()).to_numpy(zero_copy_only=False)[order]
    unit = (field.metadata or {}).get(b"unit", b"").decode() or str(law.get("unit") or "")
    title = COLUMN_TITLES.get(name, name)
    return DesignColumn(name, title, unit, _law(law.get("law")), values.astype(np.float64), names)


def _numeric(kind: Any) -> bool:
    import pyarrow as pa

    types = pa.types
    return bool(types.is_integer(kind) or types.is_floating(kind) or types.is_null(kind))


def _texts(data: Any) -> Any:
    """Return values as texts; empty texts become null."""
    import pyarrow as pa
    from pyarrow import compute

    texts = data.cast(pa.string())
    return compute.if_else(compute.equal(texts, ""), pa.scalar(None, pa.string()), texts)


def _law(law: object) -> str:
    if isinstance(law, dict):
        return ", ".join(f"{key} {value}" for key, value in law.items())
    return "" if law is None else str(law)


def _per_design(column: DesignColumn, ends: Any) -> DesignColumn:
    """Return one value for every design.

    Raises: ValueError if a design has two.
    """
    values, starts = column.values, ends[:-1]
    one = values[starts]
    again = np.repeat(one, np.diff(ends))
    if not np.array_equal(again, values, equal_nan=True):
        raise ValueError(f"a design has two values of {column.key}")
    return DesignColumn(column.key, column.title, column.unit, column.law, one, column.names)


def _nothing(name: str, rows: int) -> DesignColumn:
    return DesignColumn(name, name, "", "", np.full(rows, np.nan), ())

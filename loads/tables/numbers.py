"""Numbers from the cells of a table; ambiguous numbers are refused."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from loads.tables.csv_table import (
    DECIMAL_COMMA_PATTERN,
    MAX_CELL_VALUE,
    MAX_SHOWN_CHARACTERS,
    TableError,
    not_a_number,
    require_in_range,
)
from loads.tables.grid import Cell, Column, Decimal, TableGrid, Unreadable
from pinbase.arrays import Floats

FORTRAN_PATTERN = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+))[dD]([-+]?\d+)")
# Groups of three digits; a number with a single comma may also be a decimal fraction.
COMMA_GROUPS_PATTERN = re.compile(r"[-+]?[1-9]\d{0,2}(?:,\d{3})+(?:\.\d*)?")
POINT_GROUPS_PATTERN = re.compile(r"[-+]?[1-9]\d{0,2}(?:\.\d{3})+(?:,\d*)?")


class TableNumbers:
    """The numbers of a table, in its units.

    grid: the table.
    columns: indices of all columns with numbers, which together show the decimal sign.
    decimal: decimal sign that the study states, or None.
    """

    def __init__(self, grid: TableGrid, columns: Sequence[int], decimal: Decimal | None) -> None:
        self.grid, self.columns, self.decimal = grid, columns, decimal

    def column(self, index: int, rows: Sequence[int] | None) -> Floats:
        """The numbers of a column, (R,).

        rows: indices of the R rows; None for all rows.

        Raises: TableError for a cell that is not a finite number.
        """
        cells = self.grid.columns[index]
        if isinstance(cells, np.ndarray):
            values = np.asarray(cells, dtype=float)
            values = values if rows is None else values[np.asarray(rows)]
        else:
            values = self._values(self._of(index, rows), index, rows)
        bad = ~(np.abs(values) <= MAX_CELL_VALUE)
        if bad.any():
            k = int(np.flatnonzero(bad)[0])
            k = k if rows is None else rows[k]
            self._require_value(k, index, float(values[np.flatnonzero(bad)[0]]))
        return values

    def _values(self, cells: Sequence[Cell], index: int, rows: Sequence[int] | None) -> Floats:
        text = _joined(cells)
        mixed = "." in text and (self.decimal == "," or self._has_commas)
        if text and not mixed:  # convert all cells at once, as a table may have a million
            if "," in text and self._commas_settled:
                cells = [cell.replace(",", ".") for cell in cells]  # type: ignore[union-attr]
            try:
                return np.array(list(map(float, cells)))  # type: ignore[arg-type]
            except ValueError:
                cells = self._of(index, rows)
        order = range(len(cells)) if rows is None else rows
        pairs = zip(order, cells, strict=True)
        return np.array([self._cell(k, index, cell) for k, cell in pairs])

    def _of(self, index: int, rows: Sequence[int] | None) -> Sequence[Cell]:
        cells: Sequence[Cell] = self.grid.columns[index]  # type: ignore[assignment]
        return cells if rows is None else [cells[k] for k in rows]

    @cached_property
    def _has_commas(self) -> bool:
        """Whether numbers may have decimal commas, and some have a comma."""
        return self.grid.comma and any("," in _joined(self.grid.columns[c]) for c in self.columns)

    @cached_property
    def _commas_settled(self) -> bool:
        """Whether all commas are decimal signs.

        They are if the study says so, or in a table without points in which some comma cannot
        separate thousands, as in 0,5 or 12,34.
        """
        if self.decimal is not None or not self._has_commas:
            return self.decimal == "," and self.grid.comma
        if any("." in _joined(self.grid.columns[c]) for c in self.columns):
            return False
        return any(
            shows_decimal_comma(cell)
            for c in self.columns
            for cell in self.grid.columns[c]
            if isinstance(cell, str)
        )

    def _cell(self, row: int, index: int, cell: Cell) -> float:
        """The number in a cell. Raises: TableError for any other cell."""
        if isinstance(cell, float):
            return cell
        what = f"{self.grid.where(row, index)}: {self.grid.name(index)}"
        if isinstance(cell, Unreadable):
            raise TableError(f"{what} {cell.what}", "not-a-number")
        text = cell.strip()
        if not text:
            raise TableError(f"{what} = '' is not a number; the cell is empty", "not-a-number")
        text = self._with_point(what, text)
        fortran = FORTRAN_PATTERN.fullmatch(text[:MAX_SHOWN_CHARACTERS])
        text = f"{fortran[1]}e{fortran[2]}" if fortran else text
        try:
            if "_" in text or not text.isascii():
                raise ValueError(text)
            return float(text)
        except ValueError:
            raise not_a_number(what, cell.strip()) from None

    def _with_point(self, what: str, text: str) -> str:
        """The text of a number with a decimal point and without groups of thousands.

        Raises: TableError where a comma or point may be a decimal sign or separate thousands.
        """
        short = text[:MAX_SHOWN_CHARACTERS]
        by_commas = COMMA_GROUPS_PATTERN.fullmatch(short)
        by_points = POINT_GROUPS_PATTERN.fullmatch(short)
        if self.decimal == ".":
            return text.replace(",", "") if by_commas else text
        if self.decimal == ",":
            if "." in text and not by_points:
                raise not_a_number(what, text)
            return text.replace(".", "").replace(",", ".")
        if not self.grid.comma or not self._has_commas:
            return text
        single = text.count(",") + text.count(".") == 1
        if not single and (by_commas or by_points):
            raise TableError(
                f'{what} = {short} has groups of thousands; state decimal = "." or decimal = '
                '"," in the table of the case',
                "ambiguous-decimal",
            )
        if (by_commas and not self._commas_settled) or by_points:
            digits = text.replace(",", "").replace(".", "")
            raise TableError(
                f"{what} = {short} may be {digits} or {text.replace(',', '.')}; state decimal = "
                '"." or decimal = "," in the table of the case',
                "ambiguous-decimal",
            )
        return text.replace(",", ".") if single else text

    def _require_value(self, row: int, index: int, value: float) -> None:
        """Raise TableError for a number that is not finite, or too large."""
        what = f"{self.grid.where(row, index)}: {self.grid.name(index)}"
        cell = self.grid.columns[index][row]
        shown = cell.strip()[:MAX_SHOWN_CHARACTERS] if isinstance(cell, str) else f"{value:g}"
        require_in_range(f"{what} = {shown}", value)


def shows_decimal_comma(text: str) -> bool:
    """Whether a number has a comma that cannot separate thousands, as in 0,5 or 12,34."""
    if "," not in text:
        return False
    short = text.strip()[:MAX_SHOWN_CHARACTERS]
    decimal = DECIMAL_COMMA_PATTERN.fullmatch(short)
    return decimal is not None and not COMMA_GROUPS_PATTERN.fullmatch(short)


def _joined(cells: Column) -> str:
    """All cells in one text.

    It is empty unless all cells are texts of ASCII characters without underscores: Python would
    accept other digits and underscores in numbers.
    """
    try:
        text = "".join(cells)  # type: ignore[arg-type]
    except TypeError:  # cells of a workbook may be numbers
        return ""
    return text if text.isascii() and "_" not in text else ""

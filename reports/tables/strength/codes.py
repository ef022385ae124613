"""The codes that a study selects, side by side: the least margin by each code at every lug."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from assess.margin import Margin
from reports.data.results import Results
from reports.format.numbers import DASH, margin_text
from reports.tables.column import Column, Table, read_only, texts

CODES_TITLE = "Least margin of each code (without the checks that all of them have)"


@dataclass(frozen=True)
class CodesRow:
    """A place of a pin with the governing check of each code, over all cases.

    margins: by code; a check that several codes share counts for each of them.
    """

    pin: str
    at: str
    margins: dict[str, Margin]


def codes_table(results: Results) -> Table[CodesRow]:
    """Return a row for each place of a pin at which some but not all codes have a check.

    The table has no rows if the study selects a single code.
    """
    made = list(_checks_at_places(results))
    codes = list(dict.fromkeys(code for _, m in made for code in m.code.split(", ")))
    rows: dict[tuple[str, str], dict[str, Margin]] = {}
    for pin, m in made:
        of = m.code.split(", ")
        if len(of) == len(codes):
            continue
        of_place = rows.setdefault((pin, m.at), {})
        for code in of:
            if code not in of_place or m.used > of_place[code].used:
                of_place[code] = m
    columns = [*texts("pin at"), *(_column(code) for code in codes)]
    shown = [CodesRow(pin, at, margins) for (pin, at), margins in rows.items()]
    return Table("codes", columns, shown if len(codes) > 1 else [])


def _checks_at_places(results: Results) -> Iterator[tuple[str, Margin]]:
    """Yield the pin and the margin of each check of a code at a named place.

    Checks without a demand are left out.
    """
    for row in results.pins:
        for m in row.margins:
            if m.at and m.code and m.governs and m.used > 0.0:
                yield row.pin, m


def _column(code: str) -> Column[CodesRow]:
    return read_only(code, lambda row: _cell(row.margins.get(code)), numeric=False)


def _cell(m: Margin | None) -> str:
    if m is None:
        return DASH
    return f"{margin_text(m.margin)} ({m.method})"

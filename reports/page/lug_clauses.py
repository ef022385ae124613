"""The clauses of several codes side by side for one lug: failure modes by codes."""

from __future__ import annotations

from dataclasses import dataclass

from assess.margin import Margin
from pinbase.keys import lug_key
from reports.data.lug_modes import LUG_MODES, lug_mode
from reports.data.row import PinResult, Units
from reports.format.numbers import short
from reports.format.ranges import factor_text
from reports.format.work_words import passing_text, work_text
from reports.tables.strength.margins import MarginRow


@dataclass(frozen=True)
class ClauseCell:
    """A check of a lug by one code.

    factor: allowable over demand, in words. required: the required factor, in words.
    misses: whether the factor is too low.
    numbers: demand and allowable, and the dimension that would pass.
    lines: the check and its working.
    needs: what is missing where the check was not made.
    """

    factor: str
    required: str
    misses: bool
    numbers: tuple[str, ...]
    lines: tuple[str, ...]
    needs: str = ""


@dataclass(frozen=True)
class LugClauses:
    """The table of one lug.

    rows: failure modes, each with the worst check by each code; None where a code has none.
    """

    lug: str
    codes: tuple[str, ...]
    rows: tuple[tuple[str, tuple[ClauseCell | None, ...]], ...]


def lug_clauses(row: PinResult, units: Units) -> tuple[LugClauses, ...]:
    """Return a table for each lug of a row; nothing if the study selects fewer than two codes.

    Checks that all codes share are left out, since they do not differ.
    """
    margins = [m for m in row.margins if m.code and m.governs and lug_mode(m.method)]
    codes = tuple(dict.fromkeys(c for m in row.margins if m.code for c in m.code.split(", ")))
    margins = [m for m in margins if len(m.code.split(", ")) < len(codes)]
    lugs = dict.fromkeys(m.at for m in margins if m.at and not m.needs)
    if len(codes) < 2:
        return ()
    return tuple(LugClauses(lug, codes, _rows(lug, codes, margins, row, units)) for lug in lugs)


def _rows(
    lug: str, codes: tuple[str, ...], margins: list[Margin], row: PinResult, units: Units
) -> tuple[tuple[str, tuple[ClauseCell | None, ...]], ...]:
    rows = []
    for mode in LUG_MODES:
        here = [m for m in margins if lug_mode(m.method) == mode and _is_of(m, lug, row.pin)]
        cells = tuple(
            _cell([m for m in here if code in m.code.split(", ")], row, units) for code in codes
        )
        if any(cells):
            rows.append((mode, cells))
    return tuple(rows)


def _is_of(m: Margin, lug: str, pin: str) -> bool:
    """Return whether a margin is of a lug; a check that was not made names the lug in what it
    needs.
    """
    if not m.needs:
        return m.at == lug
    return f"{lug_key(pin, lug)}." in m.needs or f"lug {lug}," in m.needs


def _cell(margins: list[Margin], row: PinResult, units: Units) -> ClauseCell | None:
    if not margins:
        return None
    m = max(margins, key=lambda m: m.rank)
    if m.needs:
        return ClauseCell("", "", False, (), (m.method,), m.needs)
    shown = MarginRow(row.pin, row.case, m, units)
    passing = passing_text(m, units)
    numbers = (
        f"{shown.with_unit(m.demand)} of {shown.with_unit(m.allowable)}",
        f"{passing} would pass" if passing else "",
    )
    lines = f"{m.method} ({m.clause})", work_text(m, units), m.omits
    return ClauseCell(
        factor_text(m.safety_factor, m.factor), short(float(f"{m.factor:.4g}")), m.used > 1.0,
        tuple(filter(None, numbers)), tuple(filter(None, lines)),
    )  # fmt: skip

"""The requirements of a run as a matrix of checks by pins, in few rows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

from pinbase.grouped import grouped
from reports.data.requirements import MET, NOT_CHECKED, OUTCOMES, RequirementRow, keys_in

MAX_CASE_ROWS = 4  # rows of a requirement; with more cases, those met by all pins share a row


@dataclass(frozen=True)
class MatrixRow:
    """A requirement, or several together, on all pins.

    check, level, case: of the requirement; `check` may name several checks.
    required: the factor; None where it differs.
    cells: the outcome by pin, the worst of several; a pin without the requirement is left out.
    needs: what is missing where nothing was checked, with the checks that lack it; keys are without
    the pin, lug or material.
    """

    check: str
    level: str
    case: str
    required: float | None
    cells: dict[str, str]
    needs: dict[tuple[str, ...], list[str]] = field(default_factory=dict)


def matrix_rows(rows: Sequence[RequirementRow]) -> list[MatrixRow]:
    """Return the stated requirements, then the other checks that are not met, then one row for all
    others.

    For each level a last row lists what was not checked, stated or not, with what is missing.
    """
    stated = _by_case(row for row in rows if row.stated)
    derived = [r for r in rows if not r.stated and r.outcome != NOT_CHECKED]
    by_check = grouped(((r.check, r.level), r) for r in derived).items()
    missed = [x for x in by_check if any(r.outcome != MET for r in x[1])]
    unmet = [_together(check, level, _case(some), some) for (check, level), some in missed]
    rest = [r for _, some in by_check if all(r.outcome == MET for r in some) for r in some]
    levels = " and ".join(dict.fromkeys(r.level for r in rest))
    count = len({r.check for r in rest})
    others = [_together(f"other checks ({count})", levels, "", rest)] if rest else []
    unchecked = grouped((r.level, r) for r in rows if r.outcome == NOT_CHECKED)
    open_ = [replace(_together("", level, "", some), needs=_needs(some))
             for level, some in unchecked.items()]  # fmt: skip
    return [*stated, *unmet, *others, *open_]


def _needs(rows: Iterable[RequirementRow]) -> dict[tuple[str, ...], list[str]]:
    """Return the checks of rows, grouped by what they need."""
    bare = ((tuple(dict.fromkeys(map(_bare, keys_in(r.needs)))), r.check) for r in rows)
    return {k: [*dict.fromkeys(v)] for k, v in grouped(bare).items()}


def _bare(key: str) -> str:
    """Return the last part of a key, the name of a table in brackets, and other text unchanged."""
    name = key.rpartition(".")[2]
    return key if not name.isidentifier() else name if name != key else f"[{key}]"


def worst_cell(row: MatrixRow, pins: Iterable[str]) -> str:
    """Return the worst outcome of some pins; empty where none has the requirement."""
    return min((row.cells[pin] for pin in pins if pin in row.cells), key=_rank, default="")


def _case(rows: Sequence[RequirementRow]) -> str:
    """Return the only case in which a check is not met; empty where there are several."""
    cases = {row.case for row in rows if row.outcome != MET}
    return cases.pop() if len(cases) == 1 else ""


def _by_case(rows: Iterable[RequirementRow]) -> list[MatrixRow]:
    """Return a row for each requirement and case; with many cases one row for all cases that are
    met.
    """
    matrix = []
    for (check, level), of_check in grouped(((r.check, r.level), r) for r in rows).items():
        by_case = [*grouped((r.case, r) for r in of_check).items()]
        shown, met = by_case, []
        if all(r.outcome == NOT_CHECKED for r in of_check):
            shown = [("", of_check)]
        elif len(by_case) > MAX_CASE_ROWS:
            shown = [x for x in by_case if any(r.outcome != MET for r in x[1])]
            met = [r for _, some in by_case for r in some if all(q.outcome == MET for q in some)]
        matrix += [_together(check, level, case, some) for case, some in shown]
        if met:
            count = len({r.case for r in met})
            cases = f"{count} other cases" if shown else f"all {count} cases"
            matrix.append(_together(check, level, cases, met))
    return sorted(matrix, key=lambda row: min(map(_rank, row.cells.values())))


def _rank(outcome: str) -> int:
    return OUTCOMES.index(outcome)


def _together(check: str, level: str, case: str, rows: Sequence[RequirementRow]) -> MatrixRow:
    cells: dict[str, str] = {}
    for row in rows:
        known = cells.get(row.pin, row.outcome)
        cells[row.pin] = min(known, row.outcome, key=_rank)
    required = {row.required for row in rows}
    factor = required.pop() if len(required) == 1 else None
    return MatrixRow(check, level, case, factor, cells)

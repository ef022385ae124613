"""Tables of two runs side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pinbase.counted import counted
from reports.data.comparison import NOT_SOLVED, UNCHANGED, RowPair, RunComparison, Side, ValuePair
from reports.data.requirement_pairs import REQUIREMENT_CHANGES, RequirementPair
from reports.data.requirements import RequirementRow
from reports.format.numbers import DASH, engineering, margin_text, short
from reports.format.ranges import factor_text
from reports.tables.column import Column, Table, or_dash, read_only, texts

MAX_SHOWN_FORCES = 30
CHANGE_DIGITS = 3


def rows_table(comparison: RunComparison) -> Table[RowPair]:
    """Return the pins and cases that changed, the important changes first."""

    def both(text: Callable[[Side], str]) -> Callable[[RowPair], str]:
        return lambda x: _from_to(*(DASH if s is None else text(s) for s in (x.first, x.second)))

    columns: list[Column[RowPair]] = [
        *texts("pin case"),
        read_only(f"max von Mises A [{comparison.stress}]", lambda row: _range(row.first), rank=4),
        read_only(f"max von Mises B [{comparison.stress}]", lambda row: _range(row.second), rank=3),
        read_only("change", lambda row: per_cent(row.change)),
        read_only("factor A → B", both(lambda side: engineering(side.factor)), rank=1),
        read_only("result A → B", both(lambda side: side.outcome), rank=2, numeric=False),
        read_only("change is", lambda row: row.kind, numeric=False),
    ]
    return Table("rows", columns, changed_rows(comparison))


def requirements_table(comparison: RunComparison) -> Table[RequirementPair]:
    """Return the requirements that changed, those that were lost first."""

    def both(text: Callable[[RequirementRow], str]) -> Callable[[RequirementPair], str]:
        return lambda x: _from_to(*(DASH if s is None else text(s) for s in (x.first, x.second)))

    columns: list[Column[RequirementPair]] = [
        *texts("row.pin"),
        *texts("row.case", show=or_dash),
        *texts("requirement=row.title"),
        read_only("required A → B", both(lambda row: short(row.required))),
        read_only(
            "reached A → B", both(lambda row: factor_text(row.reached, row.required)), rank=1
        ),
        read_only("outcome A → B", both(lambda row: row.outcome), numeric=False),
        *texts("change"),
    ]
    changes = [x for x in REQUIREMENT_CHANGES if x != UNCHANGED]
    return Table("requirements", columns, comparison.requirements_that(*changes))


def _from_to(first: str, second: str) -> str:
    """Return the values of both runs as text; only one where they are equal."""
    return first if first == second else f"{first} → {second}"


def changed_rows(comparison: RunComparison) -> list[RowPair]:
    """Return the rows with a change."""
    return [row for row in comparison.rows if row.kind != UNCHANGED]


def _pairs(name: str, pairs: Sequence[ValuePair]) -> Table[ValuePair]:
    """Return a table of the values that differ, by `name`."""
    columns: list[Column[ValuePair]] = [
        *texts(f"{name}=names.0"),
        *texts("A=first B=second", show=str),
    ]
    return Table("pairs", columns, pairs)


def inputs_table(comparison: RunComparison) -> Table[ValuePair]:
    """Return the input values that differ, by key."""
    return _pairs("input", comparison.inputs)


def versions_table(comparison: RunComparison) -> Table[ValuePair]:
    """Return the programs whose versions differ."""
    return _pairs("program", comparison.versions)


def forces_table(comparison: RunComparison) -> Table[ValuePair]:
    """Return the largest forces that differ, the largest changes first."""
    columns: list[Column[ValuePair]] = [
        *texts("case=names.0 connection=names.1"),
        read_only(f"largest force A [{comparison.force}]", lambda pair: pair.first),
        read_only(f"B [{comparison.force}]", lambda pair: pair.second),
        read_only("change", lambda pair: per_cent(pair.change)),
    ]
    return Table("forces", columns, comparison.forces[:MAX_SHOWN_FORCES])


def margins_table(comparison: RunComparison) -> Table[ValuePair]:
    """Return the least margins of safety that differ."""
    columns: list[Column[ValuePair]] = [
        *texts("pin=names.0"),
        read_only("least margin A", lambda pair: margin_text((pair.first or (None,))[0])),
        read_only("check A", lambda pair: (pair.first or (DASH,))[-1], numeric=False),
        read_only("least margin B", lambda pair: margin_text((pair.second or (None,))[0])),
        read_only("check B", lambda pair: (pair.second or (DASH,))[-1], numeric=False),
    ]
    return Table("margins", columns, comparison.margins)


def left_out(comparison: RunComparison) -> str:
    """Return a note on the number of forces that the table leaves out."""
    more = len(comparison.forces) - MAX_SHOWN_FORCES
    verb = "differs" if more == 1 else "differ"
    return f"{counted(more, 'more force')} {verb} by less." if more > 0 else ""


def _range(side: Side | None) -> str:
    if side is None:
        return DASH
    if side.maximum is None:
        return NOT_SOLVED
    if side.low is None or side.high is None:
        return engineering(side.maximum)
    ends = (engineering(end, CHANGE_DIGITS) for end in (side.low, side.high))
    return f"{engineering(side.maximum)} ({' to '.join(ends)})"


def per_cent(change: float | None) -> str:
    """Return a change with its sign."""
    if change is None:
        return DASH
    rounded = float(f"{100.0 * change:.3g}")
    return f"{'+' * (rounded >= 0.0)}{short(rounded)} %"

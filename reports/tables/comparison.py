"""Tables of two runs side by side."""

from __future__ import annotations

from reports.data.comparison import NOT_SOLVED, UNCHANGED, RowPair, RunComparison, Side, ValuePair
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering

MAX_SHOWN_FORCES = 30  # forces shown
CHANGE_DIGITS = 3  # digits


def rows_grid(found: RunComparison) -> Grid:
    """Pins and cases, the important changes first; those without any are left out."""
    maxima = [f"max von Mises {run} [{found.stress}]" for run in "AB"]
    head = ["pin", "case", *maxima, "change", "factor A → B", "result A → B", "change is"]
    body = [
        [
            row.pin,
            row.case,
            *(_range(side) for side in (row.first, row.second)),
            per_cent(row.change),
            _from_to(*(DASH if s is None else engineering(s.factor) for s in _sides(row))),
            _from_to(*(DASH if s is None else s.outcome for s in _sides(row))),
            row.kind,
        ]
        for row in changed_rows(found)
    ]
    return Grid(head, body, [False, False, *[True] * 4, False, False])


def _sides(row: RowPair) -> tuple[Side | None, Side | None]:
    return row.first, row.second


def _from_to(first: str, second: str) -> str:
    """What was and what is; once where they are the same."""
    return first if first == second else f"{first} → {second}"


def changed_rows(found: RunComparison) -> list[RowPair]:
    """Rows with a change."""
    return [row for row in found.rows if row.kind != UNCHANGED]


def inputs_grid(found: RunComparison) -> Grid:
    """Values that differ, by key."""
    return Grid(["input", "A", "B"], _texts(found.inputs or ()), [False, False, False])


def versions_grid(found: RunComparison) -> Grid:
    """Programs whose versions differ."""
    return Grid(["program", "A", "B"], _texts(found.versions), [False, False, False])


def forces_grid(found: RunComparison) -> Grid:
    """Largest forces that differ, the largest changes first."""
    body = [
        [*pair.names, engineering(pair.first), engineering(pair.second), per_cent(pair.change)]
        for pair in found.forces[:MAX_SHOWN_FORCES]
    ]
    head = [
        "case",
        "connection",
        f"largest force A [{found.force}]",
        f"B [{found.force}]",
        "change",
    ]
    return Grid(head, body, [False, False, True, True, True])


def margins_grid(found: RunComparison) -> Grid:
    """Least margins of safety that differ."""
    body = []
    for pair in found.margins:
        sides = [pair.first or (None, DASH), pair.second or (None, DASH)]
        (a, check_a), (b, check_b) = sides
        body.append([*pair.names, _signed(a), check_a, _signed(b), check_b])
    head = ["pin", "least margin A", "check A", "least margin B", "check B"]
    return Grid(head, body, [False, True, False, True, False])


def left_out(found: RunComparison) -> str:
    """How many forces have no room."""
    more = len(found.forces) - MAX_SHOWN_FORCES
    return f"{more} more forces differ by less." if more > 0 else ""


def _texts(pairs: tuple[ValuePair, ...]) -> list[list[str]]:
    return [
        [*pair.names, *(DASH if x is None else str(x) for x in (pair.first, pair.second))]
        for pair in pairs
    ]


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
    """A change with its sign."""
    return DASH if change is None else f"{100.0 * change:+.3g} %".replace("-", "−")


def _signed(margin: float | None) -> str:
    if margin is None:
        return DASH
    return f"{'+' if margin > 0.0 else ''}{engineering(margin, CHANGE_DIGITS)}"

"""Comparison of two runs, read from their results.json.

The comparison lists the inputs that differ and the results that changed, and whether the results
changed by more than their errors.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from assess.judgement import DEPENDS, FAILS, NOT_DECIDED, YIELDS
from reports.data.requirement_pairs import RequirementPair, requirement_pairs

UNCHANGED_TOLERANCE = 1e-9  # relative; values that differ by less count as unchanged
DECISION_CHANGED = "decision changed"
BEYOND_ERRORS = "changed beyond the errors"
WITHIN_ERRORS = "within the errors"
UNCHANGED = "unchanged"
NOT_SOLVED = "not solved"
ONLY_IN_ONE_RUN = "only in A", "only in B"
CHANGE_KINDS = (
    DECISION_CHANGED,
    BEYOND_ERRORS,
    *ONLY_IN_ONE_RUN,
    NOT_SOLVED,
    WITHIN_ERRORS,
    UNCHANGED,
)  # in the order of the table


@dataclass(frozen=True)
class Side:
    """A pin in a case of one run; a number is None where the run has none.

    maximum, low, high: the maximum stress and its range by the error, in the units of the first
    run.
    factor: safety factor.
    outcome: as in assess.judgement.
    """

    maximum: float | None
    low: float | None
    high: float | None
    factor: float | None
    outcome: str
    model: str


@dataclass(frozen=True)
class RowPair:
    """A pin in a case of both runs; a side is None where its run lacks the row."""

    pin: str
    case: str
    first: Side | None
    second: Side | None

    @property
    def kind(self) -> str:
        """The kind of the change, one of CHANGE_KINDS."""
        a, b = self.first, self.second
        if a is None or b is None:
            return ONLY_IN_ONE_RUN[a is None]
        if a.outcome != b.outcome:
            return DECISION_CHANGED
        if a.maximum is None or b.maximum is None:
            return UNCHANGED if a.maximum == b.maximum else NOT_SOLVED
        if _same(a.maximum, b.maximum):  # the factor also has the strength, which has no error
            return UNCHANGED if unchanged(a.factor, b.factor) else BEYOND_ERRORS
        apart = _above(a.low, b.high) or _above(b.low, a.high)
        return BEYOND_ERRORS if apart else WITHIN_ERRORS

    @property
    def change(self) -> float | None:
        """The change of the maximum relative to that of the first run."""
        a, b = self.first, self.second
        if a is None or b is None or not a.maximum or b.maximum is None:
            return None
        return b.maximum / a.maximum - 1.0


@dataclass(frozen=True)
class ValuePair:
    """A value other than those of rows that differs between the runs, by its names; None where a
    run lacks it.
    """

    names: tuple[str, ...]
    first: Any
    second: Any

    @property
    def change(self) -> float | None:
        """The change of a number relative to that of the first run."""
        if not self.first or self.second is None:
            return None
        return float(self.second) / float(self.first) - 1.0


@dataclass(frozen=True)
class RunComparison:
    """The differences between two runs.

    folders, titles: of both runs.
    stress, force: the units of the first run, in which both are compared.
    inputs: the values that differ, by key.
    forces: the largest forces by case and connection.
    margins: the governing check of each pin, and its margin.
    requirements: those of both runs.
    """

    folders: tuple[str, str]
    titles: tuple[str, str]
    stress: str
    force: str
    rows: tuple[RowPair, ...]
    inputs: tuple[ValuePair, ...]
    forces: tuple[ValuePair, ...]
    margins: tuple[ValuePair, ...]
    requirements: tuple[RequirementPair, ...]
    versions: tuple[ValuePair, ...]

    def count(self, kind: str) -> int:
        """Return the number of rows of a kind."""
        return sum(row.kind == kind for row in self.rows)

    def requirements_that(self, *changes: str) -> list[RequirementPair]:
        """Return the requirements whose change is one of `changes`."""
        return [pair for pair in self.requirements if pair.change in changes]


def compared(
    first: Mapping[str, Any],
    second: Mapping[str, Any],
    folders: tuple[str, str],
    units: tuple[float, float] = (1.0, 1.0),
) -> RunComparison:
    """Return the comparison of the contents of two results.json.

    units: the stress unit and the force unit of the second run, in those of the first.
    """
    stress, force = units
    a, b = ({(p["pin"], p["case"]): p for p in run["pins"]} for run in (first, second))
    rows = [
        RowPair(*row, _side(a.get(row), 1.0), _side(b.get(row), stress))
        for row in dict.fromkeys((*a, *b))
    ]
    return RunComparison(
        folders=folders,
        titles=(first["title"], second["title"]),
        stress=first["units"]["stress"],
        force=first["units"]["force"],
        rows=tuple(sorted(rows, key=_place)),
        inputs=_of_keys(first, second, "inputs"),
        forces=_by_change(_differing(_forces(first, 1.0), _forces(second, force))),
        margins=_differing(_margins(first), _margins(second)),
        requirements=requirement_pairs(first, second),
        versions=_of_keys(first, second, "versions"),
    )


def _side(row: Mapping[str, Any] | None, unit: float) -> Side | None:
    if row is None:
        return None
    value, error = row["max_von_mises"], row["error_estimate"]
    low, high = row.get("max_von_mises_interval") or (None, None)
    if low is None and value is not None and error is not None:
        low, high = value - error, value + error
    value, low, high = (None if x is None else x * unit for x in (value, low, high))
    return Side(value, low, high, row["safety_factor"], row["outcome"], row["model"])


def _same(a: float, b: float) -> bool:
    return math.isclose(a, b, rel_tol=UNCHANGED_TOLERANCE)


def _above(low: float | None, high: float | None) -> bool:
    return low is not None and high is not None and low > high


def _place(row: RowPair) -> tuple[int, bool, float]:
    """Return the sort key of a row: the most important change comes first."""
    change = row.change
    worse = row.second is not None and row.second.outcome in (FAILS, YIELDS, NOT_DECIDED, DEPENDS)
    size = 0.0 if change is None else -abs(math.log(max(1.0 + change, 1e-300)))
    return CHANGE_KINDS.index(row.kind), not worse, size


def _of_keys(
    first: Mapping[str, Any], second: Mapping[str, Any], part: str
) -> tuple[ValuePair, ...]:
    return _differing(_by_key(first[part]), _by_key(second[part]))


def _by_key(values: Mapping[str, Any]) -> dict[tuple[str, ...], Any]:
    return {(key,): value for key, value in values.items()}


def _differing(
    first: Mapping[tuple[str, ...], Any], second: Mapping[tuple[str, ...], Any]
) -> tuple[ValuePair, ...]:
    pairs = (
        ValuePair(names, first.get(names), second.get(names))
        for names in dict.fromkeys((*first, *second))
    )
    return tuple(pair for pair in pairs if not unchanged(pair.first, pair.second))


def unchanged(a: Any, b: Any) -> bool:
    """Return whether two values are equal; numbers may differ by round-off."""
    numbers = isinstance(a, float) and isinstance(b, float)
    return _same(a, b) if numbers else bool(a == b)


def _by_change(pairs: Iterable[ValuePair]) -> tuple[ValuePair, ...]:
    def size(pair: ValuePair) -> float:
        return math.inf if pair.change is None else abs(pair.change)

    return tuple(sorted(pairs, key=size, reverse=True))


def _forces(run: Mapping[str, Any], unit: float) -> dict[tuple[str, ...], float]:
    return {
        (table["case"], force["connection"]): float(force["force"]) * unit
        for table in run["loads"]
        for force in table["largest_forces"]
        if force["force"] is not None
    }


def _margins(run: Mapping[str, Any]) -> dict[tuple[str, ...], tuple[float, str]]:
    """Return the least margin of each pin among the checks that govern, and the name of the check.

    The margin is rounded to six digits, so that round-off is not reported as a change.
    """
    least: dict[tuple[str, ...], tuple[float, str]] = {}
    for row in run["margins"]:
        if row["margin"] is None or not row["governs"]:
            continue
        here = float(f"{row['margin']:.6g}"), f"{row['method']}, {row['case']}"
        least[(row["pin"],)] = min(here, least.get((row["pin"],), here))
    return least

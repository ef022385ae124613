"""Requirements of two runs side by side, read from their results.json, and which of them
were lost.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from assess.requirement import REQUIRED_CHECKS
from reports.data.requirements import MET, NOT_CHECKED, OUTCOMES, RequirementRow

LOST, GONE = "lost", "gone"
NEWLY_MET, NEW, LOWERED, OTHER = "newly met", "new", "asks for less", "changed"
UNCHANGED = "unchanged"
REQUIREMENT_CHANGES = (LOST, GONE, LOWERED, OTHER, NEWLY_MET, NEW, UNCHANGED)  # order of the table
ROW_KEYS = "pin", "case", "level", "check", "required", "reached", "outcome", "stated", "needs"
COLLAPSE = "limit load"  # checked by itself only where a pin yields


@dataclass(frozen=True)
class RequirementPair:
    """A requirement of both runs; a side is None where its run lacks it."""

    first: RequirementRow | None
    second: RequirementRow | None

    @property
    def row(self) -> RequirementRow:
        """The requirement in the second run, or in the first run if the second lacks it."""
        row = self.second or self.first
        assert row is not None
        return row

    @property
    def change(self) -> str:
        """The change between the runs, one of REQUIREMENT_CHANGES.

        A requirement is "lost" if it was met and no longer is, whatever the reason. It is "gone" if
        the second run lacks it, or no longer states it and nothing checks it. A requirement whose
        factor was lowered is no progress, whether or not it is met now.
        """
        a, b = self.first, self.second
        if a is None:
            return NEW
        if b is None:
            return GONE
        before, after = a.outcome == MET, b.outcome == MET
        if before and not after:
            return LOST
        if a.stated and not b.stated and b.outcome == NOT_CHECKED:
            return GONE
        if b.required < a.required:  # even if it is met only because of this
            return LOWERED
        if after and not before:
            return NEWLY_MET
        return UNCHANGED if (a.outcome, a.required) == (b.outcome, b.required) else OTHER


def requirement_pairs(
    first: Mapping[str, Any], second: Mapping[str, Any]
) -> tuple[RequirementPair, ...]:
    """Return the pairs of requirements in two results.json, the lost ones first."""
    a, b = _by_key(first["requirements"]), _by_key(second["requirements"])
    pairs = [RequirementPair(a.get(key), b.get(key)) for key in dict.fromkeys((*a, *b))]
    counted = [pair for pair in pairs if pair.change != GONE or _counts(pair.first or pair.row)]
    return tuple(sorted(counted, key=lambda pair: REQUIREMENT_CHANGES.index(pair.change)))


def _counts(row: RequirementRow) -> bool:
    """Return whether the absence of a requirement in the second run is reported.

    Requirements by the factors on loads come and go with the formulas that apply to a pin.
    Requirements on pins and cases that the first run left out were not met there.
    """
    by_factors = row.outcome == MET and row.check in REQUIRED_CHECKS and row.check != COLLAPSE
    return (row.stated and not row.left_out) or by_factors


def _by_key(rows: list[dict[str, Any]]) -> dict[tuple[str, ...], RequirementRow]:
    """Return the requirements by pin, case, level and check, the worst of those with the
    same key.
    """
    worst: dict[tuple[str, ...], RequirementRow] = {}
    for content in rows:
        row = RequirementRow(**{key: content[key] for key in ROW_KEYS})
        known = worst.get(row.key)
        if known is None or _rank(row) < _rank(known):
            worst[row.key] = row
    return worst


def _rank(row: RequirementRow) -> tuple[int, bool, float]:
    return OUTCOMES.index(row.outcome), not row.stated, -row.required

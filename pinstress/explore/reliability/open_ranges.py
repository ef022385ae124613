"""What a study leaves open without a law: by how much a range raises the stress of its rows."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

from reports.data.row import PinResult
from reports.data.unknowns import factor_spread


def growth(row: PinResult | None, laws: Collection[str]) -> float:
    """Return the stress over all that is open in a row, over that as described; at least 1.

    row: of the study as it is; None, or one without a factor, has no growth.
    laws: keys of the numbers with a law. A range that one of them describes does not count.
    """
    if row is None:
        return 1.0
    by_law = _by_law(row, laws)
    rest = replace(
        row,
        landing=None if "landing" in by_law else row.landing,
        strength_range=None if "strength" in by_law else row.strength_range,
    )
    spread = factor_spread(rest)
    return 1.0 if spread is None else max((row.safety_factor or 0.0) / spread[0], 1.0)


def left_out(rows: Iterable[PinResult], laws: Collection[str]) -> Iterable[str]:
    """Yield a sentence on each range that does not count, since a law describes it."""
    names = {"landing": "a landing's impulse", "strength": "a yield strength"}
    pins = [(owner, row.pin) for row in rows for owner in _by_law(row, laws)]
    for owner, name in names.items():
        if some := dict.fromkeys(pin for x, pin in pins if x == owner):
            yield (
                f"The range of {name} is left out, since a law takes its place: a run judges pins "
                f"over it ({', '.join(some)})."
            )


def _by_law(row: PinResult, laws: Collection[str]) -> set[str]:
    """Return the owners of the row's ranges that a law describes."""
    owners = set()
    if row.landing is not None and any(key.startswith(f"case.{row.case}.") for key in laws):
        owners.add("landing")
    if row.strength_range is not None and any(key.endswith(".yield_strength") for key in laws):
        owners.add("strength")
    return owners

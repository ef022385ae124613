"""Past yield: at which part of its loads a pin collapses, and what it keeps of its shape."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from assess.plastic.records import LimitLoad
from reports.data.results import PinResult, Results
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, finite
from reports.tables.table import Table

LIMIT_LOAD_NOTE = (
    "A pin whose safety factor is below one yields somewhere, which need not matter. It collapses "
    "when all its loads, in proportion, reach the limit load; below, it bends and stays bent."
)
LEFT_OUT_NOTE = (
    "Left out: fracture, buckling, large displacements, and what flow does to the pressures of "
    "lugs."
)
COLUMNS = ("pin", "case", "mesh", "load_factor", "displacement", "permanent_set")


def limit_rows(results: Results) -> list[tuple[PinResult, LimitLoad]]:
    """Rows with a limit load."""
    return [(pin, pin.limit_load) for pin in results.pins if pin.limit_load is not None]


def limit_word(limit: LimitLoad) -> str:
    """Whether the pin collapses under its loads, in a word or two."""
    if limit.stopped:
        return "not computed: --limit-load computes it"
    if limit.method == "none":
        return "not computed"
    if limit.carries is None:
        return "not decided"
    return "bends" if limit.carries else "collapses"


def limit_grid(results: Results) -> Grid | None:
    """A row each; None without any."""
    length = results.units.length
    body = [
        [
            pin.pin,
            pin.case,
            limit_word(limit),
            limit_range(limit),
            limit.method,
            engineering(limit.permanent_set, 3),
            engineering(limit.permanent_at, 3),
        ]
        for pin, limit in limit_rows(results)
    ]
    if not body:
        return None
    head = ["pin", "case", "under its loads", "collapses at × loads", "by"]
    head += [f"permanent set [{length}]", "after × loads"]
    return Grid(head, body, [False, False, False, True, False, True, True])


def limit_range(limit: LimitLoad) -> str:
    """The bracket."""
    if limit.lower is None or limit.upper is None:
        return DASH
    return f"{engineering(limit.lower, 3)} to {engineering(limit.upper, 3)}"


def limit_notes(results: Results) -> list[str]:
    """Of rows that need one, a sentence each."""
    return [
        f"Pin {pin.pin}, {pin.case}: {limit.note}."
        for pin, limit in limit_rows(results)
        if limit.note
    ]


def limit_load_table(results: Results) -> Table:
    """Load factor against displacement on the finest mesh."""
    rows = [
        (pin.pin, pin.case, len(limit.meshes), *step)
        for pin, limit in limit_rows(results)
        if limit.curve is not None
        for step in zip(
            limit.curve.factor.tolist(),
            limit.curve.displacement.tolist(),
            limit.curve.permanent.tolist(),
            strict=True,
        )
    ]
    return Table.of("limit_load", COLUMNS, rows)


def limit_load_json(limit: LimitLoad | None) -> dict[str, Any] | None:
    """For results.json; the curve is in limit_load.csv."""
    if limit is None:
        return None
    return {
        "lower": finite(limit.lower),
        "upper": finite(limit.upper),
        "method": limit.method,
        "carries": None if limit.carries is None else bool(limit.carries),
        "permanent_set": finite(limit.permanent_set),
        "permanent_set_factor": finite(limit.permanent_at),
        "hardening": bool(limit.hardening),
        "seconds": finite(limit.seconds),
        "meshes": [asdict(mesh) for mesh in limit.meshes],
        "note": limit.note,
    }

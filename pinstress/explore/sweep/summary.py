"""The summary of a sweep on the terminal."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table as Grid

from assess.judgement import FAILS
from pinbase.counted import counted
from pinstress.explore.sweep.table import facts
from reports.format.numbers import DASH, engineering
from reports.format.ranges import factor_text
from reports.format.words import not_judged

if TYPE_CHECKING:
    import pyarrow as pa

MAX_PRINTED_REASONS = 3  # largest number of printed reasons, the most frequent first
UNSOLVED_VERDICTS = ("failed", "rigid")  # verdicts without numbers
MAX_REASON_LENGTH = 100  # characters of a reason


def summary(table: pa.Table, console: Console) -> None:
    """Print the numbers of designs and of failed designs, the reasons, and for each pin the range
    of its safety factor with the worst and the best design and the largest stress.
    """
    stated = facts(table)
    rows: list[dict[str, Any]] = table.select(
        ["design", "pin", "max_von_mises", "safety_factor", "outcome", "verdict", "reason", "code"]
    ).to_pylist()
    designs = {row["design"] for row in rows}
    failed = {row["design"] for row in rows if row["verdict"] in UNSOLVED_VERDICTS}
    console.print(
        f"{counted(len(designs), 'design')}, {len(failed):,} failed"
        + " in some row" * (len(rows) > len(designs)),
        highlight=False,
    )
    for line in _reasons(rows):
        console.print(line, highlight=False, markup=False)
    grid = Grid(box=None, pad_edge=False)
    unit = table.schema.field("max_von_mises").metadata[b"unit"].decode()
    for name in ("pin", "safety factor", "worst design", "best design", f"largest [{unit}]"):
        grid.add_column(name.replace("[", "\\["), justify="left" if name == "pin" else "right")
    required = stated.get("required_safety_factor")
    short: list[str] = []
    for pin in dict.fromkeys(row["pin"] for row in rows):
        of_pin = [row for row in rows if row["pin"] == pin]
        grid.add_row(pin, *_range(of_pin, required))
        if required is not None or any(r["outcome"] == FAILS for r in rows):
            below = {r["design"] for r in of_pin if _below(r, required)}
            lacking = {r["design"] for r in of_pin if r["verdict"] in UNSOLVED_VERDICTS}
            solved = len(designs) - len(lacking - below)
            of = f" of {solved:,} solved" if solved < len(designs) else ""
            short.append(f"{pin} {len(below):,}{of}")
    console.print(grid)
    if short:
        of = (
            "their required factors" if required is None else f"the required factor of {required:g}"
        )
        console.print(
            f"designs below {of}: {', '.join(short)}",
            highlight=False,
            markup=False,
        )
    in_lugs = stated.get("pins_in_lugs", ())
    held = (row["pin"] for row in rows if row["pin"] in in_lugs)
    if said := not_judged(held, stated.get("other_checks", ())):
        console.print(said, highlight=False, markup=False)
    rough = Counter(row["pin"] for row in rows if row["verdict"] in ("unconverged", "singular"))
    if rough:
        console.print(
            "rows whose maximum is not converged (see verdict, error_estimate): "
            + ", ".join(f"{pin} {count:,}" for pin, count in rough.items()),
            highlight=False,
            markup=False,
        )


def _below(row: dict[str, Any], required: float | None) -> bool:
    """Whether a row misses the required factor, or its own one if `required` is None."""
    if required is None:
        return bool(row["outcome"] == FAILS)
    return (row["safety_factor"] or required) < required


def _reasons(rows: list[dict[str, Any]]) -> list[str]:
    """Return the most frequent reasons of failure, by code, each with an example."""
    failed = [row for row in rows if row["verdict"] in UNSOLVED_VERDICTS]
    counts = Counter(row["code"] for row in failed)
    lines = []
    for code, _ in counts.most_common(MAX_PRINTED_REASONS):
        examples = [row for row in failed if row["code"] == code]
        many = len({row["design"] for row in examples})
        text = examples[0]["reason"]
        text = text if len(text) <= MAX_REASON_LENGTH else text[: MAX_REASON_LENGTH - 1] + "…"
        lines.append(f"  {many:,} {code}: for instance design {examples[0]['design']}, {text}")
    if len(counts) > MAX_PRINTED_REASONS:
        lines.append(f"  and {counted(len(counts) - MAX_PRINTED_REASONS, 'other reason')}")
    return lines


def _range(rows: list[dict[str, Any]], required: float | None) -> tuple[str, str, str, str]:
    """Return a pin's factors, the worst and best design by their worst case, and its maximum."""
    solved = [row for row in rows if row["max_von_mises"] is not None]
    if not solved:
        return DASH, DASH, DASH, DASH
    worst_of: dict[int, float] = {}
    for row in solved:
        number, stress = row["design"], row["max_von_mises"]
        factor = row["safety_factor"]  # None without a strength, or without stress (the best case)
        size = -factor if factor is not None else stress or -math.inf
        worst_of[number] = max(worst_of.get(number, -math.inf), size)
    worst = max(worst_of, key=lambda number: worst_of[number])
    best = min(worst_of, key=lambda number: worst_of[number])
    factors = [-x for x in worst_of.values() if -math.inf < x < 0.0]
    ends = [min(factors), max(factors)] if factors else []
    told = (engineering(x) if required is None else factor_text(x, required, 4) for x in ends)
    between = " to ".join(told) or DASH
    most = max(row["max_von_mises"] for row in solved)
    return between, f"{worst}", f"{best}", engineering(most)

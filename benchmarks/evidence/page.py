"""docs/evidence.md: all comparisons, by kind and source."""

from __future__ import annotations

import statistics
import textwrap
from collections.abc import Iterable
from itertools import groupby
from pathlib import Path

from benchmarks import ROOT
from benchmarks.evidence.comparison import KINDS, Comparison, Fault, Source, records, sources
from benchmarks.timing import table

PAGE = ROOT / "docs" / "evidence.md"
WIDTH = 120  # characters of a line of text
TEMPLATE = Path(__file__).parent / "template.md"
REASONS: dict[Fault, str] = {"": "", "print": "error in print: ", "model": "miss: "}
BARS_NOTE = """The limit load is the lower end of its bracket, the ultimate load the largest up to
a plastic strain at the bore of ln(1 + A), in finite strain. The first is below the test in {safe}
of {all} bars, because metal hardens. The second is above it in {unsafe}: it is a prediction with
this scatter, not an allowable."""


def page(comparisons: Iterable[Comparison]) -> str:
    """Return the page of all comparisons."""
    every = list(comparisons)
    parts = []
    for name, source in sources().items():
        of_source = [c for c in every if c.printed.source == name]
        parts.append(f"## {source.title}\n\n{_about(source)}\n\n{source_table(name, of_source)}")
    return TEMPLATE.read_text(encoding="utf-8").format(
        statistics=statistics_table(every), parts="\n\n".join(parts)
    )


def statistics_table(comparisons: list[Comparison]) -> str:
    """Return the table of number, mean and scatter of the ratios by kind."""
    rows: list[tuple[object, ...]] = []
    for kind, title in KINDS.items():
        of_kind = [c for c in comparisons if c.kind == kind]
        ratios = [c.ratio for c in of_kind if c.printed.fault != "print"]
        missed = sum(not c.agrees and c.printed.fault != "print" for c in of_kind)
        rows.append(
            (
                title, len(of_kind), f"{statistics.mean(ratios):.3f}",
                f"{statistics.stdev(ratios):.3f}", f"{min(ratios):.3f}", f"{max(ratios):.3f}",
                len(of_kind) - len(ratios), missed,
            )
        )  # fmt: skip
    head = ("kind", "numbers", "mean", "standard deviation", "least", "largest", "errors in print",
            "misses")  # fmt: skip
    return table(head, rows)


def source_table(name: str, comparisons: list[Comparison]) -> str:
    """Return the table of the comparisons with a source."""
    if name == "moore":
        return _bars(comparisons)
    rows = source_rows(comparisons)
    head: tuple[str, ...]
    head = ("quantity", "study", "printed", "ours", "ratio", "remark")
    if not comparisons[0].printed.study:
        rows = [(row[0], *row[2:]) for row in rows]
        head = (head[0], *head[2:])
    return table(head, rows)


def source_rows(comparisons: Iterable[Comparison]) -> list[tuple[object, ...]]:
    """Return the cells of the comparisons with a source."""
    return [
        (
            c.printed.quantity, f"`{c.printed.study}`",
            c.printed.text + ("" if c.printed.unit == "1" else f" {c.printed.unit}"),
            _shown(c.predicted), f"{c.ratio:.3f}", REASONS[c.printed.fault] + c.printed.remark,
        )
        for c in comparisons
    ]  # fmt: skip


def _shown(value: float) -> str:
    """Return a prediction with four digits, or with all digits before the point."""
    return f"{value:.0f}" if abs(value) >= 1e4 else f"{value:.4g}"


def bar_rows(comparisons: Iterable[Comparison]) -> list[tuple[object, ...]]:
    """Return the cells of the broken bars; both loads of a bar are in one row."""
    out: list[tuple[object, ...]] = []
    for quantity, of_bar in groupby(comparisons, lambda c: c.printed.quantity):
        limit, ultimate = of_bar
        bar, _, ratio = quantity.rpartition(", e/D ")
        loads = (f"{c.predicted:.1f}" for c in (limit, ultimate))
        low, high = (f"{c.ratio:.3f}" for c in (limit, ultimate))
        first, second = loads
        out.append((bar, ratio, limit.printed.text, first, low, second, high))
    return out


def _bars(comparisons: list[Comparison]) -> str:
    head = ("bar", "e/D", "measured, ksi", "limit load at yield, ksi", "ratio",
            "ultimate load, ksi", "ratio ")  # fmt: skip
    rows = bar_rows(comparisons)
    assert len(rows) == 2 * len(records("moore1948.csv"))
    above = {kind: sum(c.ratio > 1.0 for c in comparisons if c.kind == kind) for kind in KINDS}
    note = BARS_NOTE.format(
        safe=len(rows) - above["limit"], all=len(rows), unsafe=above["ultimate"]
    )
    return f"{table(head, rows)}\n\n{_filled(note)}"


def _about(source: Source) -> str:
    """Return the description of a source, its errors, and what it does not establish."""
    parts = [source.cited]
    if source.function:
        parts.append(f"Not a study: `{source.function}`.")
    if source.errors:
        parts.append(f"*Errors in print.* {source.errors}")
    parts.append(f"*Not established.* {source.limits}")
    return "\n\n".join(_filled(part) for part in parts)


def _filled(text: str) -> str:
    return textwrap.fill(
        " ".join(text.split()), WIDTH, break_long_words=False, break_on_hyphens=False
    )

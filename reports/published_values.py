"""Single published numbers beside ours, with the reason where they differ."""

from __future__ import annotations

from pathlib import Path

from reports import markdown
from reports.numbers import engineering, ratio
from reports.results import PublishedValue, Results
from reports.table import Table

COLUMNS = ("case", "time", "quantity", "name", "published", "ours", "ratio", "unit", "reason")


def published_values_table(results: Results) -> Table:
    """Every published value with ours."""
    return Table.of("published", COLUMNS, (_cells(v) for v in results.published))


def write_published_values(results: Results, directory: Path) -> None:
    """Write published.md; nothing where nothing was published."""
    if not results.published:
        return
    title = f"# Published values beside ours: {markdown.escaped(results.title)}"
    text = f"{title}\n\n{published_table(results.published)}\n"
    (directory / "published.md").write_text(text, encoding="utf-8")


def _cells(v: PublishedValue) -> tuple[str | float | None, ...]:
    beside = ratio(v.ours, v.published)
    return v.case, v.time, v.quantity, v.name, v.published, v.ours, beside, v.unit, v.reason


def published_table(values: tuple[PublishedValue, ...]) -> str:
    """A Markdown table of published values, ours, their ratio and why they differ."""
    return markdown.table(
        ("case", "quantity", "of", "published", "ours", "ours / published", "why"),
        [
            [
                v.case,
                f"{v.quantity.replace('_', ' ')} [{v.unit}]",
                v.name,
                engineering(v.published, 6),
                engineering(v.ours, 6),
                engineering(ratio(v.ours, v.published), 5),
                v.reason,
            ]
            for v in values
        ],
        (False, False, False, True, True, True, False),
    )

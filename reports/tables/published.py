"""Reactions and single numbers compared with the publication's."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from reports.data.results import PublishedValue, ReactionTable, Results
from reports.format.files import markdown
from reports.format.grid import Grid
from reports.format.numbers import engineering, ratio
from reports.format.ranges import factor_range
from reports.tables.table import Table

PUBLISHED_REACTION_COLUMNS = ("case", "connection", "ours", "published", "ratio")
PUBLISHED_VALUE_COLUMNS = (
    "case",
    "time",
    "quantity",
    "name",
    "published",
    "ours",
    "ratio",
    "unit",
    "reason",
)


@dataclass(frozen=True)
class PublishedReaction:
    """A connection's largest force of a case, ours and published, in the study's force unit."""

    case: str
    connection: str
    ours: float
    published: float
    ratio: float | None


def published_reactions(results: Results) -> list[PublishedReaction]:
    """Every reaction for which a value was published; ours is the largest over all instants."""
    return [row for table in results.reactions for row in _rows(table)]


def _rows(table: ReactionTable) -> list[PublishedReaction]:
    largest = table.magnitudes.max(axis=0)
    rows = []
    for connection, ours in zip(table.connections, largest.tolist(), strict=True):
        if connection in table.published:
            theirs = table.published[connection]
            rows.append(
                PublishedReaction(table.case, connection, ours, theirs, ratio(ours, theirs))
            )
    return rows


def published_reactions_table(results: Results) -> Table:
    """The same as a table."""
    rows = (
        [getattr(row, name) for name in PUBLISHED_REACTION_COLUMNS]
        for row in published_reactions(results)
    )
    return Table.of("reactions_published", PUBLISHED_REACTION_COLUMNS, rows)


def write_published_reactions(results: Results, directory: Path) -> None:
    """Write reactions_published.md, if there are published reactions."""
    rows = published_reactions(results)
    if not rows:
        return
    force = results.units.force
    body = markdown.table(
        ("case", "connection", f"ours [{force}]", f"published [{force}]", "ours / published"),
        [
            [r.case, r.connection, *(engineering(x) for x in (r.ours, r.published, r.ratio))]
            for r in rows
        ],
        (False, False, True, True, True),
    )
    title = f"# Reactions compared with published values: {markdown.escaped(results.title)}"
    (directory / "reactions_published.md").write_text(f"{title}\n\n{body}\n", encoding="utf-8")


def published_values_table(results: Results) -> Table:
    """Every published value with ours."""
    return Table.of("published", PUBLISHED_VALUE_COLUMNS, (_cells(v) for v in results.published))


def write_published_values(results: Results, directory: Path) -> None:
    """Write published.md, if there are published values."""
    if not results.published:
        return
    title = f"# Comparison with published values: {markdown.escaped(results.title)}"
    text = f"{title}\n\n{published_table(results.published)}\n"
    (directory / "published.md").write_text(text, encoding="utf-8")


def _cells(v: PublishedValue) -> tuple[str | float | None, ...]:
    relative = ratio(v.ours, v.published)
    return v.case, v.time, v.quantity, v.name, v.published, v.ours, relative, v.unit, v.reason


def published_table(values: tuple[PublishedValue, ...]) -> str:
    """A Markdown table of published values, ours, their ratio and the reason for the difference."""
    return markdown.table(
        ("case", "quantity", "of", "published", "ours", "ours / published", "reason"),
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


def published_maxima(results: Results) -> Grid | None:
    """Published maxima and safety factors compared with ours, in the order of the study."""
    rows = [pin for pin in results.pins if pin.published_max_von_mises is not None]
    if not rows:
        return None
    stress = results.units.stress
    return Grid(
        [
            *("pin", "case", f"published max [{stress}]", f"ours [{stress}]", "ours / published"),
            *("published factor", "our factor", "our verdict"),
        ],
        [
            [
                pin.pin,
                pin.case,
                engineering(pin.published_max_von_mises),
                engineering(pin.max_von_mises),
                engineering(ratio(pin.max_von_mises, pin.published_max_von_mises), 3),
                engineering(pin.published_safety_factor),
                factor_range(pin),
                pin.verdict,
            ]
            for pin in rows
        ],
        [False, False, True, True, True, True, True, False],
    )

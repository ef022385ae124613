"""Reactions compared with the publication's."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from reports.data.results import ReactionTable, Results
from reports.format import markdown
from reports.format.numbers import engineering, ratio
from reports.tables.table import Table

COLUMNS = ("case", "connection", "ours", "published", "ratio")


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
    rows = ([getattr(row, name) for name in COLUMNS] for row in published_reactions(results))
    return Table.of("reactions_published", COLUMNS, rows)


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

"""Reactions and single numbers compared with those of the publication."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from reports.data.mechanics import PublishedValue, ReactionTable
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.files import markdown
from reports.format.numbers import engineering, ratio
from reports.format.ranges import factor_range
from reports.tables.column import Column, Table, fields, read_only, texts


@dataclass(frozen=True)
class PublishedReaction:
    """The largest force of a connection in a case, computed and published, in the study's unit."""

    case: str
    connection: str
    ours: float
    published: float
    ratio: float | None


def published_reactions(results: Results) -> list[PublishedReaction]:
    """Return every reaction with a published value; `ours` is the largest over all instants."""
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


def published_reactions_table(results: Results) -> Table[PublishedReaction]:
    """Return the published reactions as a table."""
    force = f" [{results.units.force}]"  # for people only
    columns: list[Column[PublishedReaction]] = [
        *texts("case connection"),
        Column("ours", lambda row: row.ours, heading=f"ours{force}"),
        Column("published", lambda row: row.published, heading=f"published{force}"),
        Column("ratio", lambda row: row.ratio, heading="ours / published"),
    ]
    return Table("reactions_published", columns, published_reactions(results))


VALUE_COLUMNS: list[Column[PublishedValue]] = [
    *texts("case"),
    *fields("time", "time"),
    Column("quantity", lambda v: v.quantity, "", "quantity",
           lambda v: f"{v.quantity.replace('_', ' ')} [{v.unit}]", numeric=False),
    Column("name", lambda v: v.name, heading="of", numeric=False),
    Column("published", lambda v: v.published, "", "published",
           lambda v: engineering(v.published, 6)),
    Column("ours", lambda v: v.ours, "", "ours", lambda v: engineering(v.ours, 6)),
    Column("ratio", lambda v: ratio(v.ours, v.published), "", "ours / published",
           lambda v: engineering(ratio(v.ours, v.published), 5)),
    *fields("unit"),
    *texts("reason"),
]  # fmt: skip


def published_values_table(results: Results) -> Table[PublishedValue]:
    """Return every published value with the computed one."""
    return Table("published", VALUE_COLUMNS, results.published)


def write_published(results: Results, directory: Path) -> None:
    """Write reactions_published.md and published.md, if there are published values."""
    reactions, values = published_reactions_table(results), published_values_table(results)
    for name, title, table in (
        ("reactions_published", "Reactions compared with published values", reactions),
        ("published", "Comparison with published values", values),
    ):
        if table.rows:
            title = f"# {title}: {markdown.escaped(results.title)}"
            text = f"{title}\n\n{table.grid(results.units).markdown()}\n"
            (directory / f"{name}.md").write_text(text, encoding="utf-8")


MAXIMUM_COLUMNS: list[Column[PinResult]] = [
    *texts("pin case"),
    read_only("published max", lambda pin: pin.published_max_von_mises, "stress"),
    read_only("ours", lambda pin: pin.max_von_mises, "stress"),
    read_only(
        "ours / published",
        lambda pin: engineering(ratio(pin.max_von_mises, pin.published_max_von_mises), 3),
    ),
    read_only("published factor", lambda pin: pin.published_safety_factor, rank=1),
    read_only("our factor", factor_range, rank=2),
    read_only("our verdict", lambda pin: pin.verdict, rank=3, numeric=False),
]


def published_maxima(results: Results) -> Table[PinResult]:
    """Return published maxima and safety factors with the computed ones, in the study's order."""
    rows = [pin for pin in results.pins if pin.published_max_von_mises is not None]
    return Table("published_maxima", MAXIMUM_COLUMNS, rows)

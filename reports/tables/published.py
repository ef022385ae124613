"""Reactions and single numbers compared with those of the publication."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from reports.data.mechanics import PublishedValue
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.files import markdown
from reports.format.numbers import ratio
from reports.format.ranges import factor_range
from reports.tables.column import Column, Table, digits, fields, headed, read_only, texts


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
    return [
        PublishedReaction(table.case, name, ours, theirs, ratio(ours, theirs))
        for table in results.reactions
        for name, ours in zip(table.connections, table.magnitudes.max(axis=0).tolist(), strict=True)
        if (theirs := table.published.get(name)) is not None
    ]


def published_reactions_table(results: Results) -> Table[PublishedReaction]:
    """Return the published reactions as a table."""
    force = f" [{results.units.force}]"  # for people only
    columns: list[Column[PublishedReaction]] = [
        *texts("case connection"),
        *fields("ours", heading=f"ours{force}"),
        *fields("published", heading=f"published{force}"),
        *fields("ratio", heading="ours / published"),
    ]
    return Table("reactions_published", columns, published_reactions(results))


VALUE_COLUMNS: list[Column[PublishedValue]] = [
    *texts("case"),
    *fields("time", "time"),
    Column("quantity", lambda v: v.quantity, "", "quantity",
           lambda v: f"{v.quantity.replace('_', ' ')} [{v.unit}]", numeric=False),
    *fields("name", heading="of", numeric=False),
    *headed("published ours", show=digits(6)),
    Column("ratio", lambda v: ratio(v.ours, v.published), "", "ours / published", show=digits(5)),
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


def _ratio(pin: PinResult) -> float | None:
    return ratio(pin.max_von_mises, pin.published_max_von_mises)


MAXIMUM_COLUMNS: list[Column[PinResult]] = [
    *texts("pin case"),
    read_only("published max", lambda pin: pin.published_max_von_mises, "stress"),
    read_only("ours", lambda pin: pin.max_von_mises, "stress"),
    read_only("ours / published", _ratio, show=digits(3)),
    read_only("published factor", lambda pin: pin.published_safety_factor, rank=1),
    read_only("our factor", factor_range, rank=2),
    read_only("our verdict", lambda pin: pin.verdict, rank=3, numeric=False),
]


def published_maxima(results: Results) -> Table[PinResult]:
    """Return published maxima and safety factors with the computed ones, in the study's order."""
    rows = [pin for pin in results.pins if pin.published_max_von_mises is not None]
    return Table("published_maxima", MAXIMUM_COLUMNS, rows)

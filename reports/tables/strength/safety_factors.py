"""The safety factors, as rows, as a table and as Markdown."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path

from assess.judgement import DEPENDS
from fea.support.records import JointRange
from reports.data.decision import common_factor, limit, worst_first
from reports.data.envelope import detailed_rows, omitted_note
from reports.data.over_loads import BENEATH_CONTACT
from reports.data.results import Results
from reports.data.row import PinResult, SharingRange
from reports.format.files import markdown
from reports.format.numbers import finite, ratio, short
from reports.format.ranges import error_range, factor_range, utilisation_range, variation_range
from reports.format.words import (
    BENEATH_CONTACT_NOTE,
    JOINT_RANGE_NOTE,
    RESULT_ROWS_NOTE,
    SHARING_NOTE,
    VERDICT_MEANINGS,
    depends_words,
    headline,
    result_words,
    verdict_words,
)
from reports.tables.column import (
    Column,
    Table,
    fields,
    grid_of,
    headed,
    in_order,
    texts,
    unit_columns,
)
from reports.tables.published import published_maxima
from reports.tables.stress.joint import lugs_word

FACTOR_COLUMN_ORDER = (  # for people; columns not named here come last
    "pin case outcome safety_factor utilisation max_von_mises error_estimate governs sharing_high "
    "joint_high beneath time verdict model"
)


@dataclass(frozen=True)
class FactorRow:
    """A pin in a case with the results to which it belongs."""

    pin: PinResult
    results: Results

    @property
    def required(self) -> float | None:
        """The factor that is required."""
        return finite(self.pin.required)

    @property
    def joint(self) -> JointRange | None:
        """The range over the unknowns of the joint."""
        return self.pin.joint.range if self.pin.joint else None

    @property
    def sharing(self) -> SharingRange | None:
        """The range over the stiffness of links."""
        return self.pin.sharing

    @property
    def used(self) -> float | None:
        """The required over the actual factor."""
        factor = finite(self.pin.safety_factor)
        return finite((self.required or 1.0) / factor) if factor else None

    @property
    def margin(self) -> float | None:
        """The actual over the required factor, minus 1."""
        factor = finite(self.pin.safety_factor)
        return None if factor is None else factor / (self.required or 1.0) - 1.0


def _error(part: str) -> Column[FactorRow]:
    """Return a column of a part of the error."""
    return Column(f"error_{part}", lambda row: row.pin.error_parts.get(part), "stress")


# New columns are appended at the end, so that the existing ones keep their positions.
COLUMNS: tuple[Column[FactorRow], ...] = (
    *texts("pin.pin pin.case", in_json=True),
    *headed("pin.time", "time", rank=6, drop_if_empty=True, in_json=True),
    *fields("pin.max_von_mises", "stress", heading="max von Mises", rank=1, in_json=True),
    *fields("pin.error_estimate", "stress", heading="±",
            text=lambda row: error_range(row.pin), rank=3, in_json=True),
    *headed("pin.safety_factor", text=lambda row: factor_range(row.pin), in_json=True),
    *fields("required"),
    *fields("pin.meets_required", in_json=True),
    *texts("pin.verdict", text=lambda row: verdict_words(row.pin.verdict, row.pin.yields),
           rank=7, in_json=True),
    *texts("pin.model", rank=8, in_json=True),
    *fields("pin.published_max_von_mises", "stress"),
    Column("ratio", lambda row: ratio(row.pin.max_von_mises, row.pin.published_max_von_mises)),
    *fields("pin.published_safety_factor"),
    *fields("pin.note", in_json=True),
    *unit_columns("stress time", "results"),
    *fields("pin.yields", in_json=True),
    *fields("max_von_mises_low=pin.max_von_mises_interval?.0", "stress"),
    *fields("max_von_mises_high=pin.max_von_mises_interval?.1", "stress"),
    *fields("safety_factor_low=pin.safety_factor_interval?.0"),
    *fields("safety_factor_high=pin.safety_factor_interval?.1"),
    *(_error(part) for part in ("mesh", "time", "series", "model", "cells")),
    *fields("sharing_low=sharing?.max_von_mises.0", "stress"),
    Column("sharing_high", lambda row: row.sharing and row.sharing.max_von_mises[1], "stress",
           "links", lambda row: variation_range(row.sharing), rank=4, drop_if_empty=True),
    *fields("joint_low=joint?.max_von_mises.0", "stress"),
    Column("joint_high", lambda row: row.joint and row.joint.max_von_mises[1], "stress", "joint",
           lambda row: variation_range(row.joint), rank=4, drop_if_empty=True),
    *fields("joint_model=joint?.model"),
    Column("joint_lugs", lambda row: row.joint and lugs_word(row.joint)),
    Column("outcome", lambda row: row.pin.outcome, "", "result",
           lambda row: result_words(row.pin), numeric=False, in_json=True),
    Column("utilisation", lambda row: row.used, "", "utilisation",
           lambda row: utilisation_range(row.pin, limit(row.pin)), rank=2),
    *fields("margin_of_safety=margin"),
    _error("truncation"),
    Column("depends_on", lambda row: depends_words(row.pin.depends_on, row.results.units)
           if row.pin.outcome == DEPENDS else None),
    Column("governs", lambda row: row.pin.places and row.pin.places.governing, "", "at",
           numeric=False, rank=5, drop_if_empty=True),
    *fields("surface=pin.places?.surface?.max_von_mises", "stress"),
    *fields("section=pin.places?.section?.max_von_mises", "stress"),
    *fields("pin.places?.contact?.beneath", "stress", heading="beneath", rank=5,
            drop_if_empty=True),
    *fields("pin.places?.contact?.beneath_error", "stress"),
    *fields("pin.places?.contact?.reach pin.places?.contact?.reach_required", "length"),
    *unit_columns("length", "results"),
)  # fmt: skip


def safety_factors_table(results: Results) -> Table[FactorRow]:
    """Return the table with a row for each pin and case, with all digits."""
    return Table("safety_factors", COLUMNS, [FactorRow(pin, results) for pin in results.pins])


def shown_factors(results: Results, without: Collection[str] = ()) -> Table[FactorRow]:
    """Return the rows for people, the worst first.

    without: keys of columns to leave out.
    """
    rows = [FactorRow(pin, results) for pin in worst_first(results)]
    heads = {"safety_factor": f"safety factor{_required(results)}"}
    shown = [
        replace(c, heading=heads.get(c.key, c.heading))
        for c in in_order(COLUMNS, FACTOR_COLUMN_ORDER)
    ]
    table = Table("safety_factors", [c for c in shown if c.key not in without], rows)
    return replace(table, columns=[column for column, _ in table.for_people()])


def _required(results: Results) -> str:
    required = common_factor(results.pins)
    return "" if required is None else f" (≥ {short(required)})"


def write_safety_factors(results: Results, directory: Path) -> None:
    """Write safety_factors.md: the rows with four digits, and the notes."""
    text = _markdown(results)
    (directory / "safety_factors.md").write_text(text, encoding="utf-8")


def _markdown(everything: Results) -> str:
    results = detailed_rows(everything)
    table = shown_factors(results)
    parts = [
        f"# Safety factors: {markdown.escaped(results.title)}",
        markdown.escaped(headline(everything)),
        table.grid(results.units).markdown(),
        *([rest] if (rest := omitted_note(everything)) else []),
        *reading(table),
        "\n".join(f"- {name}: {sentence}" for name, sentence in VERDICT_MEANINGS.items()),
    ]
    if grid := grid_of(published_maxima(results), results.units):
        parts += ["## Published maxima", grid.markdown()]
    if results.published_source:
        parts.append(f"Published values: {markdown.escaped(results.published_source)}")
    notes = [f"- {_note(pin)}" for pin in results.pins if pin.note or pin.why]
    if notes:
        parts += ["## Notes", "\n".join(notes)]
    return "\n\n".join(parts) + "\n"


def reading(table: Table[FactorRow]) -> list[str]:
    """Return the explanation of the table, one paragraph for each entry."""
    names = table.keys
    return [
        RESULT_ROWS_NOTE,
        *[SHARING_NOTE] * ("sharing_high" in names),
        *[JOINT_RANGE_NOTE] * ("joint_high" in names),
        *[BENEATH_CONTACT_NOTE] * (BENEATH_CONTACT in names),
    ]


def _note(pin: PinResult) -> str:
    said = "; ".join(text for text in (pin.note, pin.why) if text)
    return markdown.escaped(f"{pin.pin}, {pin.case}: {said}")

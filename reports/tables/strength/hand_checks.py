"""Hand checks with the model's safety factor for comparison, as a table and as Markdown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from operator import attrgetter
from pathlib import Path
from typing import Any

from assess.margin import Margin
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.files import markdown
from reports.format.numbers import DASH, components, engineering, short
from reports.format.ranges import factor_range
from reports.format.words import verdict_words
from reports.tables.column import PIN_AND_CASE, Column, Table, fields, unit_columns

HAND_CHECKS_NOTE = (
    "Hand checks use nominal stresses: from beam theory or averaged over a section, without stress "
    "concentration at corners and edges. They cover the whole pin, including excluded zones such "
    "as at a clamp, so their factor may be smaller than the model's. Bending and shear of a pin "
    "whose joint was solved take the moments and forces of the joint model; checks for comparison "
    "govern nothing."
)


@dataclass(frozen=True)
class CheckRow:
    """A hand check of a pin in a case; without a check, the model's result for people."""

    pin: PinResult
    check: Margin | None


def _check(
    name: str, dimension: str, heading: str, model: Callable[[PinResult], str], **more: Any
) -> Column[CheckRow]:
    """Return a column of an attribute of the check.

    name: "attribute" or "key=attribute".
    model: returns the text for people in the row of the model's result.
    """
    key, _, attribute = name.rpartition("=")

    def text(row: CheckRow) -> str:
        return model(row.pin) if row.check is None else of_check.shown(row)

    of_check = Column[CheckRow](
        key or attribute, attrgetter(f"check.{attribute}"), dimension, heading, **more
    )
    return replace(of_check, text=text)


COLUMNS: list[Column[CheckRow]] = [
    *PIN_AND_CASE,
    Column("check", lambda row: row.check and row.check.method, "", "check",
           lambda row: row.check.shown if row.check else _model(row.pin), numeric=False),
    _check("at", "", "location", lambda pin: _location(pin), numeric=False),
    _check("time", "time", "time", lambda pin: short(pin.time), drop_if_empty=True),
    _check("stress=demand", "stress", "stress", lambda pin: engineering(pin.max_von_mises)),
    _check("strength=allowable", "stress", "strength", lambda _: "yield"),
    _check("factor=safety_factor", "", "factor", lambda pin: _factor(pin)),
    _check("formula", "", "stress from", lambda _: "elasticity", numeric=False),
    _check("source=clause", "", "source", lambda _: DASH, numeric=False),
    # These columns repeat the model's result for the pin, with its verdict.
    *fields("pin.model"),
    *fields("pin.max_von_mises", "stress"),
    *fields("pin.safety_factor pin.verdict"),
    *unit_columns("stress time"),
    *fields("safety_factor_low=pin.safety_factor_interval?.0"),
    *fields("safety_factor_high=pin.safety_factor_interval?.1"),
    *fields("check.basis check.governs"),
]  # fmt: skip


def hand_checks_table(results: Results) -> Table[CheckRow]:
    """Return every check of every pin and case, with all digits."""
    rows = [CheckRow(pin, check) for pin in results.pins for check in pin.hand_checks]
    return Table("hand_checks", COLUMNS, rows)


def write_hand_checks(results: Results, directory: Path) -> None:
    """Write hand_checks.md, if there are any checks."""
    checked = [pin for pin in results.pins if pin.hand_checks]
    if not checked:
        return
    parts = [f"# Hand checks: {markdown.escaped(results.title)}", HAND_CHECKS_NOTE]
    for pin in checked:
        title, table = f"{pin.pin}, {pin.case}", pin_checks(pin)
        parts += [f"## {markdown.escaped(title)}", table.grid(results.units).markdown()]
    (directory / "hand_checks.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def pin_checks(pin: PinResult) -> Table[CheckRow]:
    """Return the model's result, then every check, for people."""
    rows = [CheckRow(pin, check) for check in (None, *pin.hand_checks)]
    return Table("hand_checks", COLUMNS, rows)


def _model(pin: PinResult) -> str:
    outside = ", outside the excluded zones" if pin.verdict == "singular" else ""
    return f"{pin.model} model, maximum von Mises stress{outside}"


def _location(pin: PinResult) -> str:
    if pin.location is None:
        return DASH
    place = components(pin.location, max(map(abs, pin.location)))
    return f"x, y, z = {', '.join(place)} {pin.units.length}"


def _factor(pin: PinResult) -> str:
    return f"{factor_range(pin)} ({verdict_words(pin.verdict, pin.yields)})"

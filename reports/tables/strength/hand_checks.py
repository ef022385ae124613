"""Hand checks with the model's safety factor for comparison, as a table and as Markdown."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from assess.margin import Margin
from reports.data.results import PinResult, Results, Units
from reports.format.files import markdown
from reports.format.files.csv import Cell
from reports.format.numbers import DASH, components, engineering, short
from reports.format.ranges import factor_range
from reports.format.words import verdict_words
from reports.tables.table import Table

CHECK_FIELDS = {  # heading -> attribute of a margin
    "name": "method",
    "at": "at",
    "time": "time",
    "stress": "demand",
    "strength": "allowable",
    "factor": "safety_factor",
    "formula": "formula",
    "source": "clause",
}
# The model's result for the same pin, with its verdict.
MODEL_FIELDS = ("model", "max_von_mises", "safety_factor", "verdict")
NUMERIC_CHECK_COLUMNS = ("stress", "strength", "factor", "time")
HAND_CHECKS_NOTE = (
    "Hand checks use nominal stresses: from beam theory or averaged over a section, without stress "
    "concentration at corners and edges. They cover the whole pin, including excluded zones such "
    "as "
    "at a clamp, so their factor may be smaller than the model's. Bending and shear of a pin whose "
    "joint was solved take the moments and forces of the joint model; checks for comparison govern "
    "nothing."
)


RANGE_END_COLUMNS = ("safety_factor_low", "safety_factor_high")  # of a singular row's factor
LATER_CHECK_FIELDS = ("basis", "governs")  # later than the others, so last
COLUMNS = (
    "pin",
    "case",
    "check",
    *list(CHECK_FIELDS)[1:],
    *MODEL_FIELDS,
    "stress_unit",
    "time_unit",
    *RANGE_END_COLUMNS,
    *LATER_CHECK_FIELDS,
)


def hand_check_rows(results: Results) -> Table:
    """Every check of every pin and case, with all digits."""
    rows = _rows([pin for pin in results.pins if pin.hand_checks], results.units)
    return Table.of("hand_checks", COLUMNS, rows)


def write_hand_checks(results: Results, directory: Path) -> None:
    """Write hand_checks.md, if there are any checks."""
    checked = [pin for pin in results.pins if pin.hand_checks]
    if not checked:
        return
    units = results.units
    parts = [f"# Hand checks: {markdown.escaped(results.title)}", HAND_CHECKS_NOTE]
    for pin in checked:
        title, (head, body, numeric) = f"{pin.pin}, {pin.case}", hand_check_table(pin, units)
        parts += [f"## {markdown.escaped(title)}", markdown.table(head, body, numeric)]
    (directory / "hand_checks.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def hand_check_table(pin: PinResult, units: Units) -> tuple[list[str], list[list[str]], list[bool]]:
    """Head, rows and numeric columns for display: the model's result, then every check.

    The time column is omitted if no row has a time.
    """
    headings = {
        "name": "check",
        "at": "location",
        "time": f"time [{units.time}]",
        "stress": f"stress [{units.stress}]",
        "strength": f"strength [{units.stress}]",
        "factor": "factor",
        "formula": "stress from",
        "source": "source",
    }
    if pin.time is None and all(check.time is None for check in pin.hand_checks):
        headings.pop("time")
    rows = [_model(pin, units), *(_check(check) for check in pin.hand_checks)]
    names = list(headings)
    body = [[row[name] for name in names] for row in rows]
    return list(headings.values()), body, [name in NUMERIC_CHECK_COLUMNS for name in names]


def _model(pin: PinResult, units: Units) -> dict[str, str]:
    where = DASH
    if pin.location is not None:
        place = components(pin.location, max(map(abs, pin.location)))
        where = f"x, y, z = {', '.join(place)} {units.length}"
    outside = ", outside the excluded zones" if pin.verdict == "singular" else ""
    verdict = verdict_words(pin.verdict, pin.yields)
    return {
        "name": f"{pin.model} model, maximum von Mises stress{outside}",
        "at": where,
        "time": DASH if pin.time is None else short(pin.time),
        "stress": engineering(pin.max_von_mises),
        "strength": "yield",
        "factor": f"{factor_range(pin)} ({verdict})",
        "formula": "elasticity",
        "source": DASH,
    }


def _check(check: Margin) -> dict[str, str]:
    return {
        "name": check.shown,
        "at": check.at,
        "time": DASH if check.time is None else short(check.time),
        "stress": engineering(check.demand),
        "strength": engineering(check.allowable),
        "factor": engineering(check.safety_factor),
        "formula": check.formula,
        "source": check.clause,
    }


def _rows(checked: list[PinResult], units: Units) -> Iterator[list[Cell]]:
    for pin in checked:
        model = [getattr(pin, name) for name in MODEL_FIELDS]
        for check in pin.hand_checks:
            own = [getattr(check, name) for name in CHECK_FIELDS.values()]
            ends = pin.safety_factor_interval or (None, None)
            added = [getattr(check, name) for name in LATER_CHECK_FIELDS]
            yield [pin.pin, pin.case, *own, *model, units.stress, units.time, *ends, *added]

"""The safety factors, as rows, as a table and as Markdown."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from reports.data.decision import DEPENDS, limit, outcome, worst_first
from reports.data.dependence import BENEATH_CONTACT
from reports.data.envelope import detailed_rows, omitted_note
from reports.data.results import PinResult, Results, Units
from reports.format.files import markdown
from reports.format.numbers import DASH, engineering, finite, ratio, short
from reports.format.ranges import (
    error_range,
    factor_range,
    joint_range,
    utilisation_range,
)
from reports.format.words import (
    BENEATH_CONTACT_NOTE,
    JOINT_RANGE_NOTE,
    RESULT_ROWS_NOTE,
    VERDICT_MEANINGS,
    depends_words,
    headline,
    result_words,
    verdict_words,
)
from reports.tables.published import published_maxima
from reports.tables.stress.joint import lugs_word
from reports.tables.table import Table

Row = dict[str, str | float | None]
COLUMNS = (
    "pin",
    "case",
    "time",
    "max_von_mises",
    "error_estimate",
    "safety_factor",
    "required",
    "meets_required",
    "verdict",
    "model",
    "published_max_von_mises",
    "ratio",
    "published_safety_factor",
    "note",
)
# After the units, so that columns of earlier versions keep their positions.
LATER_COLUMNS = (
    "yields",
    *("max_von_mises_low", "max_von_mises_high", "safety_factor_low", "safety_factor_high"),
    *("error_mesh", "error_time", "error_series", "error_model"),
    *("error_cells", "joint_low", "joint_high", "joint_model", "joint_lugs"),
    *("outcome", "utilisation", "margin_of_safety"),
    "error_truncation",
    "depends_on",
    *("governs", "surface", "section", "beneath", "beneath_error", "reach", "reach_required"),
    "length_unit",
)
TEXT_COLUMNS = ("pin", "case", "result", "governs", "verdict", "model")
JOINT_RANGE_COLUMN = "joint_high"  # in whose place the whole range is shown


def safety_factor_rows(results: Results) -> list[Row]:
    """A row per pin and case; numbers in the study's units, None where there is none."""
    required = finite(results.required_safety_factor)
    return [
        {
            **safety_factor_row(pin, required),
            "depends_on": _depends(pin, results.units),
            "length_unit": results.units.length,
        }
        for pin in results.pins
    ]


def _depends(pin: PinResult, units: Units) -> str | None:
    return depends_words(pin.depends_on, units) if outcome(pin) == DEPENDS else None


def display_rows(results: Results) -> list[Row]:
    """The same for display, the worst first: text where a number may be an interval."""
    required = limit(results)
    return [
        {
            **safety_factor_row(pin, results.required_safety_factor),
            "result": result_words(pin),
            "error_estimate": error_range(pin),
            "safety_factor": factor_range(pin),
            "utilisation": utilisation_range(pin, required),
            JOINT_RANGE_COLUMN: joint_range(pin),
        }
        for pin in worst_first(results)
    ]


def safety_factor_row(pin: PinResult, required: float | None) -> Row:
    """A row; numbers in the results' units, None where there is none."""
    return {
        "pin": pin.pin,
        "case": pin.case,
        "time": finite(pin.time),
        "max_von_mises": finite(pin.max_von_mises),
        "error_estimate": finite(pin.error_estimate),
        "safety_factor": finite(pin.safety_factor),
        "required": required,
        "meets_required": None if pin.meets_required is None else _yes(pin.meets_required),
        "verdict": pin.verdict,
        "model": pin.model,
        "published_max_von_mises": finite(pin.published_max_von_mises),
        "ratio": ratio(pin.max_von_mises, pin.published_max_von_mises),
        "published_safety_factor": finite(pin.published_safety_factor),
        "note": pin.note,
        "yields": None if pin.yields is None else _yes(pin.yields),
        **_ends("max_von_mises", pin.max_von_mises_interval),
        **_ends("safety_factor", pin.safety_factor_interval),
        **{f"error_{part}": finite(value) for part, value in pin.error_parts.items()},
        **_joint(pin),
        **_places(pin),
        "outcome": outcome(pin),
        **_used(pin, required),
    }


def _used(pin: PinResult, required: float | None) -> Row:
    factor, needed = finite(pin.safety_factor), required or 1.0
    return {
        "utilisation": finite(needed / factor) if factor else None,
        "margin_of_safety": None if factor is None else factor / needed - 1.0,
    }


def _ends(name: str, interval: tuple[float, float | None] | None) -> Row:
    low, high = interval or (None, None)
    return {f"{name}_low": finite(low), f"{name}_high": finite(high)}


def _joint(pin: PinResult) -> Row:
    """The maximum over what is not known of the joint."""
    over = pin.joint.range if pin.joint else None
    low, high = over.max_von_mises if over else (None, None)
    return {
        "joint_low": finite(low),
        "joint_high": finite(high),
        "joint_model": over.model if over else None,
        "joint_lugs": lugs_word(over) if over else None,
    }


def _places(pin: PinResult) -> Row:
    places = pin.places
    section, contact = (places.section, places.contact) if places else (None, None)
    return {
        "governs": places.governs if places else None,
        "surface": finite(places.surface.max_von_mises) if places else None,
        "section": finite(section.max_von_mises) if section else None,
        **{
            name: finite(getattr(contact, name)) if contact else None
            for name in (BENEATH_CONTACT, "beneath_error", "reach", "reach_required")
        },
    }


def _yes(value: bool) -> str:
    return "yes" if value else "no"


def shown_columns(rows: list[Row], results: Results) -> dict[str, str]:
    """Columns for display with their headings; what governs, the range over the joint, what lies
    beneath contact and the time only if there are any.
    """
    units, required = results.units, results.required_safety_factor
    needed = "" if required is None else f" (≥ {short(required)})"
    headings = {
        "pin": "pin",
        "case": "case",
        "result": "result",
        "safety_factor": f"safety factor{needed}",
        "utilisation": "utilisation",
        "max_von_mises": f"max von Mises [{units.stress}]",
        "error_estimate": f"± [{units.stress}]",
        "governs": "at",
        JOINT_RANGE_COLUMN: f"joint [{units.stress}]",
        BENEATH_CONTACT: f"beneath [{units.stress}]",
        "time": f"time [{units.time}]",
        "verdict": "verdict",
        "model": "model",
    }
    empty = [
        k
        for k in ("governs", JOINT_RANGE_COLUMN, BENEATH_CONTACT, "time")
        if all(row[k] in (None, DASH) for row in rows)
    ]
    return {name: text for name, text in headings.items() if name not in empty}


def display_text(name: str, row: Row) -> str:
    """A value of a row for display: four digits, a dash for no value."""
    value = row[name]
    if name == "verdict":
        return verdict_words(str(value), row["yields"] == "yes")
    if value is None:
        return DASH
    if isinstance(value, str):
        return value
    return short(value) if name == "time" else engineering(value)


def safety_factors_table(results: Results) -> Table:
    """A row per pin and case, with all digits."""
    units = results.units
    return Table.of(
        "safety_factors",
        (*COLUMNS, "stress_unit", "time_unit", *LATER_COLUMNS),
        (
            [
                *(row[n] for n in COLUMNS),
                units.stress,
                units.time,
                *(row.get(n) for n in LATER_COLUMNS),
            ]
            for row in safety_factor_rows(results)
        ),
    )


def write_safety_factors(results: Results, directory: Path) -> None:
    """Write safety_factors.md, four digits and the notes."""
    text = _markdown(results)
    (directory / "safety_factors.md").write_text(text, encoding="utf-8")


def _markdown(everything: Results) -> str:
    results = detailed_rows(everything)
    rows = display_rows(results)
    columns = shown_columns(rows, results)
    parts = [
        f"# Safety factors: {markdown.escaped(results.title)}",
        markdown.escaped(headline(everything)),
        markdown.table(
            tuple(columns.values()),
            [[display_text(name, row) for name in columns] for row in rows],
            [name not in TEXT_COLUMNS for name in columns],
        ),
        *([rest] if (rest := omitted_note(everything)) else []),
        *reading(columns),
        "\n".join(f"- {name}: {sentence}" for name, sentence in VERDICT_MEANINGS.items()),
    ]
    if grid := published_maxima(results):
        parts += ["## Published maxima", markdown.table(grid.head, grid.body, grid.numeric)]
    if results.published_source:
        parts.append(f"Published values: {markdown.escaped(results.published_source)}")
    notes = [f"- {_note(pin)}" for pin in results.pins if pin.note or pin.why]
    if notes:
        parts += ["## Notes", "\n".join(notes)]
    return "\n\n".join(parts) + "\n"


def reading(columns: Iterable[str]) -> list[str]:
    """How the table with these columns is to be read, a paragraph each."""
    names = tuple(columns)
    return [
        RESULT_ROWS_NOTE,
        *[JOINT_RANGE_NOTE] * (JOINT_RANGE_COLUMN in names),
        *[BENEATH_CONTACT_NOTE] * (BENEATH_CONTACT in names),
    ]


def _note(pin: PinResult) -> str:
    said = "; ".join(text for text in (pin.note, pin.why) if text)
    return markdown.escaped(f"{pin.pin}, {pin.case}: {said}")

"""The safety factors, as rows, as a table and as Markdown."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from reports.data.results import PinResult, Results, Units
from reports.format import markdown
from reports.format.numbers import DASH, engineering, finite, ratio, short
from reports.format.ranges import error_range, factor_range, joint_range
from reports.format.words import JOINT, MEANING, READING, verdict_words
from reports.tables.joint import lugs_word
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
LATER = (
    "yields",
    *("max_von_mises_low", "max_von_mises_high", "safety_factor_low", "safety_factor_high"),
    *("error_mesh", "error_time", "error_series", "error_model"),
    *("error_cells", "joint_low", "joint_high", "joint_model", "joint_lugs"),
)
TEXTS = ("pin", "case", "meets_required", "verdict", "model")
PUBLISHED = ("published_max_von_mises", "ratio", "published_safety_factor")
OVER_JOINT = "joint_high"  # in whose place the whole range is shown


def safety_factor_rows(results: Results) -> list[Row]:
    """A row per pin and case; numbers in the study's units, None where there is none."""
    required = finite(results.required_safety_factor)
    return [_row(pin, required) for pin in results.pins]


def shown_rows(results: Results) -> list[Row]:
    """The same for display: text where a number is an interval."""
    return [
        {
            **row,
            "error_estimate": error_range(pin),
            "safety_factor": factor_range(pin),
            OVER_JOINT: joint_range(pin),
        }
        for pin, row in zip(results.pins, safety_factor_rows(results), strict=True)
    ]


def _row(pin: PinResult, required: float | None) -> Row:
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


def _yes(value: bool) -> str:
    return "yes" if value else "no"


def shown_columns(rows: list[Row], units: Units) -> dict[str, str]:
    """Columns for display with their headings: no note, published values and the range over the
    joint only if there are any.
    """
    headings = {
        "pin": "pin",
        "case": "case",
        "time": f"time [{units.time}]",
        "max_von_mises": f"max von Mises [{units.stress}]",
        "error_estimate": f"± [{units.stress}]",
        OVER_JOINT: f"joint [{units.stress}]",
        "safety_factor": "safety factor",
        "required": "required",
        "meets_required": "meets required",
        "verdict": "verdict",
        "model": "model",
        "published_max_von_mises": f"published max [{units.stress}]",
        "ratio": "ours / published",
        "published_safety_factor": "published factor",
    }
    optional = (*PUBLISHED, OVER_JOINT)
    empty = [name for name in optional if all(row[name] in (None, DASH) for row in rows)]
    return {name: text for name, text in headings.items() if name not in empty}


def shown(name: str, row: Row) -> str:
    """A value of a row for display: four digits, a dash for no value."""
    value = row[name]
    if name == "verdict":
        return verdict_words(str(value), row["yields"] == "yes")
    if value is None or (name == "meets_required" and not _decides(row)):
        return DASH
    if isinstance(value, str):
        return value
    if name in ("required", "time"):
        return short(value)
    return engineering(value)


def _decides(row: Row) -> bool:
    """Whether a row decides if the required factor is met; a singular one can only fail."""
    return row["verdict"] != "singular" or row["meets_required"] == "no"


def safety_factors_table(results: Results) -> Table:
    """A row per pin and case, with all digits."""
    units = results.units
    return Table.of(
        "safety_factors",
        (*COLUMNS, "stress_unit", "time_unit", *LATER),
        (
            [*(row[n] for n in COLUMNS), units.stress, units.time, *(row.get(n) for n in LATER)]
            for row in safety_factor_rows(results)
        ),
    )


def write_safety_factors(results: Results, directory: Path) -> None:
    """Write safety_factors.md, four digits and the notes."""
    text = _markdown(results, shown_rows(results))
    (directory / "safety_factors.md").write_text(text, encoding="utf-8")


def _markdown(results: Results, rows: list[Row]) -> str:
    columns = shown_columns(rows, results.units)
    parts = [
        f"# Safety factors: {markdown.escaped(results.title)}",
        markdown.table(
            tuple(columns.values()),
            [[shown(name, row) for name in columns] for row in rows],
            [name not in TEXTS for name in columns],
        ),
        *reading(columns),
        "\n".join(f"- {name}: {sentence}" for name, sentence in MEANING.items()),
    ]
    if results.published_source:
        parts.append(f"Published values: {markdown.escaped(results.published_source)}")
    notes = [f"- {_note(pin)}" for pin in results.pins if pin.note or pin.why]
    if notes:
        parts += ["## Notes", "\n".join(notes)]
    return "\n\n".join(parts) + "\n"


def reading(columns: Iterable[str]) -> list[str]:
    """How the table with these columns is to be read, a paragraph each."""
    return [READING, JOINT] if OVER_JOINT in columns else [READING]


def _note(pin: PinResult) -> str:
    said = "; ".join(text for text in (pin.note, pin.why) if text)
    return markdown.escaped(f"{pin.pin}, {pin.case}: {said}")

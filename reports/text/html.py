"""The safety factors as HTML, for notebooks."""

from __future__ import annotations

from html import escape

from reports.data.envelope import detailed_rows, omitted_note
from reports.data.results import Results
from reports.format.words import headline
from reports.tables.strength.safety_factors import (
    TEXT_COLUMNS,
    display_rows,
    display_text,
    shown_columns,
)
from reports.text.summary import summary

HEADING_CELL_HTML = '<th style="text-align:{0}">{1}</th>'
BODY_CELL_HTML = '<td style="text-align:{0}">{1}</td>'


def safety_factors_html(results: Results) -> str:
    """Title, the worst row in a sentence, safety factor table with verdicts, and summary."""
    detailed = detailed_rows(results)
    rows = display_rows(detailed)
    columns = shown_columns(rows, detailed)
    sides = {name: "left" if name in TEXT_COLUMNS else "right" for name in columns}
    head = "".join(
        HEADING_CELL_HTML.format(sides[name], escape(text)) for name, text in columns.items()
    )
    body = "".join(
        "<tr>"
        + "".join(
            BODY_CELL_HTML.format(sides[name], escape(display_text(name, row))) for name in columns
        )
        + "</tr>"
        for row in rows
    )
    return (
        f"<p><b>{escape(results.title)}</b></p>"
        f"<p>{escape(headline(results))}</p>"
        f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        f"<p>{escape(' '.join(filter(None, (omitted_note(results), summary(results)))))}</p>"
    )

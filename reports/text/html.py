"""The safety factors as HTML, for notebooks."""

from __future__ import annotations

from html import escape

from reports.data.envelope import elsewhere, in_detail
from reports.data.results import Results
from reports.format.words import headline
from reports.tables.strength.safety_factors import TEXTS, shown, shown_columns, shown_rows
from reports.text.summary import summary

HEAD = '<th style="text-align:{0}">{1}</th>'
CELL = '<td style="text-align:{0}">{1}</td>'


def safety_factors_html(results: Results) -> str:
    """Title, the worst row in a sentence, safety factor table with verdicts, and summary."""
    detailed = in_detail(results)
    rows = shown_rows(detailed)
    columns = shown_columns(rows, detailed)
    sides = {name: "left" if name in TEXTS else "right" for name in columns}
    head = "".join(HEAD.format(sides[name], escape(text)) for name, text in columns.items())
    body = "".join(
        "<tr>"
        + "".join(CELL.format(sides[name], escape(shown(name, row))) for name in columns)
        + "</tr>"
        for row in rows
    )
    return (
        f"<p><b>{escape(results.title)}</b></p>"
        f"<p>{escape(headline(results))}</p>"
        f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        f"<p>{escape(' '.join(filter(None, (elsewhere(results), summary(results)))))}</p>"
    )

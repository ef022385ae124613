"""The safety factors as HTML, for notebooks."""

from __future__ import annotations

from html import escape

from reports.data.envelope import detailed_rows, omitted_note
from reports.data.results import Results
from reports.format.words import headline
from reports.tables.strength.safety_factors import shown_factors
from reports.text.summary import summary

HEADING_CELL_HTML = '<th style="text-align:{0}">{1}</th>'
BODY_CELL_HTML = '<td style="text-align:{0}">{1}</td>'


def safety_factors_html(results: Results) -> str:
    """Return the title, a sentence on the worst row, the safety factors with verdicts, and the
    summary.
    """
    grid = shown_factors(detailed_rows(results)).grid(results.units)
    sides = ["right" if numeric else "left" for numeric in grid.numeric]

    def cells(html: str, texts: list[str]) -> str:
        pairs = zip(sides, texts, strict=True)
        return "".join(html.format(side, escape(text)) for side, text in pairs)

    head = cells(HEADING_CELL_HTML, grid.head)
    body = "".join(f"<tr>{cells(BODY_CELL_HTML, row)}</tr>" for row in grid.body)
    return (
        f"<p><b>{escape(results.title)}</b></p>"
        f"<p>{escape(headline(results))}</p>"
        f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        f"<p>{escape(' '.join(filter(None, (omitted_note(results), summary(results)))))}</p>"
    )

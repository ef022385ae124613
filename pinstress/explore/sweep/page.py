"""The page designs.html, to explore the designs of a sweep, in one file that opens offline."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from pinstress.explore.sweep.design_columns import DesignColumn, Designs
from reports.format.numbers import DASH, short
from reports.format.packed import packed
from reports.format.script_json import script_json
from reports.format.template import rendered
from reports.format.words import VERDICT_MEANINGS, not_judged
from reports.plots.theme import style_sheet
from reports.tables.column import Grid

MAX_REASONS = 20


def render_designs(designs: Designs) -> str:
    """Return the page as text."""
    return rendered(
        "designs/page.html.j2",
        study=designs.study,
        summary=summary(designs),
        columns=column_grid(designs),
        reasons=reason_grid(designs),
        meaning={k: VERDICT_MEANINGS[k] for k in _verdicts(designs)},
        shades=style_sheet(),
        data=script_json(page_data(designs)),
    )


def summary(designs: Designs) -> str:
    """Return the numbers of designs and of those with results, and the requirement, in words."""
    count, failed = len(designs.numbers), int(designs.failed.sum())
    parts = [f"{count:,} {'design' if count == 1 else 'designs'}"]
    parts += [f"{count - failed:,} with results and {failed:,} without"] if failed else []
    varied = sum(len(np.unique(p.known)) > 1 for p in designs.parameters)
    parts += [f"{varied} varied {'parameter' if varied == 1 else 'parameters'}"]
    if designs.required is not None:
        parts += [f"required safety factor {short(designs.required)}"]
    beside = not_judged(designs.in_lugs, designs.other_checks).replace("`", "")  # of the terminal
    return f"{'; '.join(parts)}. {beside}".rstrip()


def page_data(designs: Designs) -> dict[str, Any]:
    """Return the data for the scripts; templates/designs/model.js unpacks them."""
    return {
        "study": designs.study,
        "required": designs.required,
        "numbers": packed(designs.numbers, "<u4"),
        "first": packed(designs.first, "<u4"),
        "columns": [
            *({**_packed(c), "of": "design"} for c in designs.parameters),
            *({**_packed(c), "of": "row"} for c in designs.results),
        ],
        "texts": {name: _packed(column) for name, column in designs.texts.items()},
        "meaning": VERDICT_MEANINGS,
    }


def _packed(column: DesignColumn) -> dict[str, Any]:
    """Return a packed column; texts as their index in `names`, counted from 1, 0 for none."""
    head = {"key": column.key, "title": column.title, "unit": column.unit}
    if column.names is None:
        return {**head, "values": packed(column.values, "<f8")}
    places = np.where(np.isfinite(column.values), column.values + 1.0, 0.0)
    return {**head, "names": list(column.names), "places": packed(places, "<u4")}


def column_grid(designs: Designs) -> Grid:
    """Return a table of the parameters and results with their ranges."""
    columns = [(c, "parameter") for c in designs.parameters]
    columns += [(c, "result") for c in designs.results]
    body = [[c.title, kind, c.unit or DASH, *_ends(c), c.law or DASH] for c, kind in columns]
    head = ["column", "", "unit", "lowest", "highest", "distribution"]
    return Grid(head, body, [False, False, False, True, True, False])


def _ends(column: DesignColumn) -> list[str]:
    known = column.known
    if not len(known):
        return [DASH, DASH]
    if column.names is not None:
        return [f"{len(column.names)} values", DASH]
    return [short(float(known.min())), short(float(known.max()))]


def reason_grid(designs: Designs) -> Grid:
    """Return a table of the reasons why rows have no results, grouped by code, the most frequent
    first, with an example of each.
    """
    reason, code = designs.texts["reason"], designs.texts["code"]
    counts: Counter[str] = Counter()
    example: dict[str, str] = {}
    rows = designs.failed_rows
    for why, of in zip(reason.values[rows], code.values[rows], strict=True):
        text = (reason.names or ())[int(why)]
        name = (code.names or ())[int(of)] if np.isfinite(of) else text
        counts[name] += 1
        example.setdefault(name, text)
    body = [[f"{n:,}", example[name]] for name, n in counts.most_common(MAX_REASONS)]
    if len(counts) > MAX_REASONS:
        rest = sum(counts.values()) - sum(n for _, n in counts.most_common(MAX_REASONS))
        body.append([f"{rest:,}", "other reasons"])
    return Grid(["rows", "reason (an example of each kind)"], body, [True, False])


def _verdicts(designs: Designs) -> list[str]:
    names = designs.texts["verdict"].names or ()
    return [name for name in VERDICT_MEANINGS if name in names]

"""The maxima of two runs with their errors, row by row."""

from __future__ import annotations

from reports.data.comparison import RunComparison
from reports.plots.spec import Plot, Spec, labels, rows
from reports.tables.comparison import changed_rows

COMPARISON_PLOT_NAME = "comparison"
MAX_PLOT_ROWS = 40  # with more rows, the caption gives their number


def comparison_plot(comparison: RunComparison) -> Plot | None:
    """Return points with their ranges on a logarithmic axis; None without a changed maximum."""
    data: list[Spec] = []
    changed = changed_rows(comparison)
    pairs = changed[:MAX_PLOT_ROWS]
    pins, cases = labels(x.pin for x in pairs), labels(x.case for x in pairs)
    for pair in pairs:
        for run, side in zip("AB", (pair.first, pair.second), strict=True):
            if side is None or not side.maximum:
                continue
            ends = side.low or side.maximum, side.high or side.maximum
            low = max(ends[0], 1e-3 * side.maximum)
            row = f"{pins[pair.pin]}, {cases[pair.case]}"
            data.append({"row": row, "run": run, "x": side.maximum, "low": low, "high": ends[1]})
    if not data:
        return None
    title = f"maximum von Mises stress [{comparison.stress}]"
    x = {"field": "low", "type": "quantitative", "title": title,
         "scale": {"type": "log", "nice": False, "padding": 15}}  # fmt: skip
    y = {"field": "row", "type": "nominal", "title": None, "sort": None}
    beside = {"field": "run", "type": "nominal"}
    colour = {"field": "run", "type": "nominal", "title": None, "scale": {"domain": ["A", "B"]}}
    common = {"y": y, "yOffset": beside, "color": colour}
    spec = {
        "data": rows(data),
        "width": 420,
        "height": {"step": 12},
        "layer": [
            {"mark": {"type": "rule", "size": 2}, "encoding": {"x": x, "x2": {"field": "high"},
                                                               **common}},
            {"mark": {"type": "point", "filled": True, "size": 45},
             "encoding": {"x": {**x, "field": "x"}, "shape": colour, **common}},
        ],
    }  # fmt: skip
    caption = "Maxima of both runs with their errors"
    if len(changed) > len(pairs):
        caption += f": the first {len(pairs)} of the {len(changed):,} rows above"
    return Plot(COMPARISON_PLOT_NAME, f"{caption}.", spec)

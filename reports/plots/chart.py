"""The speed-accuracy chart: error against time and against memory."""

from __future__ import annotations

import textwrap
from math import ceil, floor, log10

from reports.data.chart import CHART_NAME, Chart, ChartPoint, error
from reports.format.numbers import percent
from reports.plots.spec import Plot, Spec, clipped, headed, level, rows
from reports.text.chart_summary import curve_name, failures, reference_line

SUBTITLE_LINE_LENGTH = 110  # characters
AXIS_ROOM_FACTOR = 2.5  # by which the axis extends beyond the outermost points
X_AXIS_HEADINGS = {
    "seconds": "time, meshing included [s]",
    "memory": "peak memory above bare process [MB]",
}


def chart_plot(chart: Chart) -> Plot:
    """Return two logarithmic panels with a common axis of errors."""
    floor = max(chart.reference.error, 1e-9)  # error of the reference, positive
    data = [
        _row(curve_name(model, element), point, floor)
        for (model, element), curve in chart.curves.items()
        for point in curve
    ]
    errors = [row["error"] for row in data]
    limits = [
        min(*errors, floor) / AXIS_ROOM_FACTOR,
        max(*errors, chart.tolerance) * AXIS_ROOM_FACTOR,
    ]
    title = f"pin {clipped(chart.pin)}, {clipped(chart.case, 40)}: error against cost"
    names = list(dict.fromkeys(row["of"] for row in data))
    spec = {
        "title": headed(title, *_foot(chart)),
        "usermeta": {"columns": list(X_AXIS_HEADINGS.values())},
        "data": rows(data),
        "hconcat": [_panel(across, heading, limits, chart, names)
                    for across, heading in X_AXIS_HEADINGS.items()],
    }  # fmt: skip
    return Plot(CHART_NAME, title, spec)


def _row(of: str, point: ChartPoint, floor: float) -> Spec:
    return {
        "of": of, "seconds": point.seconds or 0.0, "memory": point.memory or 0.0,
        "error": max(error(point), floor / 3.0), "shown": percent(error(point)),
        "dofs": point.dofs or 0, "auto": point.chosen,
    }  # fmt: skip


def _panel(across: str, heading: str, limits: list[float], chart: Chart, names: list[str]) -> Spec:
    floor = max(chart.reference.error, 1e-9)
    x = {"field": across, "type": "quantitative", "title": heading,
         "scale": {"type": "log", "nice": False, "padding": 20},
         "axis": {"tickCount": 4, "grid": False}}  # fmt: skip
    y = {"field": "error", "type": "quantitative", "title": "error of the maximum von Mises stress",
         "scale": {"type": "log", "domain": limits, "nice": False},
         "axis": {"format": "~%", "values": _decades(*limits)}}  # fmt: skip
    key = {"field": "of", "type": "nominal", "title": None, "scale": {"domain": names},
           "legend": {"symbolSize": 60}}  # fmt: skip
    unclear = {
        "data": rows([{}]),
        "mark": {"type": "rect", "style": "shade"},
        "encoding": {"x": {"value": 0}, "x2": {"value": "width"},
                     "y": {"datum": limits[0], "type": "quantitative"}, "y2": {"datum": floor}},
    }  # fmt: skip
    line = {
        "mark": {"type": "line", "point": {"size": 45, "filled": True}},
        "encoding": {"x": x, "y": y, "color": key, "shape": key, "order": {"field": "dofs"},
                     "tooltip": [{"field": name, "title": text} for name, text in (
                         ("of", "model"), ("dofs", "unknowns"), ("seconds", "time [s]"),
                         ("memory", "memory [MB]"), ("shown", "error"))]},
    }  # fmt: skip
    ring = {
        "transform": [{"filter": "datum.auto"}],
        "mark": {"type": "point", "size": 160, "style": "zero", "filled": False},
        "encoding": {"x": x, "y": y},
    }
    auto = {
        "transform": [{"filter": "datum.auto"}],
        "mark": {"type": "text", "style": "note", "align": "left", "dx": 10, "text": "auto"},
        "encoding": {"x": x, "y": y},
    }
    tolerance = level(chart.tolerance, f"tolerance {percent(chart.tolerance)}")
    return {"width": 300, "height": 240, "layer": [unclear, tolerance, line, ring, auto]}


def _decades(low: float, high: float) -> list[float]:
    return [10.0**k for k in range(ceil(log10(low)), floor(log10(high)) + 1)]


def _foot(chart: Chart) -> list[str]:
    """Return the lines under the title: reference, shaded range, failures."""
    of = f"median of {chart.runs} runs" if chart.runs > 1 else "one run"
    lines = [
        reference_line(chart),
        f"Shaded: errors that cannot be distinguished from zero. Times: {of}; bare process: "
        f"{chart.bare:.0f} MB.",
        *([chart.note] if chart.note else []),
        *failures(chart),
    ]
    return [part for line in lines for part in textwrap.wrap(line, SUBTITLE_LINE_LENGTH)]

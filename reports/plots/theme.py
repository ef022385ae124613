"""Theme of the plots: colours, dashes, and the configuration of Vega-Lite that all plots share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

# Colours on light and on dark ground. The dashes of the seven curves differ, also without colour.
THEME_COLOURS: dict[str, tuple[str, str]] = {
    "ink": ("#1d1f23", "#e4e6ea"),
    "quiet": ("#5a6068", "#a2a9b3"),
    "paper": ("#ffffff", "#17191d"),
    "rule": ("#d7dbe0", "#3a3f47"),
    "band": ("#9dbbe0", "#35587f"),
    "shade": ("#ececec", "#2b2f35"),
    "hot": ("#a8211b", "#ff8f87"),
    "s0": ("#0b3c6f", "#74acf5"),
    "s1": ("#c8501e", "#ff9466"),
    "s2": ("#1a8a6e", "#4fcdaa"),
    "s3": ("#8f4a9c", "#d394e2"),
    "s4": ("#7a6a00", "#d6bf4c"),
    "s5": ("#4f9bd9", "#7fd0f7"),
    "s6": ("#000000", "#ffffff"),
}
SERIES_COLOURS = tuple(name for name in THEME_COLOURS if name[0] == "s" and name[1:].isdigit())
SERIES_DASHES = ([1, 0], [7, 3], [2, 2], [7, 3, 2, 3], [4, 2], [7, 2, 2, 2, 2, 2], [12, 3])


def dashes(number: int) -> list[list[int]]:
    """Return the dashes of `number` curves; the first 49 differ in colour or dashes."""
    return [
        SERIES_DASHES[(k + k // len(SERIES_COLOURS)) % len(SERIES_DASHES)] for k in range(number)
    ]


def style_sheet() -> str:
    """Return the colours as properties of a style sheet."""
    shades = (
        f"--{name}: light-dark({light}, {dark});" for name, (light, dark) in THEME_COLOURS.items()
    )
    return f":root {{ {' '.join(shades)} }}"


def on_paper(font: str = "DejaVu Sans, sans-serif") -> dict[str, Any]:
    """Return the configuration of plots in files."""
    colours = {name: light for name, (light, _) in THEME_COLOURS.items()}
    return {**_config(colours, font), "background": colours["paper"]}


def on_page() -> dict[str, Any]:
    """Return the configuration in the report, whose style sheet gives the colours."""
    colours = {name: f"var(--{name})" for name in THEME_COLOURS}
    return {**_config(colours, "system-ui, sans-serif"), "background": None}


def _config(c: Mapping[str, str], font: str) -> dict[str, Any]:
    text = {"labelColor": c["ink"], "titleColor": c["ink"], "titleFontWeight": "normal"}
    return {
        "font": font,
        "aria": False,
        "mark": {"aria": False},  # otherwise each mark would need a label
        "padding": 4,
        "axis": {**text, "gridColor": c["rule"], "domainColor": c["quiet"], "tickColor": c["quiet"],
                 "labelFontSize": 11, "titleFontSize": 11, "labelLimit": 260},
        "axisY": {"grid": True, "minExtent": 46, "domain": False, "ticks": False, "tickCount": 5},
        "axisX": {"tickCount": 8},
        "legend": {**text, "orient": "top", "title": None, "labelFontSize": 11, "labelLimit": 320,
                   "columnPadding": 16, "symbolSize": 400, "symbolStrokeWidth": 1.8,
                   "symbolType": "stroke", "columns": 4},
        "title": {"anchor": "start", "color": c["ink"], "subtitleColor": c["quiet"],
                  "fontSize": 11, "fontWeight": "normal", "offset": 6, "frame": "group"},
        "view": {"stroke": None, "continuousWidth": 560, "continuousHeight": 150},
        "concat": {"spacing": 14},
        "range": {"category": [c[name] for name in SERIES_COLOURS]},
        "line": {"strokeWidth": 1.6},
        "style": {
            "zero": {"color": c["quiet"], "strokeWidth": 1},
            "level": {"color": c["quiet"], "strokeWidth": 1.2, "strokeDash": [2, 2]},
            "governs": {"color": c["ink"], "strokeDash": [4, 3]},
            "pointed": {"color": c["quiet"], "strokeWidth": 5},
            "note": {"color": c["ink"], "fontSize": 11},
            "quiet-note": {"color": c["quiet"], "fontSize": 11},
            "hot-note": {"color": c["hot"], "fontSize": 11},
            "hot": {"color": c["hot"], "strokeWidth": 1.5},
            "band": {"color": c["band"], "fillOpacity": 0.5},
            "shade": {"color": c["shade"]},
            "bar": {"color": c["s5"]},
            "published": {"color": c["paper"], "stroke": c["s1"], "strokeWidth": 1.6},
            "faint": {"color": c["quiet"], "strokeWidth": 1, "strokeOpacity": 0.45},
            "hollow": {"color": c["paper"], "stroke": c["ink"], "strokeWidth": 1.5},
        },
    }  # fmt: skip

"""Specifications of plots in Vega-Lite, as plain dicts with their data.

The report draws them in the browser; reports.plots.draw draws the same specifications into files.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.shape.chords import needed
from pinbase.arrays import Mask
from pinbase.dimensions import Floats
from reports.plots.theme import dashes

Spec = dict[str, Any]
CURVE_TOLERANCE = 1e-6  # of the largest value; curves nearer than this coincide
MAX_CURVE_POINTS = 2_001  # of more points, only those that the curves need are drawn
POINTER_POINTS = 500  # least number of points of a curve at which the pointer finds values
CURVE_POINT_TOLERANCE = 5e-4  # of a panel's extent: a twelfth of a pixel
FEW_VALUES = 32  # values by which curves are compared first
NUMBER_FORMAT = ",.5~r"
ZOOM_PARAMETER: Spec = {
    "name": "zoom",
    "select": {"type": "interval", "encodings": ["x"], "zoom": "wheel![event.shiftKey]"},
    "bind": "scales",
}
POINTER_PARAMETER: Spec = {
    "name": "pointed",
    "select": {"type": "point", "on": "pointerover", "clear": "pointerout", "fields": ["x"]},
}


@dataclass(frozen=True)
class Plot:
    """A plot: the name of its file without extension, its caption, and its specification."""

    name: str
    caption: str
    spec: Spec


@dataclass(frozen=True)
class Abscissa:
    """The values (N,) against which curves are drawn, with their heading."""

    heading: str
    values: Floats
    logarithmic: bool = False


@dataclass(frozen=True)
class Panel:
    """Curves (N,) by name over a common abscissa, NaN where values are missing.

    under, over: layers behind and in front of the curves.
    scale: of the ordinate.
    zero: whether to draw a line at zero.
    """

    heading: str
    curves: dict[str, Floats]
    under: tuple[Spec, ...] = ()
    over: tuple[Spec, ...] = ()
    scale: Spec = field(default_factory=dict)
    height: float = 110.0
    zero: bool = True


def curves(title: str, x: Abscissa, panels: Sequence[Panel], common: bool = False) -> Spec:
    """Return panels with curves over one abscissa, which zoom together and show values at the
    pointer.

    common: whether the curves of all panels have the same names, and share a key.
    """
    together = [panels] if common else [[panel] for panel in panels]
    merged = [shown for part in together for shown in _merged([p.curves for p in part])]
    kept = _needed(x, panels, merged)
    columns: list[tuple[str, str, Floats]] = [("x", x.heading, x.values[kept])]
    views: list[Spec] = []
    for panel, shown in zip(panels, merged, strict=True):
        ids = [f"c{len(columns) - 1 + k}" for k in range(len(shown))]
        heads = [f"{name}, {panel.heading}" if name else panel.heading for name in shown]
        columns += list(zip(ids, heads, (values[kept] for values in shown.values()), strict=True))
        views.append(_view(panel, dict(zip(ids, shown, strict=True)), x, panel is panels[-1]))
    scales = "shared" if common else "independent"
    return {
        "title": headed(title),
        "usermeta": {"columns": [head for _, head, _ in columns]},
        "data": table({name: values for name, _, values in columns}),
        "vconcat": views,
        "resolve": {"scale": {"color": scales, "strokeDash": scales}},
    }


def headed(title: str, *notes: str) -> Spec:
    """Return the title of a plot, with notes as lines under it."""
    return {"text": title, "subtitle": list(notes), "fontSize": 13, "fontWeight": 600, "offset": 12}


def table(columns: dict[str, Floats]) -> Spec:
    """Return columns (N,) as CSV data, the shortest form that Vega-Lite reads."""
    rows = zip(*(_written(values) for values in columns.values()), strict=True)
    text = "\n".join([",".join(columns), *map(",".join, rows)])
    return {"values": text, "format": {"type": "csv", "parse": dict.fromkeys(columns, "number")}}


def _written(values: Floats) -> list[str]:
    return [f"{v:.6g}" if np.isfinite(v) else "" for v in np.asarray(values, float).tolist()]


def _view(panel: Panel, names: dict[str, str], x: Abscissa, last: bool) -> Spec:
    """Return the view of a panel. names: of the curves, by column."""
    scale = {"nice": False, "zero": False}
    across: Spec = {"field": "x", "type": "quantitative", "title": x.heading if last else None,
              "scale": {"type": "log", **scale} if x.logarithmic else scale}  # fmt: skip
    if not last:
        across["axis"] = {"labels": False, "title": None}
    lines = [_line(column, names, panel.scale) for column in names]
    lines[0]["params"] = [ZOOM_PARAMETER]
    zero = [level(0.0, style="zero")] if panel.zero else []
    return {
        "title": panel.heading,
        "height": panel.height,
        "encoding": {"x": across},
        "layer": [*panel.under, *zero, *lines, _pointed(panel, names), *panel.over],
    }


def _line(column: str, names: dict[str, str], scale: Spec) -> Spec:
    """Return one curve; curves with names have a key."""
    domain = {"domain": list(names.values())}
    colour: Spec = {"datum": names[column], "scale": domain}
    more: Spec = {"strokeDash": {**colour, "scale": {**domain, "range": dashes(len(names))}}}
    if not any(names.values()):
        colour, more = {**colour, "legend": None}, {}
    return {
        "mark": {"type": "line", "clip": True},
        "encoding": {
            "y": {"field": column, "type": "quantitative", "title": None, "scale": scale},
            "color": colour,
            **more,
        },
    }


def _pointed(panel: Panel, names: dict[str, str]) -> Spec:
    """Return a rule at each instant, visible only under the pointer, with the values there."""
    values = [
        {"field": column, "title": name or panel.heading, "format": NUMBER_FORMAT}
        for column, name in names.items()
    ]
    seen: Spec = {"condition": {"param": "pointed", "empty": False, "value": 0.4}, "value": 0.0}
    return {
        "params": [POINTER_PARAMETER],
        "mark": {"type": "rule", "style": "pointed", "clip": True},
        "encoding": {
            "opacity": seen,
            "tooltip": [{"field": "x", "title": "at", "format": NUMBER_FORMAT}, *values],
            "y": {"value": 0},
            "y2": {"value": panel.height},
        },
    }


def _merged(panels: Sequence[dict[str, Floats]]) -> list[dict[str, Floats]]:
    """Return the panels' curves; those that coincide in all panels share one name.

    Curves without any value are left out, unless no curve has any.
    """
    names = list(panels[0])
    close = [_tolerance(panel) for panel in panels]
    few = [np.array([_few(panel[name]) for name in names]) for panel in panels]
    groups: list[list[int]] = []
    for k, name in enumerate(names):
        if not any(np.isfinite(panel[name]).any() for panel in panels):
            continue
        first = [group[0] for group in groups]
        alike = np.ones(len(groups), dtype=bool)
        for values, tolerance in zip(few, close, strict=True):
            alike &= _coincide(values[first], values[k], tolerance)
        same = (
            groups[g] for g in np.flatnonzero(alike)
            if all(_coincide(panel[names[first[g]]], panel[name], tolerance)
                   for panel, tolerance in zip(panels, close, strict=True))
        )  # fmt: skip
        if (group := next(same, None)) is not None:
            group.append(k)
        else:
            groups.append([k])
    groups = groups or [[0]]
    together = {", ".join(names[k] for k in g): names[g[0]] for g in groups}
    key = labels(together, 48)
    return [{key[head]: panel[name] for head, name in together.items()} for panel in panels]


def _needed(x: Abscissa, panels: Sequence[Panel], merged: list[dict[str, Floats]]) -> Mask:
    """Return which of the points (N,) are drawn.

    Of more than MAX_CURVE_POINTS, only the points between which the curves are straight are drawn,
    and some for the pointer.
    merged: the curves of the panels.
    """
    if len(x.values) <= MAX_CURVE_POINTS:
        return np.ones(len(x.values), dtype=bool)
    axes = [(x.values[:, None], x.logarithmic)]
    for panel, shown in zip(panels, merged, strict=True):
        axes.append((np.column_stack([*shown.values()]), panel.scale.get("type") == "log"))
    parts = [np.log10(values) if logarithmic else values for values, logarithmic in axes]
    # A curve ends where values are missing; the last point before and the first after it are kept.
    finite = np.column_stack([np.isfinite(part) for part in parts])
    ends = np.any(finite[1:] != finite[:-1], axis=1)
    fixed = np.append(ends, False) | np.append(False, ends)
    fixed[:: len(fixed) // POINTER_POINTS] = True
    shares = [np.nan_to_num(part / _height(part), posinf=0.0, neginf=0.0) for part in parts]
    values = np.column_stack(shares)
    allowed = np.full(values.shape, CURVE_POINT_TOLERANCE)
    return needed(np.arange(len(values), dtype=float), values, allowed, fixed)


def _height(values: Floats) -> float:
    """Return the extent of a panel's curves; 1 if it is zero."""
    known = values[np.isfinite(values)]
    return float(np.ptp(known)) if len(known) and np.ptp(known) > 0.0 else 1.0


def _tolerance(panel: dict[str, Floats]) -> float:
    """Return the difference up to which curves of a panel coincide."""
    known = (np.abs(v[np.isfinite(v)]).max(initial=0.0) for v in panel.values())
    return CURVE_TOLERANCE * float(max(known))


def _few(values: Floats) -> Floats:
    """Return a few values of a curve; most curves differ in these already."""
    return values[:: max(1, len(values) // FEW_VALUES)]


def _coincide(some: Floats, other: Floats, tolerance: float) -> NDArray[np.bool_]:
    """Return whether curves (..., N) coincide with another curve (N,)."""
    close = np.isclose(some, other, rtol=0.0, atol=tolerance, equal_nan=True)
    return np.asarray(close.all(axis=-1))


def clipped(name: str, most: int = 24) -> str:
    """Return a name short enough for a label."""
    return name if len(name) <= most else name[: most - 1] + "…"


def labels(names: Iterable[str], most: int = 24) -> dict[str, str]:
    """Return the label of each name, shortened unless two labels would then be the same."""
    texts = {name: clipped(name, most) for name in names}
    counts = Counter(texts.values())
    return {name: text if counts[text] == 1 else name for name, text in texts.items()}


def still(spec: Spec) -> Spec:
    """Return the specification without the parts that only a pointer needs."""
    if "params" in spec:
        spec = {key: value for key, value in spec.items() if key != "params"}
    parts: Spec = {
        key: [still(part) for part in spec[key] if POINTER_PARAMETER not in part.get("params", [])]
        for key in ("layer", "vconcat")
        if key in spec
    }
    return {**spec, **parts}


# The functions below make layers with data of their own.


def rows(values: Sequence[Spec]) -> Spec:
    """Return data for Vega-Lite given row by row."""
    return {"values": [{k: _rounded(v) for k, v in row.items()} for row in values]}


def _rounded(value: object) -> object:
    return float(f"{value:.6g}") if isinstance(value, float) else value


def level(y: float, text: str = "", style: str = "level", right: bool = False) -> Spec:
    """Return a horizontal line, with a text at its left end, or its right one."""
    rule: Spec = {"mark": {"type": "rule", "style": style}, "encoding": {"x": None}}
    noted: Spec = {
        "mark": {"type": "text", "style": "quiet-note", "align": "right" if right else "left",
                 "dx": -3 if right else 3, "dy": -6, "text": text},
        "encoding": {"x": {"value": "width" if right else 0}},
    }  # fmt: skip
    return {
        "data": rows([{}]),
        "encoding": {"y": {"datum": y, "type": "quantitative"}},
        "layer": [rule, noted] if text else [rule],
    }


def instant(x: float, text: str = "", left: bool = False) -> Spec:
    """Return a vertical line, with a text at its top, optionally to the left."""
    rule: Spec = {"mark": {"type": "rule", "style": "governs", "clip": True}}
    noted: Spec = {
        "mark": {"type": "text", "style": "note", "align": "right" if left else "left",
                 "baseline": "top", "dx": -4 if left else 4, "text": text, "clip": True},
        "encoding": {"y": {"value": 3}},
    }  # fmt: skip
    return {
        "data": rows([{"x": x}]),
        "layer": [rule, noted] if text else [rule],
    }


def bands(extents: Sequence[tuple[float, float]], style: str = "shade") -> Spec:
    """Return shaded intervals of the abscissa."""
    return {
        "data": rows([{"x": low, "x2": high} for low, high in extents]),
        "mark": {"type": "rect", "style": style, "clip": True},
        "encoding": {"x": {"field": "x", "type": "quantitative"}, "x2": {"field": "x2"}},
    }


def points(values: Sequence[Spec], style: str = "hot", shape: str = "circle") -> Spec:
    """Return marks at rows with x, y and optionally a text, which the pointer shows."""
    mark = {"type": "point", "style": style, "shape": shape, "size": 36, "filled": True,
            "opacity": 1, "clip": True}  # fmt: skip
    if style == "published":
        mark |= {"size": 60}
    encoding: Spec = {
        "x": {"field": "x", "type": "quantitative"}, "y": {"field": "y", "type": "quantitative"},
    }  # fmt: skip
    if any("text" in row for row in values):
        encoding["tooltip"] = {"field": "text", "type": "nominal"}
    return {"data": rows(values), "mark": mark, "encoding": encoding}

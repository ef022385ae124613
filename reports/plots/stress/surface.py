"""Plots of the von Mises stress along a pin, as the maximum over the circumference."""

from __future__ import annotations

import numpy as np

from pinbase.dimensions import Floats
from reports.data.results import PinShape
from reports.data.row import PinResult, Units
from reports.data.surface import Mask, Surface, SurfaceCase
from reports.format.file_names import plot_name
from reports.format.numbers import engineering
from reports.format.ranges import error_range
from reports.plots.spec import (
    NUMBER_FORMAT,
    ZOOM_PARAMETER,
    Plot,
    Spec,
    bands,
    clipped,
    headed,
    level,
    points,
    rows,
    table,
)

FILL_STYLES = {"band": "band", "held": "governs"}


def surface_plot(
    surface: Surface, case: SurfaceCase, pin: PinResult, shape: PinShape | None, units: Units
) -> Plot:
    """Return the stress of a revolved pin in one case, on the outer surface and in the bore, along
    z.

    The stress is that at the governing instant, without the excluded zones.
    shape: for the strip with the bands; None leaves the strip out.
    """
    z = surface.points[:, 2]
    lugs = unread_points(case)
    read = np.where(case.excluded | lugs, np.nan, case.largest)
    name = f"Pin {clipped(pin.pin)}, {clipped(pin.case)}"
    across = {"field": "x", "type": "quantitative", "title": f"z [{units.length}]", "sort": None,
              "scale": {"domain": [float(z.min()), float(z.max())], "nice": False}}  # fmt: skip
    sides = outline_sides(z)
    spec = {
        "title": headed(f"{name}: maximum over the circumference"),
        "usermeta": {"columns": [f"z [{units.length}]", f"von Mises [{units.stress}]"]},
        "data": table({"x": z, "y": read}),
        "vconcat": [
            {"title": f"von Mises [{units.stress}]", "height": 190, "encoding": {"x": across},
             "layer": [bands(_spans(z, case.excluded | lugs)), level(0.0, style="zero"),
                       *(_side(*side, list(sides), z, read) for side in sides.items()),
                       *_mark(pin, units)]},
            *_strip(shape, across),
        ],
    }  # fmt: skip
    what = ["excluded zones"] * bool(case.excluded.any())
    what += ["nothing is read: lugs press, or their edges are near"] * bool(lugs.any())
    note = f"; shaded: {'; '.join(what)}" if what else ""
    section = pin.places is not None and pin.places.governs == "section"
    when = ", at the governing instant" if pin.time is not None else ""
    dot = "a dot above the curve marks a maximum inside the pin or on the boundary of "
    dot += "an excluded zone"
    if case.unread is not None:
        dot = f"the dot is the {'section that governs' if section else 'maximum'}"
    free = " outside what lugs press on" if case.unread is not None else ""
    caption = (
        f"Pin {pin.pin}, {pin.case}: von Mises stress along the pin, maximum over the "
        f"circumference{free}{when}; {dot}{note}"
    )
    return Plot(plot_name("surface", pin.case, pin.pin), caption, spec)


def _side(name: str, part: slice, names: list[str], z: Floats, read: Floats) -> Spec:
    """Return the curve of one side, in the order of the meridian."""
    heading = {"x": "z", "y": f"von Mises, {name}"}
    key: Spec = {"datum": name, "scale": {"domain": names}}
    return {
        **({"params": [ZOOM_PARAMETER]} if name == names[0] else {}),
        "data": table({"x": z[part], "y": read[part]}),
        "mark": {"type": "line", "clip": True, "point": {"size": 8, "opacity": 0.01}},
        "encoding": {
            "y": {"field": "y", "type": "quantitative", "title": None, "scale": {"zero": True}},
            "color": key if len(names) > 1 else {**key, "legend": None},
            "tooltip": [{"field": k, "type": "quantitative", "title": text, "format": NUMBER_FORMAT}
                        for k, text in heading.items()],
        },
    }  # fmt: skip


def outline_sides(z: Floats) -> dict[str, slice]:
    """Return the slices of the outer surface and the bore, with shoulders, without end faces.

    The meridian runs up the outer surface, then down the bore.
    """
    little = 1e-9 * float(np.ptp(z))
    start = int(np.flatnonzero(z > z.min() + little)[0]) - 1
    end = np.flatnonzero(z >= z.max() - little)
    sides = {"outer surface": slice(max(start, 0), int(end[0]) + 1)}
    if (z[end[-1] :] < z.max() - little).any():
        sides["bore"] = slice(int(end[-1]), len(z))
    return sides


def unread_points(case: SurfaceCase) -> Mask:
    """Return the points (P,) whose stress is nowhere read, since lugs press on them or next to
    them.
    """
    if case.unread is None:
        return np.zeros(len(case.largest), dtype=bool)
    return np.asarray(case.largest <= 0.0)


def _spans(z: Floats, excluded: Mask) -> list[tuple[float, float]]:
    edges = np.flatnonzero(np.diff(excluded.astype(int), prepend=0, append=0)).reshape(-1, 2)
    return [(float(z[a:b].min()), float(z[a:b].max())) for a, b in edges.tolist()]


def _mark(pin: PinResult, units: Units) -> list[Spec]:
    """Return the maximum with its error, or with its interval for a singular row."""
    if pin.location is None or pin.max_von_mises is None:
        return []
    value, error, within = pin.max_von_mises, 0.0, ""
    interval = pin.max_von_mises_interval
    if pin.maximum.bounded:
        error = pin.error_estimate or 0.0
        within = f" ({error_range(pin)})" if interval else f" ± {error_range(pin)}"
    low, high = interval or (value - error, value + error)
    text = f"max {engineering(value)}{within} {units.stress}"
    at = {"x": pin.location[2], "y": value, "low": low, "high": high, "text": text}
    x, y = ({"field": k, "type": "quantitative"} for k in ("x", "y"))
    error_bar = {
        "data": rows([at]),
        "mark": {"type": "rule", "style": "hot", "clip": True},
        "encoding": {"x": x, "y": {**y, "field": "low"}, "y2": {"field": "high"}},
    }
    noted = {
        "data": rows([at]),
        "mark": {"type": "text", "style": "hot-note", "align": "right", "baseline": "bottom",
                 "text": text, "x": "width", "y": -4, "clip": False},
        "encoding": {"x": None},
    }  # fmt: skip
    return [error_bar, points([at]), noted]


def _strip(shape: PinShape | None, across: Spec) -> list[Spec]:
    """Return the strip below the curves: bearing bands, and clamped segments as frames."""
    if shape is None:
        return []
    at, shown = 0.0, []
    for length, _, _, label, kind in shape.segments:
        if kind in FILL_STYLES:
            shown.append({"x": at, "x2": at + length, "middle": at + 0.5 * length, "kind": kind,
                          "label": clipped(label, 12)})  # fmt: skip
        at += length
    x: Spec = {"x": {**across, "title": None, "axis": None}}
    parts: list[Spec] = [
        {"transform": [{"filter": f"datum.kind === '{kind}'"}],
         "mark": {"type": "rect", "style": style, "clip": True, "filled": kind == "band"},
         "encoding": {**x, "x2": {"field": "x2"}}}
        for kind, style in FILL_STYLES.items()
    ]  # fmt: skip
    middle: Spec = {"x": {**x["x"], "field": "middle"}}
    named: Spec = {"text": {"field": "label", "type": "nominal"}}
    parts.append({"mark": {"type": "text", "style": "note", "clip": True},
                  "encoding": {**middle, **named}})  # fmt: skip
    return [{"data": rows(shown), "height": 16, "layer": parts}]

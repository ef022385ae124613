"""Plots of the load from the lugs on a pin: load per length, and the bending moment below it."""

from __future__ import annotations

import numpy as np

from fea.support.records import BandContact, JointResult
from reports.data.row import Units
from reports.format.file_names import plot_name
from reports.format.numbers import engineering
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
)

LABEL_HEADROOM_FACTOR = 1.18  # upper end over the largest value, with room for names


def joint_plot(pin: str, case: str, joint: JointResult, units: Units) -> Plot:
    """Return the plot of one pin in one case at the governing instant, with shaded lugs."""
    force = f"load per length [{units.force}/{units.length}]"
    z = [z for z, _ in joint.bending_moments]
    title = f"Pin {clipped(pin)}, {clipped(case)}: load from the lugs"
    caption = (
        f"Pin {pin}, {case}: load per length from the lugs (shaded), in the direction of each "
        "link's force (negative: the opposite side of the bore carries), and size of the bending "
        "moment"
    )
    across = {"field": "x", "type": "quantitative", "title": f"z [{units.length}]",
              "scale": {"domain": [min(z), max(z)], "nice": False}}  # fmt: skip
    hidden = {**across, "title": None, "axis": {"labels": False}}
    lugs = [bands([_extent(band) for band in joint.bands]), level(0.0, style="zero")]
    top = LABEL_HEADROOM_FACTOR * max(q for band in joint.bands for _, q in band.line_load)
    loads = [_load(band, force, top) for band in joint.bands]
    loads[0]["params"] = [ZOOM_PARAMETER]
    spec = {
        "title": headed(title),
        "usermeta": {"columns": [f"z [{units.length}]", _moment_heading(units)]},
        "data": rows([{"x": x, "y": y} for x, y in joint.bending_moments]),
        "vconcat": [
            {"title": force, "height": 150, "encoding": {"x": hidden},
             "layer": [*lugs, *loads, *(_name(band) for band in joint.bands)]},
            {"title": _moment_heading(units), "height": 110, "encoding": {"x": across},
             "layer": [*lugs, *_moment(joint, units)]},
        ],
    }  # fmt: skip
    return Plot(plot_name("joint", case, pin), caption, spec)


def _moment_heading(units: Units) -> str:
    return f"bending moment [{units.force}·{units.length}]"


def _load(band: BandContact, heading: str, top: float) -> Spec:
    """Return the load per length of a band: constant along each ring, or without rings a curve."""
    load = [q for _, q in band.line_load]
    pairs = zip(band.ends, [*load, load[-1]], strict=True) if band.ends else band.line_load
    return {
        "data": rows([{"x": z, "y": q} for z, q in pairs]),
        "mark": {"type": "area", "line": True, "fillOpacity": 0.15, "clip": True,
                 "interpolate": "step-after" if band.ends else "linear"},
        "encoding": {"y": _y(top), "tooltip": _tooltip(heading)},
    }  # fmt: skip


def _y(top: float = 0.0) -> Spec:
    """Return the ordinate. top: upper end of the scale, if positive."""
    scale = {"scale": {"domainMax": top}} if top > 0.0 else {}
    return {"field": "y", "type": "quantitative", "title": None, **scale}


def _tooltip(heading: str) -> list[Spec]:
    return [{"field": "x", "title": "z", "format": NUMBER_FORMAT, "type": "quantitative"},
            {**_y(), "title": heading, "format": NUMBER_FORMAT}]  # fmt: skip


def _extent(band: BandContact) -> tuple[float, float]:
    z = band.ends or tuple(z for z, _ in band.line_load)
    return z[0], z[-1]


def _name(band: BandContact) -> Spec:
    """Return the name of a lug, above its load."""
    return {
        "data": rows([{"x": float(np.mean(_extent(band)))}]),
        "mark": {"type": "text", "style": "note", "baseline": "top",
                 "text": clipped(band.name, 12)},
        "encoding": {"x": {"field": "x", "type": "quantitative"}, "y": {"value": 3}},
    }  # fmt: skip


def _moment(joint: JointResult, units: Units) -> list[Spec]:
    z, moment = (np.array(x) for x in zip(*joint.bending_moments, strict=True))
    largest = int(moment.argmax())
    at = {"x": float(z[largest]), "y": float(moment[largest]),
          "text": f"largest {engineering(joint.bending_moment)}"}  # fmt: skip
    left, top = z[largest] < np.mean(z), LABEL_HEADROOM_FACTOR * float(moment[largest])
    noted = {
        "data": rows([at]),
        "mark": {"type": "text", "style": "hot-note", "align": "left" if left else "right",
                 "dx": 8 if left else -8, "dy": -4},
        "encoding": {"x": {"field": "x", "type": "quantitative"}, "y": _y(),
                     "text": {"field": "text", "type": "nominal"}},
    }  # fmt: skip
    line = {
        "params": [ZOOM_PARAMETER],
        "mark": {"type": "line", "clip": True, "point": {"size": 12}},
        "encoding": {"y": _y(top), "tooltip": _tooltip(_moment_heading(units))},
    }
    return [line, points([at]), noted]

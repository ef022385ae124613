"""Plots of the maximum stress on each mesh, as its deviation from that on the finest."""

from __future__ import annotations

from collections.abc import Sequence

from reports.data.results import PinResult, Units
from reports.format.file_names import plot_name
from reports.plots.spec import FORMAT, Plot, Spec, clipped, headed, level, rows

HEADING = "deviation [%]"


def refinement_plot(case: str, pins: Sequence[PinResult], units: Units) -> Plot:
    """Every pin's maximum on its meshes in one case."""
    return _plot(plot_name("refinement", case), case, pins, [pin.pin for pin in pins], units)


def pin_refinement_plot(pin: str, cases: Sequence[PinResult], units: Units) -> Plot:
    """One pin's maximum on its meshes in every case."""
    name, labels = plot_name("refinement-pin", pin), [clipped(case.case) for case in cases]
    return _plot(name, f"Pin {pin}", cases, labels, units)


def _plot(
    name: str, title: str, pins: Sequence[PinResult], labels: Sequence[str], units: Units
) -> Plot:
    steps = [
        {"x": step.dofs, "y": 100.0 * (step.max_von_mises / pin.history[-1].max_von_mises - 1.0),
         "value": step.max_von_mises, "row": _text(label, pin)}
        for label, pin in zip(labels, pins, strict=True) for step in pin.history
    ]  # fmt: skip
    names = list(dict.fromkeys(_text(*both) for both in zip(labels, pins, strict=True)))
    title = f"{title}: mesh refinement of the maximum von Mises stress"
    return Plot(name, f"{title}, as its deviation from that on the finest mesh", {
        "title": headed(title),
        "usermeta": {"columns": ["unknowns", HEADING, f"maximum [{units.stress}]", "row"]},
        "data": rows(steps),
        "height": 170,
        "layer": [level(0.0, style="zero"), _lines(names, units)],
    })  # fmt: skip


def _lines(names: list[str], units: Units) -> Spec:
    key = {"field": "row", "type": "nominal", "sort": None, "title": None}
    ticks = {"tickCount": 6, "format": "~s"}
    return {
        "mark": {"type": "line", "point": {"size": 40, "filled": True}},
        "encoding": {
            "x": {"field": "x", "type": "quantitative", "title": "unknowns, logarithmic",
                  "scale": {"type": "log", "nice": False}, "axis": ticks},
            "y": {"field": "y", "type": "quantitative", "title": HEADING},
            "color": key | {"scale": {"domain": names}},
            "tooltip": [
                {"field": "row", "type": "nominal", "title": "row"},
                {"field": "x", "type": "quantitative", "title": "unknowns", "format": ","},
                {"field": "value", "type": "quantitative", "title": f"maximum [{units.stress}]",
                 "format": FORMAT},
                {"field": "y", "type": "quantitative", "title": HEADING, "format": ".3~f"},
            ],
        },
    }  # fmt: skip


def _text(label: str, pin: PinResult) -> str:
    return label if pin.verdict == "converged" else f"{label}, {pin.verdict}"

"""Plots of fatigue: the stress at a pin's worst point, and the cumulative spectrum of its
amplitudes.
"""

from __future__ import annotations

import numpy as np

from assess.fatigue.records import CaseHistory, PointFatigue, PointHistory
from pinbase.dimensions import Floats
from reports.data.row import Units
from reports.format.file_names import plot_name
from reports.plots.spec import NUMBER_FORMAT, Abscissa, Panel, Plot, clipped, curves, headed, rows


def history_plot(history: PointHistory, units: Units) -> Plot:
    """Return signed and unsigned von Mises stress at a point over the instants.

    The cases follow each other with zero load between them.
    """
    signed, plain = (_course([getattr(c, name) for c in history.cases]) for name in STRESS_COLUMNS)
    title = f"Pin {clipped(history.pin)}, point {history.point}: stress over the cases"
    panel = Panel(f"stress [{units.stress}]", {"signed": signed, "von Mises": plain}, height=170.0)
    x = Abscissa("instant, case after case", np.arange(len(signed), dtype=np.float64))
    cases = ", ".join(_named(c) for c in history.cases)
    caption = f"{title}: {cases}; every case begins and ends at zero load"
    return Plot(plot_name("stress-history", history.pin), caption, curves(title, x, [panel]))


STRESS_COLUMNS = ("signed", "von_mises")


def _named(case: CaseHistory) -> str:
    count = len(case.signed)
    return f"{case.case} ({count} instant{'s' * (count > 1)})"


def _course(cases: list[Floats]) -> Floats:
    zero = np.zeros(1)
    return np.concatenate([zero, *(np.concatenate([case, zero]) for case in cases)])


def collective_plot(point: PointFatigue, unit: str, units: Units) -> Plot:
    """Return the number of cycles per unit in which amplitudes at a point are reached, cumulated
    from the largest amplitude.
    """
    reached = np.cumsum(point.counts)
    steps = [{"x": float(n), "y": float(a)} for a, n in zip(point.amplitudes, reached, strict=True)]
    title = f"Pin {clipped(point.pin)}, point {point.point}: cumulative spectrum per {unit}"
    heads = [f"cycles per {unit}", f"amplitude [{units.stress}]"]
    caption = f"{title}; amplitudes corrected for mean stress, where the method does"
    return Plot(plot_name("spectrum", point.pin), caption, {
        "title": headed(title),
        "usermeta": {"columns": heads},
        "data": rows(steps),
        "height": 170,
        "mark": {"type": "line", "interpolate": "step-before",
                 "point": {"size": 40, "filled": True}},
        "encoding": {
            "x": {"field": "x", "type": "quantitative", "title": f"{heads[0]}, logarithmic",
                  "scale": {"type": "log", "nice": False}},
            "y": {"field": "y", "type": "quantitative", "title": heads[1]},
            "tooltip": [
                {"field": "x", "type": "quantitative", "title": heads[0], "format": NUMBER_FORMAT},
                {"field": "y", "type": "quantitative", "title": heads[1], "format": NUMBER_FORMAT},
            ],
        },
    })  # fmt: skip

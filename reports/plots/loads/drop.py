"""Plots of a drop: forces, motion and energies over time; force over stroke."""

from __future__ import annotations

import numpy as np

from reports.data.results import DropRecord, Units
from reports.format.file_names import plot_name
from reports.plots.spec import Abscissa, Panel, Plot, curves

ENERGY_NAMES = {
    "kinetic": "kinetic",
    "spring": "strut's spring",
    "tyre": "tyre",
    "oil": "oil",
    "friction": "friction",
    "stop": "extension stop",
    "slip": "sliding tyre",
}


def drop_plots(d: DropRecord, units: Units) -> list[Plot]:
    """Return the plots over time, and over stroke if there is a strut."""
    forces = {"vertical": d.vertical, "along the strut": d.strut, "drag on the leg": d.leg_drag}
    lengths = {"stroke": d.stroke, "tyre": d.deflection}
    energies = {
        words: d.energies[key] for key, words in ENERGY_NAMES.items() if d.energies[key].any()
    }
    panels = [
        Panel(f"force [{units.force}]", {k: v for k, v in forces.items() if v.any()}, height=190.0),
        Panel(f"stroke, deflection [{units.length}]", lengths),
        Panel(f"sink velocity [{units.length}/{units.time}]", {"": d.sink_velocity}),
        Panel(f"energy [{units.force}·{units.length}]", energies, height=150.0),
    ]
    title = f"{d.case}: forces, motion and energies of the drop"
    time = Abscissa(f"time [{units.time}]", d.time)
    plots = [Plot(plot_name("drop", d.case), title, curves(title, time, panels))]
    if np.isfinite(d.closing).any():
        title = f"{d.case}: vertical force over stroke"
        over = {"closing": d.closing, "opening": d.opening}
        panel = Panel(f"vertical force [{units.force}]", over, height=190.0)
        stroke = Abscissa(f"stroke [{units.length}]", d.strokes)
        plots.append(Plot(plot_name("drop-stroke", d.case), title, curves(title, stroke, [panel])))
    return plots

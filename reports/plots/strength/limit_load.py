"""Plots of the load factor against the displacement of a yielding pin."""

from __future__ import annotations

import numpy as np

from reports.data.row import PinResult, Units
from reports.format.file_names import plot_name
from reports.plots.spec import Abscissa, Panel, Plot, curves, level


def limit_plot(pin: PinResult, units: Units) -> Plot | None:
    """Return the load factor against displacement; None where no solid model was loaded
    past yield.
    """
    limit = pin.limit_load
    if limit is None or limit.curve is None or limit.upper is None:
        return None
    title = f"pin {pin.pin}, {pin.case}: load factor against the largest displacement"
    curve, levels = limit.curve, [level(1.0, "loads of the case")]
    x = np.unique(np.concatenate([curve.displacement, curve.permanent]))
    loaded = np.interp(x, curve.displacement, curve.factor)
    left = np.interp(x, np.maximum.accumulate(curve.permanent), curve.factor, right=np.nan)
    heading = "load factor"
    panel = Panel(heading, {"loaded": loaded, "left after unloading": left}, tuple(levels),
                  height=220.0)  # fmt: skip
    spec = curves(title, Abscissa(f"displacement [{units.length}]", x), [panel])
    return Plot(plot_name("limit-load", pin.pin, pin.case), title, spec)

"""Curves over time, labelled at their ends."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.data.results import Floats, Units
from reports.format.style import GREY, clipped, label_ends, line_style, plain_numbers


def curves(axes: Axes, time: Floats, shown: dict[str, Floats], zero: bool = True) -> None:
    """Curves, each labelled at its end; coinciding curves share a label."""
    span = max(
        (float(np.nanmax(np.abs(v))) for v in shown.values() if np.isfinite(v).any()), default=0.0
    )
    groups: list[tuple[int, list[str], Floats]] = []
    for order, (name, values) in enumerate(shown.items()):
        if not np.isfinite(values).any():
            continue
        for _, names, other in groups:
            if np.allclose(values, other, rtol=0.0, atol=1e-6 * span, equal_nan=True):
                names.append(clipped(name))
                break
        else:
            groups.append((order, [clipped(name)], values))
    for order, names, values in groups:
        text = ", ".join(names)
        label = text if len(text) < 24 else ",\n".join(names)
        axes.plot(time, values, label=label, gid="curve", **line_style(order))
    if zero:
        axes.axhline(0.0, color=GREY, linewidth=0.8, zorder=1.0)


def finish(figure: Figure, axes: list[Axes], units: Units, title: str) -> None:
    for panel in axes:
        panel.margins(x=0.0)
        plain_numbers(panel)
    axes[-1].set_xlabel(f"time [{units.time}]")
    figure.align_ylabels()
    figure.suptitle(title, x=0.01, ha="left")
    figure.draw_without_rendering()
    for panel in axes:
        lines = [line for line in panel.lines if line.get_gid() == "curve"]
        if lines:
            label_ends(figure, panel, lines, [str(line.get_label()) for line in lines], True)

"""Plots of the maximum stress against the number of unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, MaxNLocator, NullFormatter, NullLocator

from reports.data.results import PinResult, Units
from reports.format.file_names import plot_name
from reports.format.style import clipped, label_ends, line_style, panels, plain_numbers, save

MARKS = "os^Dv<>ph*"
CLOSE = np.log10(3.0)  # range of an axis that may have no two of 1, 2, 5


def refinement_plot(
    case: str, pins: Sequence[PinResult], units: Units, directory: Path
) -> list[Path]:
    """Every pin's maximum on its meshes in one case."""
    name = plot_name("refinement", case)
    return _plot(name, case, pins, [pin.pin for pin in pins], units, directory)


def pin_refinement_plot(
    pin: str, cases: Sequence[PinResult], units: Units, directory: Path
) -> list[Path]:
    """One pin's maximum on its meshes in every case."""
    name, labels = plot_name("refinement-pin", pin), [clipped(case.case) for case in cases]
    return _plot(name, f"pin {pin}", cases, labels, units, directory, 2.6)


def _plot(
    name: str,
    title: str,
    pins: Sequence[PinResult],
    labels: Sequence[str],
    units: Units,
    directory: Path,
    least: float = 3.6,
) -> list[Path]:
    """Both axes logarithmic; open markers: not converged. least: height in inches."""
    with panels(1, height=max(least, 0.2 * len(pins) + 1.0)) as (figure, (axes,)):
        lines = []
        for order, pin in enumerate(pins):
            style = line_style(order)
            face = style["color"] if pin.verdict == "converged" else "white"
            lines += axes.plot(
                [step.dofs for step in pin.history],
                [step.max_von_mises for step in pin.history],
                marker=MARKS[order % len(MARKS)],
                markersize=5,
                markerfacecolor=face,
                **style,
            )
        axes.set(xscale="log", yscale="log")
        _ticks(axes, pins)
        axes.set_xlabel("unknowns")
        axes.set_ylabel(f"max von Mises [{units.stress}]")
        axes.set_title(f"{title}: mesh refinement", pad=8)
        label_ends(figure, axes, lines, [_text(*both) for both in zip(labels, pins, strict=True)])
        return save(figure, directory, name)


def _text(label: str, pin: PinResult) -> str:
    return label if pin.verdict == "converged" else f"{label}, {pin.verdict}"


def _ticks(axes: Axes, pins: Sequence[PinResult]) -> None:
    """Ticks at 1, 2, 5 where the range is small, and at round numbers where it is smaller still:
    decades alone would leave an axis bare.
    """
    steps = [step for pin in pins for step in pin.history]
    for axis, values in (
        (axes.xaxis, [float(step.dofs) for step in steps]),
        (axes.yaxis, [step.max_von_mises for step in steps]),
    ):
        low, high = np.log10(min(values)), np.log10(max(values))
        if high - low < CLOSE:
            axis.set_major_locator(MaxNLocator(5))
            axis.set_minor_locator(NullLocator())
            continue
        decades = np.arange(np.floor(low), np.ceil(high) + 1)
        within = (1.0, 2.0, 5.0) if high - low < 3.0 else (1.0,)
        axis.set_major_locator(FixedLocator([m * 10.0**d for d in decades for m in within]))
        axis.set_minor_formatter(NullFormatter())
    plain_numbers(axes)

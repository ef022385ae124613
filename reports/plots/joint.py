"""Plots of how the lugs load a pin: load per length, with the bending moment under it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fea.joint.records import BandContact, JointResult
from reports.data.results import Units
from reports.format.file_names import plot_name
from reports.format.numbers import engineering
from reports.format.style import COLOURS, GREY, clipped, line_style, panels, plain_numbers, save

LUG = "#dbe7f4"
HEADROOM = 1.18  # above the largest value, for names and labels


def joint_plot(
    pin: str, case: str, joint: JointResult, units: Units, directory: Path
) -> list[Path]:
    """Of one pin in one case, at the governing instant; the lugs are shaded."""
    with panels(2, height=2.2, sharex=True) as (figure, axes):
        load, moment = axes
        for band in joint.bands:
            _load(load, band)
            for panel in axes:
                panel.axvspan(*_extent(band), color=LUG, zorder=0.1)
        _moment(moment, joint)
        _names(load, joint.bands)
        load.set_ylabel(f"load per length\n[{units.force}/{units.length}]")
        moment.set_ylabel(f"bending moment\n[{units.force} {units.length}]")
        moment.set_xlabel(f"z [{units.length}]")
        z = [z for z, _ in joint.bending_moments]
        moment.set_xlim(min(z), max(z))
        for panel in axes:
            panel.axhline(0.0, color=GREY, linewidth=0.8)
            plain_numbers(panel)
        figure.align_ylabels()
        load.set_title(f"pin {clipped(pin)}, {clipped(case)}: load from the lugs (shaded)")
        return save(figure, directory, plot_name("joint", case, pin))


def _load(axes: Axes, band: BandContact) -> None:
    """Even along each ring; where there are no rings, a curve."""
    style = line_style(0)
    load = [q for _, q in band.line_load]
    if band.ends:
        axes.stairs(load, band.ends, color=style["color"], linewidth=1.5)
        axes.stairs(load, band.ends, color=style["color"], fill=True, alpha=0.15)
    else:
        axes.plot([z for z, _ in band.line_load], load, **style)


def _extent(band: BandContact) -> tuple[float, float]:
    z = band.ends or tuple(z for z, _ in band.line_load)
    return z[0], z[-1]


def _names(axes: Axes, bands: tuple[BandContact, ...]) -> None:
    """Of the lugs, above their loads."""
    loads = [q for band in bands for _, q in band.line_load]
    low, high = min(0.0, *loads), max(loads)
    room = (HEADROOM - 1.0) * (high - low) or 1.0
    axes.set_ylim(low - (0.3 * room if low < 0.0 else 0.0), high + room)
    for band in bands:
        axes.annotate(
            clipped(band.name, 12), (float(np.mean(_extent(band))), 1.0),
            xycoords=("data", "axes fraction"), xytext=(0, -3), textcoords="offset points",
            ha="center", va="top", fontsize=8.5,
        )  # fmt: skip


def _moment(axes: Axes, joint: JointResult) -> None:
    z, moment = (np.array(x) for x in zip(*joint.bending_moments, strict=True))
    axes.plot(z, moment, **line_style(0))
    largest = int(moment.argmax())
    axes.set_ylim(0.0, HEADROOM * float(moment[largest]) or 1.0)
    left = z[largest] < np.mean(z)
    axes.plot(z[largest], moment[largest], "o", color=COLOURS[1], ms=5)
    axes.annotate(
        f"max {engineering(joint.bending_moment)}", (z[largest], moment[largest]),
        xytext=(8 if left else -8, 4), textcoords="offset points",
        ha="left" if left else "right", va="bottom", color=COLOURS[1], fontsize=8.5,
    )  # fmt: skip

"""Plots of the von Mises stress along a pin, maximum over the circumference."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from reports.data.results import Floats, PinResult, PinShape, Units
from reports.data.surface import Mask, Surface, SurfaceCase
from reports.format.file_names import plot_name
from reports.format.numbers import engineering
from reports.format.ranges import error_range
from reports.format.style import BAND, GREY, clipped, line_style, panels, plain_numbers, save

RED = "#a8211b"
STRIP = 0.07  # height of the strip that shows the bands, of the panel
HEADROOM = 1.25  # above the maximum, for its label


def surface_plot(
    surface: Surface,
    case: SurfaceCase,
    pin: PinResult,
    shape: PinShape | None,
    units: Units,
    directory: Path,
) -> list[Path]:
    """Of a pin with a meridian in one case: outer surface and bore along z, at the governing
    instant, without the excluded zones. shape: for the strip with the bands.
    """
    z = surface.points[:, 2]
    read = np.where(case.excluded, np.nan, case.largest)
    with panels(1, height=2.7) as (figure, (axes,)):
        for order, (name, rows) in enumerate(_sides(z).items()):
            axes.plot(z[rows], read[rows], label=name, **line_style(order))
        for low, high in _spans(z, case.excluded):
            axes.axvspan(low, high, color=BAND, zorder=0.1)
        if pin.location is not None and pin.max_von_mises is not None:
            _mark(axes, pin.location[2], pin.max_von_mises, pin)
        top = (pin.max_von_mises_interval or (0.0, pin.max_von_mises or 0.0))[1]
        largest = max(float(np.nanmax(read)), top)
        axes.set_ylim(-1.5 * STRIP * largest, HEADROOM * largest or 1.0)
        axes.set_xlim(float(z.min()), float(z.max()))
        if shape is not None:
            _bands(axes, shape, -1.5 * STRIP * largest, -0.3 * STRIP * largest)
        axes.axhline(0.0, color=GREY, linewidth=0.8)
        axes.set(xlabel=f"z [{units.length}]", ylabel=f"von Mises [{units.stress}]")
        note = "; grey: excluded" if case.excluded.any() else ""
        name = f"pin {clipped(pin.pin)}, {clipped(pin.case)}"
        axes.set_title(f"{name}: maximum over the circumference{note}")
        plain_numbers(axes)
        if len(axes.get_lines()) and len(_sides(z)) > 1:
            figure.legend(loc="outside lower left", ncols=2, handlelength=3.5)
        return save(figure, directory, plot_name("surface", pin.case, pin.pin))


def _sides(z: Floats) -> dict[str, slice]:
    """Points of the outer surface and of the bore, shoulders with them; the end faces are left out.

    The meridian runs up the outer surface, then down the bore.
    """
    little = 1e-9 * float(np.ptp(z))
    start = int(np.flatnonzero(z > z.min() + little)[0]) - 1
    end = np.flatnonzero(z >= z.max() - little)
    found = {"outer surface": slice(max(start, 0), int(end[0]) + 1)}
    if (z[end[-1] :] < z.max() - little).any():
        found["bore"] = slice(int(end[-1]), len(z))
    return found


def _spans(z: Floats, excluded: Mask) -> list[tuple[float, float]]:
    edges = np.flatnonzero(np.diff(excluded.astype(int), prepend=0, append=0)).reshape(-1, 2)
    return [(float(z[a:b].min()), float(z[a:b].max())) for a, b in edges.tolist()]


def _mark(axes: Axes, z: float, value: float, pin: PinResult) -> None:
    """The maximum with its error, or the interval of a singular row."""
    error, interval = pin.error_estimate or 0.0, pin.max_von_mises_interval
    low, high = interval or (value - error, value + error)
    error_text = f"({error_range(pin)})" if interval else f"± {error_range(pin)}"
    axes.errorbar(
        [z], [value], [[value - low], [high - value]], fmt="o", color=RED, ms=5, capsize=3
    )
    left = z < np.mean(axes.get_xlim())
    axes.annotate(
        f"max {engineering(value)} {error_text}",
        (z, value),
        xytext=(8, 3) if left else (-8, 3),
        textcoords="offset points",
        ha="left" if left else "right",
        va="bottom",
        color=RED,
        fontsize=8.5,
    )  # fmt: skip


def _bands(axes: Axes, shape: PinShape, low: float, high: float) -> None:
    """A strip under the curves: bearing bands, and clamped segments (hatched)."""
    at = 0.0
    for length, _, _, label, kind in shape.segments:
        if kind in ("band", "held"):
            axes.fill_between(
                [at, at + length], low, high, facecolor="#9dbbe0" if kind == "band" else "white",
                edgecolor=GREY, hatch="////" if kind == "held" else None, linewidth=0.6,
            )  # fmt: skip
            text = clipped(label, 12)
            box = (
                {"facecolor": "white", "edgecolor": "none", "pad": 0.8} if kind == "held" else None
            )
            axes.text(
                at + 0.5 * length, 0.5 * (low + high), text, ha="center", va="center_baseline",
                fontsize=7.5, bbox=box if kind == "held" else None,
            )  # fmt: skip
        at += length

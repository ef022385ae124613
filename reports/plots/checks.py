"""Plots of the checks: a cantilever against beam theory, a joint against its closed form."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from reports.data.results import BeamCheck, MotionCheck, Units
from reports.format.file_names import plot_name
from reports.format.numbers import engineering, short
from reports.format.style import BAND, GREY, INK, line_style, panels, plain_numbers, save

WINDOW = (0.3, 0.8)  # of the loaded length, where beam and solid are compared
HEADROOM = 1.25  # over the beam's peak; higher values are cut off and labelled


def beam_plots(check: BeamCheck, units: Units, directory: Path) -> list[Path]:
    """Shear and moment diagrams, and the axial stress of beam and solid along the pin."""
    return _diagrams(check, units, directory) + _stress(check, units, directory)


def _diagrams(check: BeamCheck, units: Units, directory: Path) -> list[Path]:
    with panels(2, height=1.9, sharex=True) as (figure, axes):
        for panel, values, heading in (
            (axes[0], check.shear, f"shear [{units.force}]"),
            (axes[1], check.moment, f"moment [{units.force}·{units.length}]"),
        ):
            panel.plot(check.z, values, **line_style(0))
            panel.fill_between(check.z, values, color="#7d9cbf", alpha=0.35, linewidth=0.0)
            panel.axhline(0.0, color=GREY, linewidth=0.8)
            panel.set_ylabel(heading)
            _shade(panel, check)
        axes[1].set_xlabel(f"z from the root [{units.length}]")
        figure.align_ylabels()
        figure.suptitle(_title(check, units), x=0.01, ha="left")
        _legend(figure, axes[0])
        return save(figure, directory, plot_name("beam-diagrams"))


def _title(check: BeamCheck, units: Units) -> str:
    force = f"{engineering(check.force)} {units.force}"
    return f"Pin {check.pin}, {check.case}: cantilever under {force}"


def _shade(axes: Axes, check: BeamCheck) -> None:
    axes.axvspan(*check.band, color=BAND, zorder=0.1, label="loaded band")
    axes.margins(x=0.0)
    plain_numbers(axes)


def _legend(figure: object, axes: Axes) -> None:
    figure.legend(  # type: ignore[attr-defined]
        *axes.get_legend_handles_labels(), loc="outside lower left", ncols=2, handlelength=3.5
    )


def _stress(check: BeamCheck, units: Units, directory: Path) -> list[Path]:
    curves = (
        ("beam theory", check.beam_axial_stress),
        ("finite elements, load on the surface", check.fea_axial_stress),
        ("finite elements, load on the axis", check.fea_axial_stress_axis_load),
    )
    low, high = _limits(check)
    with panels(1, height=3.6) as (figure, (axes,)):
        for order, (name, values) in enumerate(curves):
            axes.plot(check.z, values, label=name, **line_style(order))
        loaded = float(check.z[-1])
        # An outline over the grey band: overlapping fills would be indistinguishable.
        axes.axvspan(
            WINDOW[0] * loaded,
            WINDOW[1] * loaded,
            facecolor="none",
            edgecolor=GREY,
            hatch="//",
            linewidth=0.0,
            zorder=0.2,
            alpha=0.6,
            label="compared range: 30 to 80 % of the loaded length",
        )
        axes.axhline(0.0, color=GREY, linewidth=0.8)
        axes.set(
            ylim=(low, high),
            xlabel=f"z from the root [{units.length}]",
            ylabel=f"axial stress, tension side [{units.stress}]",
        )
        axes.set_title(_title(check, units), pad=8)
        _shade(axes, check)
        _say_cut_off(axes, check, high, units)
        _legend(figure, axes)
        return save(figure, directory, plot_name("beam-stress"))


def _limits(check: BeamCheck) -> tuple[float, float]:
    solid = np.concatenate([check.fea_axial_stress, check.fea_axial_stress_axis_load])
    peak = float(np.max(check.beam_axial_stress))
    low = min(0.0, float(np.min(solid)), float(np.min(check.beam_axial_stress)))
    top = min(float(np.max(solid)), HEADROOM * peak)
    return max(low, -HEADROOM * peak) - 0.05 * peak, max(top, peak) + 0.05 * peak


def _say_cut_off(axes: Axes, check: BeamCheck, high: float, units: Units) -> None:
    solid = np.maximum(check.fea_axial_stress, check.fea_axial_stress_axis_load)
    worst = int(np.argmax(solid))
    if solid[worst] <= high:
        return
    axes.text(
        0.985,
        0.96,
        f"finite-element peak, {engineering(float(solid[worst]))} {units.stress} at "
        f"z = {short(float(check.z[worst]))} {units.length}, is cut off",
        transform=axes.transAxes,
        ha="right",
        va="top",
        fontsize=8.5,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 2.0},
    )


def motion_plot(check: MotionCheck, units: Units, directory: Path) -> list[Path]:
    """A joint's speed and acceleration with their closed form and published points."""
    speed = f"{units.length}/{units.time}"
    with panels(2, height=2.2, sharex=True) as (figure, axes):
        for panel, ours, exact, column, heading in (
            (axes[0], check.speed, check.closed_form_speed, 1, f"speed [{speed}]"),
            (
                axes[1],
                check.acceleration,
                check.closed_form_acceleration,
                2,
                f"acceleration [{speed}²]",
            ),
        ):
            panel.plot(check.time, ours, color="#9dbbe0", linewidth=4.0, label="linkage")
            panel.plot(check.time, exact, color=INK, linestyle=(0, (5, 3)), label="closed form")
            if check.published:
                panel.plot(
                    [row[0] for row in check.published],
                    [row[column] for row in check.published],
                    "D",
                    ms=6,
                    mfc="white",
                    mec="#c8501e",
                    mew=1.5,
                    label="published",
                )
            panel.set_ylabel(heading)
            panel.margins(x=0.02)
            plain_numbers(panel)
        axes[1].set_xlabel(f"time [{units.time}]")
        figure.align_ylabels()
        figure.suptitle(f"{check.case}: joint {check.joint}", x=0.01, ha="left")
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower left", ncols=3)
        return save(figure, directory, plot_name("motion-check"))

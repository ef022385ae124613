"""The speed-accuracy chart: error against time and against memory."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from reports.data.chart import NAME, Chart, ChartPoint
from reports.format.plot_labels import Label, place_texts
from reports.format.style import GREY, INK, clipped, line_style, panels, plain_numbers, save
from reports.text.chart_summary import curve_name, error, failures, percent, reference_line

MARKS = "Dos^v"
ROOM = 2.5  # factor beyond the outermost points
LINE = 128  # letters of a line of the foot


def chart_plot(chart: Chart, directory: Path) -> list[Path]:
    """Draw chart.svg and chart.png: two log-log panels with a common axis of errors."""
    across: tuple[tuple[str, Callable[[ChartPoint], float]], ...] = (
        ("time, meshing included [s]", lambda p: p.seconds or 0.0),
        ("peak memory above bare process [MB]", lambda p: p.memory or 0.0),
    )
    foot = _foot(chart)
    with panels(1, 2, height=3.5 + 0.14 * len(foot), sharey=True) as (figure, axes):
        for panel, (heading, value) in zip(axes, across, strict=True):
            _draw(figure, panel, chart, value)
            panel.set_xlabel(heading)
        _levels(axes[-1], chart)
        axes[0].set_ylabel("error of the maximum von Mises stress")
        figure.suptitle(
            f"pin {clipped(chart.pin)}, {clipped(chart.case, 40)}: error against cost",
            x=0.01, ha="left", fontsize=10.5,
        )  # fmt: skip
        figure.supxlabel("\n".join(foot), x=0.01, ha="left", fontsize=7.5, color=INK)
        for panel in axes:
            place_texts(figure, panel, _labels(chart, across[axes.index(panel)][1]))
        return save(figure, directory, NAME)


def _draw(figure: Figure, axes: Axes, chart: Chart, value: Callable[[ChartPoint], float]) -> None:
    floor = _floor(chart)
    errors = [max(error(p), floor / 3.0) for curve in chart.curves.values() for p in curve]
    costs = [value(p) for curve in chart.curves.values() for p in curve]
    axes.set(xscale="log", yscale="log")
    axes.set_xlim(min(costs) / ROOM, max(costs) * ROOM)
    axes.set_ylim(min(*errors, floor) / ROOM, max(*errors, chart.tolerance) * ROOM)
    axes.axhspan(axes.get_ylim()[0], floor, color="#eeeeee", linewidth=0.0)
    axes.axhline(chart.tolerance, color=GREY, linewidth=1.0)
    for order, curve in enumerate(chart.curves.values()):
        style = line_style(order)
        at = [value(p) for p in curve], [max(error(p), floor / 3.0) for p in curve]
        axes.plot(*at, marker=MARKS[order % len(MARKS)], markersize=4.5, **style)
    for p in (p for p in chart.points if p.chosen):
        axes.plot(
            value(p), max(error(p), floor / 3.0), marker="o", markersize=12,
            markerfacecolor="none", markeredgecolor=INK, linestyle="none",
        )  # fmt: skip
    axes.yaxis.set_major_formatter(FuncFormatter(lambda v, _: percent(v)))
    axes.yaxis.set_minor_formatter(NullFormatter())
    plain_numbers(axes, "x")
    axes.xaxis.set_minor_formatter(NullFormatter())


def _levels(axes: Axes, chart: Chart) -> None:
    """Labels of the two levels, right of the panel."""
    for level, text, side in (
        (chart.tolerance, f"tolerance\n{percent(chart.tolerance)}", "bottom"),
        (_floor(chart), "error of the\nreference", "top"),
    ):
        axes.annotate(
            text, (1.0, level), xycoords=("axes fraction", "data"), xytext=(4, 0),
            textcoords="offset points", va=side, fontsize=7.5, color="#666666",
        )  # fmt: skip


def _floor(chart: Chart) -> float:
    """The error of the reference, positive."""
    return max(chart.reference.error, 1e-9)


def _labels(chart: Chart, value: Callable[[ChartPoint], float]) -> list[Label]:
    floor = _floor(chart)

    def at(p: ChartPoint) -> tuple[float, float]:
        return value(p), max(error(p), floor / 3.0)

    labels = [Label("auto", *at(p), {"color": INK}) for p in chart.points if p.chosen]
    for order, ((model, element), curve) in enumerate(chart.curves.items()):
        middle = curve[len(curve) // 2]
        colour = line_style(order)["color"]
        labels.append(Label(curve_name(model, element), *at(middle), {"color": colour}))
    return labels


def _foot(chart: Chart) -> list[str]:
    """Lines under the panels: reference, grey range, failures."""
    of = f"median of {chart.runs} runs" if chart.runs > 1 else "one run"
    lines = [
        f"{reference_line(chart)} Grey: errors that cannot be "
        f"distinguished from zero. Times: {of}; bare process: {chart.bare:.0f} MB.",
        *([chart.note] if chart.note else []),
        *failures(chart),
    ]
    return [line for text in lines for line in textwrap.wrap(text.replace(" %", "\u00a0%"), LINE)]

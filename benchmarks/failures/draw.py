"""Elements of the pictures of the gallery that benchmarks.style lacks."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator

from benchmarks.style import GREY, INK, line_style
from fea.core.pin_loads import Floats
from reports.format.numbers import short

__all__ = ["GREY", "INK", "decades", "line_style", "note", "ratio_line", "ticks"]


def note(
    axes: Axes,
    x: float,
    y: float,
    text: str,
    shift: tuple[float, float] = (6.0, 0.0),
    color: str = INK,
    align: str = "left",
) -> None:
    """Write text next to a point. shift: in points."""
    axes.annotate(
        text, (x, y), xytext=shift, textcoords="offset points", color=color, fontsize=8.5,
        ha=align, va="center", linespacing=1.15,
    )  # fmt: skip


def ratio_line(axes: Axes, x: Floats, y: Floats, text: str) -> None:
    """Draw a line for comparison, with its name at its second point."""
    axes.plot(x, y, **line_style(1))
    note(axes, float(x[1]), float(y[1]), text, (8.0, -10.0), line_style(1)["color"])


def decades(*axes: Axes, which: str = "both") -> None:
    """Label the ticks of logarithmic axes with plain numbers; minor ticks have no labels."""
    for one in axes:
        for name, axis in (("x", one.xaxis), ("y", one.yaxis)):
            if which in (name, "both"):
                axis.set_major_formatter(FuncFormatter(lambda value, _: short(value)))
                axis.set_minor_formatter(NullFormatter())


def ticks(axes: Axes, x: Floats | None = None, y: tuple[float, ...] = ()) -> None:
    """Set the ticks of logarithmic axes at these values only."""
    for axis, values in ((axes.xaxis, x), (axes.yaxis, y)):
        if values is not None and len(values):
            axis.set_ticks(
                values, [f"{value:.2g}" if value < 10 else f"{value:g}" for value in values]
            )
            axis.set_minor_locator(NullLocator())

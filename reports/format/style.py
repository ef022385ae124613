"""The house style of the plots: readable in grey, the same bytes on every run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter

from reports.format.file_names import PNG, SVG
from reports.format.numbers import short
from reports.format.spread import spread

INK, GREY, BAND = "#222222", "#8a8a8a", "#e9e9e9"
WIDTH = 7.2  # inches
COLOURS = ("#0b3c6f", "#c8501e", "#1a8a6e", "#8f4a9c", "#7a6a00", "#4f9bd9", "#000000")
DASHES: tuple[Any, ...] = (
    "solid",
    (0, (6, 2)),
    (0, (1.2, 1.4)),
    (0, (6, 2, 1.2, 2)),
    (0, (3, 1.2)),
    (0, (6, 1.5, 1.2, 1.5, 1.2, 1.5)),
    (0, (10, 2)),
)
RC: Any = {
    "axes.axisbelow": True,
    "axes.edgecolor": GREY,
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.labelsize": 9.5,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "figure.constrained_layout.use": True,
    "figure.dpi": 100.0,
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
    # A name of the study may hold dollar signs, which are no mathematics.
    "text.parse_math": False,
    "figure.constrained_layout.h_pad": 0.06,
    "figure.constrained_layout.w_pad": 0.08,
    "svg.fonttype": "path",
    "svg.hashsalt": "pinstress",
    "text.color": INK,
    "xtick.color": INK,
    "xtick.labelsize": 8.5,
    "ytick.color": INK,
    "ytick.labelsize": 8.5,
}


@contextmanager
def panels(
    rows: int, columns: int = 1, height: float = 2.2, **options: Any
) -> Iterator[tuple[Figure, list[Axes]]]:
    """A figure in the house style with its axes, row by row."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(RC)
        # Figure without pyplot: no window, nothing to close.
        figure = Figure(figsize=(WIDTH, height * rows + 0.5))
        axes = figure.subplots(rows, columns, squeeze=False, **options)
        yield figure, list(axes.flat)


def line_style(index: int) -> dict[str, Any]:
    """Colour and dashes of the line of this number; no two of the first 49 are alike."""
    dash = (index + index // len(COLOURS)) % len(DASHES)
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[dash]}


def plain_numbers(axes: Axes, which: str = "both") -> None:
    """Tick labels as engineers write them."""
    formatter: Callable[[float, int | None], str] = lambda value, _: short(value)  # noqa: E731
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        if which in (name, "both"):
            axis.set_major_formatter(FuncFormatter(formatter))


def clipped(name: str, most: int = 24) -> str:
    """A name short enough for a label."""
    return name if len(name) <= most else name[: most - 1] + "…"


def label_ends(
    figure: Figure,
    axes: Axes,
    lines: Sequence[Line2D],
    texts: Sequence[str],
    settled: bool = False,
) -> None:
    """Write each line's text right of its end, spread so that none overlap.

    settled: the figure has been laid out since its curves were drawn, which takes time.
    """
    if not settled:
        figure.draw_without_rendering()
    height = axes.get_window_extent().height
    gap = 1.35 * 8.5 * figure.dpi / 72.0 / height
    ends = [_end(axes, line) for line in lines]
    rows = [(text.count("\n") + 1) * gap for text in texts]
    places = spread([y for _, y in ends], rows)
    for line, text, end, place in zip(lines, texts, ends, places, strict=True):
        axes.annotate(
            text,
            xy=end,
            xytext=(1.035, place),
            xycoords="axes fraction",
            textcoords="axes fraction",
            color=line.get_color(),
            fontsize=8.5,
            va="center",
            linespacing=1.15,
            arrowprops={
                "arrowstyle": "-",
                "color": line.get_color(),
                "linewidth": 0.7,
                # From the text's left edge: a leader from its middle crosses its neighbours.
                "relpos": (0.0, 0.5),
                "shrinkA": 1.0,
                "shrinkB": 0.0,
            },
        )


def _end(axes: Axes, line: Line2D) -> tuple[float, float]:
    """The line's rightmost point as fractions of the axes."""
    points = np.asarray(line.get_xydata())
    last = points[int(np.argmax(points[:, 0]))]
    x, y = axes.transAxes.inverted().transform(axes.transData.transform(last))
    return float(x), float(y)


def save(figure: Figure, directory: Path, name: str) -> list[Path]:
    """Write a figure as SVG and PNG, without a date; returns both paths."""
    svg, png = directory / (name + SVG), directory / (name + PNG)
    if (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)
        figure.set_layout_engine("none")  # once for both: it takes as long as drawing
    figure.savefig(svg, metadata={"Date": None})
    figure.savefig(png, dpi=150, metadata={"Software": None})
    return [svg, png]

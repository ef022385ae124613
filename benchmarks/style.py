"""The style of the plots in the documentation: legible in grey, and the same bytes on every run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from reports.format.file_names import PNG_SUFFIX, SVG_SUFFIX
from reports.format.numbers import short

INK, GREY = "#222222", "#8a8a8a"
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
    # A name of a study may contain dollar signs, which do not mark mathematics.
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
    """Yield a figure in the house style with its axes, row by row."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(RC)
        # A Figure without pyplot has no window and need not be closed.
        figure = Figure(figsize=(WIDTH, height * rows + 0.5))
        axes = figure.subplots(rows, columns, squeeze=False, **options)
        yield figure, list(axes.flat)


def line_style(index: int) -> dict[str, Any]:
    """Return colour and dashes of a line by its number; the first 49 all differ."""
    dash = (index + index // len(COLOURS)) % len(DASHES)
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[dash]}


def plain_numbers(axes: Axes, which: str = "both") -> None:
    """Format tick labels as engineers write numbers."""
    formatter: Callable[[float, int | None], str] = lambda value, _: short(value)  # noqa: E731
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        if which in (name, "both"):
            axis.set_major_formatter(FuncFormatter(formatter))


def save(figure: Figure, directory: Path, name: str) -> list[Path]:
    """Write a figure as SVG and PNG, without a date; return both paths."""
    svg, png = directory / (name + SVG_SUFFIX), directory / (name + PNG_SUFFIX)
    if (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)
        figure.set_layout_engine("none")  # laid out once for both files, since it is slow
    figure.savefig(svg, metadata={"Date": None})
    figure.savefig(png, dpi=150, metadata={"Software": None})
    return [svg, png]

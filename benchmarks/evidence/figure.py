"""The figure of docs/evidence.md and README.md: predicted over measured, a dot for each number."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmarks import ROOT
from benchmarks.evidence.comparison import KINDS, Comparison
from benchmarks.style import COLOURS, GREY, INK, panels, save

FOLDER, NAME = ROOT / "docs" / "images", "evidence"
LEAST_RATIO, MOST_RATIO = 0.45, 1.25
SPREAD, COLUMN = (
    0.28,
    0.008,
)  # height over which the dots of a row spread; width of axis in which dots are stacked


def draw(comparisons: Sequence[Comparison]) -> list[Path]:
    """Write the figure as SVG and PNG; return both paths."""
    with panels(1, height=3.1) as (figure, (axes,)):
        axes.axvline(1.0, color=INK, linewidth=0.9)
        for row, (kind, title) in enumerate(reversed(KINDS.items())):
            of_kind = [c for c in comparisons if c.kind == kind]
            heights = _spread([c.ratio for c in of_kind])
            for wrong in (False, True):
                chosen = [
                    (c.ratio, row + height)
                    for c, height in zip(of_kind, heights, strict=True)
                    if (c.printed.fault == "print") == wrong
                ]
                axes.plot(
                    [x for x, _ in chosen], [y for _, y in chosen], "o", ms=4.2,
                    color=COLOURS[len(KINDS) - 1 - row],
                    markerfacecolor="white" if wrong else COLOURS[len(KINDS) - 1 - row],
                    alpha=1.0 if wrong else 0.75, zorder=3,
                )  # fmt: skip
            axes.text(
                LEAST_RATIO + 0.005, row + 0.33, f"{title} ({len(of_kind)})", fontsize=8.5,
                color=INK,
            )  # fmt: skip
        axes.set(
            xlim=(LEAST_RATIO, MOST_RATIO), ylim=(-0.6, len(KINDS) - 0.4),
            xlabel="predicted over measured or printed",
        )  # fmt: skip
        axes.set_yticks([])
        axes.grid(visible=False, axis="y")
        for ratio, side, word in ((0.99, "right", "safe"), (1.01, "left", "unsafe")):
            axes.text(ratio, len(KINDS) - 0.67, word, ha=side, fontsize=8.5, color=GREY)
        axes.set_title("Evidence: a dot is a number; open where the print is wrong")
        return save(figure, FOLDER, NAME)


def _spread(ratios: Sequence[float]) -> list[float]:
    """Return the heights of the dots of a row; dots of nearly the same ratio are stacked."""
    columns: dict[int, int] = {}
    sizes: dict[int, int] = {}
    places = [round(ratio / COLUMN) for ratio in ratios]
    for place in places:
        sizes[place] = sizes.get(place, 0) + 1
    heights = []
    for place in places:
        order, size = columns.get(place, 0), sizes[place]
        columns[place] = order + 1
        step = min(0.09, 2.0 * SPREAD / max(size - 1, 1))
        heights.append((order - (size - 1) / 2.0) * step)
    return heights

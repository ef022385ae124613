"""Labels next to points, placed where they hide least."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from reports.data.results import Floats

SIZE = 8.5
REACHES = (5.0, 9.0, 14.0, 20.0, 28.0)  # points from the point to the text's nearer edge
DIRECTIONS = 16
FAR = 0.4  # samples that a point more of distance is worth
CLEAR = 2.0  # points around a text
HALO = withStroke(linewidth=2.2, foreground="white")
STEP = 4.0  # pixels between the samples of a line one point thick

# Of a marker's size in points, in pixels.
RING = 0.6 * np.array(
    [[1, 1], [1, -1], [-1, 1], [-1, -1], [0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]]
)


@dataclass(frozen=True)
class Label:
    """A text that belongs to a point of the axes."""

    text: str
    x: float
    y: float
    style: dict[str, Any] = field(default_factory=dict)


def place_texts(figure: Figure, axes: Axes, labels: list[Label]) -> None:
    """Write every label near its point, in the order given; the axes' lines are kept clear."""
    figure.draw_without_rendering()
    points = 72.0 / figure.dpi
    drawn = _samples(axes) * points
    frame = np.asarray(axes.get_window_extent().get_points()) * points
    taken: list[Floats] = []
    for label in labels:
        at = np.asarray(axes.transData.transform((label.x, label.y))) * points
        text = axes.annotate(
            label.text, (label.x, label.y), (0.0, 0.0), textcoords="offset points",
            ha="center", va="center", fontsize=SIZE, zorder=8.0, path_effects=[HALO], **label.style,
        )  # fmt: skip
        # What lies in the axes shall not move them.
        text.set_in_layout(False)
        box = text.get_window_extent()
        half = 0.5 * np.array([box.width, box.height]) * points
        offset = _best(at, half, drawn, frame, taken)
        text.set_position(tuple(offset.tolist()))
        taken.append(np.array([at + offset - half, at + offset + half]))


def _best(at: Floats, half: Floats, drawn: Floats, frame: Floats, taken: list[Floats]) -> Floats:
    angles = np.radians(45.0 + 360.0 / DIRECTIONS * np.arange(DIRECTIONS))
    found, least = np.zeros(2), np.inf
    drawn = drawn[np.all(np.abs(drawn - at) < REACHES[-1] + 2.0 * half + 2.0 * CLEAR, axis=1)]
    for reach in REACHES:
        for angle in angles:
            way = np.array([np.cos(angle), np.sin(angle)])
            # The box's edge, not its middle, is `reach` away.
            offset = way * (reach + float(np.min(half / np.maximum(np.abs(way), 1e-9))))
            low, high = at + offset - half - CLEAR, at + offset + half + CLEAR
            cost = float(np.all((drawn > low) & (drawn < high), axis=1).sum()) + FAR * reach
            cost += 1e3 * sum(bool(np.all((b[1] > low) & (b[0] < high))) for b in taken)
            cost += 1e3 * float(np.any(low < frame[0]) or np.any(high > frame[1]))
            if cost < least:
                found, least = offset, cost
    return found


def _samples(axes: Axes) -> Floats:
    """(N, 2) pixels, evenly along every line, more of thick ones, and at every marker."""
    parts = [np.empty((0, 2))]
    for line in axes.lines:
        ends = np.asarray(line.get_transform().transform(line.get_xydata()))
        if line.get_marker() not in ("None", None, ""):
            ring = RING * line.get_markersize()
            parts += [point + ring for point in ends] * 8
        if line.get_linestyle() == "None":
            continue
        for a, b in pairwise(ends):
            number = max(int(np.hypot(*(b - a)) * line.get_linewidth() / STEP), 1)
            part = np.linspace(0.0, 1.0, number, endpoint=False)[:, None]
            parts.append(a + part * (b - a))
    return np.concatenate(parts)

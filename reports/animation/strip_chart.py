"""Curves against time below an animation: forces on the pins, forces of the drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pinbase.dimensions import Floats
from reports.animation.frames import PICTURE_WIDTH, nice
from reports.format.numbers import short

STRIP_LEFT, STRIP_RIGHT = 70.0, PICTURE_WIDTH - 14.0
STRIP_TOP_MARGIN, STRIP_BOTTOM_MARGIN = 24.0, 22.0
LOW_STRIP_HEIGHT = 100.0  # a lower strip has no scale, only zero and the extremes


@dataclass(frozen=True)
class Tick:
    """A position on an axis and its label."""

    at: float
    text: str


@dataclass(frozen=True)
class Curve:
    """The path of a line, its colour class, and the position and value of its peak."""

    path: str
    colour: str
    peak: tuple[float, float]


@dataclass(frozen=True)
class Strip:
    """A panel of curves against time with one scale from zero."""

    title: str
    note: str
    height: float
    x: list[Tick]
    y: list[Tick]
    zero: float
    curves: list[Curve]

    left, right, top, width = STRIP_LEFT, STRIP_RIGHT, STRIP_TOP_MARGIN, PICTURE_WIDTH

    @property
    def foot(self) -> float:
        return self.height - STRIP_BOTTOM_MARGIN


def strip(
    title: str,
    note: str,
    height: float,
    time: Floats,
    curves: Sequence[Floats],
    colours: Sequence[str],
    factor: float,
) -> Strip:
    """Return a panel of curves against time.

    time: (F,). curves: each (F,), labelled in multiples of `factor`.
    """
    low = min(0.0, *(float(np.min(c)) for c in curves))
    high = max(0.0, *(float(np.max(c)) for c in curves))
    if high == low:
        high = low + 1.0
    bottom = height - STRIP_BOTTOM_MARGIN
    start, span = float(time[0]), float(np.ptp(time)) or 1.0
    x = STRIP_LEFT + (STRIP_RIGHT - STRIP_LEFT) * (time - start) / span
    scale = (bottom - STRIP_TOP_MARGIN) / (high - low)

    def up(value: float) -> float:
        return bottom - scale * (value - low)

    lines = []
    for values, colour in zip(curves, colours, strict=True):
        peak = int(np.argmax(np.abs(values)))
        y = bottom - scale * (values - low)
        places = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
        lines.append(Curve(f"M{places}", colour, (float(x[peak]), float(y[peak]))))
    times = [
        Tick(STRIP_LEFT + (STRIP_RIGHT - STRIP_LEFT) * (t - start) / span, short(t))
        for t in ticks(start, start + span, 8)
    ]
    levels = ticks(low, high, 4) if height > LOW_STRIP_HEIGHT else extremes(low, high)
    marks = [Tick(up(v), short(float(f"{v / factor:.4g}"))) for v in levels]
    return Strip(title, note, height, times, marks, up(0.0), lines)


def extremes(low: float, high: float) -> list[float]:
    """Return the ends of the range that are far enough from zero to be labelled, and zero."""
    return [v for v in (low, high) if abs(v) > 0.35 * (high - low)] + [0.0]


def ticks(low: float, high: float, most: int) -> list[float]:
    """Return round numbers from low to high, about `most` of them."""
    step = nice((high - low) / most)
    if (high - low) / step > 1.5 * most:
        step = nice(2.6 * step)
    first, last = int(np.ceil(low / step - 1e-9)), int(np.floor(high / step + 1e-9))
    return [float(f"{k * step:.9g}") for k in range(first, last + 1)]

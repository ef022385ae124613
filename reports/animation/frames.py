"""The instants of an animation, and the mapping to its picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats
from reports.data.mechanics import DriveTable, ReactionTable
from reports.data.skeleton import Skeleton
from reports.format.drawing.projection import Projection

MAX_FRAMES = 240  # 4 s at 60 frames per second
PICTURE_WIDTH, MAX_PICTURE_HEIGHT, MIN_PICTURE_HEIGHT = 960.0, 560.0, 300.0
PICTURE_MARGIN = 36.0  # room for names and for symbols around a joint


def frames(
    skeleton: Skeleton, table: ReactionTable | None, drives: list[DriveTable]
) -> NDArray[np.int64]:
    """Return the indices of at most 240 instants: evenly spaced ones and those of the peaks."""
    count = len(skeleton.position)
    if count <= MAX_FRAMES:
        return np.arange(count)
    peaks = [int(np.argmax(np.abs(d.force))) for d in drives if len(d.force) == count]
    if table is not None:
        peaks += table.magnitudes.argmax(axis=0).tolist()
    peak_indices = np.unique(peaks)[: MAX_FRAMES // 2]
    even = np.linspace(0, count - 1, MAX_FRAMES - len(peak_indices)).round().astype(int)
    return np.union1d(even, peak_indices)


@dataclass(frozen=True)
class Viewport:
    """A mapping from lengths in the study's unit to the picture, whose y axis points downwards.

    scale: picture units per length.
    left, top: the origin of the lengths on the picture.
    height: of the picture.
    """

    scale: float
    left: float
    top: float
    height: float

    @staticmethod
    def of(points: Floats, tails: Floats, arrows: Floats) -> Viewport:
        """Return the viewport in which all points and arrows fit.

        points: (N, 2), in the study's unit.
        tails: (M, 2), the points at which the arrows start, in the study's unit.
        arrows: (M, 2), in picture units, y upwards.
        """
        all_points = np.concatenate([points, tails])
        offsets = np.concatenate([np.zeros_like(points), arrows])
        room = np.array([PICTURE_WIDTH, MAX_PICTURE_HEIGHT]) - 2.0 * PICTURE_MARGIN
        size = np.ptp(all_points, axis=0)
        if not size.any():
            size = np.ones(2)
        low, high = 0.0, float(np.min(room / np.maximum(size, 1e-9 * size.max())))
        for _ in range(40):  # bisection, since the arrows do not scale with the points
            middle = 0.5 * (low + high)
            fits = np.all(np.ptp(middle * all_points + offsets, axis=0) <= room)
            low, high = (middle, high) if fits else (low, middle)
        drawn = low * all_points + offsets
        corner, size = drawn.min(axis=0), np.ptp(drawn, axis=0)
        height = float(max(size[1] + 2.0 * PICTURE_MARGIN, MIN_PICTURE_HEIGHT))
        left = 0.5 * (PICTURE_WIDTH - size[0]) - corner[0]
        top = 0.5 * (height + size[1]) + corner[1]
        return Viewport(low, float(left), float(top), height)

    @staticmethod
    def turning(
        points: Floats, tails: Floats, arrows: Floats, views: Sequence[Projection]
    ) -> Viewport:
        """Return the viewport about the middle of all points in which points and arrows fit in
        several views.

        points: (N, 3), in the study's unit.
        tails: (M, 3), the points at which the arrows start.
        arrows: (M, 3), in picture units.
        views: the first is that of the viewport.
        """
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        away = np.concatenate([points, tails]) - middle
        offsets = np.concatenate([np.zeros_like(points), arrows])
        room = 0.5 * np.array([PICTURE_WIDTH, MAX_PICTURE_HEIGHT]) - PICTURE_MARGIN

        def fits(scale: float) -> bool:
            drawn = scale * away + offsets
            return all(bool((np.abs(view(drawn)) <= room).all()) for view in views)

        low, high = 0.0, float(room.max() / (np.abs(away).max() or 1.0))
        for _ in range(40):
            scale = 0.5 * (low + high)
            low, high = (scale, high) if fits(scale) else (low, scale)
        x, y = (float(c) for c in low * views[0](middle))
        half = 0.5 * PICTURE_WIDTH, 0.5 * MAX_PICTURE_HEIGHT
        return Viewport(low, half[0] - x, half[1] + y, MAX_PICTURE_HEIGHT)

    def __call__(self, points: Floats) -> Floats:
        """Return the positions (..., 2) in the picture of points (..., 2)."""
        return np.stack(
            [self.left + self.scale * points[..., 0], self.top - self.scale * points[..., 1]],
            axis=-1,
        )


def nice(value: float) -> float:
    """Return the largest 1, 2 or 5 times a power of ten that does not exceed a value; 1 if the
    value is not positive and finite.
    """
    if not value > 0.0 or not np.isfinite(value):
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    digit = max(d for d in (1.0, 2.0, 5.0) if d <= value / power * (1.0 + 1e-9))
    return float(digit * power)

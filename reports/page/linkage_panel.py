"""A panel of the drawing of a linkage: one view at an instant, at one scale."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pinbase.dimensions import Floats
from reports.data.mechanics import ReactionTable
from reports.data.skeleton import Skeleton
from reports.format.drawing.projection import Projection

Points = Mapping[str, Floats]  # pixels (2,) by joint


@dataclass(frozen=True)
class Instant:
    """A linkage at an instant.

    k: index of the instant.
    table: the forces at its connections, where they are shown.
    """

    skeleton: Skeleton
    k: int
    table: ReactionTable | None = None


@dataclass(frozen=True)
class Mark:
    """A label at a joint, and the symbol drawn there.

    name: in bold. words: the text after the name.
    symbol: an SVG element about the origin, in which all text is escaped.
    """

    joint: str
    name: str
    words: str = ""
    symbol: str = ""


@dataclass(frozen=True)
class LinkagePanel:
    """A view of a linkage and its place on the drawing, in pixels from the panel's corner, y
    downwards.

    scale: pixels per length.
    middle: of the view, (2,), in lengths.
    size: width and height.
    symbol: the scale of supports, pins and arrows.
    """

    view: Projection
    scale: float
    middle: Floats
    size: tuple[float, float]
    symbol: float = 1.0

    @staticmethod
    def of(
        at: Instant, view: Projection, width: float, heights: tuple[float, float], margin: float
    ) -> LinkagePanel:
        """Return the panel that a linkage fills.

        heights: the smallest and the largest.
        margin: on every side, for names and arrows.
        """
        low, high = _extent(at, view)
        span = np.maximum(high - low, 1e-9 * (1.0 + np.abs(high).max()))
        room = width - 2.0 * margin, heights[1] - 2.0 * margin
        scale = float(min(room[0] / span[0], room[1] / span[1]))
        height = max(scale * float(span[1]) + 2.0 * margin, heights[0])
        return LinkagePanel(view, scale, 0.5 * (low + high), (width, height))

    def pixels(self, points: Floats) -> Floats:
        """Return the pixels (.., 2) of points (.., 3), y downwards."""
        away = (self.view(points) - self.middle) * self.scale * np.array([1.0, -1.0])
        return np.asarray(away + 0.5 * np.array(self.size))

    def joints(self, at: Instant) -> Points:
        """Return the position of every joint, in pixels (2,)."""
        skeleton = at.skeleton
        return dict(zip(skeleton.joints, self.pixels(skeleton.position[at.k]), strict=True))

    def direction(self, vector: Floats) -> Floats:
        """Return the projection (2,) of a vector (3,) on the picture, y downwards, not scaled to
        pixels.
        """
        return np.asarray(self.view(vector) * np.array([1.0, -1.0]))


def _extent(at: Instant, view: Projection) -> tuple[Floats, Floats]:
    """Return the lowest and the highest coordinates of the drawn parts of a linkage, each (2,)."""
    skeleton, k = at.skeleton, at.k
    parts = [skeleton.position[k], *(ends[k] for ends in skeleton.slides.values())]
    parts += [ends[k] for ends in skeleton.springs.values()]
    parts += [skeleton.centre[k, skeleton.bodies.index(body)] for body in skeleton.stems]
    parts += [load.position[min(k, len(load.position) - 1)] for load in skeleton.loads]
    box = np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]])
    parts += [c.ends[k][:1] + c.radius * box if c.round else c.ends[k] for c in skeleton.pitch]
    every = view(np.concatenate([np.reshape(part, (-1, 3)) for part in parts]))
    return every.min(axis=0), every.max(axis=0)

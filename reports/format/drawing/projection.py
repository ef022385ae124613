"""Parallel projections of a linkage in space on a picture: isometric, and three views."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.dimensions import Floats

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Projection:
    """A parallel projection.

    right, up: directions on the picture, unit vectors at a right angle.
    """

    name: str
    right: Vector
    up: Vector

    def __call__(self, points: Floats) -> Floats:
        """Return the coordinates (..., 2) on the picture, y upwards, of points (..., 3)."""
        return np.asarray(points @ np.array([self.right, self.up]).T)

    @property
    def towards(self) -> Vector:
        """The direction to the viewer."""
        return _vector(np.cross(self.right, self.up))

    def depth(self, points: Floats) -> Floats:
        """Return the distances (...) towards the viewer of points (..., 3)."""
        return np.asarray(points @ np.array(self.towards))


PLANE = Projection("x-y plane", (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))


def isometric(up: Vector) -> Projection:
    """Return the view in which all axes are equally foreshortened, from the front, right and above.

    up: the vertical, along one of the axes.
    """
    right, high, near = _front(up)
    return Projection(
        "Isometric",
        _vector((right - near) / np.sqrt(2.0)),
        _vector((2.0 * high - right - near) / np.sqrt(6.0)),
    )


def three_views(up: Vector) -> tuple[Projection, Projection, Projection]:
    """Return the views from the front, from the right and from above.

    up: the vertical, along one of the axes.
    """
    right, high, near = _front(up)
    return (
        Projection("Front", _vector(right), _vector(high)),
        Projection("Right side", _vector(-near), _vector(high)),
        Projection("Top", _vector(right), _vector(-near)),
    )


def _front(up: Vector) -> tuple[Floats, Floats, Floats]:
    """Return the directions right, up and towards the viewer of the front view.

    To the right is x, or y where x is the vertical.
    """
    high = np.array(up)
    right = np.array([1.0, 0.0, 0.0]) if abs(high[0]) < 0.5 else np.array([0.0, 1.0, 0.0])
    return right, high, np.cross(right, high)


def _vector(components: Floats) -> Vector:
    x, y, z = (float(c) + 0.0 for c in components)
    return x, y, z

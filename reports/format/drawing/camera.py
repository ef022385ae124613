"""Camera position for a pin: its maximum and heads are visible, and it fills the view."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.dimensions import Floats

Point = tuple[float, float, float]
VIEW_ANGLE = 30.0  # degrees, vertical
ASPECT_RATIO = 1.5
FILLED_WIDTH, FILLED_HEIGHT = 0.86, 0.62  # of the picture that the pin may fill
LABEL_CLEARANCE = 0.07  # of the picture's height, from the pin to the label of its peak
VIEW_TURN_ANGLE = np.radians(25.0)  # from the peak, so that it does not face the viewer squarely
VIEW_AXIAL_LEAN = 0.55  # towards the nearer end


@dataclass(frozen=True)
class View:
    """A perspective view from `eye` to `centre` with the direction `up`, each (3,)."""

    eye: Floats
    centre: Floats
    up: Floats

    @staticmethod
    def of(points: Floats, peak: Floats) -> View:
        """Return the view from the side of the maximum, slightly from one end, z to the right."""
        centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
        angle = np.arctan2(peak[1] - centre[1], peak[0] - centre[0]) + VIEW_TURN_ANGLE
        end = _seen_from(points, peak)
        towards = np.array([np.cos(angle), np.sin(angle), VIEW_AXIAL_LEAN * end])
        towards /= np.linalg.norm(towards)
        up = np.cross(towards, np.array([0.0, 0.0, 1.0]))
        up /= np.linalg.norm(up)
        basis = np.stack([np.cross(up, towards), up, towards])
        return View(centre + _distance((points - centre) @ basis.T) * towards, centre, up)

    @property
    def camera(self) -> list[Point]:
        """Return the position, the focal point and the upward direction, in VTK's order."""
        return [_point(self.eye), _point(self.centre), _point(self.up)]

    def above(self, points: Floats, place: Floats) -> Floats:
        """Return a point (3,) above `place` in the picture, clear of the pin."""
        heights = (points - self.centre) @ self.up
        height = float((place - self.centre) @ self.up)
        visible = 2.0 * np.linalg.norm(self.eye - self.centre) * np.tan(np.radians(VIEW_ANGLE / 2))
        clear = float(heights.max() + LABEL_CLEARANCE * visible)
        return np.asarray(place + (clear - height) * self.up)


def _seen_from(points: Floats, peak: Floats) -> float:
    """Return the end (1 or -1 along z) from which no head hides the maximum.

    It is the thinner end, otherwise the nearer one.
    """
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    little = 1e-6 * float(np.ptp(z))
    beyond = r[z > peak[2] + little].max(initial=0.0)
    before = r[z < peak[2] - little].max(initial=0.0)
    if not np.isclose(beyond, before, rtol=1e-3):
        return 1.0 if beyond < before else -1.0
    return 1.0 if peak[2] >= 0.5 * (z.min() + z.max()) else -1.0


def _distance(seen: Floats) -> float:
    """Return the distance of the eye at which all points are in the picture.

    seen: (N, 3), coordinates to the right, up and towards the eye.
    """
    half = np.tan(np.radians(VIEW_ANGLE / 2))
    right = seen[:, 2] + np.abs(seen[:, 0]) / (half * ASPECT_RATIO * FILLED_WIDTH)
    up = seen[:, 2] + np.abs(seen[:, 1]) / (half * FILLED_HEIGHT)
    return float(max(right.max(), up.max()))


def _point(vector: Floats) -> Point:
    x, y, z = (float(v) for v in vector)
    return x, y, z

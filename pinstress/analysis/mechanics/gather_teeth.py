"""Pitch circles of gears and pitch lines of racks, to be drawn."""

from __future__ import annotations

import math

import numpy as np

from loads import Gear, Motion, Rack, Teeth
from loads.linkage.linkage import Point
from reports.data.mechanics import PitchCurve


def pitch_curves(motion: Motion) -> tuple[PitchCurve, ...]:
    """Of all teeth, each circle once."""
    found: dict[tuple[str, str, float], PitchCurve] = {}
    for teeth in motion.linkage.teeth:
        for side in teeth.sides:
            if isinstance(side, Rack):
                found[side.body, side.slider, 0.0] = _line(motion, teeth, side)
                continue
            centre = motion.linkage.joint(side.joint).at
            radius = float(f"{math.dist(centre, teeth.at):.9g}")
            if (key := (side.body, side.joint, radius)) not in found:
                found[key] = PitchCurve(side.body, _ends(motion, side, centre, teeth.at), True)
    return tuple(found.values())


def _ends(motion: Motion, side: Gear | Rack, first: Point, second: Point) -> np.ndarray:
    """(T, 2, 2) of two points of a body, m as drawn."""
    return np.stack([motion.point(side.body, p)[0] for p in (first, second)], axis=1)


def _line(motion: Motion, teeth: Teeth, rack: Rack) -> PitchCurve:
    """What of the pitch line meets the gear, and as much again as its radius on both sides."""
    slider = next(s for s in motion.linkage.sliders if s.name == rack.slider)
    gear = next(side for side in teeth.sides if isinstance(side, Gear))
    radius = math.dist(motion.linkage.joint(gear.joint).at, teeth.at)
    travel = motion.coordinate(slider)[0] - slider.drawn
    met = -travel if slider.moving == rack.body else travel
    (x, y), (ex, ey) = teeth.at, slider.axis
    far = (float(met.min()) - radius, float(met.max()) + radius)
    low, high = ((x + s * ex, y + s * ey) for s in far)
    return PitchCurve(rack.body, _ends(motion, rack, low, high), False)

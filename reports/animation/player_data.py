"""The numbers for an animation's script, rounded to visible precision."""

from __future__ import annotations

from typing import Any

import numpy as np

from reports.animation.frames import nice
from reports.animation.scene import APPLIED_GAP, MAX_ARROW_LENGTH, Scene
from reports.data.results import DriveTable, Floats, Units
from reports.format.numbers import short

PLAYING_SECONDS = 6.0  # that a motion takes to play, about
WATCHABLE_SECONDS = (2.0, 12.0)  # seconds that need no other speed


def player_data(scene: Scene, drives: list[DriveTable], units: Units) -> dict[str, Any]:
    """Return the positions and values of every frame for the script."""
    at = scene.instants
    time = scene.motion.time
    return {
        "time": digits(np.arange(len(at), dtype=np.float64) if time is None else time[at], 7),
        "places": {"left": scene.view.left, "top": scene.view.top, "scale": scene.view.scale},
        "units": {"length": units.length, "force": units.force, "time": units.time},
        "joints": list(scene.motion.joints),
        "xy": [pixels(scene.joints[:, j]) for j in range(len(scene.motion.joints))],
        "centres": [pixels(scene.centres[:, b]) for b in range(len(scene.motion.bodies))],
        "links": scene.members,
        "slides": [
            {
                "ends": pixels(s.ends.reshape(-1, 4)),
                "cylinder": round(s.cylinder, 2),
                "rail": s.rail is not None,
                "angle": round(s.angle, 3),
            }
            for s in scene.slides
        ],
        "pitch": [pixels(ends.reshape(-1, 4)) for _, ends, _ in scene.pitch],
        "connections": _connections(scene),
        "applied": [
            {"xy": pixels(at), "fx": digits(force[:, 0]), "fy": digits(force[:, 1])}
            for at, force in scene.applied
        ],
        "drives": [
            {"position": digits(d.position[at]), "force": digits(d.force[at])} for d in drives
        ],
        "arrow": {"longest": MAX_ARROW_LENGTH, "largest": scene.largest, "gap": APPLIED_GAP},
    }


def _connections(scene: Scene) -> list[dict[str, Any]]:
    if scene.table is None:
        return []
    size = scene.table.magnitudes[scene.instants]
    return [
        {
            "name": name,
            "body": body,
            "joint": scene.tails[c],
            "fx": digits(scene.forces[:, c, 0]),
            "fy": digits(scene.forces[:, c, 1]),
            "f": digits(size[:, c]),
        }
        for c, (name, body, _) in enumerate(scene.motion.connections)
    ]


def speeds(time: Floats | None) -> list[tuple[float, str, bool]]:
    """Return the speeds of playback: the factor on real time, its label, whether it is the default.

    A motion of milliseconds or of hours plays in seconds.
    """
    if time is None or len(time) < 2:
        return []
    duration = float(np.ptp(time)) or 1.0
    middle = nice(1.5 * duration / PLAYING_SECONDS)
    if WATCHABLE_SECONDS[0] <= duration <= WATCHABLE_SECONDS[1]:
        middle = 1.0
    choices = sorted({float(f"{middle * m:.6g}") for m in (0.1, 0.2, 0.5, 1.0, 2.0, 5.0)} | {1.0})
    return [
        (s, f"{short(s)}×" + (" (real time)" if s == 1.0 else ""), s == middle) for s in choices
    ]


def digits(values: Floats, significant: int = 5) -> list[float | None]:
    """Return the numbers rounded relative to the largest; None for missing ones."""
    finite = values[np.isfinite(values)]
    largest = float(np.abs(finite).max(initial=0.0))
    decimals = significant - 1 - int(np.floor(np.log10(largest))) if largest > 0.0 else 0
    return [_plain(round(v, decimals)) if np.isfinite(v) else None for v in values.tolist()]


def pixels(points: Floats) -> list[float]:
    """Return the coordinates as one flat list, rounded to a hundredth of a pixel."""
    return [_plain(round(v, 2)) for v in points.reshape(-1).tolist()]


def _plain(value: float) -> float:
    # Whole numbers without ".0", and no minus zero: a third of the file.
    return int(value) if value == int(value) else value

"""The numbers for an animation's script, rounded to visible precision."""

from __future__ import annotations

from typing import Any

import numpy as np

from pinbase.dimensions import Floats
from reports.animation.frames import nice
from reports.animation.scene import APPLIED_GAP, AXIS_REACH, JOINT_LABEL_GAP, PIN_REACH, Scene
from reports.data.mechanics import DriveTable
from reports.data.row import Units
from reports.format.drawing.projection import three_views
from reports.format.numbers import short

PLAYING_SECONDS = 6.0  # for which a motion plays, about
WATCHABLE_SECONDS = (2.0, 12.0)  # durations that play in real time


def player_data(scene: Scene, drives: list[DriveTable], units: Units) -> dict[str, Any]:
    """Return the positions and values of every frame for the script."""
    at = scene.instants
    time = scene.skeleton.time
    return {
        "time": digits(np.arange(len(at), dtype=np.float64) if time is None else time[at], 7),
        "places": {"left": scene.view.left, "top": scene.view.top, "scale": scene.view.scale},
        "space": None if scene.skeleton.flat else _space(scene),
        "units": {"length": units.length, "force": units.force, "time": units.time},
        "joints": list(scene.skeleton.joints),
        "at": _each(scene, scene.skeleton.position),
        "centres": _each(scene, scene.skeleton.centre),
        "links": scene.members,
        "slides": [
            {
                "ends": pixels(scene.placed(scene.skeleton.slides[s.name][at])),
                "cylinder": round(s.cylinder, 2),
                "rail": s.rail is not None,
                "angle": round(s.angle, 3),
            }
            for s in scene.slides
        ],
        "springs": [pixels(scene.placed(ends[at])) for ends in scene.skeleton.springs.values()],
        "pitch": [pixels(ends.reshape(-1, 4)) for _, ends, _ in scene.pitch],
        "connections": _connections(scene),
        "applied": [
            {"at": pixels(scene.placed(point)), "lever": joint, **_components(scene, force)}
            for (point, force), joint in zip(scene.applied, scene.levers, strict=True)
        ],
        "couples": [
            {"at": pixels(scene.placed(point)), **_components(scene, couple, 7)}
            for point, couple in scene.couples
        ],
        "drives": [
            {"position": digits(d.position[at]), "force": digits(d.force[at])} for d in drives
        ],
        "arrow": {
            "longest": scene.longest,
            "largest": scene.largest,
            "couple": scene.largest_couple,
            "gap": APPLIED_GAP,
        },
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
            **_components(scene, scene.forces[:, c]),
            "f": digits(size[:, c]),
        }
        for c, (name, body, _) in enumerate(scene.skeleton.connections)
    ]


def _each(scene: Scene, points: Floats) -> list[list[float]]:
    """Return the positions on the picture of each of N points (T, N, 3) in all frames."""
    return [pixels(points) for points in np.moveaxis(scene.placed(points[scene.instants]), 1, 0)]


def _components(scene: Scene, force: Floats, significant: int = 5) -> dict[str, list[float | None]]:
    """Return the components of a force (F, 3) along the axes of the picture."""
    return {f"f{axis}": digits(force[:, i], significant) for i, axis in enumerate(scene.axes)}


def _space(scene: Scene) -> dict[str, Any]:
    """Return the data with which the script turns a linkage in space.

    base: the directions right, up and towards the viewer of the front view.
    """
    skeleton, at = scene.skeleton, scene.instants
    front = three_views(skeleton.up)[0]
    return {
        "reach": [AXIS_REACH, PIN_REACH],
        "labels": {"gap": JOINT_LABEL_GAP, "sizes": scene.name_sizes.tolist()},
        "base": [front.right, front.up, front.towards],
        "middle": scene.middle.tolist(),
        "axes": [
            [round(float(c), 4) for c in skeleton.axes[at, j].ravel()] if shown else None
            for j, shown in enumerate(np.any(skeleton.axes, axis=(0, 2)).tolist())
        ],
        "stems": [skeleton.bodies.index(body) for body in skeleton.stems],
        "curves": [pixels(scene.placed(path[at])) for path in skeleton.paths.values()],
    }


def speeds(time: Floats | None) -> list[tuple[float, str, bool]]:
    """Return the speeds of playback: factor on real time, label, and whether it is the default.

    By default a motion of milliseconds or of hours plays in seconds.
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
    """Return the numbers rounded relative to the largest; None for non-finite ones."""
    finite = values[np.isfinite(values)]
    largest = float(np.abs(finite).max(initial=0.0))
    decimals = significant - 1 - int(np.floor(np.log10(largest))) if largest > 0.0 else 0
    return [_plain(round(v, decimals)) if np.isfinite(v) else None for v in values.tolist()]


def pixels(points: Floats) -> list[float]:
    """Return the coordinates as one flat list, rounded to a hundredth of a pixel."""
    return [_plain(round(v, 2)) for v in points.reshape(-1).tolist()]


def _plain(value: float) -> float:
    # Whole numbers without ".0" and without minus zero; this saves a third of the file.
    return int(value) if value == int(value) else value

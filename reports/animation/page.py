"""animation_CASE.html: an animated linkage with the forces on its pins, in one offline file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from pinbase.dimensions import Floats
from reports.animation.force_table import Shown, applied_arrows, arrows, couple_arrows, key, rows
from reports.animation.frames import frames, nice
from reports.animation.player_data import player_data, speeds
from reports.animation.scene import AXIS_REACH, PIN_REACH, Scene, clipped
from reports.animation.strip_chart import Strip, strip
from reports.data.mechanics import DriveTable, ReactionTable
from reports.data.results import Results
from reports.data.row import Units
from reports.data.skeleton import Skeleton
from reports.format.file_names import animation_name
from reports.format.numbers import engineering, short
from reports.format.script_json import script_json
from reports.format.template import rendered

# Names with azimuth (from the front to the right) and elevation, degrees; the first is shown first.
VIEW_ANGLES = (
    ("Isometric", 45.0, float(np.degrees(np.arctan(np.sqrt(0.5))))),
    ("Front", 0.0, 0.0),
    ("Right side", 90.0, 0.0),
    ("Top", 0.0, 90.0),
)
SCALE_BAR_SHARE = 0.2  # of the linkage's size, about; length of the scale bar


def write_animations(results: Results, directory: Path) -> list[Path]:
    """Write an animation for every case with a known linkage; return the paths."""
    paths = []
    for skeleton in results.skeletons:
        path = directory / animation_name(skeleton.case)
        path.write_text(render_animation(skeleton, results), encoding="utf-8", newline="\n")
        paths.append(path)
    return paths


def render_animation(skeleton: Skeleton, results: Results) -> str:
    """Return the text of the HTML file of a case."""
    case = skeleton.case
    table = next((_matched(t, skeleton) for t in results.reactions if t.case == case), None)
    drives = [d for d in results.drive if d.case == case]
    scene = Scene(skeleton, frames(skeleton, table, drives), table)
    shown = Shown.of(scene, drives, results.units)
    data = player_data(scene, drives, results.units)
    data["fixed"] = {
        "force": vars(shown.force),
        "couple": vars(shown.couple),
        "drives": [[vars(position), vars(force)] for position, force in shown.drives],
    }
    return rendered(
        "animation.html.j2",
        title=results.title,
        case=case,
        note="" if table is None else table.note,
        units=results.units,
        scene=scene,
        moving=len(scene.instants) > 1,
        arrows=arrows(scene),
        applied=applied_arrows(scene),
        couples=couple_arrows(scene),
        key=key(scene),
        short=short,
        clipped=clipped,
        shown=shown,
        bar=_bar(scene, results.units),
        rows=rows(scene, shown),
        drives=drives,
        pin_axes=_pin_axes(scene),
        view_angles=VIEW_ANGLES,
        strips=_strips(scene, drives, shown, results.units),
        speeds=speeds(skeleton.time),
        data=script_json(data),
    )


def _pin_axes(scene: Scene) -> list[tuple[Floats, Floats]]:
    """Return for each joint with an axis the ends (2, 2) of the axis and of the pin, at the first
    frame.
    """
    along = scene.projection(scene.skeleton.axes[scene.instants[0]]) * [1.0, -1.0]
    both = np.array([[-1.0], [1.0]])
    return [
        (joint + AXIS_REACH * both * axis, joint + PIN_REACH * both * axis)
        for joint, axis in zip(scene.joints[0], along, strict=True)
        if axis.any()
    ]


def _matched(table: ReactionTable, skeleton: Skeleton) -> ReactionTable | None:
    """Return the table in the order of the linkage's connections; None if some are
    missing in it.
    """
    names = [name for name, _, _ in skeleton.connections]
    if not set(names) <= set(table.connections):
        return None
    at = [table.connections.index(name) for name in names]
    return replace(
        table,
        connections=tuple(names),
        bodies=tuple(table.bodies[i] for i in at),
        pins=tuple(table.pins[i] for i in at),
        forces=table.forces[:, at],
        moments=table.moments[:, at],
        turn=None if table.turn is None else table.turn[:, at],
    )


def _bar(scene: Scene, units: Units) -> tuple[float, str]:
    """Return the length of a scale bar on the picture, and the round length that it represents."""
    length = nice(SCALE_BAR_SHARE * scene.size)
    return length * scene.view.scale, f"{short(length)} {units.length}"


def _strips(scene: Scene, drives: list[DriveTable], shown: Shown, units: Units) -> list[Strip]:
    """Return a panel of the forces on the pins against time, then a panel for each drive."""
    time, at = scene.skeleton.time, scene.instants
    if time is None or len(at) < 2:
        return []
    strips = []
    if scene.table is not None and scene.tails:
        curves = list(scene.table.magnitudes[at].T)
        colours = [scene.colour(body) for _, body, _ in scene.skeleton.connections]
        title = f"forces on the pins [{shown.force.unit}]"
        note = f"time [{units.time}]"
        strips.append(strip(title, note, 122.0, time[at], curves, colours, shown.force.factor))
    for d, (_, force) in zip(drives, shown.drives, strict=True):
        title = f"drive {d.name}: {'torque' if d.kind == 'rotary' else 'force'} [{force.unit}]"
        note = ", ".join(
            f"{what} {engineering(size / force.factor)}"
            for what, size in (("mean", d.mean), ("RMS", d.rms))
        )
        strips.append(strip(title, note, 82.0, time[at], [d.force[at]], ["plain"], force.factor))
    return strips

"""animation_CASE.html: an animated linkage with the forces on its pins, in one offline file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from reports.animation.force_table import Shown, applied_arrows, arrows, key, rows
from reports.animation.frames import frames, nice
from reports.animation.player_data import player_data, speeds
from reports.animation.scene import Scene, clipped
from reports.animation.strip_chart import Strip, strip
from reports.data.results import DriveTable, LinkageMotion, ReactionTable, Results, Units
from reports.format.file_names import animation_name
from reports.format.numbers import short
from reports.format.script_json import script_json
from reports.format.template import environment

SCALE_BAR_SHARE = 0.2  # of the linkage's size, about: the bar that shows a length


def write_animations(results: Results, directory: Path) -> list[Path]:
    """Write an animation for every case whose linkage is known, and return the paths."""
    paths = []
    for motion in results.motion:
        path = directory / animation_name(motion.case)
        path.write_text(render_animation(motion, results), encoding="utf-8", newline="\n")
        paths.append(path)
    return paths


def render_animation(motion: LinkageMotion, results: Results) -> str:
    """Return the text of the HTML file of a case."""
    table = next((_matched(t, motion) for t in results.reactions if t.case == motion.case), None)
    drives = [d for d in results.drive if d.case == motion.case]
    scene = Scene(motion, frames(motion, table, drives), table)
    shown = Shown.of(scene, drives, results.units)
    data = player_data(scene, drives, results.units)
    data["fixed"] = {
        "force": vars(shown.force),
        "drives": [[vars(position), vars(force)] for position, force in shown.drives],
    }
    return (
        environment()
        .get_template("animation.html.j2")
        .render(
            title=results.title,
            case=motion.case,
            note="" if table is None else table.note,
            units=results.units,
            scene=scene,
            moving=len(scene.instants) > 1,
            arrows=arrows(scene),
            applied=applied_arrows(scene),
            key=key(scene),
            short=short,
            clipped=clipped,
            shown=shown,
            bar=_bar(scene, results.units),
            rows=rows(scene, shown),
            drives=drives,
            strips=_strips(scene, drives, shown, results.units),
            speeds=speeds(motion.time),
            data=script_json(data),
        )
    )


def _matched(table: ReactionTable, motion: LinkageMotion) -> ReactionTable | None:
    """Return the table in the order of the linkage's connections; None when some are missing."""
    names = [name for name, _, _ in motion.connections]
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
    time, at = scene.motion.time, scene.instants
    if time is None or len(at) < 2:
        return []
    strips = []
    if scene.table is not None and scene.tails:
        curves = list(scene.table.magnitudes[at].T)
        colours = [scene.colour(body) for _, body, _ in scene.motion.connections]
        title = f"forces on the pins [{shown.force.unit}]"
        note = f"time [{units.time}]"
        strips.append(strip(title, note, 122.0, time[at], curves, colours, shown.force.factor))
    for d, (_, force) in zip(drives, shown.drives, strict=True):
        title = f"drive {d.name}: {'torque' if d.kind == 'rotary' else 'force'} [{force.unit}]"
        note = f"mean {force(d.mean)}, RMS {force(d.rms)}"
        strips.append(strip(title, note, 82.0, time[at], [d.force[at]], ["plain"], force.factor))
    return strips

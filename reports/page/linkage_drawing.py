"""A linkage at an instant as an SVG drawing, with its applied forces and marks at its joints.

A planar linkage has one panel, in its plane. A linkage in space has an isometric view with all
labels, and below it views from the front, the right and above at one scale, with the names of the
marks.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from html import escape

import numpy as np

from pinbase.dimensions import Floats
from reports.format.drawing.projection import PLANE, Projection, isometric, three_views
from reports.format.drawing.svg_labels import label_offsets
from reports.format.numbers import engineering
from reports.page.linkage_panel import Instant, LinkagePanel, Mark, Points
from reports.page.linkage_parts import (
    LoadArrow,
    axes,
    bodies,
    draw_arrow,
    forces_at,
    levers,
    load_arrows,
    pitches,
    sides,
    sliders,
    springs,
    support,
    support_foot,
    triad,
)

PICTURE_WIDTH, MIN_HEIGHT, MAX_HEIGHT = 410.0, 170.0, 470.0
MARGIN = 50.0  # room for names, supports and arrows
LETTER, LABEL_GAP = (7.6, 16.0), 11.0  # mean width and height of a letter
# The three views have smaller letters and symbols.
VIEW_HEIGHTS, VIEW_MARGIN, VIEW_TITLE_HEIGHT = (90.0, 210.0), 26.0, 18.0
VIEW_LETTER, VIEW_SYMBOL_SCALE = (6.5, 12.0), 0.62
MAX_ISOMETRIC_HEIGHT = 330.0
TRIAD_MARGIN = 34.0  # between the axes and the edges of a panel


def draw_linkage(
    at: Instant, marks: Sequence[Mark], title: str, unit: str, length: str = ""
) -> str:
    """Return the drawing as an <svg> element, in which all text is escaped.

    Links are as wide as their forces. Joints are rings, fixed joints have a triangle, and arrows
    point at the places where forces act.
    marks: the most important first.
    unit: of forces.
    length: the unit of length; with `unit` it gives that of couples.
    Colours are in reports/templates/linkage.css.
    """
    marks = [mark for mark in marks if mark.joint in at.skeleton.joints]
    if at.skeleton.flat:
        panel = LinkagePanel.of(at, PLANE, PICTURE_WIDTH, (MIN_HEIGHT, MAX_HEIGHT), MARGIN)
        parts, height = [*_panel(at, panel, marks, (unit, length))], panel.size[1]
    else:
        parts, height = _in_space(at, marks, (unit, length))
    role = "group" if any("<a " in mark.symbol for mark in marks) else "img"
    return (
        f'<svg class="linkage" viewBox="0 0 {PICTURE_WIDTH:.0f} {height:.0f}" role="{role}" '
        f'xmlns="http://www.w3.org/2000/svg" aria-label="{escape(title)}">{"".join(parts)}</svg>'
    )


def _panel(
    at: Instant, panel: LinkagePanel, marks: Sequence[Mark], units: tuple[str, str]
) -> Iterable[str]:
    """Yield the parts of a view with all its labels."""
    arrows, points = load_arrows(at, panel), panel.joints(at)
    yield from _shapes(at, panel, points, arrows)
    yield from (_symbol(mark, points) for mark in reversed(marks))
    yield from _labels(at, _told(at, marks, points, arrows, units), points, panel, arrows)


def _shapes(
    at: Instant, panel: LinkagePanel, points: Points, arrows: Sequence[LoadArrow]
) -> Iterable[str]:
    """Yield all parts that are not text or marks."""
    yield from bodies(at, panel, points)
    yield from sliders(at, panel)
    yield from pitches(at, panel)
    yield from springs(at, panel)
    yield from levers(at, panel, points)
    yield from (
        support(points[name], panel.symbol) for name in at.skeleton.ground if name in points
    )
    yield from axes(at, panel, points)
    for x, y in points.values():
        yield f'<circle class="joint" cx="{x:.1f}" cy="{y:.1f}" r="3.6"/>'
    yield from map(draw_arrow, arrows)


def _in_space(
    at: Instant, marks: Sequence[Mark], units: tuple[str, str]
) -> tuple[list[str], float]:
    """Return the parts of the isometric view and of the three views below it, and the height in
    pixels.
    """
    up = at.skeleton.up
    panel = LinkagePanel.of(
        at, isometric(up), PICTURE_WIDTH, (MIN_HEIGHT, MAX_ISOMETRIC_HEIGHT), MARGIN
    )
    parts = [*triad(panel, _emptiest_corner(at, panel)), *_panel(at, panel, marks, units)]
    views = three_views(up)
    width = PICTURE_WIDTH / len(views)
    panels = [LinkagePanel.of(at, view, width, VIEW_HEIGHTS, VIEW_MARGIN) for view in views]
    scale = min(one.scale for one in panels)
    height = max(one.size[1] * scale / one.scale for one in panels)
    height = max(height, VIEW_HEIGHTS[0])
    top = panel.size[1] + VIEW_TITLE_HEIGHT
    for k, one in enumerate(panels):
        same = replace(one, scale=scale, size=(width, height), symbol=VIEW_SYMBOL_SCALE)
        place = f"translate({k * width:.1f} {top:.1f})"
        parts += [f'<g class="view" transform="{place}">', *_view(at, same, marks), "</g>"]
    return parts, top + height


def _view(at: Instant, panel: LinkagePanel, marks: Sequence[Mark]) -> Iterable[str]:
    """Yield the parts of one of the three views."""
    arrows, points = load_arrows(at, panel), panel.joints(at)
    middle = 0.5 * panel.size[0]
    yield f'<text class="view-title" x="{middle:.1f}" y="-5">{_title(panel.view)}</text>'
    yield from _shapes(at, panel, points, arrows)
    yield from (_symbol(mark, points, panel.symbol) for mark in reversed(marks))
    names = [(points[mark.joint], mark.name, "") for mark in marks]
    yield from _labels(at, names, points, panel, arrows)


def _title(view: Projection) -> str:
    """Return the name of a view along an axis, and the axes that it shows."""
    axes_shown = [
        f"{'−' if sum(axis) < 0.0 else ''}{'xyz'[int(np.argmax(np.abs(axis)))]}"
        for axis in (view.right, view.up)
    ]
    return f"{view.name} ({', '.join(axes_shown)})"


def _emptiest_corner(at: Instant, panel: LinkagePanel) -> Floats:
    """Return the corner of a panel that is farthest from all joints, pixels (2,)."""
    (width, height), m = panel.size, TRIAD_MARGIN
    corners = np.array([[m, height - m], [width - m, height - m], [m, m], [width - m, m]])
    joints = panel.pixels(at.skeleton.position[at.k])
    away = np.linalg.norm(corners[:, None] - joints, axis=-1).min(axis=1)
    return np.asarray(corners[int(np.argmax(away))])


def _symbol(mark: Mark, points: Points, scale: float = 1.0) -> str:
    x, y = points[mark.joint]
    smaller = "" if scale == 1.0 else f" scale({scale:g})"
    return mark.symbol and f'<g transform="translate({x:.1f} {y:.1f}){smaller}">{mark.symbol}</g>'


Told = list[tuple[Floats, str, str]]  # labels: point (2,), bold text, other text


def _told(
    at: Instant,
    marks: Sequence[Mark],
    points: Points,
    arrows: Sequence[LoadArrow],
    units: tuple[str, str],
) -> Told:
    """Return the labels of the marks, of applied loads, and of forces on the ground.

    units: of force and of length.
    """
    unit, couple_unit = units[0], "·".join(units)
    told: Told = [(points[mark.joint], mark.name, mark.words) for mark in marks]
    told += [(points[joint], "", f"{force} {unit}") for joint, force in _on_ground(at)]
    told += [
        (arrow.tail, "", f"{engineering(arrow.size)} {couple_unit if arrow.couple else unit}")
        for arrow in arrows
    ]
    return told


def _labels(
    at: Instant,
    told: Told,
    points: Points,
    panel: LinkagePanel,
    arrows: Sequence[LoadArrow],
) -> Iterable[str]:
    """Yield the labels, placed where they hide least."""
    if not told:
        return
    skeleton = at.skeleton
    where = np.array([point for point, *_ in told])
    texts = [f"{name} {rest}".strip() for _, name, rest in told]
    wide, high = LETTER if panel.symbol == 1.0 else VIEW_LETTER
    sizes = np.array([[wide * len(text), high] for text in texts])
    lines = [[points[a], points[b]] for joints in skeleton.links for a, b in sides(joints)]
    lines += [list(panel.pixels(ends[at.k])) for ends in skeleton.slides.values()]
    lines += [list(panel.pixels(ends[at.k])) for ends in skeleton.springs.values()]
    lines += [[arrow.tail, arrow.tip] for arrow in arrows]
    lines += [support_foot(points[name], panel.symbol) for name in skeleton.ground]
    hidden = np.array(lines or [[where[0], where[0]]])[None]
    offsets = label_offsets(where[None], sizes, hidden, panel.symbol * LABEL_GAP, panel.size)
    for (x, y), (_, name, rest) in zip(where + offsets, told, strict=True):
        bold = f'<tspan class="b">{escape(name)}</tspan>' if name else ""
        kind = "" if name else ' class="force"'
        yield (
            f'<text{kind} x="{x:.1f}" y="{y + 5.0:.1f}" text-anchor="middle">'
            f"{f'{bold} {escape(rest)}'.strip()}</text>"
        )


def _on_ground(at: Instant) -> Iterable[tuple[str, str]]:
    """Yield each fixed joint with the magnitude of the force that the links exert on the ground
    there.
    """
    if at.table is None:
        return
    now = forces_at(at.table, at.k)
    for joint in at.skeleton.ground:
        here = [
            c for c, (_, _, of) in enumerate(at.skeleton.connections)
            if of == joint and c < len(now)
        ]  # fmt: skip
        size = float(np.linalg.norm(now[here].sum(axis=0)))
        if size > 0.0:
            yield joint, engineering(size, 3)

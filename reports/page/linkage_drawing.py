"""The linkage at the governing instant with its pins, coloured and named by their factors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise

import numpy as np

from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, NOT_DECIDED, SAFE, YIELDS
from reports.data.overview import PinLine
from reports.data.results import Floats, LinkageMotion, ReactionTable, Results
from reports.format.drawing.svg_labels import label_offsets
from reports.format.numbers import engineering
from reports.format.ranges import factor_range

PICTURE_WIDTH, MIN_HEIGHT, MAX_HEIGHT = 400.0, 200.0, 470.0
MARGIN = 42.0
LETTER_WIDTH, LABEL_HEIGHT, PIN_LABEL_GAP = 7.6, 16.0, 11.0
PIN_RADIUS, LOAD_LENGTH = 9.0, 34.0
MIN_LINK_WIDTH, MAX_LINK_WIDTH = 1.5, 12.0
MARKS = {  # of an outcome: a cross, a tick, half a disc, a question mark
    FAILS: '<circle r="9"/><path class="k" d="M-4-4L4 4M4-4L-4 4"/>',
    SAFE: '<circle r="8.5" class="h"/><path d="M-4 0l3 4l5-8"/>',
    DEPENDS: '<circle r="8.5" class="h"/><path class="hf" d="M0-8.5a8.5 8.5 0 0 0 0 17z"/>',
    NOT_DECIDED: '<circle r="8.5" class="h"/><path d="M-2.5-2.5a2.7 2.7 0 1 1 3.5 2.5q-1 .5-1 '
    '1.8M0 4.4v.6"/>',
}
MARKS |= {YIELDS: MARKS[FAILS], BELOW_YIELD: MARKS[SAFE]}


@dataclass(frozen=True)
class GoverningInstant:
    """The linkage of a case at an instant.

    k: number of the instant.
    """

    motion: LinkageMotion
    table: ReactionTable | None
    k: int


def governing_instant(results: Results, lines: Sequence[PinLine]) -> GoverningInstant | None:
    """Return the linkage in the case and at the instant of the worst pin; None without one."""
    for line in lines:
        motion = next((m for m in results.motion if m.case == line.row.case), None)
        if motion is None:
            continue
        table = next((t for t in results.reactions if t.case == line.row.case), None)
        k = 0
        if motion.time is not None and line.row.time is not None:
            k = int(np.argmin(np.abs(motion.time - line.row.time)))
        return GoverningInstant(motion, table, k)
    return None


def draw_linkage(
    results: Results, lines: Sequence[PinLine], anchors: Mapping[str, str]
) -> str | None:
    """Return the drawing as an <svg> element, in which all text is escaped; None without a linkage.

    anchors: of the pins' parts of the page.
    """
    at = governing_instant(results, lines)
    if at is None:
        return None
    frame = _Frame(at)
    points = dict(zip(at.motion.joints, frame.pixels(at.motion.joint_position[at.k]), strict=True))
    joints = _joints_of_pins(at)
    parts = [
        *_bodies(at, points),
        *_sliders(at, frame),
        *(_support(points[name]) for name in at.motion.ground if name in points),
        *(_arrow(tip, tail) for tip, tail, _ in _loads(at, frame)),
        *_pins(lines, joints, points, anchors),
        *_labels(at, lines, joints, points, frame, results.units.force),
    ]
    label = f"Linkage in case {at.motion.case}; each pin with its factor of safety"
    size = f"0 0 {PICTURE_WIDTH:.0f} {frame.height:.0f}"
    return (
        f'<svg class="linkage" viewBox="{size}" role="group" aria-label="{escape(label)}">'
        f"{''.join(parts)}</svg>"
    )


class _Frame:
    """The picture, with one scale in both directions."""

    def __init__(self, at: GoverningInstant) -> None:
        ends = [slide[at.k] for slide in at.motion.slides.values()]
        ends += [load.position[min(at.k, len(load.position) - 1)] for load in at.motion.applied]
        points = [at.motion.joint_position[at.k], *(np.reshape(end, (-1, 2)) for end in ends)]
        every = np.concatenate(points)
        low, high = every.min(axis=0), every.max(axis=0)
        span = np.maximum(high - low, 1e-9 * (1.0 + np.abs(high).max()))
        room = PICTURE_WIDTH - 2.0 * MARGIN, MAX_HEIGHT - 2.0 * MARGIN
        self.scale = min(room[0] / span[0], room[1] / span[1])
        self.height = max(self.scale * float(span[1]) + 2.0 * MARGIN, MIN_HEIGHT)
        self._middle = 0.5 * (low + high)

    def pixels(self, points: Floats) -> Floats:
        """Return the pixels (.., 2) of points (.., 2), y downwards."""
        away = (points - self._middle) * self.scale * np.array([1.0, -1.0])
        return np.asarray(away + 0.5 * np.array([PICTURE_WIDTH, self.height]))


def _joints_of_pins(at: GoverningInstant) -> dict[str, str]:
    """Return the joint at which each pin sits."""
    if at.table is None:
        return {}
    by_connection = {name: joint for name, _, joint in at.motion.connections}
    return {
        pin: by_connection[connection]
        for connection, pin in zip(at.table.connections, at.table.pins, strict=True)
        if connection in by_connection
    }


def _forces(at: GoverningInstant) -> Floats:
    """Return the magnitudes (C,) of the forces at the connections."""
    table = at.table
    if table is None:
        return np.zeros(0)
    forces = table.forces.reshape(-1, *table.forces.shape[-2:])
    return np.asarray(np.linalg.norm(forces[min(at.k, len(forces) - 1)], axis=-1))


def _widths(at: GoverningInstant) -> dict[tuple[str, str], float]:
    """Return the width of a body's line at each of its joints, by the force there."""
    ends = [(body, joint) for _, body, joint in at.motion.connections]
    forces = dict(zip(ends, _forces(at).tolist(), strict=False))
    most = max(forces.values(), default=0.0) or 1.0
    spread = MAX_LINK_WIDTH - MIN_LINK_WIDTH
    return {end: MIN_LINK_WIDTH + spread * force / most for end, force in forces.items()}


def _bodies(at: GoverningInstant, points: Mapping[str, Floats]) -> Iterable[str]:
    """Yield bodies with more than two joints as areas, and each side as wide as the smaller of the
    forces at its ends.
    """
    widths = _widths(at)
    for body, joints in zip(at.motion.bodies, at.motion.links, strict=True):
        if len(joints) > 2:
            path = "L".join(f"{points[name][0]:.1f} {points[name][1]:.1f}" for name in joints)
            yield f'<path class="body" d="M{path}Z"><title>{escape(body)}</title></path>'
        sides = [*pairwise(joints), *([(joints[-1], joints[0])] if len(joints) > 2 else [])]
        for one, other in sides:
            known = [widths[body, name] for name in (one, other) if (body, name) in widths]
            width = min(known, default=MIN_LINK_WIDTH)
            (x1, y1), (x2, y2) = points[one], points[other]
            yield (
                f'<path class="link" d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}" '
                f'stroke-width="{width:.1f}"><title>{escape(body)}</title></path>'
            )


def _sliders(at: GoverningInstant, frame: _Frame) -> Iterable[str]:
    for ends in at.motion.slides.values():
        (x1, y1), (x2, y2) = frame.pixels(ends[at.k])
        yield f'<path class="slide" d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}"/>'


def _loads(at: GoverningInstant, frame: _Frame) -> list[tuple[Floats, Floats, float]]:
    """Return the tip and the tail of the arrow of each applied load, and its size."""
    arrows = []
    for load in at.motion.applied:
        k = min(at.k, len(load.force) - 1)
        size = float(load.sizes[k])
        if size > 0.0:
            along = load.force[k] / size * np.array([1.0, -1.0])
            tip = frame.pixels(load.position[k]) - (PIN_RADIUS + 3.0) * along
            arrows.append((tip, tip - LOAD_LENGTH * along, size))
    return arrows


def _arrow(tip: Floats, tail: Floats) -> str:
    """Return the arrow of an applied load."""
    along = (tip - tail) / np.linalg.norm(tip - tail)
    across = np.array([-along[1], along[0]])
    neck = tip - 9.0 * along
    head = [tip, neck + 6.0 * across, neck - 6.0 * across]
    corners = "L".join(f"{x:.1f} {y:.1f}" for x, y in head)
    (x1, y1), (x2, y2) = tail, neck
    return (
        f'<path class="load" d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}"/>'
        f'<path class="head" d="M{corners}Z"/>'
    )


def _support(at: Floats) -> str:
    """Return the triangle of a fixed joint."""
    x, y = at
    return f'<path class="ground" d="M{x:.1f} {y:.1f}l-11 19h22zM{x - 16:.1f} {y + 19:.1f}h32"/>'


def _pins(
    lines: Sequence[PinLine],
    joints: Mapping[str, str],
    points: Mapping[str, Floats],
    anchors: Mapping[str, str],
) -> Iterable[str]:
    for line in reversed(lines):
        if line.pin in joints:
            x, y = points[joints[line.pin]]
            outcome = line.outcome.replace(" ", "-")
            mark = (
                f'<g class="pin {outcome}" transform="translate({x:.1f} {y:.1f})">'
                f"<title>{escape(line.pin)}: {escape(line.outcome)}</title>"
                f"{MARKS[line.outcome]}</g>"
            )
            anchor = anchors.get(line.pin)
            yield f'<a href="#{escape(anchor)}">{mark}</a>' if anchor else mark


def _labels(
    at: GoverningInstant,
    lines: Sequence[PinLine],
    joints: Mapping[str, str],
    points: Mapping[str, Floats],
    frame: _Frame,
    unit: str,
) -> Iterable[str]:
    """Yield names and factors of the pins, and the forces on the ground at its joints."""
    told: list[tuple[Floats, str, str]] = []
    for line in lines:
        if line.pin in joints:
            factor = factor_range(line.row) if line.row.safety_factor else ""
            told.append((points[joints[line.pin]], line.pin, factor))
    told += [(points[joint], "", f"{force} {unit}") for joint, force in _on_ground(at)]
    told += [(tail, "", f"{engineering(size, 3)} {unit}") for _, tail, size in _loads(at, frame)]
    if not told:
        return
    where = np.array([point for point, *_ in told])
    texts = [f"{name} {rest}".strip() for _, name, rest in told]
    sizes = np.array([[LETTER_WIDTH * len(text), LABEL_HEIGHT] for text in texts])
    segments = [
        [points[one], points[other]] for names in at.motion.links for one, other in pairwise(names)
    ]
    ends = np.array(segments or [[where[0], where[0]]])[None]
    offsets = label_offsets(where[None], sizes, ends, PIN_LABEL_GAP, (PICTURE_WIDTH, frame.height))
    for (x, y), (_, name, rest) in zip(where + offsets, told, strict=True):
        bold = f'<tspan class="b">{escape(name)}</tspan> ' if name else ""
        kind = "" if name else ' class="force"'
        yield (
            f'<text{kind} x="{x:.1f}" y="{y + 5.0:.1f}" text-anchor="middle">{bold}'
            f"{escape(rest)}</text>"
        )


def _on_ground(at: GoverningInstant) -> Iterable[tuple[str, str]]:
    """Yield the fixed joints with the size of the force that links pass to the ground there."""
    table = at.table
    if table is None:
        return
    forces = table.forces.reshape(-1, *table.forces.shape[-2:])
    now = forces[min(at.k, len(forces) - 1)]
    for joint in at.motion.ground:
        here = [
            c for c, (_, _, of) in enumerate(at.motion.connections)
            if of == joint and c < len(now)
        ]  # fmt: skip
        if here:
            size = float(np.linalg.norm(now[here].sum(axis=0)))
            if size > 0.0:
                yield joint, f"{engineering(size, 3)}"

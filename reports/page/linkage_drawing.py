"""A linkage at an instant as an SVG drawing, with its applied forces and marks at its joints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise

import numpy as np

from reports.data.results import Floats, LinkageMotion, ReactionTable
from reports.format.drawing.svg_labels import label_offsets
from reports.format.numbers import engineering

PICTURE_WIDTH, MIN_HEIGHT, MAX_HEIGHT = 410.0, 170.0, 470.0
MARGIN = 50.0  # for names, supports and arrows
LETTER_WIDTH, LABEL_HEIGHT, LABEL_GAP = 7.6, 16.0, 11.0
ARROW_CLEARANCE = 12.0  # between the tip of an arrow and the place where its force acts
ARROW_LENGTHS = (22.0, 38.0)  # of the smallest and the largest force
MIN_LINK_WIDTH, MAX_LINK_WIDTH = 1.5, 12.0
PLAIN_LINK_WIDTH = 2.2  # where no force is shown

Points = Mapping[str, Floats]  # pixels (2,) by joint


@dataclass(frozen=True)
class Instant:
    """A linkage at an instant.

    k: number of the instant. table: the forces at its connections, where they are shown.
    """

    motion: LinkageMotion
    k: int
    table: ReactionTable | None = None


@dataclass(frozen=True)
class Mark:
    """A label at a joint, and what is drawn there.

    name: in bold. words: after it. symbol: an SVG element about the origin, in which all text is
    escaped.
    """

    joint: str
    name: str
    words: str = ""
    symbol: str = ""


def draw_linkage(at: Instant, marks: Sequence[Mark], title: str, unit: str) -> str:
    """Return the drawing as an <svg> element, in which all text is escaped.

    Links are as wide as their forces, joints rings, those of the ground with a triangle; arrows
    point at the places where forces act.
    marks: the most important first. unit: of forces. Colours: reports/templates/linkage.css.
    """
    frame = _Frame(at)
    joints = frame.pixels(at.motion.joint_position[at.k])
    points = dict(zip(at.motion.joints, joints, strict=True))
    marks = [mark for mark in marks if mark.joint in points]
    arrows = _arrows(at, frame)
    parts = [
        *_bodies(at, points),
        *_sliders(at, frame),
        *_pitches(at, frame),
        *_levers(at, frame, points),
        *(_support(points[name]) for name in at.motion.ground if name in points),
        *(f'<circle class="joint" cx="{x:.1f}" cy="{y:.1f}" r="3.6"/>' for x, y in joints),
        *(_arrow(tip, tail) for tip, tail, _ in arrows),
        *(_symbol(mark, points) for mark in reversed(marks)),
        *_labels(at, marks, points, arrows, frame, unit),
    ]
    role = "group" if any("<a " in mark.symbol for mark in marks) else "img"
    return (
        f'<svg class="linkage" viewBox="0 0 {PICTURE_WIDTH:.0f} {frame.height:.0f}" role="{role}" '
        f'xmlns="http://www.w3.org/2000/svg" aria-label="{escape(title)}">{"".join(parts)}</svg>'
    )


class _Frame:
    """The picture, with one scale in both directions."""

    def __init__(self, at: Instant) -> None:
        motion, k = at.motion, at.k
        parts = [motion.joint_position[k], *(ends[k] for ends in motion.slides.values())]
        parts += [load.position[min(k, len(load.position) - 1)] for load in motion.applied]
        box = np.array([[-1.0, -1.0], [1.0, 1.0]])
        parts += [c.ends[k][:1] + c.radius * box if c.round else c.ends[k] for c in motion.pitch]
        every = np.concatenate([np.reshape(part, (-1, 2)) for part in parts])
        low, high = every.min(axis=0), every.max(axis=0)
        span = np.maximum(high - low, 1e-9 * (1.0 + np.abs(high).max()))
        room = PICTURE_WIDTH - 2.0 * MARGIN, MAX_HEIGHT - 2.0 * MARGIN
        self.scale = float(min(room[0] / span[0], room[1] / span[1]))
        self.height = max(self.scale * float(span[1]) + 2.0 * MARGIN, MIN_HEIGHT)
        self._middle = 0.5 * (low + high)

    def pixels(self, points: Floats) -> Floats:
        """Return the pixels (.., 2) of points (.., 2), y downwards."""
        away = (points - self._middle) * self.scale * np.array([1.0, -1.0])
        return np.asarray(away + 0.5 * np.array([PICTURE_WIDTH, self.height]))


def _widths(at: Instant) -> dict[tuple[str, str], float]:
    """Return the width of a body's line at each of its joints, by the force there."""
    if at.table is None:
        return {}
    sizes = np.linalg.norm(_forces(at.table, at.k), axis=-1)
    ends = [(body, joint) for _, body, joint in at.motion.connections]
    forces = dict(zip(ends, sizes.tolist(), strict=False))
    most = max(forces.values(), default=0.0) or 1.0
    spread = MAX_LINK_WIDTH - MIN_LINK_WIDTH
    return {end: MIN_LINK_WIDTH + spread * force / most for end, force in forces.items()}


def _forces(table: ReactionTable, k: int) -> Floats:
    """Return the forces (C, 2 or 3) at the connections at an instant."""
    forces = table.forces.reshape(-1, *table.forces.shape[-2:])
    return np.asarray(forces[min(k, len(forces) - 1)])


def _sides(joints: Sequence[str]) -> list[tuple[str, str]]:
    """Return the sides of a body, from joint to joint."""
    return [*pairwise(joints), *([(joints[-1], joints[0])] if len(joints) > 2 else [])]


def _bodies(at: Instant, points: Points) -> Iterable[str]:
    """Yield bodies with more than two joints as areas, and each side as wide as the smaller of the
    forces at its ends.
    """
    widths = _widths(at)
    for body, joints in zip(at.motion.bodies, at.motion.links, strict=True):
        if len(joints) > 2:
            path = "L".join(f"{points[name][0]:.1f} {points[name][1]:.1f}" for name in joints)
            yield f'<path class="body" d="M{path}Z"><title>{escape(body)}</title></path>'
        for one, other in _sides(joints):
            known = [widths[body, name] for name in (one, other) if (body, name) in widths]
            width = min(known, default=PLAIN_LINK_WIDTH)
            line = _line("link", points[one], points[other], f' stroke-width="{width:.1f}"')
            yield line.replace("/>", f"><title>{escape(body)}</title></path>")


def _line(kind: str, start: Floats, end: Floats, more: str = "") -> str:
    (x1, y1), (x2, y2) = start, end
    return f'<path class="{kind}" d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}"{more}/>'


def _sliders(at: Instant, frame: _Frame) -> Iterable[str]:
    for ends in at.motion.slides.values():
        yield _line("slide", *frame.pixels(ends[at.k]))


def _pitches(at: Instant, frame: _Frame) -> Iterable[str]:
    """Yield the pitch circles of gears and the lines of racks."""
    for curve in at.motion.pitch:
        start, end = frame.pixels(curve.ends[at.k])
        if curve.round:
            size = f'cx="{start[0]:.1f}" cy="{start[1]:.1f}" r="{frame.scale * curve.radius:.1f}"'
            yield f'<circle class="pitch" {size}/>'
        else:
            yield _line("pitch", start, end)


def _levers(at: Instant, frame: _Frame, points: Points) -> Iterable[str]:
    """Yield a line from every force to the nearest joint of the body on which it acts."""
    for load in at.motion.applied:
        joints = at.motion.links[at.motion.bodies.index(load.body)]
        acting = frame.pixels(load.position[min(at.k, len(load.position) - 1)])
        away = [points[joint] - acting for joint in joints]
        nearest = min(away, key=lambda d: float(np.hypot(*d)), default=np.zeros(2))
        if nearest.any():
            yield _line("lever", acting + nearest, acting)


def _support(at: Floats) -> str:
    """Return the triangle of a fixed joint."""
    x, y = at
    return f'<path class="ground" d="M{x:.1f} {y:.1f}l-11 19h22zM{x - 16:.1f} {y + 19:.1f}h32"/>'


def _arrows(at: Instant, frame: _Frame) -> list[tuple[Floats, Floats, float]]:
    """Return the tip and the tail of the arrow of each applied force, and its size."""
    loads = [(load, min(at.k, len(load.force) - 1)) for load in at.motion.applied]
    largest = max((float(load.sizes[k]) for load, k in loads), default=0.0)
    short, long = ARROW_LENGTHS
    arrows = []
    for load, k in loads:
        size = float(load.sizes[k])
        if size > 0.0:
            along = load.force[k] / size * np.array([1.0, -1.0])
            tip = frame.pixels(load.position[k]) - ARROW_CLEARANCE * along
            arrows.append((tip, tip - (short + (long - short) * size / largest) * along, size))
    return arrows


def _arrow(tip: Floats, tail: Floats) -> str:
    along = (tip - tail) / np.linalg.norm(tip - tail)
    across = np.array([-along[1], along[0]])
    neck = tip - 9.0 * along
    head = [tip, neck + 6.0 * across, neck - 6.0 * across]
    corners = "L".join(f"{x:.1f} {y:.1f}" for x, y in head)
    return _line("load", tail, neck) + f'<path class="head" d="M{corners}Z"/>'


def _symbol(mark: Mark, points: Points) -> str:
    x, y = points[mark.joint]
    return mark.symbol and f'<g transform="translate({x:.1f} {y:.1f})">{mark.symbol}</g>'


def _labels(
    at: Instant,
    marks: Sequence[Mark],
    points: Points,
    arrows: Sequence[tuple[Floats, Floats, float]],
    frame: _Frame,
    unit: str,
) -> Iterable[str]:
    """Yield the labels of the marks, of applied forces, and of forces on the ground, where they
    hide least.
    """
    told = [(points[mark.joint], mark.name, mark.words) for mark in marks]
    told += [(points[joint], "", f"{force} {unit}") for joint, force in _on_ground(at)]
    told += [(tail, "", f"{engineering(size)} {unit}") for _, tail, size in arrows]
    if not told:
        return
    where = np.array([point for point, *_ in told])
    texts = [f"{name} {rest}".strip() for _, name, rest in told]
    sizes = np.array([[LETTER_WIDTH * len(text), LABEL_HEIGHT] for text in texts])
    lines = [[points[a], points[b]] for joints in at.motion.links for a, b in _sides(joints)]
    lines += [list(frame.pixels(ends[at.k])) for ends in at.motion.slides.values()]
    hidden = np.array(lines or [[where[0], where[0]]])[None]
    offsets = label_offsets(where[None], sizes, hidden, LABEL_GAP, (PICTURE_WIDTH, frame.height))
    for (x, y), (_, name, rest) in zip(where + offsets, told, strict=True):
        bold = f'<tspan class="b">{escape(name)}</tspan>' if name else ""
        kind = "" if name else ' class="force"'
        yield (
            f'<text{kind} x="{x:.1f}" y="{y + 5.0:.1f}" text-anchor="middle">'
            f"{f'{bold} {escape(rest)}'.strip()}</text>"
        )


def _on_ground(at: Instant) -> Iterable[tuple[str, str]]:
    """Yield the fixed joints with the size of the force that links pass to the ground there."""
    if at.table is None:
        return
    now = _forces(at.table, at.k)
    for joint in at.motion.ground:
        here = [
            c for c, (_, _, of) in enumerate(at.motion.connections)
            if of == joint and c < len(now)
        ]  # fmt: skip
        size = float(np.linalg.norm(now[here].sum(axis=0)))
        if size > 0.0:
            yield joint, engineering(size, 3)

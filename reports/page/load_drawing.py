"""A linkage with the forces that a case applies to it, as an SVG drawing."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape

import numpy as np

from reports.data.mechanics import LinkageMotion
from reports.data.results import Floats, Units
from reports.format.drawing.svg import INK_COLOUR, text, wide
from reports.format.drawing.svg_labels import label_offsets
from reports.format.numbers import engineering

WIDTH, MIN_HEIGHT, MAX_HEIGHT = 480.0, 120.0, 420.0
MARGIN = 56.0  # for names and arrows
LABEL_HEIGHT, LABEL_GAP = 13.0, 7.0
ARROW_LENGTHS = (22.0, 46.0)  # of the smallest and the largest force
LINK_COLOUR, FORCE_COLOUR, GROUND_COLOUR = "#3b6fb6", "#b3261e", "#555555"


def draw_loads(motion: LinkageMotion, units: Units) -> str:
    """Return the linkage as an <svg> element, at the instant of the largest applied force.

    Links are lines or polygons, joints rings, those of the ground with a triangle; arrows point at
    the places where forces act.
    """
    k = _instant(motion)
    frame = _Frame(motion, k)
    at = dict(zip(motion.joints, frame(motion.joint_position[k]), strict=True))
    parts = [
        f'<svg class="linkage" viewBox="0 0 {WIDTH:.0f} {frame.height:.0f}" role="img" '
        f'xmlns="http://www.w3.org/2000/svg" font-size="11" font-family="sans-serif">'
        f"<title>{escape(f'The linkage in case {motion.case}, with its applied forces')}</title>",
        *(_path([at[j] for j in joints], len(joints) > 2) for joints in motion.links if joints),
        *(_path(list(frame(ends[k])), False, 4.0) for ends in motion.slides.values()),
        *(_pitch(frame, curve.ends[k], curve.round) for curve in motion.pitch),
        *(_joint(point, name in motion.ground) for name, point in at.items()),
    ]
    arrows = _arrows(motion, k, frame)
    parts += _levers(motion, k, frame, at)
    parts += [_arrow(tail, tip) for tail, tip, _ in arrows]
    parts += _names(motion, k, frame, at, [(tail, f"{engineering(size)} {units.force}")
                                           for tail, _, size in arrows])  # fmt: skip
    return "".join(parts) + "</svg>"


def _instant(motion: LinkageMotion) -> int:
    sizes = sum((force.sizes for force in motion.applied), np.zeros(len(motion.condition)))
    return int(np.argmax(sizes))


class _Frame:
    """The scale of the drawing, the same in both directions."""

    def __init__(self, motion: LinkageMotion, k: int) -> None:
        parts = [motion.joint_position[k], *(ends[k] for ends in motion.slides.values())]
        parts += [force.position[k][None] for force in motion.applied]
        box = np.array([[-1.0, -1.0], [1.0, 1.0]])
        parts += [c.ends[k][:1] + c.radius * box if c.round else c.ends[k] for c in motion.pitch]
        points = np.concatenate([np.asarray(p).reshape(-1, 2) for p in parts])
        low, high = points.min(axis=0), points.max(axis=0)
        span = np.maximum(high - low, 1e-9 * max(float((high - low).max()), 1.0))
        room = (WIDTH - 2.0 * MARGIN, MAX_HEIGHT - 2.0 * MARGIN)
        self.scale = float(min(room[0] / span[0], room[1] / span[1]))
        self.height = max(self.scale * float(span[1]) + 2.0 * MARGIN, MIN_HEIGHT)
        self.middle = 0.5 * (low + high)

    def __call__(self, points: Floats) -> Floats:
        """Return the pixels (.., 2) of points (.., 2), y downwards."""
        x, y = np.moveaxis(self.scale * (np.asarray(points) - self.middle), -1, 0)
        return np.stack([0.5 * WIDTH + x, 0.5 * self.height - y], axis=-1)


def _path(points: list[Floats], closed: bool, width: float = 2.2) -> str:
    if len(points) < 2:
        return ""
    ends = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    kind, fill = ("polygon", f"{LINK_COLOUR}22") if closed else ("polyline", "none")
    return (
        f'<{kind} points="{ends}" fill="{fill}" stroke="{LINK_COLOUR}" stroke-width="{width}" '
        'stroke-linejoin="round" stroke-linecap="round"/>'
    )


def _pitch(frame: _Frame, ends: Floats, is_round: bool) -> str:
    """Return a gear's pitch circle or a rack's line."""
    if not is_round:
        return _path(list(frame(ends)), False, 1.2)
    (x, y), radius = frame(ends[0]), frame.scale * float(np.linalg.norm(ends[1] - ends[0]))
    return (
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" fill="none" '
        f'stroke="{LINK_COLOUR}" stroke-width="1.2"/>'
    )


def _joint(at: Floats, fixed: bool) -> str:
    x, y = at
    ring = (
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.6" fill="#fff" stroke="{INK_COLOUR}" '
        'stroke-width="1.4"/>'
    )
    if not fixed:
        return ring
    corners = f"{x:.1f},{y:.1f} {x - 8:.1f},{y + 13:.1f} {x + 8:.1f},{y + 13:.1f}"
    return f'<polygon points="{corners}" fill="{GROUND_COLOUR}" opacity="0.45"/>{ring}'


def _arrows(motion: LinkageMotion, k: int, frame: _Frame) -> list[tuple[Floats, Floats, float]]:
    """Return the tail, the tip and the size of every applied force."""
    forces = [(frame(f.position[k]), f.force[k] * (1.0, -1.0), f.sizes[k]) for f in motion.applied]
    largest = max((size for *_, size in forces), default=0.0)
    short, long = ARROW_LENGTHS
    return [
        (tip - force / size * (short + (long - short) * size / largest), tip, float(size))
        for tip, force, size in forces
        if size > 0.0
    ]


def _levers(motion: LinkageMotion, k: int, frame: _Frame, at: dict[str, Floats]) -> Iterator[str]:
    """Yield a line from every force to the nearest joint of the body on which it acts."""
    for force in motion.applied:
        joints = motion.links[motion.bodies.index(force.body)]
        tip = frame(force.position[k])
        nearest = min(
            (at[j] for j in joints), key=lambda p: float(np.hypot(*(p - tip))), default=tip
        )
        (x1, y1), (x2, y2) = nearest, tip
        yield (
            f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
            f'stroke="{LINK_COLOUR}" stroke-width="1.2" stroke-dasharray="5 3"/>'
        )


def _arrow(tail: Floats, tip: Floats) -> str:
    along = (tip - tail) / np.linalg.norm(tip - tail)
    across = np.array([-along[1], along[0]])
    base = tip - 9.0 * along
    head = " ".join(f"{x:.1f},{y:.1f}" for x, y in (tip, base + 4.0 * across, base - 4.0 * across))
    return (
        f'<line x1="{tail[0]:.1f}" y1="{tail[1]:.1f}" x2="{base[0]:.1f}" y2="{base[1]:.1f}" '
        f'stroke="{FORCE_COLOUR}" stroke-width="2"/><polygon points="{head}" '
        f'fill="{FORCE_COLOUR}"/>'
    )


def _names(
    motion: LinkageMotion,
    k: int,
    frame: _Frame,
    at: dict[str, Floats],
    forces: list[tuple[Floats, str]],
) -> list[str]:
    """Return the names of the joints and the sizes of the forces, where they hide least."""
    labels = [(point, name) for name, point in at.items()] + forces
    points = np.array([point for point, _ in labels]).reshape(1, -1, 2)
    sizes = np.array([[wide(name), LABEL_HEIGHT] for _, name in labels])
    lines = [
        (at[a], at[b])
        for joints in motion.links if len(joints) > 1
        for a, b in zip(joints, (*joints[1:], *joints[:1]), strict=True)
    ] + [tuple(frame(ends[k])) for ends in motion.slides.values()]  # fmt: skip
    offsets = label_offsets(
        points, sizes, np.array(lines).reshape(1, -1, 2, 2), LABEL_GAP, (WIDTH, frame.height)
    )
    return [
        text(float(x), float(y) + 4.0, name, halo=True)
        for (x, y), (_, name) in zip(points[0] + offsets, labels, strict=True)
    ]

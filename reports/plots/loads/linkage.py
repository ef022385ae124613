"""The positions of a linkage during a motion, or its static position."""

from __future__ import annotations

from itertools import chain

import numpy as np

from geometry.shape.chords import needed
from pinbase.dimensions import Floats
from reports.data.motion import LinkageMotion, PitchCurve
from reports.data.row import Units
from reports.format.drawing.svg_labels import label_offsets
from reports.format.drawing.zigzag import zigzag
from reports.format.file_names import plot_name
from reports.format.numbers import short
from reports.plots.spec import MAX_CURVE_POINTS, Plot, Spec, clipped, headed, rows

PITCH_CIRCLE_SIDES = 72
INTERMEDIATE_POSITIONS = 5  # positions between the first and the last
DIAGRAM_WIDTH, MIN_DIAGRAM_HEIGHT, MAX_DIAGRAM_HEIGHT = 560.0, 160.0, 560.0
DIAGRAM_MARGIN = 0.06  # of the size, around the linkage
LABEL_LETTER_WIDTH, LABEL_LINE_HEIGHT, LABEL_GAP = 7.0, 13.0, 7.0
SPRING_HALF_WIDTH = 5.0
SUPPORT_SIZE = 170.0  # of the triangle of a fixed joint: Vega's size, square pixels
SUPPORT_FOOT = np.sqrt(SUPPORT_SIZE) * np.array([[-0.5, 0.43], [0.5, 0.43]])  # its lower side
PATH_TOLERANCE = 1e-4  # of the linkage's size, a twentieth of a pixel
POSITION_TOLERANCE = 1e-6  # of the linkage's size; nearer positions are drawn once


def linkage_plot(motion: LinkageMotion, units: Units) -> Plot:
    """Return the first (solid) and the last (dashed) position, with the paths of the joints."""
    frame = _Frame(motion)
    moving = motion.time is not None
    instants = _instants(motion, frame.size)
    title = f"{motion.case}: the linkage " + (
        "from start to end, with the paths of its joints" if moving else "in its position"
    )
    key = dict(zip(instants, _keys(motion, instants, units), strict=True))
    links = [row for k in instants for row in _links(motion, k, key[k])]
    links += [row for k in instants for row in _springs(motion, k, key[k], frame)]
    between = [row for k in _intermediate(motion) for row in _links(motion, k, "intermediate")]
    spec = {
        "title": headed(title),
        "usermeta": {"columns": [f"x [{units.length}]", f"y [{units.length}]"]},
        "data": rows([]),
        "width": DIAGRAM_WIDTH,
        "height": frame.height,
        "encoding": {name: frame.axis(k, units) for k, name in enumerate("xy")},
        "layer": [
            *_lines(between, "faint", None),
            *_lines(_paths(motion, frame.size) if moving else [], "level", None),
            *_lines(links, "", list(key.values())),
            *_joints(motion, instants),
            *_names(motion, instants, frame),
        ],
    }
    return Plot(plot_name("linkage", motion.case), title, spec)


class _Frame:
    """The extent of the diagram, with one scale in both directions."""

    def __init__(self, motion: LinkageMotion) -> None:
        parts = [motion.joint_position, *motion.slides.values(), *motion.springs.values()]
        parts += _around(motion)
        every = np.concatenate([np.asarray(p).reshape(-1, 2) for p in parts])
        low, high = every.min(axis=0), every.max(axis=0)
        self.size = float((high - low).max()) or 1.0
        span = high - low + 2.0 * DIAGRAM_MARGIN * self.size
        scale = min(DIAGRAM_WIDTH / span[0], MAX_DIAGRAM_HEIGHT / span[1])
        self.height = max(scale * float(span[1]), MIN_DIAGRAM_HEIGHT)
        half = 0.5 * np.array([DIAGRAM_WIDTH, self.height]) / scale
        middle = 0.5 * (low + high)
        self.scale, self.low, self.high = scale, middle - half, middle + half

    def axis(self, k: int, units: Units) -> Spec:
        return {
            "field": "xy"[k], "type": "quantitative", "title": f"{'xy'[k]} [{units.length}]",
            "scale": {"domain": [float(self.low[k]), float(self.high[k])], "nice": False},
        }  # fmt: skip

    def pixels(self, points: Floats) -> Floats:
        """Return the pixels (.., 2) of points (.., 2), y downwards."""
        x, y = points[..., 0] - self.low[0], self.high[1] - points[..., 1]
        return np.asarray(self.scale * np.stack([x, y], axis=-1))


def _around(motion: LinkageMotion) -> list[Floats]:
    """Return points of pitch circles and lines that the diagram must include."""
    box = np.array([[-1.0, -1.0], [1.0, 1.0]])
    return [c.ends[:, :1] + c.radius * box if c.round else c.ends for c in motion.pitch]


def _instants(motion: LinkageMotion, size: float) -> list[int]:
    """Return the first instant and, if its position differs, the last."""
    points = motion.joint_position
    moved = float(np.abs(points[-1] - points[0]).max())
    return [0] if motion.time is None or moved < POSITION_TOLERANCE * size else [0, len(points) - 1]


def _intermediate(motion: LinkageMotion) -> list[int]:
    if motion.time is None:
        return []
    inner = np.linspace(0, len(motion.condition) - 1, INTERMEDIATE_POSITIONS + 2)[1:-1]
    return [round(float(k)) for k in inner]


def _keys(motion: LinkageMotion, instants: list[int], units: Units) -> list[str]:
    if motion.time is None:
        return ["the linkage"]
    start, end = (f"t = {short(float(motion.time[k]))} {units.time}" for k in (0, -1))
    if len(instants) == 1:
        return [f"start, {start}, and end, {end}"]
    return [f"start, {start}", f"end, {end}"]


def _links(motion: LinkageMotion, k: int, key: str) -> list[Spec]:
    """Return the outlines of bodies, lines of sliders and pitch curves at an instant, point by
    point.
    """
    at = dict(zip(motion.joints, motion.joint_position[k], strict=True))
    shapes = [
        [at[j] for j in ((*joints, joints[0]) if len(joints) > 2 else joints)]
        for joints in motion.links if len(joints) > 1
    ]  # fmt: skip
    sliders = [list(ends[k]) for ends in motion.slides.values()]
    sliders += [_pitch(curve, k) for curve in motion.pitch]
    return [
        {"x": float(x), "y": float(y), "of": f"{k}.{number}", "key": key}
        for number, shape in enumerate(chain(shapes, sliders)) for x, y in shape
    ]  # fmt: skip


def _springs(motion: LinkageMotion, k: int, key: str, frame: _Frame) -> list[Spec]:
    """Return the zigzags of springs between two points at an instant, point by point."""
    return [
        {"x": float(x), "y": float(y), "of": f"{k}.spring {name}", "key": key}
        for name, ends in motion.springs.items()
        for x, y in zigzag(ends[k], SPRING_HALF_WIDTH / frame.scale)
    ]


def _pitch(curve: PitchCurve, k: int) -> list[Floats]:
    """Return the line of a rack, or the circle of a gear with a radius that turns with the gear."""
    if not curve.round:
        return list(curve.ends[k])
    centre, mark = curve.ends[k]
    angle = np.linspace(0.0, 2.0 * np.pi, PITCH_CIRCLE_SIDES + 1)
    x, y = mark - centre
    turned = np.stack(
        [x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)], 1
    )
    return [centre, *(centre + turned)]


def _paths(motion: LinkageMotion, size: float) -> list[Spec]:
    """Return the paths of the moving joints, point by point; size: of the linkage."""
    return [
        {"x": float(x), "y": float(y), "of": name, "key": "path"}
        for j, name in enumerate(motion.joints) if name not in motion.ground
        for x, y in _path(motion.joint_position[:, j], PATH_TOLERANCE * size)
    ]  # fmt: skip


def _path(points: Floats, tolerance: float) -> Floats:
    """Return the points (N, 2) of a path to draw; of many points only those that the
    shape needs.
    """
    if len(points) <= MAX_CURVE_POINTS:
        return points
    allowed, free = np.full(points.shape, tolerance), np.zeros(len(points), dtype=bool)
    return points[needed(np.arange(len(points), dtype=float), points, allowed, free)]


def _lines(data: list[Spec], style: str, key: list[str] | None) -> list[Spec]:
    if not data:
        return []
    scale = {"domain": key}
    coloured: Spec = {
        "color": {"field": "key", "type": "nominal", "title": None, "scale": scale},
        "strokeDash": {"field": "key", "type": "nominal", "title": None, "scale": scale},
    }
    if key and len(key) == 1 and key[0] == "the linkage":
        coloured = {"color": {**coloured["color"], "legend": None}}
    return [{
        "data": rows(data),
        "mark": {"type": "line", **({"style": style} if style else {"strokeWidth": 2.2})},
        "encoding": {"detail": {"field": "of", "type": "nominal"}, "order": {"value": None},
                     **({} if key is None else coloured)},
    }]  # fmt: skip


def _joints(motion: LinkageMotion, instants: list[int]) -> list[Spec]:
    """Return rings at the joints, and triangles at the fixed joints."""
    layers = []
    for still, shape, size in ((True, "triangle-up", SUPPORT_SIZE), (False, "circle", 34)):
        shown = [
            {"x": float(x), "y": float(y), "name": name}
            for j, name in enumerate(motion.joints) if (name in motion.ground) or not still
            for x, y in motion.joint_position[instants, j]
        ]  # fmt: skip
        tooltip = {"field": "name", "type": "nominal"}
        mark = {"type": "point", "shape": shape, "size": size, "filled": True, "opacity": 1,
                "style": "hollow"}  # fmt: skip
        layers.append({"data": rows(shown), "mark": mark, "encoding": {"tooltip": tooltip}})
    return layers


def _names(motion: LinkageMotion, instants: list[int], frame: _Frame) -> list[Spec]:
    """Return the names of joints at the first position and of bodies, placed where they
    hide least.
    """
    at = dict(zip(motion.joints, motion.joint_position[0], strict=True))
    bodies = [
        (clipped(body), np.mean([at[j] for j in joints], axis=0))
        for body, joints in zip(motion.bodies, motion.links, strict=True)
        # A body EF with the joints E and F needs no name.
        if len(joints) > 1 and sorted(body) != sorted("".join(joints))
    ]
    named = [(clipped(name), point) for name, point in at.items()] + bodies
    points = np.array([point for _, point in named]).reshape(-1, 2)
    sizes = np.array([[LABEL_LETTER_WIDTH * len(name), LABEL_LINE_HEIGHT] for name, _ in named])
    segments = [
        [motion.joint_position[k][motion.joints.index(j)] for j in pair]
        for k in instants for joints in motion.links
        for pair in zip(joints, (*joints[1:], *joints[:1]), strict=True) if len(joints) > 1
    ]  # fmt: skip
    at_pixels = frame.pixels(points)
    for lines in (motion.slides, motion.springs):
        segments += [list(ends[k]) for k in instants for ends in lines.values()]
    ends = frame.pixels(np.array(segments).reshape(1, -1, 2, 2))
    feet = [at_pixels[motion.joints.index(name)] + SUPPORT_FOOT for name in motion.ground]
    ends = np.concatenate([ends, np.reshape(feet, (1, -1, 2, 2))], axis=1)
    placed = at_pixels + label_offsets(
        at_pixels[None], sizes, ends, LABEL_GAP, (DIAGRAM_WIDTH, frame.height)
    )
    shown = [
        {"px": float(x), "py": float(y), "name": name}
        for (name, _), (x, y) in zip(named, placed, strict=True)
    ]
    parts = ((shown[: len(at)], "bold", "note"), (shown[len(at) :], "normal", "quiet-note"))
    return [
        {"data": rows(part),
         "mark": {"type": "text", "style": style, "fontWeight": weight},
         "encoding": {"x": {"field": "px", "type": "quantitative", "scale": None, "axis": None},
                      "y": {"field": "py", "type": "quantitative", "scale": None, "axis": None},
                      "text": {"field": "name", "type": "nominal"}}}
        for part, weight, style in parts if part
    ]  # fmt: skip

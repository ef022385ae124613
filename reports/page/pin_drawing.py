"""A pin's profile as an SVG drawing: section, sizes, bands, zones, loads, stress along the pin."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape

from reports.data.results import CutShape, PinShape
from reports.data.row import Units
from reports.format.drawing.spread import rows
from reports.format.drawing.svg import INK_COLOUR, line, text, wide
from reports.format.numbers import drawn, engineering, short
from reports.page.drawing_places import PlaceMark
from reports.page.drawing_zones import STRIPE_PATTERN, ZoneMarks
from reports.page.lug_drawing import LUG_PATTERN, draw_line_loads, draw_lug
from reports.page.stress_along import StressAlong
from reports.page.stress_panel import ARROW_ROOM, StressPanel, arrow, triad
from reports.tables.stress.singular_zones import ShownZone

HIDDEN_LINE_STYLE = 'stroke-dasharray="4 2"'


DRAWING_WIDTH, DRAWING_MARGIN, MAX_HEIGHT_RATIO = (
    480.0,
    52.0,
    0.22,
)  # the ratio is of height to width
LOCAL_SOLID_OFFSET = 3.0  # gap between the pin and the box of a local solid
TEXT_LINE_HEIGHT = 14.0
PATTERNS = (
    '<defs><pattern id="held" width="6" height="6" patternUnits="userSpaceOnUse" '
    'patternTransform="rotate(45)"><rect width="6" height="6" fill="#fff"/>'
    f'<rect width="2" height="6" fill="#777"/></pattern>{STRIPE_PATTERN}{LUG_PATTERN}</defs>'
)
LUG_HEIGHT_SHARE = 0.45  # of a lug's diameter, which counts for the scale; lugs may stand out
FILL_COLOURS = {"band": "#9dbbe0", "held": "url(#held)", "plain": "#ececec"}


@dataclass(frozen=True)
class _Piece:
    """A segment on the drawing, in pixels.

    x, width: its left end and width.
    extent: its length on the pin.
    radii, bores: radii of surface and bore at its two ends.
    label, size, length, force: the words at the segment.
    """

    x: float
    width: float
    extent: float
    radii: tuple[float, float]
    bores: tuple[float, float]
    label: str
    size: str
    length: str
    kind: str
    force: str = ""

    @property
    def radius(self) -> float:
        """The larger of the two radii."""
        return max(self.radii)

    @property
    def middle(self) -> float:
        return self.x + 0.5 * self.width

    @property
    def words(self) -> tuple[str, str, str]:
        """The words above the segment, line by line."""
        return self.label, self.size, self.force


@dataclass(frozen=True)
class _Layout:
    """The place at which a pin is drawn, in pixels.

    left: the left end of the pin. scale: pixels per length. length: of the pin, in its own unit.
    radius: the largest, of pin or lugs.
    tops: the rows of the labels of segments that have words.
    lines: the number of lines of a label.
    axis: the y of the axis.
    foot: the y below the section and the arrows there.
    """

    left: float
    scale: float
    length: float
    radius: float
    tops: list[int]
    lines: int
    axis: float
    foot: float

    @property
    def right(self) -> float:
        return self.left + self.scale * self.length

    @property
    def row_height(self) -> float:
        """The height of a row of labels."""
        return self.lines * TEXT_LINE_HEIGHT

    @staticmethod
    def of(pieces: list[_Piece], along: StressAlong | None, around: float = 0.0) -> _Layout:
        """Return the layout of a pin. around: the diameter of the largest lug, in the unit of the
        pin.
        """
        labelled = [p for p in pieces if any(p.words)]
        tops = rows([p.middle for p in labelled], [max(map(wide, p.words)) for p in labelled])
        lines = 3 if any(p.force for p in pieces) else 2
        radius = max(p.radius for p in pieces)
        ups = [load.up for load in along.loads] if along else []
        above = ARROW_ROOM if min(ups, default=0.0) < 0.0 else 0.0
        below = ARROW_ROOM if max(ups, default=0.0) > 0.0 else 0.0
        drawn = sum(p.width for p in pieces)
        scale = drawn / sum(p.extent for p in pieces)
        radius = max(radius, 0.5 * scale * around)
        axis = 8.0 + lines * TEXT_LINE_HEIGHT * (max(tops) + 1) + 12.0 + above + radius
        return _Layout(
            pieces[0].x, scale, drawn / scale, radius, tops, lines, axis, axis + radius + below
        )


def draw_pin(
    shape: PinShape,
    units: Units,
    zones: list[ShownZone] | None = None,
    width: float = DRAWING_WIDTH,
    places: list[PlaceMark] | None = None,
    along: StressAlong | None = None,
) -> str:
    """Return the drawing as an <svg> element, in which all text is escaped.

    zones: one for each circle.
    width: of the drawing, in pixels; letters have the size 11.
    places: the places of the largest stress of rows.
    along: the loads and the stress along the pin, in the governing case.
    """
    around = max((lug.outer_diameter for lug in shape.lugs), default=0.0)
    pieces = _pieces(shape, units, width, along, around)
    if not pieces:
        return ""
    at = _Layout.of(pieces, along, around)
    marks = ZoneMarks(zones or [], places or [], (at.left, at.scale, at.radius), width)
    top = at.foot + marks.height
    panel = None
    if along is not None and along.drawn:
        panel = StressPanel(along, (at.left, at.scale, at.length), top)
        top = panel.foot
    chain = top + 19.0
    feet = rows([p.middle for p in pieces], [wide(p.length) for p in pieces])
    overall = chain + TEXT_LINE_HEIGHT * (max(feet) + 1) + 12.0
    height = overall + 12.0 + TEXT_LINE_HEIGHT * len(shape.cuts)
    total = f"{drawn(at.length)} {units.length}"
    parts = [
        f'<svg class="pin" viewBox="0 0 {width:.0f} {height:.0f}" role="img" '
        f'xmlns="http://www.w3.org/2000/svg" font-size="11" font-family="sans-serif">'
        f"<title>{escape(_title(shape, along))}</title>{PATTERNS}",
        *(
            part
            for lug in shape.lugs
            for part in draw_lug(lug, _radius(lug.z, pieces, at), (at.left, at.scale, at.axis))
        ),
        *_body(shape, pieces, at, marks),
        *([] if along is None else _pressed(along, pieces, at, units)),
        *([] if along is None else _loads(along, shape, pieces, at)),
        *([] if along is None else triad(8.0, overall + 2.0, along.angle)),
        *([] if panel is None else _guides(pieces, at, chain) + panel.draw(units.stress)),
        *(_dimension(p.x, p.x + p.width, chain, chain - 19.0) for p in pieces),
        *(
            text(p.middle, chain + TEXT_LINE_HEIGHT * (feet[i] + 1) - 3.0, p.length)
            for i, p in enumerate(pieces)
        ),
        _dimension(at.left, at.right, overall, chain),
        text(0.5 * (at.left + at.right), overall + 3.0, total),
        *marks.draw(at.axis, at.foot),
        *(
            text(0.5 * width, overall + 8.0 + TEXT_LINE_HEIGHT * i, cut_words(cut))
            for i, cut in enumerate(shape.cuts, 1)
        ),
        "</svg>",
    ]
    return "".join(parts)


def _title(shape: PinShape, along: StressAlong | None) -> str:
    if along is None:
        return f"Profile of pin {shape.pin}"
    return f"Profile of pin {shape.pin}, with its loads and the stress along it in {along.case}"


def _body(shape: PinShape, pieces: list[_Piece], at: _Layout, marks: ZoneMarks) -> list[str]:
    """Return the section with its cuts, excluded zones, axis and labels."""
    axis = at.axis
    labelled = [p for p in pieces if any(p.words)]
    return [
        *(_section(p, axis) for p in pieces),
        *(part for p in pieces for wall in _walls(p, axis) for part in marks.stripes(axis, wall)),
        *(draw_cut(cut, at.left, axis, at.scale) for cut in shape.cuts),
        *(
            _solid(at.left + at.scale * z0, at.left + at.scale * z1, axis, pieces)
            for z0, z1 in shape.solids
        ),
        line(at.left - 14, axis, at.right + 14, axis, 'stroke-dasharray="12 3 2 3"'),
        *(_leader(p, at, row) for p, row in zip(labelled, at.tops, strict=True)),
        *(_label(p, at, row) for p, row in zip(labelled, at.tops, strict=True)),
    ]


def _radius(z: tuple[float, float], pieces: list[_Piece], at: _Layout) -> float:
    """Return the largest drawn radius of the pin between two values of z."""
    left, right = (at.left + at.scale * x for x in z)
    return max((p.radius for p in pieces if p.x < right and left < p.x + p.width), default=0.0)


def _pressed(along: StressAlong, pieces: list[_Piece], at: _Layout, units: Units) -> Iterator[str]:
    """Yield the load per length along the bands, on the side of the pin that carries it."""
    rings = [(*x, _radius((x[0], x[1]), pieces, at)) for x in along.line_loads]
    unit = f"{units.force}/{units.length}"
    yield from draw_line_loads(rings, (at.left, at.scale, at.axis), unit)


def _loads(along: StressAlong, shape: PinShape, pieces: list[_Piece], at: _Layout) -> list[str]:
    """Return the arrow of every force, drawn outside its lug if there is one."""
    largest = max((load.size for load in along.loads), default=0.0)
    outer = {lug.connection: 0.5 * at.scale * lug.outer_diameter for lug in shape.lugs}
    parts = []
    for load in along.loads:
        x = at.left + at.scale * load.z
        radius = max((p.radius for p in pieces if p.x <= x <= p.x + p.width), default=at.radius)
        parts += arrow(load, x, at.axis, max(radius, outer.get(load.band, 0.0)), largest)
    return parts


def _guides(pieces: list[_Piece], at: _Layout, foot: float) -> list[str]:
    """Return faint lines from the ends of the segments down to the chain of dimensions."""
    ends = dict.fromkeys([p.x for p in pieces] + [at.right])
    lines = "".join(f"M{x:.2f},{at.axis + at.radius:.2f}V{foot - 17.0:.2f}" for x in ends)
    return [f'<path d="{lines}" stroke="{INK_COLOUR}" stroke-width="0.8" opacity="0.18"/>']


def _pieces(
    shape: PinShape, units: Units, across: float, along: StressAlong | None, around: float = 0.0
) -> list[_Piece]:
    length = sum(s[0] for s in shape.segments)
    widths = [s[1] for s in shape.segments] + [diameter for diameter, _ in shape.far_ends]
    widest = max([*widths, around * LUG_HEIGHT_SHARE], default=0.0)
    if length <= 0.0 or widest <= 0.0:
        return []
    scale = min((across - 2 * DRAWING_MARGIN) / length, MAX_HEIGHT_RATIO * across / widest)
    start = x = 0.5 * (across - scale * length)
    pieces: list[_Piece] = []
    last_size = ""
    near_ends = [(diameter, bore) for _, diameter, bore, _, _ in shape.segments]
    far_ends = shape.far_ends or near_ends
    for (long, _, _, label, kind), near, far in zip(
        shape.segments, near_ends, far_ends, strict=True
    ):
        diameters, bores = (near[0], far[0]), (near[1], far[1])
        size = f"⌀{_from_to(diameters)}" + (f" / {_from_to(bores)}" if any(bores) else "")
        radii, holes = ((scale * a / 2, scale * b / 2) for a, b in (diameters, bores))
        force = _force(along, units, (x - start) / scale, (x - start) / scale + long)
        # A segment without a label repeats no size of the segment before it.
        shown = "" if not label and size == last_size else size
        last_size = size
        words = (label, shown, drawn(long), kind, force)
        pieces.append(_Piece(x, scale * long, long, radii, holes, *words))
        x += scale * long
    return pieces


def _force(along: StressAlong | None, units: Units, start: float, end: float) -> str:
    """Return the sizes of the forces on a segment between two values of z; empty without any."""
    forces = [x.size for x in along.loads if start < x.z < end] if along else []
    return ", ".join(f"{engineering(size)} {units.force}" for size in forces if size > 0.0)


def _from_to(ends: tuple[float, float]) -> str:
    """Return the size, or for a cone the sizes at both ends."""
    return "–".join(dict.fromkeys(drawn(size) for size in ends))


def _section(piece: _Piece, axis: float) -> str:
    """Return the section of a segment: the walls above and below the axis."""
    fill = FILL_COLOURS.get(piece.kind, FILL_COLOURS["plain"])
    paint = f'fill="{fill}" stroke="{INK_COLOUR}" stroke-width="1"/>'
    if piece.radii[0] != piece.radii[1] or piece.bores[0] != piece.bores[1]:
        return "".join(f'<polygon points="{_cone(piece, axis, s)}" {paint}' for s in (-1.0, 1.0))
    rectangles = [
        f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}" {paint}'
        for x, y, width, height in _walls(piece, axis)
    ]
    return "".join(rectangles)


def _cone(piece: _Piece, axis: float, side: float) -> str:
    """Return the corners of a wall above (side -1) or below the axis."""
    far = piece.x + piece.width
    (r0, r1), (b0, b1) = piece.radii, piece.bores
    corners = (piece.x, r0), (far, r1), (far, b1), (piece.x, b0)
    return " ".join(f"{x:.2f},{axis + side * r:.2f}" for x, r in corners)


def _walls(piece: _Piece, axis: float) -> list[tuple[float, float, float, float]]:
    """Return x, y, width and height of the walls; for a cone of the rectangles that
    enclose them.
    """
    bore = min(piece.bores)
    wall = piece.radius - bore
    return [(piece.x, y, piece.width, wall) for y in (axis - piece.radius, axis + bore)]


def _solid(left: float, right: float, axis: float, pieces: list[_Piece]) -> str:
    """Return the box that marks a local solid."""
    radius = (
        max(p.radius for p in pieces if p.x < right and left < p.x + p.width) + LOCAL_SOLID_OFFSET
    )
    return (
        f'<rect class="solid" x="{left:.2f}" y="{axis - radius:.2f}" width="{right - left:.2f}" '
        f'height="{2.0 * radius:.2f}" fill="none" stroke="#1a7f37" stroke-width="1.5" '
        'stroke-dasharray="6 3"/>'
    )


def _leader(piece: _Piece, at: _Layout, row: int) -> str:
    foot = 8.0 + at.row_height * (row + 1)
    return line(piece.middle, foot, piece.middle, at.axis - piece.radius, 'opacity="0.3"')


def _label(piece: _Piece, at: _Layout, row: int) -> str:
    y = 8.0 + at.row_height * row + 11.0
    return "".join(
        text(piece.middle, y + (TEXT_LINE_HEIGHT - 1.0) * k, part, halo=True)
        for k, part in enumerate(piece.words)
        if part
    )


def _dimension(left: float, right: float, y: float, from_y: float) -> str:
    """Return a dimension line with ticks and extension lines."""
    foot = y - TEXT_LINE_HEIGHT
    ticks = "".join(f"M{x - 3:.2f},{foot + 5:.2f}l6,-6" for x in (left, right))
    leads = "".join(f"M{x:.2f},{from_y + 2:.2f}V{foot + 5:.2f}" for x in (left, right))
    drawn = f"M{left:.2f},{foot + 2:.2f}H{right:.2f}{ticks}"
    stroke = f'stroke="{INK_COLOUR}" stroke-width="0.8"'
    return f'<path d="{drawn}" {stroke}/><path d="{leads}" {stroke} opacity="0.4"/>'


def draw_cut(cut: CutShape, left: float, axis: float, scale: float) -> str:
    """Return the SVG of a cut on a pin that starts at x = left, with its axis at y = axis.

    left, axis: pixels. scale: pixels per length.
    """

    def at(z: float, x: float) -> tuple[float, float]:
        return left + scale * z, axis - scale * x

    out = []
    for z0, x0, z1, x1 in cut.notches:
        (a, c), (b, d) = at(z0, x0), at(z1, x1)
        away = 1.5 if d > c else -1.5  # covers the outline, too
        out.append(f'<path d="M{a:.2f},{d + away:.2f}H{b:.2f}V{c:.2f}H{a:.2f}Z" fill="#fff"/>')
    for points, hidden in cut.lines:
        drawn = " ".join("{:.2f},{:.2f}".format(*at(z, x)) for z, x in points)
        more = HIDDEN_LINE_STYLE if hidden else ""
        out.append(
            f'<polyline points="{drawn}" fill="none" stroke="{INK_COLOUR}" '
            f'stroke-width="0.8" {more}/>'
        )
    title = f"<title>{cut.name}</title>"
    return f'<g class="cut">{title}{"".join(out)}</g>'


def cut_words(cut: CutShape) -> str:
    """Return the sizes and the place of a cut as text, in the report's unit of length."""
    kind, size, (low, high) = cut.name.split()[0], drawn(cut.size), cut.z
    deep = "through" if cut.depth is None else f"{drawn(cut.depth)} deep"
    between = f"z = {drawn(low)} to {drawn(high)}"
    where = f" at {short(cut.angle % 360.0)}°"
    match kind:
        case "hole":
            aside = f"{drawn(abs(cut.offset))} beside the axis, " if cut.offset else ""
            dimensions = f"⌀{size}, {deep}, {aside}z = {drawn(low)},"
        case "flat":
            dimensions = f"{size} from the axis, {between},"
        case "slot":
            dimensions = f"{size} wide, {deep}, {between},"
        case "recess":
            dimensions = f"{size} wide, {between},"
        case _:
            aside = f"{drawn(cut.offset)} from the axis" if cut.offset else "on the axis"
            dimensions = f"⌀{size}, {deep}, {between}, {aside}"
            where = where if cut.offset else ""
    lean = f", leaning {short(cut.tilt)}° towards z" if cut.tilt else ""
    return f"{cut.name}: {dimensions}{where}{lean}"

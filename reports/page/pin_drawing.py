"""A pin's profile as an SVG drawing: section, lengths, diameters, bands and singular zones."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

from reports.data.results import PinShape, Units
from reports.format.drawing.cuts import draw_cut, words
from reports.format.drawing.spread import rows
from reports.format.drawing.svg import INK_COLOUR, line, text, wide
from reports.format.numbers import short
from reports.page.drawing_places import PlaceMark
from reports.page.drawing_zones import STRIPE_PATTERN, ZoneMarks
from reports.tables.stress.singular_zones import ShownZone

DRAWING_WIDTH, DRAWING_MARGIN, MAX_HEIGHT_RATIO = 760.0, 45.0, 0.2  # the last in widths
LOCAL_SOLID_OFFSET = 3.0  # what the box of a local solid stands off the pin
TEXT_LINE_HEIGHT = 14.0  # height of the text
FILL_COLOURS = {"band": "#9dbbe0", "held": "url(#held)", "plain": "#ececec"}


@dataclass(frozen=True)
class _Piece:
    """A segment on the drawing: x to x + width, radii at its two ends in the same unit."""

    x: float
    width: float
    radii: tuple[float, float]
    bores: tuple[float, float]
    label: str
    size: str
    length: str
    kind: str

    @property
    def radius(self) -> float:
        """The larger of the two radii."""
        return max(self.radii)

    @property
    def middle(self) -> float:
        return self.x + 0.5 * self.width


def draw_pin(
    shape: PinShape,
    units: Units,
    zones: list[ShownZone] | None = None,
    width: float = DRAWING_WIDTH,
    places: list[PlaceMark] | None = None,
) -> str:
    """Return the drawing as an <svg> element, in which all text is escaped.

    zones: one per circle. places: of the stress of rows.
    width: of the drawing, in pixels; letters have the size 11.
    """
    pieces = _pieces(shape, width)
    if not pieces:
        return ""
    tops = rows([p.middle for p in pieces], [_text_width(p) for p in pieces])
    feet = rows([p.middle for p in pieces], [wide(p.length) for p in pieces])
    radius = max(p.radius for p in pieces)
    axis = 8.0 + 2.0 * TEXT_LINE_HEIGHT * (max(tops) + 1) + 12.0 + radius
    left, right = pieces[0].x, pieces[-1].x + pieces[-1].width
    scale = (right - left) / sum(s[0] for s in shape.segments)
    marks = ZoneMarks(zones or [], places or [], (left, scale, radius), width)
    chain = axis + radius + marks.height + 24.0
    overall = chain + TEXT_LINE_HEIGHT * (max(feet) + 1) + 22.0
    height = overall + 12.0 + TEXT_LINE_HEIGHT * len(shape.cuts)
    parts = [
        f'<svg class="pin" viewBox="0 0 {width:.0f} {height:.0f}" role="img" '
        f'xmlns="http://www.w3.org/2000/svg" font-size="11" font-family="sans-serif">'
        f"<title>{escape(f'Profile of pin {shape.pin}')}</title>",
        '<defs><pattern id="held" width="6" height="6" patternUnits="userSpaceOnUse" '
        'patternTransform="rotate(45)"><rect width="6" height="6" fill="#fff"/>'
        f'<rect width="2" height="6" fill="#777"/></pattern>{STRIPE_PATTERN}</defs>',
    ]
    parts += [_section(p, axis) for p in pieces]
    parts += [
        part for p in pieces for wall in _walls(p, axis) for part in marks.stripes(axis, wall)
    ]
    parts += [draw_cut(cut, left, axis, scale) for cut in shape.cuts]
    parts += [_solid(left + scale * z0, left + scale * z1, axis, pieces) for z0, z1 in shape.solids]
    parts.append(line(left - 14, axis, right + 14, axis, 'stroke-dasharray="12 3 2 3"'))
    parts += [_leader(p, axis, tops[i]) for i, p in enumerate(pieces)]
    parts += [_label(p, tops[i]) for i, p in enumerate(pieces)]
    parts += [_dimension(p.x, p.x + p.width, chain, chain - 24.0) for p in pieces]
    parts += [
        text(p.middle, chain + TEXT_LINE_HEIGHT * (feet[i] + 1) - 3.0, p.length)
        for i, p in enumerate(pieces)
    ]
    parts.append(_dimension(left, right, overall, chain))
    total = f"{short(sum(s[0] for s in shape.segments))} {units.length}"
    parts.append(text(0.5 * (left + right), overall + 3.0, total))
    parts += marks.draw(axis, axis + radius)
    parts += [
        text(0.5 * width, overall + 8.0 + TEXT_LINE_HEIGHT * i, words(cut))
        for i, cut in enumerate(shape.cuts, 1)
    ]
    return "".join(parts) + "</svg>"


def drawn_ends(shape: PinShape, width: float = DRAWING_WIDTH) -> tuple[float, float]:
    """Return x of the ends of a pin in its drawing."""
    pieces = _pieces(shape, width)
    return pieces[0].x, pieces[-1].x + pieces[-1].width


def _pieces(shape: PinShape, across: float) -> list[_Piece]:
    length = sum(s[0] for s in shape.segments)
    widths = [s[1] for s in shape.segments] + [diameter for diameter, _ in shape.far_ends]
    widest = max(widths, default=0.0)
    if length <= 0.0 or widest <= 0.0:
        return []
    scale = min((across - 2 * DRAWING_MARGIN) / length, MAX_HEIGHT_RATIO * across / widest)
    x = 0.5 * (across - scale * length)
    pieces = []
    near_ends = [(diameter, bore) for _, diameter, bore, _, _ in shape.segments]
    far_ends = shape.far_ends or near_ends
    for (long, _, _, label, kind), near, far in zip(
        shape.segments, near_ends, far_ends, strict=True
    ):
        diameters, bores = (near[0], far[0]), (near[1], far[1])
        size = f"⌀{_from_to(diameters)}" + (f" / {_from_to(bores)}" if any(bores) else "")
        radii, holes = ((scale * a / 2, scale * b / 2) for a, b in (diameters, bores))
        pieces.append(_Piece(x, scale * long, radii, holes, label, size, short(long), kind))
        x += scale * long
    return pieces


def _from_to(ends: tuple[float, float]) -> str:
    """Return one size, or the sizes at both ends of a cone."""
    return "–".join(dict.fromkeys(short(size) for size in ends))


def _section(piece: _Piece, axis: float) -> str:
    """Return the section: the walls above and below the axis."""
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
    """Return x, y, width and height of the walls; for cones of the rectangles around them."""
    bore = min(piece.bores)
    wall = piece.radius - bore
    return [(piece.x, y, piece.width, wall) for y in (axis - piece.radius, axis + bore)]


def _solid(left: float, right: float, axis: float, pieces: list[_Piece]) -> str:
    """Return the boundary of a local solid."""
    radius = (
        max(p.radius for p in pieces if p.x < right and left < p.x + p.width) + LOCAL_SOLID_OFFSET
    )
    return (
        f'<rect class="solid" x="{left:.2f}" y="{axis - radius:.2f}" width="{right - left:.2f}" '
        f'height="{2.0 * radius:.2f}" fill="none" stroke="#1a7f37" stroke-width="1.5" '
        'stroke-dasharray="6 3"/>'
    )


def _leader(piece: _Piece, axis: float, row: int) -> str:
    foot = 8.0 + 2.0 * TEXT_LINE_HEIGHT * (row + 1)
    return line(piece.middle, foot, piece.middle, axis - piece.radius, 'opacity="0.5"')


def _label(piece: _Piece, row: int) -> str:
    y = 8.0 + 2.0 * TEXT_LINE_HEIGHT * row + 11.0
    return text(piece.middle, y, piece.label, halo=True) + text(
        piece.middle, y + TEXT_LINE_HEIGHT - 1.0, piece.size, halo=True
    )


def _dimension(left: float, right: float, y: float, from_y: float) -> str:
    """Return a dimension line with ticks and extension lines."""
    ends = (left, right)
    ticks = [line(x - 3, y - TEXT_LINE_HEIGHT + 5, x + 3, y - TEXT_LINE_HEIGHT - 1) for x in ends]
    leads = [line(x, from_y + 2, x, y - TEXT_LINE_HEIGHT + 5, 'opacity="0.4"') for x in ends]
    return line(left, y - TEXT_LINE_HEIGHT + 2, right, y - TEXT_LINE_HEIGHT + 2) + "".join(
        ticks + leads
    )


def _text_width(piece: _Piece) -> float:
    return max(wide(piece.label), wide(piece.size))

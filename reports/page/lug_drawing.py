"""Lugs in section about a pin, and their load on the pin, as parts of the drawing of the pin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from reports.data.results import LugSketch
from reports.format.drawing.svg import INK_COLOUR, text
from reports.format.numbers import engineering
from reports.page.stress_panel import LOAD_COLOUR

LUG_PATTERN = (
    '<pattern id="lug" width="7" height="7" patternUnits="userSpaceOnUse" '
    'patternTransform="rotate(45)"><rect width="7" height="7" fill="#f3e6d2"/>'
    '<rect width="0.9" height="7" fill="#b58d55"/></pattern>'
)
BUSHING_COLOUR = "#e0b23a"
LINE_LOAD_HEIGHT = 24.0  # of the largest load per length
MIN_LOAD_SHARE = 0.01  # of the largest load per length; smaller loads are not drawn

Frame = tuple[float, float, float]  # left end of the pin, pixels per length, y of its axis


def draw_lug(lug: LugSketch, radius: float, frame: Frame) -> Iterator[str]:
    """Yield the section of a lug and its bushing, above and below the pin.

    radius: of the drawn pin.
    """
    left, scale, axis = frame
    x, width = left + scale * lug.z[0], scale * (lug.z[1] - lug.z[0])
    bore = radius + 0.5 * scale * max(lug.clearance, 0.0)
    hole, outer = bore + scale * lug.bushing, 0.5 * scale * lug.outer_diameter
    for kind, fill, inner, end in (
        ("bushing", BUSHING_COLOUR, bore, hole),
        ("lug", "url(#lug)", hole, outer),
    ):
        for y in (axis - end, axis + inner) if end > inner else ():
            yield (
                f'<rect class="{kind}" x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" '
                f'height="{end - inner:.2f}" fill="{fill}" stroke="{INK_COLOUR}" '
                'stroke-width="0.8"/>'
            )


def draw_line_loads(
    rings: Sequence[tuple[float, float, float, float]], frame: Frame, unit: str
) -> Iterator[str]:
    """Yield the load per length of every ring, and the largest in words.

    It is drawn outwards from the surface of the pin, on the side on which the lug presses.
    rings: start z, end z, load per length upwards, drawn radius of the pin.
    """
    left, scale, axis = frame
    largest = max((abs(load) for _, _, load, _ in rings), default=0.0)
    shown = [ring for ring in rings if abs(ring[2]) > MIN_LOAD_SHARE * largest]
    if not shown:
        return
    bars = []
    for start, end, load, radius in shown:
        side = 1.0 if load > 0.0 else -1.0  # a load upwards presses from below
        foot = axis + side * radius
        tip = foot + side * LINE_LOAD_HEIGHT * abs(load) / largest
        x0, x1 = left + scale * start, left + scale * end
        bars.append(f"M{x0:.2f},{foot:.2f}V{tip:.2f}H{x1:.2f}V{foot:.2f}Z")
    yield (
        f'<path d="{"".join(bars)}" class="pressure" fill="{LOAD_COLOUR}" fill-opacity="0.45" '
        f'stroke="{LOAD_COLOUR}" stroke-width="0.7"/>'
    )
    start, end, load, radius = max(shown, key=lambda ring: abs(ring[2]))
    side = 1.0 if load > 0.0 else -1.0
    y = axis + side * (radius + LINE_LOAD_HEIGHT + 7.0) + 4.0
    words = f"{engineering(largest, 3)} {unit}"
    yield text(left + 0.5 * scale * (start + end), y, words, halo=True)

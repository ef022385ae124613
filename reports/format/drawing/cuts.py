"""Cuts on the drawing of a pin: silhouette, edges (hidden ones dashed), and sizes in words."""

from __future__ import annotations

from reports.data.results import CutShape
from reports.format.drawing.svg import INK_COLOUR
from reports.format.numbers import short

HIDDEN_LINE_STYLE = 'stroke-dasharray="4 2"'


def draw_cut(cut: CutShape, left: float, axis: float, scale: float) -> str:
    """Return the SVG of a cut on a pin that starts at x = left, with its axis at y = axis.

    All lengths of the drawing are in pixels.
    """

    def at(z: float, x: float) -> tuple[float, float]:
        return left + scale * z, axis - scale * x

    out = []
    for z0, x0, z1, x1 in cut.notches:
        (a, c), (b, d) = at(z0, x0), at(z1, x1)
        away = 1.5 if d > c else -1.5  # over the outline, too
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


def words(cut: CutShape) -> str:
    """Return the sizes and the place of a cut as text, in the report's unit of length."""
    kind, size, (low, high) = cut.name.split()[0], short(cut.size), cut.z
    deep = "through" if cut.depth is None else f"{short(cut.depth)} deep"
    between = f"z = {short(low)} to {short(high)}"
    where = f" at {short(cut.angle % 360.0)}°"
    match kind:
        case "hole":
            dimensions = f"⌀{size}, {deep}, z = {short(low)},"
        case "flat":
            dimensions = f"{size} from the axis, {between},"
        case "slot":
            dimensions = f"{size} wide, {deep}, {between},"
        case _:
            aside = f"{short(cut.offset)} from the axis" if cut.offset else "on the axis"
            dimensions = f"⌀{size}, {deep}, {between}, {aside}"
            where = where if cut.offset else ""
    return f"{cut.name}: {dimensions}{where}"

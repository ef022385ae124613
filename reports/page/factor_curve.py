"""The factor of a pin against its diameter, as an SVG drawing."""

from __future__ import annotations

import math
from html import escape

from reports.data.overview import MAX_LUG_SHARE, PinLine, diameter_law
from reports.format.numbers import engineering, short
from reports.tables.strength.overview import FactorAxis

WIDTH, HEIGHT = 260.0, 50.0
POINTS, REACH = 24, 1.25  # of the curve; the largest over the needed diameter
CHARACTER, LINE = 6.5, 11.0  # width of a character and height of a line
LEFT, ABOVE, RIGHT, BELOW = 40.0, 18.0, 10.0, 20.0  # margins for the labels


def draw_factor_curve(line: PinLine, unit: str) -> str | None:
    """Return the lowest factor, with its error and beneath contact, against the diameter of a pin,
    as an <svg> element.

    The curve follows the law of the section. The result is None where no diameter is estimated.
    unit: of lengths. Colours are in reports/templates/overview.css.
    """
    d = line.diameter
    if d is None or d.needed is None:
        return None
    most = REACH * d.needed / d.given
    scales = [most ** (k / (POINTS - 1)) for k in range(POINTS)]
    factors = list(map(diameter_law(line.row).factor_at, scales))
    required = line.row.required or 1.0
    axis = FactorAxis(min(factors) / 1.1, max(factors) * 1.1, required)
    across = [WIDTH * k / (POINTS - 1) for k in range(POINTS)]
    points = " ".join(f"{x:.1f},{_down(axis, f):.1f}" for x, f in zip(across, factors, strict=True))
    needed, at = _across(d.needed / d.given, most), _down(axis, required)
    # The label of the needed diameter, or of the first factor, is moved if it would meet another.
    given_text, needed_text = (f"{engineering(x, 3)} {unit}" for x in (d.given, d.needed))
    beside = CHARACTER * (len(given_text) + 0.5 * len(needed_text) + 2.0)
    below = max(_down(axis, factors[0]), at + LINE)
    title = f"Pin {line.pin}: estimated lowest factor, beneath contact too"
    parts = [
        f'<path class="frame" d="M0 0V{HEIGHT}H{WIDTH}"/>',
        f'<path class="limit" d="M0 {at:.1f}H{WIDTH}M{needed:.1f} {at:.1f}V{HEIGHT}"/>',
        f'<polyline points="{points}"/>',
        _text(0.0, HEIGHT + 15.0, given_text),
        _text(max(needed, beside), HEIGHT + 15.0, needed_text, "middle"),
        _text(-5.0, at + 4.0, short(required), "end"),
        _text(-5.0, below + 4.0, engineering(factors[0], 3), "end"),
        _text(5.0 - LEFT, -7.0, title),
    ]
    if d.eye and d.too_large(d.needed):
        largest = MAX_LUG_SHARE * d.eye
        lug = _across(largest / d.given, most)
        parts += [
            f'<path class="lug" d="M{lug:.1f} 0V{HEIGHT}"/>',
            _text(lug + 4.0, HEIGHT - 4.0, f"above {engineering(largest, 3)}: lug too small"),
        ]
    box = f"{-LEFT} {-ABOVE} {LEFT + WIDTH + RIGHT} {ABOVE + HEIGHT + BELOW}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="curve" viewBox="{box}" role="img" '
        f'aria-label="{escape(title)}">{"".join(parts)}</svg>'
    )


def _across(scale: float, most: float) -> float:
    return WIDTH * math.log(scale) / math.log(most)


def _down(axis: FactorAxis, factor: float) -> float:
    return HEIGHT * (1.0 - axis.at(factor))


def _text(x: float, y: float, text: str, anchor: str = "start") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'

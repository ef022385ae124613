"""The stress along a pin below its drawing, on the same z axis, and the arrows of its loads."""

from __future__ import annotations

from itertools import groupby
from math import floor, log10

import numpy as np

from pinbase.dimensions import Floats
from reports.format.drawing.svg import INK_COLOUR, line, text, wide
from reports.format.numbers import engineering
from reports.page.drawing_zones import ZONE_COLOUR
from reports.page.stress_along import LoadMark, StressAlong

PANEL_HEIGHT, KEY_HEIGHT = 84.0, 18.0
HEADROOM_FACTOR = 1.12  # upper end of the axis over the largest stress
MIN_TOP = 1e-300  # upper end of an axis; a smaller one counts as zero
MAX_TICKS = 4  # of the stress axis, without zero
ARROW_ROOM, MIN_ARROW_LENGTH = 26.0, 10.0  # of load arrows
LOAD_COLOUR, SECTION_COLOUR = "#0b5cad", "#9a4a00"
CURVE_STYLE = 'fill="none" stroke-width="1.4" stroke-linejoin="round"'
MIN_SHARE = 0.02  # of the largest force; a smaller component is not drawn
LETTER_HEIGHT = 12.0  # of labels that must not overlap
SYMBOL_RADIUS = 5.0  # of the symbol of a force out of the plane


class StressPanel:
    """The panel with the stress curves of a pin, with its upper edge at y = `top`.

    drawn: left end, scale and length of the drawn pin.
    """

    def __init__(self, along: StressAlong, drawn: tuple[float, float, float], top: float) -> None:
        self.along = along
        self.left, self.scale, length = drawn
        self.right = self.left + self.scale * length
        self.top, self.foot = top + KEY_HEIGHT, top + KEY_HEIGHT + PANEL_HEIGHT
        self.highest = HEADROOM_FACTOR * along.top
        self.key_end = self.left  # right end of the key above the panel

    def x(self, z: float) -> float:
        """The abscissa of a place on the pin."""
        return self.left + self.scale * z

    def y(self, stress: float) -> float:
        """The ordinate of a stress, at most the upper edge of the panel."""
        return self.foot - PANEL_HEIGHT * min(stress / self.highest, 1.0)

    def draw(self, unit: str) -> list[str]:
        """Return axis, key, curves and the mark of the governing place."""
        parts = self._axis(unit)
        for z, stress in self.along.surface:
            parts += self._curve(z, stress, f'class="surface" stroke="{INK_COLOUR}"')
        z, stress = self.along.section
        section = f'class="section" stroke="{SECTION_COLOUR}" stroke-dasharray="4 2"'
        return [*parts, *self._curve(z, stress, section), *self._allowed(), *self._mark()]

    def _axis(self, unit: str) -> list[str]:
        values = ticks(self.highest)
        marks = "".join(f"M{self.left - 3.0:.1f},{self.y(x):.1f}h3" for x in values)
        parts = [
            f'<path d="M{self.left:.1f},{self.top:.1f}V{self.foot:.1f}H{self.right:.1f}{marks}" '
            f'fill="none" stroke="{INK_COLOUR}" stroke-width="0.8"/>'
        ]
        for tick in values:
            words = engineering(tick, 2)
            parts.append(text(self.left - 5.0, self.y(tick) + 4.0, words, anchor="end"))
        keys = [("surface", bool(self.along.surface), f'stroke="{INK_COLOUR}"'),
                ("section", len(self.along.section[0]) > 0,
                 f'stroke="{SECTION_COLOUR}" stroke-dasharray="4 2"')]  # fmt: skip
        x, y = self.left, self.top - 6.0
        for name, there, style in keys:
            if there:
                parts.append(f'<path d="M{x:.1f},{y - 4.0:.1f}h16" {style} '
                             f'stroke-width="1.4" fill="none"/>')  # fmt: skip
                parts.append(text(x + 20.0, y, name, anchor="start"))
                x += 20.0 + wide(name) + 4.0
        self.key_end = x + wide(f"[{unit}]")
        return [*parts, text(x, y, f"[{unit}]", anchor="start")]

    def _curve(self, z: Floats, stress: Floats, style: str) -> list[str]:
        """Return a line for every part of a curve whose values are known."""
        parts = []
        finite = np.isfinite(stress)
        for known, group in groupby(range(len(z)), key=lambda k: bool(finite[k])):
            if known:
                points = " ".join(f"{self.x(z[k]):.1f},{self.y(stress[k]):.1f}" for k in group)
                parts.append(f'<polyline points="{points}" {style} {CURVE_STYLE}/>')
        return parts

    def _allowed(self) -> list[str]:
        """Return the line at the stress that the required factor permits, if it is within the
        panel.
        """
        allowed = self.along.allowed
        if allowed is None or allowed > self.highest:
            return []
        y = self.y(allowed)
        words = f"allowed {engineering(allowed)}"
        x, below, maximum, anchor = self._label()
        end = x + wide(maximum) if anchor == "start" else x
        start, at = self.right - 2.0 - wide(words), y - 3.0
        if self.key_end > start and at - (self.top - 6.0) < LETTER_HEIGHT:  # the key is there
            at = y + LETTER_HEIGHT
        meets = end > start and abs(below - at) < LETTER_HEIGHT
        style = 'class="allowed" stroke-dasharray="2 3"'
        return [line(self.left, y, self.right, y, style, ZONE_COLOUR),
                text(self.right - 2.0, below + LETTER_HEIGHT if meets else at, words,
                     halo=True, anchor="end")]  # fmt: skip

    def _label(self) -> tuple[float, float, str, str]:
        """Return the label of the maximum: x, y, text and anchor."""
        x, y = self.x(self.along.z or 0.0), self.y(self.along.maximum or 0.0) + 4.0
        words = f"max {engineering(self.along.maximum)}"
        if x - 7.0 - wide(words) < self.left:
            return x + 7.0, y, words, "start"
        return x - 7.0, y, words, "end"

    def _mark(self) -> list[str]:
        z, value = self.along.z, self.along.maximum
        if z is None or value is None:
            return []
        x, y, words, anchor = self._label()
        return [f'<circle class="governs" cx="{self.x(z):.2f}" cy="{self.y(value):.2f}" r="3.5" '
                f'fill="{ZONE_COLOUR}" stroke="#fff"/>',
                text(x, y, words, halo=True, anchor=anchor)]  # fmt: skip


def ticks(top: float) -> list[float]:
    """Return round values from zero to `top`, at most MAX_TICKS besides zero."""
    if not top > MIN_TOP:
        return [0.0]
    power = 10.0 ** floor(log10(top / MAX_TICKS))
    step = next(m * power for m in (1.0, 2.0, 5.0, 10.0) if top / (m * power) <= MAX_TICKS + 1e-9)
    return [k * step for k in range(int(top / step + 1e-9) + 1)]


def arrow(load: LoadMark, x: float, axis: float, radius: float, largest: float) -> list[str]:
    """Return the arrow of a force, and its symbol if it leaves the plane of the drawing.

    x: of the middle of the band.
    axis, radius: y of the axis and radius of the band, as drawn.
    largest: of all forces.
    """
    parts = []
    if largest > 0.0 and abs(load.up) > MIN_SHARE * largest:
        length = MIN_ARROW_LENGTH + (ARROW_ROOM - 4.0 - MIN_ARROW_LENGTH) * abs(load.up) / largest
        side = 1.0 if load.up > 0.0 else -1.0  # an upward force pushes from below
        tip = axis + side * radius
        base = tip + side * 7.0
        parts.append(
            f'<path class="load" d="M{x:.2f},{tip + side * length:.2f}V{base:.2f}" '
            f'stroke="{LOAD_COLOUR}" stroke-width="2.2"/>'
            f'<path d="M{x:.2f},{tip:.2f}L{x - 4.5:.2f},{base:.2f}H{x + 4.5:.2f}Z" '
            f'fill="{LOAD_COLOUR}"/>'
        )
    if load.out_of_plane:
        r = SYMBOL_RADIUS
        d = 0.7 * r
        inside = (
            f'<circle cx="{x:.2f}" cy="{axis:.2f}" r="1.6" fill="{LOAD_COLOUR}"/>'
            if load.towards > 0.0
            else f'<path d="M{x - d:.2f},{axis - d:.2f}l{2 * d:.2f},{2 * d:.2f}m0,{-2 * d:.2f}'
            f'l{-2 * d:.2f},{2 * d:.2f}" stroke="{LOAD_COLOUR}" stroke-width="1.4"/>'
        )
        parts.append(
            f'<circle class="load" cx="{x:.2f}" cy="{axis:.2f}" r="{r}" fill="#fff" '
            f'stroke="{LOAD_COLOUR}" stroke-width="1.6"/>{inside}'
        )
    return parts


def triad(x: float, y: float, angle: float) -> list[str]:
    """Return the axes of the drawing at (x, y): z to the right, and the upward direction.

    angle: of the upward direction from x, degrees.
    """
    up = "x" if abs(angle) < 0.5 else f"{angle:.0f}°".replace("-", "−")
    return [
        f'<path class="axes" d="M{x:.1f},{y - 18.0:.1f}V{y:.1f}H{x + 18.0:.1f}'
        f"M{x - 3.0:.1f},{y - 13.0:.1f}L{x:.1f},{y - 19.0:.1f}L{x + 3.0:.1f},{y - 13.0:.1f}"
        f'M{x + 13.0:.1f},{y - 3.0:.1f}L{x + 19.0:.1f},{y:.1f}L{x + 13.0:.1f},{y + 3.0:.1f}" '
        f'fill="none" stroke="{INK_COLOUR}" stroke-width="1.2"/>',
        text(x + 22.0, y + 4.0, "z", anchor="start"),
        text(x + 6.0, y - 14.0, up, halo=True, anchor="start"),
    ]

"""The most loaded lug of a pin, seen along its axis: eye, shank, and the pressure around
the bore.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from math import cos, degrees, hypot, radians, sin

import numpy as np

from pinbase.dimensions import Floats
from reports.data.results import LugSketch, PinShape, Results
from reports.data.row import Units
from reports.format.drawing.svg import INK_COLOUR, line, text
from reports.format.numbers import engineering
from reports.page.lug_drawing import BUSHING_COLOUR, LUG_PATTERN
from reports.page.stress_along import StressAlong, governing_rows, surface_of
from reports.page.stress_panel import LOAD_COLOUR

SIZE = 240.0  # of the picture, pixels; two lines of text are below it
EYE_SHARE = 0.5  # of the picture, taken by the eye
PRESSURE_SHARE = 0.45  # drawn height of the largest pressure over the pin's radius
SHANK_REACH = 1.5  # radii of the eye; longer shanks are cut off there
PIN_COLOUR = "#9dbbe0"


@dataclass(frozen=True)
class RingPressure:
    """The pressure about a pin on its most loaded ring in a lug.

    pin: diameter of the pin.
    z: of the ring.
    angles: (M,) of its sectors from x, rad. pressure: (M,).
    force: of the link on the pin, along x and y.
    shank: its angle from x, rad.
    """

    lug: LugSketch
    pin: float
    z: float
    angles: Floats
    pressure: Floats
    force: tuple[float, float]
    shank: float

    @property
    def arc(self) -> float:
        """The angle over which the pin touches the lug, degrees."""
        return degrees(2.0 * np.pi * np.count_nonzero(self.pressure > 0.0) / len(self.pressure))


def most_loaded(results: Results, shape: PinShape) -> RingPressure | None:
    """Return the pressure of the lug with the largest force in a pin's governing case; None where
    no pressure is known.
    """
    row = governing_rows(results).get(shape.pin)
    surface, case = (None, None) if row is None else surface_of(results, row)
    if row is None or surface is None or case is None or not shape.lugs:
        return None
    if case.pressure is None or case.rings is None or not row.joint:
        return None
    forces = {band.name: band.force for band in row.joint.bands}
    lug = max(shape.lugs, key=lambda lug: forces.get(lug.connection, 0.0))
    z = np.array([surface.points[case.rings == k, 2].mean() if (case.rings == k).any() else np.nan
                  for k in range(len(case.pressure))])  # fmt: skip
    inside = np.flatnonzero((lug.z[0] < z) & (z < lug.z[1]))
    if not len(inside) or not case.pressure[inside].any():
        return None
    ring = int(inside[case.pressure[inside].sum(axis=1).argmax()])
    pressure, points = case.pressure[ring], surface.points[case.rings == ring]
    angles = case.first + 2.0 * np.pi * np.arange(len(pressure)) / len(pressure)
    # Pressure acts towards the axis, so it pushes the pin opposite to its sector.
    push = -(pressure[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)).sum(axis=0)
    push *= forces[lug.connection] / (float(np.hypot(*push)) or 1.0)
    force = float(push[0]), float(push[1])
    along = float(np.arctan2(force[1], force[0]))
    shank = dict(row.shank_angles).get(lug.connection)
    pin = 2.0 * float(np.hypot(points[:, 0], points[:, 1]).max())
    return RingPressure(
        lug,
        pin,
        float(z[ring]),
        angles,
        pressure,
        force,
        along if shank is None else radians(shank),
    )


def draw_across(results: Results, shape: PinShape, along: StressAlong | None) -> str:
    """Return the view of the most loaded lug, seen against z, with the upward direction of the
    drawing of the pin; empty where no pressure is known.
    """
    of = most_loaded(results, shape)
    if of is None or along is None:
        return ""
    turn = radians(90.0 - along.angle)
    scale = EYE_SHARE * SIZE / max(of.lug.outer_diameter, of.pin)
    ink = f'stroke="{INK_COLOUR}" stroke-width="1.6"'
    title = f"Lug {of.lug.connection} of pin {shape.pin} across its axis"
    return "".join(
        [
            f'<svg class="across" viewBox="0 0 {SIZE:.0f} {SIZE + 34.0:.0f}" role="img" '
            'xmlns="http://www.w3.org/2000/svg" font-size="11" font-family="sans-serif">'
            f"<title>{escape(title)}</title><defs>{LUG_PATTERN}</defs>",
            *_outline(of, scale, turn, ink),
            *_outline(of, scale, turn, ""),  # fill only, so that the outline encloses both
            *_bore(of, scale),
            *_pressure(of, scale, turn),
            *_force(of, turn, results.units),
            *_words(of, results.units),
            "</svg>",
        ]
    )


def _at(r: float, angle: float) -> str:
    """Return the point at a distance r, pixels, from the middle of the picture and at an angle,
    rad.
    """
    return f"{0.5 * SIZE + r * cos(angle):.2f},{0.5 * SIZE - r * sin(angle):.2f}"


def _outline(of: RingPressure, scale: float, turn: float, ink: str) -> Iterator[str]:
    """Yield the shank, if it is known, and the eye."""
    lug, outer = of.lug, 0.5 * scale * of.lug.outer_diameter
    if lug.shank is not None:
        half = 0.5 * scale * lug.shank.width
        reach = min(scale * lug.shank.length, SHANK_REACH * outer)
        angle = of.shank + turn
        start = -scale * lug.shank.end if lug.shank.shape == "square" else 0.0
        across = outer if lug.shank.shape == "tapered" else half
        ends = (start, across), (reach, half), (reach, -half), (start, -across)
        corners = (_at(hypot(x, y), angle + float(np.arctan2(y, x))) for x, y in ends)
        yield f'<polygon class="shank" points="{" ".join(corners)}" fill="url(#lug)" {ink}/>'
    if lug.shank is None or lug.shank.shape != "square":
        yield _circle("lug", 0.5 * SIZE, outer, "url(#lug)", ink)


def _bore(of: RingPressure, scale: float) -> Iterator[str]:
    """Yield the bushing, the bore and the pin, with centre lines."""
    lug, middle, ink = of.lug, 0.5 * SIZE, f'stroke="{INK_COLOUR}" stroke-width="0.8"'
    bore = 0.5 * scale * (of.pin + max(lug.clearance, 0.0))
    if lug.bushing > 0.0:
        yield _circle("bushing", middle, bore + scale * lug.bushing, BUSHING_COLOUR, ink)
    yield _circle("bore", middle, bore, "#fff", ink)
    yield _circle("pin", middle, 0.5 * scale * of.pin, PIN_COLOUR, ink)
    reach = 0.5 * scale * lug.outer_diameter + 8.0
    dashes = 'stroke-dasharray="10 3 2 3" opacity="0.6"'
    yield line(middle - reach, middle, middle + reach, middle, dashes)
    yield line(middle, middle - reach, middle, middle + reach, dashes)


def _circle(kind: str, middle: float, r: float, fill: str, ink: str) -> str:
    place = f'cx="{middle:.2f}" cy="{middle:.2f}" r="{r:.2f}"'
    return f'<circle class="{kind}" {place} fill="{fill}" {ink}/>'


def _pressure(of: RingPressure, scale: float, turn: float) -> Iterator[str]:
    """Yield the pressure of every sector, drawn outwards from the surface of the pin."""
    radius, half = 0.5 * scale * of.pin, np.pi / len(of.pressure)
    largest = float(of.pressure.max())
    sectors = []
    for angle, pressure in zip(of.angles, of.pressure, strict=True):
        if pressure > 0.0:
            tip = radius * (1.0 + PRESSURE_SHARE * pressure / largest)
            a, b = angle + turn - half, angle + turn + half
            sectors.append(f"M{_at(radius, a)}L{_at(tip, a)}L{_at(tip, b)}L{_at(radius, b)}Z")
    yield (
        f'<path class="around" d="{"".join(sectors)}" fill="{LOAD_COLOUR}" fill-opacity="0.45" '
        f'stroke="{LOAD_COLOUR}" stroke-width="0.7"/>'
    )


def _force(of: RingPressure, turn: float, units: Units) -> Iterator[str]:
    """Yield the force of the link on the pin as an arrow outside the eye that points at the pin."""
    size, angle = hypot(*of.force), float(np.arctan2(of.force[1], of.force[0])) + turn
    outer = 0.5 * EYE_SHARE * SIZE
    tail, tip = outer + 30.0, outer + 6.0
    back = angle + np.pi
    head = (
        f"M{_at(tip, back)}L{_at(hypot(tip + 7.0, 4.5), back + 4.5 / (tip + 7.0))}"
        f"L{_at(hypot(tip + 7.0, 4.5), back - 4.5 / (tip + 7.0))}Z"
    )
    yield (
        f'<path class="load" d="M{_at(tail, back)}L{_at(tip + 6.0, back)}" '
        f'stroke="{LOAD_COLOUR}" stroke-width="2.2"/><path d="{head}" fill="{LOAD_COLOUR}"/>'
    )
    words = f"{engineering(size, 3)} {units.force}"
    x, y = _at(tail + 2.0, back).split(",")
    yield text(float(x) + 6.0, float(y) + (10.0 if sin(back) < 0.0 else -2.0), words, True, "start")


def _words(of: RingPressure, units: Units) -> Iterator[str]:
    """Yield the name of the lug, and its pressure and arc."""
    name = f"lug {of.lug.connection} at z = {engineering(of.z, 3)} {units.length}, seen against z"
    yield text(0.5 * SIZE, SIZE + 12.0, name)
    largest = f"up to {engineering(float(of.pressure.max()), 3)} {units.stress}"
    yield text(0.5 * SIZE, SIZE + 27.0, f"{largest}, over {engineering(of.arc, 3)}°")

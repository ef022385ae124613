"""Marks on the drawing of a pin for stress singularities and places of the largest stress.

Numbered rings mark stress singularities, with their kind; stripes mark the excluded zones about
them. A dot marks the largest stress on the surface, a line across the pin the section that governs.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import Literal

from reports.format.drawing.spread import rows
from reports.format.drawing.svg import line, text, wide
from reports.page.drawing_places import PlaceMark
from reports.tables.stress.singular_zones import ShownZone

ZONE_COLOUR = "#a8211b"
# Lengths in pixels of the drawing.
RING_RADIUS, DOT_RADIUS = 4.0, 3.5
LABEL_ROW_HEIGHT = 14.0
FIRST_ROW_GAP = 10.0  # between the section and the first row
STRIPE_PATTERN = (
    '<pattern id="excluded" width="5" height="5" patternUnits="userSpaceOnUse" '
    'patternTransform="rotate(-45)"><rect width="5" height="5" fill="#fff"/>'
    '<rect width="2" height="5" fill="#a8211b"/></pattern>'
)


@dataclass(frozen=True)
class _Mark:
    """A zone or a place of stress on the drawing; lengths in pixels.

    x: position.
    r: distance from the axis; for a section the radius of the pin.
    excluded: the excluded distance.
    words: the label.
    """

    x: float
    r: float
    excluded: float
    words: str
    governs: bool
    kind: Literal["zone", "surface", "section"] = "zone"


class ZoneMarks:
    """The marks of zones, one for each circle, and of places on the drawing of a pin.

    drawn: left end, scale and radius of the drawn pin.
    width: of the picture, in which labels are kept.
    """

    def __init__(
        self,
        zones: list[ShownZone],
        places: list[PlaceMark],
        drawn: tuple[float, float, float],
        width: float,
    ) -> None:
        left, scale, radius = drawn
        self.marks = [
            _Mark(
                left + scale * zone.z,
                scale * zone.r,
                scale * zone.place.excluded,
                _words(zone),
                zone.place.governs,
            )
            for zone in zones
        ] + [
            _Mark(
                left + scale * place.z,
                radius if place.r is None else scale * place.r,
                0.0,
                place.words,
                False,
                "section" if place.r is None else "surface",
            )
            for place in places
        ]
        self.places = [_within(m, width) for m in self.marks]
        self.rows = rows(self.places, [wide(m.words) for m in self.marks])

    @property
    def height(self) -> float:
        """The height of the labels below the section."""
        return FIRST_ROW_GAP + LABEL_ROW_HEIGHT * (max(self.rows) + 1) if self.marks else 0.0

    def stripes(self, axis: float, wall: tuple[float, float, float, float]) -> list[str]:
        """Return the stripes of the excluded zones in a wall of the section.

        wall: x, y, width and height of its rectangle; an inner <svg> clips the stripes to it.
        """
        x, y, width, height = wall
        discs = [
            f'<circle cx="{mark.x - x:.2f}" cy="{axis + side * mark.r - y:.2f}" '
            f'r="{mark.excluded:.2f}" fill="url(#excluded)"/>'
            for mark in self.marks
            for side in (-1.0, 1.0)
            if mark.kind == "zone" and _touches(mark.x, axis + side * mark.r, mark.excluded, wall)
        ]
        if not discs:
            return []
        frame = f'<svg x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}">'
        return [frame, *discs, "</svg>"]

    def draw(self, axis: float, foot: float) -> list[str]:
        """Return the marks above and below the axis, the leaders and the labels.

        foot: the lower edge of the section.
        """
        parts = []
        for mark, place, row in zip(self.marks, self.places, self.rows, strict=True):
            y = foot + FIRST_ROW_GAP + LABEL_ROW_HEIGHT * (row + 1) - 3.0
            parts.append(
                line(
                    mark.x,
                    axis + mark.r + RING_RADIUS,
                    place,
                    y - 10.0,
                    'opacity="0.7"',
                    ZONE_COLOUR,
                )
            )
        for mark, place, row in zip(self.marks, self.places, self.rows, strict=True):
            parts += _drawn(mark, axis)
            y = foot + FIRST_ROW_GAP + LABEL_ROW_HEIGHT * (row + 1) - 3.0
            parts.append(text(place, y, mark.words, halo=True))
        return parts


def _drawn(mark: _Mark, axis: float) -> list[str]:
    ends = [axis + side * mark.r for side in (-1.0, 1.0)]
    if mark.kind == "section":
        across = 'class="place" style="stroke-width: 2"'
        return [
            line(mark.x, ends[0] - RING_RADIUS, mark.x, ends[1] + RING_RADIUS, across, ZONE_COLOUR)
        ]
    if mark.kind == "surface":
        return [
            f'<circle class="place" cx="{mark.x:.2f}" cy="{y:.2f}" r="{DOT_RADIUS:.1f}" '
            f'fill="{ZONE_COLOUR}" stroke="#fff" stroke-width="1"/>'
            for y in ends
        ]
    return [_ring(mark.x, y, mark.governs) for y in ends]


def _words(zone: ShownZone) -> str:
    return f"{zone.number} {zone.short_kind}" + (", governs" if zone.place.governs else "")


def _touches(x: float, y: float, radius: float, wall: tuple[float, float, float, float]) -> bool:
    """Return whether a disc reaches into a rectangle."""
    left, top, width, height = wall
    off = x - min(max(x, left), left + width), y - min(max(y, top), top + height)
    return hypot(*off) < radius


def _within(mark: _Mark, width: float) -> float:
    """Return the x of the middle of a label, as close to its mark as the width of the picture
    allows.
    """
    half = min(0.5 * wide(mark.words), 0.5 * width)
    return min(max(mark.x, half), width - half)


def _ring(x: float, y: float, governs: bool) -> str:
    """Return a ring, filled where the zone governs."""
    fill = ZONE_COLOUR if governs else "none"
    return (
        f'<circle class="zone" cx="{x:.2f}" cy="{y:.2f}" r="{RING_RADIUS:.1f}" fill="{fill}" '
        f'fill-opacity="0.6" stroke="{ZONE_COLOUR}" stroke-width="1.6"/>'
    )

"""The drawing of a pin with its loads and the stress along it."""

from __future__ import annotations

from dataclasses import replace

from reports.data.results import PinShape, Results
from reports.data.row import PinResult
from reports.page.drawing_places import place_marks
from reports.page.pin_drawing import DRAWING_WIDTH, draw_pin
from reports.page.stress_along import stress_along
from reports.tables.stress.singular_zones import circles, pin_zones


def draw_row(results: Results, row: PinResult) -> str:
    """Return the pin of a row as an <svg> element with its stress along z, its loads and its
    maximum.

    The text is empty for a pin without a profile.
    """
    shape = next((s for s in results.shapes if s.pin == row.pin), None)
    if shape is None:
        return ""
    return draw_shape(shape, replace(results, pins=(row,)))


def draw_shape(shape: PinShape, results: Results, width: float = DRAWING_WIDTH) -> str:
    """Return a pin as an <svg> element, with the zones and places of all its rows, and the stress
    and loads of its governing row.
    """
    zones = circles(zone for case in pin_zones(results, shape.pin).values() for zone in case)
    marks = place_marks(results, shape.pin, sum(s[0] for s in shape.segments))
    return draw_pin(shape, results.units, zones, width, marks, stress_along(results, shape))

"""One row as a drawing: the pin with the place of its maximum, above it the stress along it."""

from __future__ import annotations

import re
from dataclasses import replace

from reports.data.results import PinResult, Results
from reports.page.drawing_places import place_marks
from reports.page.pin_drawing import DRAWING_WIDTH, draw_pin, drawn_ends
from reports.plots.draw import svg
from reports.plots.spec import Spec
from reports.plots.stress.surface import surface_plot
from reports.plots.theme import on_paper
from reports.tables.stress.singular_zones import circles, pin_zones

SIZE_PATTERN = re.compile(r' width="([\d.]+)" height="([\d.]+)"')
ORIGIN_PATTERN = re.compile(r"translate\(([\d.]+),[\d.]+\)")  # of the first group: the plot's
VIEW_BOX_PATTERN = re.compile(r'viewBox="0 0 ([\d.]+) ([\d.]+)"')


def draw_row(results: Results, row: PinResult) -> str:
    """Return the pin of a row as an <svg> element, with its stress along z where it has a meridian.

    Both are to one scale of z. Empty for a pin without a profile.
    """
    shape = next((s for s in results.shapes if s.pin == row.pin), None)
    if shape is None:
        return ""
    only = replace(results, pins=(row,))
    zones = circles(zone for case in pin_zones(only, row.pin).values() for zone in case)
    marks = place_marks(only, row.pin, sum(s[0] for s in shape.segments))
    drawing = draw_pin(shape, results.units, zones, places=marks)
    for surface in results.surfaces:
        for case in surface.cases if surface.revolved and surface.pin == row.pin else ():
            if case.case == row.case and drawing:
                spec = surface_plot(surface, case, row, None, results.units).spec
                return _joined(spec, drawing, drawn_ends(shape))
    return drawing


def _joined(spec: Spec, drawing: str, ends: tuple[float, float]) -> str:
    """Return a plot along z above the drawing of a pin.

    ends: x of the ends of the pin in the drawing.
    """
    left, right = ends
    views = [{**view, "width": right - left} for view in spec["vconcat"]]
    plot = svg({**spec, "vconcat": views, "config": on_paper()})
    size, origin = SIZE_PATTERN.search(plot), ORIGIN_PATTERN.search(plot)
    box = VIEW_BOX_PATTERN.search(drawing)
    assert size is not None
    assert origin is not None
    assert box is not None
    x = left - float(origin[1])
    first, last = min(x, 0.0), max(x + float(size[1]), DRAWING_WIDTH)
    height = float(size[2]) + float(box[2])
    plot = plot.replace("<svg ", f'<svg x="{x:.1f}" ', 1)
    placed = f'<svg y="{size[2]}" width="{box[1]}" height="{box[2]}" '
    drawing = drawing.replace("<svg ", placed, 1)
    width = f"{last - first:.0f}"
    return (
        f'<svg viewBox="{first:.0f} 0 {width} {height:.0f}" width="{width}" height="{height:.0f}" '
        'xmlns="http://www.w3.org/2000/svg">'
        f'<rect x="{first:.0f}" width="100%" height="100%" fill="#fff"/>{plot}{drawing}</svg>'
    )

"""Cuts of a pin as reports draw them."""

from __future__ import annotations

import math
from collections.abc import Iterator

from geometry import Cut, CutPin, Flat, Hole, Passage, Slot
from geometry.shape.cut_edges import drawn
from reports.data.results import CutShape


def cut_shapes(pin: CutPin) -> Iterator[CutShape]:
    """Of all cuts, in SI."""
    for name, cut in pin.cuts.items():
        found = drawn(cut, pin.profile)
        size, offset, depth = _sizes(cut)
        low, high = (cut.z, cut.z) if isinstance(cut, Hole) else _ends(cut)
        lines = tuple((tuple((z, x) for z, x in at.tolist()), hide) for at, hide in found.lines)
        yield CutShape(
            name,
            (max(low, 0.0), min(high, pin.length)),
            size,
            offset,
            depth,
            math.degrees(cut.angle),
            lines,
            found.notches,
        )


def _ends(cut: Cut) -> tuple[float, float]:
    assert isinstance(cut, Flat | Slot | Passage)
    return cut.z0, cut.z1


def _sizes(cut: Cut) -> tuple[float, float, float | None]:
    """Diameter, width or distance, offset, depth."""
    if isinstance(cut, Flat):
        return cut.distance, 0.0, None
    if isinstance(cut, Slot):
        return cut.width, 0.0, cut.depth
    if isinstance(cut, Hole):
        return cut.diameter, 0.0, cut.depth
    assert isinstance(cut, Passage)
    return cut.diameter, cut.offset, None if cut.mouth == "both" else cut.z1 - cut.z0

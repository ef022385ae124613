"""The pins on the drawing of the linkage, coloured and named by their factors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape

import numpy as np

from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, NOT_DECIDED, SAFE, YIELDS
from reports.data.overview import PinLine
from reports.data.results import Results
from reports.format.ranges import factor_range
from reports.page.linkage_panel import Instant, Mark

SYMBOLS = {  # of outcomes: a cross, a tick, half a disc, a question mark
    FAILS: '<circle r="9"/><path class="k" d="M-4-4L4 4M4-4L-4 4"/>',
    SAFE: '<circle r="8.5" class="h"/><path d="M-4 0l3 4l5-8"/>',
    DEPENDS: '<circle r="8.5" class="h"/><path class="hf" d="M0-8.5a8.5 8.5 0 0 0 0 17z"/>',
    NOT_DECIDED: '<circle r="8.5" class="h"/><path d="M-2.5-2.5a2.7 2.7 0 1 1 3.5 2.5q-1 .5-1 '
    '1.8M0 4.4v.6"/>',
}
SYMBOLS |= {YIELDS: SYMBOLS[FAILS], BELOW_YIELD: SYMBOLS[SAFE]}


def governing_instant(results: Results, lines: Sequence[PinLine]) -> Instant | None:
    """Return the linkage in the case and at the instant of the worst pin whose case has a linkage;
    None without one.
    """
    for line in lines:
        skeleton = next((s for s in results.skeletons if s.case == line.row.case), None)
        if skeleton is None:
            continue
        table = next((t for t in results.reactions if t.case == line.row.case), None)
        k = 0
        if skeleton.time is not None and line.row.time is not None:
            k = int(np.argmin(np.abs(skeleton.time - line.row.time)))
        return Instant(skeleton, k, table)
    return None


def pin_marks(at: Instant, lines: Iterable[PinLine], anchors: Mapping[str, str]) -> list[Mark]:
    """Return a mark for each pin at a joint of the linkage.

    anchors: of the sections of the pins on the page, by pin.
    """
    joints = _joints_of_pins(at)
    return [
        Mark(
            joints[line.pin],
            line.pin,
            factor_range(line.row) if line.row.safety_factor else "",
            _symbol(line, anchors.get(line.pin, "")),
        )
        for line in lines
        if line.pin in joints
    ]


def _joints_of_pins(at: Instant) -> dict[str, str]:
    """Return the joint of each pin."""
    if at.table is None:
        return {}
    by_connection = {name: joint for name, _, joint in at.skeleton.connections}
    return {
        pin: by_connection[connection]
        for connection, pin in zip(at.table.connections, at.table.pins, strict=True)
        if connection in by_connection
    }


def _symbol(line: PinLine, anchor: str) -> str:
    outcome = line.outcome.replace(" ", "-")
    title = f"<title>{escape(line.pin)}: {escape(line.outcome)}</title>"
    symbol = f'<g class="pin {outcome}">{title}{SYMBOLS[line.outcome]}</g>'
    # Not in the tab order, since the table next to the drawing has the same links.
    link = f'<a href="#{escape(anchor)}" tabindex="-1">{symbol}</a>'
    return link if anchor else symbol

"""Loads and timings on the page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from reports.data.results import PinResult, ReactionTable, Results, Units
from reports.format.grid import Grid
from reports.format.numbers import DASH, components, engineering
from reports.plots.loads.reactions import NO_PIN_NAME
from reports.tables.loads.drop import drop_words, impulse_grid, peak_grid
from reports.tables.published import published_reactions
from reports.tables.strength.landing import LANDING_NOTE, landing_blocks

TIMING_TEXT_COLUMNS = (True, True, True, False, False, False)


@dataclass(frozen=True)
class DropPart:
    """A drop: the clause that requires it, sentences, tables of its largest values."""

    case: str
    clause: str
    words: list[str]
    grids: list[Grid]


@dataclass(frozen=True)
class ReactionRow:
    """A connection's maximum force with its components and time, and its maximum moment."""

    connection: str
    body: str
    pin: str
    shared: bool
    largest: float
    components: tuple[float, float, float]
    time: float | None
    moment: float


def load_part(results: Results) -> dict[str, Any]:
    """Reactions, drops and landings of all cases."""
    return {
        "published": published_reactions(results),
        "timed": any(v.time is not None for v in results.published),
        "reactions": [(table, _rows(table)) for table in results.reactions],
        "without": NO_PIN_NAME,
        "drops": [
            DropPart(
                d.case,
                d.clause,
                drop_words(d, results),
                [peak_grid(d, results), impulse_grid(d, results)],
            )
            for d in results.drops
        ],
        "landing": landing_blocks(results),
        "landed": list(dict.fromkeys(r.case for r in results.landing)),
        "landing_note": LANDING_NOTE,
    }


def _rows(table: ReactionTable) -> list[ReactionRow]:
    return [
        ReactionRow(
            connection=table.connections[c],
            body=table.bodies[c],
            pin=table.pins[c],
            shared=table.connections[c] in table.shared,
            largest=peak.force,
            components=peak.components,
            time=peak.time,
            moment=peak.moment,
        )
        for c, peak in enumerate(table.largest)
    ]


def loads_at(pin: PinResult, units: Units) -> Grid | None:
    """Force of every body on a pin at the governing instant, world axes; None without loads."""
    if not pin.loads:
        return None
    turns = any(load.moment.any() for load in pin.loads)
    head = ["connection", "body", "force", "Fx", "Fy", "Fz"]
    head[2] += f" [{units.force}]"
    if turns:
        head += [f"{m} [{units.force}·{units.length}]" for m in ("Mx", "My", "Mz")]
    force, moment = (
        max(float(np.abs(getattr(load, name)).max()) for load in pin.loads)
        for name in ("force", "moment")
    )
    body = []
    for load in pin.loads:
        row = [load.connection, load.body or DASH]
        row += [engineering(float(np.linalg.norm(load.force)))]
        row += components(load.force.tolist(), force)
        if turns:
            row += components(load.moment.tolist(), moment)
        body.append(row)
    return Grid(head, body, [False, False, *[True] * (len(head) - 2)])


def timings(results: Results) -> Grid | None:
    """Meshes, unknowns and seconds of every row; None without rows."""
    if not results.pins:
        return None
    body = [
        [
            p.pin,
            p.case,
            p.model,
            str(len(p.history)) if p.dofs else DASH,
            f"{p.dofs:,}" if p.dofs else DASH,
            engineering(p.seconds, 2),
        ]
        for p in results.pins
    ]
    total = sum(p.seconds for p in results.pins)
    body.append(["all", "", "", "", "", engineering(total, 2)])
    head = ["pin", "case", "model", "meshes", "unknowns, finest mesh", "seconds"]
    return Grid(head, body, [not text for text in TIMING_TEXT_COLUMNS])

"""Loads and timings on the page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from pinbase.rounding import without_round_off
from reports.data.mechanics import PeakReaction, ReactionTable
from reports.data.results import Results
from reports.data.row import GoverningLoad, PinResult, Units
from reports.format.numbers import DASH, components, engineering, short
from reports.plots.loads.reactions import NO_PIN_NAME
from reports.tables.column import Column, Grid, Table, grid_of, read_only, texts
from reports.tables.loads.drop import drop_words, impulse_grid, peak_grid
from reports.tables.loads.wear import WEAR_NOTE, wear_table
from reports.tables.loads.wheel import WHEEL_NOTE, wheel_table
from reports.tables.published import published_reactions
from reports.tables.strength.landing import LANDING_NOTE, landing_blocks


def load_part(results: Results, everything: Results) -> dict[str, Any]:
    """Return the reactions, drops and landings of the cases that are shown, and the wheel loads of
    all cases.

    everything: results with all cases.
    """
    return {
        "published": published_reactions(results),
        "timed": any(v.time is not None for v in results.published),
        "reactions": [(table, _reactions(table, results.units)) for table in results.reactions],
        "without": NO_PIN_NAME,
        "drops": [
            (d, drop_words(d, results), [peak_grid(d, results), impulse_grid(d, results)])
            for d in results.drops
        ],
        "wear": grid_of(wear_table(results), results.units),
        "wear_note": WEAR_NOTE,
        "wheel": grid_of(wheel_table(everything), results.units),
        "wheel_note": WHEEL_NOTE,
        "landing": landing_blocks(results),
        "landed": list(dict.fromkeys(r.case for r in results.landing)),
        "landing_note": LANDING_NOTE,
    }


def largest_force(results: Results) -> str:
    """Return a sentence on the largest force at a connection in any case."""
    peaks = [(table, peak) for table in results.reactions for peak in table.largest]
    table, peak = max(peaks, key=lambda of: without_round_off(of[1].force))
    body = table.bodies[table.connections.index(peak.connection)]
    when = "" if peak.time is None else f" at t = {short(peak.time)} {results.units.time}"
    on = f"of {body} on the pin at {peak.connection}" if body else f"at {peak.connection}"
    force = f"{engineering(peak.force)} {results.units.force}"
    return f"Largest force: {force} {on}, in {table.case}{when}."


def _reactions(table: ReactionTable, units: Units) -> Grid:
    """Return each connection's largest force with components and time, and its largest moment."""

    def name(row: tuple[int, PeakReaction]) -> str:
        connection = table.connections[row[0]]
        return connection + " (shared)" * (connection in table.shared)

    def part(k: int) -> Callable[[tuple[int, PeakReaction]], str]:
        return lambda row: components(row[1].components, row[1].force)[k]

    columns: list[Column[tuple[int, PeakReaction]]] = [
        read_only("connection", name, numeric=False),
        read_only("body", lambda row: table.bodies[row[0]], numeric=False),
        read_only("pin", lambda row: table.pins[row[0]], numeric=False),
        read_only("force", lambda row: row[1].force, "force"),
        *(read_only(f"F{x}", part(k)) for k, x in enumerate("xyz")),
    ]
    if table.times is not None:
        columns.append(read_only("time", lambda row: row[1].time, "time"))
    if table.moments.any():
        columns.append(read_only("moment", lambda row: row[1].moment, "moment"))
    return Table("reactions", columns, [*enumerate(table.largest)]).grid(units)


def loads_at(pin: PinResult, units: Units) -> Grid | None:
    """Return the force of every body on a pin at the governing instant, in world axes; None without
    loads.
    """
    if not pin.loads:
        return None

    def part(name: str, k: int) -> Callable[[GoverningLoad], str]:
        largest = max(float(np.abs(getattr(load, name)).max()) for load in pin.loads)
        return lambda load: components(getattr(load, name).tolist(), largest)[k]

    couple = f" [{units.force}·{units.length}]"
    turns = any(load.moment.any() for load in pin.loads)
    columns: list[Column[GoverningLoad]] = [
        *texts("connection"),
        read_only("body", lambda load: load.body or DASH, numeric=False),
        read_only("force", lambda load: float(np.linalg.norm(load.force)), "force"),
        *(read_only(f"F{x}", part("force", k)) for k, x in enumerate("xyz")),
        *(read_only(f"M{x}{couple}", part("moment", k)) for k, x in enumerate("xyz") if turns),
    ]
    return Table("loads", columns, pin.loads).grid(units)


TIMING_COLUMNS: list[Column[PinResult]] = [
    *texts("pin case model"),
    read_only("meshes", lambda p: str(len(p.history)) if p.dofs else DASH),
    read_only("unknowns, finest mesh", lambda p: f"{p.dofs:,}" if p.dofs else DASH),
    read_only("seconds", lambda p: engineering(p.seconds, 2)),
]


def timings(results: Results) -> Grid | None:
    """Return meshes, unknowns and seconds of every row, and the total time; None without rows."""
    grid = grid_of(Table("timings", TIMING_COLUMNS, results.pins), results.units)
    total = engineering(sum(p.seconds for p in results.pins), 2)
    return grid and replace(grid, body=[*grid.body, ["all", "", "", "", "", total]])

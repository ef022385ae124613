"""The loads on one pin in one case, and the timings, for the page."""

from __future__ import annotations

import numpy as np

from reports.data.results import PinResult, Results, Units
from reports.format.grid import Grid
from reports.format.numbers import DASH, components, engineering

TIMINGS = (True, True, True, False, False, False)


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
    return Grid(head, body, [not text for text in TIMINGS])

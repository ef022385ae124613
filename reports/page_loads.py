"""What the page shows of the forces on one pin in one case, and of the time that all took."""

from __future__ import annotations

import numpy as np

from reports.grid import Grid
from reports.numbers import DASH, engineering
from reports.results import PinResult, ReactionTable, Results, Units

ROUNDING = 1e-9  # of the largest component: what is nought but for rounding
TIMINGS = (True, True, True, False, False, False)


def loads_at(pin: PinResult, results: Results) -> Grid | None:
    """What every body does to a pin at the governing instant, world axes; None where not known."""
    for table in results.reactions:
        if table.case == pin.case and pin.pin in table.pins:
            return _loads(pin, table, results.units)
    return None


def _loads(pin: PinResult, table: ReactionTable, units: Units) -> Grid:
    moving = table.times is not None and pin.time is not None
    instant = int(np.abs(np.asarray(table.times) - pin.time).argmin()) if moving else 0
    force, moment = table.forces[instant], table.moments[instant]
    turns = bool(table.moments.any())
    head = ["connection", "body", "force", "Fx", "Fy", "Fz"]
    head[2] += f" [{units.force}]"
    if turns:
        head += [f"{m} [{units.force}·{units.length}]" for m in ("Mx", "My", "Mz")]
    body = []
    for c, name in enumerate(table.connections):
        if table.pins[c] != pin.pin:
            continue
        row = [name, table.bodies[c] or DASH, engineering(float(np.linalg.norm(force[c])))]
        row += _components(force[c].tolist(), float(np.abs(force).max()))
        if turns:
            row += _components(moment[c].tolist(), float(np.abs(moment).max()))
        body.append(row)
    return Grid(head, body, [False, False, *[True] * (len(head) - 2)])


def _components(values: list[float], largest: float) -> list[str]:
    return [engineering(v if abs(v) > ROUNDING * largest else 0.0) for v in values]


def timings(results: Results) -> Grid | None:
    """Meshes, unknowns and seconds of every row; None without any."""
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
    head = ["pin", "case", "model", "meshes", "unknowns of the finest", "seconds"]
    return Grid(head, body, [not text for text in TIMINGS])

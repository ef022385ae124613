"""The path of the largest force through the pins of a linkage, in a sentence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reports.data.results import Results
from reports.data.row import GoverningLoad, PinResult, Units
from reports.data.skeleton import Skeleton
from reports.format.numbers import engineering

LARGE_FORCE = 0.5  # of the largest force; pins that carry more are on its path
MAX_NAMED_PINS = 6  # with more pins, a sentence gives their number
SAME_FORCE = 0.15  # relative difference up to which a pin carries the applied force


def load_path(results: Results, rows: Sequence[PinResult]) -> str:
    """Return a sentence on the pins through which the largest forces of a case pass.

    Example: "194,000 lbf goes J–E–A to the frame; others at most 35,700." If there is no single
    path, the pins are named without order.
    rows: of the pins, the worst first; its case is described.
    """
    units = results.units
    in_case = [row for row in rows if row.case == rows[0].case and row.loads]
    forces = {row.pin: _largest(row.loads) for row in in_case}
    if len(forces) < 2:
        return _on_one_pin(rows[0], units) if forces else ""
    most = max(forces.values())
    through = {pin: force for pin, force in forces.items() if force >= LARGE_FORCE * most}
    elsewhere = engineering(max((f for p, f in forces.items() if p not in through), default=0.0), 3)
    some = len(through) < len(forces)
    if path := _path(results, in_case, through):
        applied, pins = path
        others = f"; others at most {elsewhere}" if some else ""
        force = f"{engineering(applied, 3)} {units.force}"
        return f"{force} goes {'–'.join(pins)} to the frame{others}."
    others = f", others {elsewhere}" if some else ""
    verb = "carry" if len(through) > 1 else "carries"
    return f"{names(list(through))} {verb} up to {engineering(most, 3)} {units.force}{others}."


def names(pins: Sequence[str]) -> str:
    """Return the names of pins as a list in words: "A", "A and B", "A, B and C"."""
    if len(pins) > MAX_NAMED_PINS:
        return f"{len(pins)} pins"
    return " and ".join(filter(None, [", ".join(pins[:-1]), pins[-1]])) if pins else ""


def _path(
    results: Results, rows: Sequence[PinResult], forces: Mapping[str, float]
) -> tuple[float, list[str]] | None:
    """Return the single applied force and the pins that transmit it to the frame, in order.

    The result is None unless the force acts on a link of the first pin, and all pins carry about as
    much as the force.
    forces: the largest by pin.
    """
    skeleton = next((s for s in results.skeletons if s.case == rows[0].case), None)
    if skeleton is None or len(skeleton.loads) != 1 or len(skeleton.applied) != 1:
        return None
    load = skeleton.applied[0]
    applied = float(load.sizes[min(_instant(skeleton, rows[0]), len(load.sizes) - 1)])
    if any(abs(force - applied) > SAME_FORCE * applied for force in forces.values()):
        return None
    bodies = {row.pin: {x.body for x in row.loads} for row in rows if row.pin in forces}
    frame = {c for c, _, joint in skeleton.connections if joint in skeleton.ground}
    path = [pin for pin, on in bodies.items() if load.body in on][:1]
    while path:
        ahead = [p for p, on in bodies.items() if p not in path and on & bodies[path[-1]]]
        if len(ahead) != 1:
            break
        path += ahead
    ends = path and {x.connection for row in rows if row.pin == path[-1] for x in row.loads}
    return (applied, path) if len(path) == len(forces) and ends and ends & frame else None


def _instant(skeleton: Skeleton, row: PinResult) -> int:
    """Return the index of the instant of a row."""
    if skeleton.time is None or row.time is None:
        return 0
    return int(np.argmin(np.abs(skeleton.time - row.time)))


def _on_one_pin(row: PinResult, units: Units) -> str:
    load = max(row.loads, key=_size)
    if not _size(load):
        return ""  # as on a press fit without loads
    return (
        f"The largest force on pin {row.pin} is {engineering(_size(load), 3)} {units.force}, at "
        f"{load.connection} ({row.case})."
    )


def _size(load: GoverningLoad) -> float:
    return float(np.linalg.norm(load.force))


def _largest(loads: Sequence[GoverningLoad]) -> float:
    """Return the largest force on a pin: of a link, or the resultant of all links."""
    total = sum(np.asarray(load.force) for load in loads)
    return max(*map(_size, loads), float(np.linalg.norm(total)))

"""The path of the largest force through the pins of a linkage, in a sentence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reports.data.results import Results
from reports.data.row import GoverningLoad, PinResult, Units
from reports.data.skeleton import Skeleton
from reports.format.numbers import engineering

LARGE_FORCE = 0.5  # of the largest force: what passes through the same pins
MAX_NAMED_PINS = 6  # in a sentence; of more, their number is given
SAME_FORCE = 0.15  # relative difference up to which a pin carries the force that is applied


def load_path(results: Results, rows: Sequence[PinResult]) -> str:
    """Return the pins through which the largest forces of a case pass: "194,000 lbf goes J–E–A to
    the frame; others at most 35,700." Where this is no single path, only the pins are named.

    rows: of the pins, the worst first, whose case it is.
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
    """Return names of pins: "A", "A and B", "A, B and C"."""
    if len(pins) > MAX_NAMED_PINS:
        return f"{len(pins)} pins"
    return " and ".join(filter(None, [", ".join(pins[:-1]), pins[-1]])) if pins else ""


def _path(
    results: Results, rows: Sequence[PinResult], forces: Mapping[str, float]
) -> tuple[float, list[str]] | None:
    """Return the one force that is applied and the pins that pass it on to the frame, in order;
    None unless it enters at the first of them, and all carry about as much.

    forces: by pin, the largest.
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
    """Return the number of the instant of a row."""
    if skeleton.time is None or row.time is None:
        return 0
    return int(np.argmin(np.abs(skeleton.time - row.time)))


def _on_one_pin(row: PinResult, units: Units) -> str:
    load = max(row.loads, key=_size)
    if not _size(load):
        return ""  # as on an idle press fit
    return (
        f"The largest force on pin {row.pin} is {engineering(_size(load), 3)} {units.force}, at "
        f"{load.connection} ({row.case})."
    )


def _size(load: GoverningLoad) -> float:
    return float(np.linalg.norm(load.force))


def _largest(loads: Sequence[GoverningLoad]) -> float:
    """Return the largest force of a link on a pin, or of all together, which its supports take."""
    total = sum(np.asarray(load.force) for load in loads)
    return max(*map(_size, loads), float(np.linalg.norm(total)))

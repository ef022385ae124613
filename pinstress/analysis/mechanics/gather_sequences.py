"""Sequences of load cases on one time axis, joined from the results of the cases without a new
solution.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from itertools import pairwise
from typing import Any, Literal, TypeVar

import numpy as np

from assess.fatigue.records import CaseHistory, PointHistory
from pinbase.arrays import Floats
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.sequence import Occurrence, complete, steps
from pinstress.study.reading.file import Study
from reports.data.mechanics import DriveEffort, DriveTable, PeakReaction, ReactionTable
from reports.data.motion import AppliedForce, Extremes, LinkageMotion
from reports.format.numbers import engineering

T = TypeVar("T")
# Relative to the linkage's size: the distance from which a joint counts as displaced between the
# end of a case and the beginning of the next.
JUMP_TOLERANCE = 1e-6


def _joined(parts: Sequence[Any]) -> Any:
    """Return parts joined one after the other.

    Arrays are concatenated, also inside dataclasses, tuples and dictionaries. The result is None if
    any part is None. Of other values the first is taken.
    """
    first: Any = parts[0]
    if any(part is None for part in parts):
        return None
    if isinstance(first, np.ndarray):
        return np.concatenate(parts)
    if is_dataclass(first):
        joined = {f.name: _joined([getattr(p, f.name) for p in parts]) for f in fields(first)}
        return replace(first, **joined)  # type: ignore[type-var]
    if isinstance(first, dict):
        return {k: _joined([p[k] for p in parts]) for k in first if all(k in p for p in parts)}
    if isinstance(first, tuple) and any(map(is_dataclass, first)):
        return tuple(_joined(items) for items in zip(*parts, strict=True))
    return first


def _course(
    parts: Mapping[str, T], times: Mapping[str, Floats | None], order: list[Occurrence]
) -> T:
    """Return the joined results of every step's case; those of a case at rest are taken twice, at
    the beginning and at the end of the step.
    """
    every = [parts[s.case] for s in order for _ in range(2 if times[s.case] is None else 1)]
    joined: T = _joined(every)
    return joined


def _axis(times: Mapping[str, Floats | None], order: list[Occurrence]) -> Floats:
    """Return the times (T,) s of the results of `_course`."""
    out = []
    for step in order:
        case_times = times[step.case]
        out.append(
            step.begin
            + (np.array([0.0, step.duration]) if case_times is None else case_times - case_times[0])
        )
    return np.concatenate(out)


def sequence_tables(study: Study, parts: dict[str, Any]) -> dict[str, Any]:
    """Return the parts with the reactions, drives and motions of all sequences whose cases are
    among them.
    """
    reactions = {t.case: t for t in parts["reactions"]}
    motions = {m.case: m for m in parts["motion"]}
    in_space = {skeleton.case for skeleton in parts["space"]}
    drives = {(d.case, d.name): d for d in parts["drive"]}
    times = {name: t.times for name, t in reactions.items()}
    out: dict[str, list[Any]] = {"reactions": [], "drive": [], "motion": []}
    for name in complete(study, reactions):
        order = list(steps(study.table.sequence[name], times))
        cases = [step.case for step in order]
        table = _reactions(name, reactions, order)
        in_plane = all(case in motions for case in cases)
        if in_plane or all(case in in_space for case in cases):
            held = dict.fromkeys(d for case, d in drives if case in cases)
            of = [{case: drives.get((case, drive)) for case in cases} for drive in held]
            joined_drives = [_drive(name, by_case, times, order) for by_case in of]
            jumps = _jumps(motions, order) if in_plane else ""
            table = replace(table, note=f"{table.note} {_work(study, joined_drives)}{jumps}")
            out["drive"] += joined_drives
        if in_plane:
            out["motion"].append(_motion(name, motions, order))
        out["reactions"].append(table)
    return {key: (*parts[key], *tables) for key, tables in out.items()}


def _reactions(
    name: str, tables: Mapping[str, ReactionTable], order: list[Occurrence]
) -> ReactionTable:
    used = {step.case: tables[step.case] for step in order}
    names = dict.fromkeys(c for table in used.values() for c in table.connections)
    whole = {case: _with_all(table, list(names), used) for case, table in used.items()}
    times = {case: table.times for case, table in used.items()}
    return replace(
        _course(whole, times, order),
        case=name,
        times=_axis(times, order),
        note=_steps_in_words(order),
        published={},
        shared=tuple(dict.fromkeys(c for t in used.values() for c in t.shared)),
        peaks=tuple(_peak(c, whole, order) for c in range(len(names))),
        unresolved=tuple(
            (s.begin + low - _first(times[s.case]), s.begin + high - _first(times[s.case]))
            for s in order
            for low, high in used[s.case].unresolved
        ),
    )


def _first(times: Floats | None) -> float:
    return 0.0 if times is None else float(times[0])


def _with_all(
    table: ReactionTable, names: list[str], of: Mapping[str, ReactionTable]
) -> ReactionTable:
    """Return a table with all connections of the sequence in one order; a connection that the case
    does not have has zero force.
    """
    have = {c: k for k, c in enumerate(table.connections)}
    owner = {c: t for t in of.values() for c in t.connections}
    at = [have.get(c, -1) for c in names]
    present = np.array([k >= 0 for k in at])
    turn = None if table.turn is None else _turn_where_present(present, table.turn[:, at])
    of_name = {peak.connection: peak for peak in table.largest}
    return replace(
        table,
        connections=tuple(names),
        bodies=tuple(owner[c].bodies[owner[c].connections.index(c)] for c in names),
        pins=tuple(owner[c].pins[owner[c].connections.index(c)] for c in names),
        forces=np.where(present[:, None], table.forces[:, at], 0.0),
        moments=np.where(present[:, None], table.moments[:, at], 0.0),
        turn=turn,
        peaks=tuple(of_name.get(c, PeakReaction(c, 0.0, None)) for c in names),
    )


def _turn_where_present(present: Floats, turn: Floats) -> Floats:
    """Return the rotation where the case has the connection, and no rotation elsewhere.

    turn: angles (T, C) in a plane or matrices (T, C, 3, 3) in space.
    """
    if turn.ndim == 2:
        return np.where(present, turn, 0.0)
    return np.where(present[:, None, None], turn, np.eye(3))


def _peak(c: int, tables: Mapping[str, ReactionTable], order: list[Occurrence]) -> PeakReaction:
    """Return the peak of connection number c over the sequence, at its first occurrence."""
    peaks = [(s, tables[s.case].peaks[c]) for s in order]
    step, peak = max(peaks, key=lambda pair: pair[1].force)
    case_time = 0.0 if peak.time is None else peak.time - _first(tables[step.case].times)
    return replace(
        peak,
        time=step.begin + case_time,
        moment=max(p.moment for _, p in peaks),
        frictionless=_frictionless((p.force, p.frictionless) for _, p in peaks),
    )


def _frictionless(largest: Iterable[tuple[float, float | None]]) -> float | None:
    """Return the largest value without friction, or None if no step has friction.

    largest: for every step, the largest value and the largest value without friction. The latter is
    None where nothing rubs, as at rest; both are then the same.
    """
    every = list(largest)
    if all(smooth is None for _, smooth in every):
        return None
    return max(value if smooth is None else smooth for value, smooth in every)


def _steps_in_words(order: list[Occurrence]) -> str:
    runs: list[list[Occurrence]] = []
    for step in order:
        if runs and runs[-1][0].case == step.case and runs[-1][0].duration == step.duration:
            runs[-1].append(step)
        else:
            runs.append([step])
    run_texts = (f"{len(r)} × {r[0].case}" if len(r) > 1 else r[0].case for r in runs)
    end = order[-1].begin + order[-1].duration
    return f"Sequence of {', '.join(run_texts)}; {end:g} s. Stresses are those of its cases."


def _motion(
    name: str, motions: Mapping[str, LinkageMotion], order: list[Occurrence]
) -> LinkageMotion:
    used = {step.case: motions[step.case] for step in order}
    times = {case: m.time for case, m in used.items()}
    unloaded = {case: replace(m, applied=(), aside=()) for case, m in used.items()}
    whole = _course(unloaded, times, order)

    def loads(key: Literal["applied", "aside"]) -> tuple[AppliedForce, ...]:
        found = []
        for case, m in used.items():
            for load in getattr(m, key):
                of = {c: np.zeros((len(n.centre), load.force.shape[1])) for c, n in used.items()}
                force = _course(of | {case: load.force}, times, order)
                found.append(AppliedForce(load.body, _carried(load, m, whole), force))
        return tuple(found)

    def later(step: Occurrence, extreme: tuple[float, float | None]) -> tuple[float, float]:
        value, time = extreme
        case_time = 0.0 if time is None else time - _first(times[step.case])
        return value, step.begin + case_time

    links = [(k, later(s, v)) for s in order for k, v in used[s.case].poorest.items()]
    angles = {k: min((v for link, v in links if link == k)) for k in dict.fromkeys(dict(links))}
    worst = max((later(s, used[s.case].worst_condition) for s in order), key=lambda v: v[0])
    violation = max(m.ledger.violation for m in used.values())
    return replace(
        whole,
        case=name,
        time=_axis(times, order),
        applied=loads("applied"),
        aside=loads("aside"),
        ledger=replace(whole.ledger, violation=violation),
        extremes=Extremes(angles, worst),
    )


def _carried(load: AppliedForce, own: LinkageMotion, whole: LinkageMotion) -> Floats:
    """Return the positions (T, 2) of the point at which a load acts; its body carries the point
    through all steps.

    own: motion of the case with the load. whole: motion of the sequence.
    """
    if load.body not in whole.bodies:  # on the ground
        return np.repeat(load.position[:1], len(whole.centre), axis=0)
    b = whole.bodies.index(load.body)
    turned = np.radians(np.nan_to_num(whole.angle[:, b] - own.angle[0, b]))  # no angle: a particle
    x, y = load.position[0] - own.centre[0, b]
    cos, sin = np.cos(turned), np.sin(turned)
    at = whole.centre[:, b] + np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)
    return np.asarray(at)


def _jumps(motions: Mapping[str, LinkageMotion], order: list[Occurrence]) -> str:
    """Return a sentence that names the cases that do not begin where the case before them ends;
    empty if there are none.
    """
    jumps: dict[str, None] = {}
    for one, two in pairwise(order):
        end, begin = (motions[s.case].joint_position for s in (one, two))
        size = float(np.ptp(begin[0], axis=0).max()) or 1.0
        if np.abs(end[-1] - begin[0]).max() > JUMP_TOLERANCE * size:
            jumps[f"{one.case} and {two.case}"] = None
    return f" The linkage jumps between {'; '.join(jumps)}." if jumps else ""


def _drive(
    name: str,
    tables: Mapping[str, DriveTable | None],
    times: Mapping[str, Floats | None],
    order: list[Occurrence],
) -> DriveTable:
    """Return a drive's table over a sequence.

    tables: of the drive, for each case; None where something else holds the linkage, so that the
    drive's force is zero.
    """
    known = next(t for t in tables.values() if t is not None)
    whole = {
        case: t or _idle(known, 1 if (course := times[case]) is None else len(course))
        for case, t in tables.items()
    }
    joined, axis = _course(whole, times, order), _axis(times, order)
    work, done = [], 0.0
    for step in order:
        case_work = whole[step.case].work
        work.append(done + (case_work if times[step.case] is not None else np.zeros(2)))
        done = float(work[-1][-1])
    efforts = [(step, _effort(whole[step.case])) for step in order]
    effort = _over(efforts, float(np.nanmax(joined.position) - np.nanmin(joined.position)))
    return replace(joined, case=name, time=axis, work=np.concatenate(work), effort=effort)


def _work(study: Study, drives: list[DriveTable]) -> str:
    unit, factor = study.system.unit("energy"), study.system.factor("energy")
    drive_texts = (f"{d.name} {engineering(d.work[-1] / factor)} {unit}" for d in drives)
    return f"Work per cycle: {', '.join(drive_texts)}."


def _idle(drive: DriveTable, count: int) -> DriveTable:
    unknown, zero = np.full(count, np.nan), np.zeros(count)
    return DriveTable(
        *("", None, unknown, unknown, unknown, zero, zero, zero, zero, zero), drive.name, drive.kind
    )


def _effort(table: DriveTable) -> DriveEffort:
    """Return a drive's effort with times counted from the beginning of the case."""
    if table.effort is not None:
        begin, e = _first(table.time), table.effort
        return replace(e, time=e.time - begin, power_time=e.power_time - begin)
    size, force = table.largest, float(table.force[0])
    return DriveEffort(size, 0.0, force, size, table.largest_power, 0.0, 0.0)


def _over(efforts: list[tuple[Occurrence, DriveEffort]], stroke: float) -> DriveEffort:
    lasts = np.array([step.duration for step, _ in efforts])
    mean, rms = (np.array([getattr(e, key) for _, e in efforts]) for key in ("mean", "rms"))
    step, most = max(efforts, key=lambda pair: pair[1].largest)
    busy, strongest = max(efforts, key=lambda pair: pair[1].power)
    return DriveEffort(
        most.largest,
        step.begin + most.time,
        float(lasts @ mean / lasts.sum()),
        float(np.sqrt(lasts @ rms**2 / lasts.sum())),
        strongest.power,
        busy.begin + strongest.power_time,
        max(stroke, *(e.stroke for _, e in efforts)),
        _frictionless((e.largest, e.frictionless) for _, e in efforts),
    )


def with_sequences(
    study: Study, loads: Mapping[str, CaseLoads], histories: tuple[PointHistory, ...]
) -> tuple[PointHistory, ...]:
    """Return the histories with the stress over every sequence whose cases are all among the loads.

    The stress is zero in cases that do not load the pin.
    """
    times = {case: case_loads.reactions.times for case, case_loads in loads.items()}
    orders = {n: list(steps(study.table.sequence[n], times)) for n in complete(study, loads)}
    return tuple(
        replace(history, cases=(*history.cases, *_sequences(history, orders)))
        for history in histories
    )


def _sequences(history: PointHistory, orders: dict[str, list[Occurrence]]) -> Iterator[CaseHistory]:
    have = {case.case: case for case in history.cases}
    for name, order in orders.items():
        if any(step.case in have for step in order):
            used = {step.case: have.get(step.case, _unloaded(history)) for step in order}
            times = {case: h.times for case, h in used.items()}
            yield replace(_course(used, times, order), case=name, times=_axis(times, order))


def _unloaded(history: PointHistory) -> CaseHistory:
    zero = np.zeros(1)
    return CaseHistory("", None, np.zeros((1, history.cases[0].stress.shape[1])), zero, zero)

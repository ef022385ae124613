"""What is to be solved: each pin, how it is held, and its loads in every case."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.pin_loads import Distribution, Floats, PinLoads
from geometry import PinLike
from loads import Reactions
from pinstress.build import CaseLoads
from pinstress.pins import material
from pinstress.study import Study


@dataclass(frozen=True)
class Task:
    """One pin, held in one way, with its loads in all the cases where it is held so.

    left_out: by case, the connections whose force and moment are not applied because their band is
    held. ranges: by case, the loads over the ranges of its impulse.
    """

    pin: PinLike
    clamps: tuple[str, ...]
    loads: tuple[PinLoads, ...]
    left_out: dict[str, tuple[str, ...]]
    ranges: dict[str, PinLoads]


def tasks(study: Study, pins: list[PinLike], loads: dict[str, CaseLoads]) -> list[Task]:
    """What is to be solved: the pins that any case loads.

    Raises: InputError when nothing is, or when all loads on a pin are at what holds it.
    """
    out = []
    for pin in pins:
        ways = dict.fromkeys(study.clamps(pin.name, case) for case in loads)
        for clamps in ways:
            task = _task(study, pin, clamps, loads)
            if task.loads:
                out.append(task)
    if not study.table.pin:
        raise study.error("the study has no pins; pinstress loads gives the reactions alone")
    if not out:
        many = "s" if len(loads) > 1 else ""
        raise study.error(
            f"case{many} {', '.join(loads)} {'do' if many else 'does'} not load "
            f"pin{'s' if len(pins) > 1 else ''} {', '.join(pin.name for pin in pins)}"
        )
    return out


def _task(study: Study, pin: PinLike, clamps: tuple[str, ...], loads: dict[str, CaseLoads]) -> Task:
    held = {pin.surface(c) for c in clamps}
    cases: list[PinLoads] = []
    left_out: dict[str, tuple[str, ...]] = {}
    ranges: dict[str, PinLoads] = {}
    for case, given in loads.items():
        here = [c for c in pin.connections if c in given.reactions.connections]
        if not here or study.clamps(pin.name, case) != clamps:
            continue
        applied = [c for c in here if c not in held]
        if not applied:
            raise study.error(
                f"case.{case}: every load on pin {pin.name} is at a clamped band "
                f"({', '.join(here)}), so nothing loads it; clamp something else"
            )
        left_out[case] = tuple(c for c in here if c in held)
        spread = study.table.case[case].distribution
        body = np.zeros(3)
        if not clamps and material(study, study.table.pin[pin.name].material).density:
            body = _own_weight(given, applied)
        cases.append(pin_loads(case, applied, given.reactions, spread, body))
        if given.range is not None:
            ranges[case] = pin_loads(case, applied, given.range.reactions, spread, body)
    return Task(pin, clamps, tuple(cases), left_out, ranges)


def pin_loads(
    case: str, applied: list[str], reactions: Reactions, distribution: Distribution, body: Floats
) -> PinLoads:
    """Reactions at some connections of a pin; body: (T, 3) m/s^2 or what broadcasts to it."""
    forces = np.stack([reactions.in_pin_axes(c) for c in applied], axis=1)
    moments = np.stack([reactions.moment_in_pin_axes(c) for c in applied], axis=1)
    return PinLoads(case, tuple(applied), forces, moments, distribution, body)


def _own_weight(case: CaseLoads, connections: list[str]) -> Floats:
    """Gravity less the pin's acceleration, (T, 3) m/s^2 in its own axes, where a mechanism moves
    it; else nought. A clamped pin's weight goes into its clamp, as the loads there do.
    """
    if case.dynamics is None:
        return np.zeros(3)
    motion, first = case.dynamics.motion, connections[0]
    for joint in motion.linkage.joints:
        if any(c.name == first for c in joint.connections):
            across = np.array(motion.linkage.gravity) - motion.joint(joint.name)[2]
            turn = case.reactions.turn[:, case.reactions.connections.index(first)]
            c, s = np.cos(turn), np.sin(turn)
            x, y = across.T
            return np.stack([c * x + s * y, c * y - s * x, np.zeros(len(x))], axis=1)
    return np.zeros(3)

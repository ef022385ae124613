"""The ends of a joint's properties, each alone and all together, as bounds of the stress for any
combination of properties, on joints drawn at random.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmarks.joints.random_pins import PinTrial, pin_trials
from benchmarks.timing import table
from fea.core.requirement import Requirement
from fea.support.contact.contact_support import profile_of
from fea.support.contact.joint_changes import JointChanges, PressedJoint
from fea.support.contact.pressure_loads import MODE_TOLERANCE
from fea.support.contact.resolution import ROUGH
from fea.support.contact.solve_joint import ContactModel
from fea.support.contact.variations import compare, nowhere
from fea.support.lugs.changes import JointChange, combined, joint_variations
from fea.support.records import TOGETHER, Variation
from pinbase.arrays import Floats

COUNT, SEED = 24, 11
LEAST_CLEARANCE = 5e-4  # diameters, in every second joint, which makes contact narrow


def together() -> str:
    """Return the table of the amounts by which the ends over the tried changes fall short of those
    over all.
    """
    rows = [x for x in map(shortfalls, joints(COUNT, SEED)) if x is not None]
    short = np.array([of for of, *_ in rows])
    tried, every = (sum(x[k] for x in rows) / len(rows) for k in (1, 2))
    names = "row, upper end", "beneath contact, upper end", "row, lower end"
    lines = [
        (name, str(len(short)), *(f"{100.0 * x:.2f}" for x in
         (np.median(of), np.quantile(of, 0.9), of.max())), f"{tried:.1f}", f"{every:.1f}")
        for name, of in zip(names, short.T, strict=True)
    ]  # fmt: skip
    head = "of", "joints", "short, median [%]", "90 % [%]", "most [%]", "tried", "of"
    return table(head, lines)


def joints(count: int, seed: int) -> list[PinTrial]:
    """Return pins under one instant of loads, every second one with at least LEAST_CLEARANCE."""
    trials = [x for x in pin_trials(2 * count, seed) if x.given.cases[0].times is None][:count]
    return [_loose(x) if k % 2 else x for k, x in enumerate(trials)]


def _loose(trial: PinTrial) -> PinTrial:
    given, pin = trial.given, profile_of(trial.given.pin)
    lugs = tuple(
        replace(
            x, clearance=max(x.clearance, LEAST_CLEARANCE * 2.0 * pin.band(x.connection).radius)
        )
        for x in given.lugs
    )
    return PinTrial(replace(given, lugs=lugs))


def shortfalls(trial: PinTrial) -> tuple[Floats, int, int] | None:
    """Return the amounts by which the ends over the tried changes fall short of those over all,
    (3,), relative; and the numbers of changes that are tried and of all changes.

    The result is None if no two changes can be combined.
    """
    given = trial.given
    model = ContactModel(profile_of(given.pin), given.material, given.lugs, ROUGH)
    contact = model.solve(given.cases[0])
    (compared,) = compare(model, [contact], Requirement(), vary=nowhere)
    joint = PressedJoint(model.waves(contact.contact), list(contact.contact))
    like = (compared.stress, compared.cells, joint)
    changes = JointChanges(model, [contact], Requirement(), [{"own": like}], ("own",))
    tried = list(joint_variations(model.whole, model.lugs))
    alone = [change for change in tried if change.what != TOGETHER]
    every = {_name(x): x for x in (*tried, *_combinations(model, alone))}
    known = model.patterns([(joint.waves, MODE_TOLERANCE)])
    (solved,), _ = changes.by([list(every.values())], known)
    of = {_name(x): (x.max_von_mises, x.beneath or 1.0) for x in solved.over}
    names = [_name(change) for change in tried if _name(change) in of]
    if len(of) == len(alone):
        return None
    whole, some = (np.array([(1.0, 1.0), *x]) for x in (of.values(), (of[x] for x in names)))
    upper = 1.0 - some.max(axis=0) / whole.max(axis=0)
    lower = some[:, 0].min() / whole[:, 0].min() - 1.0
    return np.array([*upper, lower]), len(names), len(of)


def _name(change: JointChange | Variation) -> str:
    return f"{change.what} {change.value}"


def _combinations(model: ContactModel, singles: Sequence[JointChange]) -> list[JointChange]:
    """Return every combination of two or more properties, each at either end."""
    ends: dict[str, list[JointChange | None]] = {}
    for change in singles:
        ends.setdefault(change.what, [None]).append(change)
    some = ([x for x in each if x is not None] for each in itertools.product(*ends.values()))
    return [combined(model.lugs, x) for x in some if len(x) > 1]

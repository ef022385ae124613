"""Derivatives of the largest stress of a pin in contact with its lugs: by loads and clearances.

As long as the same cells are in contact pressures are linear in both. So they are differentiated
by differences of contact alone, with the flexibilities at hand, and stress by them with the
adjoints of the pin under its pressures: no other stress is solved.

With the dimensions of the pin and the moduli its flexibility changes, of which every one takes a
new solution on all rings: they are not differentiated.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fea.core.pin_loads import PinLoads, UnitLoad
from fea.derivatives.derivatives import Adjoint
from fea.derivatives.governing import turned
from fea.derivatives.records import SolvedCase
from fea.joint.contact import Pressed
from fea.joint.solve_joint import JointModel
from geometry.arrays import Floats

STEPS = 1e-4, 1e-6  # of the largest force: the second where the first brings other cells in
LOOSER = 1e-8  # clearance that is added, of the radius
AXES = "xy"


@dataclass(frozen=True)
class JointDerivatives:
    """Of the largest stress `maximum`, Pa. by_force: Pa/N, of the force of each link across the
    pin, by connection and axis of the pin, what is out of balance then being shared by the links;
    by_clearance: Pa/m, by connection. Those are missing with which cells come into contact or leave
    it at once.
    """

    maximum: float
    by_force: dict[tuple[str, str], float]
    by_clearance: dict[str, float]


def joint_derivatives(solved: SolvedCase, model: JointModel, links: PinLoads) -> JointDerivatives:
    """Of the maximum under pressures at one instant. solved: the pin with its bands cut into rings
    under them; links: the loads that they carry.

    Raises: SolveError.
    """
    adjoint = Adjoint(solved)
    keys = [(c, axis) for c in range(len(links.surfaces)) for axis in range(len(AXES))]
    by_force: dict[tuple[str, str], float] = {}
    size = float(np.abs(links.forces).max())
    for part in STEPS:
        step = part * size
        forces = np.repeat(links.forces, 1 + 2 * len(keys), axis=0)
        for k, (c, a) in enumerate(keys):
            forces[1 + 2 * k, c, a] += step
            forces[2 + 2 * k, c, a] -= step
        none = np.zeros(len(forces), dtype=np.int64)
        before, *found = model.pressed(replace(links.at(none), forces=forces, times=None))
        for k, (c, a) in enumerate(keys):
            change = _change(model, adjoint, found[2 * k + 1], found[2 * k])
            if change is not None:
                by_force.setdefault((links.surfaces[c], AXES[a]), change / (2.0 * step))
        if len(by_force) == len(keys):
            break
    by_clearance: dict[str, float] = {}
    for k, lug in enumerate(model.lugs):
        step = LOOSER * model.whole.band(lug.connection).radius
        lugs = list(model.lugs)
        lugs[k] = replace(lug, clearance=lug.clearance + step)
        change = _change(model, adjoint, before, model.varied(tuple(lugs)).pressed(links)[0])
        if change is not None:
            by_clearance[lug.connection] = change / step
    return JointDerivatives(adjoint.top.value, by_force, by_clearance)


def _change(model: JointModel, adjoint: Adjoint, less: Pressed, more: Pressed) -> float | None:
    """Of the stress, Pa, from one contact to another; None where other cells touch."""
    if not np.array_equal(less.active, more.active):
        return None
    first, last = (model.waves([pressed])[:, 0] for pressed in (less, more))
    return of_pressures(adjoint, model.rings, last - first)


def of_pressures(adjoint: Adjoint, rings: tuple[str, ...], waves: Floats) -> float:
    """What pressures (N + 1, R, 2), Pa, of the harmonics from 0 on add to the stress, Pa."""
    total = 0.0
    for k, wave in enumerate(adjoint.waves):
        if wave.n < len(waves):
            amount = turned(wave.n, waves[wave.n].T, adjoint.top.angle)[wave.part]
            parts = tuple(zip(rings, amount.tolist(), strict=True))
            total += adjoint.of_load(k, UnitLoad("", "pressure", wave.n, parts))
    return total

"""Friction of a pin in its lugs, bounded by the pressures of contact without it.

Torque: where pin and lug turn on each other, friction is mu p on every cell, against the sliding:
the torque between them is at most mu times the integral of p R over the band. That is more than mu
F R, since pressures on an arc do not all point along their resultant. Which lugs turn on the pin,
and which way, is not known: a section's torque is at most that of all rings on one side of it, and
of all rings on the other, which react it.

Bending: as the pin bends, its surface slides along the bores where it is pressed, and friction mu
p along the axis takes a part of the bending moment while the load grows, up to mu R F on each band.
When the load falls after a larger one the sliding reverses, and friction adds to the moment. How
far that has come depends on the history, and on what sticks. Full slip under the pressures without
friction bounds it: on every ring as it changes the moment of a section most, in balance.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from fea.core.pin_loads import UnitLoad
from fea.support.bands import Bands
from fea.support.contact.bending import LoadedJoint, stations
from fea.support.contact.contact_state import ContactState
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.pressure_loads import (
    MODE_TOLERANCE,
    PressureLoads,
    PressureModes,
    pressure_modes,
)
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from fea.support.records import FRICTION, Variation
from pinbase.arrays import Floats

SLIDING, TURNING = "pin sliding as it bends", "links turning on the pin"
# Shares of the friction along the axis and around it, in both senses. On one cell they are parts of
# one friction, so that a pin that slides while links turn has some of both.
HALF, MOST = 0.5, math.sqrt(0.75)
SENSES = 1.0, -1.0
SHARES: dict[str, tuple[tuple[float, float], ...]] = {
    SLIDING: (
        *((along, 0.0) for along in SENSES),
        *(
            (along * a, around * b)
            for a, b in ((MOST, HALF), (HALF, MOST))
            for along in SENSES
            for around in SENSES
        ),
    ),
    TURNING: tuple((0.0, around) for around in SENSES),
}


def rubs(lugs: Sequence[Lug]) -> bool:
    """Return whether any of the lugs has friction."""
    return any(lug.friction for lug in lugs)


def coefficient_words(lugs: Sequence[Lug]) -> str:
    """Return the coefficients of friction of lugs in words."""
    ends = dict.fromkeys(f"{f(lug.friction for lug in lugs):g}" for f in (min, max))
    return " to ".join(ends)


def ring_torques(model: ContactModel, states: Sequence[ContactState]) -> Floats:
    """The largest torque of friction between each ring and its lug, (T, R) N m."""
    bands = model.bands
    friction = np.array([lug.friction for lug in model.lugs])[bands.band]
    mean = np.stack([state.pressure.mean(axis=1) for state in states])
    return np.asarray(mean * _areas(bands) * bands.radius * friction)


def band_torques(model: ContactModel, states: Sequence[ContactState]) -> Floats:
    """The largest torque of friction between the pin and each lug, (T, B) N m."""
    return model.bands.sums(ring_torques(model, states))


def opposed(torques: Floats, z: Floats) -> Floats:
    """The torques (R,) on rings, in balance, by which every section has the largest torque that
    friction can cause there.

    torques: the largest of each ring, (R,) N m. z: of their middles, (R,) m.
    """
    order = np.argsort(z)
    before = np.cumsum(torques[order])
    total = before[-1]
    at_ends = np.minimum(before, total - before)  # of each ring
    at_ends[-1] = 0.0
    most = at_ends.max()
    if most <= 0.0:
        return np.zeros_like(torques)
    # Within the ring where one half of all torque is reached, a section has that half.
    out = np.zeros_like(torques)
    out[order] = np.diff(at_ends, prepend=0.0) * (0.5 * total / most)
    return out


def along_axis(model: ContactModel, contact: JointContact) -> Floats:
    """The friction along the axis over the pressure, by ring, (R,), by which every section has the
    largest change of moment that friction can cause there.
    """
    bands = model.bands
    friction = np.array([lug.friction for lug in model.lugs])[bands.band]
    force = contact.line_load[0] * bands.length[:, None]
    (of_lugs,) = bands.sums(force[None])
    largest = of_lugs[np.linalg.norm(of_lugs, axis=1).argmax()]
    # mu p along the axis turns a ring by mu R times its force.
    arm = bands.radius * (force @ (largest / (np.linalg.norm(largest) or 1.0)))
    couples = opposed(friction * np.abs(arm), bands.z)
    share: Floats = np.divide(couples, arm, out=np.zeros_like(couples), where=arm != 0.0)
    return share


def rubbed_across(model: ContactModel, contact: JointContact, own: LoadedJoint) -> float:
    """The largest bending moment of a pin whose friction along the axis adds to it, over that
    without friction.
    """
    bands, z = model.bands, stations(model.pin)
    couples = (along_axis(model, contact) * bands.radius)[:, None] * own.line_load[0]
    before = np.clip(z[:, None] - (bands.z - bands.length / 2.0), 0.0, bands.length)
    moment, by_friction = own.bending_moment(z)[0], before @ couples
    largest = [np.linalg.norm(moment + way * by_friction, axis=1).max() for way in (0.0, *SENSES)]
    return float(max(largest) / largest[0]) if largest[0] > 0.0 else 1.0


def rubbed(
    model: ContactModel, contact: JointContact, known: PressureModes | None = None
) -> tuple[PressureLoads, dict[str, list[PressureLoads]]]:
    """The loads of a contact at one instant, and those with friction by SHARES.

    known: patterns of pressures that have been solved.
    """
    bands, waves = model.bands, model.waves(contact.contact)
    patterns = model.patterns([(waves, MODE_TOLERANCE)], known)
    plain = patterns.loads(waves, contact.loads.links, model.arcs(contact.contact))
    axial = waves * along_axis(model, contact)[:, None]
    modes = pressure_modes(model.pin, model.rings, [(axial, MODE_TOLERANCE)])
    turning = turning_traction(model, opposed(ring_torques(model, contact.contact)[0], bands.z))

    def loads(along: float, around: float) -> PressureLoads:
        by_friction = modes.amounts(along * axial, "axial")
        by_friction |= {unit: around * amount for unit, amount in turning.items()}
        return replace(plain, acting={**plain.acting, **by_friction})

    return plain, {name: [loads(*share) for share in every] for name, every in SHARES.items()}


def friction_variations(
    lugs: Sequence[Lug], ratios: dict[str, list[tuple[float, float, float]]], across: float
) -> Iterator[Variation]:
    """Yield the bounds by friction of the stress, relative to that without.

    ratios: of the row, the surface and what lies beneath, by the kind of sliding. across: of the
    moment where friction adds to it.
    """
    words = coefficient_words(lugs)
    for name, which, kind, growth in (
        ("load growing", min, SLIDING, 1.0),
        ("load falling after a larger one", max, SLIDING, across),
        (TURNING, max, TURNING, 1.0),
    ):
        row, surface, deep = (which(each) for each in zip(*ratios[kind], strict=True))
        name = f"{words}, {name}"
        yield Variation(FRICTION, name, row, beneath=deep, across=growth, surface=surface)


def _areas(bands: Bands) -> Floats:
    return 2.0 * np.pi * bands.radius * bands.length


def turning_traction(model: ContactModel, torque: Floats) -> dict[UnitLoad, Floats]:
    """The traction about the axis of torques (R,) N m on rings, as a unit load with its amount
    (1, 2) at one instant; none where there is no torque.

    It is one pattern over all rings, as those along the axis are: within a lug it has no edge.
    """
    shear = torque / (_areas(model.bands) * model.bands.radius)
    size = float(np.linalg.norm(shear))
    if size == 0.0:
        return {}
    parts = tuple(zip(model.rings, (shear / size).tolist(), strict=True))
    return {UnitLoad("", "around", 0, parts): np.array([[0.0, size]])}

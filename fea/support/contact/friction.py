"""Bounds of the effects of friction between a pin and its lugs, from contact without friction.

Torque: where a lug turns on the pin, the friction on every cell is mu p, against the sliding. The
torque between lug and pin is then at most mu times the integral of p R over the band. That is more
than mu F R, since pressures on an arc do not all point along their resultant. Which lugs turn on
the pin, and in which sense, is unknown. The torque in a section is at most that of all rings on one
side of it, and at most that of all rings on the other side, which react it.

Bending: as the pin bends, its surface slides along the bores where it is pressed. While the load
grows, the friction mu p along the axis carries a part of the bending moment, up to mu R F on each
band. When the load falls after a larger one, the sliding reverses, and friction adds to the moment.
How far it has reversed depends on the load history and on where the surfaces stick. Full slip under
the pressures without friction is a bound: friction acts on every ring in the sense that changes the
moment in the sections most, and is in balance.
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
# Shares of the friction that act along the axis and around it, in both senses. Both are components
# of one friction on a cell, so that a pin that slides while links turn has some of both.
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
    """Return the range of the coefficients of friction of the lugs as text."""
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
    """The torques on rings, (R,) N m, that are in balance and give every section the largest torque
    that friction can cause there.

    torques: largest friction torque on each ring, (R,) N m.
    z: of the middles of the rings, (R,) m.
    """
    order = np.argsort(z)
    before = np.cumsum(torques[order])
    total = before[-1]
    at_ends = np.minimum(before, total - before)  # largest torque at the end of each ring
    at_ends[-1] = 0.0
    most = at_ends.max()
    if most <= 0.0:
        return np.zeros_like(torques)
    # A section within the ring where half of the total torque is reached has that half. Only the
    # ends of rings are seen here, so that all torques are scaled up to reach it.
    out = np.zeros_like(torques)
    out[order] = np.diff(at_ends, prepend=0.0) * (0.5 * total / most)
    return out


def along_axis(model: ContactModel, contact: JointContact) -> Floats:
    """The ratio of the friction along the axis to the pressure on each ring, (R,), that gives every
    section the largest change of moment that friction can cause there.
    """
    bands = model.bands
    friction = np.array([lug.friction for lug in model.lugs])[bands.band]
    force = contact.line_load[0] * bands.length[:, None]
    (of_lugs,) = bands.sums(force[None])
    largest = of_lugs[np.linalg.norm(of_lugs, axis=1).argmax()]
    # A friction mu p along the axis gives a ring a couple of mu R times its force.
    arm = bands.radius * (force @ (largest / (np.linalg.norm(largest) or 1.0)))
    couples = opposed(friction * np.abs(arm), bands.z)
    share: Floats = np.divide(couples, arm, out=np.zeros_like(couples), where=arm != 0.0)
    return share


def rubbed_across(model: ContactModel, contact: JointContact, own: LoadedJoint) -> float:
    """The largest bending moment with friction along the axis that adds to it, divided by that
    without friction.

    own: the pin in its lugs without friction.
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
    """The loads of a contact at one instant without friction, and with friction for each of SHARES.

    known: existing patterns of pressures.
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
    """Yield the variations of the stress by friction, relative to the stress without friction.

    ratios: for each kind of sliding, the ratios of the row, of the surface and beneath contact.
    across: ratio of the bending moment where friction adds to it.
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
    """The traction around the axis by torques (R,) N m on rings, as a unit load with its amount
    (1, 2) at one instant; empty without torques.

    All rings are parts of one pattern, like those along the axis, so that the traction has no edges
    within a lug.
    """
    shear = torque / (_areas(model.bands) * model.bands.radius)
    size = float(np.linalg.norm(shear))
    if size == 0.0:
        return {}
    parts = tuple(zip(model.rings, (shear / size).tolist(), strict=True))
    return {UnitLoad("", "around", 0, parts): np.array([[0.0, size]])}

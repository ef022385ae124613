"""Friction of sliders and pins, and radial forces of teeth, in proportion to contact forces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from loads.forces.force_balance import ForceBalance
from loads.linkage.friction import MAX_ENUMERATED_CONTACTS, JammingError, contact_sizes
from loads.linkage.linkage import LinkageError
from loads.motion.joint_forces import loops_of_sliders
from pinbase.arrays import Complex, Floats

# Relative to the fastest coordinate of the course: a slower slider or pin counts as at rest.
MIN_SLIDING_SPEED = 1e-13


@dataclass(frozen=True)
class ContactSource:
    """A force (couple) in proportion to the magnitude of a contact force.

    It is the friction of a slider, the friction couple of a pin, or the radial force of teeth.
    which: number of the slider, connection or pair of teeth.
    share: (T,) force (couple) per newton of the contact force, with its sign; m for a pin.
    f: (T, rows) multipliers due to one newton (newton metre) of the force (couple).
    couples: (T, items) couples that items require in addition, per newton metre of the couple.
    spread: (T, teeth) radial forces of teeth, per newton of the force.
    """

    name: str
    kind: Literal["slider", "pin", "teeth"]
    which: int
    share: Floats
    f: Floats
    couples: Floats
    spread: Floats


def sources_of(balance: ForceBalance) -> list[ContactSource]:
    """All forces in proportion to contact forces: friction (if any), and radial forces of teeth."""
    rubbing = [*_rubbing_sliders(balance), *_rubbing_pins(balance)] if balance.rubs else []
    return [*rubbing, *_teeth(balance)]


def _opposing(balance: ForceBalance, speed: Floats) -> Floats:
    """Sign (T,) of friction at sliding speeds (T,) m/s: opposite to the speed, 0 at rest."""
    return np.where(np.abs(speed) > MIN_SLIDING_SPEED * balance.motion.pace, -np.sign(speed), 0.0)


def _rubbing_sliders(balance: ForceBalance) -> Iterator[ContactSource]:
    """The friction of each slider that has friction.

    Raises: LinkageError for a slider whose couple, and so whose friction, is indeterminate.
    """
    motion, first = balance.motion, balance.loops.frames - 1
    unguided = loops_of_sliders(balance.loops)
    for k, s in enumerate(motion.linkage.sliders):
        if s.friction:
            push = np.zeros_like(motion.q)
            push[:, first + k] = -1.0
            share = s.friction * _opposing(balance, motion.v[:, first + k])
            if s.bearing is not None and share.any() and (loop := unguided.get(k)):
                raise LinkageError(
                    f"sliders {', '.join(loop)} form a loop in which no body can turn, so "
                    "rigid-body statics does not divide the couple among them, by which the pads "
                    f"of {s.name} rub; remove its bearing (the couple is then carried without "
                    "friction), or let a body of the loop turn on a pin",
                    "couple-indeterminate",
                    ("slider", s.name),
                )
            f = balance.multipliers(push, balance.no_forces)
            yield ContactSource(
                f"slider {s.name}", "slider", k, share, f, balance.no_couples, balance.no_spread
            )


def _rubbing_pins(balance: ForceBalance) -> Iterator[ContactSource]:
    """The friction couple of each pin that has friction."""
    linkage, motion = balance.motion.linkage, balance.motion
    for c, (joint, connection) in enumerate(linkage.connections):
        if connection.friction:
            couples = balance.no_couples.copy()
            for name, sign in ((connection.body, -1.0), (linkage.carrier(joint), 1.0)):
                if (i := linkage.index[name]) < couples.shape[1]:  # not the ground
                    couples[:, i] = sign
            f = balance.multipliers(
                balance.generalised(balance.no_forces, couples), balance.no_forces
            )
            speed = motion.turning(joint, connection) * linkage.length_scale
            share = connection.friction * _opposing(balance, speed)
            name = f"pin {joint.name} at {connection.name}"
            yield ContactSource(name, "pin", c, share, f, couples, balance.no_spread)


def _teeth(balance: ForceBalance) -> Iterator[ContactSource]:
    """The radial force of each pair of teeth."""
    for g, teeth in enumerate(balance.motion.linkage.teeth):
        spread = balance.no_spread.copy()
        spread[:, g] = 1.0
        f = balance.multipliers(np.zeros_like(balance.motion.q), balance.no_forces, spread)
        share = np.full(len(f), np.tan(teeth.pressure_angle))
        yield ContactSource(f"teeth {teeth.name}", "teeth", g, share, f, balance.no_couples, spread)


def _contact_forces(
    balance: ForceBalance,
    sources: list[ContactSource],
    f: Floats,
    needed: Complex,
    by: ContactSource | None = None,
) -> list[Complex]:
    """Contact forces at each source, (T, contacts) N, complex.

    They are the forces of pads along their normal, of pins in the plane, and of teeth along the
    pitch circle.
    f: (T, rows) multipliers. needed: (T, items) N, forces that the items require.
    by: the source whose unit force causes these contact forces; None for the forces that the bodies
    require.
    """
    couples, spread = (by.couples, by.spread) if by else (balance.couples, None)
    closing = balance.closing(f, spread)
    slides = any(s.kind == "slider" for s in sources)
    normal, couple = balance.slider_forces(closing, f, needed, couples) if slides else (f, f)
    pins = balance.connections.forces(needed, closing)
    tangential = f[:, 2 * len(balance.loops.closing) : balance.loops.guides]
    out = []
    for s in sources:
        if s.kind == "pin":
            out.append(pins[:, [s.which]])
        elif s.kind == "teeth":
            out.append(tangential[:, [s.which]].astype(complex))
        else:
            # Two pads at the distance `bearing` carry the couple by a pair of forces.
            n, bearing = normal[:, s.which], balance.loops.linkage.sliders[s.which].bearing
            pads = [n]
            if bearing is not None:
                pads = [n / 2 + sign * couple[:, s.which] / bearing for sign in (1.0, -1.0)]
            out.append(np.stack(pads, axis=1).astype(complex))
    return out


def with_contacts(
    balance: ForceBalance, f: Floats, sources: list[ContactSource]
) -> tuple[Floats, Floats]:
    """Forces (couples) of the sources, (T, sources), and the multipliers that include them.

    f: (T, rows) multipliers without the sources.

    Raises: LinkageError for too many contacts with friction; JammingError.
    """
    free = _contact_forces(balance, sources, f, balance.needed)
    owner = [i for i, contacts in enumerate(free) for _ in range(contacts.shape[1])]
    rubbing = sum(sources[i].kind != "teeth" for i in owner)
    if rubbing > MAX_ENUMERATED_CONTACTS:
        raise LinkageError(
            f"{rubbing} contacts have friction; at most {MAX_ENUMERATED_CONTACTS} can be solved",
            "too-many-contacts",
        )
    # Contact forces due to one unit of each source; times the share of each contact's source, they
    # are the response of all contact forces to the size of that contact force.
    unit = [
        np.concatenate(_contact_forces(balance, sources, s.f, balance.no_forces, s), 1)
        for s in sources
    ]
    response = np.stack([unit[i] * sources[i].share[:, None] for i in owner], axis=2)
    try:
        sizes = contact_sizes(np.concatenate(free, axis=1), response)
    except JammingError as error:
        raise _named(balance, error, response, [sources[i].name for i in owner]) from None
    amounts = np.zeros((len(f), len(sources)))
    for k, i in enumerate(owner):
        amounts[:, i] += sources[i].share * sizes[:, k]
    for i, s in enumerate(sources):
        f = f + amounts[:, i, None] * s.f
    return amounts, f


def _named(
    balance: ForceBalance, error: JammingError, response: Complex, names: list[str]
) -> JammingError:
    """The same error, which also names the time and the slider or pin that rubs."""
    t = int(error.instants[0])
    grips = np.abs(np.diagonal(response[t]))
    when = f"t = {balance.motion.times[t]:.6g} s" if len(balance.motion) > 1 else ""
    return JammingError(error.instants, error.none, error.grip, when, names[int(grips.argmax())])

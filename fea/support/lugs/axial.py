"""The seats at which axial forces of links enter a pin.

A link bears on the nearest shoulder on the side to which it pushes, if no other lug is between, or
on the segment that the study names: a head, a collar, a nut. Otherwise its force is a shear over
its band that fades towards the edges (friction, a press fit). Torques always are such shears (a
key, a press fit).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fea.core.peak import Reason
from fea.core.pin_loads import MOMENT_ROUND_OFF, PinLoads
from fea.support.lugs.lug import Lug
from geometry import ArgumentError, Pin, PinLike, body_of_revolution
from geometry.shape.band import SHOULDER

SAME_DIAMETER = 1e-9  # relative: a segment that is thicker by less is no shoulder


def axial_seats(pin: Pin, lugs: Sequence[Lug]) -> dict[str, tuple[str, str]]:
    """The surfaces that take the axial force of each link, towards the start of the pin and towards
    its end, by connection; a link that bears on its own band in both senses has no entry.

    Raises: ArgumentError for a lug whose `axial` names no segment of the pin, a segment on which
    another link bears, or a segment on the wrong side.
    """
    out = {}
    for lug in lugs:
        if lug.connection not in pin.labels:
            continue
        if lug.axial is None:
            seats = _shoulder(pin, lug, -1), _shoulder(pin, lug, 1)
        else:
            seats = _stated(pin, lug, 0), _stated(pin, lug, 1)
        if seats != (lug.connection, lug.connection):
            out[lug.connection] = seats
    return out


def structure_reacts(pin: PinLike, lugs: Sequence[Lug], mass: float, loads: PinLoads) -> PinLoads:
    """The loads with the axial forces and torques that lugs of a structure exert for balance.

    The lugs that bear on a shoulder or a named segment in the sense of the reaction share the axial
    force. Where there are none, all lugs of the structure take the force, in proportion to the
    lengths of their bands. All of them always take the torque in this way, as a key, a bolt or a
    press fit in the structure would.
    mass: of the pin, kg.
    """
    names = [lug.connection for lug in lugs if lug.connection not in pin.connections]
    forces, moments = np.zeros((2, len(loads), len(names), 3))
    pull = loads.forces[:, :, 2].sum(axis=1) + mass * loads.body[:, 2]
    even = np.array([pin.band(name).length for name in names])
    even /= even.sum()
    profile = body_of_revolution(pin)
    seats = {} if profile is None else axial_seats(profile, lugs)
    for side, reaction in enumerate((np.minimum(-pull, 0.0), np.maximum(-pull, 0.0))):
        bears = np.array([seats.get(name, (name, name))[side] != name for name in names])
        forces[:, :, 2] += np.outer(reaction, bears / bears.sum() if bears.any() else even)
    moments[:, :, 2] = np.outer(-loads.moments[:, :, 2].sum(axis=1), even)
    return replace(
        loads,
        surfaces=(*loads.surfaces, *names),
        forces=np.concatenate([loads.forces, forces], axis=1),
        moments=np.concatenate([np.broadcast_to(loads.moments, loads.forces.shape), moments], 1),
    )


def pulled(pin: PinLike, lugs: Sequence[Lug], loads: PinLoads, mass: float) -> bool:
    """Whether lugs of a structure must react an axial force or a torque."""
    if all(lug.connection in pin.connections for lug in lugs):
        return False
    force = np.abs(loads.forces[:, :, 2].sum(axis=1) + mass * loads.body[:, 2])
    torque = np.abs(loads.moments[:, :, 2].sum(axis=1))
    size = np.abs(loads.forces).max(initial=0.0)
    turning = max(size * pin.length, np.abs(loads.moments).max(initial=0.0))
    least = MOMENT_ROUND_OFF * max(size, turning / pin.length)
    return bool((force > least).any() or (torque > least * pin.length).any())


def _shoulder(pin: Pin, lug: Lug, step: int) -> str:
    """The face of the nearest shoulder on one side (step -1 or 1); the band itself if there is
    none.
    """
    i = pin.labels.index(lug.connection)
    bore = pin.segments[i].diameter * (1.0 + SAME_DIAMETER)
    while 0 <= i + step < len(pin.segments):
        name = f"{SHOULDER}{max(i, i + step)}"  # the number of the segment, from 1, that ends there
        i += step
        beyond = pin.segments[i]
        if beyond.diameters[0 if step > 0 else 1] > bore and pin.shoulder(name) is not None:
            return name
        if beyond.connection or max(beyond.diameters) > bore:
            break
    return lug.connection


def _stated(pin: Pin, lug: Lug, side: int) -> str:
    """The surface of the segment that a lug names for one side (0 start, 1 end): its face towards
    the lug if it has one, otherwise its outer surface.
    """
    assert lug.axial is not None
    name, what = lug.axial[side], f"lug {lug.connection}: axial"
    if name == lug.connection:
        return name
    if name not in pin.labels:
        raise ArgumentError(
            f"{what} names {name!r}, which is no segment of the pin; its segments are "
            f"{', '.join(pin.labels)}",
            "unknown-surface",
        )
    i, of_lug = pin.labels.index(name), pin.labels.index(lug.connection)
    if pin.segments[i].connection:
        raise ArgumentError(
            f"{what} names {name!r}, on which a link bears: name a segment that takes the force "
            "along the axis, as a head, a collar or a nut",
            "axial-on-band",
        )
    if len(set(lug.axial)) == 1:  # one segment holds both ways, and a face cannot pull
        return name
    if (i > of_lug) != (side == 1):
        raise ArgumentError(
            f"{what}: {name!r} is not on the side of the pin's {('start', 'end')[side]}; give the "
            "segment on the side of the start first",
            "axial-side",
        )
    face = f"{SHOULDER}{i if side else i + 1}"
    beside = pin.segments[i - 1] if side else pin.segments[i + 1]
    thicker = pin.segments[i].diameters[1 - side] > beside.diameters[side]
    return face if thicker and pin.shoulder(face) is not None else name


def seats_note(links: PinLoads, lugs: Sequence[Lug]) -> Reason | None:
    """Return the seats of the axial forces of a case as the end of a note; None without such
    forces.
    """
    names = {lug.connection for lug in lugs}
    parts = []
    for c, name in enumerate(links.surfaces):
        pull = links.forces[:, c, 2]
        if name not in names or not pull.any():
            continue
        low, high = links.seats.get(name, (name, name))
        acting = dict.fromkeys(x for x, on in ((low, pull < 0.0), (high, pull > 0.0)) if np.any(on))
        seats = " and ".join("its own band" if x == name else x for x in acting)
        parts.append(f"that of {name} on {seats}")
    if not parts:
        return None
    return Reason(f"; forces along the axis: {', '.join(parts)}", ("axial-seats",))

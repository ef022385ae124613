"""Links with two ears, whose load is divided into loads on the bands on which the ears bear.

A force across the axis acts midway between the ears, which share it. A moment across the axis is a
couple of forces on the ears, by statics. A force along the axis acts on the ear on the side towards
which it pushes, since it holds the other ear off. A torque is shared.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from geometry import Band, PinLike
from pinbase.arrays import Floats


class Ears(NamedTuple):
    """The second ear of a clevis.

    name: of its band.
    z, other_z: middles of the connection's band and of the second ear's band, m.
    """

    name: str
    z: float
    other_z: float


def bands_of(connection: str, pin: PinLike, ears: Mapping[str, str]) -> dict[str, Band]:
    """The bands on which a link bears, by name: the connection's band and, for a clevis, the second
    ear's.

    ears: the name of the second ear, by connection.
    """
    names = [connection, ears[connection]] if connection in ears else [connection]
    return {name: pin.band(name) for name in names}


def middle_of(connection: str, pin: PinLike, ears: Mapping[str, str]) -> float:
    """The z of a link on a pin, m: the middle of its band; for a clevis, midway between the ears.

    ears: as in `bands_of`.
    """
    bands = bands_of(connection, pin, ears).values()
    return sum(band.middle for band in bands) / len(bands)


def on_ears(
    connections: Sequence[str], forces: Floats, moments: Floats, ears: Mapping[str, Ears]
) -> tuple[tuple[str, ...], Floats, Floats]:
    """The bands, and the forces and moments on them, about their middles.

    forces, moments: (T, C, 3) N and N m of the links; for a clevis, about the middle between its
    ears.
    """
    if not ears:
        return tuple(connections), forces, moments
    names: list[str] = []
    of_bands: list[tuple[Floats, Floats]] = []
    for c, connection in enumerate(connections):
        force, moment = forces[:, c], moments[:, c]
        if connection not in ears:
            names.append(connection)
            of_bands.append((force, moment))
            continue
        other, z, other_z = ears[connection]
        apart = other_z - z
        couple = np.stack([moment[:, 1], -moment[:, 0], np.zeros(len(moment))], axis=1) / apart
        # A force along the axis acts on the ear in front: at the larger z if the force is positive.
        to_other = (force[:, 2] > 0.0) == (apart > 0.0)
        torque = 0.5 * moment * [0.0, 0.0, 1.0]
        for name, sign, bears in ((connection, -1.0, ~to_other), (other, 1.0, to_other)):
            part = 0.5 * force + sign * couple
            part[:, 2] = np.where(bears, force[:, 2], 0.0)
            names.append(name)
            of_bands.append((part, torque))
    of_force, of_moment = zip(*of_bands, strict=True)
    return tuple(names), np.stack(of_force, axis=1), np.stack(of_moment, axis=1)

"""Sliding, pressure and their product at the bands of pins over a motion, on which wear depends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pinbase.dimensions import Length, Stress, Time, Velocity


@dataclass(frozen=True)
class BandWear:
    """A band of a pin over the motion of one case.

    connection: the connection of the band; for the other ear of a clevis the name of its segment.
    body: the body in whose lug the band sits.
    against: the body with which the pin turns.
    floats: whether the pin may turn with any of its links; then `against` is the link for which the
    band slides farthest, and the other numbers are the largest for any of them.
    mean_pressure: the largest force over diameter and length.
    velocity: the largest sliding velocity.
    distance: the path of sliding over the whole motion.
    pressure_velocity: the largest product of both at one instant. time: this instant.
    These numbers of sliding are None where the rotation of the body is not known (a particle).
    """

    case: str
    pin: str
    connection: str
    body: str
    against: str
    floats: bool
    mean_pressure: Stress
    velocity: Velocity | None = None
    distance: Length | None = None
    pressure_velocity: Annotated[float, "stress velocity"] | None = None
    time: Time | None = None

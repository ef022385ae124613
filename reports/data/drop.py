"""Results of a drop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pinbase.dimensions import Energies, Force, Forces, Lengths, Time, Times, Velocities, Velocity

PEAK_QUANTITIES = {  # reported quantities of a drop: name and dimension
    "vertical": ("vertical force of the ground", "force"),
    "along": ("force along the strut", "force"),
    "stroke": ("stroke of the strut", "length"),
    "deflection": ("deflection of the tyre", "length"),
    "drag": ("drag of the ground (spin-up)", "force"),
    "on_leg": ("drag that the leg passes on", "force"),
    "spring_back": ("forward force that the leg passes on (spring-back)", "force"),
}


@dataclass(frozen=True)
class DropPeak:
    """The largest value of a quantity and its time. dimension: of the value."""

    name: str
    value: Annotated[float, "own"]
    time: Time
    dimension: str


@dataclass(frozen=True)
class DropRecord:
    """A landing computed as a drop: histories (T,) over time and values derived from them.

    sink_velocity: of the sprung mass, positive downwards.
    strut: force along the strut.
    leg_drag: the part of the drag that the leg transmits.
    peaks: by the names of PEAK_QUANTITIES.
    load_factor: vertical force over the weight.
    imbalance: largest imbalance of the energies over the initial kinetic energy.
    impulse_force: m V over impulse_time.
    equal_impulse_time: the impulse time at which this force equals that of the drop.
    spin_up: largest drag by appendix D to 14 CFR part 23; None without a wheel.
    closing, opening: (P,) vertical force over the strokes (P,) of the first compression and
    extension.
    """

    case: str
    clause: str
    velocity: Velocity
    weight: Force
    lift: float
    time: Times
    stroke: Lengths
    deflection: Lengths
    sink_velocity: Velocities
    vertical: Forces
    drag: Forces
    strut: Forces
    leg_drag: Forces
    energies: dict[str, Energies]
    peaks: dict[str, DropPeak]
    load_factor: float
    imbalance: float
    impulse_time: Time
    impulse_force: Force
    equal_impulse_time: Time
    spin_up: Force | None
    strokes: Lengths
    closing: Forces
    opening: Forces

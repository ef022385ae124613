"""Results of fatigue: histories of stress at points, and the damage there."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pinbase.dimensions import Floats, Point, Stress, Stresses, Times

ERROR_OF_STRESS = "error"  # the numerical error of the stress, among what is open of it


@dataclass(frozen=True)
class CaseHistory:
    """The stress at a point in one case.

    stress: (T, 6) Pa; rr, tt, zz, tz, rz, rt for a body of revolution; xx, yy, zz, yz, xz, xy for
    any other.
    von_mises, signed: (T,) Pa, without and with a sign (assess.fatigue.critical_points).
    times: (T,) s, None without a motion.
    """

    case: str
    times: Times | None
    stress: Stresses
    von_mises: Stresses
    signed: Stresses


@dataclass(frozen=True)
class PointHistory:
    """A critical point of a pin, numbered from 1, with its stress in all solved cases.

    location: in the pin's axes.
    chosen: the reason, in words.
    cylindrical: whether stresses have the components of a body of revolution.
    """

    pin: str
    point: int
    location: Point
    chosen: str
    cases: tuple[CaseHistory, ...]
    cylindrical: bool = False

    def in_pin_axes(self, direction: Floats) -> tuple[float, float, float]:
        """A direction (3,) in the pin's axes, from one in the axes of the stresses."""
        first, second, z = direction.tolist()
        angle = math.atan2(self.location[1], self.location[0]) if self.cylindrical else 0.0
        c, s = math.cos(angle), math.sin(angle)
        return c * first - s * second, s * first + c * second, z


@dataclass(frozen=True)
class PointFatigue:
    """Damage at a point per unit of the spectrum (a flight, say).

    It is for the failure probability that the study requests.
    life: units until damage 1, None without damage.
    lives: the same at 10, 50 and 90 %, empty without a scatter.
    utilisation: damage times the design life.
    amplitude, mean: of the largest cycle, uncorrected.
    amplitudes: (C,) Pa, of all cycles that may do damage, corrected for the mean, the largest
    first.
    counts: of each per unit.
    method: of the equivalent stress.
    note: remarks on the assessment.
    normal: of the critical plane, in the pin's axes; amplitude and mean are then those of its shear
    stress.
    largest_damage: over the error of the stress and all ranges that the study leaves open; None
    where there are none. damage_over: over each of them.
    """

    pin: str
    point: int
    location: Point
    cases: tuple[str, ...]
    method: str
    damage: float
    life: float | None
    lives: tuple[float | None, ...]
    utilisation: float | None
    amplitude: Stress
    mean: Stress
    amplitudes: Stresses
    counts: Floats
    note: str = ""
    normal: tuple[float, float, float] | None = None
    largest_damage: float | None = None
    damage_over: Mapping[str, float] = field(default_factory=dict)

    def open_beyond(self, damage: float) -> tuple[str, ...]:
        """Names of what is open that takes the damage beyond one not reached as described."""
        if not self.damage <= damage < (self.largest_damage or 0.0):
            return ()
        alone = tuple(what for what, over in self.damage_over.items() if over > damage)
        return alone or tuple(self.damage_over)

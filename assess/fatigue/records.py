"""Results of the fatigue assessment: stress histories at points, and the damage there."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pinbase.dimensions import Floats, Point, Stress, Stresses, Times

ERROR_OF_STRESS = "error"  # the numerical error, as one of the uncertainties of the stress


@dataclass(frozen=True)
class CaseHistory:
    """The stress at a point in one load case.

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
        """Return a direction in the pin's axes. direction: (3,) in the axes of the stresses."""
        first, second, z = direction.tolist()
        angle = math.atan2(self.location[1], self.location[0]) if self.cylindrical else 0.0
        c, s = math.cos(angle), math.sin(angle)
        return c * first - s * second, s * first + c * second, z


@dataclass(frozen=True)
class PointFatigue:
    """The fatigue damage at a point per unit of the spectrum (for example per flight).

    damage: for the failure probability that the study requests.
    life: units until the damage is 1; None without damage.
    lives: the lives at failure probabilities of 10, 50 and 90 %; empty without a scatter.
    utilisation: damage times the design life; None without a design life.
    amplitude, mean: of the largest cycle, not corrected for the mean stress.
    amplitudes: (C,) Pa, of all cycles that may do damage, corrected for the mean stress, the
    largest first.
    counts: (C,) how often each amplitude occurs per unit.
    method: the method of the equivalent stress.
    note: remarks on the assessment.
    normal: normal of the critical plane, in the pin's axes; amplitude and mean are then those of
    the shear stress on this plane.
    largest_damage: the largest damage over the error of the stress and all ranges that the study
    leaves open together; None if there are none. damage_over: the damage over each of them alone.
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
        """Return the names of the uncertainties that raise the damage above a given one.

        damage: a damage that the pin as described does not exceed; if it does, the result is empty.
        If no uncertainty alone raises the damage so far, but all together do, all are named.
        """
        if not self.damage <= damage < (self.largest_damage or 0.0):
            return ()
        alone = tuple(what for what, over in self.damage_over.items() if over > damage)
        return alone or tuple(self.damage_over)

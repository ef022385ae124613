"""The curve of safety factors against one number of a study, as plain data."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

from assess.judgement import OUTCOME_ORDER
from pinbase.grouped import grouped

CURVE_NAME = "curve"
MAX_POWER_RATIO = 5.0  # of neighbouring values between which a factor is taken as a power
AS_DESCRIBED = "as described"  # follows an outcome where only a run finds the range over the joint


@dataclass(frozen=True)
class CurvePoint:
    """One pin in one case at one value of the number, in the curve's units.

    error_estimate: error of max_von_mises; both are None where the design could not be solved, for
    `reason`.
    safety_factor: None without a maximum or a yield strength.
    outcome, depends_on: as in the results of a run.
    """

    value: float
    pin: str
    case: str
    max_von_mises: float | None
    error_estimate: float | None
    safety_factor: float | None
    outcome: str
    depends_on: str = ""
    verdict: str = ""
    reason: str = ""

    @property
    def rank(self) -> tuple[int, float]:
        """The sort key of cases: the worst outcome, then the smallest factor, comes first."""
        outcome = self.outcome.removesuffix(f" {AS_DESCRIBED}")
        return OUTCOME_ORDER[outcome], self.known_factor

    @property
    def known_factor(self) -> float:
        """The safety factor; 0 where it is unknown, inf where no load stresses the pin."""
        return math.inf if self.max_von_mises == 0.0 else self.safety_factor or 0.0

    @property
    def factor_ends(self) -> tuple[float, float] | None:
        """The safety factor at the upper and at the lower end of the error of the maximum; None
        without a factor.
        """
        factor, stress = self.safety_factor, self.max_von_mises
        if factor is None or not stress:
            return None
        error = (self.error_estimate or 0.0) / stress
        return factor / (1.0 + error), factor / (1.0 - error) if error < 1.0 else math.inf


@dataclass(frozen=True)
class Crossing:
    """A value of the number at which a pin's factor passes the required one.

    between: the neighbouring computed values.
    value: interpolated between them.
    rising: whether the factor is reached above this value, rather than below it.
    """

    pin: str
    between: tuple[float, float]
    value: float
    rising: bool


@dataclass(frozen=True)
class FactorCurve:
    """The safety factors of pins against one number of a study.

    key, unit: of the number.
    nominal: the value of the number in the study.
    required: the factor to reach, if any.
    stress_unit: the unit of the points' stresses.
    points: in the order of rising values.
    in_lugs: the pins whose lugs are not judged.
    other_checks: the checks besides yield that a run makes and that are not made here.
    """

    study: str
    key: str
    unit: str
    nominal: float
    required: float | None
    stress_unit: str
    points: tuple[CurvePoint, ...]
    in_lugs: tuple[str, ...] = ()
    other_checks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        first, last = self.values[0], self.values[-1]
        many = f"pins: {len(self.pins)}, values: {len(self.values)}"
        return f"<FactorCurve {self.key} {first:.4g} to {last:.4g} {self.unit}: {many}>"

    @property
    def pins(self) -> tuple[str, ...]:
        """The pins in their order."""
        return tuple(dict.fromkeys(point.pin for point in self.points))

    @property
    def values(self) -> tuple[float, ...]:
        """The values of the number, rising."""
        return tuple(dict.fromkeys(point.value for point in self.points))

    def least(self, pin: str) -> tuple[CurvePoint, ...]:
        """Return the pin's case with the smallest factor at every value of the number.

        Cases without a factor precede all others, since nothing is known about them.
        """
        by_value = grouped((point.value, point) for point in self.points if point.pin == pin)
        return tuple(min(points, key=lambda p: p.known_factor) for points in by_value.values())

    def worst(self, pin: str) -> tuple[CurvePoint, ...]:
        """Return the worst case of a pin at every value; its factor need not be the smallest, since
        another case may require less.
        """
        by_value = grouped((point.value, point) for point in self.points if point.pin == pin)
        return tuple(min(points, key=lambda p: p.rank) for points in by_value.values())

    @property
    def moves(self) -> bool:
        """Whether any result differs between values; True if fewer than two values were solved."""
        known = [p for p in self.points if p.max_von_mises is not None]
        by_row = grouped(
            ((p.pin, p.case), (p.max_von_mises, p.safety_factor, p.outcome)) for p in known
        )
        return len({p.value for p in known}) < 2 or any(len(set(x)) > 1 for x in by_row.values())

    @property
    def reached(self) -> tuple[Crossing, ...]:
        """The values at which pins pass the required factor.

        The logarithm of the factor is interpolated linearly between neighbouring values: over their
        logarithms, as a power of the number, unless one value is many times the other.
        """
        out = []
        for pin in self.pins if self.required else ():
            for left, right in pairwise(self.least(pin)):
                ends = left.safety_factor, right.safety_factor
                if not all(ends):
                    continue
                low, high = (math.log((f or 1.0) / (self.required or 1.0)) for f in ends)
                if (low < 0.0) == (high < 0.0):
                    continue
                share = low / (low - high)
                value = _between(left.value, right.value, share)
                out.append(Crossing(pin, (left.value, right.value), value, high > low))
        return tuple(out)


def _between(left: float, right: float, share: float) -> float:
    """Return the value at a share of the way from one value to another."""
    if left > 0.0 and right <= MAX_POWER_RATIO * left:
        return float(left * (right / left) ** share)
    return left + share * (right - left)

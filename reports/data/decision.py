"""Factors and utilisations of rows with their errors, and which row is worst."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from assess.judgement import OUTCOME_ORDER
from reports.data.results import Results
from reports.data.row import PinResult

Ends = tuple[float, float]


def factor_ends(pin: PinResult) -> Ends:
    """Return the lower and upper end of a row's safety factor, by the error of the maximum.

    An end is inf where no stress may be left. The row must have a factor.
    """
    if pin.safety_factor_interval is not None:
        low, high = pin.safety_factor_interval
        return low, inf if high is None else high
    factor, stress, error = pin.safety_factor or 0.0, pin.max_von_mises, pin.error_estimate or 0.0
    if not stress:
        return factor, factor
    least = stress - error
    return factor * stress / (stress + error), factor * stress / least if least > 0.0 else inf


def low_factor(pin: PinResult) -> float | None:
    """Return the factor of a row by the largest of these stresses; None without one."""
    if pin.safety_factor is None or not pin.max_von_mises:
        return None
    return min(factor_ends(pin)[0], beneath_factor(pin))


def beneath_factor(pin: PinResult) -> float:
    """Return the factor by the stress beneath contact with its error; inf without any."""
    contact = pin.places and pin.places.contact
    if not contact or not contact.upper_end or pin.yield_strength is None:
        return inf
    return (contact.strength or pin.yield_strength) / contact.upper_end


def limit(pin: PinResult) -> float:
    """Return the factor that is required of a row; 1, at which a pin yields, without one."""
    return pin.required or 1.0


def common_factor(pins: Iterable[PinResult]) -> float | None:
    """Return the factor that is required of all rows, None without one or where they differ."""
    factors = {pin.required for pin in pins}
    return factors.pop() if len(factors) == 1 else None


def largest_factor(pins: Iterable[PinResult]) -> float | None:
    """Return the largest factor that is required of any row, None where none is required."""
    return max((pin.required for pin in pins if pin.required is not None), default=None)


def utilisation(pin: PinResult, limit: float) -> Ends | None:
    """Return the lower and upper end of required over actual factor.

    The ends are equal where the factor is a number, inf where they are unknown; None without a
    factor.
    """
    if pin.safety_factor is None:
        return None
    low, high = pin.safety_factor_interval or (pin.safety_factor, pin.safety_factor)
    return (0.0 if high is None else limit / high), (limit / low if low else inf)


def worst_first(results: Results) -> list[PinResult]:
    """Return the rows that fail, then those not decided, then the others, by utilisation: first
    where that is unknown, last where no load stresses the pin.
    """

    def place(pin: PinResult) -> tuple[int, float]:
        used = utilisation(pin, limit(pin))
        unknown = 0.0 if pin.max_von_mises == 0.0 else inf
        return OUTCOME_ORDER[pin.outcome], -(unknown if used is None else used[1])

    return sorted(results.pins, key=place)

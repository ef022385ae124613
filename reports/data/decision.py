"""Safety factors and utilisations of rows with their errors, and which row is worst."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from assess.judgement import OUTCOME_ORDER
from reports.data.results import Results
from reports.data.row import PinResult

Ends = tuple[float, float]


def factor_ends(pin: PinResult) -> Ends:
    """Return the lower and upper end of a row's safety factor, by the error of the maximum.

    The upper end is inf where the error is as large as the stress. The row must have a factor.
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
    """Return the lower end of a row's factor, by its maximum or by the stress beneath contact,
    whichever is less; None for a row without a factor.
    """
    if pin.safety_factor is None or not pin.max_von_mises:
        return None
    return min(factor_ends(pin)[0], beneath_factor(pin))


def beneath_factor(pin: PinResult) -> float:
    """Return the factor by the stress beneath contact with its error; inf without such a stress."""
    contact = pin.places and pin.places.contact
    if not contact or not contact.upper_end or pin.yield_strength is None:
        return inf
    return (contact.strength or pin.yield_strength) / contact.upper_end


def limit(pin: PinResult) -> float:
    """Return the factor that is required of a row; without one 1, at which the pin yields."""
    return pin.required or 1.0


def common_factor(pins: Iterable[PinResult]) -> float | None:
    """Return the factor that is required of all rows; None if none is required or they differ."""
    factors = {pin.required for pin in pins}
    return factors.pop() if len(factors) == 1 else None


def largest_factor(pins: Iterable[PinResult]) -> float | None:
    """Return the largest factor that is required of any row; None where none is required."""
    return max((pin.required for pin in pins if pin.required is not None), default=None)


def utilisation(pin: PinResult, limit: float) -> Ends | None:
    """Return the lower and upper end of the required factor over the actual one; None without a
    factor.

    The ends are equal where the factor is a single number. The upper end is inf where the factor
    has no positive lower end.
    """
    if pin.safety_factor is None:
        return None
    low, high = pin.safety_factor_interval or (pin.safety_factor, pin.safety_factor)
    return (0.0 if high is None else limit / high), (limit / low if low else inf)


def worst_first(results: Results) -> list[PinResult]:
    """Return the rows, the worst first: by outcome, then by falling utilisation.

    Among rows of one outcome those of unknown utilisation come first, and those that no load
    stresses last.
    """

    def place(pin: PinResult) -> tuple[int, float]:
        used = utilisation(pin, limit(pin))
        unknown = 0.0 if pin.max_von_mises == 0.0 else inf
        return OUTCOME_ORDER[pin.outcome], -(unknown if used is None else used[1])

    return sorted(results.pins, key=place)

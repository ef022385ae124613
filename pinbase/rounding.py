"""Numbers rounded to the digits that are shown, up or down, so that the message stays true."""

from __future__ import annotations

import math

SORTED_DIGITS = 9  # by which numbers are sorted; further ones may be round-off
ROUND_OFF = 1e-9  # relative amount by which a value may lie beyond its rounded value


def rounded_up(value: float, digits: int = 3) -> float:
    """Return a positive limit that must be exceeded, rounded up to some digits, as 0.0229."""
    last = _last_digit(value, digits)
    return last * math.ceil(value / last * (1.0 - ROUND_OFF))


def rounded_down(value: float, digits: int = 3) -> float:
    """Return a positive limit that must not be exceeded, rounded down to some digits."""
    last = _last_digit(value, digits)
    return last * math.floor(value / last * (1.0 + ROUND_OFF))


def without_round_off(value: float) -> float:
    """Return a number to sort by: numbers that differ only by round-off, as of one result in other
    units, become equal and so keep their order.
    """
    return float(f"{value:.{SORTED_DIGITS}g}")


def _last_digit(value: float, digits: int) -> float:
    """Return the unit of the last digit of a number that is shown with some digits."""
    return 10.0 ** (math.floor(math.log10(value)) + 1 - digits)

"""Error and safety factor of a maximum as text, with intervals for a singular row."""

from __future__ import annotations

import math

from fea.support.records import JointRange
from reports.data.decision import utilisation
from reports.data.row import PinResult, SharingRange
from reports.format.numbers import DASH, engineering

END_DIGITS = 3  # digits of factors and of an interval's ends
MAX_DIGITS = 9
ERROR_PART_WORDS = {  # of an error, in words
    "mesh": "mesh",
    "time": "time",
    "series": "terms of the bearing pressure",
    "model": "beam",
    "cells": "cells of contact",
    "truncation": "ends of the local solid",
}


def error_range(pin: PinResult, to: str = " to ") -> str:
    """Return the error of a maximum, or for a singular row its interval.

    That interval is over half and twice the excluded distance, which is a convention.
    """
    interval = pin.max_von_mises_interval
    if interval is None:
        return engineering(pin.error_estimate, 2)
    return to.join(engineering(end, END_DIGITS) for end in interval)


def factor_range(pin: PinResult, to: str = " to ") -> str:
    """Return the safety factor or its interval with three digits, which is what loads deserve."""
    interval = pin.safety_factor_interval
    if interval is None:
        return factor_text(pin.safety_factor, pin.required or 1.0)
    low, high = interval
    return to.join(
        [engineering(low, END_DIGITS), DASH if high is None else engineering(high, END_DIGITS)]
    )


def factor_text(factor: float | None, required: float) -> str:
    """Return a factor with three digits, or more where rounding would carry it past `required`."""
    if factor is None or not math.isfinite(factor):
        return DASH
    for digits in range(END_DIGITS, MAX_DIGITS):
        rounded = float(f"{factor:.{digits - 1}e}")
        if (rounded >= required) == (factor >= required):
            return engineering(factor, digits)
    return engineering(factor, MAX_DIGITS)


def utilisation_range(pin: PinResult, required: float) -> str:
    """Return required over actual factor in per cent, or its interval."""
    used = utilisation(pin, required)
    if used is None:
        return DASH
    return f"{' to '.join(dict.fromkeys(engineering(100.0 * end, END_DIGITS) for end in used))} %"


def variation_range(over: JointRange | SharingRange | None) -> str:
    """Return the maximum over what is not known of a joint, or over the stiffness of links; a dash
    where that was not computed.
    """
    return " to ".join(engineering(x, END_DIGITS) for x in over.max_von_mises) if over else DASH


def part_words(pin: PinResult) -> str:
    """Return the contributions to the error of a maximum, without those that are zero."""
    return ", ".join(
        ERROR_PART_WORDS[part] for part, value in pin.error_parts.items() if value > 0.0
    )


def error_words(pin: PinResult) -> str:
    """Return the error or interval for use in a sentence."""
    if pin.max_von_mises_interval is None:
        return f"± {error_range(pin)}"
    return f"{error_range(pin)} over half and twice the excluded distance"

"""Error and safety factor of a maximum as text; intervals for a singular row."""

from __future__ import annotations

from collections.abc import Iterable

from fea.support.records import JointRange
from reports.data.decision import limit, utilisation
from reports.data.row import PinResult, SharingRange
from reports.format.numbers import DASH, beside_limit, engineering

UNKNOWN = "unknown"  # an error that the model, or too few meshes, cannot give
END_DIGITS = 3  # digits of factors and of an interval's ends
ERROR_PART_WORDS = {  # sources of the parts of an error
    "mesh": "mesh",
    "time": "time",
    "series": "terms of the bearing pressure",
    "model": "beam",
    "cells": "cells of contact",
    "truncation": "ends of the local solid",
}


def error_range(pin: PinResult, to: str = " to ") -> str:
    """Return the error of a maximum, or for a singular row its interval.

    The interval is the one over half and twice the excluded distance, which is a convention.
    """
    interval = pin.max_von_mises_interval
    if interval is None:
        return engineering(pin.error_estimate, 2) if pin.maximum.bounded else UNKNOWN
    return _joined((engineering(end, END_DIGITS) for end in interval), to)


def percent_error(pin: PinResult) -> str:
    """Return the relative error of a maximum, or "unknown"; a dash without a maximum."""
    if not pin.max_von_mises or pin.error_estimate is None:
        return DASH
    if not pin.maximum.bounded:
        return UNKNOWN
    return f"{engineering(100.0 * pin.error_estimate / pin.max_von_mises, 2)} %"


def factor_range(pin: PinResult, to: str = " to ") -> str:
    """Return the safety factor, or its interval, with three digits; loads are not known
    any better.
    """
    ends = pin.safety_factor_interval or (pin.safety_factor,)
    return _joined((factor_text(end, limit(pin)) for end in ends), to)


def _joined(ends: Iterable[str], to: str = " to ") -> str:
    """Return the ends of a range; only one if both are equal, as where a section governs."""
    return to.join(dict.fromkeys(ends))


def factor_text(factor: float | None, required: float, digits: int = END_DIGITS) -> str:
    """Return a factor with `digits` digits, or more if rounding would carry it past `required`."""
    return DASH if factor is None else beside_limit(factor, required, digits)


def used_text(used: float, digits: int = END_DIGITS) -> str:
    """Return a utilisation in per cent, with more digits if rounding would hide that it exceeds 100
    %.
    """
    return f"{beside_limit(100.0 * used, 100.0, digits, at_most=True)} %"


def utilisation_range(pin: PinResult, required: float) -> str:
    """Return required over actual factor in per cent, or its interval."""
    used = utilisation(pin, required)
    if used is None:
        return DASH
    ends = (used_text(end).removesuffix(" %") for end in used)
    return f"{_joined(ends)} %"


def variation_range(over: JointRange | SharingRange | None) -> str:
    """Return the range of the maximum over the joint, or over the stiffness of links; a dash
    without one.
    """
    return " to ".join(engineering(x, END_DIGITS) for x in over.max_von_mises) if over else DASH


def part_words(pin: PinResult) -> str:
    """Return the sources of the error of a maximum, without those that contribute nothing."""
    return ", ".join(
        ERROR_PART_WORDS[part] for part, value in pin.error_parts.items() if value > 0.0
    )


def error_words(pin: PinResult) -> str:
    """Return the error or interval for use in a sentence."""
    if pin.max_von_mises_interval is None:
        return f"± {error_range(pin)}" if pin.maximum.bounded else "error unknown"
    low, high = pin.max_von_mises_interval
    ends = error_range(pin) if low < high else "unchanged"
    return f"{ends} over half and twice the excluded distance"

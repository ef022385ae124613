"""Tolerances as on drawings: two deviations from the nominal size, or a class of ISO 286."""

from __future__ import annotations

import math
import re

from pinbase.errors import ArgumentError
from pinstress.explore.sweep.number import Number
from pinstress.study.schema.iso286 import CLASS_PATTERN, deviations
from pinstress.study.schema.shown import as_text
from pinstress.study.schema.thermal_units import difference_of
from pinstress.study.schema.units import UnitSystem, split, to_si

PLUS_MINUS_PATTERN = re.compile(r"(?:±|\+/?-)\s*([^+-].*)")
TOLERANCE_EXAMPLES = 'write for instance "+0.1 mm -0.05 mm", "±0.1 mm" or "h7"'


def limits_of(text: str, number: Number, system: UnitSystem) -> tuple[float, float]:
    """Return the smallest and the largest value (SI) of a number with a tolerance.

    Raises: ArgumentError.
    """
    text = text.strip()
    is_class = CLASS_PATTERN.fullmatch(text) is not None
    try:
        low, high = _class(text, number) if is_class else _deviations(text, number, system)
    except ArgumentError as error:
        raise ArgumentError(f"tolerance: {error}", error.code) from None
    return number.nominal + low, number.nominal + high


def _class(tolerance_class: str, number: Number) -> tuple[float, float]:
    if number.dimension != "length":
        raise ArgumentError(f"{tolerance_class} is for lengths", "no-tolerance-class")
    return deviations(tolerance_class, number.nominal)


def _deviations(text: str, number: Number, system: UnitSystem) -> tuple[float, float]:
    if both := PLUS_MINUS_PATTERN.fullmatch(text):
        size = _si(both[1], number, system)
        low, high = -size, size
    else:
        parts = re.split(r"[\s/]+(?=[+-]|0(?![\d.]))", text)
        if len(parts) != 2 or not all(part[:1] in "+-0" for part in parts):
            raise ArgumentError(
                f"cannot read {as_text(text)}; {TOLERANCE_EXAMPLES}", "not-a-tolerance"
            )
        low, high = sorted(_si(part, number, system) for part in parts)
        _require_units(text, parts, number, system)
    if not low < high:
        raise ArgumentError(
            f"{as_text(text)} has no width; {TOLERANCE_EXAMPLES}", "not-a-tolerance"
        )
    return low, high


def _require_units(text: str, parts: list[str], number: Number, system: UnitSystem) -> None:
    """Check that both deviations have a unit, or neither.

    Raises: ArgumentError if only one deviation has a unit, unless the other would have the same
    value in that unit; on a drawing one unit applies to both.
    """
    (value, unit), (other, other_unit) = (split(part) or (0.0, "") for part in parts)
    if bool(unit) == bool(other_unit):
        return
    bare = other if unit else value
    both = (_si(f"{bare!r} {one}".strip(), number, system) for one in ("", unit or other_unit))
    if not math.isclose(*both):
        raise ArgumentError(
            f"{as_text(text)} has a unit for one deviation only; give both theirs", "missing-unit"
        )


def _si(text: str, number: Number, system: UnitSystem) -> float:
    if number.dimension:
        return to_si(text, difference_of(number.dimension), system)
    try:
        return float(text)
    except ValueError:
        raise ArgumentError(
            f"{as_text(text)} is not a number without a unit", "not-a-tolerance"
        ) from None

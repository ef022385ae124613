"""Tolerances as drawings give them: two deviations from the nominal size, or a class of ISO 286.

Source: ISO 286-1:2010, tables 1 (standard tolerances) and 2 to 3 (fundamental deviations), of
nominal sizes up to 500 mm.
"""

from __future__ import annotations

import re

from pinbase.errors import ArgumentError
from pinstress.explore.sweep.number import Number
from pinstress.study.schema.shown import as_text
from pinstress.study.schema.units import UnitSystem, to_si

NOMINAL_SIZE_LIMITS = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)  # mm, nominal sizes
GRADE_TOLERANCES = {  # micrometres
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
    12: (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630),
}
# Of the nearer limit from the nominal size, micrometres: below it of shafts.
FUNDAMENTAL_DEVIATIONS = {
    "h": (0,) * 13,
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
}
TOLERANCE_CLASS_PATTERN = re.compile(r"(js|JS|[fghFGH])(\d{1,2})")
PLUS_MINUS_PATTERN = re.compile(r"(?:±|\+/?-)\s*([^+-].*)")
TOLERANCE_EXAMPLES = 'write for instance "+0.1 mm -0.05 mm", "±0.1 mm" or "h7"'


def limits_of(text: str, number: Number, system: UnitSystem) -> tuple[float, float]:
    """Return the least and the largest value (SI) of a number with a tolerance.

    Raises: ArgumentError.
    """
    text = text.strip()
    match = TOLERANCE_CLASS_PATTERN.fullmatch(text)
    try:
        low, high = (
            _class(match[1], int(match[2]), number) if match else _deviations(text, number, system)
        )
    except ArgumentError as error:
        raise ArgumentError(f"tolerance: {error}", error.code) from None
    return number.nominal + low, number.nominal + high


def _class(letter: str, grade: int, number: Number) -> tuple[float, float]:
    size = number.nominal * 1e3
    if number.dimension != "length" or not 0.0 < size <= NOMINAL_SIZE_LIMITS[-1]:
        raise ArgumentError(
            f"{letter}{grade} is for lengths up to {NOMINAL_SIZE_LIMITS[-1]} mm",
            "no-tolerance-class",
        )
    if grade not in GRADE_TOLERANCES:
        raise ArgumentError(
            f"{letter}{grade}: the grades known here are {min(GRADE_TOLERANCES)} to "
            f"{max(GRADE_TOLERANCES)}",
            "no-tolerance-class",
        )
    k = next(k for k, most in enumerate(NOMINAL_SIZE_LIMITS) if size <= most * (1.0 + 1e-12))
    width = GRADE_TOLERANCES[grade][k] * 1e-6
    if letter in ("js", "JS"):
        return -0.5 * width, 0.5 * width
    away = FUNDAMENTAL_DEVIATIONS[letter.lower()][k] * 1e-6
    return (-away - width, -away) if letter.islower() else (away, away + width)


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
    if not low < high:
        raise ArgumentError(
            f"{as_text(text)} has no width; {TOLERANCE_EXAMPLES}", "not-a-tolerance"
        )
    return low, high


def _si(text: str, number: Number, system: UnitSystem) -> float:
    if number.dimension:
        return to_si(text, number.dimension, system)
    try:
        return float(text)
    except ValueError:
        raise ArgumentError(
            f"{as_text(text)} is not a number without a unit", "not-a-tolerance"
        ) from None

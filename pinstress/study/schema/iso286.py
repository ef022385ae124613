"""Limits and fits of ISO 286-1 for nominal sizes up to 500 mm.

The values are as printed in two documents: K. L. Narayana, P. Kannaiah, K. Venkata Reddy, "Machine
Drawing", table 15.1 (p. 213, tolerances), 15.2 (pp. 215 and 216, shafts) and 15.3 (p. 219, holes),
and cobanengineering.com, "Calculation of Upper and Lower Deviation for Shaft" (shafts a to h up to
180 mm). Deviation k follows its formula, as JIS B 0401 prints it up to 65 mm. The formulae of the
standard (the same book, table 15.1A, p. 212, and table 15.4, p. 222) give the values before
rounding; they are in the test. Where no rounding leads to the printed value, the printed value is
used (16 i is 14.4 micrometres for sizes over 6 up to 10 mm, but IT7 is 15). Values that are not
printed there are not included.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from dataclasses import dataclass

from pinbase.errors import ArgumentError
from pinstress.study.schema.shown import as_text

SIZE_LIMITS = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)  # mm, upper ends of ranges
FINE_SIZE_LIMITS = (
    3, 6, 10, 14, 18, 24, 30, 40, 50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250, 280, 315, 355,
    400, 450, 500,
)  # fmt: skip
STANDARD_TOLERANCES = {  # micrometres, by grade, for the ranges of SIZE_LIMITS
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
    12: (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630),
    13: (140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970),
    14: (250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550),
    15: (400, 480, 580, 700, 840, 1000, 1200, 1400, 1600, 1850, 2100, 2300, 2500),
    16: (600, 750, 900, 1100, 1300, 1600, 1900, 2200, 2500, 2900, 3200, 3600, 4000),
}
# Deviations of the limit that is nearer to the nominal size, micrometres, for the ranges of
# SIZE_LIMITS or FINE_SIZE_LIMITS, as far as they are printed. Shafts a to h are below their nominal
# size, and holes A to H are above it by the same amount.
CLEARANCE_DEVIATIONS = {
    "a": (270, 270, 280, 290, 290, 300, 300, 310, 320, 340, 360, 380, 410, 460, 520, 580, 660, 740,
          820, 920, 1050, 1200, 1350, 1500, 1650),
    "b": (140, 140, 150, 150, 150, 160, 160, 170, 180, 190, 200, 220, 240, 260, 280, 310, 340, 380,
          420, 480, 540, 600, 680, 760, 840),
    "c": (60, 70, 80, 95, 95, 110, 110, 120, 130, 140, 150, 170, 180, 200, 210, 230, 240, 260, 280,
          300, 330, 360, 400, 440, 480),
    "d": (20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230),
    "e": (14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
    "h": (0,) * 13,
}  # fmt: skip
INTERFERENCE_DEVIATIONS = {  # of the lower limit of shafts, above their nominal size
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),  # for grades up to 7; 0 for others
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43),
    "r": (10, 15, 19, 23, 23, 28, 28, 34, 34, 41, 43, 51, 54, 63, 65, 68),
    "s": (14, 19, 23, 28, 28, 35, 35, 43, 43, 53, 59, 71, 79, 92, 100, 108),
}
LETTERS = {  # deviations that are included for some size
    *CLEARANCE_DEVIATIONS, *map(str.upper, CLEARANCE_DEVIATIONS), *INTERFERENCE_DEVIATIONS, "js",
    "JS",
}  # fmt: skip
FINE_LETTERS = "abcrs"  # deviations that are listed for FINE_SIZE_LIMITS
MAX_GRADE_OF_K = 7  # the highest grade in which deviation k is above the nominal size
COARSE_GRADE = 14  # from this grade on, and for a and b, classes are for sizes above 1 mm only
CLASS_PATTERN = re.compile(r"([A-Za-z]{1,2})([0-9]{1,2})")
MISSING_VALUES_TEXT = (
    "its values are not at hand; there are those of a to h, js, k, m, n, p, r and s for shafts and "
    "of A to H and JS for holes"
)


@dataclass(frozen=True)
class Fit:
    """A hole and a shaft of one nominal size, given by their tolerance classes.

    hole, shaft: the least and the largest deviation from the nominal size, m.
    """

    hole: tuple[float, float]
    shaft: tuple[float, float]

    @property
    def clearance(self) -> tuple[float, float]:
        """The least and the largest clearance, m; negative for interference."""
        return self.hole[0] - self.shaft[1], self.hole[1] - self.shaft[0]

    @property
    def kind(self) -> str:
        """The kind of the fit: "clearance", "interference", or "transition" between the two."""
        least, largest = self.clearance
        if least >= 0.0:
            return "clearance"
        return "transition" if largest > 0.0 else "interference"


def fit_of(text: str, size: float) -> Fit:
    """Return the fit of two classes such as "H7/f7" at a nominal size, m.

    Raises: ArgumentError.
    """
    hole, shaft = classes_of(text)
    return Fit(deviations(hole, size), deviations(shaft, size))


def classes_of(text: str) -> tuple[str, str]:
    """Return the tolerance classes of hole and shaft of a fit such as "H7/f7".

    Raises: ArgumentError for a text that is not a fit, and for classes that are not included for
    any size.
    """
    hole, slash, shaft = (part.strip() for part in text.partition("/"))
    if not slash or not hole[:1].isupper() or not shaft[:1].islower():
        raise ArgumentError(
            f"{as_text(text)} is not a fit; give the classes of hole and shaft, as H7/f7",
            "not-a-fit",
        )
    for tolerance_class in (hole, shaft):
        _letter_and_grade(tolerance_class)
    return hole, shaft


def deviations(tolerance_class: str, size: float) -> tuple[float, float]:
    """Return the least and the largest deviation (m) from a nominal size (m) in a tolerance class.

    Classes of holes are in capitals ("H7"), those of shafts in small letters ("f7").

    Raises: ArgumentError for a class or a size that is not included.
    """
    letter, grade = _letter_and_grade(tolerance_class)
    millimetres = round(1e3 * size, 9)
    if not 0.0 < millimetres <= SIZE_LIMITS[-1]:
        raise ArgumentError(
            f"a size of {millimetres:g} mm is not included: sizes are above 0 and up to "
            f"{SIZE_LIMITS[-1]} mm",
            "out-of-range",
        )
    if millimetres <= 1.0 and (grade >= COARSE_GRADE or letter in "abAB"):
        at = f"{tolerance_class} at {millimetres:g} mm"
        raise _not_included(at, "it is for sizes above 1 mm")
    width = STANDARD_TOLERANCES[grade][bisect_left(SIZE_LIMITS, millimetres)]
    low = _lower_limit(letter, millimetres, width, grade)
    return low * 1e-6, (low + width) * 1e-6


def _letter_and_grade(tolerance_class: str) -> tuple[str, int]:
    """Return the letter (or two) and the grade of a tolerance class.

    Raises: ArgumentError for a text that is not a class, and for a class that is not included for
    any size.
    """
    match = CLASS_PATTERN.fullmatch(tolerance_class)
    if match is None:
        raise ArgumentError(
            f"{as_text(tolerance_class)} is not a tolerance class such as H7 or f7", "not-a-fit"
        )
    letter, grade = match[1], int(match[2])
    if letter not in LETTERS:
        raise _not_included(f"deviation {letter}", MISSING_VALUES_TEXT)
    if grade not in STANDARD_TOLERANCES:
        least, most = min(STANDARD_TOLERANCES), max(STANDARD_TOLERANCES)
        raise _not_included(tolerance_class, f"the grades included are {least} to {most}")
    return letter, grade


def _lower_limit(letter: str, size: float, width: int, grade: int) -> float:
    """Return the lower deviation, micrometres.

    size: mm. width: of the tolerance, micrometres.
    """
    if letter in ("js", "JS"):
        return -0.5 * width
    if letter == "k" and grade > MAX_GRADE_OF_K:
        return 0.0
    above = INTERFERENCE_DEVIATIONS.get(letter, ())
    printed = above or CLEARANCE_DEVIATIONS.get(letter.lower(), ())
    limits = FINE_SIZE_LIMITS if letter.lower() in FINE_LETTERS else SIZE_LIMITS
    k = bisect_left(limits, size)
    if k >= len(printed):
        largest = limits[len(printed) - 1]
        raise _not_included(f"deviation {letter} above {largest} mm", MISSING_VALUES_TEXT)
    return float(-printed[k] - width if letter.islower() and not above else printed[k])


def _not_included(what: str, why: str) -> ArgumentError:
    return ArgumentError(f"{what} is not included: {why}", "no-tolerance-class")

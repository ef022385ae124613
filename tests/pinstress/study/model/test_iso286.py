"""Limits and fits against the formulae of ISO 286-1 and what other documents print.

Formulae: K. L. Narayana, P. Kannaiah, K. Venkata Reddy, "Machine Drawing", p. 212 (standard
tolerance unit i and its multiples) and table 15.4, p. 222 (shafts), in micrometres with D in mm,
the geometric mean of a step of sizes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import pytest

from pinbase.errors import ArgumentError
from pinstress.study.schema.iso286 import (
    CLEARANCE_DEVIATIONS,
    FINE_LETTERS,
    FINE_SIZE_LIMITS,
    INTERFERENCE_DEVIATIONS,
    SIZE_LIMITS,
    STANDARD_TOLERANCES,
    deviations,
    fit_of,
)
from tests.support.each import each

MULTIPLES = dict(zip(range(5, 17), (7, 10, 16, 25, 40, 64, 100, 160, 250, 400, 640, 1000),
                     strict=True))  # fmt: skip
# The standard rounds to 5 and 10 micrometres and by series of its own; the formulae are for more
# than 3 mm. A wrong digit is farther away than this. Only c is not by its formula over 10 up to
# 40 mm: over 30 this is 106 micrometres, and all documents print 120 (they are compared below).
ROUNDING_SHARES, ROUNDING_SHARE, ROUNDING = {"c": 0.14}, 0.05, 0.8


def unit(size: float) -> float:
    return float(0.45 * size ** (1.0 / 3.0) + 0.001 * size)


def it(grade: int, size: float) -> float:
    """The standard tolerance of the step in which a size is."""
    step = next(k for k, end in enumerate(SIZE_LIMITS) if size <= end)
    return MULTIPLES[grade] * unit(math.sqrt(SIZE_LIMITS[step - 1] * SIZE_LIMITS[step]))


FORMULAE: dict[str, Callable[[float], float]] = {
    "a": lambda d: 265 + 1.3 * d if d <= 120 else 3.5 * d,
    "b": lambda d: 140 + 0.85 * d if d <= 160 else 1.8 * d,
    "c": lambda d: 52 * d**0.2 if d <= 40 else 95 + 0.8 * d,
    "d": lambda d: 16 * d**0.44,
    "e": lambda d: 11 * d**0.41,
    "f": lambda d: 5.5 * d**0.41,
    "g": lambda d: 2.5 * d**0.34,
    "h": lambda _: 0.0,
    "k": lambda d: 0.6 * d ** (1.0 / 3.0),
    "m": lambda d: it(7, d) - it(6, d),
    "n": lambda d: 5 * d**0.34,
    "p": lambda d: it(7, d) + 2.5,  # "IT7 + 0 to 5"
    "s": lambda d: it(8, d) + 2.5 if d <= 50 else it(7, d) + 0.4 * d,  # "IT8 + 1 to 4"
    "r": lambda d: math.sqrt(FORMULAE["p"](d) * FORMULAE["s"](d)),
}
WIDTHS = {"p": 2.5, "s": 1.5, "r": 2.0}  # of what the formula leaves open, micrometres
MEAN_STEPS = {  # mm, of steps above 3 mm
    limits: [math.sqrt(a * b) for a, b in pairwise(limits)]
    for limits in (SIZE_LIMITS, FINE_SIZE_LIMITS)
}


@each("grade", STANDARD_TOLERANCES)
def test_standard_tolerances_are_multiples_of_the_unit(grade: int) -> None:
    for size, printed in zip(MEAN_STEPS[SIZE_LIMITS], STANDARD_TOLERANCES[grade][1:], strict=True):
        off = max(ROUNDING, ROUNDING_SHARE * printed)
        assert it(grade, size) == pytest.approx(printed, abs=off)


@each("letter", [*CLEARANCE_DEVIATIONS, *INTERFERENCE_DEVIATIONS])
def test_fundamental_deviations_are_by_their_formulae(letter: str) -> None:
    limits = FINE_SIZE_LIMITS if letter in FINE_LETTERS else SIZE_LIMITS
    printed = (CLEARANCE_DEVIATIONS | INTERFERENCE_DEVIATIONS)[letter][1:]
    for size, value in zip(MEAN_STEPS[limits], printed, strict=False):
        share = ROUNDING_SHARES.get(letter, ROUNDING_SHARE)
        off = max(ROUNDING, share * value) + WIDTHS.get(letter, 0.0)
        assert FORMULAE[letter](size) == pytest.approx(value, abs=off)


@each(
    ("size", "tolerance_class", "low", "high"),
    [
        # JIS B 0401 (1999) as Sumitomo's catalogue prints it, "regularly used shaft fits"
        *((35, name, low, high) for name, low, high in (
            ("b9", -232, -170), ("c9", -182, -120), ("d8", -119, -80), ("e8", -89, -50),
            ("f7", -50, -25), ("g6", -25, -9), ("h9", -62, 0), ("js7", -12.5, 12.5), ("k6", 2, 18),
            ("m6", 9, 25), ("n6", 17, 33), ("p6", 26, 42), ("r6", 34, 50), ("s6", 43, 59),
        )),
        (3, "k5", 0, 4), (3, "b9", -165, -140), (60, "k5", 2, 15), (60, "s6", 53, 72),
        (22, "c9", -162, -110), (8, "e9", -61, -25), (12, "c9", -138, -95), (12, "g5", -14, -6),
        (16, "m5", 7, 15),
        # The same of holes: mikipulley.co.jp, "List of Fit Tolerances"; info.5y1.org, "tolerances
        # of regularly used hole fits"
        (5, "E8", 20, 38), (8, "F7", 13, 28), (12, "G7", 6, 24), (35, "B10", 170, 270),
        (60, "C10", 140, 260), (45, "D10", 80, 180), (6, "JS6", -4, 4),
        # A table of holes A of Creo Parametric's help, "Example: A Tolerance Table"
        (40, "A9", 310, 372), (50, "A11", 320, 480), (65, "A12", 340, 640),
        # github.com/gabor-gubicza/CV
        (132.5, "a13", -1090, -460), (132.5, "H6", 0, 25),
    ],
)  # fmt: skip
def test_limits_that_others_print(
    size: float, tolerance_class: str, low: float, high: float
) -> None:
    found = deviations(tolerance_class, size * 1e-3)
    assert [1e6 * x for x in found] == pytest.approx([low, high])


@each(
    ("size", "fit", "least", "largest", "kind"),
    [
        (40, "H7/f7", 25, 75, "clearance"),  # the contract's
        (64, "H8/f7", 30, 106, "clearance"),  # byjus.com: 64.000 to 64.046, 63.940 to 63.970
        (50, "H8/f7", 25, 89, "clearance"),  # Wikipedia, "Engineering fit"
        (25, "H7/h6", 0, 34, "clearance"),  # metricmech.com, "ISO 286 fits visualizer"
        (35, "H7/n6", -33, 8, "transition"),  # the limits above
        (35, "H7/s6", -59, -18, "interference"),
        (38.1, "F8/h7", 25, 89, "clearance"),
    ],
)
def test_fits_that_others_print(
    size: float, fit: str, least: float, largest: float, kind: str
) -> None:
    found = fit_of(fit, size * 1e-3)
    assert [1e6 * x for x in found.clearance] == pytest.approx([least, largest], abs=1e-6)
    assert found.kind == kind


@each("size", SIZE_LIMITS)
def test_a_step_of_sizes_has_its_upper_end(size: float) -> None:
    """As the standard has them: over the lower, up to and including the upper."""
    below, above = (deviations("h7", x * 1e-3) for x in (0.99 * size, size))
    assert below == above
    if size < SIZE_LIMITS[-1]:
        assert deviations("h7", 1.001e-3 * size) != above


@each(
    ("size", "fit", "message"),
    [
        (40, "H7/zc7", "deviation zc is not included: its values are not at hand"),
        (40, "K7/h6", "deviation K is not included"),
        (200, "H7/p6", "deviation p above 180 mm is not included"),
        (40, "H4/h7", "H4 is not included: the grades included are 5 to 16"),
        (501, "H7/h6", "a size of 501 mm is not included: sizes are above 0 and up to 500 mm"),
        (501, "H7/zc7", "deviation zc is not included"),
        (1, "H7/a7", "a7 at 1 mm is not included: it is for sizes above 1 mm"),
        (40, "H7", "'H7' is not a fit; give the classes of hole and shaft, as H7/f7"),
        (40, "f7/H7", "is not a fit"),
        (40, "H/f", "'H' is not a tolerance class"),
    ],
)
def test_what_is_not_printed_is_refused_by_name(size: float, fit: str, message: str) -> None:
    with pytest.raises(ArgumentError, match=message):
        fit_of(fit, size * 1e-3)

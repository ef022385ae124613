"""Numbers as engineers write them: four digits, no 1e+05, exponents that are multiples of three."""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence
from decimal import Decimal

DASH = "–"
SUPERSCRIPT_DIGITS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
MARGIN_DIGITS = 3
MAX_DIGITS = 9  # of a number shown with its limit
COMPONENT_ROUND_OFF = 1e-9  # of the largest component; anything smaller is round-off
# Outside this range, Python would write three digits with an exponent.
LARGE_NUMBER, SMALL_NUMBER = 1e3, 1e-4


def engineering(value: float | None, digits: int = 4) -> str:
    """Return a number with `digits` significant digits; a dash for None or a non-finite number.

    From 0.001 to below ten million the number is written out, with commas at thousands; otherwise
    it has a power 10³ⁿ.
    """
    if value is None or not math.isfinite(value):
        return DASH
    rounded = float(f"{value:.{digits - 1}e}")
    if rounded == 0.0:
        return "0"
    size = math.floor(math.log10(abs(rounded)))
    if -3 <= size < 7:
        return _plain(rounded, digits, size)
    power = 3 * (size // 3)
    return f"{_plain(float(Decimal(rounded).scaleb(-power)), digits, size - power)}×{ten_to(power)}"


def beside_limit(value: float, limit: float, digits: int, at_most: bool = False) -> str:
    """Return a number with `digits` significant digits, or more if rounding would hide that it
    misses a limit.

    at_most: whether the limit is an upper one.
    """
    meets = operator.le if at_most else operator.ge
    enough = (
        n
        for n in range(digits, MAX_DIGITS)
        if meets(float(f"{value:.{n - 1}e}"), limit) == meets(value, limit)
    )
    return engineering(value, next(enough, MAX_DIGITS))


def margin_text(margin: float | None) -> str:
    """Return a margin of safety with its sign; "+∞" without demand, a dash for None."""
    if margin is not None and math.isinf(margin):
        return "+∞"
    return f"{'+' if (margin or 0.0) > 0.0 else ''}{engineering(margin, MARGIN_DIGITS)}"


def ten_to(power: int) -> str:
    """Return a power of ten as text."""
    return "10" + str(power).translate(SUPERSCRIPT_DIGITS)


def _plain(value: float, digits: int, size: int) -> str:
    text = f"{value:,.{max(digits - 1 - size, 0)}f}"
    return text.replace("-", "−")


def short(value: float | None) -> str:
    """Return a dimension or an instant as it was given: without trailing zeros, at most
    six digits; a dash for None.
    """
    text = engineering(value, 6)
    head, times, power = text.partition("×")
    if "." in head:
        head = head.rstrip("0").rstrip(".")
    return head + times + power


def drawn(value: float) -> str:
    """Return a dimension on a drawing as it was given, or with five digits if it was converted from
    another unit.
    """
    given = math.isclose(value, float(f"{value:.6g}"), rel_tol=1e-9)
    return short(value if given else float(f"{value:.5g}"))


def with_decimals_of(value: float, given: float) -> str:
    """Return a number with as many decimals as a given number has."""
    _, _, decimals = f"{Decimal(repr(float(given))):f}".partition(".")
    return f"{value:,.{len(decimals.rstrip('0'))}f}".replace("-", "−")


def finite(value: float | None) -> float | None:
    """Return the number; None if it is not finite."""
    return None if value is None or not math.isfinite(value) else float(value)


def ratio(ours: float | None, published: float | None) -> float | None:
    """Return computed over published value; None if either is missing or the published value is
    zero.
    """
    if ours is None or published is None or published == 0.0:
        return None
    return finite(ours / published)


def components(values: Sequence[float], largest: float) -> list[str]:
    """Return the numbers of a vector as text; round-off relative to the largest becomes zero."""
    return [engineering(v if abs(v) > COMPONENT_ROUND_OFF * largest else 0.0) for v in values]


def percent(value: float) -> str:
    """Return a relative error as text."""
    return f"{short(float(f'{100.0 * value:.2g}'))} %"


def seconds(value: float | None) -> str:
    """Return a time in s or ms."""
    if value is None:
        return engineering(None)
    return f"{engineering(value, 2)} s" if value >= 0.1 else f"{engineering(1e3 * value, 2)} ms"


def threshold(value: float) -> str:
    """Return a value at which something changes, with three digits: "22.8×10⁻⁶", "0.000387", "0.1",
    "88,900".
    """
    rounded = float(f"{value:.3g}")
    few = SMALL_NUMBER <= abs(rounded) < LARGE_NUMBER
    return f"{rounded:g}".replace("-", "−") if few else engineering(value, 3)

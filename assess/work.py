"""The work of a check: its formula, the numbers in it, and what would just pass."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

from fea.beam.round_section import Circle

MAX_CHANGE = 10.0  # times by which a dimension is changed at most to find what just passes
STEP_RATIO = 1.5  # of dimensions that are tried one after another; the root is between two
PASSING_TOLERANCE = 1e-6  # relative, of the value that just passes


@dataclass(frozen=True)
class WorkQuantity:
    """A number of a formula: its symbol, its value in SI and its dimension ("1" for a ratio)."""

    symbol: str
    value: Annotated[float, "own"]
    dimension: str = "1"


@dataclass(frozen=True)
class Work:
    """A formula with its numbers and its result.

    formula: with the symbols of the quantities in braces: "1.8 × {F_y} × {d} × {t}". Every term of
    it has the same dimension in any system of units.
    """

    result: WorkQuantity
    formula: str
    quantities: tuple[WorkQuantity, ...]


def work(
    symbol: str, value: float, dimension: str, formula: str, **quantities: tuple[float, str]
) -> Work:
    """Return the work of a result; each quantity is a value in SI with its dimension."""
    return Work(
        WorkQuantity(symbol, float(value), dimension),
        formula,
        tuple(WorkQuantity(name, float(x), kind) for name, (x, kind) in quantities.items()),
    )


def scaled(symbol: str, now: float, utilisation: float, power: float) -> WorkQuantity | None:
    """Return the length that would just pass where what a check carries grows with a power of it;
    None without a load.

    now: the present length, m.
    """
    if not 0.0 < utilisation < float("inf"):
        return None
    return WorkQuantity(symbol, now * utilisation ** (1.0 / power), "length")


def wider(
    section: Circle, utilisation: float, power: float, resists: Callable[[Circle], float]
) -> WorkQuantity | None:
    """Return the diameter of a pin that would just pass with its bore as it is; None without a
    load, and where none within MAX_CHANGE does.

    resists: what a check carries in proportion to, which grows with a power of the diameter of a
    solid pin.
    """
    if not section.inner or not 0.0 < utilisation < float("inf"):
        return scaled("diameter", 2.0 * section.outer, utilisation, power)

    def used(wall: float) -> float:
        return utilisation * resists(section) / resists(Circle(section.inner + wall, section.inner))

    return diameter_of_wall(section, used)


def diameter_of_wall(section: Circle, used: Callable[[float], float]) -> WorkQuantity | None:
    """Return the diameter of a pin that would just pass with its bore as it is, as `would_pass`.

    used: the utilisation by the wall of the section, m; of a solid one its radius.
    """
    wall = would_pass(used, section.outer - section.inner)
    if wall is None:
        return None
    return WorkQuantity("diameter", 2.0 * (section.inner + wall), "length")


def would_pass(utilisation: Callable[[float], float], now: float) -> float | None:
    """Return the value of a dimension nearest to the present one at which a utilisation is 1, on
    its safe side; None where none is within MAX_CHANGE.

    utilisation: as a function of the dimension; it falls as this grows.
    now: the present value.
    """
    step = STEP_RATIO if utilisation(now) > 1.0 else 1.0 / STEP_RATIO
    last = now
    while now / MAX_CHANGE <= last <= now * MAX_CHANGE:
        following = last * step
        if (utilisation(following) > 1.0) != (step > 1.0):
            low, high = sorted((last, following))
            while high - low > PASSING_TOLERANCE * high:  # SciPy takes long to import
                middle = 0.5 * (low + high)
                low, high = (middle, high) if utilisation(middle) > 1.0 else (low, middle)
            return high
        last = following
    return None

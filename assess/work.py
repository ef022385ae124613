"""The work of a check: its formula, the numbers in it, and the dimension that would just pass."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

from fea.beam.round_section import Circle

MAX_CHANGE = 10.0  # largest factor on a dimension in the search for the value that just passes
STEP_RATIO = 1.5  # ratio of successive trial dimensions; two of them bracket the root
PASSING_TOLERANCE = 1e-6  # relative tolerance of the value that just passes


@dataclass(frozen=True)
class WorkQuantity:
    """A quantity of a formula: its symbol, its value in SI and its dimension ("1" for a ratio)."""

    symbol: str
    value: Annotated[float, "own"]
    dimension: str = "1"


@dataclass(frozen=True)
class Work:
    """A formula with its numbers and its result.

    formula: text with the symbols of the quantities in braces: "1.8 × {F_y} × {d} × {t}". All its
    terms have the same dimension, so that it holds in any system of units.
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
    """Return the length that would just pass; None without a load.

    now: the present length, m. power: the allowable load is proportional to this power of the
    length.
    """
    if not 0.0 < utilisation < float("inf"):
        return None
    return WorkQuantity(symbol, now * utilisation ** (1.0 / power), "length")


def wider(
    section: Circle, utilisation: float, power: float, resists: Callable[[Circle], float]
) -> WorkQuantity | None:
    """Return the diameter of a pin that would just pass, its bore unchanged; None without a load,
    or if no diameter of a bored pin within MAX_CHANGE passes.

    resists: the section property to which the allowable load is proportional. power: of a solid
    pin, the property is proportional to this power of the diameter.
    """
    if not section.inner or not 0.0 < utilisation < float("inf"):
        return scaled("diameter", 2.0 * section.outer, utilisation, power)

    def used(wall: float) -> float:
        return utilisation * resists(section) / resists(Circle(section.inner + wall, section.inner))

    return diameter_of_wall(section, used)


def diameter_of_wall(section: Circle, used: Callable[[float], float]) -> WorkQuantity | None:
    """Return the diameter of a pin that would just pass, its bore unchanged, as `would_pass`.

    used: the utilisation as a function of the wall thickness, m; of a solid section, its radius.
    """
    wall = would_pass(used, section.outer - section.inner)
    if wall is None:
        return None
    return WorkQuantity("diameter", 2.0 * (section.inner + wall), "length")


def would_pass(utilisation: Callable[[float], float], now: float) -> float | None:
    """Return the value of a dimension, nearest to the present one, at which a utilisation is 1. The
    value is on the safe side; None if there is none within MAX_CHANGE.

    utilisation: a function of the dimension that decreases as the dimension grows.
    now: the present value.
    """
    # Step away from the present value until two trials bracket the root, then bisect.
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

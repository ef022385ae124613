"""Rounding of the dimensions of the least weight, and a description of its active constraints."""

from __future__ import annotations

import numpy as np

from pinbase.arrays import Floats
from pinstress.explore.size.optimise import Optimum
from pinstress.explore.size.other_dimensions import ROUNDING_DIRECTIONS, rounding_step
from pinstress.explore.size.pin_shape import MAX_DIMENSION_RATIO, VariedShape, kind_of
from pinstress.explore.size.scaled_study import rounded

PRESENT_TOLERANCE = 1e-6  # relative distance within which a search ends at the present value
MAX_ROUNDING_STEPS = 40  # largest number of steps by which rounded diameters are enlarged
LIMIT_ROUNDING_TOLERANCE = (
    2e-3  # violation of a geometric limit that rounding to four digits causes
)


def rounded_values(
    shape: VariedShape, values: Floats, step: float | None, length_unit: float
) -> Floats:
    """Return dimensions rounded as they are written: to four digits, diameters up, bores and
    fillets down. Rounding does not go beyond a present value that the search ended at; otherwise a
    fillet that must not become smaller would do so by its last digits.

    step: step to which diameters are rounded up, m; by further steps if that violates a geometric
    limit.
    length_unit: the study's unit of length, m.
    """
    out, steps = [], np.zeros(len(values))
    for k, (dimension, value) in enumerate(zip(shape.dimensions, values, strict=True)):
        increment = rounding_step(dimension.key, step, length_unit)
        steps[k] = (increment or 0.0) * length_unit
        up = ROUNDING_DIRECTIONS[kind_of(dimension.key)]
        new = rounded(float(value) / length_unit, increment, up) * length_unit
        least = float(value) * (1.0 - up * PRESENT_TOLERANCE)
        beyond = increment is None and up * least <= up * dimension.value < up * new
        out.append(dimension.value if beyond else new)
    result = np.array(out)
    for _ in range(MAX_ROUNDING_STEPS if step is not None else 0):
        limits, slopes = shape.at_limits(result)
        if not len(limits) or limits.min() >= -LIMIT_ROUNDING_TOLERANCE:
            break
        grow = (slopes[int(limits.argmin())] > 0.0) & (steps > 0.0)
        if not grow.any():
            break
        result = result + np.where(grow, steps, 0.0)
    return result


def binding(shape: VariedShape, optimum: Optimum) -> list[tuple[str, float]]:
    """Return the active constraints in words with their multipliers, the largest first."""
    keys, limits = shape.keys, shape.geometric
    out = []
    for name, multiplier in optimum.optimality.multipliers.items():
        kind, _, number = name.rpartition(" ")
        text = name
        if kind == "limit":
            text = limits[int(number) - 1].text
        elif kind in ("least", "most"):
            far = f"{MAX_DIMENSION_RATIO:g} times {'less' if kind == 'least' else 'more'}"
            text = f"{keys[int(number) - 1]} {far}"
        out.append((text, multiplier))
    return sorted(out, key=lambda one: (-one[1], one[0]))

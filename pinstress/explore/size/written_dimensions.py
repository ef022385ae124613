"""Dimensions that a search for the least weight found, as they are written, and what binds them."""

from __future__ import annotations

import numpy as np

from pinbase.arrays import Floats
from pinstress.explore.size.optimise import Optimum
from pinstress.explore.size.pin_shape import MAX_DIMENSION_RATIO, VariedShape, kind_of
from pinstress.explore.size.scaled_study import rounded

MAX_ROUNDING_STEPS = 40  # of diameters rounded to steps
LIMIT_ROUNDING_TOLERANCE = 2e-3  # of a geometric limit, by which four digits may break it


def rounded_values(shape: VariedShape, values: Floats, step: float | None, metre: float) -> Floats:
    """As they are written: four digits, diameters up, bores and fillets down; diameters up to a
    step (m), and by further steps where a geometric limit is broken by that.
    """
    up = {"diameters": 1, "bores": -1, "fillets": -1}
    out, steps = [], np.zeros(len(values))
    for k, (dimension, value) in enumerate(zip(shape.dimensions, values, strict=True)):
        kind = kind_of(dimension.key)
        own = None
        if step is not None and kind == "diameters":
            own = (step / 2.0 if dimension.key.startswith("meridian") else step) / metre
            steps[k] = own * metre
        out.append(rounded(float(value) / metre, own, up[kind]) * metre)
    found = np.array(out)
    for _ in range(MAX_ROUNDING_STEPS if step is not None else 0):
        limits, slopes = shape.at_limits(found)
        if not len(limits) or limits.min() >= -LIMIT_ROUNDING_TOLERANCE:
            break
        grow = (slopes[int(limits.argmin())] > 0.0) & (steps > 0.0)
        if not grow.any():
            break
        found = found + np.where(grow, steps, 0.0)
    return found


def binding(shape: VariedShape, optimum: Optimum) -> list[tuple[str, float]]:
    """What binds, the largest multiplier first."""
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

"""What a little more of each dimension of a pin does to its factor, by differences.

The pin is solved again at the governing instant with 5 % more and less of a dimension, on two
meshes. Maxima of different shapes are read on different meshes, whose noise is in their difference;
by how much the two meshes disagree is taken for the error, and a dimension whose effect is smaller
than that is left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

from fea.single_mesh import Problem, Rung, result_on
from geometry import GeometryError, Pin
from reports.data.changes import Sensitivity

PART = 0.05  # of a dimension, more and less
LEVELS = 0, 1
LEAST = 0.01  # power of a dimension that matters
MOST = 0.1  # of a dimension that its step is at most


@dataclass(frozen=True)
class Dimension:
    """A dimension by its key in the pin's table, m; changed: the pin with another value."""

    key: str
    value: float
    changed: Callable[[float], Pin]


def sensitivities(problem: Problem, factor: float, step: float) -> tuple[Sensitivity, ...]:
    """Of the pin's factor to its dimensions, where they exceed their error. step: of a dimension,
    m; a tenth of it, or a hundredth, where that is no small part of the dimension.
    """
    assert isinstance(problem.pin, Pin)
    found = []
    for each in _dimensions(problem.pin):
        try:
            coarse, fine = (_power(problem, each, level) for level in LEVELS)
        except (GeometryError, ArithmeticError):  # a shape that cannot be
            continue
        if abs(fine) <= max(abs(fine - coarse), LEAST):
            continue
        more = step
        while more > MOST * each.value:
            more /= 10.0
        grown = 1.0 + more / each.value
        error = abs(fine - coarse) * factor * (grown - 1.0)
        found.append(Sensitivity(each.key, each.value, more, factor * grown**fine, error))
    return tuple(found)


def _power(problem: Problem, of: Dimension, level: int) -> float:
    """Of the dimension, with which the factor grows."""
    more, less = 1.0 + PART, 1.0 - PART
    high, low = (
        result_on(replace(problem, pin=of.changed(times * of.value)), Rung("harmonic", level=level))
        for times in (more, less)
    )
    return math.log(low.maximum / high.maximum) / math.log(more / less)


def _dimensions(pin: Pin) -> Iterator[Dimension]:
    """Those that are not zero; the diameter or bore of neighbours where it is equal is one."""
    every = range(len(pin.segments))
    for key in ("diameter", "bore"):
        values: list[float] = [getattr(segment, key) for segment in pin.segments]
        for value, run in groupby(every, values.__getitem__):
            if value:
                yield _dimension(pin, key, list(run))
    for key in ("length", "fillet"):
        for k in every:
            if getattr(pin.segments[k], key):
                yield _dimension(pin, key, [k])
    if pin.fillet:
        yield Dimension("fillet", pin.fillet, lambda value: replace(pin, fillet=value))


def _dimension(pin: Pin, key: str, at: Sequence[int]) -> Dimension:
    """Of segments (from 0) that have it in common."""

    def changed(value: float) -> Pin:
        changes: dict[str, Any] = {key: value}
        segments = [replace(s, **changes) if k in at else s for k, s in enumerate(pin.segments)]
        return replace(pin, segments=tuple(segments))

    where = f"{at[0] + 1}" if len(at) == 1 else f"{at[0] + 1}-{at[-1] + 1}"
    return Dimension(f"profile[{where}].{key}", getattr(pin.segments[at[0]], key), changed)

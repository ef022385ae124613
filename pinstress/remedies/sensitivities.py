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
    ends = [(k, end) for k in range(len(pin.segments)) for end in (0, 1)]
    for key, pairs in (
        ("diameter", [s.diameters for s in pin.segments]),
        ("bore", [s.bores for s in pin.segments]),
    ):
        values = [value for pair in pairs for value in pair]
        for value, run in groupby(range(len(ends)), values.__getitem__):
            if value:
                yield _across(pin, key, value, [ends[i] for i in run])
    for key in ("length", "fillet"):
        for k, segment in enumerate(pin.segments):
            if value := getattr(segment, key):
                yield _along(pin, key, value, k)
    if pin.fillet:
        yield Dimension("fillet", pin.fillet, lambda value: replace(pin, fillet=value))


def _across(pin: Pin, key: str, value: float, at: Sequence[tuple[int, int]]) -> Dimension:
    """Of the ends of segments, (segment, end) from 0, that have it in common."""

    def changed(new: float) -> Pin:
        segments = list(pin.segments)
        for k, s in enumerate(segments):
            outer, inner = list(s.diameters), list(s.bores)
            for end in (0, 1):
                if (k, end) in at:
                    (outer if key == "diameter" else inner)[end] = new
            segments[k] = s.with_diameters((outer[0], outer[1]), (inner[0], inner[1]))
        return replace(pin, segments=tuple(segments))

    whole = sorted({k for k, _ in at if (k, 0) in at and (k, 1) in at})
    if not whole:
        k, end = at[-1]
        return Dimension(f"profile[{k + 1}].{key}[{end + 1}]", value, changed)
    where = f"{whole[0] + 1}" if len(whole) == 1 else f"{whole[0] + 1}-{whole[-1] + 1}"
    return Dimension(f"profile[{where}].{key}", value, changed)


def _along(pin: Pin, key: str, value: float, k: int) -> Dimension:
    """Of segment k from 0."""

    def changed(new: float) -> Pin:
        changes: dict[str, Any] = {key: new}
        segments = list(pin.segments)
        segments[k] = replace(segments[k], **changes)
        return replace(pin, segments=tuple(segments))

    return Dimension(f"profile[{k + 1}].{key}", value, changed)

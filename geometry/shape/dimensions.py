"""The dimensions of a profile by their keys, and the pin after a change of one of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

from geometry.shape.pin import Pin
from geometry.shape.segment import Pair

KEY_JOINT = " & "
_RADIUS_KEYS = (("edge_radius", "edge_radii"), ("bore_radius", "bore_radii"))


@dataclass(frozen=True)
class Dimension:
    """A dimension of a pin.

    key: key in the pin's table of a study; several keys of one dimension are joined by KEY_JOINT.
    value: m.
    changed: function that returns the pin with another value (m) of the dimension.
    """

    key: str
    value: float
    changed: Callable[[float], Pin]


def dimensions(pin: Pin) -> Iterator[Dimension]:
    """All nonzero dimensions; equal diameters or bores of neighbours are a single dimension."""
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
                yield _of_segment(pin, f"profile[{k + 1}].{key}", value, k, _field(key))
    for key, name in _RADIUS_KEYS:
        for k, segment in enumerate(pin.segments):
            for end, value in enumerate(getattr(segment, name)):
                if value:
                    yield _of_segment(
                        pin, f"profile[{k + 1}].{key}[{end + 1}]", value, k, _end(name, end)
                    )
    if pin.fillet:
        yield Dimension("fillet", pin.fillet, lambda value: replace(pin, fillet=value))


def _across(pin: Pin, key: str, value: float, at: Sequence[tuple[int, int]]) -> Dimension:
    """The common diameter or bore of some ends of segments. at: pairs (segment, end), from 0."""

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
    keys = []
    if whole:
        where = f"{whole[0] + 1}" if len(whole) == 1 else f"{whole[0] + 1}-{whole[-1] + 1}"
        keys.append(f"profile[{where}].{key}")
    keys += [f"profile[{k + 1}].{key}[{end + 1}]" for k, end in at if k not in whole]
    return Dimension(KEY_JOINT.join(keys), value, changed)


def _of_segment(
    pin: Pin, key: str, value: float, k: int, change: Callable[[Any, float], dict[str, Any]]
) -> Dimension:
    """A dimension of segment k (from 0).

    change: function of the segment and the new value that returns the changed fields.
    """

    def changed(new: float) -> Pin:
        segments = list(pin.segments)
        segments[k] = replace(segments[k], **change(segments[k], new))
        return replace(pin, segments=tuple(segments))

    return Dimension(key, value, changed)


def _field(name: str) -> Callable[[Any, float], dict[str, Any]]:
    """The change of a field."""
    return lambda _, new: {name: new}


def _end(name: str, end: int) -> Callable[[Any, float], dict[str, Any]]:
    """The change at one end (0 or 1) of a field that has a value for both ends."""

    def change(segment: Any, new: float) -> dict[str, Pair]:
        first, last = getattr(segment, name)
        return {name: (first, new) if end else (new, last)}

    return change

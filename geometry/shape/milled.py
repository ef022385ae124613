"""Milled cuts, which are flats, keyways and slots."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from geometry.shape.features import (
    Cut,
    Off,
    Require,
    SmoothPart,
    marks_of,
    positive,
    radii,
    requirement,
)
from geometry.shape.pin import Pin
from geometry.shape.tolerance import snapped
from pinbase.arrays import Floats, Mask
from pinbase.errors import Place

MAX_BOTTOM_RADIUS_RATIO = 0.45  # largest ratio of the radius at the bottom of a slot to its width


class Milled(Cut):
    """A milled cut from z0 to z1 (m), with a radius (m) at the inner corners of its bottom."""

    z0: float
    z1: float
    radius: float

    @property
    def extent(self) -> tuple[float, float]:
        """Least and greatest z, m."""
        return self.z0, self.z1

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Self:
        """The same cut with other ends. change: from old to new ends in z, m."""
        return self._with(dict(zip(("z0", "z1"), change(self.z0, self.z1), strict=True)))

    def on(self, pin: Pin) -> Self:
        """The same cut with its ends moved to those of bands and segments that it almost meets."""
        marks, near = marks_of(pin), pin.tolerance
        return self.along(lambda a, b: (snapped(a, marks, near), snapped(b, marks, near)))

    def past(self, pin: Pin) -> Self:
        """The same cut, extended where it ends at an end of the pin or beyond it.

        The rounded ends of the cut are then outside the pin.
        """
        far = 2.0 * self.radius + (self.size if math.isfinite(self.size) else 0.0)
        if not far:
            return self
        low = min(self.z0, -far) if self.z0 <= pin.tolerance else self.z0
        beyond = self.z1 >= pin.length - pin.tolerance
        high = max(self.z1, pin.length + far) if beyond else self.z1
        return self.along(lambda a, b: (low, high))


@dataclass(frozen=True)
class Flat(Milled):
    """A flat, which removes everything beyond a distance from the axis on one side.

    z0, z1: axial positions of the ends, m.
    distance: distance from the pin's axis, m.
    angle: direction of the flat's normal, rad from x.
    radius: radius of the inner corners at the ends, m.
    """

    z0: float
    z1: float
    distance: float
    angle: float = 0.0
    radius: float = 0.0

    what: ClassVar[str] = "flat"
    lengths: ClassVar[tuple[str, ...]] = ("z0", "z1", "distance", "radius")

    @property
    def size(self) -> float:
        """Infinity, because a flat has no width of its own."""
        return math.inf

    def takes(self, x: Floats, radius: float) -> Mask:
        """Mask (P,) of the points x (P, 3) beyond the flat's distance and between its ends."""
        del radius
        u = math.cos(self.angle) * x[:, 0] + math.sin(self.angle) * x[:, 1]
        return np.asarray((u > self.distance) & (x[:, 2] > self.z0) & (x[:, 2] < self.z1))

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """The smooth parts of the flat's surface: floor, ends, and fillets between them."""
        del pin
        below, beyond, both = _rounded(self, lambda x: np.full(len(x), -math.inf), self.distance)
        return _parts(below, beyond, both, self.radius, "end")

    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raise GeometryError when this pin cannot have the flat. name, at: for the message."""
        require = requirement(f"pin {pin.name}, {name}", at)
        _check_ends(self, pin, require)
        require(self.distance > 0.0, "the distance from the axis must be positive", "not-positive")
        outer = radii(pin, self.z0, self.z1)[1]
        require(
            self.distance < outer - pin.tolerance,
            f"its distance from the axis is {self.distance / outer:.4g} times the pin's "
            "radius there, so it cuts nothing; reduce the distance",
            "cuts-nothing",
        )
        require(
            2.0 * self.radius < self.z1 - self.z0,
            f"its radius is {self.radius / (self.z1 - self.z0):.4g} times its length and "
            "must be less than half of it",
            "radius-too-large",
        )


@dataclass(frozen=True)
class Slot(Milled):
    """A slot or keyway along the pin.

    z0, z1: axial positions of the ends, m.
    width: m.
    depth: depth from the surface, m; None for a slot through the whole pin.
    angle: direction from which the slot is milled, rad from x.
    radius: radius of the corners at the bottom, m.
    round_ends: whether the ends are half circles in plan; otherwise they are square.
    """

    z0: float
    z1: float
    width: float
    depth: float | None = None
    angle: float = 0.0
    radius: float = 0.0
    round_ends: bool = True

    what: ClassVar[str] = "slot"
    lengths: ClassVar[tuple[str, ...]] = ("z0", "z1", "width", "depth", "radius")

    @property
    def size(self) -> float:
        """The width, m."""
        return self.width

    @property
    def half_turn(self) -> bool:
        """Whether half a turn maps the slot to itself: if it goes through the pin."""
        return self.depth is None

    @property
    def middle(self) -> float:
        """Position z of the middle of the slot, m."""
        return 0.5 * (self.z0 + self.z1)

    def floor(self, pin: Pin) -> float:
        """Distance of the slot's bottom from the axis, m; minus infinity for a through slot."""
        if self.depth is None:
            return -math.inf
        return radii(pin, self.z0, self.z1)[1] - self.depth

    def takes(self, x: Floats, radius: float) -> Mask:
        """Mask (P,) of the points x (P, 3) in the slot's outline, on the milled side."""
        del radius
        u = math.cos(self.angle) * x[:, 0] + math.sin(self.angle) * x[:, 1]
        between = (x[:, 2] > self.z0) & (x[:, 2] < self.z1)
        return np.asarray(between & (self._aside(x) < 0.0) & ((u > 0.0) | (self.depth is None)))

    def _aside(self, x: Floats) -> Floats:
        """Distance of points (P, 3) from the slot's outline in plan, (P,) m, negative inside.

        A slot with square ends has only its side walls here; see `_past_ends`.
        """
        half, radius = self.width / 2.0, self.width / 2.0 if self.round_ends else 0.0
        half_length = 0.5 * (self.z1 - self.z0) - radius
        y = np.abs(math.cos(self.angle) * x[:, 1] - math.sin(self.angle) * x[:, 0])
        if not self.round_ends:
            return np.asarray(y - half)
        past = np.maximum(np.abs(x[:, 2] - self.middle) - half_length, 0.0)
        return np.asarray(np.hypot(y, past) - half)

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """The smooth parts of the slot's surface: bottom, walls, ends, and fillets between them."""
        aside = self._aside
        floor = self.floor(pin)
        below, beyond, both = _rounded(self, aside, floor)
        parts = _parts(below, beyond, both, self.radius, "wall", floor > -math.inf)
        if self.round_ends:
            return parts
        past: Off = lambda x: _past_ends(self, x)  # noqa: E731
        out = [part for part in parts if part.part == "floor"]
        for name, side in (("end", past), ("wall", aside)):
            out.append(SmoothPart(name, "Plane", _on(both, side)))
            if self.radius:
                out.append(_fillet(side, below, self.radius))
        return tuple(out)

    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raise GeometryError when this pin cannot have the slot. name, at: for the message."""
        require, length = requirement(f"pin {pin.name}, {name}", at), self.z1 - self.z0
        _check_ends(self, pin, require)
        require(positive(self.width), "the width must be positive", "not-positive")
        tolerance = pin.tolerance
        if self.depth is None:
            inside = self.z0 > tolerance and self.z1 < pin.length - tolerance
            require(
                inside,
                "a slot through the pin must end before the pin does, or it would split the pin",
                "beyond-end",
            )
        least, most = radii(pin, self.z0, self.z1)
        otherwise = "so that it is a flat: give it as one, with its distance from the axis"
        if self.depth is None:
            otherwise = "and would cut the pin in two; reduce it"
        require(
            self.width / 2.0 < least - tolerance,
            f"its width is {self.width / (2.0 * least):.4g} times the pin's diameter there, "
            f"{otherwise}",
            "slot-too-wide",
        )
        if self.round_ends:
            require(
                length >= self.width - tolerance,
                f"with round ends its length, {length / self.width:.4g} times the width, "
                'must be at least the width; lengthen it, or drill a hole (or ends = "square")',
                "slot-too-short",
            )
        self._check_depth(least, most, require, tolerance)

    def _check_depth(self, least: float, most: float, require: Require, tolerance: float) -> None:
        """Raise GeometryError for a depth or radius that does not fit.

        least, most: smallest and largest outer radius of the pin at the slot, m.
        """
        if self.depth is None:
            require(
                self.radius == 0.0,
                "it goes through and has no bottom; give a depth, or no radius",
                "no-bottom",
            )
            return
        require(positive(self.depth), "the depth must be positive", "not-positive")
        side = math.sqrt(max(least**2 - (self.width / 2.0) ** 2, 0.0))
        require(
            most - self.depth < side - tolerance,
            f"a depth of {self.depth / (most - side):.4g} times the sagitta of the surface "
            "over its width leaves no wall; deepen it, or mill a flat",
            "cuts-nothing",
        )
        require(
            self.depth < most - tolerance,
            f"its depth is {self.depth / most:.4g} times the pin's radius, and it must not "
            "reach the axis; reduce it, or leave it out for a slot through the pin",
            "too-deep",
        )
        limit = min(MAX_BOTTOM_RADIUS_RATIO * self.width, 0.9 * (self.depth - (most - side)))
        require(
            self.radius <= limit + tolerance,
            f"the radius of its bottom is {self.radius / limit if limit else 0:.4g} times "
            f"the largest that fits, {MAX_BOTTOM_RADIUS_RATIO:g} of the width and within the "
            "height of its walls",
            "radius-too-large",
        )


def _check_ends(cut: Flat | Slot, pin: Pin, require: Require) -> None:
    """Raise GeometryError unless the ends are in order and the cut is on the pin."""
    require(cut.z1 - cut.z0 > pin.tolerance, "z = [a, b] requires a < b", "z-reversed")
    inside = cut.z1 > pin.tolerance and cut.z0 < pin.length - pin.tolerance
    require(inside, "it lies entirely beyond an end of the pin", "beyond-end")


def _rounded(cut: Flat | Slot, aside: Off, floor: float) -> tuple[Off, Off, Off]:
    """Distances of points below the bottom, beyond the walls, and outside the removed volume.

    The third distance includes the rounded corners between bottom and walls.
    aside: distance of points beyond the side walls. floor: distance of the bottom from the axis, m.
    """
    c, s, rho = math.cos(cut.angle), math.sin(cut.angle), cut.radius

    def below(x: Floats) -> Floats:
        return np.asarray(floor - (c * x[:, 0] + s * x[:, 1]))

    def beyond(x: Floats) -> Floats:
        return np.maximum(aside(x), _past_ends(cut, x))

    return below, beyond, _corner(beyond, below, rho)


def _corner(one: Off, other: Off, rho: float) -> Off:
    """Distance from the region in which two distances are negative, its corner rounded by rho."""

    def off(x: Floats) -> Floats:
        p, q = one(x) + rho, other(x) + rho
        corner = np.hypot(np.maximum(p, 0.0), np.maximum(q, 0.0))
        return np.asarray(corner + np.minimum(np.maximum(p, q), 0.0) - rho)

    return off


def _fillet(one: Off, other: Off, rho: float) -> SmoothPart:
    """The fillet of radius rho between two sides."""
    whole = _corner(one, other, rho)

    def off(x: Floats) -> Floats:
        aside = np.maximum(-rho - one(x), 0.0) + np.maximum(-rho - other(x), 0.0)
        return np.asarray(np.abs(whole(x)) + aside)

    return SmoothPart("fillet", "", off, rho)


def _on(whole: Off, side: Off) -> Off:
    """Distance of points from the part of a side that bounds the whole."""
    return lambda x: np.abs(whole(x)) + np.abs(side(x))


def _past_ends(cut: Flat | Slot, x: Floats) -> Floats:
    """Distance of points (P, 3) beyond the ends of a cut along z, (P,) m, negative between them."""
    middle, half = 0.5 * (cut.z0 + cut.z1), 0.5 * (cut.z1 - cut.z0)
    return np.asarray(np.abs(x[:, 2] - middle) - half)


def _parts(
    below: Off, beyond: Off, both: Off, radius: float, wall: str, bottom: bool = True
) -> tuple[SmoothPart, ...]:
    """Floor, wall and fillet of a cut, from the three distances of `_rounded`.

    wall: name of the wall. bottom: whether there is a floor.
    """
    out = []
    if bottom:
        out.append(SmoothPart("floor", "Plane", _on(both, below)))
    out.append(SmoothPart(wall, "", _on(both, beyond)))
    if radius:
        out.append(_fillet(beyond, below, radius))
    return tuple(out)

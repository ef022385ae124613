"""Flats, keyways and slots."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from geometry.shape.features import Cut, Off, SmoothPart, positive, radii, require
from geometry.shape.pin import Pin
from geometry.shape.tolerance import snapped
from pinbase.arrays import Floats, Mask
from pinbase.errors import Place

MAX_BOTTOM_RADIUS_RATIO = 0.45  # of the width of a slot: the radius of its bottom


class Milled(Cut):
    """A cut from z0 to z1, m, whose bottom is rounded to a `radius`, m."""

    z0: float
    z1: float
    radius: float

    @property
    def extent(self) -> tuple[float, float]:
        """From end to end."""
        return self.z0, self.z1

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Self:
        """With other ends."""
        return self._with(dict(zip(("z0", "z1"), change(self.z0, self.z1), strict=True)))

    def snapped(self, marks: Collection[float], tolerance: float) -> Self:
        """The same with its ends at marks (z, m) that are within the tolerance (m)."""
        return self.along(lambda a, b: (snapped(a, marks, tolerance), snapped(b, marks, tolerance)))

    def past(self, length: float, near: float) -> Self:
        """The same, ends that are near the pin's or beyond them so far that none of what is rounded
        there is left (m).
        """
        far = 2.0 * self.radius + (self.size if math.isfinite(self.size) else 0.0)
        if not far:
            return self
        low = min(self.z0, -far) if self.z0 <= near else self.z0
        high = max(self.z1, length + far) if self.z1 >= length - near else self.z1
        return self.along(lambda a, b: (low, high))


@dataclass(frozen=True)
class Flat(Milled):
    """What lies beyond `distance` (m) from the axis in the direction `angle` (rad from x) is taken
    away from z0 to z1 (m); radius: to which the inner corners at its ends are rounded.
    """

    z0: float
    z1: float
    distance: float
    angle: float = 0.0
    radius: float = 0.0

    what: ClassVar[str] = "flat"

    @property
    def size(self) -> float:
        """As wide as the pin is; that it has no size of its own."""
        return math.inf

    @property
    def half_turn(self) -> bool:
        """Never."""
        return False

    def lengths(self) -> tuple[str, ...]:
        """All but the angle."""
        return "z0", "z1", "distance", "radius"

    def takes(self, x: Floats, radius: float) -> Mask:
        """What lies beyond the distance, between its ends."""
        del radius
        u = math.cos(self.angle) * x[:, 0] + math.sin(self.angle) * x[:, 1]
        return np.asarray((u > self.distance) & (x[:, 2] > self.z0) & (x[:, 2] < self.z1))

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """Floor, ends, and what rounds their corner."""
        del pin
        below, beyond, both = _rounded(self, lambda x: np.full(len(x), -math.inf), self.distance)
        return _parts(below, beyond, both, self.radius, "end")

    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raises: GeometryError when it cuts nothing, or reaches the axis."""
        what = f"pin {pin.name}, {name}"
        _check_ends(self, pin, what, at)
        require(
            self.distance > 0.0,
            f"{what}: the distance from the axis must be positive",
            "not-positive",
            at,
        )
        most = radii(pin, self.z0, self.z1)[1]
        require(
            self.distance < most - pin.tolerance,
            f"{what}: its distance from the axis is {self.distance / most:.4g} times the pin's "
            "radius there, so it cuts nothing; reduce the distance",
            "cuts-nothing",
            at,
        )
        require(
            2.0 * self.radius < self.z1 - self.z0,
            f"{what}: its radius is {self.radius / (self.z1 - self.z0):.4g} times its length and "
            "must be less than half of it",
            "radius-too-large",
            at,
        )


@dataclass(frozen=True)
class Slot(Milled):
    """A slot along the pin from z0 to z1 (m), of a width (m), as a cutter leaves it that moves
    along: milled from the direction `angle` (rad from x) `depth` (m) deep from the surface, None
    through the whole pin. round_ends: half circles in plan, or square. radius: at its bottom.
    """

    z0: float
    z1: float
    width: float
    depth: float | None = None
    angle: float = 0.0
    radius: float = 0.0
    round_ends: bool = True

    what: ClassVar[str] = "slot"

    @property
    def size(self) -> float:
        """The width."""
        return self.width

    @property
    def half_turn(self) -> bool:
        """If it goes through."""
        return self.depth is None

    @property
    def middle(self) -> float:
        """z, m."""
        return 0.5 * (self.z0 + self.z1)

    def lengths(self) -> tuple[str, ...]:
        """All but the angle."""
        return "z0", "z1", "width", "depth", "radius"

    def floor(self, pin: Pin) -> float:
        """Distance of its bottom from the axis, m."""
        if self.depth is None:
            return -math.inf
        return radii(pin, self.z0, self.z1)[1] - self.depth

    def takes(self, x: Floats, radius: float) -> Mask:
        """What lies inside its outline in plan, on the side from which it is milled."""
        del radius
        u = math.cos(self.angle) * x[:, 0] + math.sin(self.angle) * x[:, 1]
        between = (x[:, 2] > self.z0) & (x[:, 2] < self.z1)
        return np.asarray(between & (self._aside(x) < 0.0) & ((u > 0.0) | (self.depth is None)))

    def _aside(self, x: Floats) -> Floats:
        """How far points (P, 3) are outside of its walls in plan, m."""
        half, radius = self.width / 2.0, self.width / 2.0 if self.round_ends else 0.0
        long = 0.5 * (self.z1 - self.z0) - radius
        y = np.abs(math.cos(self.angle) * x[:, 1] - math.sin(self.angle) * x[:, 0])
        if not self.round_ends:
            return np.asarray(y - half)
        past = np.maximum(np.abs(x[:, 2] - self.middle) - long, 0.0)
        return np.asarray(np.hypot(y, past) - half)

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """Bottom, walls, and what rounds their corner."""
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
        """Raises: GeometryError when it is no slot of this pin."""
        what, long = f"pin {pin.name}, {name}", self.z1 - self.z0
        _check_ends(self, pin, what, at)
        require(positive(self.width), f"{what}: the width must be positive", "not-positive", at)
        near = pin.tolerance
        if self.depth is None:
            inside = self.z0 > near and self.z1 < pin.length - near
            require(
                inside,
                f"{what}: a slot through the pin must end before the pin does, or it parts it",
                "beyond-end",
                at,
            )
        least, most = radii(pin, self.z0, self.z1)
        require(
            self.width / 2.0 < least - near,
            f"{what}: its width is {self.width / (2.0 * least):.4g} times the pin's diameter there "
            "and would cut the pin in two; reduce it",
            "slot-too-wide",
            at,
        )
        if self.round_ends:
            require(
                long >= self.width - near,
                f"{what}: with round ends its length, {long / self.width:.4g} times the width, "
                'must be at least the width; lengthen it, or drill a hole (or ends = "square")',
                "slot-too-short",
                at,
            )
        self._check_depth(least, most, what, near, at)

    def _check_depth(self, least: float, most: float, what: str, near: float, at: Place) -> None:
        if self.depth is None:
            require(
                self.radius == 0.0,
                f"{what}: it goes through and has no bottom; give a depth, or no radius",
                "no-bottom",
                at,
            )
            return
        require(positive(self.depth), f"{what}: the depth must be positive", "not-positive", at)
        side = math.sqrt(max(least**2 - (self.width / 2.0) ** 2, 0.0))
        require(
            most - self.depth < side - near,
            f"{what}: a depth of {self.depth / (most - side):.4g} times the sagitta of the surface "
            "over its width leaves no wall; deepen it, or mill a flat",
            "cuts-nothing",
            at,
        )
        require(
            self.depth < most - near,
            f"{what}: its depth is {self.depth / most:.4g} times the pin's radius, and it must not "
            "reach the axis; reduce it, or leave it out for a slot through the pin",
            "too-deep",
            at,
        )
        limit = min(MAX_BOTTOM_RADIUS_RATIO * self.width, 0.9 * (self.depth - (most - side)))
        require(
            self.radius <= limit + near,
            f"{what}: the radius of its bottom is {self.radius / limit if limit else 0:.4g} times "
            f"the most that fits, {MAX_BOTTOM_RADIUS_RATIO:g} of the width and the height of its "
            f"walls",
            "radius-too-large",
            at,
        )


def _check_ends(cut: Flat | Slot, pin: Pin, what: str, at: Place) -> None:
    require(cut.z1 - cut.z0 > pin.tolerance, f"{what}: z = [a, b] requires a < b", "z-reversed", at)
    inside = cut.z1 > pin.tolerance and cut.z0 < pin.length - pin.tolerance
    require(inside, f"{what}: it lies entirely beyond an end of the pin", "beyond-end", at)


def _rounded(cut: Flat | Slot, aside: Off, floor: float) -> tuple[Off, Off, Off]:
    """How far points are below the bottom, beyond the walls, and, with rounded corners between the
    two, outside of what is taken away.
    """
    c, s, rho = math.cos(cut.angle), math.sin(cut.angle), cut.radius

    def below(x: Floats) -> Floats:
        return np.asarray(floor - (c * x[:, 0] + s * x[:, 1]))

    def beyond(x: Floats) -> Floats:
        return np.maximum(aside(x), _past_ends(cut, x))

    return below, beyond, _corner(beyond, below, rho)


def _corner(one: Off, other: Off, rho: float) -> Off:
    """How far points are outside of where both are negative, the corner rounded."""

    def off(x: Floats) -> Floats:
        p, q = one(x) + rho, other(x) + rho
        corner = np.hypot(np.maximum(p, 0.0), np.maximum(q, 0.0))
        return np.asarray(corner + np.minimum(np.maximum(p, q), 0.0) - rho)

    return off


def _fillet(one: Off, other: Off, rho: float) -> SmoothPart:
    """What rounds the corner between two sides."""
    whole = _corner(one, other, rho)

    def off(x: Floats) -> Floats:
        aside = np.maximum(-rho - one(x), 0.0) + np.maximum(-rho - other(x), 0.0)
        return np.asarray(np.abs(whole(x)) + aside)

    return SmoothPart("fillet", "", off, rho)


def _on(whole: Off, side: Off) -> Off:
    """How far points are off a side of the whole."""
    return lambda x: np.abs(whole(x)) + np.abs(side(x))


def _past_ends(cut: Flat | Slot, x: Floats) -> Floats:
    middle, half = 0.5 * (cut.z0 + cut.z1), 0.5 * (cut.z1 - cut.z0)
    return np.asarray(np.abs(x[:, 2] - middle) - half)


def _parts(
    below: Off, beyond: Off, both: Off, radius: float, wall: str, bottom: bool = True
) -> tuple[SmoothPart, ...]:
    out = []
    if bottom:
        out.append(SmoothPart("floor", "Plane", _on(both, below)))
    out.append(SmoothPart(wall, "", _on(both, beyond)))
    if radius:
        out.append(_fillet(beyond, below, radius))
    return tuple(out)

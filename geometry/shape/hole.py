"""Holes across the pin, through it or blind."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from geometry.shape.drill import (
    SQUARE_BOTTOM,
    Bottom,
    Drilled,
    Placed,
    closed_outline,
    drill_outline,
    turned_surfaces,
    wall_edges,
)
from geometry.shape.features import Off, SmoothPart, outer_radius, positive, radii, require
from geometry.shape.pin import Pin
from geometry.shape.profile import Edge
from pinbase.arrays import Floats, Mask
from pinbase.errors import Place

MIN_SAME_SIDE_COSINE = 0.9  # cosine of the angle between holes drilled from the same side
MIN_WALL_RATIO = 0.02  # of a diameter: walls that nobody makes, and of which meshes have no end
MAX_MOUTH_REACH = 1.5  # of its radius: how far a rounded mouth reaches at most


@dataclass(frozen=True)
class Hole(Drilled):
    """A round hole across the pin: its axis crosses the pin's at z (m), at `angle` (rad) from x;
    diameter in m.

    depth: from the surface to where the full diameter ends, m, for one that is drilled from the
    direction `angle` and ends there with a `bottom`; None through the pin. chamfer: width of a
    countersink of 90 degrees at its mouths, measured at the generator of the pin that it meets;
    mouth_radius: to which the edges of its mouths are rounded; m.
    """

    z: float
    diameter: float
    angle: float = 0.0
    depth: float | None = None
    bottom: Bottom = SQUARE_BOTTOM
    chamfer: float = 0.0
    mouth_radius: float = 0.0

    what: ClassVar[str] = "hole"

    @property
    def extent(self) -> tuple[float, float]:
        """With what is taken from its mouth."""
        half = self.diameter / 2.0 + self.chamfer + self.mouth_radius
        return self.z - half, self.z + half

    @property
    def half_turn(self) -> bool:
        """If it goes through."""
        return self.depth is None

    @property
    def undivided(self) -> bool:
        """With rounded mouths."""
        return self.mouth_radius > 0.0

    @property
    def plain(self) -> bool:
        """Whether it is a cylinder through the pin and no more."""
        return self.depth is None and not self.chamfer and not self.mouth_radius

    def lengths(self) -> tuple[str, ...]:
        """All but angles."""
        return "z", "diameter", "depth", "chamfer", "mouth_radius"

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Hole:
        """With its middle amid other ends."""
        a, b = change(self.z, self.z)
        return replace(self, z=0.5 * (a + b))

    def placed(self, pin: Pin, top: float) -> Placed:
        """What is taken away of a profile, as far as t = top (m) from its axis."""
        a, outer = self.diameter / 2.0, outer_radius(pin, self.z)
        chamfer = (self.chamfer, outer) if self.chamfer else None
        if self.depth is not None:
            outline = drill_outline(a, self.bottom, outer - self.depth, top, chamfer)
        else:
            far = wall_edges(a, top, chamfer)
            down = [(0.0, -top), *((s, -t) for _, s, t in reversed(far))]
            names = [None, *(n for n, _, _ in reversed(far[1:]))]
            edges = [Edge(n, p, q) for n, p, q in zip(names, down, down[1:], strict=False)]
            outline = closed_outline(edges, far)
        c, s = math.cos(self.angle), math.sin(self.angle)
        return Placed(outline, (0.0, 0.0, self.z), (c, s, 0.0))

    def takes(self, x: Floats, radius: float) -> Mask:
        """Its mouths, with what is countersunk; of rounded ones all that is rounded."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        u, aside = c * x[:, 0] + s * x[:, 1], c * x[:, 1] - s * x[:, 0]
        far = np.hypot(aside, x[:, 2] - self.z)
        sunk = np.maximum(self.chamfer - (radius - np.abs(u)), self.mouth_radius)
        return np.asarray((far < self.diameter / 2.0 + sunk) & ((u > 0.0) | (self.depth is None)))

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """Wall, bottom, mouths."""
        top = 4.0 * pin.largest_diameter
        found = turned_surfaces(self.placed(pin, top))
        if self.mouth_radius:
            found = (*found, SmoothPart("mouth", "", self._off_mouth(pin), self.mouth_radius))
        return found

    def _off_mouth(self, pin: Pin) -> Off:
        """Beyond the ring in which its rounded edge lies."""
        a, rho, outer = self.diameter / 2.0, self.mouth_radius, outer_radius(pin, self.z)
        placed = self.placed(pin, 4.0 * pin.largest_diameter)

        def off(x: Floats) -> Floats:
            s, _ = placed.local(x)
            r = np.hypot(x[:, 0], x[:, 1])
            aside = np.maximum(s - a - MAX_MOUTH_REACH * rho, a - s)
            return np.maximum(np.maximum(aside, outer - MAX_MOUTH_REACH * rho - r), 0.0)

        return off

    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raises: GeometryError when it is no hole of this pin."""
        what, r = f"pin {pin.name}, {name}", self.diameter / 2
        require(positive(r), f"{what}: the diameter must be positive", "not-positive", at)
        low, high = self.extent
        require(
            low > pin.tolerance and high < pin.length - pin.tolerance,
            f"{what}: it extends past an end of the pin; its z must be more than half its diameter "
            "from both ends",
            "beyond-end",
            at,
        )
        least = radii(pin, low, high)[0]
        require(
            r < least - pin.tolerance,
            f"{what}: its diameter is {r / least:.4g} times the pin's there and would cut the pin "
            "in two; reduce it",
            "hole-too-large",
            at,
        )
        require(
            high - self.z < least - pin.tolerance,
            f"{what}: its mouth is {(high - self.z) / least:.4g} times as wide as the pin; reduce "
            "its chamfer or mouth_radius",
            "hole-too-large",
            at,
        )
        self._check_mouth(pin, least, what, at)
        if self.depth is None:
            return
        outer = outer_radius(pin, self.z)
        require(positive(self.depth), f"{what}: the depth must be positive", "not-positive", at)
        left = abs(outer - self.depth - self.bottom.height(self.diameter) - pin.radii(self.z)[0])
        require(
            left >= MIN_WALL_RATIO * self.diameter or not pin.radii(self.z)[0],
            f"{what}: its bottom is less than {MIN_WALL_RATIO:g} times its diameter from the "
            f"surface of the "
            "bore; deepen it into the bore, or reduce its depth",
            "thin-wall",
            at,
        )
        self.bottom.check(self.diameter, what, at)
        sagitta = outer - math.sqrt(outer**2 - r**2)
        wall = self.depth - sagitta - self.chamfer - self.mouth_radius
        corner = self.bottom.radius * math.tan(self.bottom.tip / 4.0)
        require(
            wall > corner + pin.tolerance,
            f"{what}: a depth of {self.depth / outer:.4g} times the pin's radius leaves no wall "
            "between its mouth and its bottom; deepen it",
            "cuts-nothing",
            at,
        )
        deep = self.depth + self.bottom.height(self.diameter)
        beyond = outer - deep < -math.sqrt(outer**2 - r**2) + pin.tolerance
        require(
            not beyond,
            f"{what}: with its tip it is {deep / outer / 2:.4g} times the pin's diameter deep and "
            "comes out on the other side; reduce the depth, or leave it out for a hole through",
            "too-deep",
            at,
        )

    def check_beside(self, other: Hole, names: tuple[str, str], pin: Pin, at: Place) -> None:
        """Raises: GeometryError where two holes just touch, or leave a wall that is far too thin
        between them; of blind ones that are drilled from the same side.
        """
        both_through = self.depth is None and other.depth is None
        if not both_through and math.cos(self.angle - other.angle) < MIN_SAME_SIDE_COSINE:
            return
        apart = abs(self.z - other.z)
        wall = apart - 0.5 * (self.diameter + other.diameter)
        least = min(self.diameter, other.diameter)
        require(
            abs(wall) >= MIN_WALL_RATIO * least,
            f"pin {pin.name}: {names[0]} and {names[1]} all but touch: between them a wall of at "
            f"least {MIN_WALL_RATIO:g} times the smaller diameter must be left; move them apart, "
            f"or well "
            "into each other",
            "thin-wall",
            at,
        )

    def _check_mouth(self, pin: Pin, least: float, what: str, at: Place) -> None:
        r = self.diameter / 2.0
        if self.chamfer and self.mouth_radius:
            require(False, f"{what}: give either chamfer or mouth_radius", "key-not-applicable", at)
        sagitta = least - math.sqrt(least**2 - r**2)
        if self.chamfer:
            require(
                self.chamfer > 1.05 * sagitta,
                f"{what}: the chamfer is {self.chamfer / sagitta:.4g} times as deep as the "
                "mouth's edge falls off round the pin and must be more, to reach all of it",
                "chamfer-too-small",
                at,
            )
        if self.mouth_radius:
            low, high = self.extent
            require(
                math.isclose(*radii(pin, low, high), rel_tol=1e-12),
                f"{what}: a mouth can only be rounded where the pin is a cylinder",
                "mouth-not-on-cylinder",
                at,
            )
            require(
                self.mouth_radius < 0.9 * (least - r),
                f"{what}: the radius of its mouth does not fit beside the hole; reduce it",
                "radius-too-large",
                at,
            )

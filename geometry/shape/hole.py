"""Holes across the pin, blind or through; through holes may also be off the axis or oblique."""

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
from geometry.shape.features import (
    Cut,
    Off,
    Require,
    SmoothPart,
    outer_radius,
    positive,
    radii,
    requirement,
)
from geometry.shape.pin import Pin
from geometry.shape.profile import Edge
from pinbase.arrays import Floats, Mask
from pinbase.errors import Place

MIN_SAME_SIDE_COSINE = 0.9  # least cosine of the angle between holes open on the same side
MIN_WALL_RATIO = 0.02  # of a diameter: thinner walls cannot be made, and need excessive meshes
MAX_TILT = math.pi / 3.0 + 1e-12  # rad; chosen by judgement
# Size of a rounded mouth over the size at which the rounding shrinks to a point. Above this ratio
# OpenCASCADE takes 5 % more off the edges than a rolling ball of the radius would, or fails.
MAX_MOUTH_SHARE = 0.8


@dataclass(frozen=True)
class Hole(Drilled):
    """A round hole across the pin, whose axis intersects the pin's axis or passes it.

    z: position at which the hole's axis is nearest to the pin's, m.
    diameter: m.
    angle: direction of the hole's axis, rad from x; a blind hole is drilled from this side.
    depth: depth from the surface to the end of the full diameter, m; None for a through hole.
    bottom: bottom of a blind hole.
    chamfer: width of a 90 degree countersink at the mouths, measured at the generator of the pin
    that it meets, m.
    mouth_radius: radius to which the edges of the mouths are rounded, m.
    offset: distance of the hole's axis from the pin's, towards `angle` plus a quarter turn, m.
    tilt: angle by which the hole's axis leans towards z, rad.
    outer: radius of the pin at an oblique hole, m, which CutPin fills in; 0 for other holes.
    """

    z: float
    diameter: float
    angle: float = 0.0
    depth: float | None = None
    bottom: Bottom = SQUARE_BOTTOM
    chamfer: float = 0.0
    mouth_radius: float = 0.0
    offset: float = 0.0
    tilt: float = 0.0
    outer: float = 0.0

    what: ClassVar[str] = "hole"
    lengths: ClassVar = ("z", "diameter", "depth", "chamfer", "mouth_radius", "offset", "outer")

    @property
    def extent(self) -> tuple[float, float]:
        """Least and greatest z, including chamfers or rounded mouths, m."""
        half = self._mouth / math.cos(self.tilt) + self.outer * abs(math.tan(self.tilt))
        return self.z - half, self.z + half

    @property
    def _mouth(self) -> float:
        """Radius of the mouths, m."""
        return self.diameter / 2.0 + self.chamfer + self.mouth_radius

    @property
    def half_turn(self) -> bool:
        """Whether half a turn maps the hole to itself: if it is a through hole across the axis."""
        return self.depth is None and not self.aslant

    @property
    def aslant(self) -> bool:
        """Whether the hole's axis does not intersect the pin's axis at a right angle."""
        return bool(self.offset or self.tilt)

    def mirrored(self, plane: str) -> Hole:
        """The mirror image of the hole in the plane x, y or z = 0."""
        if plane == "z":
            return replace(super().mirrored(plane), tilt=-self.tilt)
        return replace(super().mirrored(plane), offset=-self.offset)

    def like(self, other: Cut, tolerance: float) -> bool:
        """Whether the hole equals another cut up to a tolerance (m), with its axis either way."""
        if isinstance(other, Hole) and other.aslant and not super().like(other, tolerance):
            other = replace(other.turned(other.angle + math.pi), offset=-other.offset,
                            tilt=-other.tilt)  # fmt: skip
        return super().like(other, tolerance)

    def on(self, pin: Pin) -> Hole:
        """The same hole with the pin's radius as `outer` if it is oblique."""
        return replace(self, outer=outer_radius(pin, self.z)) if self.tilt else self

    @property
    def undivided(self) -> bool:
        """Whether no plane may divide the hole: if its mouths are rounded."""
        return self.mouth_radius > 0.0

    @property
    def plain(self) -> bool:
        """Whether the hole is a plain cylinder through the pin."""
        return self.depth is None and not self.chamfer and not self.mouth_radius

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Hole:
        """The same hole moved in z. change: from old to new ends in z, m."""
        a, b = change(self.z, self.z)
        return replace(self, z=0.5 * (a + b))

    def placed(self, pin: Pin, top: float) -> Placed:
        """The volume that the hole removes from a profile, up to t = top (m) along its axis."""
        a, outer = self.diameter / 2.0, outer_radius(pin, self.z)
        chamfer = (self.chamfer, outer) if self.chamfer else None
        if self.depth is not None:
            outline = drill_outline(a, self.bottom, outer - self.depth, top, chamfer)
        else:
            # Through hole: the edges at the far side mirror those at the near side.
            upper = wall_edges(a, top, chamfer)
            lower = [(0.0, -top), *((s, -t) for _, s, t in reversed(upper))]
            names = [None, *(n for n, _, _ in reversed(upper[1:]))]
            edges = [Edge(n, p, q) for n, p, q in zip(names, lower, lower[1:], strict=False)]
            outline = closed_outline(edges, upper)
        origin, direction = (tuple(v.tolist()) for v in _line(self))
        return Placed(outline, origin, direction)

    def takes(self, x: Floats, radius: float) -> Mask:
        """Mask (P,) of the points x (P, 3) in the mouths, including chamfers or roundings."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        u, aside = c * x[:, 0] + s * x[:, 1], c * x[:, 1] - s * x[:, 0]
        up = math.cos(self.tilt) * (x[:, 2] - self.z) - math.sin(self.tilt) * u
        distance = np.hypot(aside - self.offset, up)
        width = np.maximum(self.chamfer - (radius - np.abs(u)), self.mouth_radius)
        on_side = (u > 0.0) | (self.depth is None)
        return np.asarray((distance < self.diameter / 2.0 + width) & on_side)

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """The smooth parts of the hole's surface: wall, bottom, chamfers or mouths."""
        top = 4.0 * pin.largest_diameter
        parts = turned_surfaces(self.placed(pin, top))
        if self.mouth_radius:
            parts = (*parts, SmoothPart("mouth", "", self._off_mouth(pin), self.mouth_radius))
        return parts

    def _off_mouth(self, pin: Pin) -> Off:
        """Distance of points from the ring in which the rounded edge of a mouth lies.

        The rounded edge is the path of a ball that touches the pin's surface and the hole's wall
        from within the material.
        """
        a, rho, outer = self.diameter / 2.0, self.mouth_radius, outer_radius(pin, self.z)
        # Distance from the hole's axis at which the ball touches the surface, at the sides, and
        # distance from the pin's axis at which it touches the wall.
        widest = (a + rho) * outer / (outer - rho)
        least = math.sqrt((outer - rho) ** 2 - 2.0 * a * rho - rho**2)
        placed = self.placed(pin, 4.0 * pin.largest_diameter)

        def off(x: Floats) -> Floats:
            s, _ = placed.local(x)
            r = np.hypot(x[:, 0], x[:, 1])
            aside = np.maximum(s - widest, a - s)
            return np.maximum(np.maximum(aside, least - r), 0.0)

        return off

    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raise GeometryError when this pin cannot have the hole. name, at: for the message."""
        require, r = requirement(f"pin {pin.name}, {name}", at), self.diameter / 2
        require(positive(r), "the diameter must be positive", "not-positive")
        low, high = self.extent
        require(
            low > pin.tolerance and high < pin.length - pin.tolerance,
            "it extends past an end of the pin; its z must be more than half its diameter "
            "from both ends",
            "beyond-end",
        )
        least = radii(pin, low, high)[0]
        require(
            r < least - pin.tolerance,
            f"its diameter is {r / least:.4g} times the pin's there and would cut the pin "
            "in two; reduce it",
            "hole-too-large",
        )
        require(
            self._mouth < least - pin.tolerance,
            f"its mouth is {self._mouth / least:.4g} times as wide as the pin; reduce "
            "its chamfer or mouth_radius",
            "hole-too-large",
        )
        self._check_mouth(pin, least, require)
        if self.aslant:
            self._check_aslant(pin, require)
        if self.depth is None:
            return
        outer = outer_radius(pin, self.z)
        require(positive(self.depth), "the depth must be positive", "not-positive")
        to_bore = abs(outer - self.depth - self.bottom.height(self.diameter) - pin.radii(self.z)[0])
        require(
            to_bore >= MIN_WALL_RATIO * self.diameter or not pin.radii(self.z)[0],
            f"its bottom is less than {MIN_WALL_RATIO:g} times its diameter from the "
            "surface of the bore; deepen it into the bore, or reduce its depth",
            "thin-wall",
        )
        self.bottom.check(self.diameter, require)
        sagitta = outer - math.sqrt(outer**2 - r**2)
        wall = self.depth - sagitta - self.chamfer - self.mouth_radius
        corner = self.bottom.radius * math.tan(self.bottom.tip / 4.0)
        require(
            wall > corner + pin.tolerance,
            f"a depth of {self.depth / outer:.4g} times the pin's radius leaves no wall "
            "between its mouth and its bottom; deepen it",
            "cuts-nothing",
        )
        deep = self.depth + self.bottom.height(self.diameter)
        beyond = outer - deep < -math.sqrt(outer**2 - r**2) + pin.tolerance
        require(
            not beyond,
            f"with its tip it is {deep / outer / 2:.4g} times the pin's diameter deep and "
            "comes out on the other side; reduce the depth, or leave it out for a hole through",
            "too-deep",
        )

    def check_beside(self, other: Hole, names: tuple[str, str], pin: Pin, at: Place) -> None:
        """Raise GeometryError where two holes almost touch.

        A blind hole is compared only with holes that are open on the side from which it is drilled.
        """
        through = self.depth is None, other.depth is None
        cosine = math.cos(self.angle - other.angle)
        if any(through):  # a through hole is open on both sides
            cosine = abs(cosine)
        if not all(through) and cosine < MIN_SAME_SIDE_COSINE:
            return
        wall = _apart(self, other) - 0.5 * (self.diameter + other.diameter)
        least = min(self.diameter, other.diameter)
        requirement(f"pin {pin.name}", at)(
            abs(wall) >= MIN_WALL_RATIO * least,
            f"{names[0]} and {names[1]} almost touch: the wall between them must "
            f"be at least {MIN_WALL_RATIO:g} times the smaller diameter; move them apart, or well "
            "into each other",
            "thin-wall",
        )

    def _check_aslant(self, pin: Pin, require: Require) -> None:
        """Raise GeometryError for an offset or tilt that this hole, or this pin, cannot have."""
        require(
            self.plain,
            "offset and tilt are for holes through the pin without chamfer, mouth_radius and depth",
            "key-not-applicable",
        )
        require(
            abs(self.tilt) <= MAX_TILT,
            f"its tilt is {math.degrees(self.tilt):.4g} deg; at most 60 deg is possible",
            "too-oblique",
        )
        low, high = self.extent
        inner, outer = pin.radii(self.z)
        require(
            math.isclose(*radii(pin, low, high), rel_tol=1e-12),
            f"offset and tilt need a cylindrical part of the pin, here from z = {low:.4g} "
            f"to {high:.4g} m",
            "mouth-not-on-cylinder",
        )
        # Where a side of the hole touches the surface or the bore, the wall thins out to an edge.
        sides = [abs(self.offset + side * self.diameter / 2.0) for side in (1.0, -1.0)]
        walls = [outer - max(sides), *(abs(s - inner) for s in sides if inner)]
        require(
            min(walls) >= MIN_WALL_RATIO * self.diameter,
            f"its side is less than {MIN_WALL_RATIO:g} times its diameter from the surface "
            "of the pin or of the bore; change its offset",
            "thin-wall",
        )

    def _check_mouth(self, pin: Pin, least: float, require: Require) -> None:
        """Raise GeometryError for a chamfer or rounding that does not fit.

        least: smallest outer radius of the pin at the hole, m.
        """
        r = self.diameter / 2.0
        if self.chamfer and self.mouth_radius:
            require(False, "give either chamfer or mouth_radius", "key-not-applicable")
        sagitta = least - math.sqrt(least**2 - r**2)
        if self.chamfer:
            require(
                self.chamfer > 1.05 * sagitta,
                f"the chamfer is {self.chamfer / sagitta:.4g} times the drop of the "
                "mouth's edge around the pin; it must be larger to reach the whole edge",
                "chamfer-too-small",
            )
        if self.mouth_radius:
            low, high = self.extent
            require(
                math.isclose(*radii(pin, low, high), rel_tol=1e-12),
                "a mouth can only be rounded on a cylindrical part of the pin",
                "mouth-not-on-cylinder",
            )
            require(
                r + 2.0 * self.mouth_radius < MAX_MOUTH_SHARE * least,
                "the radius of its mouth does not fit beside the hole; at most "
                f"{(MAX_MOUTH_SHARE * least - r) / 2.0 / self.diameter:.3g} of its diameter does",
                "radius-too-large",
            )


def _apart(one: Hole, other: Hole) -> float:
    """The distance between the axes of two holes, m."""
    if not (one.aslant or other.aslant):
        return abs(one.z - other.z)
    (a, d), (b, e) = (_line(hole) for hole in (one, other))
    across = np.cross(d, e)
    size = float(np.linalg.norm(across))
    if size < 1e-9:
        return float(np.linalg.norm(np.cross(b - a, d)))
    return float(abs((b - a) @ across) / size)


def _line(hole: Hole) -> tuple[Floats, Floats]:
    """A point (3,) on the axis of a hole, m, and its direction (3,)."""
    c, s, lean = math.cos(hole.angle), math.sin(hole.angle), math.cos(hole.tilt)
    point = np.array([-hole.offset * s, hole.offset * c, hole.z])
    return point, np.array([lean * c, lean * s, math.sin(hole.tilt)])

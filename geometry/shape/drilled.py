"""Holes across the pin and beside its axis, through it or blind."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

import numpy as np

from geometry.arrays import Floats
from geometry.coded import Place
from geometry.shape.features import Cut, CutSurface, Off, outer_radius, positive, radii, require
from geometry.shape.pin import FACES, Pin
from geometry.shape.profile import Arc, Edge, kind_of, off_edge

FLAT_TIP = math.pi
POINTED = math.pi / 6.0  # rad: the least angle of a tip
WIDER = 1.5  # of its radius: how far a rounded mouth reaches at most
Mouth = Literal["start", "end", "both"]


@dataclass(frozen=True)
class Placed:
    """Outline (s, t), m, of a body of revolution that is taken away, s from its axis and t along
    it; the axis passes through `origin` along `direction`.
    """

    outline: tuple[Edge, ...]
    origin: tuple[float, float, float]
    direction: tuple[float, float, float]

    def local(self, x: Floats) -> tuple[Floats, Floats]:
        """s and t of points (P, 3)."""
        away = x - self.origin
        t = away @ np.array(self.direction)
        return np.linalg.norm(away - t[:, None] * self.direction, axis=1), t


@dataclass(frozen=True)
class Bottom:
    """Of a blind hole. tip: angle of the cone that the drill leaves, rad, pi for none; radius: to
    which the corners there are rounded, m.
    """

    tip: float = FLAT_TIP
    radius: float = 0.0

    def rounded(self, digits: int) -> Bottom:
        """With its radius rounded to so many digits, and its angle."""
        tip = round(self.tip, 9)
        return Bottom(FLAT_TIP if tip >= round(FLAT_TIP, 9) else tip, round(self.radius, digits))

    def height(self, diameter: float) -> float:
        """Of the cone below the full diameter, m."""
        return diameter / 2.0 / math.tan(self.tip / 2.0) if self.tip < FLAT_TIP else 0.0

    def check(self, diameter: float, what: str, at: Place) -> None:
        """Raises: GeometryError where the radius does not fit."""
        in_range = POINTED <= self.tip <= FLAT_TIP + 1e-12
        require(
            in_range,
            f"{what}: the tip's angle is {math.degrees(self.tip):.4g} deg and must be from 30 deg "
            "to 180 deg, which is flat",
            "tip-angle",
            at,
        )
        half = self.tip / 2.0
        taken = math.tan(half / 2.0) + (1.0 / math.tan(half) if self.tip < FLAT_TIP else 0.0)
        most = 0.98 * diameter / 2.0 / math.sin(half) / taken
        require(
            self.radius <= most,
            f"{what}: the radius of its bottom is {self.radius / most:.4g} times the most that "
            "fits; reduce it",
            "radius-too-large",
            at,
        )

    def edges(self, a: float, floor: float) -> tuple[Edge, ...]:
        """From the axis to the wall (s = a), whose straight part begins at t >= floor, m."""
        half, rho = self.tip / 2.0, self.radius
        s, c = math.sin(half), math.cos(half) if self.tip < FLAT_TIP else 0.0
        apex = (0.0, floor - self.height(2.0 * a))
        corner = (a, floor)
        out: list[Edge] = []
        if rho == 0.0:
            return (Edge("bottom", apex, corner),)
        first, back = apex, rho * math.tan(half / 2.0)
        if self.tip < FLAT_TIP:
            on = rho / math.tan(half)
            top = (0.0, apex[1] + rho / s - rho)
            first = (on * s, apex[1] + on * c)
            out.append(Arc("fillet", top, first, (0.0, apex[1] + rho / s), rho))
        last = (a - back * s, floor - back * c)
        out.append(Edge("bottom", first, last))
        out.append(Arc("fillet", last, (a, floor + back), (a - rho, floor + back), rho))
        return tuple(out)


def _drill(
    a: float, bottom: Bottom, floor: float, top: float, chamfer: tuple[float, float] | None
) -> tuple[Edge, ...]:
    """A blind tool up to t = top; chamfer: its width and t of the mouth."""
    edges = list(bottom.edges(a, floor))
    return _closed(edges, _wall(a, top, chamfer))


def _wall(
    a: float, top: float, chamfer: tuple[float, float] | None
) -> list[tuple[str | None, float, float]]:
    """Names and ends (s, t) of edges along the wall and what widens it."""
    if chamfer is None:
        return [("wall", a, top)]
    wide, mouth = chamfer
    return [("wall", a, mouth - wide), ("chamfer", a + wide, mouth), (None, a + wide, top)]


def _closed(edges: list[Edge], rest: list[tuple[str | None, float, float]]) -> tuple[Edge, ...]:
    """With edges to the given ends (s, t), and back along the axis."""
    for name, s, t in rest:
        edges.append(Edge(name, edges[-1].end, (s, t)))
    low, high = edges[0].start, (0.0, edges[-1].end[1])
    return (*edges, Edge(None, edges[-1].end, high), Edge(None, high, low))


def _off(placed: Placed, edge: Edge) -> Off:
    return lambda x: off_edge(edge)(*placed.local(x))


def _surfaces(placed: Placed) -> tuple[CutSurface, ...]:
    out = []
    for e in placed.outline:
        if e.name:
            # a torus without a hole is none to OpenCASCADE
            kind, radius = ("", e.radius) if isinstance(e, Arc) else (kind_of(e), 0.0)
            out.append(CutSurface(e.name, kind, _off(placed, e), radius))
    return tuple(out)


@dataclass(frozen=True)
class Hole(Cut):
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
    bottom: Bottom = Bottom()
    chamfer: float = 0.0
    mouth_radius: float = 0.0

    what: ClassVar[str] = "hole"

    @property
    def extent(self) -> tuple[float, float]:
        """With what is taken from its mouth."""
        half = self.diameter / 2.0 + self.chamfer + self.mouth_radius
        return self.z - half, self.z + half

    @property
    def size(self) -> float:
        """The diameter."""
        return self.diameter

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

    def scaled(self, factor: float) -> Hole:
        """The same in another unit."""
        made = super().scaled(factor)
        return replace(made, bottom=replace(self.bottom, radius=self.bottom.radius * factor))

    def rounded(self, digits: int) -> Hole:
        """The same, its bottom as well."""
        return replace(super().rounded(digits), bottom=self.bottom.rounded(digits))

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Hole:
        """With its middle amid other ends."""
        a, b = change(self.z, self.z)
        return replace(self, z=0.5 * (a + b))

    def placed(self, pin: Pin, top: float) -> Placed:
        """What is taken away of a profile, as far as t = top (m) from its axis."""
        a, outer = self.diameter / 2.0, outer_radius(pin, self.z)
        chamfer = (self.chamfer, outer) if self.chamfer else None
        if self.depth is not None:
            outline = _drill(a, self.bottom, outer - self.depth, top, chamfer)
        else:
            far = _wall(a, top, chamfer)
            down = [(0.0, -top), *((s, -t) for _, s, t in reversed(far))]
            names = [None, *(n for n, _, _ in reversed(far[1:]))]
            edges = [Edge(n, p, q) for n, p, q in zip(names, down, down[1:], strict=False)]
            outline = _closed(edges, far)
        c, s = math.cos(self.angle), math.sin(self.angle)
        return Placed(outline, (0.0, 0.0, self.z), (c, s, 0.0))

    def surfaces(self, pin: Pin) -> tuple[CutSurface, ...]:
        """Wall, bottom, mouths."""
        top = 4.0 * pin.largest_diameter
        found = _surfaces(self.placed(pin, top))
        if self.mouth_radius:
            found = (*found, CutSurface("mouth", "", self._off_mouth(pin), self.mouth_radius))
        return found

    def _off_mouth(self, pin: Pin) -> Off:
        """Beyond the ring in which its rounded edge lies."""
        a, rho, outer = self.diameter / 2.0, self.mouth_radius, outer_radius(pin, self.z)
        placed = self.placed(pin, 4.0 * pin.largest_diameter)

        def off(x: Floats) -> Floats:
            s, _ = placed.local(x)
            r = np.hypot(x[:, 0], x[:, 1])
            aside = np.maximum(s - a - WIDER * rho, a - s)
            return np.maximum(np.maximum(aside, outer - WIDER * rho - r), 0.0)

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
            high - self.z < least - pin.tolerance,
            f"{what}: its diameter is {r / least:.4g} times the pin's there and would cut the pin "
            "in two; reduce it",
            "hole-too-large",
            at,
        )
        self._check_mouth(pin, least, what, at)
        if self.depth is None:
            return
        outer = outer_radius(pin, self.z)
        require(positive(self.depth), f"{what}: the depth must be positive", "not-positive", at)
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


@dataclass(frozen=True)
class Passage(Cut):
    """A hole along the pin, its axis `offset` (m) from the pin's in the direction `angle` (rad from
    x): of a diameter (m), between z0 and z1 (m), drilled from a `mouth`: "start", "end", or "both"
    for one through the pin. bottom: of a blind one, beyond the end of its full diameter.
    """

    z0: float
    z1: float
    diameter: float
    offset: float
    angle: float = 0.0
    mouth: Mouth = "both"
    bottom: Bottom = Bottom()

    what: ClassVar[str] = "passage"

    @property
    def extent(self) -> tuple[float, float]:
        """With its tip."""
        tip = self.bottom.height(self.diameter)
        down, up = (tip if self.mouth == end else 0.0 for end in ("end", "start"))
        return self.z0 - down, self.z1 + up

    @property
    def size(self) -> float:
        """The diameter."""
        return self.diameter

    @property
    def half_turn(self) -> bool:
        """Never; amid the pin it is round."""
        return False

    @property
    def round(self) -> bool:
        """On the axis."""
        return self.offset == 0.0

    @property
    def opens(self) -> tuple[float, float]:
        """Nowhere on the outer surface."""
        return math.inf, -math.inf

    @property
    def faces(self) -> tuple[str, ...]:
        """With its mouths."""
        return FACES if self.mouth == "both" else (self.mouth,)

    def lengths(self) -> tuple[str, ...]:
        """All but angles."""
        return "z0", "z1", "diameter", "offset"

    def scaled(self, factor: float) -> Passage:
        """The same in another unit."""
        made = super().scaled(factor)
        return replace(made, bottom=replace(self.bottom, radius=self.bottom.radius * factor))

    def rounded(self, digits: int) -> Passage:
        """The same, its bottom as well."""
        return replace(super().rounded(digits), bottom=self.bottom.rounded(digits))

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Passage:
        """With other ends; what exchanges them turns it round."""
        a, b = change(self.z0, self.z1)
        turned = change(0.0, 1.0)[0] < change(0.0, 0.0)[0]
        other: dict[Mouth, Mouth] = {"start": "end", "end": "start", "both": "both"}
        return replace(self, z0=a, z1=b, mouth=other[self.mouth] if turned else self.mouth)

    def placed(self, pin: Pin, top: float) -> Placed:
        """What is taken away, beyond the ends of the profile by `top` (m)."""
        del pin
        x, y = self.offset * math.cos(self.angle), self.offset * math.sin(self.angle)
        long, a = self.z1 - self.z0, self.diameter / 2.0
        if self.mouth == "both":
            first = [Edge(None, (0.0, -top), (a, -top))]
            return Placed(_closed(first, [("wall", a, long + top)]), (x, y, self.z0), (0, 0, 1.0))
        outline = _drill(a, self.bottom, 0.0, long + top, None)
        if self.mouth == "end":
            return Placed(outline, (x, y, self.z0), (0.0, 0.0, 1.0))
        return Placed(outline, (x, y, self.z1), (0.0, 0.0, -1.0))

    def surfaces(self, pin: Pin) -> tuple[CutSurface, ...]:
        """Wall and bottom."""
        return _surfaces(self.placed(pin, 2.0 * pin.largest_diameter))

    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raises: GeometryError when it is no passage of this pin."""
        what, r, near = f"pin {pin.name}, {name}", self.diameter / 2, pin.tolerance
        require(positive(r), f"{what}: the diameter must be positive", "not-positive", at)
        require(self.offset >= 0.0, f"{what}: the offset must not be negative", "negative", at)
        require(self.z1 - self.z0 > near, f"{what}: the depth must be positive", "not-positive", at)
        self.bottom.check(self.diameter, what, at)
        low, high = self.extent
        deep = self.mouth != "both" and not (
            (self.mouth == "start" or low > near)
            and (self.mouth == "end" or high < pin.length - near)
        )
        require(
            not deep,
            f"{what}: with its tip it is as deep as the pin is long; reduce the depth, or leave it "
            "out for one through the pin",
            "too-deep",
            at,
        )
        least, _ = radii(pin, low, high)
        require(
            self.offset + r < least - near,
            f"{what}: its wall reaches {(self.offset + r) / least:.4g} times the pin's radius and "
            "breaks out of its surface; reduce the offset or the diameter",
            "breaks-out",
            at,
        )
        ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
        bores = [max(s.bores) / 2.0 for s, a, b in ends if b > low and a < high]
        require(
            not max(bores, default=0.0) or self.offset - r > max(bores) + near,
            f"{what}: it meets the pin's bore; increase the offset",
            "meets-bore",
            at,
        )

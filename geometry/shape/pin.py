"""A pin: segments of a body of revolution along z, the bands on which links bear, exact volume."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

from geometry.coded import Coded
from geometry.shape.tolerance import ROUND_OFF, SAME, merged, snapped

FACES = ("start", "end")


class GeometryError(Coded, ValueError):
    """The pin as described is impossible; the message says why and what would be right."""


@dataclass(frozen=True)
class Segment:
    """A cylinder of the profile; all in m.

    bore: inner diameter, 0 for solid. connection: the connection whose link bears on it. fillet:
    radius of the inner corner at its far end; None takes the pin's.
    """

    length: float
    diameter: float
    bore: float = 0.0
    name: str | None = None
    connection: str | None = None
    fillet: float | None = None

    def scaled(self, factor: float) -> Segment:
        """The same segment in another unit."""
        length, diameter, bore = (x * factor for x in (self.length, self.diameter, self.bore))
        fillet = None if self.fillet is None else self.fillet * factor
        return replace(self, length=length, diameter=diameter, bore=bore, fillet=fillet)


@dataclass(frozen=True)
class Band:
    """A cylindrical surface: the part of a segment between its fillets; m."""

    name: str
    z0: float
    z1: float
    radius: float

    @property
    def length(self) -> float:
        """Axial length, m."""
        return self.z1 - self.z0

    @property
    def area(self) -> float:
        """Exact area, m^2."""
        return 2.0 * math.pi * self.radius * self.length

    @property
    def middle(self) -> float:
        """z of the middle, m."""
        return 0.5 * (self.z0 + self.z1)


@dataclass(frozen=True)
class Pin:
    """A body of revolution from z = 0 on; `fillet` (m) is the radius at every inner corner.

    Diameters and bores that differ by less than its `tolerance` are made equal; merged: the largest
    difference (m) that was, 0 where it was no more than round-off.

    Raises: GeometryError when a dimension is impossible or a fillet does not fit.
    """

    name: str
    segments: tuple[Segment, ...]
    fillet: float = 0.0
    merged: float = field(init=False, default=0.0, compare=False)

    revolved: ClassVar[bool] = True
    meshed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        _check_dimensions(self)
        segments, apart = _merged(self.segments, self.tolerance)
        object.__setattr__(self, "segments", segments)
        object.__setattr__(self, "merged", apart)
        _check(self)

    @cached_property
    def tolerance(self) -> float:
        """The length (m) below which two dimensions are one."""
        return SAME * self.smallest_diameter

    @cached_property
    def stations(self) -> tuple[float, ...]:
        """z of the ends of all segments, m."""
        z = [0.0]
        for s in self.segments:
            z.append(z[-1] + s.length)
        return tuple(z)

    @property
    def length(self) -> float:
        """Overall length, m."""
        return self.stations[-1]

    @property
    def ends(self) -> tuple[float, float]:
        """Least and greatest z, m."""
        return 0.0, self.length

    @property
    def smallest_diameter(self) -> float:
        """m."""
        return min(s.diameter for s in self.segments)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """The name of each segment's outer surface: its connection, its name, or its number."""
        return tuple(
            s.connection or s.name or f"segment {i}" for i, s in enumerate(self.segments, 1)
        )

    def fillet_at(self, corner: int) -> float:
        """Radius (m) of the corner between segments `corner` and `corner` + 1 (from 0)."""
        left, right = self.segments[corner], self.segments[corner + 1]
        if left.diameter == right.diameter:
            return 0.0
        step = 0.5 * abs(left.diameter - right.diameter)
        rho = self.fillet if left.fillet is None else left.fillet
        return snapped(rho, (step,), min(self.tolerance, 1e-3 * step))

    @cached_property
    def bands(self) -> tuple[Band, ...]:
        """The outer cylinder of every segment, without what fillets take from it."""
        bands = []
        for i, s in enumerate(self.segments):
            cut = [0.0, 0.0]
            for side, j, corner in ((0, i - 1, i - 1), (1, i + 1, i)):
                if 0 <= j < len(self.segments) and self.segments[j].diameter > s.diameter:
                    cut[side] = self.fillet_at(corner)
            z0, z1 = self.stations[i] + cut[0], self.stations[i + 1] - cut[1]
            z1 = snapped(z1, (z0,), self.tolerance)  # fillets that meet, meet in one circle
            bands.append(Band(self.labels[i], z0, z1, 0.5 * s.diameter))
        return tuple(bands)

    @property
    def connections(self) -> tuple[str, ...]:
        """Connections that bear on this pin, in the order of the profile."""
        return tuple(s.connection for s in self.segments if s.connection)

    def band(self, name: str) -> Band:
        """The outer surface called `name` (a segment's connection, name or number), or "bore " and
        such a name for the inner one.
        """
        if name.startswith("bore ") and name[5:] in self.labels:
            i = self.labels.index(name[5:])
            return Band(name, self.stations[i], self.stations[i + 1], 0.5 * self.segments[i].bore)
        return self.bands[self._position(name)]

    def surface(self, name: str) -> str:
        """The mesh boundary for a name in a study: "start", "end" or a segment's.

        Raises: GeometryError listing the names there are.
        """
        return name if name in FACES else self.labels[self._position(name)]

    def _position(self, name: str) -> int:
        for i, s in enumerate(self.segments):
            if name in (s.connection, s.name, self.labels[i]):
                return i
        known = ", ".join((*FACES, *self.labels))
        raise GeometryError(
            f"pin {self.name} has no surface {name!r}; its surfaces are {known}", "unknown-surface"
        )

    @cached_property
    def volume(self) -> float:
        """Exact volume, m^3: cylinders, and by Pappus the rings that fillets add."""
        tubes = (s.length * (s.diameter**2 - s.bore**2) * math.pi / 4.0 for s in self.segments)
        rings = 0.0
        for i in range(len(self.segments) - 1):
            rho = self.fillet_at(i)
            shaft = 0.5 * min(self.segments[i].diameter, self.segments[i + 1].diameter)
            # spandrel between two tangents and the arc: area and its centroid's distance from both
            area = (1.0 - math.pi / 4.0) * rho**2
            centroid = rho * (10.0 - 3.0 * math.pi) / (12.0 - 3.0 * math.pi)
            rings += 2.0 * math.pi * (shaft + centroid) * area
        return sum(tubes) + rings

    def scaled(self, factor: float) -> Pin:
        """The same pin in another unit."""
        segments = tuple(s.scaled(factor) for s in self.segments)
        return replace(self, segments=segments, fillet=self.fillet * factor)

    def with_bore(self, connection: str, bore: float) -> Pin:
        """The same pin with a bore (m) through the segment on which `connection` bears."""
        i = self._position(connection)
        segments = list(self.segments)
        segments[i] = replace(segments[i], bore=bore)
        return replace(self, segments=tuple(segments))


def _merged(segments: tuple[Segment, ...], tolerance: float) -> tuple[tuple[Segment, ...], float]:
    """Segments whose diameters and bores are equal or further apart than the tolerance; the largest
    difference (m) between a dimension and what it became, if more than round-off.
    """
    outer = merged((s.diameter for s in segments), tolerance)
    inner = merged((0.0, *(s.bore for s in segments)), tolerance)
    changes = [*outer.items(), *inner.items()]
    apart = max((old - new for old, new in changes if old - new > ROUND_OFF * old), default=0.0)
    one = (replace(s, diameter=outer[s.diameter], bore=inner[s.bore]) for s in segments)
    return tuple(one), apart


def _check_dimensions(pin: Pin) -> None:
    where = f"pin {pin.name}"
    if not pin.segments:
        raise GeometryError(f"{where}: the profile has no segments", "no-segments")
    for i, s in enumerate(pin.segments, 1):
        what, at = f"{where}, segment {i}", ("segment", i)
        if not (math.isfinite(s.length) and s.length > 0.0):
            raise GeometryError(f"{what}: the length must be positive", "not-positive", at)
        if not (math.isfinite(s.diameter) and s.diameter > 0.0):
            raise GeometryError(f"{what}: the diameter must be positive", "not-positive", at)
        if not 0.0 <= s.bore < s.diameter:
            raise _bore_too_large(what, i)
        if s.fillet is not None and not s.fillet >= 0.0:
            raise GeometryError(f"{what}: the fillet must not be negative", "negative", at)
    if not pin.fillet >= 0.0:
        raise GeometryError(f"{where}: the fillet must not be negative", "negative")


def _bore_too_large(what: str, i: int) -> GeometryError:
    at = ("segment", i)
    return GeometryError(f"{what}: the bore must be less than the diameter", "bore-too-large", at)


def _check(pin: Pin) -> None:
    where, least = f"pin {pin.name}", pin.tolerance
    for i, s in enumerate(pin.segments, 1):
        if s.diameter - s.bore <= least:
            raise _bore_too_large(f"{where}, segment {i}", i)
        if s.length <= least:
            raise GeometryError(
                f"{where}, segment {i}: its length is {s.length / pin.smallest_diameter:.2g} of "
                "the pin's smallest diameter, too short to model; lengthen it or leave it out",
                "segment-too-short",
                ("segment", i),
            )
    for i, (a, b) in enumerate(pairwise(pin.segments), 1):
        if min(a.diameter, b.diameter) - max(a.bore, b.bore) <= least:
            raise GeometryError(
                f"{where}: the bore separates segment {i} from segment {i + 1}; it must be less "
                "than the smaller of their diameters",
                "segments-separate",
                ("segment", i),
            )
    names = [n for s in pin.segments for n in {s.connection, s.name} if n] + list(FACES)
    twice = sorted({n for n in names if names.count(n) > 1})
    if twice:
        raise GeometryError(
            f"{where}: two surfaces are named {twice[0]!r}; names must be unique", "duplicate-name"
        )
    _check_fillets(pin)


def _check_fillets(pin: Pin) -> None:
    for i in range(len(pin.segments) - 1):
        rho = pin.fillet_at(i)
        step = 0.5 * abs(pin.segments[i].diameter - pin.segments[i + 1].diameter)
        if rho > step:
            raise GeometryError(
                f"pin {pin.name}: the fillet between segments {i + 1} and {i + 2} is "
                f"{rho / step:.4g} times as large as the step; reduce it to at most half the "
                f"difference of the diameters, or give segment {i + 1} a fillet of its own",
                "fillet-too-large",
                ("segment", i + 1),
            )
    for i, (s, band) in enumerate(zip(pin.segments, pin.bands, strict=True), 1):
        left = band.length
        if left < 0.0 or (s.connection and left == 0.0):
            raise GeometryError(
                f"pin {pin.name}, segment {i}: the fillets at its ends take up its whole length "
                f"({(s.length - left) / s.length:.4g} of it); reduce them or lengthen the segment",
                "fillets-overlap",
                ("segment", i),
            )

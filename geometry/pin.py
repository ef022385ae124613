"""A pin: segments of a body of revolution along z, the bands on which links bear, exact volume."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

FACES = ("start", "end")


class GeometryError(ValueError):
    """The pin as described cannot exist; the message says why and what would fit."""


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


@dataclass(frozen=True)
class Band:
    """A cylindrical surface: what is left of a segment between its fillets; m."""

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

    Raises: GeometryError when a dimension is impossible or a fillet does not fit.
    """

    name: str
    segments: tuple[Segment, ...]
    fillet: float = 0.0

    def __post_init__(self) -> None:
        _check(self)

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
        return self.fillet if left.fillet is None else left.fillet

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
            bands.append(Band(self.labels[i], z0, z1, 0.5 * s.diameter))
        return tuple(bands)

    @property
    def revolved(self) -> bool:
        """Whether it is the same all round its axis: always."""
        return True

    @property
    def meshed(self) -> bool:
        """Whether it comes with a mesh: never."""
        return False

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
        raise GeometryError(f"pin {self.name} has no surface {name!r}; it has {known}")

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

    def weight(self, density: float, gravity: float = 9.80665) -> float:
        """Weight (N) for a density in kg/m^3."""
        return density * gravity * self.volume

    def with_bore(self, connection: str, bore: float) -> Pin:
        """The same pin with a bore (m) through the segment on which `connection` bears."""
        i = self._position(connection)
        segments = list(self.segments)
        segments[i] = replace(segments[i], bore=bore)
        return replace(self, segments=tuple(segments))


def _check(pin: Pin) -> None:
    where = f"pin {pin.name}"
    if not pin.segments:
        raise GeometryError(f"{where}: the profile has no segments")
    for i, s in enumerate(pin.segments, 1):
        what = f"{where}, segment {i}"
        if not (math.isfinite(s.length) and s.length > 0.0):
            raise GeometryError(f"{what}: its length must be positive")
        if not (math.isfinite(s.diameter) and s.diameter > 0.0):
            raise GeometryError(f"{what}: its diameter must be positive")
        if not 0.0 <= s.bore < s.diameter:
            raise GeometryError(f"{what}: its bore must be smaller than its diameter")
        if s.fillet is not None and s.fillet < 0.0:
            raise GeometryError(f"{what}: its fillet must not be negative")
    if pin.fillet < 0.0:
        raise GeometryError(f"{where}: the fillet must not be negative")
    for i, (a, b) in enumerate(zip(pin.segments, pin.segments[1:], strict=False), 1):
        if a.bore >= b.diameter or b.bore >= a.diameter:
            raise GeometryError(f"{where}: the bore separates segment {i} from segment {i + 1}")
    names = [n for s in pin.segments for n in {s.connection, s.name} if n] + list(FACES)
    twice = sorted({n for n in names if names.count(n) > 1})
    if twice:
        raise GeometryError(f"{where}: two surfaces are called {twice[0]!r}")
    _check_fillets(pin)


def _check_fillets(pin: Pin) -> None:
    for i in range(len(pin.segments) - 1):
        rho = pin.fillet_at(i)
        step = 0.5 * abs(pin.segments[i].diameter - pin.segments[i + 1].diameter)
        if rho > step * (1.0 + 1e-12):
            raise GeometryError(
                f"pin {pin.name}: a fillet of {rho / step:.4g} times the step does not fit between "
                f"segments {i + 1} and {i + 2}; the shoulder is only as high as the step, so make "
                f"the radius at most half the difference of the diameters, or set the fillet of "
                f"segment {i + 1} on its own"
            )
    for i, (s, band) in enumerate(zip(pin.segments, pin.bands, strict=True), 1):
        left = band.length
        if left < -1e-12 * s.length or (s.connection and left <= 1e-9 * s.length):
            raise GeometryError(
                f"pin {pin.name}, segment {i}: the fillets at its ends take its whole length "
                f"({(s.length - left) / s.length:.4g} of it); make them smaller or it longer"
            )

"""What is cut from a profile: removed volumes, each with a surface, an extent and symmetries."""

from __future__ import annotations

import dataclasses
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any, ClassVar, Self

from geometry.shape.pin import GeometryError, Pin
from pinbase.arrays import Floats, Mask
from pinbase.errors import Place

Off = Callable[[Floats], Floats]  # distances (P,) of points (P, 3) from a surface
ANGLE_TOLERANCE = 1e-9


@dataclass(frozen=True)
class SmoothPart:
    """A smooth part of a cut's surface: its name, gmsh's word for it ("" for several kinds), and
    how far points are off it. radius: to which it rounds an inner corner, 0 where it does not, m.
    """

    part: str
    kind: str
    off: Off
    radius: float = 0.0


class Cut(ABC):
    """A volume taken away from a profile, about or beside its axis. What its subclasses store are
    lengths in m, and `angle` in rad from x.
    """

    what: ClassVar[str]  # in names: "hole 1"
    angle: float

    @property
    @abstractmethod
    def extent(self) -> tuple[float, float]:
        """Least and greatest z, m."""

    @property
    @abstractmethod
    def size(self) -> float:
        """Across, m: by it are measured the distance from its inner corners and between places."""

    @property
    def undivided(self) -> bool:
        """Whether an end of a pin must not cut it: OpenCASCADE rounds no edges that end there."""
        return False

    @property
    @abstractmethod
    def half_turn(self) -> bool:
        """Whether half a turn about the pin's axis leaves it where it is."""

    @abstractmethod
    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """All of its surface in a profile."""

    @abstractmethod
    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raises: GeometryError when it cannot be cut into a profile."""

    @abstractmethod
    def lengths(self) -> tuple[str, ...]:
        """Names of what is a length."""

    @abstractmethod
    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Self:
        """The same with its two ends in z changed."""

    @property
    def opens(self) -> tuple[float, float]:
        """Between which z, m, it takes from the outer surface."""
        return self.extent

    @abstractmethod
    def takes(self, x: Floats, radius: float) -> Mask:
        """Which points (P, 3), m, of an outer cylinder of a radius (m) are cut away."""

    @property
    def faces(self) -> tuple[str, ...]:
        """End faces from which it takes although they are not in its extent."""
        return ()

    def scaled(self, factor: float) -> Self:
        """The same in another unit."""
        return self._with({key: _times(getattr(self, key), factor) for key in self.lengths()})

    def rounded(self, digits: int) -> Self:
        """The same with its lengths rounded to so many digits, and its angle."""
        lengths = {key: getattr(self, key) for key in self.lengths()}
        made = {k: None if x is None else round(x, digits) + 0.0 for k, x in lengths.items()}
        return self._with(made | {"angle": round(self.angle, 9) + 0.0})

    def moved(self, z: float, angle: float) -> Self:
        """The same in a frame at z (m), turned by an angle (rad)."""
        return self.along(lambda a, b: (a - z, b - z)).turned(self.angle - angle)

    def turned(self, angle: float) -> Self:
        """The same in another direction."""
        return self._with({"angle": angle})

    def mirrored(self, plane: str) -> Self:
        """Its image in the plane across x, y or z through the origin."""
        if plane == "z":
            return self.along(lambda a, b: (-b, -a))
        return self.turned(-self.angle if plane == "y" else math.pi - self.angle)

    def like(self, other: Cut, tolerance: float) -> bool:
        """Whether it is the same as another cut, but for round-off (tolerance in m)."""
        if type(other) is not type(self):
            return False
        period = 1.0 if self.half_turn else 0.5
        turn = math.sin(period * (self.angle - other.angle))
        if abs(turn) > ANGLE_TOLERANCE and not self.round:
            return False
        ours, others = dataclasses.asdict(self), dataclasses.asdict(other)  # type: ignore[call-overload]
        return all(_near(ours[key], others[key], tolerance) for key in ours if key != "angle")

    @property
    def round(self) -> bool:
        """Whether it is of revolution about the pin's axis."""
        return False

    def _with(self, changes: dict[str, Any]) -> Self:
        made: Self = dataclasses.replace(self, **changes)  # type: ignore[type-var]
        return made


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor


def _near(a: Any, b: Any, tolerance: float) -> bool:
    if isinstance(a, float) and isinstance(b, float):
        return abs(a - b) <= tolerance
    return bool(a == b)


def radii(pin: Pin, z0: float, z1: float) -> tuple[float, float]:
    """Smallest and largest outer radius, m, of the segments between z0 and z1."""
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    near = [(s, a, (max(a, z0), min(b, z1))) for s, a, b in ends if b > z0 and a < z1]
    found = [s.radii(z - a)[1] for s, a, both in near for z in both]
    return (min(found), max(found)) if found else (0.0, 0.0)


def outer_radius(pin: Pin, z: float) -> float:
    """Of the segment in which z lies, m."""
    near = pin.tolerance
    return radii(pin, z - near, z + near)[1] if 0.0 <= z <= pin.length else 0.0


def require(holds: bool, text: str, code: str, at: Place) -> None:
    """Raises: GeometryError unless something holds."""
    if not holds:
        raise GeometryError(text, code, at)


def positive(*values: float) -> bool:
    """Whether all are, and finite."""
    return all(math.isfinite(x) and x > 0.0 for x in values)


def marks_of(pin: Pin) -> Collection[float]:
    """z of the ends of its segments and bands, m."""
    return {*pin.stations, *(z for b in pin.bands for z in (b.z0, b.z1))}

"""Cuts in a profile as removed volumes, each with its surfaces, extent and symmetries."""

from __future__ import annotations

import dataclasses
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any, ClassVar, Self

from geometry.shape.band import GeometryError
from geometry.shape.pin import Pin
from pinbase.arrays import Floats, Mask
from pinbase.errors import Place

Require = Callable[[bool, str, str], None]  # returned by `requirement`
Off = Callable[[Floats], Floats]  # distances (P,) of points (P, 3) from a surface
ANGLE_TOLERANCE = 1e-9  # rad


@dataclass(frozen=True)
class SmoothPart:
    """A smooth part of a cut's surface.

    part: name of the part, such as "wall".
    kind: gmsh's type of surface; "" for any type.
    off: function that returns the distance of points from the part.
    radius: radius of the inner corner that the part rounds, m; 0 where it rounds none.
    """

    part: str
    kind: str
    off: Off
    radius: float = 0.0


class Cut(ABC):
    """A volume that is removed from a profile. Lengths are in m.

    what: kind of the cut, used in names such as "hole 1".
    lengths: names of the fields that are lengths.
    angle: direction of the cut, rad from x.
    """

    what: ClassVar[str]
    lengths: ClassVar[tuple[str, ...]]
    angle: float

    @property
    @abstractmethod
    def extent(self) -> tuple[float, float]:
        """Least and greatest z, m."""

    @property
    @abstractmethod
    def size(self) -> float:
        """Width, m, to which element sizes and distances near the cut are relative."""

    @property
    def undivided(self) -> bool:
        """Whether no plane may divide the cut, because OpenCASCADE can only round whole edges."""
        return False

    @property
    def half_turn(self) -> bool:
        """Whether half a turn about the pin's axis maps the cut to itself."""
        return False

    @abstractmethod
    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """The smooth parts of the cut's surface in a profile."""

    @abstractmethod
    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raise GeometryError when the profile cannot have this cut. name, at: for the message."""

    @abstractmethod
    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Self:
        """The same cut with other ends. change: from old to new ends in z, m."""

    @property
    def opens(self) -> tuple[float, float]:
        """Least and greatest z of the part of the outer surface that the cut removes, m."""
        return self.extent

    @abstractmethod
    def takes(self, x: Floats, radius: float) -> Mask:
        """Mask (P,) of the points x (P, 3), m, of an outer cylinder that are removed.

        radius: radius of that cylinder, m.
        """

    @property
    def faces(self) -> tuple[str, ...]:
        """Names of the end faces that the cut cuts, although they are not in its extent."""
        return ()

    def on(self, pin: Pin) -> Self:
        """The same cut as it is in this pin."""
        del pin
        return self

    def past(self, pin: Pin) -> Self:
        """The same cut, once checked, as far beyond the ends of the pin as makes it simple."""
        del pin
        return self

    def scaled(self, factor: float) -> Self:
        """The same cut in another unit of length: all lengths times `factor`."""
        return self._with({key: _times(getattr(self, key), factor) for key in self.lengths})

    def rounded(self, digits: int) -> Self:
        """The same cut with its lengths rounded to `digits` decimals, and its angle to nine."""
        lengths = {key: getattr(self, key) for key in self.lengths}
        rounded = {k: None if x is None else round(x, digits) + 0.0 for k, x in lengths.items()}
        return self._with(rounded | {"angle": round(self.angle, 9) + 0.0})

    def moved(self, z: float, angle: float) -> Self:
        """The same cut in a frame at z (m) that is rotated by an angle (rad)."""
        return self.along(lambda a, b: (a - z, b - z)).turned(self.angle - angle)

    def turned(self, angle: float) -> Self:
        """The same cut in another direction. angle: rad from x."""
        return self._with({"angle": angle})

    def mirrored(self, plane: str) -> Self:
        """The mirror image of the cut in the plane x, y or z = 0."""
        if plane == "z":
            return self.along(lambda a, b: (-b, -a))
        return self.turned(-self.angle if plane == "y" else math.pi - self.angle)

    def like(self, other: Cut, tolerance: float) -> bool:
        """Whether this cut equals another one up to a tolerance (m)."""
        if type(other) is not type(self):
            return False
        period = 1.0 if self.half_turn else 0.5
        turn = math.sin(period * (self.angle - other.angle))
        if abs(turn) > ANGLE_TOLERANCE and not self.round:
            return False
        one, two = dataclasses.asdict(self), dataclasses.asdict(other)  # type: ignore[call-overload]
        return all(_near(one[key], two[key], tolerance) for key in one if key != "angle")

    @property
    def round(self) -> bool:
        """Whether the cut is a body of revolution about the pin's axis."""
        return False

    def _with(self, changes: dict[str, Any]) -> Self:
        """The same cut with other values of some fields."""
        changed: Self = dataclasses.replace(self, **changes)  # type: ignore[type-var]
        return changed


def _times(value: float | None, factor: float) -> float | None:
    """The product, or None for no value."""
    return None if value is None else value * factor


def _near(a: Any, b: Any, tolerance: float) -> bool:
    """Whether two values are equal; floating-point numbers, within a tolerance."""
    if isinstance(a, float) and isinstance(b, float):
        return abs(a - b) <= tolerance
    return bool(a == b)


def radii(pin: Pin, z0: float, z1: float) -> tuple[float, float]:
    """Smallest and largest outer radius of a pin between z0 and z1, m."""
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    parts = [(s, a, (max(a, z0), min(b, z1))) for s, a, b in ends if b > z0 and a < z1]
    radii_at_ends = [s.radii(z - a)[1] for s, a, both in parts for z in both]
    return (min(radii_at_ends), max(radii_at_ends)) if radii_at_ends else (0.0, 0.0)


def outer_radius(pin: Pin, z: float) -> float:
    """Outer radius of a pin at z, m; 0 beyond its ends."""
    tolerance = pin.tolerance
    return radii(pin, z - tolerance, z + tolerance)[1] if 0.0 <= z <= pin.length else 0.0


def requirement(what: str, at: Place) -> Require:
    """A function of a condition, a text and a code, which raises GeometryError if it is false.

    what: subject of the text. at: place of the subject in the study.
    """

    def require(holds: bool, text: str, code: str) -> None:
        if not holds:
            raise GeometryError(f"{what}: {text}", code, at)

    return require


def positive(*values: float) -> bool:
    """Whether all values are positive and finite."""
    return all(math.isfinite(x) and x > 0.0 for x in values)


def marks_of(pin: Pin) -> Collection[float]:
    """Positions z of the ends of a pin's segments and bands, m."""
    return {*pin.stations, *(z for b in pin.bands for z in (b.z0, b.z1))}

"""Holes and flats, and what must be true of them to be cut into a profile."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace

from geometry.shape.pin import GeometryError, Pin
from geometry.shape.tolerance import snapped


@dataclass(frozen=True)
class Hole:
    """A round hole through the whole pin: its axis crosses the pin's at z (m), at `angle` (rad)
    from x; diameter in m.
    """

    z: float
    diameter: float
    angle: float = 0.0

    def scaled(self, factor: float) -> Hole:
        """The same in another unit."""
        return Hole(self.z * factor, self.diameter * factor, self.angle)


@dataclass(frozen=True)
class Flat:
    """What lies beyond `distance` (m) from the axis in the direction `angle` (rad from x) is taken
    away from z0 to z1 (m).
    """

    z0: float
    z1: float
    distance: float
    angle: float = 0.0

    def scaled(self, factor: float) -> Flat:
        """The same in another unit."""
        z0, z1, distance = (x * factor for x in (self.z0, self.z1, self.distance))
        return Flat(z0, z1, distance, self.angle)

    def snapped(self, marks: Collection[float], tolerance: float) -> Flat:
        """The same with its ends at marks (z, m) that are within the tolerance (m)."""
        z0, z1 = (snapped(z, marks, tolerance) for z in (self.z0, self.z1))
        return replace(self, z0=z0, z1=z1)


def radii(pin: Pin, z0: float, z1: float) -> tuple[float, float]:
    """Smallest and largest outer radius, m, of the segments between z0 and z1."""
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    near = [(s, a, (max(a, z0), min(b, z1))) for s, a, b in ends if b > z0 and a < z1]
    found = [s.radii(z - a)[1] for s, a, both in near for z in both]
    return (min(found), max(found)) if found else (0.0, 0.0)


def check_hole(pin: Pin, i: int, hole: Hole) -> None:
    """Raises: GeometryError when hole i does not go through the pin, or cuts it in two."""
    what, r, at = f"pin {pin.name}, hole {i}", hole.diameter / 2, ("hole", i)
    if not (math.isfinite(r) and r > 0.0):
        raise GeometryError(f"{what}: the diameter must be positive", "not-positive", at)
    if hole.z - r <= pin.tolerance or hole.z + r >= pin.length - pin.tolerance:
        raise GeometryError(
            f"{what}: it extends past an end of the pin; its z must be more than half its diameter "
            "from both ends",
            "beyond-end",
            at,
        )
    least = radii(pin, hole.z - r, hole.z + r)[0]
    if r >= least - pin.tolerance:
        raise GeometryError(
            f"{what}: its diameter is {r / least:.4g} times the pin's there and would cut the pin "
            "in two; reduce it",
            "hole-too-large",
            at,
        )


def check_flat(pin: Pin, i: int, flat: Flat) -> None:
    """Raises: GeometryError when flat i cuts nothing, or reaches the axis."""
    what, at = f"pin {pin.name}, flat {i}", ("flat", i)
    if not flat.z1 - flat.z0 > pin.tolerance:
        raise GeometryError(f"{what}: z = [a, b] requires a < b", "z-reversed", at)
    if flat.z1 <= pin.tolerance or flat.z0 >= pin.length - pin.tolerance:
        raise GeometryError(f"{what}: it lies entirely beyond an end of the pin", "beyond-end", at)
    if not flat.distance > 0.0:
        raise GeometryError(
            f"{what}: the distance from the axis must be positive", "not-positive", at
        )
    most = radii(pin, flat.z0, flat.z1)[1]
    if flat.distance >= most - pin.tolerance:
        raise GeometryError(
            f"{what}: its distance from the axis is {flat.distance / most:.4g} times the pin's "
            "radius there, so it cuts nothing; reduce the distance",
            "cuts-nothing",
            at,
        )

"""Holes and flats, and what must be true of them to be cut into a profile."""

from __future__ import annotations

import math
from dataclasses import dataclass

from geometry.pin import GeometryError, Pin


@dataclass(frozen=True)
class Hole:
    """A round hole through the whole pin: its axis crosses the pin's at z (m), at `angle` (rad)
    from x; diameter in m.
    """

    z: float
    diameter: float
    angle: float = 0.0


@dataclass(frozen=True)
class Flat:
    """What lies beyond `distance` (m) from the axis in the direction `angle` (rad from x) is taken
    away from z0 to z1 (m).
    """

    z0: float
    z1: float
    distance: float
    angle: float = 0.0


def radii(pin: Pin, z0: float, z1: float) -> tuple[float, float]:
    """Smallest and largest outer radius, m, of the segments between z0 and z1."""
    ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    found = [s.diameter / 2 for s, a, b in ends if b > z0 and a < z1]
    return (min(found), max(found)) if found else (0.0, 0.0)


def check_hole(pin: Pin, i: int, hole: Hole) -> None:
    """Raises: GeometryError when hole i does not go through the pin, or cuts it in two."""
    what, r = f"pin {pin.name}, hole {i}", hole.diameter / 2
    if not (math.isfinite(r) and r > 0.0):
        raise GeometryError(f"{what}: its diameter must be positive")
    if hole.z - r <= 0.0 or hole.z + r >= pin.length:
        raise GeometryError(
            f"{what}: it reaches beyond the ends of the pin; z must be further than half its "
            "diameter from both"
        )
    least = radii(pin, hole.z - r, hole.z + r)[0]
    if r >= least:
        raise GeometryError(
            f"{what}: its diameter is {r / least:.4g} times the pin's there, which would cut it in "
            "two; make it smaller"
        )


def check_flat(pin: Pin, i: int, flat: Flat) -> None:
    """Raises: GeometryError when flat i cuts nothing, or reaches the axis."""
    what = f"pin {pin.name}, flat {i}"
    if not flat.z0 < flat.z1:
        raise GeometryError(f"{what}: z = [a, b] needs a below b")
    if flat.z1 <= 0.0 or flat.z0 >= pin.length:
        raise GeometryError(f"{what}: it lies beyond the ends of the pin")
    if not flat.distance > 0.0:
        raise GeometryError(f"{what}: its distance from the axis must be positive")
    most = radii(pin, flat.z0, flat.z1)[1]
    if flat.distance >= most:
        raise GeometryError(
            f"{what}: it lies outside the pin, {flat.distance / most:.4g} times its radius from "
            "the axis, so it cuts nothing"
        )

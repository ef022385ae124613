"""What one mesh says of one case: the noun between the models and the verdict."""

from __future__ import annotations

from dataclasses import dataclass

Point = tuple[float, float, float]

FELT = 0.1  # of a place's radius: a place governs if at this distance it has the largest stress


@dataclass(frozen=True)
class Inside:
    """Of a singular place: the largest von Mises stress in it (Pa), which only says how fine the
    mesh is, where (x, y, z in m); felt: the largest further away than FELT of its radius; and the
    exponent with which stress was seen to grow, None where that could not be measured. acts: false
    where only other cases of the pin load the place, so that stress has a bound there.
    """

    maximum: float
    felt: float
    location: Point
    exponent: float | None = None
    acts: bool = True


@dataclass(frozen=True)
class Look:
    """maximum: largest von Mises stress (Pa) outside all singular places, at `location` (m) at the
    governing `instant`. places: what is inside of each.

    scatter: of the maximum by the mesh alone, where it was seen, Pa. left_out: by how much the
    harmonics of a bearing pressure that are not taken may change the maximum, Pa. high: points
    (r, z) of a section, m, where a finer mesh may find the maximum.
    """

    unknowns: int
    maximum: float
    instant: int
    location: Point
    places: tuple[Inside, ...] = ()
    scatter: float = 0.0
    left_out: float = 0.0
    high: tuple[tuple[float, float], ...] = ()

"""Derivatives of the largest stress of a pin, as results."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Derivatives:
    """Of the largest von Mises stress `maximum`, Pa, at `location` (x, y, z), m.

    by_dimension: Pa/m, by the key of each dimension; without: why others have none. by_force,
    by_moment: Pa/N and Pa/(N m), by surface and axis of the pin ("x", "y", "z"), the other loads as
    they are. poisson_ratio: Pa; youngs_modulus: 0, because a pin under given loads has the same
    stress with any; density: Pa/(kg/m^3), of its own weight.
    """

    maximum: float
    location: tuple[float, float, float]
    by_dimension: dict[str, float]
    without: dict[str, str]
    by_force: dict[tuple[str, str], float]
    by_moment: dict[tuple[str, str], float]
    poisson_ratio: float
    density: float
    youngs_modulus: float = 0.0

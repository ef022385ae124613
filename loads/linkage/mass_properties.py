"""Mass properties of a uniform straight bar."""

from __future__ import annotations

import math


def round_bar(length: float, diameter: float, density: float) -> tuple[float, float]:
    """Mass (kg) of a round bar and its inertia (kg m^2) about a transverse axis at its middle.

    length, diameter: m.
    density: kg/m^3.
    """
    mass = density * math.pi / 4.0 * diameter**2 * length
    return mass, mass * (length**2 / 12.0 + diameter**2 / 16.0)


def flat_bar(length: float, depth: float, width: float, density: float) -> tuple[float, float]:
    """Mass (kg) of a rectangular bar and its inertia (kg m^2) about an axis through its middle.

    length, depth, width: m; the axis is parallel to `width`.
    density: kg/m^3.
    """
    mass = density * depth * width * length
    return mass, mass * (length**2 + depth**2) / 12.0

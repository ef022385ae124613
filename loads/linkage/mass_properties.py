"""Mass properties of a uniform straight bar."""

from __future__ import annotations

import math


def round_bar(length: float, diameter: float, density: float) -> tuple[float, float]:
    """Mass (kg) and inertia (kg m^2) about a transverse axis through the middle of a round bar."""
    mass = density * math.pi / 4.0 * diameter**2 * length
    return mass, mass * (length**2 / 12.0 + diameter**2 / 16.0)


def flat_bar(length: float, depth: float, width: float, density: float) -> tuple[float, float]:
    """Mass (kg) and inertia (kg m^2) of a rectangular bar about the axis across the plane in which
    `depth` is measured.
    """
    mass = density * depth * width * length
    return mass, mass * (length**2 + depth**2) / 12.0

"""Masses of floating pins, and friction circles, in a plane and in space."""

from __future__ import annotations

import math

from pinstress.study.model.pins import pin
from pinstress.study.reading.file import Study

STANDARD_GRAVITY = 9.80665


def friction_circle(friction: float | None, diameter: float | None) -> float:
    """Return the radius of the friction circle of a pin, m.

    friction: coefficient. diameter: m.
    """
    mu = friction or 0.0
    return 0.5 * (diameter or 0.0) * mu / math.hypot(1.0, mu)


def pin_mass(study: Study, joint: str, weight: float | None, gravity: float) -> float:
    """Return the mass of a floating pin: as stated, or of the profile of that name, or zero."""
    if weight is not None:
        return weight / gravity
    if joint not in study.table.pin:
        return 0.0
    density = study.material_of(joint).density
    return density * pin(study, joint).volume if density else 0.0

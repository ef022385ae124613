"""Bending with an axial force of a fully plastic round section, solid or hollow.

A plane at a distance c from the axis parts tension from compression, which are s_y everywhere. With
outer and inner radius a and b (powers of what is negative are zero, and asin is of 1 at most),

    M = 4/3 s_y ((a^2 - c^2)^(3/2) - (b^2 - c^2)^(3/2))
    N = s_y (W(a) - W(b)),    W(r) = 2 (c sqrt(r^2 - c^2) + r^2 asin(c / r))

A solid section, with c = a sin t, has M/Mp = cos^3 t and N/Np = (2 t + sin 2 t) / pi. All that a
section can carry is within this curve, which is convex: its chords are inside, and the lines along
M + c N, by which it flows, outside. So both are given, closer than 1e-4 of each other.

Source: B. G. Neal, The Plastic Methods of Structural Analysis (1977), section 6.2, for the way.
"""

from __future__ import annotations

import math

import numpy as np

from fea.beam.round_section import Circle
from pinbase.arrays import Floats

CURVE_POINTS = 201  # points of the curve, whose chords and tangents are within 1e-4 of it


def bending_and_axial_use(section: Circle, moment: Floats, axial: Floats) -> tuple[Floats, Floats]:
    """The use of the interaction curve by bending and axial force, an upper and a lower estimate.

    moment: M/Mp (...), axial: N/Np (...), not negative. The upper one is by a chord, the lower one
    by tangents.
    """
    lever, on_m, on_n = _curve(section)
    slope = np.arctan2(on_n, on_m)
    first = np.searchsorted(slope, np.arctan2(axial, moment), side="right") - 1
    first = np.clip(first, 0, CURVE_POINTS - 2)
    dm, dn = np.diff(on_m)[first], np.diff(on_n)[first]
    most = (moment * dn - axial * dm) / (on_m[first] * dn - on_n[first] * dm)
    flows = [
        (moment + lever[k] * axial) / (on_m[k] + lever[k] * on_n[k]) for k in (first, first + 1)
    ]
    return np.asarray(most), np.maximum(*flows)


def plastic_use(
    section: Circle, shear: float, moment: float, axial: float, torque: float, strength: float
) -> float:
    """The part of what a fully plastic section carries that these forces use, at most.

    It is sqrt(g^2 + (V/Vs + T/Tp)^2), as in assess.plastic.hinge.
    shear, moment, axial, torque: N and N m, not negative.
    strength: yield, Pa.
    """
    M, N = (
        np.array([moment / (strength * section.plastic_modulus)]),
        np.array([axial / (strength * section.area)]),
    )
    bent = float(bending_and_axial_use(section, M, N)[0][0]) if moment or axial else 0.0
    in_shear = strength / math.sqrt(3.0)
    sheared = shear * section.vq_it / (section.area * in_shear)
    return math.hypot(bent, sheared + torque / (in_shear * plastic_torque(section)))


def plastic_torque(section: Circle) -> float:
    """Torque of a fully plastic section over the yield stress in shear, m^3."""
    return 2.0 / 3.0 * math.pi * (section.outer**3 - section.inner**3)


def _curve(section: Circle) -> tuple[Floats, Floats, Floats]:
    """c Np / Mp, M/Mp and N/Np, (CURVE_POINTS,) each, from pure bending to pure tension."""
    a, b = section.outer, section.inner
    c = a * np.sin(np.linspace(0.0, np.pi / 2.0, CURVE_POINTS))
    bending = (_power(a, c) - _power(b, c)) / (a**3 - b**3)
    pulling = (_within(a, c) - _within(b, c)) / section.area
    return c * section.area / section.plastic_modulus, bending, pulling


def _power(radius: float, c: Floats) -> Floats:
    """(r^2 - c^2)^(3/2), zero where c exceeds the radius."""
    return np.maximum(radius**2 - c**2, 0.0) ** 1.5


def _within(radius: float, c: Floats) -> Floats:
    """The area of a disc within the distance c of a diameter."""
    near = np.minimum(c, radius)
    angle = np.arcsin(near / radius) if radius else np.zeros_like(c)
    return np.asarray(2.0 * (near * np.sqrt(radius**2 - near**2) + radius**2 * angle))

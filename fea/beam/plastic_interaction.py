"""Bending with an axial force of a fully plastic round section, solid or hollow.

A plane at a distance c from the axis separates tension from compression, which are s_y everywhere.
With outer and inner radius a and b (powers of negative numbers are zero, and the argument of asin
is at most 1),

    M = 4/3 s_y ((a^2 - c^2)^(3/2) - (b^2 - c^2)^(3/2))
    N = s_y (W(a) - W(b)),    W(r) = 2 (c sqrt(r^2 - c^2) + r^2 asin(c / r))

A solid section, with c = a sin t, has M/Mp = cos^3 t and N/Np = (2 t + sin 2 t) / pi. All that a
section can carry lies within this curve, which is convex. Its chords lie inside, and its tangents,
the lines of constant M + c N (flow is normal to them), outside. So both give bounds, closer than
1e-4 to each other.

A section with a hardened surface is two concentric rings, each of its own strength, whose M and N
are added.

Source: B. G. Neal, The Plastic Methods of Structural Analysis (1977), section 6.2, for the way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fea.beam.round_section import Circle
from fea.core.hardened import Hardened
from pinbase.arrays import Floats

CURVE_POINTS = 201  # points of the curve, whose chords and tangents are within 1e-4 of it


Ring = tuple[Circle, float]  # a concentric part of a section, and its yield strength


def cased_rings(section: Circle, case: Hardened) -> tuple[Ring, ...]:
    """The case and the core of a hardened section."""
    core = section.outer - case.depth
    return (Circle(section.outer, core), case.surface), (Circle(core, section.inner), case.core)


def bending_and_axial_use(section: Circle, moment: Floats, axial: Floats) -> tuple[Floats, Floats]:
    """The utilisation of the interaction curve by bending and axial force, an upper and a lower
    bound.

    The upper bound is by a chord, the lower one by tangents.
    moment: M/Mp (...), not negative.
    axial: N/Np (...), not negative.
    """
    return _use(((section, 1.0),), moment, axial)


def _use(rings: Sequence[Ring], moment: Floats, axial: Floats) -> tuple[Floats, Floats]:
    lever, on_m, on_n = _curve(rings)
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
    rings: Sequence[Ring], shear: float, moment: float, axial: float, torque: float
) -> float:
    """An upper bound of the part of a fully plastic section's capacity that section forces use.

    It is sqrt(g^2 + (V/Vs + T/Tp)^2), as in assess.plastic.hinge. Shear forces are carried as in
    elasticity, with the least strength of the rings.
    rings: of the section, from the outside, with their yield strengths, Pa.
    shear, moment, axial, torque: N and N m, not negative.
    """
    M = np.array([moment / sum(strength * ring.plastic_modulus for ring, strength in rings)])
    N = np.array([axial / sum(strength * ring.area for ring, strength in rings)])
    bent = float(_use(rings, M, N)[0][0]) if moment or axial else 0.0
    section = Circle(rings[0][0].outer, rings[-1][0].inner)
    in_shear = min(strength for _, strength in rings) / math.sqrt(3.0)
    sheared = shear * section.vq_it / (section.area * in_shear)
    twisted = sum(strength / math.sqrt(3.0) * plastic_torque(ring) for ring, strength in rings)
    return math.hypot(bent, sheared + torque / twisted)


def plastic_torque(section: Circle) -> float:
    """The torque of a fully plastic section over the yield stress in shear, m^3."""
    return 2.0 / 3.0 * math.pi * (section.outer**3 - section.inner**3)


def _curve(rings: Sequence[Ring]) -> tuple[Floats, Floats, Floats]:
    """The coefficient c Np / Mp, and M/Mp and N/Np, (CURVE_POINTS,) each, from pure bending to pure
    tension.
    """
    c = rings[0][0].outer * np.sin(np.linspace(0.0, np.pi / 2.0, CURVE_POINTS))
    shares = [(ring.outer, ring.inner, strength) for ring, strength in rings]
    bending = sum(s * (_power(a, c) - _power(b, c)) for a, b, s in shares)
    pulling = sum(s * (_within(a, c) - _within(b, c)) for a, b, s in shares)
    axial = sum(s * ring.area for ring, s in rings)
    moment = sum(s * ring.plastic_modulus for ring, s in rings)
    cubes = sum(s * (a**3 - b**3) for a, b, s in shares)
    return c * axial / moment, np.asarray(bending / cubes), np.asarray(pulling / axial)


def _power(radius: float, c: Floats) -> Floats:
    """Return (r^2 - c^2)^(3/2), zero where c exceeds the radius."""
    return np.maximum(radius**2 - c**2, 0.0) ** 1.5


def _within(radius: float, c: Floats) -> Floats:
    """The area of a disc within the distance c of a diameter."""
    near = np.minimum(c, radius)
    angle = np.arcsin(near / radius) if radius else np.zeros_like(c)
    half = np.sqrt(np.maximum(radius**2 - near**2, 0.0))  # which round-off may make negative
    return np.asarray(2.0 * (near * half + radius**2 * angle))

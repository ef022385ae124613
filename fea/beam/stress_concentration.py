"""Stress concentration factors of shoulder fillets on round shafts.

Kt = C1 + C2 (2h/D) + C3 (2h/D)^2 + C4 (2h/D)^3 with h = (D - d) / 2, each C a polynomial in
sqrt(h/r): fits to Peterson's charts. Kt is the largest principal stress over the nominal stress of
the thinner shaft (in torsion: shear over shear).

The factors are known to be below fine elastic solutions, up to 11 % in bending and up to 21 % in
tension (D/d = 1.25, r/d = 0.0125: 3.12, where our harmonic model and CalculiX's axisymmetric
elements find 3.963: `python -m benchmarks tension`). The coefficients are as published, so the
difference is that of the charts. On the other hand, the von Mises stress is 8 to 10 % below the
largest principal stress there, because the shoulder hinders the hoop strain. So Kt times the
nominal stress is not the von Mises peak; fea.beam.error_model states how near it is.

Source: W. D. Pilkey & D. F. Pilkey, Peterson's Stress Concentration Factors, ch. 3; W. D. Pilkey,
Formulas for Stress, Strain, and Structural Matrices, has the same fits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from geometry import Pin

Row = tuple[float, float, float]
Fit = tuple[tuple[float, float], Row, Row, Row, Row]  # h/r from, to; C1 to C4

TENSION_FIT: tuple[Fit, ...] = (
    (
        (0.1, 2.0),
        (0.926, 1.157, -0.099),
        (0.012, -3.036, 0.961),
        (-0.302, 3.977, -1.744),
        (0.365, -2.098, 0.878),
    ),
    (
        (2.0, 20.0),
        (1.200, 0.860, -0.022),
        (-1.805, -0.346, -0.038),
        (2.198, -0.486, 0.165),
        (-0.593, -0.028, -0.106),
    ),
)
BENDING_FIT: tuple[Fit, ...] = (
    (
        (0.1, 2.0),
        (0.947, 1.206, -0.131),
        (0.022, -3.405, 0.915),
        (0.869, 1.777, -0.555),
        (-0.810, 0.422, -0.260),
    ),
    (
        (2.0, 20.0),
        (1.232, 0.832, -0.008),
        (-3.813, 0.968, -0.260),
        (7.423, -4.868, 0.869),
        (-3.839, 3.070, -0.600),
    ),
)
TORSION_FIT: tuple[Fit, ...] = (
    (
        (0.25, 4.0),
        (0.905, 0.783, -0.075),
        (-0.437, -1.969, 0.553),
        (1.557, 1.073, -0.578),
        (-1.061, 0.171, 0.086),
    ),
)

# Distance of the stress peak from where the fillet meets the shaft, of the fillet's radius;
# measured in bending.
PEAK_OFFSET = 0.3
# Largest bore, of d, for which the fits for solid shafts are used: it reduces I by 0.4 %.
MAX_BORE_RATIO = 0.25


def shoulder_factor(
    fits: tuple[Fit, ...], thick: float, thin: float, radius: float
) -> float | None:
    """The factor Kt (no unit) of a fillet between two diameters; None outside the range of the
    fits.

    thick, thin, radius: the diameters and the radius of the fillet, m.

    Source: as the module.
    """
    h = (thick - thin) / 2.0
    if radius <= 0.0 or h <= 0.0:
        return None
    ratio, depth = h / radius, 2.0 * h / thick
    for (low, high), *fit in fits:
        if low * (1.0 - 1e-9) <= ratio <= high * (1.0 + 1e-9):
            terms = (a + b * math.sqrt(ratio) + c * ratio for a, b, c in fit)
            return sum(term * depth**k for k, term in enumerate(terms))
    return None


@dataclass(frozen=True)
class Notch:
    """A shoulder, a step of the bore or a cone, and its factors of the nominal stress of the
    thinner shaft.

    z: m, of its stress peak.
    on: number of the segment that is the thinner shaft.
    bending, tension, torsion: the factors; None where the beam has none.
    why: what the notch is, as text.
    """

    z: float
    on: int
    bending: float | None
    tension: float | None
    torsion: float | None
    why: str = ""


def notches(pin: Pin) -> tuple[Notch, ...]:
    """All steps of the outer diameter and of the bore, and all cones."""
    out = []
    for i, (left, right) in enumerate(zip(pin.segments, pin.segments[1:], strict=False)):
        on = i if left.walls[1] < right.walls[0] else i + 1
        if left.bores[1] != right.bore:
            why = f"a step of the bore between segments {i + 1} and {i + 2}"
            out.append(Notch(pin.stations[i + 1], on, None, None, None, why))
        if left.diameters[1] != right.diameter:
            out.append(_shoulder(pin, i))
    for i, s in enumerate(pin.segments):
        if s.walls[0] != s.walls[1]:
            middle = pin.stations[i] + s.length / 2.0
            out.append(Notch(middle, i, None, None, None, f"a cone in segment {i + 1}"))
    return tuple(out)


def _shoulder(pin: Pin, i: int) -> Notch:
    """The notch between segments i and i + 1."""
    left, right = pin.segments[i], pin.segments[i + 1]
    on = i if left.diameters[1] < right.diameter else i + 1
    thin, thick = sorted((left.diameters[1], right.diameter))
    rho, where = pin.fillet_at(i), f"between segments {i + 1} and {i + 2}"
    away = (1.0 - PEAK_OFFSET) * rho
    z = pin.stations[i + 1] + (away if on == i + 1 else -away)
    if rho == 0.0:
        return Notch(z, on, None, None, None, f"a sharp inner corner {where}")
    if max(left.bores[1], right.bore) > MAX_BORE_RATIO * thin:
        return Notch(z, on, None, None, None, f"the fillet of a tube {where}")
    bending, tension, torsion = (
        shoulder_factor(fits, thick, thin, rho) for fits in (BENDING_FIT, TENSION_FIT, TORSION_FIT)
    )
    why = f"a fillet {where} with h/r = {(thick - thin) / 2.0 / rho:.3g}"
    return Notch(z, on, bending, tension, torsion, why)

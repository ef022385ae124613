"""The peak of contact pressure at a rounded edge of a lug, from the pressure beside it.

Contact reaches only a few hundredths of the radius into the rounding. Rings that resolve its peak
would take a hundred times the work of all others. From some distance the edge looks sharp, and the
pressure rises towards the face of the lug as

    p = K x^-s (1 + b (r / x)^(2 - 2 s)) + A x^q,

where x is the distance from the face, s the exponent of a sharp edge and q the power of the next
term (fea.singular.lug_edge). The term with b is the remaining effect of the radius r at a distance;
it grows towards the edge like the field that is conjugate to the first. K and A follow from the
forces between the face and the ends of rings, which do not depend on how the peak is resolved. They
are fitted by least squares, with forces accurate to RING_FORCE_ERROR, and with A unlikely to change
the pressure at one diameter from the edge by more than REGULAR_TERM_RATIO times the first term.

Close to the edge both bodies are half-planes, of which one is flat and then rounded by a radius r.
With y from the end of contact, and d the length of contact in the rounding, the pressure is

    p(y) = E* / (2 pi r) (2 sqrt(d y) + (y - d) ln |(sqrt d - sqrt y) / (sqrt d + sqrt y)|),

at most 0.3818 E* d / r, and (2 E* d^1.5 / (3 pi r)) / sqrt(y) far away. Between the two regions r
is the only length, so that the peak is

    p = C (E* K^2 r^(-2 s))^(1/3),    1 / E* = (1 - nu^2) / E of the pin + that of the lug,

where C depends on the exponent alone. For a rigid lug, s = 1/2, C is exactly 1.073 and b is 1/2
(its edge is not a wedge, and is where rounding begins). For other exponents they were measured by
resolved rings, which agree to 1 % with finite elements of a lug whose edge is rounded (python -m
benchmarks edge-peak).

Sources: D. Dini & D. A. Hills, J. Appl. Mech. 71 (2004) for the half-planes; von Mises stress below
the surface by integrating Flamant's solution.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.core.places import ContactEdge
from fea.singular.lug_edge import lug_edge_exponent, next_power
from fea.support.contact.joint_contact import JointContact
from fea.support.lugs.lug import Lug

End = Literal["start", "end"]

EDGE_EXPONENTS = 0.11, 0.226, 0.5  # aluminium on steel, like on like, rigid
PRESSURE_COEFFICIENTS = 0.925, 0.965, 1.073
REACH_COEFFICIENTS = 0.42, 0.45, 0.5
EDGE_PEAK_ERROR = 0.1  # relative to resolved peaks (6 % on usual cells)
RING_FORCE_ERROR, REGULAR_TERM_RATIO = 0.03, 0.5
STATION_ROUND_OFF = 1e-9
# Distance from the face, in edge radii, from which on forces are compared with the expansion.
MIN_FIT_DISTANCE = 2.0
# Largest von Mises stress below the surface over the largest pressure, by Poisson's ratio.
POISSON_RATIOS = 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5
SUBSURFACE_STRESS_RATIOS = 0.5730, 0.5399, 0.5157, 0.4979, 0.4858, 0.4787, 0.4763


@dataclass(frozen=True)
class EdgePeak:
    """The peak of contact at a rounded edge.

    pressure: largest pressure, Pa.
    von_mises: largest von Mises stress in the pin below it, by contact alone, Pa.
    reach: length of contact in the rounding, m.
    """

    pressure: float
    von_mises: float
    reach: float


def contact_edges(contact: JointContact, material: Material) -> tuple[ContactEdge, ...]:
    """The edges of contact at a single instant: the edges of each band that carry load.

    material: of the pin.
    """
    out = []
    for b, lug in enumerate(contact.lugs):
        on_band = contact.bands.band == b
        pressure, length = contact.contact[0].pressure[on_band], contact.bands.length[on_band]
        exponent = lug_edge_exponent(material, lug.bearing)
        powers = exponent, next_power(material, lug.bearing)
        diameter = 2.0 * float(contact.bands.radius[on_band][0])
        ends: tuple[tuple[End, slice], ...] = ("start", slice(None)), ("end", slice(None, None, -1))
        for end, way in ends:
            rings = pressure[way], length[way]
            K = strength_at_edge(*rings, lug.edge_radius, powers, diameter)
            if K > 0.0:
                out.append(_edge(lug, end, K, exponent, material))
    return tuple(out)


def _edge(lug: Lug, end: End, K: float, exponent: float, material: Material) -> ContactEdge:
    peak = edge_peak(K, exponent, lug, material) if lug.edge_radius else None
    strength = material.yield_strength
    edge = ContactEdge(
        lug.connection, end, K, exponent,
        (K / strength) ** (1.0 / exponent) if strength and exponent else None, None, None, None,
    )  # fmt: skip
    if peak is None:
        return edge
    return replace(
        edge, max_pressure=peak.pressure, max_von_mises=peak.von_mises,
        error_estimate=EDGE_PEAK_ERROR * peak.pressure,
    )  # fmt: skip


def strength_at_edge(
    pressure: Floats, length: Floats, radius: float, powers: tuple[float, float], diameter: float
) -> float:
    """The intensity K of a sharp edge, Pa m^s, the largest around the pin.

    pressure: on the cells of the rings, in order from the face of the lug, (R, M) Pa.
    length: of these rings, (R,) m.
    radius: of the rounded edge, m.
    powers: exponent s and power q.
    diameter: of the pin, m.
    """
    stations = np.concatenate([[0.0], np.cumsum(length)])
    half, least = 0.5 * stations[-1] * (1.0 + STATION_ROUND_OFF), radius * (1.0 + STATION_ROUND_OFF)
    inside = np.flatnonzero((stations > least) & (stations <= half))
    far = inside[stations[inside] >= MIN_FIT_DISTANCE * radius * (1.0 - STATION_ROUND_OFF)]
    at = far if len(far) > 1 else inside[-2:]  # where rounding leaves little of the band flat
    if not len(at):
        return 0.0
    x, (s, q) = stations[at], powers
    b = float(np.interp(s, EDGE_EXPONENTS, REACH_COEFFICIENTS))
    # The forces from the face to x, divided by x^(1 - s) / (1 - s), for a unit of K and a unit of
    # A diameter^(s + q).
    of_k = 1.0 - b * (radius / x) ** (2.0 - 2.0 * s)
    of_a = (1.0 - s) / (1.0 + q) * (x / diameter) ** (s + q)
    terms = np.stack([of_k, of_a], axis=1)
    likely = np.diag([0.0, (RING_FORCE_ERROR / REGULAR_TERM_RATIO) ** 2])
    weights = np.linalg.solve(terms.T @ terms + likely, terms.T)[0]
    force = np.cumsum(pressure.T * length, axis=1)[:, at - 1]
    return max(0.0, float((force * (1.0 - s) * x ** (s - 1.0) @ weights).max()))


def edge_peak(K: float, exponent: float, lug: Lug, material: Material) -> EdgePeak:
    """The peak at a rounded edge.

    K: intensity of the sharp edge, Pa m^s. exponent: s. material: of the pin.
    """
    r, soft = lug.edge_radius, material.plane_compliance + lug.bearing.plane_compliance
    pressure = float(np.interp(exponent, EDGE_EXPONENTS, PRESSURE_COEFFICIENTS)) * (
        K * K * r ** (-2.0 * exponent) / soft
    ) ** (1.0 / 3.0)
    nu = material.poisson_ratio
    part = max(float(np.interp(nu, POISSON_RATIOS, SUBSURFACE_STRESS_RATIOS)), 1.0 - 2.0 * nu)
    return EdgePeak(pressure, part * pressure, pressure * soft * r / 0.3818)

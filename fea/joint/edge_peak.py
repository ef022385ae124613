"""Peak of contact at a rounded edge of a lug, from the pressure beside it.

Contact reaches only a few hundredths of the radius into the rounding, so that rings which resolve
its peak would take a hundred times the work of all others. Seen from afar the edge is sharp, and
pressure rises as K d^-s towards the face of the lug (fea.singular.lug_edge); K follows from the
force on the rings next to it, which does not depend on how its peak is resolved. Close by, both
bodies are half-planes, one flat and then rounded by a radius r: pressure there is (y from the end
of contact, d the length of contact in the rounding)

    p(y) = E* / (2 pi r) (2 sqrt(d y) + (y - d) ln |(sqrt d - sqrt y) / (sqrt d + sqrt y)|),

0.3818 E* d / r at most and (2 E* d^1.5 / (3 pi r)) / sqrt(y) far away. In between only one size is
left, r, so that the peak is

    p = C (E* K^2 r^(-2 s))^(1/3),    1 / E* = (1 - nu^2) / E of pin and of lug,

with a number C of the exponent alone: 1.07 exactly for a rigid lug, s = 1/2, whose edge is no
wedge; of others measured by resolved rings (python -m benchmarks edge-peak).

Sources: D. Dini & D. A. Hills, J. Appl. Mech. 71 (2004) for the half-planes; von Mises below by
integrating Flamant's solution.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.core.places import ContactEdge
from fea.joint.lugs.lug import Lug
from fea.joint.solve_joint import JointContact
from fea.singular.lug_edge import lug_edge_exponent

End = Literal["start", "end"]

EXPONENTS = 0.11, 0.226, 0.5  # aluminium on steel, like on like, rigid
C = 0.99, 1.07, 1.073
WITHIN = 0.15  # relative, of resolved peaks
BESIDE = 4.0  # edge radii from the face: to there at least pressure is summed
# Largest von Mises stress below the surface over the largest pressure, by Poisson's ratio.
POISSON = 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5
BELOW = 0.5730, 0.5399, 0.5157, 0.4979, 0.4858, 0.4787, 0.4763


@dataclass(frozen=True)
class EdgePeak:
    """At a rounded edge. pressure: the largest, Pa; von_mises: of the pin under it, Pa, by contact
    alone; reach: length of contact in the rounding, m.
    """

    pressure: float
    von_mises: float
    reach: float


def contact_edges(contact: JointContact, material: Material) -> tuple[ContactEdge, ...]:
    """Of contact at a single instant, both edges of each band that carries anything there.
    material: the pin's.
    """
    out = []
    for b, lug in enumerate(contact.lugs):
        own = contact.bands.band == b
        pressure, length = contact.contact[0].pressure[own], contact.bands.length[own]
        exponent = lug_edge_exponent(material, lug.bearing)
        ends: tuple[tuple[End, slice], ...] = ("start", slice(None)), ("end", slice(None, None, -1))
        for end, way in ends:
            K = strength_at_edge(pressure[way], length[way], lug.edge_radius, exponent)
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
        error_estimate=WITHIN * peak.pressure,
    )  # fmt: skip


def strength_at_edge(pressure: Floats, length: Floats, radius: float, exponent: float) -> float:
    """K, Pa m^s, where it is largest round the pin, of rings (R, M) from a face on."""
    stations = np.concatenate([[0.0], np.cumsum(length)])
    flat = int(np.searchsorted(stations, radius * (1.0 - 1e-9)))  # where the first flat ring begins
    first = stations[min(flat + 1, len(stations) - 1)]
    far = min(max(BESIDE * radius, first), stations[-1] / 2.0)
    force = np.concatenate([np.zeros((1, pressure.shape[1])), np.cumsum(pressure.T * length, 1).T])
    carried = max(float(np.interp(far, stations, column)) for column in force.T)
    return float((1.0 - exponent) * carried * far ** (exponent - 1.0))


def edge_peak(K: float, exponent: float, lug: Lug, material: Material) -> EdgePeak:
    """Of a rounded edge."""
    r, soft = lug.edge_radius, material.plane_compliance + lug.bearing.plane_compliance
    pressure = float(np.interp(exponent, EXPONENTS, C)) * (
        K * K * r ** (-2.0 * exponent) / soft
    ) ** (1.0 / 3.0)
    nu = material.poisson_ratio
    part = max(float(np.interp(nu, POISSON, BELOW)), 1.0 - 2.0 * nu)
    return EdgePeak(pressure, part * pressure, pressure * soft * r / 0.3818)

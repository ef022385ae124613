"""The surface and the sections of a pin in its lugs by CalculiX's own fields and forces."""

from __future__ import annotations

import numpy as np

from assess.opinion.calculix_joint_answer import JointOpinion
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.section.section_stress import AtSection, SectionField
from geometry import Pin
from geometry.shape.rings import ring, ringed
from pinbase.arrays import Floats, Ints, Mask

MIN_PRESSURE_SHARE = 0.02  # relative to the largest pressure: a smaller one is no contact
HEXAHEDRON_FACES = np.array(
    [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
)
RELATIVE_LENGTH_TOLERANCE = 1e-9


def section_of(opinion: JointOpinion, pin: Pin, material: Material) -> AtSection:
    """Return the largest stress of the pin's sections by the forces of CalculiX's rings."""
    loads = ring_loads(opinion, pin)
    return SectionField(on_rings(opinion, pin), material, (), [loads]).place(loads)


def free(opinion: JointOpinion) -> Mask:
    """Return a mask (N,) of the corner nodes on the pin's surface that belong to no element with a
    pressed node.
    """
    x, corners = opinion.nodes, opinion.elements[:, :8]
    faces = corners[:, HEXAHEDRON_FACES].reshape(-1, 4)
    unique_faces, count = np.unique(np.sort(faces, axis=1), axis=0, return_counts=True)
    outer = unique_faces[count == 1]
    if opinion.half:  # without the plane of symmetry
        outer = outer[np.abs(x[outer, 1]).max(axis=1) > RELATIVE_LENGTH_TOLERANCE * np.abs(x).max()]
    surface = np.zeros(len(x), dtype=bool)
    surface[outer] = True
    touched = pressed(opinion)[opinion.elements].any(axis=1)
    surface[corners[touched]] = False
    return surface


def pressed(opinion: JointOpinion) -> Mask:
    """Return a mask (N,) of the pressed nodes: nodes on a ring whose pressure -s_rr exceeds
    MIN_PRESSURE_SHARE of the largest pressure on any ring.
    """
    x = opinion.nodes
    r, z = np.hypot(x[:, 0], x[:, 1]), x[:, 2]
    near = RELATIVE_LENGTH_TOLERANCE * float(np.ptp(z))
    on = ((z[:, None] > opinion.ends[:, 0] - near) & (z[:, None] < opinion.ends[:, 1] + near)).any(
        1
    )
    layer = np.rint(z / near).astype(np.int64)
    _, number = np.unique(layer, return_inverse=True)
    largest = np.zeros(number.max() + 1)
    np.maximum.at(largest, number, r)
    on &= r > (1.0 - 1e-6) * largest[number]
    out = x[:, :2] / np.maximum(r, near)[:, None]
    plane = opinion.stress[:, [[0, 5], [5, 1]]]
    across = np.where(on, np.einsum("ni,nij,nj->n", out, plane, out), 0.0)
    return np.asarray(across < MIN_PRESSURE_SHARE * across.min())


def on_rings(opinion: JointOpinion, pin: Pin) -> Pin:
    """Return the pin with its bands cut into CalculiX's rings."""
    return ringed(pin, {name: ends for name, _, ends in _by_band(opinion, pin)})


def ring_loads(opinion: JointOpinion, pin: Pin) -> PinLoads:
    """Return the forces of the lugs on the rings, and their couples about the middles of the
    rings.
    """
    names = [
        ring(name, k)
        for name, band_rows, _ in _by_band(opinion, pin)
        for k in range(len(band_rows))
    ]
    rows = np.concatenate([band_rows for _, band_rows, _ in _by_band(opinion, pin)])
    force, middle = opinion.force[rows], opinion.ends[rows].mean(axis=1)[:, None]
    x, y = (opinion.first[rows] - middle * force).T
    about = np.stack([-y, x, 0.0 * x], axis=1)
    return PinLoads("CalculiX", tuple(names), np.pad(force, ((0, 0), (0, 1)))[None], about[None])


def _by_band(opinion: JointOpinion, pin: Pin) -> list[tuple[str, Ints, Floats]]:
    """Return for each band its name, the rows of its rings in the order of z, and the ends of the
    rings along the band, m.
    """
    out, tiny = [], RELATIVE_LENGTH_TOLERANCE * pin.length
    for name in pin.connections:
        band = pin.band(name)
        within = (opinion.ends[:, 0] > band.z0 - tiny) & (opinion.ends[:, 1] < band.z1 + tiny)
        rows = np.flatnonzero(within)
        rows = rows[np.argsort(opinion.ends[rows, 0])]
        ends = np.append(opinion.ends[rows, 0], opinion.ends[rows[-1], 1]) - band.z0
        ends[[0, -1]] = 0.0, band.length
        out.append((name, rows, ends))
    return out

"""Case crushing: the stress in the core of a hardened pin, by the pressure of lugs alone.

The case passes the pressure on to the core. Under a narrow contact the largest stress in the core
is not at the boundary with the case but as deep as under a line contact: von Mises 0.56 p0 at 0.70
of the half width for nu = 0.3. At depths that are small compared with the radius, a ring of
pressure acts as on a half-plane in plane strain, whose stresses under a strip of uniform pressure
are known in closed form. The pressure of the cells, linear between their middles, is made of strips
that are narrow compared with the depth. Bending and shear of the pin, which sections include, are
left out. The edges of lugs are left out, too: the outermost pressed rings do not count, as
elsewhere.

Source: K. L. Johnson, Contact Mechanics (1985), 2.5 (a) for the strip, 4.2 for the line contact.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from fea.core.hardened import Hardened
from fea.core.places import CaseCrushing
from fea.support.contact.joint_contact import JointContact
from pinbase.arrays import Floats, Ints

STRIPS_PER_DEPTH = 4.0  # strips in a length equal to the case depth
MAX_STRIPS = 4096  # around the pin
DEPTH_STEP = 1.1  # ratio of successive depths
MAX_DEPTH = 0.5  # of the radius: deeper, the pin does not act as a half-plane


def case_crushing(
    contacts: Iterable[JointContact], hardened: tuple[Hardened, ...], nu: float
) -> CaseCrushing | None:
    """The case crushing with the largest ratio of stress to core strength; None where no pressed
    ring is on a hardened stretch.

    contacts: each at one instant.
    nu: Poisson's ratio.
    """
    crushed = [
        crushing
        for contact in contacts
        for ring in _rings(contact)
        for case in hardened
        if case.start <= contact.bands.z[ring] <= case.end
        for crushing in [_of_ring(contact, ring, case, nu)]
    ]
    return max(crushed, key=lambda x: x.max_von_mises / x.strength, default=None)


def _rings(contact: JointContact) -> Ints:
    """The numbers of the pressed rings away from the edges of lugs; of all pressed rings if none is
    away from edges.
    """
    (state,) = contact.contact
    pressed = (state.pressure > 0.0).any(axis=1)
    arcs = contact.loads.pressed
    inner = pressed
    if arcs is not None:
        inner = pressed & ~(arcs.at_edges(0) & arcs.on[0]).any(axis=1)
    return np.flatnonzero(inner if inner.any() else pressed)


def _of_ring(contact: JointContact, ring: int, case: Hardened, nu: float) -> CaseCrushing:
    radius, (state,) = float(contact.bands.radius[ring]), contact.contact
    pressure, depth = state.pressure[ring], case.depth
    strips = min(MAX_STRIPS, math.ceil(2.0 * math.pi * radius * STRIPS_PER_DEPTH / depth))
    cells = len(pressure)
    fine = np.interp(
        np.arange(strips) * (cells / strips), np.arange(cells + 1), [*pressure, pressure[0]]
    )
    count = max(1, math.ceil(math.log(MAX_DEPTH * radius / depth) / math.log(DEPTH_STEP)))
    depths = depth * DEPTH_STEP ** np.arange(count, dtype=np.float64)
    stress = beneath_strips(fine, 2.0 * math.pi * radius / strips, depths, nu)
    k = int(stress.argmax())
    return CaseCrushing(
        contact.lugs[int(contact.bands.band[ring])].connection, float(contact.bands.z[ring]),
        float(stress[k]), float(depths[k]), float(pressure.max()), case.core,
    )  # fmt: skip


def beneath_strips(pressure: Floats, width: float, depths: Floats, nu: float) -> Floats:
    """The largest von Mises stress (D,), Pa, at depths (D,), m, beneath strips of uniform pressure.

    pressure: on adjacent strips around the pin, (N,) Pa; the first strip follows the last.
    width: of each strip, m.
    """
    count = len(pressure)
    away = (np.arange(count) + count // 2) % count - count // 2
    waves, out = np.fft.rfft(pressure), np.empty(len(depths))
    for k, depth in enumerate(depths):
        # Angles from the ends of a strip to the point beneath, for Johnson's eq. (2.31).
        first, second = (np.arctan2(depth, width * (away + end)) for end in (-0.5, 0.5))
        angle, sine = 2.0 * (first - second), np.sin(2.0 * first) - np.sin(2.0 * second)
        cosine = np.cos(2.0 * first) - np.cos(2.0 * second)
        kernels = -(angle + sine), -(angle - sine), cosine
        along, down, shear = (
            np.fft.irfft(np.fft.rfft(x / (2.0 * math.pi)) * waves, count) for x in kernels
        )
        across = nu * (along + down)
        square = (along - down) ** 2 + (down - across) ** 2 + (across - along) ** 2
        out[k] = math.sqrt(float((0.5 * square + 3.0 * shear**2).max()))
    return out


def pressed_most(forces: Floats) -> Ints:
    """The instants at which some lug has its largest force. forces: of the lugs, (T, L, 2) N."""
    return np.unique(np.linalg.norm(forces, axis=2).argmax(axis=0))

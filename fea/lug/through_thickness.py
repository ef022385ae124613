"""The stress of a lug's bore that is due to uneven pressure through the thickness of the lug.

A pin that bends presses on the edges of its lugs. Even under an even pressure, a thick eye is
stressed more in its middle than at its faces. The eye as a body of revolution, whose rings'
flexibilities serve contact, has both effects, in three dimensions. The part that a plane eye has,
too, is subtracted, since the plane lug with its shank covers it.

With u the displacements under a unit pressure of harmonic n on one ring, and p that pressure,

    hoop + p = E / (1 - nu^2) (e_tt + nu e_zz) - nu / (1 - nu) p + p,

each averaged over a ring.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.harmonic.model import polar
from fea.support.contact.flexibility import RingBody
from fea.support.lugs.lug import Lug
from pinbase.arrays import Floats

Edges = np.ndarray[tuple[int, int], np.dtype[np.int64]]  # nodes at the ends, then in the middle


@dataclass(frozen=True)
class EyeStress:
    """The stress of each ring (rows) under unit pressures on rings, (N + 1, R, R), for each
    harmonic.

    bore: hoop stress plus pressure, of the wall on which the pin bears.
    hole: hoop stress of a lug at the hole about its bushing, from the circumferential strain alone;
    None without a bushing.
    """

    bore: Floats
    hole: Floats | None = None

    def added(self, waves: Floats, length: Floats, hole: bool = False) -> Floats:
        """The addition (N + 1, T, R, 2), Pa, to the stress of a plane eye under the mean pressure,
        for each phase.

        Under an even pressure its mean through the thickness is zero.
        waves: (N + 1, T, R, 2) Pa, harmonics of the pressures.
        length: (R,) m, of the rings.
        hole: whether at the hole about a bushing.
        """
        stress = self.hole if hole else self.bore
        assert stress is not None
        n = min(len(waves), len(stress))
        share = length / length.sum()
        even = np.einsum("ntrp,r->ntp", waves[:n], share)
        plane = np.einsum("nrs,r->n", stress[:n], share)[:, None, None] * even
        return np.asarray(np.einsum("nrs,ntsp->ntrp", stress[:n], waves[:n]) - plane[:, :, None])


def eye_stress(eye: RingBody, lug: Lug, highest: int) -> EyeStress:
    """The stress of an eye's bore, and of its hole about a bushing, under unit pressures on its
    rings.

    eye: the eye as a body of revolution.
    highest: highest harmonic.

    Raises: SolveError.
    """
    E, nu = lug.bearing.youngs_modulus, lug.bearing.poisson_ratio
    edges = [eye.body.space.section.edges[name] for name in eye.rings]
    at = eye.body.space.nodes
    radius = float(at[edges[0][0, 0], 0])
    outside = None if lug.bushing is None else radius + lug.bushing.thickness
    bore, hole = list[Floats](), list[Floats]()
    for n in range(highest + 1):
        u = polar(eye.body.displace(n, eye.balanced(n, eye.forces(n))))
        stretch = u[:, 0] + n * u[:, 1]
        around = np.stack([_mean(e, at, stretch) for e in edges]) / radius
        along = np.stack([_stretch(e, at, u[:, 2]) for e in edges])
        pressed = np.eye(len(edges)) * (1.0 - nu / (1.0 - nu))
        bore.append(E / (1.0 - nu * nu) * (around + nu * along) + pressed)
        if outside is not None:
            across = [_mean_between(at, e, outside, stretch) for e in edges]
            hole.append(lug.material.youngs_modulus * np.stack(across) / outside)
    return EyeStress(np.stack(bore), np.stack(hole) if hole else None)


def _mean_between(at: Floats, edges: Edges, radius: float, u: Floats) -> Floats:
    """The mean (K,) along the axis of values (N, K) at the nodes of a radius, between the ends of a
    ring.
    """
    low, high = at[np.unique(edges), 1].min(), at[np.unique(edges), 1].max()
    tiny = 1e-6 * radius
    here = np.flatnonzero(
        (np.abs(at[:, 0] - radius) < tiny) & (at[:, 1] > low - tiny) & (at[:, 1] < high + tiny)
    )
    here = here[np.argsort(at[here, 1])]
    return np.asarray(np.trapezoid(u[here], at[here, 1], axis=0) / (high - low))


def _mean(edges: Edges, at: Floats, u: Floats) -> Floats:
    """The mean (K,) over a ring of values (N, K) at nodes, by Simpson's rule on its edges."""
    first, last, middle = edges.T
    length = np.abs(at[last, 1] - at[first, 1])[:, None]
    total = (length * (u[first] + 4.0 * u[middle] + u[last])).sum(axis=0)
    return np.asarray(total / (6.0 * length.sum()))


def _stretch(edges: Edges, at: Floats, u: Floats) -> Floats:
    """The mean strain (K,) of a ring along the axis, from displacements (N, K)."""
    nodes = np.unique(edges)
    low, high = nodes[at[nodes, 1].argmin()], nodes[at[nodes, 1].argmax()]
    return np.asarray((u[high] - u[low]) / (at[high, 1] - at[low, 1]))

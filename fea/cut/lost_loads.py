"""What a load would do where a band is cut away goes to the rest of the band nearby.

A link's force is that of the study, however its band is cut. The pressure on the rest of the band
stays as it is, and what acted on what is cut away is replaced by small tractions on the band about
the cut with the same force and couple: for a load that shears its band of constant direction and
growing along z, otherwise normal to it, as cos theta. By Saint-Venant's principle another choice
changes stress about the cut alone, by the order of the part of the force that is lost.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.solid.assembly import Discretisation
from fea.solid.boundary import SurfaceMesh, area_vectors, quadrature, slopes_at
from geometry.mesh.cut_piece import Piece
from pinbase.arrays import Floats, Mask

MIN_RADIAL_COSINE = 0.5  # least cosine between a band's normal and the radius
ON_BAND_TOLERANCE = 1e-9  # of a band's length


@dataclass(frozen=True)
class Bearing:
    """A loaded band with cuts in it, between two z (m, in the frame of the piece; on both sides of
    its mirror plane, if it has one across the axis). cuts: by name.
    """

    z0: float
    z1: float
    cuts: tuple[str, ...]

    def on(self, x: Floats, normal: Floats) -> Mask:
        """Which points (..., 3) with outward normals are on it."""
        near = ON_BAND_TOLERANCE * (self.z1 - self.z0)
        between = (x[..., 2] >= self.z0 - near) & (x[..., 2] <= self.z1 + near)
        radial = np.sum(x[..., :2] * normal[..., :2], axis=-1)
        return np.asarray(between & (radial > MIN_RADIAL_COSINE * np.hypot(x[..., 0], x[..., 1])))


def bearings(piece: Piece, bands: Sequence[tuple[float, float]]) -> tuple[Bearing, ...]:
    """Of the loaded bands (z0, z1) of the pin, m, those in which a piece has cuts. All that is lost
    in a piece is lost on its band where it has one only, also where its cuts meet.
    """
    out = []
    for low, high in bands:
        z0, z1 = low - piece.origin, high - piece.origin
        if "z" in piece.mirrors:
            z1 = min(z1, -z0)
            z0 = -z1
        opens = {name: cut.opens for name, cut in piece.cuts.items()}
        names = tuple(name for name, (start, end) in opens.items() if z0 < start and end < z1)
        if names:
            out.append(Bearing(z0, z1, names))
    return tuple(out) if len(out) != 1 else (replace(out[0], cuts=tuple(piece.cuts)),)


def trials(x: Floats, normal: Floats, shears: bool) -> Floats:
    """Tractions (..., 3, 6) at points (..., 3) of a band, each with the resultant of a force along
    an axis or a couple about it.
    """
    out = np.zeros((*x.shape, 6))
    z = x[..., 2, None]
    if shears:
        out[..., 0, 0] = out[..., 1, 1] = 1.0
    else:
        out[..., 0], out[..., 1] = (normal * normal[..., a, None] for a in (0, 1))
    out[..., 2, 2] = 1.0
    out[..., 3], out[..., 4] = -z * out[..., 1], z * out[..., 0]
    r = np.hypot(x[..., 0], x[..., 1])
    out[..., 0, 5], out[..., 1, 5] = -x[..., 1] / r, x[..., 0] / r
    return out


def trial_forces(
    space: Discretisation, surface: SurfaceMesh, bearing: Bearing, shears: bool
) -> Floats:
    """Nodal forces (3 N, 6) of these on a band."""
    (a, b), weight = quadrature()
    shapes, _ = slopes_at(a, b)
    out = np.zeros((len(space.nodes), 3, 6))
    area = area_vectors(space.nodes[surface.corners], a, b)
    area *= np.sign(np.sum(area * surface.normals.mean(axis=1)[:, None], axis=2))[..., None]
    size = np.linalg.norm(area, axis=2)
    x = np.einsum("qi,fia->fqa", shapes, space.nodes[surface.corners])
    normal = area / size[..., None]
    on = bearing.on(x, normal)
    rows = np.flatnonzero(on.any(axis=1))
    t = trials(x[rows], normal[rows], shears) * (size * on)[rows][..., None, None]
    np.add.at(out, surface.corners[rows], np.einsum("q,qi,fqak->fiak", weight, shapes, t))
    return out.reshape(-1, 6)

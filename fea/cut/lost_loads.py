"""Loads on the removed area of a band, which the rest of the band nearby carries instead.

The force of a link is that of the study, however its band is cut. The pressure on the rest of the
band stays as it is. The tractions on the removed area are replaced by small ones on the band about
the cut, with the same force and couple. If the load shears its band, these have constant direction
(for couples, growing along z); otherwise they are normal to the band and vary as cos theta. By
Saint-Venant's principle another choice would change the stress about the cut alone, by the order of
the lost part of the force.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.cut.piece_faces import PieceFaces
from fea.solid.boundary import area_vectors, quadrature, slopes_at
from geometry.mesh.cut_piece import Piece
from pinbase.arrays import Floats, Mask

MIN_RADIAL_COSINE = 0.5  # least cosine between a band's normal and the radius
ON_BAND_TOLERANCE = 1e-9  # of a band's length


@dataclass(frozen=True)
class Bearing:
    """A loaded band that has cuts.

    z0, z1: m, its ends in the frame of the piece, on both sides of the piece's mirror plane across
    the axis, if there is one.
    cuts: their names.
    """

    z0: float
    z1: float
    cuts: tuple[str, ...]

    def on(self, x: Floats, normal: Floats) -> Mask:
        """A mask (...) of points (..., 3) with outward normals (..., 3) that are on the band."""
        near = ON_BAND_TOLERANCE * (self.z1 - self.z0)
        between = (x[..., 2] >= self.z0 - near) & (x[..., 2] <= self.z1 + near)
        radial = np.sum(x[..., :2] * normal[..., :2], axis=-1)
        return np.asarray(between & (radial > MIN_RADIAL_COSINE * np.hypot(x[..., 0], x[..., 1])))


def bearings(piece: Piece, bands: Sequence[tuple[float, float]]) -> tuple[Bearing, ...]:
    """The loaded bands of the pin, from their ends in m, in which a piece has cuts.

    If there is only one, it carries all that is lost in the piece, also where its cuts meet.
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
    """Six tractions (..., 3, 6) on a band, which together can have any resultant force and couple.

    They are for forces along x, y and z and couples about x, y and z, with arbitrary amplitudes.
    x, normal: (..., 3) points and outward normals.
    shears: whether transverse tractions have constant direction, instead of that of the normal.
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


def trial_forces(faces: PieceFaces, bearing: Bearing, shears: bool) -> Floats:
    """The nodal forces (3 N, 6) of the tractions of `trials` on what is left of a band."""
    (a, b), weight = quadrature()
    shapes, _ = slopes_at(a, b)
    nodes, surface = faces.space.nodes, faces.surface
    # The floors of flats and slots face outwards, too.
    left = np.concatenate([r.face.rows for r in faces.readings if not r.face.cut])
    corners, outward = surface.corners[left], surface.normals[left].mean(axis=1)
    out = np.zeros((len(nodes), 3, 6))
    area = area_vectors(nodes[corners], a, b)
    area *= np.sign(np.sum(area * outward[:, None], axis=2))[..., None]
    size = np.linalg.norm(area, axis=2)
    x = np.einsum("qi,fia->fqa", shapes, nodes[corners])
    normal = area / size[..., None]
    on = bearing.on(x, normal)
    rows = np.flatnonzero(on.any(axis=1))
    t = trials(x[rows], normal[rows], shears) * (size * on)[rows][..., None, None]
    np.add.at(out, corners[rows], np.einsum("q,qi,fqak->fiak", weight, shapes, t))
    return out.reshape(-1, 6)

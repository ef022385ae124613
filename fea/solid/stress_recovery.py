"""The stress at the nodes of a solid from a displacement field.

Values at the quadrature points are extrapolated linearly to the nodes of each element and averaged
there. On the surface the traction is known, and the stress is corrected to match it exactly.
"""

from __future__ import annotations

import numpy as np

from fea.core.local_fit import nodal_extrapolation
from fea.core.material import Material
from fea.core.voigt import TENSOR_TO_VOIGT, VOIGT_TO_TENSOR
from fea.solid.assembly import Discretisation
from fea.solid.boundary import MIN_SMOOTH_COSINE, SurfaceMesh
from pinbase.arrays import Floats, Mask


def nodal_stress(space: Discretisation, material: Material, displacement: Floats) -> Floats:
    """The stress (N, 6, L), Pa, at the nodes, of L displacement fields (N, 3, L), m."""
    to_nodes = nodal_extrapolation(space.elements, space.basis.X, space.basis.elem.doflocs.T)
    fields = []
    for k in range(displacement.shape[2]):
        stress = material.stress(space.strain(displacement[:, :, k]))
        fields.append(to_nodes @ stress.reshape(-1, 6))
    return np.stack(fields, axis=2)


def with_known_traction(
    stress: Floats, surface: SurfaceMesh, traction: Floats, clamped: Mask
) -> Floats:
    """The stress (N, 6, L), Pa, corrected on the surface to match the given traction.

    Nodes on clamps and on edges of the body are not changed. Where two tractions meet on a smooth
    surface, their mean is taken.
    traction: (F, .., 3, L) Pa, at the nodes of the facets.
    clamped: (F,) the facets whose traction is unknown.
    """
    n_nodes = len(stress)
    node = surface.corners.ravel()
    count = np.bincount(node, minlength=n_nodes)
    on = np.maximum(count, 1)
    normal: Floats = np.stack(
        [np.bincount(node, surface.normals[..., a].ravel(), minlength=n_nodes) for a in range(3)], 1
    )
    length = np.linalg.norm(normal, axis=1)
    normal /= np.where(length > 0.0, length, 1.0)[:, None]
    sharp = np.sum(surface.normals * normal[surface.corners], axis=2) < MIN_SMOOTH_COSINE
    fixed = np.repeat(clamped[:, None], surface.corners.shape[1], axis=1)
    known = (count > 0) & (np.bincount(node, (sharp | fixed).ravel(), minlength=n_nodes) == 0)
    out = stress.copy()
    n = normal[known]
    for k in range(stress.shape[2]):
        t = np.stack(
            [
                np.bincount(node, traction[:, :, a, k].ravel(), minlength=n_nodes) / on
                for a in range(3)
            ],
            axis=1,
        )[known]
        s = stress[known, :, k][:, TENSOR_TO_VOIGT]
        # Add the symmetric tensor that changes the traction by r and nothing along the surface.
        r = t - np.einsum("nab,nb->na", s, n)
        normal_part = np.sum(r * n, axis=1)[:, None, None]
        rn = r[:, :, None] * n[:, None, :]
        s = s + rn + rn.swapaxes(1, 2) - normal_part * n[:, :, None] * n[:, None, :]
        out[known, :, k] = np.stack([s[:, a, b] for a, b in VOIGT_TO_TENSOR], axis=1)
    return out

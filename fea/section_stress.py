"""Stress and displacement on a section from the unknowns of one harmonic: its skin, its inside."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from fea.material import Material
from fea.outline import Outline, shapes
from fea.section import Floats, Ints, Section, elasticity
from fea.skin import AT, skin


def inner_nodes(space: Section, outline: Outline) -> Ints:
    """Nodes that are not on the outline, (I,)."""
    return np.setdiff1d(np.arange(len(space.nodes)), outline.nodes)


def section_stress(
    space: Section,
    outline: Outline,
    material: Material,
    n: int,
    u: Floats,
    traction: Floats,
    clamps: tuple[str, ...],
    at_extra: sp.csr_matrix,
) -> tuple[Floats, Floats]:
    """Displacement (S, 3, K) in m and stress (S, 6, K) in Pa, amplitudes, at the five points of
    each edge of the outline, then at the inner nodes, then where `at_extra` (P, N) takes values to,
    of displacements u (N, 3, K) of harmonic n.

    traction: (E, 3, 3, K) Pa at the nodes of the outline's edges. Inside, and where the traction is
    unknown because the surface is held, stresses are extended linearly from three points of each
    element to its nodes and averaged there.
    """
    K = u.shape[2]
    stress = elasticity(material) @ space.sampled_strains(n, u)  # (M, 3, 6, K)
    averaged = (space.extend @ stress.reshape(-1, 6 * K)).reshape(-1, 6, K)
    found = skin(space, outline, material, n, u, traction)
    rough = np.einsum("qi,eiak->eqak", shapes(AT), averaged[outline.nodes])
    keep = outline.held(clamps)[:, None] | (found.points[..., 0] < 1e-9 * space.nodes[:, 0].max())
    on_skin = np.where(keep[..., None, None], rough, found.stress)
    inner = inner_nodes(space, outline)
    return (
        np.concatenate([found.displacement.reshape(-1, 3, K), u[inner], _apply(at_extra, u)]),
        np.concatenate([on_skin.reshape(-1, 6, K), averaged[inner], _apply(at_extra, averaged)]),
    )


def _apply(matrix: sp.csr_matrix, values: Floats) -> Floats:
    flat = np.asarray(matrix @ values.reshape(len(values), -1))
    return flat.reshape(-1, *values.shape[1:])

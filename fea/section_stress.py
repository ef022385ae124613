"""Stress and displacement on a section from the unknowns of one harmonic: its skin, its inside."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from fea.jumps import DIRECTIONS, Jump, jumps
from fea.material import Material
from fea.outline import Outline, shapes
from fea.section import Floats, Ints, Section, elasticity
from fea.skin import AT, skin

NOWHERE = np.zeros((0, 2))


@dataclass(frozen=True)
class Beside:
    """Points (P, 2), r and z in m, where stress is read besides skin and inner nodes: some inside
    the section, then those of the jumps. displaced (P, N): takes values at nodes there; continued
    (I, 3 M): those at samples to the points inside.
    """

    points: Floats
    displaced: sp.csr_matrix
    continued: sp.csr_matrix
    jumps: tuple[Jump, ...]


def beside(
    space: Section,
    outline: Outline,
    material: Material,
    inside: Floats = NOWHERE,
    ends: Iterable[tuple[float, float]] = (),
) -> Beside:
    """inside: points (I, 2), m. ends: places on the outline where a pressure ends."""
    found = jumps(space, outline, material, ends)
    at = np.array([[j.r, j.z] for j in found]).reshape(-1, 2).repeat(DIRECTIONS, axis=0)
    node = np.array([outline.nodes[j.before, 1] for j in found], dtype=np.int64).repeat(DIRECTIONS)
    row = np.arange(len(node))
    at_nodes = sp.csr_matrix((np.ones(len(node)), (row, node)), shape=(len(node), len(space.nodes)))
    displaced = sp.vstack([space.values_at(inside), at_nodes], format="csr")
    return Beside(np.concatenate([inside, at]), displaced, space.continued_to(inside), found)


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
    clamps: tuple[str, ...] = (),
    extra: Beside | None = None,
) -> tuple[Floats, Floats]:
    """Displacement (S, 3, K) in m and stress (S, 6, K) in Pa, amplitudes, at the five points of
    each edge of the outline, then at the inner nodes, then at `extra` points, of displacements u
    (N, 3, K) of harmonic n.

    traction: (E, 3, 3, K) Pa at the nodes of the outline's edges. Inside, and where the traction is
    unknown because the surface is held, stress is fitted to samples in the elements
    (fea.recovery.continuation).
    """
    K = u.shape[2]
    stress = elasticity(material) @ space.sampled_strains(n, u)  # (M, 3, 6, K)
    sampled = stress.reshape(-1, 6, K)
    fitted = _apply(space.continued_to_nodes, sampled)
    found = skin(space, outline, material, n, u, traction)
    rough = np.einsum("qi,eiak->eqak", shapes(AT), fitted[outline.nodes])
    keep = outline.held(clamps)[:, None] | (found.points[..., 0] < 1e-9 * space.nodes[:, 0].max())
    on_skin = np.where(keep[..., None, None], rough, found.stress)
    inner = inner_nodes(space, outline)
    displacements = [found.displacement.reshape(-1, 3, K), u[inner]]
    stresses = [on_skin.reshape(-1, 6, K), fitted[inner]]
    if extra is not None:
        displacements.append(_apply(extra.displaced, u))
        stresses.append(_apply(extra.continued, sampled))
        stresses.extend(jump.stress(sampled, traction) for jump in extra.jumps)
    return np.concatenate(displacements), np.concatenate(stresses)


def _apply(matrix: sp.csr_matrix, values: Floats) -> Floats:
    flat = np.asarray(matrix @ values.reshape(len(values), -1))
    return flat.reshape(-1, *values.shape[1:])

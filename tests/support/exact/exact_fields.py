"""Exact fields of one harmonic: their loads on a section's mesh, and the errors of a solution."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementTriP2

from fea.core.linear_solver import factorize
from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.harmonic.assembly import Section, around, elasticity, strain_map
from fea.harmonic.boundary import Outline, shapes, slopes
from pinbase.arrays import Ints

Field = Callable[[Floats, Floats], Floats]  # a function of r and z (...); components are last

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True)
class Exact:
    """An exact field of harmonic n, as functions of r and z.

    displacement: amplitudes (..., 3) along r, theta, z. stress: (..., 6), rr, tt, zz, tz, rz, rt.
    body: the body force (..., 3).
    """

    n: int
    displacement: Field
    stress: Field
    body: Field = lambda r, z: np.zeros((*np.shape(r), 3))

    def at_nodes(self, space: Section) -> Floats:
        """Return the displacement at the nodes, (N, 3, 1)."""
        return self.displacement(*space.nodes.T)[..., None]

    def traction(self, x: Floats, tangent: Floats) -> Floats:
        """Return the traction (..., 3) at points x (..., 2) of an outline with unit tangents (...,
        2).
        """
        rr, _, zz, tz, rz, rt = np.moveaxis(self.stress(x[..., 0], x[..., 1]), -1, 0)
        n_r, n_z = tangent[..., 1], -tangent[..., 0]
        return np.stack([n_r * rr + n_z * rz, n_r * rt + n_z * tz, n_r * rz + n_z * zz], axis=-1)


def on_unknowns(forces: Floats) -> Floats:
    """Return the forces on the unknowns p, m, w for forces (N, 3) along r, theta, z, by virtual
    work.
    """
    R, T, Z = forces.T
    return np.stack([R + T, R - T, Z], axis=1).ravel()


def unknowns_of(u: Floats) -> Floats:
    """Return the unknowns p, m, w of displacements (N, 3)."""
    U, V, W = u.T
    return np.stack([(U + V) / 2.0, (U - V) / 2.0, W], axis=1).ravel()


def displacements_of(unknowns: Floats) -> Floats:
    """Return the displacements (N, 3, 1) of the unknowns p, m, w."""
    p, m, w = unknowns.reshape(-1, 3).T
    return np.stack([p + m, p - m, w], axis=1)[..., None]


def edge_tractions(space: Section, outline: Outline, exact: Exact) -> Floats:
    """Return the exact tractions at the nodes of the outline's edges, (E, 3, 3, 1)."""
    x = space.nodes[outline.nodes]
    tangent = np.einsum("qi,eia->eqa", slopes(np.array([-1.0, 1.0, 0.0])), x)
    tangent /= np.linalg.norm(tangent, axis=2, keepdims=True)
    return exact.traction(x, tangent)[..., None]


def boundary_forces(space: Section, outline: Outline, exact: Exact) -> Floats:
    """Return the forces on the unknowns due to the exact tractions on the whole outline."""
    x = space.nodes[outline.nodes]
    at = np.einsum("qi,eia->eqa", shapes(_POINTS), x)
    along = np.einsum("qi,eia->eqa", slopes(_POINTS), x)
    length = np.linalg.norm(along, axis=2)
    t = exact.traction(at, along / length[..., None])
    weight = around(exact.n) * _WEIGHTS * length * at[..., 0]
    forces = np.zeros((len(space.nodes), 3))
    np.add.at(forces, outline.nodes, np.einsum("eq,qi,eqa->eia", weight, shapes(_POINTS), t))
    return on_unknowns(forces)


def _fine(space: Section) -> tuple[Basis, Floats, Floats, Floats, Floats]:
    """Return a basis with many integration points, with r, z, areas times r (M, Q), and shape
    functions (6, M, Q) at them.
    """
    basis = Basis(space.section.mesh, ElementTriP2(), intorder=8)
    r, z = (np.asarray(x) for x in basis.global_coordinates())
    values = np.stack([np.broadcast_to(np.asarray(basis.basis[i][0]), r.shape) for i in range(6)])
    return basis, r, z, np.asarray(basis.dx * r), values


def _gradients(basis: Basis, r: Floats) -> Floats:
    """Return N,r N,z and N / r of the shape functions, (M, Q, 3, 6) in 1/m, at a basis' points,
    which are at r (M, Q), m.
    """
    parts = [
        (*basis.basis[i][0].grad, np.asarray(basis.basis[i][0]) / r) for i in range(basis.Nbfun)
    ]
    return np.stack([np.stack(part, axis=-1) for part in parts], axis=-1)


def body_forces(space: Section, exact: Exact) -> Floats:
    """Return the forces on the unknowns due to the exact body force."""
    _, r, z, weight, values = _fine(space)
    found = np.einsum("mq,imq,mqa->mia", around(exact.n) * weight, values, exact.body(r, z))
    forces = np.zeros((len(space.nodes), 3))
    np.add.at(forces, space.elements, found)
    return on_unknowns(forces)


def with_edges_moved(
    space: Section, outline: Outline, material: Material, exact: Exact, axis: Ints
) -> Floats:
    """Return the displacements (N, 3, 1) for the body force, with the exact displacements
    prescribed on the outline.

    axis: unknowns that vanish on the axis.
    """
    edges = np.setdiff1d(np.unique(outline.nodes), space.section.axis)
    on_edges = (3 * edges[:, None] + np.arange(3)).ravel()
    ends = np.intersect1d(outline.nodes, space.section.axis)
    fixed = np.unique(np.concatenate([on_edges, axis, (3 * ends[:, None] + np.arange(3)).ravel()]))
    free = np.setdiff1d(np.arange(space.unknowns), fixed)
    u = np.zeros(space.unknowns)
    u[fixed] = unknowns_of(exact.at_nodes(space)[..., 0])[fixed]
    K: sp.csr_matrix = space.stiffness(material, exact.n)
    u[free] = factorize(K[free][:, free], free // 3)((body_forces(space, exact) - K @ u)[free])
    return displacements_of(u)


def errors(space: Section, material: Material, exact: Exact, u: Floats) -> tuple[float, float]:
    """Return the relative L2 errors over the volume, of displacements u (N, 3, 1) and of the
    elements' stresses.
    """
    basis, r, z, weight, values = _fine(space)
    moved = np.einsum("imq,mia->mqa", values, u[space.elements][..., 0])
    local = unknowns_of(u[..., 0]).reshape(-1, 3)[space.elements]
    strain = np.einsum("sca,mqai,mic->mqs", strain_map(exact.n), _gradients(basis, r), local)
    stress = strain @ elasticity(material).T

    def off(found: Floats, true: Floats) -> float:
        wrong, size = (np.einsum("mq,mqa->", weight, x**2) for x in (found - true, true))
        return float(np.sqrt(wrong / size))

    return off(moved, exact.displacement(r, z)), off(stress, exact.stress(r, z))

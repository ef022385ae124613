"""The discretisation: against scikit-fem's own assembly, a patch test, a manufactured solution."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from skfem import Basis, ElementTetP1, ElementTetP2, ElementVector, MeshTet, MeshTet2
from skfem.models.elasticity import lame_parameters, linear_elasticity

from fea.core.linear_solver import factorize
from fea.core.material import Material
from fea.solid.assembly import Discretisation
from fea.solid.boundary import surface
from fea.solid.stress_recovery import nodal_stress
from geometry import Pin
from geometry.mesh.elements import Element, with_element
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.each import each

Floats = NDArray[np.float64]


@each("element", ["linear", "straight", "curved"])
def test_the_matrix_is_scikit_fems(cantilever_pin: Pin, steel: Material, element: Element) -> None:
    """With the same quadrature; 1e-12 of its largest entry is round-off."""
    size = MeshSize(across=2.0, arc=1.0)
    space = Discretisation(solid_mesh(cantilever_pin, size, element=element).mesh)
    ours = space.stiffness(steel)
    assert ours.shape == (space.unknowns, space.unknowns)
    theirs_own, order = (ElementTetP1(), 1) if element == "linear" else (ElementTetP2(), 2)
    basis = Basis(space.mesh, ElementVector(theirs_own), intorder=order)
    lam, mu = lame_parameters(steel.youngs_modulus, steel.poisson_ratio)
    theirs = linear_elasticity(lam, mu).assemble(basis)
    # their numbering keeps vertices, edges apart as ours does, component by component within each
    difference = abs(ours - theirs).max() / abs(theirs).max()
    assert difference < 1e-12


@each(("element", "imbalance"), [("linear", 1e-12), ("straight", 1e-12), ("curved", 5e-3)])
def test_patch(cantilever_pin: Pin, steel: Material, element: Element, imbalance: float) -> None:
    """A linear displacement gives its constant stress exactly, and is in equilibrium: exactly on
    straight-sided elements; on coarse curved ones but for the four-point rule, which does not
    integrate a varying det J exactly (2e-3 here, 1e-4 on the meshes that are used).
    """
    curved = solid_mesh(cantilever_pin, MeshSize(across=2.0, arc=1.5)).mesh
    space = Discretisation(with_element(curved, element))
    assert surface(space).curved == (element == "curved")
    H = np.array([[1.0, 0.2, -0.4], [0.5, -0.7, 0.1], [0.3, 0.6, 0.9]]) * 1e-3
    u = space.nodes @ H.T
    e = 0.5 * (H + H.T)
    strain = np.array([e[0, 0], e[1, 1], e[2, 2], e[1, 2], e[0, 2], e[0, 1]])
    stress = nodal_stress(space, steel, u[:, :, None])[:, :, 0]
    assert np.abs(stress - steel.stress(strain)).max() < 1e-12 * np.abs(stress).max()
    force = (space.stiffness(steel) @ u.ravel()).reshape(-1, 3)
    inside = np.setdiff1d(np.arange(len(u)), surface(space).nodes)
    assert np.abs(force[inside]).max() < imbalance * np.abs(force).max()


class Manufactured:
    """u = (sin ax sin by, cos by sin cz, sin ax cos cz) on the unit cube, lambda = 1.5, mu = 1."""

    material = Material("m", 2.6, 0.3)  # mu = 1, lambda = 1.5
    a, b, c = 1.3, 1.7, 1.1

    def displacement(self, x: Floats) -> Floats:
        ax, by, cz = self.a * x[..., 0], self.b * x[..., 1], self.c * x[..., 2]
        return np.stack(
            [np.sin(ax) * np.sin(by), np.cos(by) * np.sin(cz), np.sin(ax) * np.cos(cz)], -1
        )

    def stress(self, x: Floats) -> Floats:
        a, b, c = self.a, self.b, self.c
        ax, by, cz = a * x[..., 0], b * x[..., 1], c * x[..., 2]
        sx, cx, sy, cy, sz, kz = (f(v) for v in (ax, by, cz) for f in (np.sin, np.cos))
        h = np.zeros((*x.shape[:-1], 3, 3))
        h[..., 0, 0], h[..., 0, 1] = a * cx * sy, b * sx * cy
        h[..., 1, 1], h[..., 1, 2] = -b * sy * sz, c * cy * kz
        h[..., 2, 0], h[..., 2, 2] = a * cx * kz, -c * sx * sz
        e = 0.5 * (h + np.swapaxes(h, -1, -2))
        six = [e[..., i, j] for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))]
        return self.material.stress(np.stack(six, -1))

    def body_force(self, x: Floats) -> Floats:
        """-div stress by central differences of the stress: 1e-9, far below what is measured."""
        h = 1e-4
        index = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
        out = np.zeros_like(x)
        for k in range(3):
            step = np.zeros(3)
            step[k] = h
            slope = (self.stress(x + step) - self.stress(x - step)) / (2 * h)
            out -= slope[..., index[:, k]]
        return out


def solve(exact: Manufactured, n: int) -> tuple[float, float]:
    """L2 errors of displacement and stress with cells of 1 / n."""
    mesh = MeshTet2.from_mesh(MeshTet.init_tensor(*(np.linspace(0, 1, n + 1),) * 3))
    space = Discretisation(mesh)
    K = space.stiffness(exact.material)
    rule = Basis(mesh, ElementTetP2(), intorder=5)
    x = np.moveaxis(np.asarray(rule.global_coordinates()), 0, -1)
    force = exact.body_force(x)
    F = np.zeros((space.unknowns // 3, 3))
    for i in range(10):
        part = np.einsum("mqc,mq,mq->mc", force, np.asarray(rule.basis[i][0]), rule.dx)
        np.add.at(F, rule.element_dofs[i], part)
    u = np.zeros((space.unknowns // 3, 3))
    held = surface(space).nodes
    u[held] = exact.displacement(space.nodes[held])
    fixed = (3 * held[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(space.unknowns), fixed)
    flat = u.ravel()
    load = F.ravel()[free] - K[free][:, fixed] @ flat[fixed]
    flat[free] = factorize(K[free][:, free], free // 3)(load)
    at = sum(
        np.asarray(rule.basis[i][0])[..., None] * u[rule.element_dofs[i]][:, None]
        for i in range(10)
    )
    error_u = np.sqrt(np.sum((at - exact.displacement(x)) ** 2 * rule.dx[..., None]))
    x4 = np.moveaxis(np.asarray(space.basis.global_coordinates()), 0, -1)
    difference = exact.material.stress(space.strain(u)) - exact.stress(x4)
    error_s = np.sqrt(np.sum(difference**2 * space.weights[..., None]))
    return float(error_u), float(error_s)


@pytest.mark.slow
def test_orders_of_convergence() -> None:
    """Quadratic elements: order 3 for the displacement and 2 for the stress in L2, within 0.15."""
    exact = Manufactured()
    (u1, s1), (u2, s2) = solve(exact, 6), solve(exact, 12)
    assert np.log2(u1 / u2) == pytest.approx(3.0, abs=0.15)
    assert np.log2(s1 / s2) == pytest.approx(2.0, abs=0.15)
    assert u2 < 3e-5  # of a displacement near 1
    assert s2 < 1e-2

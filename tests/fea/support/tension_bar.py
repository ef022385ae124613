"""A stepped bar with a fillet in tension, by quadratic elements written for this alone."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import gmsh
import numpy as np
from skfem import (
    Basis,
    BilinearForm,
    ElementTriP2,
    ElementVector,
    FacetBasis,
    LinearForm,
    MeshTri,
    solve,
)
from skfem.helpers import sym_grad, trace

LAMBDA, MU = 210e9 * 0.3 / (1.3 * 0.4), 210e9 / 2.6


@dataclass(frozen=True)
class Fillet:
    """A shaft of radius r and one of radius R, m, with a fillet of radius rho.

    thin, thick: their lengths.
    pull: length of the outer surface at both ends on which the force (N) acts evenly.
    """

    r: float
    R: float
    rho: float
    thin: float
    thick: float
    pull: float
    force: float


def _mesh(of: Fillet) -> MeshTri:
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        add, z = gmsh.model.geo, of.thin - of.rho
        fine, coarse = of.rho / 40.0, of.r / 8.0
        corners = [
            (0.0, 0.0, coarse), (of.r, 0.0, coarse), (of.r, of.pull, coarse), (of.r, z, fine),
            (of.r + of.rho, of.thin, fine), (of.R, of.thin, coarse),
            (of.R, of.thin + of.thick - of.pull, coarse), (of.R, of.thin + of.thick, coarse),
            (0.0, of.thin + of.thick, coarse),
        ]  # fmt: skip
        points = [add.addPoint(x, y, 0.0, size) for x, y, size in corners]
        centre = add.addPoint(of.r + of.rho, z, 0.0, fine)
        lines = [
            add.addCircleArc(a, centre, b) if a == points[3] else add.addLine(a, b)
            for a, b in zip(points, [*points[1:], points[0]], strict=True)
        ]
        add.addPlaneSurface([add.addCurveLoop(lines)])
        add.synchronize()
        gmsh.model.mesh.generate(2)
        tags, x, _ = gmsh.model.mesh.getNodes()
        _, _, nodes = gmsh.model.mesh.getElements(2)
        row = np.zeros(int(max(tags)) + 1, dtype=np.int64)
        row[tags] = np.arange(len(tags))
        used, t = np.unique(row[nodes[0]], return_inverse=True)
        return MeshTri(x.reshape(-1, 3)[used, :2].T, t.reshape(-1, 3).T)
    finally:
        gmsh.finalize()


@lru_cache(2)
def _solution(of: Fillet) -> tuple[Basis, np.ndarray]:
    mesh, length = _mesh(of), of.thin + of.thick
    element = ElementVector(ElementTriP2())
    basis = Basis(mesh, element, intorder=4)

    @BilinearForm
    def stiffness(u, v, w):  # type: ignore[no-untyped-def]
        r, e, d = w.x[0], sym_grad(u), sym_grad(v)
        hoop, other = u[0] / r, v[0] / r
        bulk = LAMBDA * (trace(e) + hoop) * (trace(d) + other)
        return (bulk + 2.0 * MU * (np.sum(e * d, axis=(0, 1)) + hoop * other)) * r

    def near(x: Any, r: float, low: float, high: float) -> Any:
        return (np.abs(x[0] - r) < 1e-9) & (x[1] > low) & (x[1] < high)

    ends = {
        -1.0: (of.r, 0.0, of.pull),
        1.0: (of.R, length - of.pull, length),
    }
    load = np.zeros(basis.N)
    for sign, (r, low, high) in ends.items():
        facets = mesh.facets_satisfying(lambda x, at=(r, low, high): near(x, *at), True)
        traction = sign * of.force / (2.0 * math.pi * r * of.pull)
        form = LinearForm(lambda v, w, p=traction: p * v[1] * w.x[0])
        load += form.assemble(FacetBasis(mesh, element, facets=facets, intorder=4))
    K = stiffness.assemble(basis)
    axis = basis.get_dofs(lambda x: x[0] < 1e-12).all("u^1")
    middle = basis.get_dofs(lambda x: (x[0] < 1e-12) & (np.abs(x[1]) < 1e-12)).all("u^2")
    fixed = np.concatenate([axis, middle])
    free = np.setdiff1d(np.arange(basis.N), fixed)
    u = np.zeros(basis.N)
    u[free] = solve(K[free][:, free], load[free])
    return basis, u


def largest_on_offset(of: Fillet, depth: float) -> float:
    """The largest von Mises stress, Pa, along a line at a depth (m) below the fillet and shaft."""
    basis, u = _solution(of)
    out, inside = [], 2e-3 * of.rho  # of the boundary, whose elements have straight sides
    for angle in np.linspace(0.0, 0.5 * math.pi, 181):
        away = of.rho + max(depth, inside)
        r = of.r + of.rho - away * math.cos(angle)
        z = of.thin - of.rho + away * math.sin(angle)
        out.append(_von_mises(basis, u, r, z))
    return max(out)


def _von_mises(basis: Basis, u: np.ndarray, r: float, z: float) -> float:
    cell = basis.mesh.element_finder()(np.array([r]), np.array([z]))
    local = basis.mapping.invF(np.array([[[r]], [[z]]]), cell)
    value, grad = np.zeros(2), np.zeros((2, 2))
    for i in range(basis.Nbfun):
        (phi,) = basis.elem.gbasis(basis.mapping, local, i, cell)
        amount = u[basis.element_dofs[i, cell[0]]]
        value += amount * np.asarray(phi)[:, 0, 0]
        grad += amount * phi.grad[:, :, 0, 0]
    strain, hoop = 0.5 * (grad + grad.T), value[0] / r
    volume = LAMBDA * (np.trace(strain) + hoop)
    s = [volume + 2.0 * MU * x for x in (strain[0, 0], strain[1, 1], hoop)]
    square = sum((s[i] - s[j]) ** 2 for i, j in ((0, 1), (1, 2), (2, 0)))
    return math.sqrt(0.5 * square + 3.0 * (2.0 * MU * strain[0, 1]) ** 2)

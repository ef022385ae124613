"""NGSolve's side: our mesh with its curved edges, our nodal forces, its assembly and solver.

It runs in its own process with as little of our code as possible: the mesh is passed as arrays.
"""

from __future__ import annotations

import pickle
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# Netgen's nodes are the corners, then edges 01, 02, 03, 12, 13, 23; ours 01, 12, 02, 03, 13, 23.
TET10 = [0, 1, 2, 3, 4, 6, 7, 5, 8, 9]
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))  # in our order


@dataclass(frozen=True)
class Given:
    """The problem.

    nodes: (N, 3), m, corners first. elements: (M, 10).
    held: nodes that do not move.
    forces: (N, 3), N. lame: Pa.
    """

    nodes: Floats
    elements: Ints
    held: Ints
    forces: Floats
    lame: tuple[float, float]


@dataclass(frozen=True)
class Found:
    """NGSolve's solution.

    displacement: (N, 3), m.
    seconds: wall time from the mesh in NGSolve's form, s.
    version: of NGSolve.
    """

    displacement: Floats
    seconds: float
    version: str


def solve(given: Given, threads: int) -> Found:
    """Return the solution: assembly with our four-point rule, sparse Cholesky factorisation, one
    solve.
    """
    import ngsolve as ng

    ng.SetNumThreads(threads)
    mesh = ng.Mesh(_netgen(given))
    with ng.TaskManager():
        start = time.perf_counter()
        space = ng.NodalFESpace(mesh, order=2, dim=3)
        u, v = space.TnT()
        rule = {ng.TET: ng.IntegrationRule(ng.TET, 2)}
        lam, mu = given.lame

        def strain(w: ng.CoefficientFunction) -> ng.CoefficientFunction:
            return 0.5 * (ng.grad(w) + ng.grad(w).trans)

        form = ng.BilinearForm(space, symmetric=True)
        stress = 2.0 * mu * strain(u) + lam * ng.Trace(strain(u)) * ng.Id(3)
        form += ng.InnerProduct(stress, strain(v)).Compile() * ng.dx(intrules=rule)
        form.Assemble()
        ours = _dofs(mesh, given)
        free = ng.BitArray(space.ndof)
        free.Set()
        for dof in ours[given.held]:
            free[int(dof)] = False
        load, solution = form.mat.CreateColVector(), form.mat.CreateColVector()
        load.FV().NumPy().reshape(-1, 3)[ours] = given.forces
        solution.data = form.mat.Inverse(free, inverse="sparsecholesky") * load
        spent = time.perf_counter() - start
    return Found(solution.FV().NumPy().reshape(-1, 3)[ours].copy(), spent, ng.__version__)


def _netgen(given: Given) -> object:
    from netgen.meshing import Element3D, FaceDescriptor, Mesh, MeshPoint, Pnt

    mesh = Mesh()
    mesh.dim = 3
    mesh.Add(FaceDescriptor(surfnr=1, domin=1, domout=0, bc=1))
    points = [mesh.Add(MeshPoint(Pnt(*x))) for x in given.nodes.tolist()]
    for element in given.elements[:, TET10].tolist():
        mesh.Add(Element3D(1, [points[n] for n in element]))
    return mesh


def _dofs(mesh: object, given: Given) -> Ints:
    """Return NGSolve's number of each of our nodes: its vertices are our corners, and its edges
    follow.
    """
    vertices = mesh.nv  # type: ignore[attr-defined]
    theirs = np.array([[v.nr for v in e.vertices] for e in mesh.edges])  # type: ignore[attr-defined]
    number = {tuple(sorted(ends)): vertices + k for k, ends in enumerate(theirs.tolist())}
    out = np.arange(len(given.nodes))
    for middle, (a, b) in zip(range(4, 10), EDGES, strict=True):
        triples = np.unique(given.elements[:, [a, b, middle]], axis=0)
        for i, k, node in triples.tolist():
            out[node] = number[min(i, k), max(i, k)]
    return out


def main(given: Path, result: Path, threads: int) -> None:
    """Solve a pickled problem and pickle the result."""
    result.write_bytes(pickle.dumps(solve(pickle.loads(given.read_bytes()), threads)))

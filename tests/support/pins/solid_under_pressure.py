"""A body under pressure with symmetry planes, as the published solid problems need it.

It is built from the solid model's own parts, since a study file has neither such a pressure nor
such planes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from skfem import MeshTet2

from fea.core.linear_solver import factorize
from fea.core.material import Material
from fea.solid.assembly import Discretisation
from fea.solid.boundary import Patch, surface
from fea.solid.stress_recovery import nodal_stress, with_known_traction
from geometry.mesh.gmsh_tetrahedra import MIN_JACOBIAN_RATIO, collect, repair

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Solved:
    """The solution at the nodes.

    nodes: (N, 3), m. displacement: (N, 3), m. stress: (N, 6), Pa: xx, yy, zz, yz, xz, xy.
    """

    nodes: Floats
    displacement: Floats
    stress: Floats

    def at(self, *x: float) -> Ints:
        """Return the index (1,) of the node at a point (m); fails unless there is exactly one."""
        near = np.flatnonzero(np.linalg.norm(self.nodes - x, axis=1) < 1e-9)
        assert len(near) == 1
        return near


def meshed(gmsh: Any, surfaces: dict[str, list[int]]) -> MeshTet2:
    """Return the mesh of the model in curved tetrahedra, after a check that they are valid."""
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    jacobian, _ = repair(gmsh)
    assert jacobian > MIN_JACOBIAN_RATIO
    return collect(gmsh, surfaces)


def solve(
    mesh: MeshTet2,
    material: Material,
    pressed: tuple[str, float],
    planes: Mapping[str, int],
    held: Ints,
) -> Solved:
    """Return the solution of a body under pressure (Pa) on one surface.

    planes: for surfaces, the component of the displacement that is zero on them. held: further
    components, 3 n + c.
    """
    space = Discretisation(mesh)
    boundary = surface(space)
    patch = Patch(space, boundary, pressed[0])
    traction = np.zeros((*boundary.normals.shape, 1))
    traction[patch.rows, ..., 0] = -pressed[1] * boundary.normals[patch.rows]
    forces = patch.nodal_forces(traction[patch.rows]).reshape(-1, 1)
    symmetric = {name: np.isin(boundary.facets, mesh.boundaries[name]) for name in planes}
    on = [3 * np.unique(boundary.corners[symmetric[name]]) + c for name, c in planes.items()]
    fixed = np.unique(np.concatenate([*on, held]))
    free = np.setdiff1d(np.arange(space.unknowns), fixed)
    K = space.stiffness(material)
    u = np.zeros_like(forces)
    u[free] = factorize(K[free][:, free], free // 3)(forces[free])
    moved = u.reshape(-1, 3, 1)
    unknown = np.any(list(symmetric.values()), axis=0)
    stress = nodal_stress(space, material, moved)
    stress = with_known_traction(stress, boundary, traction, unknown)
    return Solved(space.nodes, moved[..., 0], stress[..., 0])

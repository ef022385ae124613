"""The volume of a body in gmsh's model, also of one with spline surfaces.

OpenCASCADE integrates over a face with few points: exactly on planes, cylinders, cones, spheres and
tori, but 1 % wrong on the rational splines that are exact copies of these. There the surface is
meshed with curved triangles instead, and the volume follows by the divergence theorem. (gmsh can
curve them, too, but takes several times as long as for the mesh itself.)
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pinbase.arrays import Floats, Ints

EXACT_FACES = frozenset({"Plane", "Cylinder", "Cone", "Sphere", "Torus"})  # gmsh's names
# Elements over a full turn on two meshes. The error falls with the fourth power of their size and
# is extrapolated: to 4e-7 on turned bodies with cones, fillets and domes, of which the second mesh
# alone leaves 1e-5, the difference from which on a profile is refused.
CURVATURE_ELEMENTS = 12, 24
CURVED_TRIANGLE = 9  # gmsh's number of the type with six nodes
POINTS_RULE = "Gauss6"  # exact for x . n on triangles of second order
EDGES = ((0, 1), (1, 2), (2, 0))  # of a triangle, in the order of the nodes in their middles
# Of the length of an edge: how far the point in its middle may be from its chord. It is a fifteenth
# on an arc with 12 elements around; farther where the ends' coordinates on the face do not belong
# together, across a seam or at a pole.
MAX_RISE = 0.1
SINGULAR = 1e-12  # of the squares of tangents


def solid_volume(gmsh: Any, solid: tuple[int, int]) -> float:
    """The volume of a solid in gmsh's model, in the model's unit.

    It may leave a mesh of the model's surfaces behind.
    """
    faces = [tag for _, tag in gmsh.model.getBoundary([solid], oriented=False)]
    if {gmsh.model.getType(2, tag) for tag in faces} <= EXACT_FACES:
        return float(gmsh.model.occ.getMass(*solid))
    mesh = gmsh.model.mesh
    mesh.setOutwardOrientation(solid[1])
    volumes = []
    for elements in CURVATURE_ELEMENTS:
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", elements)
        mesh.clear()
        mesh.generate(2)
        volumes.append(sum(_flux(mesh, _curved_triangles(gmsh, tag)) for tag in faces) / 3.0)
    coarse, fine = volumes
    ratio = (CURVATURE_ELEMENTS[1] / CURVATURE_ELEMENTS[0]) ** 4
    return fine + (fine - coarse) / (ratio - 1.0)


def _curved_triangles(gmsh: Any, face: int) -> Floats:
    """The nodes (E, 6, 3) of a meshed face's triangles, those in the middles of edges on the face,
    or on its boundary.
    """
    mesh = gmsh.model.mesh
    tags, x, on_face = _nodes(mesh, (2, face))
    _, _, (nodes,) = mesh.getElements(2, face)
    corners = np.searchsorted(tags, np.reshape(nodes, (-1, 3)))
    sides = np.sort(corners[:, EDGES].reshape(-1, 2), axis=1)
    edges, of_side = np.unique(sides, axis=0, return_inverse=True)
    middles = _middles(gmsh, (2, face), x[edges], on_face[edges])
    index = {(a, b): k for k, (a, b) in enumerate(tags[edges].tolist())}
    for _, curve in gmsh.model.getBoundary([(2, face)], combined=False, oriented=False):
        _, _, ends = mesh.getElements(1, curve)
        for pairs in ends:  # none of a curve without length, as at a pole
            on_it, x_of_it, along = _nodes(mesh, (1, curve))
            parts = np.sort(np.reshape(pairs, (-1, 2)), axis=1)
            at = [index[a, b] for a, b in parts.tolist()]
            parts = np.searchsorted(on_it, parts)
            middles[at] = _middles(gmsh, (1, curve), x_of_it[parts], along[parts])
    return np.concatenate([x[corners], middles[of_side].reshape(-1, 3, 3)], axis=1)


def _nodes(mesh: Any, entity: tuple[int, int]) -> tuple[Ints, Floats, Floats]:
    """The nodes of an entity and its boundary in the order of their tags (N,), with their places
    (N, 3) and their coordinates on it.
    """
    tags, x, on_it = mesh.getNodes(*entity, includeBoundary=True, returnParametricCoord=True)
    tags, first = np.unique(tags, return_index=True)
    return tags, np.reshape(x, (-1, 3))[first], np.reshape(on_it, (-1, entity[0]))[first]


def _middles(gmsh: Any, entity: tuple[int, int], ends: Floats, on_it: Floats) -> Floats:
    """The points (E, 3) of a curve or a face that are nearest to the middles of edges, by their
    ends (E, 2, 3) and the coordinates of these on it.
    """
    model = gmsh.model
    chord, at = ends.mean(axis=1), on_it.mean(axis=1)
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    # The mean of the ends' coordinates is not in the middle of the arc: one step of Newton's method
    # from there, by equations that are not singular at poles either.
    tangents = np.reshape(model.getDerivative(*entity, at.ravel()), (len(at), -1, 3))
    off = chord - np.reshape(model.getValue(*entity, at.ravel()), (-1, 3))
    products = tangents @ tangents.swapaxes(1, 2)
    least = SINGULAR * np.trace(products, axis1=1, axis2=2)[:, None, None]
    step = np.linalg.solve(products + least * np.eye(entity[0]), tangents @ off[:, :, None])
    middle = np.reshape(model.getValue(*entity, (at + step[:, :, 0]).ravel()), (-1, 3))
    far = np.linalg.norm(middle - chord, axis=1) > MAX_RISE * length
    if far.any():
        nearest, _ = model.getClosestPoint(*entity, chord[far].ravel())
        middle[far] = np.reshape(nearest, (-1, 3))
    return middle


def _flux(mesh: Any, triangles: Floats) -> float:
    """The integral of x . n over curved triangles (E, 6, 3)."""
    points, weights = mesh.getIntegrationPoints(CURVED_TRIANGLE, POINTS_RULE)
    _, values, _ = mesh.getBasisFunctions(CURVED_TRIANGLE, points, "Lagrange")
    _, gradients, _ = mesh.getBasisFunctions(CURVED_TRIANGLE, points, "GradLagrange")
    x = np.reshape(values, (-1, 6)) @ triangles
    along = np.einsum("qnd,enk->eqdk", np.reshape(gradients, (-1, 6, 3)), triangles)
    normal = np.cross(along[:, :, 0], along[:, :, 1])
    return float((np.einsum("eqi,eqi->eq", normal, x) @ weights).sum())

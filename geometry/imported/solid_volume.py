"""The volume of a body in gmsh's model, including bodies with spline surfaces.

OpenCASCADE integrates over a face with few points. This is exact on planes, cylinders, cones,
spheres and tori, but has errors of 1 % on the rational splines that are exact copies of these.
Bodies with splines are therefore meshed with curved triangles, and the volume follows from the
divergence theorem. (gmsh can curve triangles, too, but needs several times as long as for the mesh
itself.)
"""

from __future__ import annotations

from typing import Any

import numpy as np

from geometry.mesh.entities import curves_of
from pinbase.arrays import Floats, Ints

EXACT_FACES = frozenset({"Plane", "Cylinder", "Cone", "Sphere", "Torus"})  # gmsh's names
# Elements over a full turn on two meshes. The error falls with the fourth power of the element size
# and is extrapolated. On turned bodies with cones, fillets and domes the extrapolated error is
# 4e-7; that of the second mesh alone is 1e-5, the difference at which a profile is refused.
CURVATURE_ELEMENTS = 12, 24
CURVED_TRIANGLE = 9  # gmsh's number of the type with six nodes
POINTS_RULE = "Gauss6"  # exact for x . n on triangles of second order
EDGES = ((0, 1), (1, 2), (2, 0))  # edges of a triangle, in the order of their midside nodes
# Largest distance of the midside node of an edge from the chord, relative to the edge's length. On
# an arc with 12 elements around it is a fifteenth. It is larger where the ends' coordinates on the
# face do not belong together, across a seam or at a pole.
MAX_RISE = 0.1
SINGULAR = 1e-12  # regularisation at poles, relative to the squares of tangents


def solid_volume(gmsh: Any, solid: tuple[int, int]) -> float:
    """The volume of a solid in gmsh's model, in the model's unit.

    A mesh of the model's surfaces may remain in the model.
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
    """The nodes (E, 6, 3) of a meshed face's triangles, with midside nodes on face or boundary."""
    mesh = gmsh.model.mesh
    tags, x, on_face = _nodes(mesh, (2, face))
    _, _, (nodes,) = mesh.getElements(2, face)
    corners = np.searchsorted(tags, np.reshape(nodes, (-1, 3)))
    sides = np.sort(corners[:, EDGES].reshape(-1, 2), axis=1)
    edges, of_side = np.unique(sides, axis=0, return_inverse=True)
    middles = _middles(gmsh, (2, face), x[edges], on_face[edges])
    index = {(a, b): k for k, (a, b) in enumerate(tags[edges].tolist())}
    for curve in curves_of(gmsh, [face]):
        _, _, ends = mesh.getElements(1, curve)
        for pairs in ends:  # a curve without length, as at a pole, has none
            on_it, x_of_it, along = _nodes(mesh, (1, curve))
            parts = np.sort(np.reshape(pairs, (-1, 2)), axis=1)
            at = [index[a, b] for a, b in parts.tolist()]
            parts = np.searchsorted(on_it, parts)
            middles[at] = _middles(gmsh, (1, curve), x_of_it[parts], along[parts])
    return np.concatenate([x[corners], middles[of_side].reshape(-1, 3, 3)], axis=1)


def _nodes(mesh: Any, entity: tuple[int, int]) -> tuple[Ints, Floats, Floats]:
    """The nodes of an entity and its boundary, in the order of their tags.

    Returns tags (N,), places (N, 3), and coordinates on the entity (N, 1 or 2).
    """
    tags, x, on_it = mesh.getNodes(*entity, includeBoundary=True, returnParametricCoord=True)
    tags, first = np.unique(tags, return_index=True)
    return tags, np.reshape(x, (-1, 3))[first], np.reshape(on_it, (-1, entity[0]))[first]


def _middles(gmsh: Any, entity: tuple[int, int], ends: Floats, on_it: Floats) -> Floats:
    """The points (E, 3) of a curve or a face that are nearest to the middles of edges.

    ends: (E, 2, 3) ends of the edges. on_it: coordinates of these ends on the entity.
    """
    model = gmsh.model
    chord, at = ends.mean(axis=1), on_it.mean(axis=1)
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    # The mean of the ends' coordinates is not in the middle of the arc. One step of Newton's method
    # starts from it, with equations that are not singular even at poles.
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

"""Faces of a CAD body, described by points and normals on them.

So the representation of a face in the file does not matter: a cylinder may be whole, in halves, or
a spline.

A surface is a surface of revolution about an axis if all its normals meet that axis. A rigid motion
with velocities v = a + w x p maps the surface to itself if n . v = 0 at all its points p. Such
motions are the null space of the rows (n, p x n).

Source: H. Pottmann & J. Wallner, Computational Line Geometry, Springer 2001, ch. 3.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geometry.mesh.entities import along, curves_of, grid_on, points_at
from pinbase.arrays import Floats

FACE_TOLERANCE = 1e-6  # for equal points, over the body's size, and for equal directions
FACE_GRID_FRACTIONS = np.linspace(0.0, 1.0, 7)
EDGE_FRACTIONS = np.linspace(0.0, 1.0, 9)


@dataclass(frozen=True)
class Axis:
    """A line through a point (3,) along a unit vector (3,)."""

    point: Floats
    along: Floats

    def frame(self) -> Floats:
        """Unit vectors x, y, z as rows (3, 3), z along the axis; the file's axes if that is z."""
        z = self.along
        first = (
            np.eye(3)[int(np.argmin(np.abs(z)))]
            if abs(z[2]) < 1.0 - FACE_TOLERANCE
            else np.eye(3)[0]
        )
        x = first - (first @ z) * z
        x /= np.linalg.norm(x)
        return np.stack([x, np.cross(z, x), z])


@dataclass(frozen=True)
class SampledFace:
    """A face of a CAD body, sampled. Lengths are in the file's unit.

    tag, name: gmsh's tag of the face, and its name in the file.
    points, normals: (P, 3) points on the face, and unit normals there.
    rim: (R, 3) points on the edges of the face.
    """

    tag: int
    name: str
    points: Floats
    normals: Floats
    rim: Floats
    area: float

    @property
    def plane(self) -> bool:
        """Whether the face is plane."""
        return bool(np.ptp(self.normals, axis=0).max() < FACE_TOLERANCE)

    def motions(self, centre: Floats, size: float) -> Floats:
        """A basis (K, 6) of the motions (a, w) that map the face to itself.

        Lengths are divided by `size` and measured from `centre` (3,).
        """
        p = (self.points - centre) / size
        rows = np.hstack([self.normals, np.cross(p, self.normals)])
        _, values, basis = np.linalg.svd(rows, full_matrices=True)
        return np.asarray(basis[values < FACE_TOLERANCE * np.sqrt(len(rows))])

    def axis(self, centre: Floats, size: float) -> Axis | None:
        """The axis of a face of revolution; None for planes, spheres and all other faces."""
        if self.plane:
            return None
        motions = self.motions(centre, size)
        if not 1 <= len(motions) <= 2:
            return None
        left, values, _ = np.linalg.svd(motions[:, 3:])
        turn = left[:, 0] @ motions / values[0]
        w, a = turn[3:], turn[:3]
        if abs(w @ a) > FACE_TOLERANCE and len(motions) == 1:  # a helical surface
            return None
        return Axis(centre + size * np.cross(w, a), w)

    def revolved(self, axis: Axis, size: float) -> bool:
        """Whether the face is a surface of revolution about an axis. size: size of the body."""
        p = self.points - axis.point
        across = np.cross(axis.along, p)
        r = np.linalg.norm(across, axis=1)
        tangential = np.abs(np.sum(across * self.normals, axis=1))
        return bool((tangential <= FACE_TOLERANCE * np.maximum(r, size)).all())


def sampled_face(gmsh: Any, tag: int, name: str) -> SampledFace:
    """A face of the body in gmsh's model, sampled on a grid of parameters and on its edges."""
    at = grid_on(gmsh, (2, tag), FACE_GRID_FRACTIONS)
    points = points_at(gmsh, (2, tag), at)
    normals = np.reshape(gmsh.model.getNormal(tag, at.ravel()), (-1, 3))
    length = np.linalg.norm(normals, axis=1)
    inner = (FACE_GRID_FRACTIONS > 0.0) & (FACE_GRID_FRACTIONS < 1.0)
    good = np.isfinite(length) & (length > 0.5) & np.outer(inner, inner).ravel()  # not at a pole
    lines = (along(gmsh, curve, EDGE_FRACTIONS) for curve in curves_of(gmsh, [tag]))
    rim = np.concatenate([np.zeros((0, 3)), *lines])
    area = float(gmsh.model.occ.getMass(2, tag))
    face = SampledFace(tag, name, points[good], normals[good], rim, area)
    if face.plane:  # the parameters of a plane extend beyond the face
        return face
    return replace(face, rim=np.concatenate([face.rim, points[~good]]))

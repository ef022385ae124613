"""Recognition of prisms about the axis, such as the head of a bolt or a square end.

Planes along the axis that form a closed polygon are flats on a cylinder through its corners. They
leave nothing of this cylinder, but the outline needs it, although the body has no such face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geometry.imported.outline_chain import MeridianSide
from geometry.imported.sampled_face import FACE_TOLERANCE, SampledFace
from pinbase.arrays import Floats

Z_AXIS = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class PrismFace:
    """A plane along the axis, in a frame whose z-axis is the pin's.

    low, high: the two edges along the axis, (2, 3) each, clockwise and counterclockwise seen from
    the end; each has the points with least and greatest z.
    """

    face: SampledFace
    low: Floats
    high: Floats

    @staticmethod
    def of(face: SampledFace, near: float) -> PrismFace | None:
        """The plane of a face; None if the face is not a plane along the axis, or contains it.

        near: distance within which two points coincide.
        """
        normal = face.normals[0]
        distance = float(face.points[0] @ normal)
        if not face.plane or abs(normal[2]) > FACE_TOLERANCE or abs(distance) < near:
            return None
        around = face.rim @ np.cross(Z_AXIS, normal * np.sign(distance))
        ends = [face.rim[np.abs(around - at) < near] for at in (around.min(), around.max())]
        low, high = (edge[[edge[:, 2].argmin(), edge[:, 2].argmax()]] for edge in ends)
        return PrismFace(face, low, high)


def prisms(faces: Sequence[SampledFace], near: float) -> list[list[PrismFace]]:
    """The faces of each prism whose edges lie on one cylinder about the axis.

    faces: faces in a frame whose z-axis is the pin's.
    near: distance within which two points coincide.
    """
    planes = [plane for face in faces if (plane := PrismFace.of(face, near)) is not None]
    out = []
    # Follow planes from edge to edge around the axis. A closed chain with all edges on one cylinder
    # is a prism.
    while planes:
        chain = [planes.pop()]
        while following := [p for p in planes if np.abs(p.low - chain[-1].high).max() < near]:
            chain.append(following[0])
            planes.remove(following[0])
        radii = np.hypot(*np.concatenate([p.low for p in chain])[:, :2].T)
        if np.abs(chain[0].low - chain[-1].high).max() < near and np.ptp(radii) < near:
            out.append(chain)
    return out


def corner_side(prism: Sequence[PrismFace]) -> MeridianSide:
    """The side of the cylinder through the edges of a prism."""
    radius = float(np.hypot(*prism[0].low[0, :2]))
    start, end = ((radius, float(z)) for z in prism[0].low[:, 2])
    return MeridianSide(start, end, name=prism[0].face.name)

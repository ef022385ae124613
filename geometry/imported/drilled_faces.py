"""Cylinders left by a drill, holes that are oblique or off the axis, and rounded mouths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from geometry.imported.sampled_face import FACE_TOLERANCE, Axis, SampledFace
from geometry.shape.features import outer_radius
from geometry.shape.hole import Hole
from geometry.shape.pin import Pin
from pinbase.arrays import Floats

# Largest deviation of a rounded mouth, relative to its radius; OpenCASCADE's mouths have 8e-4.
BLEND_TOLERANCE = 5e-3


@dataclass
class DrilledFaces:
    """A cylinder left by a drill, and the other faces of its hole.

    axis: axis of the cylinder; its point is the one nearest to the pin's axis.
    low, high: ends of the cylinder along the axis, from that point.
    faces: faces of revolution about the axis.
    """

    axis: Axis
    radius: float
    low: float
    high: float
    faces: list[SampledFace] = field(default_factory=list)

    def local(self, x: Floats) -> tuple[Floats, Floats]:
        """Distance from the axis and position along it, (P,) each, of points x (P, 3)."""
        arm = x - self.axis.point
        t = arm @ self.axis.along
        return np.linalg.norm(arm - t[:, None] * self.axis.along, axis=1), t


def near(size: float) -> float:
    """Distance within which two points coincide. size: size of the body."""
    return 10.0 * FACE_TOLERANCE * size


def cylinder(face: SampledFace, line: Axis, size: float) -> DrilledFaces | None:
    """The cylinder about a line of which a face is a part, or None. size: size of the body."""
    drilled = DrilledFaces(line, 0.0, 0.0, 0.0, [face])
    s, _ = drilled.local(face.points)
    if np.ptp(s) > FACE_TOLERANCE * size:
        return None
    t = drilled.local(face.rim)[1]
    drilled.radius = float(s.mean())
    drilled.low, drilled.high = float(t.min()), float(t.max())
    return drilled


def join(group: list[DrilledFaces], drilled: DrilledFaces, slack: float) -> None:
    """Add a cylinder to a group, or merge it with another part of the same cylinder in the group.

    slack: distance within which two points coincide.
    """
    for other in group:
        same = np.abs(other.axis.point - drilled.axis.point).max() < slack
        same &= np.abs(other.axis.along - drilled.axis.along).max() < FACE_TOLERANCE
        if same and abs(other.radius - drilled.radius) < slack:
            other.low, other.high = min(other.low, drilled.low), max(other.high, drilled.high)
            other.faces += drilled.faces
            return
    group.append(drilled)


def holes_aslant(faces: Sequence[SampledFace], size: float) -> list[Hole]:
    """The through holes whose faces are cylinders, oblique or off the pin's axis.

    Raises: ValueError with the name of the first face that is not such a cylinder.
    """
    cylinders: list[DrilledFaces] = []
    for face in faces:
        axis = face.axis(np.zeros(3), size)
        drilled = None if axis is None else cylinder(face, _nearest(axis), size)
        if drilled is None:
            raise ValueError(face.name)
        join(cylinders, drilled, near(size))
    out = []
    for c in cylinders:
        (x, y, z), d = c.axis.point, c.axis.along
        angle = math.atan2(d[1], d[0])
        offset, tilt = y * math.cos(angle) - x * math.sin(angle), math.asin(d[2])
        offset, tilt = offset * (abs(offset) > near(size)), tilt * (abs(tilt) > FACE_TOLERANCE)
        out.append(Hole(float(z), 2.0 * c.radius, angle, offset=offset, tilt=tilt))
    return out


def rounds_mouth(pin: Pin, face: SampledFace, holes: list[Hole]) -> bool:
    """Whether a face rounds a mouth of one of the holes; the hole then gets the face's radius.

    The test: the centre of a ball that rolls along the mouth's edge is as far from the pin's
    surface, within it, as from the wall of the hole.
    """
    for i, hole in enumerate(holes):
        a, outer = hole.diameter / 2.0, outer_radius(pin, hole.z)
        x = np.array([math.cos(hole.angle), math.sin(hole.angle), 0.0])
        arm = face.points - [0.0, 0.0, hole.z]
        arm = arm - (arm @ x)[:, None] * x
        height = np.sum(arm**2, axis=1) - a**2
        for normals in (face.normals, -face.normals):
            n = normals - (normals @ x)[:, None] * x
            # |arm - rho n| = a + rho is a quadratic equation for the radius.
            linear, square = a + np.sum(arm * n, axis=1), 1.0 - np.sum(n**2, axis=1)
            root = np.sqrt(np.maximum(linear**2 + square * height, 0.0))
            rho = height / np.maximum(linear + root, FACE_TOLERANCE * a)
            radius = float(f"{np.median(rho):.3g}")  # programs approximate such faces
            centre = (face.points - radius * normals)[:, :2]
            off = np.linalg.norm(centre, axis=1) - (outer - radius)
            slack = BLEND_TOLERANCE * radius
            if np.abs(rho - radius).max() < slack and np.abs(off).max() < slack:
                holes[i] = replace(hole, mouth_radius=radius)
                return True
    return False


def _nearest(axis: Axis) -> Axis:
    """An axis with its point nearest to the pin's axis; it points to positive x, or else y."""
    d = axis.along / np.linalg.norm(axis.along)
    across = float(d[:2] @ d[:2])
    t = -float(axis.point[:2] @ d[:2]) / max(across, FACE_TOLERANCE)
    x, y = (0.0 if abs(v) < FACE_TOLERANCE else v for v in d[:2])
    return Axis(axis.point + t * d, d * (-1.0 if x < 0.0 or (x == 0.0 and y < 0.0) else 1.0))

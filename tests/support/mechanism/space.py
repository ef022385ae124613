"""Small linkages in space and rotations for tests, independent of the core's equations."""

from __future__ import annotations

import numpy as np

from loads import GROUND
from loads.space.kinds import Kind
from loads.space.linkage import RigidBody, SpaceJoint, Vector
from pinbase.arrays import Floats

Matrix = tuple[Vector, Vector, Vector]


def vector(v: Floats) -> Vector:
    """Return a vector as a tuple."""
    x, y, z = (float(c) for c in v)
    return x, y, z


def unit(v: Vector) -> Vector:
    """Return the unit vector along v."""
    return vector(np.array(v) / np.linalg.norm(v))


def tensor(m: Floats) -> Matrix:
    """Return an inertia tensor as tuples."""
    return vector(m[0]), vector(m[1]), vector(m[2])


def turned(axis: Vector, angle: Floats | float, v: Vector) -> Floats:
    """Return a vector turned about an axis by Rodrigues' formula, (T, 3)."""
    e, p = np.array(unit(axis)), np.array(v)
    c, s = (f(np.atleast_1d(angle))[:, None] for f in (np.cos, np.sin))
    return np.asarray(p * c + np.cross(e, p) * s + e * float(e @ p) * (1.0 - c))


def about(axis: Vector, through: Vector, angle: Floats | float, point: Vector) -> Floats:
    """Return a point turned about an axis through another, (T, 3)."""
    return np.array(through) + turned(axis, angle, vector(np.subtract(point, through)))


def light(name: str, centre: Vector = (0.0, 0.0, 0.0)) -> RigidBody:
    """Return a body without mass."""
    return RigidBody(name, 0.0, centre)


def joint(name: str, kind: Kind, base: str, moving: str, at: Vector, *axes: Vector) -> SpaceJoint:
    """Return a joint, with its directions scaled to unit vectors."""
    first, second = ([unit(axis) for axis in axes] + [None, None])[:2]
    return SpaceJoint(name, kind, base, moving, at, first, second)


def grounded(name: str, kind: Kind, moving: str, at: Vector, *axes: Vector) -> SpaceJoint:
    """Return a joint of a body on the ground."""
    return joint(name, kind, GROUND, moving, at, *axes)

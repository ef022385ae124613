"""Bodies of machines as plain data, and the frames of Bennett's linkage."""

from __future__ import annotations

from typing import Any, TypedDict

import numpy as np

Vector = tuple[float, float, float]


class BodyData(TypedDict):
    """A rigid body: kg, m, and kg m^2 about its centre along world axes as drawn."""

    mass: float
    centre: Vector
    inertia: tuple[Vector, Vector, Vector]


def rod(mass: float, start: Vector, end: Vector, radius: float = 0.03) -> BodyData:
    """Return a solid cylinder between two points."""
    a, b = np.array(start), np.array(end)
    length = float(np.linalg.norm(b - a))
    e = (b - a) / length
    along, across = 0.5 * mass * radius**2, mass * (radius**2 / 4.0 + length**2 / 12.0)
    tensor = across * np.eye(3) + (along - across) * np.outer(e, e)
    return {"mass": mass, "centre": vector(0.5 * (a + b)), "inertia": _tensor(tensor)}


def block(mass: float, centre: Vector, moments: Vector, products: Vector) -> BodyData:
    """Return a body by its moments Ixx, Iyy, Izz and the entries xy, xz, yz of its tensor."""
    xy, xz, yz = products
    tensor = np.diag(moments) + np.array([[0, xy, xz], [xy, 0, yz], [xz, yz, 0]])
    return {"mass": mass, "centre": centre, "inertia": _tensor(tensor)}


def vector(v: Any) -> Vector:
    return float(v[0]), float(v[1]), float(v[2])


def _tensor(m: Any) -> tuple[Vector, Vector, Vector]:
    return vector(m[0]), vector(m[1]), vector(m[2])


def square(v: Vector, to: Vector) -> Vector:
    """Return the part of a vector that is perpendicular to another."""
    e = np.array(to) / np.linalg.norm(to)
    return vector(np.array(v) - float(np.dot(v, e)) * e)


def bennett_frames(a: float, b: float, alpha: float, beta: float, angle: float) -> tuple[Any, Any]:
    """Return points and axes (4, 3) of a Bennett linkage with links a, b, a, b of twists alpha,
    beta.

    angle: of the link a = p0 p1 about axis 0 from the link d = p0 p3, rad. The other angle follows
    from tan(angle / 2) tan(other / 2) = sin((beta + alpha) / 2) / sin((beta - alpha) / 2).
    """
    ratio = np.sin(0.5 * (beta + alpha)) / np.sin(0.5 * (beta - alpha))
    other = 2.0 * np.arctan(ratio / np.tan(0.5 * angle))
    frame = np.eye(4)
    points, axes = [], []
    turns, links = (angle, other, -angle, -other), ((a, alpha), (b, beta)) * 2
    for turn, (length, twist) in zip(turns, links, strict=True):
        points.append(frame[:3, 3].copy())
        axes.append(frame[:3, 2].copy())
        frame = frame @ _turn(2, turn) @ _shift(length) @ _turn(0, twist)
    return np.array(points), np.array(axes)


def _turn(axis: int, angle: float) -> Any:
    m, (i, j) = np.eye(4), [(1, 2), (2, 0), (0, 1)][axis]
    m[i, i] = m[j, j] = np.cos(angle)
    m[j, i] = np.sin(angle)
    m[i, j] = -m[j, i]
    return m


def _shift(x: float) -> Any:
    m = np.eye(4)
    m[0, 3] = x
    return m

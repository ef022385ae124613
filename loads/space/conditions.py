"""The elementary conditions of joints in space, with their derivatives, for all joints at once.

Three forms serve all joints and measured coordinates:

    points:  e . (P - Q) - x = 0, P a point of the moving body, Q of the base, e fixed in the base
             or the world, x the measured travel, if any;
    square:  L n . b = 0, b fixed in the moving body; n fixed in the base or, for a measured angle
             theta, n = a' cos(theta) - a sin(theta) with a, a' fixed in the base;
    spans:   |P - Q| - x = 0, x the measured distance.

Each condition has gradients by the displacements and rotations of its two bodies. Per unit of the
condition's multiplier, the gradient by displacements is the force on the body (N per N), and that
by rotations about world axes is the couple on the body about its centre of mass (N m per N).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loads.space.kinds import KINDS, Direction
from loads.space.linkage import (
    BodyAngle,
    JointAngle,
    JointTravel,
    PointDistance,
    SpaceJoint,
    SpaceLinkage,
    Vector,
    unit,
)
from pinbase.arrays import Floats, Ints


@dataclass(frozen=True)
class Rates:
    """Velocities of B bodies, the ground after them, at T instants.

    velocity: (T, B + 1, 3) velocities of the centres of mass, m/s.
    spin: (T, B + 1, 3) angular velocities, world axes, rad/s.
    measured: (T, M) rates of the measured coordinates, rad/s or m/s.
    """

    velocity: Floats
    spin: Floats
    measured: Floats


@dataclass(frozen=True)
class Gradients:
    """Derivatives of R conditions at T instants; T comes last.

    base_force, moving_force: (R, 3, T) derivatives by displacements of the base and moving body.
    base_couple, moving_couple: (R, 3, T) derivatives by their rotations about world axes, m.
    measured: (R, T) derivatives by the measured coordinate, m per rad or m per m.
    """

    base_force: Floats
    base_couple: Floats
    moving_force: Floats
    moving_couple: Floats
    measured: Floats


@dataclass(frozen=True)
class ConditionRows:
    """The conditions of a linkage as arrays over R rows: points, square, then spans.

    names: (R,) names of the joints or measured coordinates to which the rows belong.
    base, moving: (R,) numbers of the two bodies.
    measured: (R,) number of the measured coordinate, or -1.
    base_point, moving_point: (R, 3) points Q and P of points and spans, m, from the centres of mass
    as drawn.
    first: (R, 3) as drawn: e of points; n, or for an angle a', of square.
    second: (R, 3) as drawn: a of an angle.
    other: (R, 3) as drawn: b of square.
    turns: (R,) 1 where e turns with the base, 0 where it is fixed in the world.
    points, square: number of rows of these forms.
    length: length scale L, m, which makes cosines comparable to lengths.
    drawn: (R,) distances of spans as drawn, m.
    """

    names: tuple[str, ...]
    base: Ints
    moving: Ints
    measured: Ints
    base_point: Floats
    moving_point: Floats
    first: Floats
    second: Floats
    other: Floats
    turns: Floats
    points: int
    square: int
    length: float
    drawn: Floats

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.names)

    def at(self, centre: Floats, rotation: Floats, measured: Floats) -> Quantities:
        """The vectors of all rows at a position.

        centre: (T, B + 1, 3) m. rotation: (T, B + 1, 3, 3). measured: (T, M) rad or m.
        """
        return Quantities(self, centre, rotation, measured)


class Quantities:
    """The vectors of all conditions at T instants; arrays are (R, 3, T), by form."""

    def __init__(
        self, rows: ConditionRows, centre: Floats, rotation: Floats, measured: Floats
    ) -> None:
        self.rows = rows
        n, m = rows.points, rows.points + rows.square
        R = np.moveaxis(rotation, 0, -1)  # (B + 1, 3, 3, T)
        value = np.zeros((rows.count, len(centre)))
        has = rows.measured >= 0
        value[has] = measured.T[rows.measured[has]]
        self.value = value
        # Points and spans: the arms from the centres of mass, and the vector between the points.
        point_rows = np.r_[0:n, m : rows.count]
        base, moving = rows.base[point_rows], rows.moving[point_rows]
        self.base_arm = _turned(R[base], rows.base_point[point_rows])
        self.moving_arm = _turned(R[moving], rows.moving_point[point_rows])
        place = np.moveaxis(centre, 0, -1)
        self.between = place[moving] + self.moving_arm - place[base] - self.base_arm
        e = _turned(R[rows.base[:n]], rows.first[:n])
        still = rows.turns[:n, None, None]
        self.e = still * e + (1.0 - still) * rows.first[:n, :, None]
        # Square: n = a' cos(theta) - a sin(theta), m = -dn / d theta, and b.
        angle = value[n:m, None]
        first = _turned(R[rows.base[n:m]], rows.first[n:m])
        second = _turned(R[rows.base[n:m]], rows.second[n:m])
        self.n = np.cos(angle) * first - np.sin(angle) * second
        self.m = np.sin(angle) * first + np.cos(angle) * second
        self.b = _turned(R[rows.moving[n:m]], rows.other[n:m])

    @cached_property
    def distance(self) -> Floats:
        """Distances of the spans, (spans, T) m."""
        return np.asarray(np.sqrt(np.sum(self.between[self.rows.points :] ** 2, axis=1)))

    @cached_property
    def along(self) -> Floats:
        """Unit vectors of the spans, (spans, 3, T)."""
        return np.asarray(self.between[self.rows.points :] / self.distance[:, None])

    @property
    def values(self) -> Floats:
        """Violation of every condition, (T, R) m."""
        rows, n = self.rows, self.rows.points
        m = n + rows.square
        points = _dot(self.e, self.between[:n]) - self.value[:n]
        square = rows.length * _dot(self.n, self.b)
        spans = self.distance - rows.drawn[m:, None] - self.value[m:]
        return np.concatenate([points, square, spans]).T

    @property
    def gradients(self) -> Gradients:
        """Derivatives of every condition."""
        rows, n = self.rows, self.rows.points
        m = n + rows.square
        L = rows.length
        direction = np.concatenate([self.e, self.along])
        # A rotation of the base also turns e relative to the vector between the points.
        turned = _cross(self.e, self.between[:n]) * rows.turns[:n, None, None]
        on_base = -_cross(self.base_arm, direction)
        on_base[:n] += turned
        on_moving = _cross(self.moving_arm, direction)
        square = L * _cross(self.n, self.b)
        zero = np.zeros_like(square)

        def placed(apart: Floats, between: Floats) -> Floats:
            return np.concatenate([apart[:n], between, apart[n:]])

        by_measured = np.zeros_like(self.value)
        by_measured[:n] = -1.0
        by_measured[n:m] = -L * _dot(self.m, self.b)
        by_measured[m:] = -1.0
        by_measured[rows.measured < 0] = 0.0
        return Gradients(
            base_force=placed(-direction, zero),
            base_couple=placed(on_base, square),
            moving_force=placed(direction, zero),
            moving_couple=placed(on_moving, -square),
            measured=by_measured,
        )

    def quadratic(self, rates: Rates) -> Floats:
        """Parts of the second derivatives that are quadratic in the rates, (T, R) m/s^2."""
        rows, n = self.rows, self.rows.points
        m = n + rows.square
        point_rows = np.r_[0:n, m : rows.count]
        spin, velocity = np.moveaxis(rates.spin, 0, -1), np.moveaxis(rates.velocity, 0, -1)
        of_base, of_moving = spin[rows.base[point_rows]], spin[rows.moving[point_rows]]
        base_speed = _cross(of_base, self.base_arm)
        moving_speed = _cross(of_moving, self.moving_arm)
        speed = velocity[rows.moving[point_rows]] + moving_speed
        speed = speed - velocity[rows.base[point_rows]] - base_speed
        bend = _cross(of_moving, moving_speed) - _cross(of_base, base_speed)
        e_rate = _cross(of_base[:n], self.e) * rows.turns[:n, None, None]
        points = _dot(self.e, bend[:n]) + 2.0 * _dot(e_rate, speed[:n])
        points += _dot(_cross(of_base[:n], e_rate), self.between[:n])
        square = self._square_bend(rates, spin[rows.base[n:m]], spin[rows.moving[n:m]])
        across = _dot(speed[n:], speed[n:]) - _dot(self.along, speed[n:]) ** 2
        spans = _dot(self.along, bend[n:]) + across / self.distance
        return np.concatenate([points, square, spans]).T

    def _square_bend(self, rates: Rates, of_base: Floats, of_moving: Floats) -> Floats:
        """The quadratic parts of the square rows, (square, T) m/s^2.

        of_base, of_moving: (square, 3, T) angular velocities of the two bodies, rad/s.
        """
        rows, n = self.rows, self.rows.points
        which = rows.measured[n : n + rows.square]
        rate = (
            np.where(which[:, None] >= 0, rates.measured.T[which], 0.0)
            if len(rates.measured.T)
            else np.zeros((len(which), len(rates.measured)))
        )
        n_rate, b_rate = _cross(of_base, self.n), _cross(of_moving, self.b)
        out = 2.0 * _dot(n_rate, b_rate)
        out += _dot(_cross(of_base, n_rate), self.b) + _dot(self.n, _cross(of_moving, b_rate))
        turning = _dot(_cross(of_base, self.m), self.b) + _dot(self.m, b_rate)
        out -= 2.0 * rate * turning + rate**2 * _dot(self.n, self.b)
        return np.asarray(rows.length * out)


def rows_of(linkage: SpaceLinkage) -> ConditionRows:
    """The conditions of all joints, then of all measured coordinates, of a linkage."""
    points, square, spans = list[_Row](), list[_Row](), list[_Row]()
    for joint in linkage.joints:
        kind, frame = KINDS[joint.kind], axes_of(joint)
        if kind.meets:
            points += [_point(linkage, joint, e, 0.0) for e in np.eye(3)]
        points += [_point(linkage, joint, frame[key], 1.0) for key in kind.along]
        square += [_square(joint, frame[a], frame[b]) for a, b in kind.square]
    for k, m in enumerate(linkage.measured):
        if isinstance(m, PointDistance):
            spans.append(_span(linkage, m, k))
            continue
        if isinstance(m, BodyAngle):
            square.append(_angle(m.name, m.base, m.moving, directions(m.axis), k))
            continue
        joint = linkage.joint(m.joint)
        frame = axes_of(joint)
        if isinstance(m, JointTravel):
            points.append(_point(linkage, joint, frame["w"], 1.0, m.name, k))
        else:
            assert isinstance(m, JointAngle)
            square.append(_angle(m.name, joint.base, joint.moving, frame, k))
    rows = [*points, *square, *spans]

    def column(key: str) -> Floats:
        shape = (len(rows), 3) if np.ndim(getattr(rows[0], key)) else (len(rows),)
        return np.array([getattr(row, key) for row in rows]).reshape(shape)

    return ConditionRows(
        names=tuple(row.name for row in rows),
        base=np.array([linkage.index[row.base] for row in rows], dtype=np.int64),
        moving=np.array([linkage.index[row.moving] for row in rows], dtype=np.int64),
        measured=np.array([row.measured for row in rows], dtype=np.int64),
        **{key: column(key) for key in _ARRAYS},
        points=len(points),
        square=len(square),
        length=linkage.length_scale,
    )


_ARRAYS = ("base_point", "moving_point", "first", "second", "other", "turns", "drawn")
_NONE = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class _Row:
    """One condition; its fields are those of `ConditionRows`."""

    name: str
    base: str
    moving: str
    measured: int = -1
    base_point: Floats | Vector = _NONE
    moving_point: Floats | Vector = _NONE
    first: Floats | Vector = _NONE
    second: Floats | Vector = _NONE
    other: Floats | Vector = _NONE
    turns: float = 1.0
    drawn: float = 0.0


def axes_of(joint: SpaceJoint) -> dict[Direction, Floats]:
    """Unit vectors (3,) of a joint as drawn: those of `directions`, and its second axis."""
    frame = directions((0.0, 0.0, 1.0) if joint.axis is None else joint.axis)
    second = frame["w"] if joint.second_axis is None else unit(joint.second_axis)
    return frame | {"second": second}


def directions(axis: Vector) -> dict[Direction, Floats]:
    """Unit vectors u, v and w, right-handed, with w along an axis, (3,) each.

    u is perpendicular to the axis and as near as possible to the world's x axis; if the axis is
    along x, to the y axis.
    """
    w = unit(axis)
    near = np.eye(3)[0] if abs(w[0]) < MAX_COSINE_TO_X else np.eye(3)[1]
    u = near - (near @ w) * w
    u /= np.linalg.norm(u)
    return {"u": u, "v": np.cross(w, u), "w": w}


MAX_COSINE_TO_X = math.cos(math.radians(1.0))  # an axis closer to x has its u from the y axis


def _arm(linkage: SpaceLinkage, body: str, at: Floats) -> Floats:
    """Vector (3,) from a body's centre of mass, or the origin, to a point, as drawn."""
    k = linkage.index[body]
    centre = linkage.bodies[k].centre if k < len(linkage.bodies) else (0.0, 0.0, 0.0)
    return np.asarray(at - np.array(centre))


def _point(
    linkage: SpaceLinkage, joint: SpaceJoint, e: Floats, turns: float, name: str = "", k: int = -1
) -> _Row:
    at = np.array(joint.at)
    arms = (_arm(linkage, joint.base, at), _arm(linkage, joint.moving, at))
    return _Row(name or joint.name, joint.base, joint.moving, k, *arms, first=e, turns=turns)


def _square(joint: SpaceJoint, a: Floats, b: Floats) -> _Row:
    return _Row(joint.name, joint.base, joint.moving, first=a, other=b)


def _angle(name: str, base: str, moving: str, frame: dict[Direction, Floats], k: int) -> _Row:
    u, v = frame["u"], frame["v"]
    return _Row(name, base, moving, k, first=v, second=u, other=u)


def _span(linkage: SpaceLinkage, span: PointDistance, k: int) -> _Row:
    (base, moving), (start, end) = span.bodies, map(np.array, span.ends)
    arms = (_arm(linkage, base, start), _arm(linkage, moving, end))
    return _Row(span.name, base, moving, k, *arms, drawn=span.drawn)


def _turned(rotation: Floats, vector: Floats) -> Floats:
    """Vectors (R, 3, T) from rotations (R, 3, 3, T) of vectors (R, 3)."""
    return np.asarray(np.einsum("rijt,rj->rit", rotation, vector))


def _dot(a: Floats, b: Floats) -> Floats:
    """Scalar products (R, T) of vectors (R, 3, T)."""
    return np.asarray(np.einsum("rit,rit->rt", a, b))


def _cross(a: Floats, b: Floats) -> Floats:
    """Vector products (R, 3, T) of vectors (R, 3, T)."""
    x, y, z = np.moveaxis(a, 1, 0)
    u, v, w = np.moveaxis(b, 1, 0)
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1)

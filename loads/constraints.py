"""Constraint equations of a planar linkage, for any number of instants at once.

Every connection holds a point of its body to the pin (two rows), every slider keeps its two bodies
parallel and in line (two rows), and the drive prescribes the driven slider's length (one row, the
last). Coordinates are the centre (x, y) and the angle from the drawn position of every item, the
angle times a typical length so that all columns are lengths; particles have no angle. The
multipliers of these equations are the forces of the connections themselves, which is why nothing is
eliminated. Source: Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems
(1989), ch. 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.linkage import GROUND, Floats, Linkage


def rotated(angle: Floats, vector: Floats) -> Floats:
    """`vector` (..., 2) turned by `angle` (...)."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = vector[..., 0], vector[..., 1]
    return np.stack([c * x - s * y, s * x + c * y], axis=-1)


def turned(vector: Floats) -> Floats:
    """`vector` (..., 2) turned by +90 degrees."""
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)


@dataclass(frozen=True)
class Constraints:
    """The equations of one linkage.

    State arrays are (T, items + ground, 3): x, y (m), angle (rad).
    """

    linkage: Linkage
    first: np.ndarray  # (P,) item on whose body the point lies
    second: np.ndarray  # (P,) item that carries the pin
    first_arm: Floats  # (P, 2) from the item's centre to the point, as drawn, m
    second_arm: Floats  # (P, 2)
    base: np.ndarray  # (S,) items of the sliders
    moving: np.ndarray  # (S,)
    base_arm: Floats  # (S, 2)
    moving_arm: Floats  # (S, 2)
    direction: Floats  # (S, 2) unit vector from start to end, as drawn
    driven: int  # which slider
    free: np.ndarray  # (3 * (items + ground),) columns that are coordinates

    @property
    def rows(self) -> int:
        """Number of equations."""
        return 2 * len(self.first) + 2 * len(self.base) + 1

    @property
    def columns(self) -> int:
        """Number of coordinates."""
        return int(self.free.sum())

    def drawn(self) -> Floats:
        """The state as drawn, (items + ground, 3)."""
        centres = [(*item.centre, 0.0) for item in self.linkage.items]
        return np.array([*centres, (0.0, 0.0, 0.0)])

    def _points(self, q: Floats, item: np.ndarray, arm: Floats) -> tuple[Floats, Floats]:
        """World position of points and their arms in world axes, both (T, N, 2)."""
        world_arm = rotated(q[:, item, 2], arm[None])
        return q[:, item, :2] + world_arm, world_arm

    def residual(self, q: Floats, length: Floats) -> Floats:
        """Violation of every equation, (T, rows), m; `length` (T,) of the driven slider."""
        scale = self.linkage.length_scale
        p1, _ = self._points(q, self.first, self.first_arm)
        p2, _ = self._points(q, self.second, self.second_arm)
        s1, _ = self._points(q, self.base, self.base_arm)
        s2, _ = self._points(q, self.moving, self.moving_arm)
        e = rotated(q[:, self.base, 2], self.direction[None])
        d = s2 - s1
        across = np.sum(turned(e) * d, axis=-1)
        tilt = scale * (q[:, self.moving, 2] - q[:, self.base, 2])
        along = np.sum(e * d, axis=-1)[:, self.driven] - length
        holds = (p1 - p2).reshape(len(q), -1)
        return np.concatenate([holds, across, tilt, along[:, None]], axis=1)

    def jacobian(self, q: Floats) -> Floats:
        """Derivative of the residual by the coordinates, (T, rows, columns), no unit."""
        n_t, n_items = q.shape[:2]
        scale = self.linkage.length_scale
        J = np.zeros((n_t, self.rows, n_items, 3))
        for item, arm, sign in (
            (self.first, self.first_arm, 1.0),
            (self.second, self.second_arm, -1.0),
        ):
            _, world = self._points(q, item, arm)
            k = np.arange(len(item))
            J[:, 2 * k, item, 0] += sign
            J[:, 2 * k + 1, item, 1] += sign
            lever = sign * turned(world) / scale
            J[:, 2 * k, item, 2] += lever[..., 0]
            J[:, 2 * k + 1, item, 2] += lever[..., 1]
        s1, arm1 = self._points(q, self.base, self.base_arm)
        s2, arm2 = self._points(q, self.moving, self.moving_arm)
        e = rotated(q[:, self.base, 2], self.direction[None])
        n = turned(e)
        d = s2 - s1
        i = np.arange(len(self.base))
        row = 2 * len(self.first) + i
        self._slide(J, row, n, -e, d, arm1, arm2, i)
        row = row + len(self.base)
        J[:, row, self.moving, 2] += 1.0
        J[:, row, self.base, 2] -= 1.0
        self._slide(J, np.array([self.rows - 1]), e, n, d, arm1, arm2, np.array([self.driven]))
        return J.reshape(n_t, self.rows, -1)[:, :, self.free]

    def _slide(
        self,
        J: Floats,
        row: np.ndarray,
        axis: Floats,
        axis_rate: Floats,
        d: Floats,
        arm1: Floats,
        arm2: Floats,
        i: np.ndarray,
    ) -> None:
        """Rows of axis . (s2 - s1), the axis turns with the base by `axis_rate` per radian."""
        scale = self.linkage.length_scale
        base, moving = self.base[i], self.moving[i]
        axis, axis_rate, d, arm1, arm2 = (v[:, i] for v in (axis, axis_rate, d, arm1, arm2))
        for component in (0, 1):
            J[:, row, moving, component] += axis[..., component]
            J[:, row, base, component] -= axis[..., component]
        J[:, row, moving, 2] += np.sum(axis * turned(arm2), axis=-1) / scale
        lever = np.sum(axis_rate * d, axis=-1) - np.sum(axis * turned(arm1), axis=-1)
        J[:, row, base, 2] += lever / scale

    def acceleration_terms(self, q: Floats, v: Floats) -> Floats:
        """The part of each equation's second rate that is quadratic in the velocity, (T, rows)."""
        w = v[..., 2]
        quadratic = []
        for item, arm in ((self.first, self.first_arm), (self.second, self.second_arm)):
            _, world = self._points(q, item, arm)
            quadratic.append(-(w[:, item, None] ** 2) * world)
        holds = (quadratic[0] - quadratic[1]).reshape(len(q), -1)
        s1, arm1 = self._points(q, self.base, self.base_arm)
        s2, arm2 = self._points(q, self.moving, self.moving_arm)
        w1, w2 = w[:, self.base, None], w[:, self.moving, None]
        d = s2 - s1
        d_rate = v[:, self.moving, :2] + w2 * turned(arm2) - v[:, self.base, :2] - w1 * turned(arm1)
        d_second = -(w2**2) * arm2 + w1**2 * arm1
        e = rotated(q[:, self.base, 2], self.direction[None])
        n = turned(e)
        across = np.sum(-(w1**2) * n * d - 2.0 * w1 * e * d_rate + n * d_second, axis=-1)
        along = np.sum(-(w1**2) * e * d + 2.0 * w1 * n * d_rate + e * d_second, axis=-1)
        tilt = np.zeros_like(across)
        return np.concatenate([holds, across, tilt, along[:, self.driven, None]], axis=1)

    def spread(self, x: Floats) -> Floats:
        """Coordinates (T, columns) in m as a state increment (T, items + ground, 3)."""
        flat = np.zeros((len(x), len(self.free)))
        flat[:, self.free] = x
        full: Floats = flat.reshape(len(x), -1, 3)
        full[..., 2] /= self.linkage.length_scale
        return full

    def gather(self, force: Floats) -> Floats:
        """Forces and couples (T, items + ground, 3) in N and N m as (T, columns) in N."""
        scaled = force.copy()
        scaled[..., 2] /= self.linkage.length_scale
        return scaled.reshape(len(force), -1)[:, self.free]


def constraints(linkage: Linkage) -> Constraints:
    """The constraint equations of a linkage."""
    index, items = linkage.index, linkage.items
    centre = np.array([item.centre for item in items] + [(0.0, 0.0)])
    first = np.array([index[c.body] for _, c in linkage.connections])
    second = np.array([index[linkage.carrier(j)] for j, _ in linkage.connections])
    at = np.array([j.at for j, _ in linkage.connections])
    base = np.array([index[s.base] for s in linkage.sliders])
    moving = np.array([index[s.moving] for s in linkage.sliders])
    start = np.array([s.start for s in linkage.sliders])
    end = np.array([s.end for s in linkage.sliders])
    free = np.ones((len(items) + 1, 3), dtype=bool)
    free[[i for i, item in enumerate(items) if item.inertia is None], 2] = False
    free[index[GROUND]] = False
    return Constraints(
        linkage=linkage,
        first=first,
        second=second,
        first_arm=at - centre[first],
        second_arm=at - centre[second],
        base=base,
        moving=moving,
        base_arm=start - centre[base],
        moving_arm=end - centre[moving],
        direction=(end - start) / np.linalg.norm(end - start, axis=1, keepdims=True),
        driven=[s.name for s in linkage.sliders].index(linkage.driven),
        free=free.ravel(),
    )

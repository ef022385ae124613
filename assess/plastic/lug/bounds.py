"""Bounds of the limit load of a plane body in plane strain: cone programs on triangles.

*Lower bound.* The stress is linear in each triangle. It is in equilibrium inside the triangles,
across every edge and with the tractions on the boundary, and nowhere exceeds yield; because the
yield condition is convex, it need only be imposed at the corners. By the static theorem the load is
a strict lower bound for the body of these triangles.

*Upper bound.* The velocity is quadratic in each triangle, and its strain rate is linear. If the
volume does not change at the corners, it changes nowhere. The work of flow is a convex function, so
it is at most that computed from the values at the corners. By the kinematic theorem the result is a
strict upper bound, and there is no locking.

A rigid, frictionless pin presses on the edges "bore" and may separate from them: pressures are not
negative, and no point of an edge penetrates the pin. For the latter it suffices that the three
control points of the edge's quadratic velocity do not.

Source: A. V. Lyamin, S. W. Sloan, Int. J. Num. Meth. Eng. 55 (2002) 573; A. Makrodimopoulos, C. M.
Martin, Int. J. Num. Anal. Meth. Geomech. 31 (2007) 835.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from assess.plastic.lug.cone_program import ConeProgram
from assess.plastic.lug.mesh import PlaneMesh
from pinbase.arrays import Floats, Ints

# Edges by name: "bore" is loaded by a normal pressure, "axis" are planes of symmetry along x or y,
# "held" is fixed, "free" has no load.


def lower_program(mesh: PlaneMesh, motion: Floats) -> ConeProgram:
    """Return the cone program of a lower bound.

    motion: velocity of the pressing body, (2,), or (E, 2) for each pressed edge. The value of the
    program is the power of the pressures on this velocity.
    """
    count = len(mesh.triangles)
    gradients, area = mesh.gradients()
    rows = _Rows(3 * count)
    point = np.arange(3 * count).reshape(count, 3)
    # Equilibrium in each triangle, times the root of its area, so that all rows have similar size.
    scaled = gradients * np.sqrt(area)[:, None, None]
    rows.add_stress(point, scaled[..., 0], scaled[..., 1], 0)
    rows.add_stress(point, scaled[..., 0], scaled[..., 1], 1)
    sides = _Sides(mesh)
    for end in (0, 1):
        left, right = sides.inner[:, 0, end], sides.inner[:, 1, end]
        n = sides.inner_normal
        for component in (0, 1):
            both = np.stack([left, right], axis=1)
            sign = np.array([1.0, -1.0])
            rows.add_stress(both, n[:, :1] * sign, n[:, 1:] * sign, component)
    loads: list[Floats] = []
    for name, edges in mesh.edges.items():
        points, n = sides.outer(edges)
        tangent = np.stack([-n[:, 1], n[:, 0]], axis=1)
        for end in (0, 1):
            at = points[:, end : end + 1]
            if name == "free":
                rows.add_stress(at, n[:, :1], n[:, 1:], 0)
                rows.add_stress(at, n[:, :1], n[:, 1:], 1)
            elif name in ("axis", "bore"):
                rows.add_traction(at, n, tangent)
            if name == "bore":
                rows.add_traction(at, n, n, pressed=True)
                length = np.linalg.norm(np.diff(mesh.nodes[edges], axis=1)[:, 0], axis=1)
                loads.append(-(n * motion).sum(axis=1) * length / 2.0)
    return rows.program(np.concatenate(loads))


def upper_program(mesh: PlaneMesh, motion: Floats) -> ConeProgram:
    """Return the cone program of an upper bound; arguments as for `lower_program`."""
    space = QuadraticNodes(mesh)
    x, y = space.gradients(np.eye(3))  # (M, 3 points, 6 nodes), at the corners
    area = mesh.gradients()[1]
    weight = (area / 3.0)[:, None, None]
    free = np.full(2 * space.count, True)
    for name, edges in mesh.edges.items():
        nodes = space.of_edges(edges).ravel()
        if name == "held":
            free[2 * nodes] = free[2 * nodes + 1] = False
        elif name == "axis":
            across = np.abs(_Sides(mesh).outer(edges)[1]).argmax(axis=1)
            free[2 * nodes.reshape(-1, 3) + across[:, None]] = False
    number = np.where(free, np.cumsum(free) - 1, -1)
    count = 3 * len(area)
    column = np.repeat(np.arange(count).reshape(-1, 3, 1), 6, axis=2)
    dof = np.broadcast_to(2 * space.numbers[:, None], column.shape)

    def matrix(along_x: Floats, along_y: Floats) -> sp.csr_matrix:
        row = np.concatenate([dof.ravel(), dof.ravel() + 1])
        data = np.concatenate([(along_x * weight).ravel(), (along_y * weight).ravel()])
        columns = np.concatenate([column.ravel()] * 2)
        return _free_rows(data, row, columns, number, count)

    edges = mesh.edges["bore"]
    nodes, n = space.of_edges(edges), _Sides(mesh).outer(edges)[1]
    # Control values of a quadratic: the end values, and twice the middle value less the mean of the
    # end values.
    controls = np.array([[1.0, 0.0, 0.0], [-0.5, -0.5, 2.0], [0.0, 1.0, 0.0]])
    data = controls[None, :, :, None] * n[:, None, None, :]
    load = np.arange(3 * len(edges)).reshape(-1, 3)
    row = 2 * nodes[:, None, :, None] + np.arange(2) + np.zeros((1, 3, 1, 1), dtype=np.int64)
    loads = _free_rows(
        data.ravel(),
        row.ravel(),
        np.broadcast_to(load[:, :, None, None], data.shape).ravel(),
        number,
        load.size,
    )
    gain = np.repeat(-(n * motion).sum(axis=1), 3)
    return ConeProgram(matrix(x, y), matrix(x, -y), matrix(y, x), loads, gain)


class QuadraticNodes:
    """The nodes of quadratic triangles on a mesh: the nodes of the mesh, then the midside nodes.

    numbers: (M, 6) corners, then the midside nodes of the sides from 0 to 1, 1 to 2, 2 to 0.
    """

    def __init__(self, mesh: PlaneMesh) -> None:
        self.mesh = mesh
        sides = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        self.sides, place = np.unique(sides, axis=0, return_inverse=True)
        middles = len(mesh.nodes) + place.reshape(-1, 3)
        self.numbers: Ints = np.concatenate([mesh.triangles, middles], axis=1)
        self.count: int = len(mesh.nodes) + len(self.sides)

    def of_edges(self, edges: Ints) -> Ints:
        """Return the nodes (E, 3) of edges: both ends, then the midside node."""
        span = len(self.mesh.nodes)
        key = self.sides[:, 0] * span + self.sides[:, 1]
        ends = np.sort(edges, axis=1)
        middle = span + np.searchsorted(key, ends[:, 0] * span + ends[:, 1])
        return np.concatenate([edges, middle[:, None]], axis=1)

    def gradients(self, places: Floats) -> tuple[Floats, Floats]:
        """Return the x and y derivatives of the shape functions, (M, Q, 6) each.

        places: (Q, 3) in area coordinates.
        """
        corner = self.mesh.gradients()[0]
        # Corner i: L (2 L - 1); middle of i, j: 4 Li Lj.
        slope = np.zeros((len(places), 6, 3))
        for i in range(3):
            slope[:, i, i] = 4.0 * places[:, i] - 1.0
            j = (i + 1) % 3
            slope[:, 3 + i, i], slope[:, 3 + i, j] = 4.0 * places[:, j], 4.0 * places[:, i]
        out = np.einsum("qki,mia->amqk", slope, corner, optimize=True)
        return out[0], out[1]


class _Sides:
    """The sides of the triangles, with the number of the stress point at each of their ends."""

    def __init__(self, mesh: PlaneMesh) -> None:
        pairs = np.array([[0, 1], [1, 2], [2, 0]])
        nodes = mesh.triangles[:, pairs].reshape(-1, 2)
        points = (3 * np.arange(len(mesh.triangles))[:, None, None] + pairs).reshape(-1, 2)
        key = np.sort(nodes, axis=1) @ np.array([len(mesh.nodes), 1])
        order = np.argsort(key, kind="stable")
        same = np.flatnonzero(np.diff(key[order]) == 0)
        first, second = order[same], order[same + 1]
        # Both triangles are counter-clockwise, so the second has the ends of the side in reverse
        # order.
        self.inner = np.stack([points[first], points[second][:, ::-1]], axis=1)
        self.inner_normal = _normals(mesh.nodes[nodes[first]])
        self._mesh = mesh
        self._lookup = {tuple(n): i for i, n in enumerate(nodes.tolist())}
        self._points = points

    def outer(self, edges: Ints) -> tuple[Ints, Floats]:
        """Return the stress points (E, 2) at the ends of boundary edges, and the outward normals of
        these edges (E, 2).
        """
        at = [self._lookup[tuple(e)] for e in edges.tolist()]
        return self._points[at], _normals(self._mesh.nodes[edges])


def _normals(ends: Floats) -> Floats:
    along = ends[:, 1] - ends[:, 0]
    turned = np.stack([along[:, 1], -along[:, 0]], axis=1)
    return np.asarray(turned / np.linalg.norm(turned, axis=1)[:, None])


class _Rows:
    """The rows of the program of a lower bound, which are added one group at a time."""

    def __init__(self, points: int) -> None:
        self.points, self.count, self.loads = points, 0, 0
        self.entries: dict[str, list[tuple[Floats, Ints, Ints]]] = {k: [] for k in "pqtc"}

    def add_stress(self, points: Ints, x: Floats, y: Floats, component: int) -> None:
        """Add E rows: the sum over points (E, J) of x sxx + y sxy (component 0), or of
        x sxy + y syy (component 1).
        """
        row = self._more(points)
        first = component == 0
        parts = {"p": x, "q": x, "t": y} if first else {"p": y, "q": -y, "t": x}
        for name, values in parts.items():
            self.entries[name].append((np.broadcast_to(values, points.shape), row, points))

    def add_traction(self, points: Ints, n: Floats, along: Floats, pressed: bool = False) -> None:
        """Add E rows: the traction along a direction (E, 2) on edges with normals n (E, 2), plus an
        unknown pressure for each row if `pressed`.
        """
        row = self._more(points)
        (a, b), (c, d) = n.T, along.T
        parts = {"p": a * c + b * d, "q": a * c - b * d, "t": a * d + b * c}
        for name, values in parts.items():
            self.entries[name].append((values[:, None], row, points))
        if pressed:
            new = self.loads + np.arange(len(points))[:, None]
            self.entries["c"].append((np.ones((len(points), 1)), row, new))
            self.loads += len(points)

    def program(self, gain: Floats) -> ConeProgram:
        """Return the program of these rows; gain: (L,) as in `ConeProgram`."""
        p, q, t, c = (self._matrix(k) for k in "pqtc")
        return ConeProgram(p, q, t, c, gain)

    def _more(self, points: Ints) -> Ints:
        row = self.count + np.repeat(np.arange(len(points))[:, None], points.shape[1], axis=1)
        self.count += len(points)
        return row

    def _matrix(self, name: str) -> sp.csr_matrix:
        data, row, column = (
            np.concatenate([np.ravel(e[i]) for e in self.entries[name]]) for i in range(3)
        )
        width = self.loads if name == "c" else self.points
        return sp.csr_matrix((data, (row, column)), shape=(self.count, width))


def _free_rows(data: Floats, row: Ints, column: Ints, number: Ints, width: int) -> sp.csr_matrix:
    there = number[row] >= 0
    shape = int(number.max()) + 1, width
    return sp.csr_matrix((data[there], (number[row[there]], column[there])), shape=shape)

"""The outline of a section's mesh: loads on it, and its normals for the recovery of stresses."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from fea.section import Floats, Ints, Section, around
from fea.surface import Surface
from fea.tractions import Traction

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_ENDS_AND_MIDDLE = np.array([-1.0, 1.0, 0.0])


def shapes(x: Floats) -> Floats:
    """Quadratic functions of an edge (ends, middle) at x (Q,) from -1 to 1, (Q, 3)."""
    return np.stack([x * (x - 1.0) / 2.0, x * (x + 1.0) / 2.0, 1.0 - x * x], axis=1)


def slopes(x: Floats) -> Floats:
    """Their derivatives, (Q, 3)."""
    return np.stack([x - 0.5, x + 0.5, -2.0 * x], axis=1)


class Outline:
    """All edges of the outline off the axis: nodes (E, 3), ends and middle, each counter-clockwise;
    after: (E,) which edge follows each, -1 at the axis.
    """

    def __init__(self, space: Section) -> None:
        edges = space.section.edges
        self._nodes = space.nodes
        self.nodes: Ints = np.concatenate(list(edges.values()))
        self.after = _after(self.nodes)
        ends = np.cumsum([len(found) for found in edges.values()])
        self.rows = {
            name: np.arange(end - len(found), end)
            for (name, found), end in zip(edges.items(), ends, strict=True)
        }

    def held(self, surfaces: tuple[str, ...]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """(E,) which edges are on one of the surfaces."""
        out = np.zeros(len(self.nodes), dtype=bool)
        for name in surfaces:
            out[self.rows[name]] = True
        return out

    @cached_property
    def surface(self) -> Surface:
        """Nodes and normals, in axes r, theta, z."""
        x = self._nodes[self.nodes]
        tangent = np.einsum("qi,eia->eqa", slopes(_ENDS_AND_MIDDLE), x)
        normals = np.stack([tangent[..., 1], 0.0 * tangent[..., 0], -tangent[..., 0]], axis=2)
        normals /= np.linalg.norm(normals, axis=2, keepdims=True)
        return Surface(np.unique(self.nodes), np.arange(len(self.nodes)), self.nodes, normals)

    def traction(self, parts: tuple[Traction, ...]) -> Floats:
        """Amplitudes at the nodes of all edges, (E, 3, 3)."""
        out = np.zeros((*self.nodes.shape, 3))
        for part in parts:
            rows = self.rows[part.surface]
            out[rows] += part.at(self._nodes[self.nodes[rows], 1])
        return out

    def forces(self, parts: tuple[Traction, ...], n: int) -> Floats:
        """Nodal forces (N, 3) along r, theta and z of tractions of harmonic n."""
        out = np.zeros((len(self._nodes), 3))
        values = shapes(_POINTS)
        for part in parts:
            edges = self.nodes[self.rows[part.surface]]
            x = self._nodes[edges]
            at = np.einsum("qi,eia->eqa", values, x)
            length = np.linalg.norm(np.einsum("qi,eia->eqa", slopes(_POINTS), x), axis=2)
            weight = around(n) * _WEIGHTS * length * at[..., 0]
            found = np.einsum("eq,qi,eqa->eia", weight, values, part.at(at[..., 1]))
            np.add.at(out, edges, found)
        return out


def _after(edges: Ints) -> Ints:
    starts = np.full(int(edges.max()) + 1, -1)
    starts[edges[:, 0]] = np.arange(len(edges))
    return np.asarray(starts[edges[:, 1]])

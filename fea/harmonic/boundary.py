"""The outline of a section's mesh, and tractions on it."""

from __future__ import annotations

from copy import copy

import numpy as np

from fea.core.pin_loads import UnitLoad
from fea.core.tractions import Traction
from fea.harmonic.assembly import Section, around
from pinbase.arrays import Floats, Ints

_EDGE_GAUSS_POINTS, _EDGE_GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)


def shapes(x: Floats) -> Floats:
    """The quadratic shape functions (Q, 3) of an edge (ends, middle) at x (Q,) from -1 to 1."""
    return np.stack([x * (x - 1.0) / 2.0, x * (x + 1.0) / 2.0, 1.0 - x * x], axis=1)


def slopes(x: Floats) -> Floats:
    """The derivatives (Q, 3) of the shape functions of an edge."""
    return np.stack([x - 0.5, x + 0.5, -2.0 * x], axis=1)


class Outline:
    """All edges of the outline except those on the axis.

    nodes: (E, 3) the ends and the middle of each edge, counter-clockwise.
    after: (E,) the edge that follows each, -1 at the axis.
    of_rings: for the latest unit loads on rings, their nodal forces divided by the integral around
    the axis, and their tractions.
    """

    def __init__(self, space: Section) -> None:
        edges = space.section.edges
        self.every_node = space.nodes
        self._surface_weights: dict[str, tuple[Floats, Floats]] = {}
        self.of_rings: dict[tuple[UnitLoad, ...], tuple[Floats, Floats]] = {}
        self.nodes: Ints = np.concatenate(list(edges.values()))
        self.after = _after(self.nodes)
        ends = np.cumsum([len(edge_nodes) for edge_nodes in edges.values()])
        self.rows = {
            name: np.arange(end - len(edge_nodes), end)
            for (name, edge_nodes), end in zip(edges.items(), ends, strict=True)
        }

    def moved(self, nodes: Floats) -> Outline:
        """The same edges on a section whose nodes are moved to (N, 2), m."""
        other = copy(self)
        other.every_node, other._surface_weights, other.of_rings = nodes, {}, {}
        return other

    def constrained(self, surfaces: tuple[str, ...]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """A mask (E,) of the edges on any of the surfaces."""
        out = np.zeros(len(self.nodes), dtype=bool)
        for name in surfaces:
            out[self.rows[name]] = True
        return out

    def traction(self, parts: tuple[Traction, ...]) -> Floats:
        """The traction amplitudes (E, 3, 3), Pa, at the nodes of all edges."""
        out = np.zeros((*self.nodes.shape, 3))
        for part in parts:
            rows = self.rows[part.surface]
            out[rows] += part.at(self.every_node[self.nodes[rows], 1])
        return out

    def forces(self, parts: tuple[Traction, ...], n: int) -> Floats:
        """The nodal forces (N, 3), N, along r, theta and z of tractions of harmonic n."""
        if not parts:
            return np.zeros((len(self.every_node), 3))
        nodes, by_part = self.nodes[np.concatenate([self.rows[x.surface] for x in parts])], []
        for part in parts:
            z, weight = self._quadrature(part.surface)
            by_part.append(np.einsum("eqi,eqa->eia", weight, part.at(z)))
        out = np.zeros((len(self.every_node), 3))
        np.add.at(out, nodes.ravel(), around(n) * np.concatenate(by_part).reshape(-1, 3))
        return out

    def weights(self, rows: Ints) -> Floats:
        """The weights (E, 3), m^2, of nodal values in integrals over edges of length times r."""
        return np.asarray(self._on_edges(rows)[1].sum(axis=1))

    def _quadrature(self, surface: str) -> tuple[Floats, Floats]:
        """The z (E, Q), m, of a surface's quadrature points, and the weights (E, Q, 3), m^2, of the
        nodes.

        The weights are for integrals over length times r.
        """
        if surface not in self._surface_weights:
            self._surface_weights[surface] = self._on_edges(self.rows[surface])
        return self._surface_weights[surface]

    def _on_edges(self, rows: Ints) -> tuple[Floats, Floats]:
        """The z (E, 4), m, of the Gauss points of edges, and the weights (E, 4, 3), m^2, with which
        tractions at these points act on the nodes.
        """
        x, values = self.every_node[self.nodes[rows]], shapes(_EDGE_GAUSS_POINTS)
        at = np.einsum("qi,eia->eqa", values, x)
        length = np.linalg.norm(np.einsum("qi,eia->eqa", slopes(_EDGE_GAUSS_POINTS), x), axis=2)
        return at[..., 1], (_EDGE_GAUSS_WEIGHTS * length * at[..., 0])[..., None] * values


def _after(edges: Ints) -> Ints:
    """The edge (E,) that starts where each edge ends, -1 for none."""
    starts = np.full(int(edges.max()) + 1, -1)
    starts[edges[:, 0]] = np.arange(len(edges))
    return np.asarray(starts[edges[:, 1]])

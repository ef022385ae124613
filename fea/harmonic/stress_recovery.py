"""Stress and displacement on a section, on its skin and inside, from the solution of a harmonic."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from fea.core.local_fit import continuation
from fea.core.material import Material
from fea.harmonic.assembly import Section
from fea.harmonic.boundary import Outline, shapes
from fea.harmonic.pressure_edge import EDGE_DIRECTIONS, Jump, jumps
from fea.harmonic.surface_stress import EDGE_STATIONS, skin
from fea.solid.boundary import QUARTER_TRIANGLES
from pinbase.arrays import Floats, Ints, Mask

NO_POINTS = np.zeros((0, 2))
ON_AXIS_TOLERANCE = 1e-9  # of the largest r: points with a smaller r lie on the axis


@dataclass(frozen=True)
class Reading:
    """The points of a mesh at which stress is read, the same in all harmonics.

    points: (S, 2) r and z in m. First come `skin` points, five on each edge of the outline, then
    the `inner` nodes, then points where stress alone is read: I inside the section, and those of
    the jumps.
    extrapolated: (E, 5) the points of the skin whose stress is extrapolated from inside, because
    they are on a clamp, where the traction is unknown, or on the axis.
    rough: the nodes at which such points lie.
    continued: matrix that takes values at samples in the elements to inner nodes, rough nodes and
    the I points (fea.core.local_fit.continuation).
    """

    space: Section
    outline: Outline
    material: Material
    points: Floats
    skin: int
    inner: Ints
    extrapolated: Mask
    rough: Ints
    continued: sp.csr_matrix
    jumps: tuple[Jump, ...]

    def of(self, n: Ints | int, u: Floats, traction: Floats) -> tuple[Floats, Floats]:
        """The amplitudes of displacement (D, 3, K), m, and stress (S, 6, K), Pa.

        n: harmonics, one or (K,).
        u: (N, 3, K) m.
        traction: (E, 3, 3, K) Pa, at the nodes of the outline's edges.
        """
        K = u.shape[2]
        sampled = self.space.sampled_stress(self.material, n, u).reshape(-1, 6, K)
        fitted = np.asarray(self.continued @ sampled.reshape(len(sampled), -1)).reshape(-1, 6, K)
        inner, rough, inside = np.split(fitted, np.cumsum([len(self.inner), len(self.rough)]))
        at_nodes = np.zeros((len(self.space.nodes), 6, K))
        at_nodes[self.rough] = rough
        on_outline = skin(self.space, self.outline, self.material, n, u, traction)
        on_skin, edges = on_outline.stress, np.flatnonzero(self.extrapolated.any(axis=1))
        from_inside = np.einsum(
            "qi,eiak->eqak", shapes(EDGE_STATIONS), at_nodes[self.outline.nodes[edges]]
        )
        some = self.extrapolated[edges][..., None, None]
        on_skin[edges] = np.where(some, from_inside, on_skin[edges])
        displacements = [on_outline.displacement.reshape(-1, 3, K), u[self.inner]]
        stresses = [on_skin.reshape(-1, 6, K), inner, inside]
        stresses.extend(jump.stress(sampled, traction) for jump in self.jumps)
        return np.concatenate(displacements), np.concatenate(stresses)

    @cached_property
    def rows(self) -> Ints:
        """The number (N,) of the point at each node."""
        return points_of_nodes(self.outline, len(self.space.nodes))

    def at_points(self, forces: Floats) -> sp.csc_matrix:
        """The forces (3 D, K), N, at points that have a displacement, from forces at nodes (N, 3,
        K).
        """
        count, loads = self.skin + len(self.inner), forces.shape[2]
        dense = np.zeros((loads, count, 3))
        dense[:, self.rows] = forces.transpose(2, 0, 1)
        load, row = np.nonzero(dense.reshape(loads, -1))
        ends = np.searchsorted(load, np.arange(loads + 1))
        values = dense.reshape(loads, -1)[load, row]
        return sp.csc_matrix((values, row, ends), (3 * count, loads))

    @property
    def triangles(self) -> Ints:
        """The triangles (M, 3) of points that fill the section, four for each element."""
        return np.asarray(self.rows[self.space.elements][:, QUARTER_TRIANGLES].reshape(-1, 3))


def points_of_nodes(outline: Outline, count: int) -> Ints:
    """The number (N,) of the point of a reading at each of `count` nodes."""
    row = np.zeros(count, dtype=np.int64)
    inner = np.setdiff1d(np.arange(count), outline.nodes)
    row[inner] = len(EDGE_STATIONS) * len(outline.nodes) + np.arange(len(inner))
    first = len(EDGE_STATIONS) * np.arange(len(outline.nodes))
    for node, at in ((2, len(EDGE_STATIONS) // 2), (1, len(EDGE_STATIONS) - 1), (0, 0)):
        row[outline.nodes[:, node]] = first + at
    return row


def reading(
    space: Section,
    outline: Outline,
    material: Material,
    clamps: tuple[str, ...] = (),
    inside: Floats = NO_POINTS,
    ends: Iterable[tuple[float, float]] = (),
) -> Reading:
    """The points at which stress is read on a mesh, and how.

    clamps: surfaces that are clamped.
    inside: additional points (I, 2), m.
    ends: places (r, z), m, on the outline where a pressure ends.
    """
    every_jump = jumps(space, outline, material, ends)
    on_jumps = (
        np.array([[j.r, j.z] for j in every_jump]).reshape(-1, 2).repeat(EDGE_DIRECTIONS, axis=0)
    )
    skin_at = np.einsum("qi,eia->eqa", shapes(EDGE_STATIONS), space.nodes[outline.nodes])
    inner = np.setdiff1d(np.arange(len(space.nodes)), outline.nodes)
    constrained = outline.constrained(clamps)
    # Stress on clamped edges and on the axis comes from inside, at `rough` nodes.
    on_axis = ON_AXIS_TOLERANCE * space.nodes[:, 0].max()
    axis = outline.nodes[space.nodes[outline.nodes, 0] < on_axis]
    rough = np.union1d(outline.nodes[constrained], axis)
    # Points of the skin, inner nodes, additional points inside, points of jumps. The last two kinds
    # have no displacement.
    points = [skin_at.reshape(-1, 2), space.nodes[inner], inside, on_jumps]
    targets = np.concatenate([space.nodes[inner], space.nodes[rough], inside])
    continued = continuation(space.samples, targets)
    return Reading(
        space,
        outline,
        material,
        np.concatenate(points),
        len(points[0]),
        inner,
        constrained[:, None] | (skin_at[..., 0] < on_axis),
        rough,
        continued,
        every_jump,
    )

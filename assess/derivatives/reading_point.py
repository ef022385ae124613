"""The stress at one point of a section's mesh, as a function of nodes, displacements and tractions.

Stress is read as in fea.harmonic.stress_recovery. At a point on the surface it comes from the
strains of the point's edge and of the edges before and after it. At a point inside, on a clamped
surface or on the rim of an excluded zone it comes from samples of the nearest elements. At the end
of a pressure it comes from samples farther away. Where lugs press on the surface, it may be a
combination of these (fea.harmonic.free_surface). If the nodes move, the point moves with them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

from fea.core.local_fit import FIT_SAMPLES, fit_weights
from fea.core.material import Material
from fea.harmonic.assembly import Section, elasticity, strain_map
from fea.harmonic.boundary import Outline, shapes
from fea.harmonic.free_surface import Cusp, relief
from fea.harmonic.pressure_edge import Jump, at_edge
from fea.harmonic.stress_recovery import ON_AXIS_TOLERANCE
from fea.harmonic.surface_stress import EDGE_STATIONS, on_edges, smooth_neighbours
from geometry.mesh.section_mesh import triangle_shapes
from pinbase.arrays import Floats, Ints

_TO_UNKNOWNS = np.array([[0.5, 0.5, 0.0], [0.5, -0.5, 0.0], [0.0, 0.0, 1.0]])


@dataclass(frozen=True)
class SectionState:
    """The state of a section, which may differ from the solved one.

    nodes: (N, 2) m.
    traction: (E, 3, 3, K) Pa, on the edges of the outline.
    places: (Z, 3) m, r, z and radius of each excluded zone.
    """

    nodes: Floats
    traction: Floats
    places: Floats


class ReadingPoint(Protocol):
    """The interface of a point at which stress is read.

    nodes: (L,) numbers of the nodes on whose displacements the stress depends.
    """

    @property
    def nodes(self) -> Ints: ...

    def stress(self, material: Material, state: SectionState, n: Ints, u: Floats) -> Floats:
        """Return the stress amplitudes (6, K), Pa, of K waves.

        n: (K,) harmonics.
        u: (L, 3, K) displacements of the point's nodes, m.
        """
        ...


@dataclass(frozen=True)
class OnSkin:
    """Points (P,) on the surface, which is made of edges.

    edges: numbers of the edges with the points, and of the edges that continue these smoothly.
    neighbours: for each of `edges`, the edge before and the edge after it, as a position in
    `edges`, or -1 if there is none.
    of: (P,) the edge of each point, as a position in `edges`.
    at: (P,) which of the five points of that edge it is.
    """

    outline: Outline
    edges: Ints
    neighbours: tuple[Ints, Ints]
    of: Ints
    at: Ints

    @cached_property
    def nodes(self) -> Ints:
        return np.unique(self.outline.nodes[self.edges])

    @cached_property
    def _local(self) -> Ints:
        return np.searchsorted(self.nodes, self.outline.nodes[self.edges])

    def each(
        self, material: Material, state: SectionState, n: Ints, u: Floats
    ) -> tuple[Floats, Floats]:
        """Return the points (P, 2), m, and the stress there, (P, 6, K), Pa."""
        x = state.nodes[self.outline.nodes[self.edges]]
        traction = state.traction[self.edges]
        skin = on_edges(material, n, x, u[self._local], traction, self.neighbours)
        return skin.points[self.of, self.at], skin.stress[self.of, self.at]

    def stress(self, material: Material, state: SectionState, n: Ints, u: Floats) -> Floats:
        """Return the stress at the first point, (6, K), Pa."""
        return np.asarray(self.each(material, state, n, u)[1][0])


def on_skin(outline: Outline, traction: Floats, edges: Ints, at: Ints) -> OnSkin:
    """Return the points `at` of some edges.

    traction: (E, 3, 3, K) Pa. Edges between which it jumps do not count as neighbours.
    """
    x = outline.every_node[outline.nodes]
    both = [neighbour[edges] for neighbour in smooth_neighbours(outline, x, traction)]
    every = np.unique(np.concatenate([edges, *(some[some >= 0] for some in both)]))
    local = []
    for neighbour in smooth_neighbours(outline, x, traction):
        near = neighbour[every]
        known = np.isin(near, every) & np.isin(every, edges)
        local.append(np.where(known, np.searchsorted(every, near), -1))
    return OnSkin(outline, every, (local[0], local[1]), np.searchsorted(every, edges), at)


@dataclass(frozen=True)
class Relieved:
    """A point in the middle of a ring, without the local stress of the pressure on the ring.

    See fea.harmonic.free_surface.
    """

    point: OnSkin

    @property
    def nodes(self) -> Ints:
        return self.point.nodes

    def stress(self, material: Material, state: SectionState, n: Ints, u: Floats) -> Floats:
        on_skin_stress = self.point.stress(material, state, n, u)
        return np.asarray(
            on_skin_stress - relief(material.poisson_ratio)[:, None] * on_skin_stress[0]
        )


@dataclass(frozen=True)
class Continued:
    """The edge of a lug, at a node, to which stress is extrapolated from points near it."""

    points: OnSkin
    cusp: Cusp
    edge: int

    @property
    def nodes(self) -> Ints:
        return self.points.nodes

    def stress(self, material: Material, state: SectionState, n: Ints, u: Floats) -> Floats:
        at, beside = self.points.each(material, state, n, u)
        weights = self.cusp.weights(at[:, 1], float(state.nodes[self.edge, 1]))
        return np.asarray(np.einsum("p,pck->ck", weights, beside))


@dataclass(frozen=True)
class Samples:
    """Some of a section's sample points, by their numbers `which` (S,). An element has three."""

    space: Section
    which: Ints

    @cached_property
    def elements(self) -> Ints:
        """The numbers (m,) of the elements that contain the samples."""
        return np.unique(self.which // 3)

    @cached_property
    def nodes(self) -> Ints:
        """The numbers (L,) of the nodes of these elements."""
        return np.unique(self.space.elements[self.elements])

    @cached_property
    def _local(self) -> tuple[Ints, Ints]:
        rows = np.searchsorted(self.elements, self.which // 3)
        return rows, self.which % 3

    def read(self, material: Material, nodes: Floats, n: Ints, u: Floats) -> tuple[Floats, Floats]:
        """Return the sample points (S, 2), m, and the stress there, (S, 6, K), Pa.

        nodes: (N, 2) of the section, m.
        n: (K,) harmonics.
        u: (L, 3, K) displacements of the samples' nodes, m.
        """
        members = self.space.elements[self.elements]
        x, moved = nodes[members], u[np.searchsorted(self.nodes, members)]
        values, slopes = _reference(self.space)
        at = np.einsum("qi,mia->mqa", values, x)
        jacobian = np.einsum("qid,mia->mqad", slopes, x)
        gradients = np.einsum("qid,mqda->mqia", slopes, np.linalg.inv(jacobian))
        over_r = values / at[..., :1]
        G = np.concatenate([gradients, over_r[..., None]], axis=3)  # (m, q, i, a)
        unknowns = np.einsum("pc,mick->mipk", _TO_UNKNOWNS, moved)
        E = np.stack([strain_map(int(one)) for one in n], axis=-1)  # (6, 3, 3, K)
        strain = np.einsum("spak,mqia,mipk->mqsk", E, G, unknowns)
        rows, q = self._local
        return at[rows, q], np.einsum("ts,xsk->xtk", elasticity(material), strain[rows, q])


def _reference(space: Section) -> tuple[Floats, Floats]:
    """Return the shape functions (3, 6) and their slopes (3, 6, 2) at the samples of an element."""
    values, slopes = triangle_shapes(space.sampled_at)
    return values.T, slopes.T


@dataclass(frozen=True)
class FromInside:
    """A stress extrapolated from the nearest samples to one or more places, as a weighted sum.

    samples: the nearest samples of each place. shares: the weight of each place in the sum.
    on: the nodes that are the places, by number. If empty, the only place is `place` (r, z), m, on
    the rim of the zone with number `zone`.
    zone_at: r, z and radius of this zone in the solution, m.
    """

    samples: tuple[Samples, ...]
    shares: tuple[float, ...]
    on: tuple[int, ...]
    place: tuple[float, float] = (0.0, 0.0)
    zone: int = -1
    zone_at: tuple[float, float, float] = (0.0, 0.0, 1.0)

    @cached_property
    def nodes(self) -> Ints:
        return np.unique(np.concatenate([s.nodes for s in self.samples]))

    def stress(self, material: Material, state: SectionState, n: Ints, u: Floats) -> Floats:
        out = np.zeros((6, u.shape[2]))
        places = [state.nodes[k] for k in self.on] or [self._on_rim(state)]
        for samples, share, place in zip(self.samples, self.shares, places, strict=True):
            displacements = u[np.searchsorted(self.nodes, samples.nodes)]
            at, sampled = samples.read(material, state.nodes, n, displacements)
            distance = np.hypot(*(at - place).T)
            weights = fit_weights(at - place, 1.0 - (distance / distance[-1]) ** 2)
            out += share * np.einsum("s,sck->ck", weights, sampled)
        return out

    def _on_rim(self, state: SectionState) -> Floats:
        if self.zone < 0:
            return np.array(self.place)
        r, z, radius = self.zone_at
        now = state.places[self.zone]
        offset = np.array(self.place) - [r, z]
        return np.asarray(now[:2] + offset * (now[2] / radius))


@dataclass(frozen=True)
class AtJump:
    """One direction of reading at the end of a pressure (fea.harmonic.pressure_edge).

    direction: the number of the direction.
    """

    outline: Outline
    jump: Jump
    samples: Samples
    direction: int

    @property
    def nodes(self) -> Ints:
        return self.samples.nodes

    def stress(self, material: Material, state: SectionState, n: Ints, u: Floats) -> Floats:
        before, after = self.jump.before, self.jump.after
        edges = self.outline.nodes
        x = state.nodes[[edges[before, 0], edges[before, 1], edges[after, 1]]]
        at, sampled = self.samples.read(material, state.nodes, n, u)
        normal, weights, field = at_edge((x[0], x[1], x[2]), at, material.poisson_ratio)
        more = state.traction[after, 0] - state.traction[before, 1]
        smooth = np.einsum("s,sck->ck", weights, sampled)
        return np.asarray(smooth + field[self.direction][:, None] * (normal @ more[[0, 2]]))


def nearest(space: Section, places: Sequence[Floats]) -> tuple[Samples, ...]:
    """Return, for each place, the samples that fea.core.local_fit.continuation would use there."""
    count = min(FIT_SAMPLES, len(space.samples))
    tree = cKDTree(space.samples)
    return tuple(Samples(space, np.asarray(tree.query(place, count)[1])) for place in places)


def at_node(space: Section, node: int) -> FromInside:
    """Return the reading point at an inner node."""
    return FromInside(nearest(space, [space.nodes[node]]), (1.0,), (node,))


def at_rough(space: Section, outline: Outline, edge: int, at: int) -> FromInside:
    """Return the reading point `at` of an edge that is clamped or lies on the axis."""
    parts = shapes(EDGE_STATIONS[at : at + 1])[0]
    some = [(float(p), int(k)) for p, k in zip(parts, outline.nodes[edge], strict=True) if p]
    on = tuple(k for _, k in some)
    return FromInside(nearest(space, [space.nodes[k] for k in on]), tuple(p for p, _ in some), on)


def on_axis(space: Section, r: float) -> bool:
    """Whether a radius (m) is zero within the tolerance."""
    return bool(r < ON_AXIS_TOLERANCE * space.nodes[:, 0].max())

"""The edges of a solid at which linear elasticity predicts unbounded stress, found on its mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fea.core.zone import Kind, Zone
from fea.singular.singularities import CLAMP_ADVICE
from fea.solid.assembly import Discretisation
from fea.solid.boundary import SurfaceMesh
from pinbase.arrays import Floats, Ints, Mask

# Least angle by which the surface turns at a sharp inner corner: less belongs to the facets of a
# curved wall, or is hardly sharp. Chosen by judgement.
MIN_EDGE_TURN = np.radians(40.0)
FACET_SIDES = ((0, 1, 2), (1, 2, 0), (0, 2, 1))  # sides of a facet: both ends, opposite corner


@dataclass(frozen=True)
class SharpEdges:
    """The points (K, 3), m, along inner corners (first) and along edges of clamps.

    corner, rim: the points of both.
    radius: (K,) m, of the body at their z.
    limit: (K,) m, the largest radius of their zones.
    """

    corner: Floats
    rim: Floats
    radius: Floats
    limit: Floats

    def singularities(self, x: Floats, part: float) -> list[tuple[Zone, Mask]]:
        """The zones near inner corners and near edges of clamps, with the points in each.

        All inner corners make one zone, and all edges of clamps another. The reach of the nearest
        point of an edge decides whether a point lies in the zone.
        x: (S, 3) m.
        part: radius of the zones, of the diameter.
        """
        first = len(self.corner)
        every = np.minimum(part * 2.0 * self.radius, self.limit)
        kinds: tuple[tuple[Kind, Floats, Floats, str], ...] = (
            ("sharp corner", self.corner, every[:first], _RADIUS_ADVICE),
            ("edge of a clamp", self.rim, every[first:], CLAMP_ADVICE),
        )
        zones = []
        for kind, points, reach, advice in kinds:
            if len(points):
                distance, nearest = cKDTree(points).query(x)
                at = points[0]
                singularity = Zone(
                    r=float(np.hypot(at[0], at[1])),
                    z=float(at[2]),
                    kind=kind,
                    between=("the body", "itself" if kind == "sharp corner" else "its clamp"),
                    theory=None,
                    torsion_theory=0.0,
                    radius=float(reach.max()),
                    advice=advice,
                )
                zones.append((singularity, distance <= reach[nearest]))
        return zones


_RADIUS_ADVICE = "a radius there would make it finite"


@dataclass(frozen=True)
class TurnedEdges:
    """The E edges between facets.

    facets: (2, E) numbers of the two facets among those of the boundary.
    nodes: (E, 2 or 3).
    turn: (E,) rad, by which the surface turns inwards; positive at an inner corner.
    """

    facets: Ints
    nodes: Ints
    turn: Floats


def turned_edges(
    space: Discretisation, surface: SurfaceMesh, plane: Floats | None = None
) -> TurnedEdges:
    """All edges between facets, with the angle by which the surface turns at each.

    The angle is that between the normals at the middle of the edge.
    plane: (F, 3) normals of the facets that replace these.
    """
    side_of = space.mesh.f2e[:, surface.facets]  # each edge is shared by two facets
    order = np.argsort(side_of.ravel(), kind="stable").reshape(-1, 2)
    facet, side = (order % len(surface.facets)).T, (order // len(surface.facets)).T
    nodes = np.array(FACET_SIDES)[side[1]]  # of the second facet: ends, across
    two = surface.corners[facet[1]]
    a, b, across = (np.take_along_axis(two, nodes[:, [k]], axis=1)[:, 0] for k in range(3))
    x = space.nodes
    if plane is None:
        normal, other = surface.normals[facet, 3 + side]
    else:
        normal, other = plane[facet]
    into = np.cross(other, x[b] - x[a])
    into *= np.sign(np.sum(into * (x[across] - (x[a] + x[b]) / 2), axis=1))[:, None]
    into /= np.linalg.norm(into, axis=1, keepdims=True)
    turn = np.arctan2(np.sum(normal * into, axis=1), np.sum(normal * other, axis=1))
    edge = np.stack([a, b], axis=1)
    if space.quadratic:
        edge = np.column_stack([edge, two[np.arange(len(two)), 3 + side[1]]])
    return TurnedEdges(facet, edge, turn)


def sharp_edges(
    space: Discretisation,
    surface: SurfaceMesh,
    clamps: tuple[str, ...],
    limit: Callable[[Floats, Floats], Floats] | None = None,
) -> SharpEdges:
    """The inner corners that turn by more than MIN_EDGE_TURN, and the rims of the clamped surfaces.

    limit: gives the largest radii (S,), m, of zones at r, z (S,), m; without it there is no limit.
    """
    clamped = surface.on(space, clamps)
    # Normals are those of plane facets: where sides were straightened for the quality of elements,
    # curved facets have kinks.
    edges = turned_edges(space, surface, _plane_normals(space.nodes, surface))
    first, second = clamped[edges.facets]
    corner = (edges.turn > MIN_EDGE_TURN) & ~(first & second)
    rim = first != second
    x = space.nodes
    corners, rims = (x[np.unique(edges.nodes[on])] for on in (corner, rim))
    points = np.concatenate([corners, rims])
    radius = _outer_radius(space.nodes[surface.nodes], points)
    limits = np.full(len(points), np.inf)
    if limit is not None:
        limits = limit(np.hypot(*points[:, :2].T), points[:, 2])
    return SharpEdges(corners, rims, radius, limits)


def _plane_normals(nodes: Floats, surface: SurfaceMesh) -> Floats:
    """The outward unit normals (F, 3) of the plane triangles between the facets' corners."""
    x = nodes[surface.corners[:, :3]]
    normals = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    mean = surface.normals[:, -3:].sum(axis=1)  # at the middles of sides, or the corners if linear
    normals *= np.sign(np.sum(normals * mean, axis=1))[:, None]
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))


def _outer_radius(nodes: Floats, points: Floats) -> Floats:
    """The largest distance (K,), m, of surface nodes from the z-axis near the z of points (K, 3),
    m.
    """
    r = np.hypot(nodes[:, 0], nodes[:, 1])
    order = np.argsort(nodes[:, 2])
    z, r, near = nodes[order, 2], r[order], 0.1 * r.max()
    first = np.searchsorted(z, points[:, 2] - near)
    last = np.searchsorted(z, points[:, 2] + near, side="right")
    return np.array([r[i:j].max() for i, j in zip(first, last, strict=True)])

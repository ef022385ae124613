"""The whole body of a pin with cuts at one instant: its local solids and the uncut pin between
them.

The uncut pin is a section that is turned about its axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from fea.core.pin_loads import PinLoads, Unit
from fea.core.solution import Picture
from fea.core.voigt import rotation
from fea.cut.frames import cartesian, turn_of
from fea.cut.local_fields import LocalFields
from fea.cut.movement import of_units, rigid
from fea.cut.shown import moved_by, own_ends, support_motion
from fea.cut.supports import ClampReaction
from fea.harmonic.fields import MeridianFields
from fea.harmonic.revolve import revolve_solid
from fea.solid.boundary import QUARTER_TRIANGLES
from geometry.mesh.clip import EIGHT_TETRAHEDRA, clipped, gaps, halved, upright
from pinbase.arrays import Floats, Ints

NEAR_TRIANGLES = 16, 400  # numbers of nearest triangles searched for the one that has a point
# Largest distance of an edge's middle from its chord, of the chord's length: a cylinder is shown by
# 50 or more flat sides, which lose 0.3 % of its area.
MAX_BENT_EDGE = 0.03
MAX_EDGE = 0.15  # largest edge, of the diameter: longer edges lose 2 % of a shear force
# Largest edge, times the size of the section's triangles there: longer edges miss the stress of the
# uncut pin at a fillet, where the shear force was 30 % off.
MAX_COARSENESS = 8.0
MAX_HALVINGS = 2
# Barycentric coordinates of the nodes of a quadratic triangle.
SIX_NODES = np.concatenate([np.eye(3), 0.5 * (np.eye(3) + np.eye(3)[[1, 2, 0]])])
INSIDE_TOLERANCE = 1e-6  # of barycentric coordinates


@dataclass(frozen=True)
class BodyPart:
    """A part of the pin at one instant.

    points: (N, 3) m. cells: by their type in VTK. displacement: (N, 3) m. stress: (N, 6) Pa.
    """

    points: Floats
    cells: dict[str, Ints]
    displacement: Floats
    stress: Floats


def body(
    fields: MeridianFields,
    pieces: Sequence[LocalFields],
    first_clamp: ClampReaction | None,
    loads: PinLoads,
    instant: int,
) -> Picture:
    """The whole pin at an instant, without an envelope.

    fields: of the uncut pin.
    pieces: the local solids about the cuts.
    first_clamp: stays in place, as for fea.cut.shown.shown.
    loads: together with the motions of clamps that they cause.
    """
    amounts = pieces[0].coefficients(loads)[instant]
    now = [piece.at(amounts) for piece in pieces]
    ends = own_ends(pieces)
    length = float(fields.points[:, 1].max())
    parts = [
        _piece(fields, piece, amounts, low_high)
        for piece, low_high in zip(pieces, ends, strict=True)
    ]
    for k, part in enumerate(parts):
        for other in (*now[:k], *now[k + 1 :]):
            part.displacement[:] += moved_by(other, part.points)[..., 0]
    if between := gaps(ends, length):
        uncut = _between(fields, loads, instant, pieces[0].nu, between)
        for piece in now:
            uncut.displacement[:] += moved_by(piece, uncut.points)[..., 0]
        parts.append(uncut)
    points = np.concatenate([part.points for part in parts])
    motion = support_motion(now, first_clamp, length)
    moved = np.concatenate([part.displacement for part in parts]) - rigid(motion, points)[..., 0]
    (cell_type, cells), *more = _joined(parts).items()
    return Picture(
        points, cells, cell_type, moved, np.concatenate([part.stress for part in parts]),
        np.full(len(points), np.nan), more=dict(more),
    )  # fmt: skip


def _joined(parts: Sequence[BodyPart]) -> dict[str, Ints]:
    """The cells of all parts by their type, with the points of the parts numbered one after
    another.
    """
    out: dict[str, list[Ints]] = {}
    first = 0
    for part in parts:
        for cell_type, cells in part.cells.items():
            if len(cells):
                out.setdefault(cell_type, []).append(cells + first)
        first += len(part.points)
    return {cell_type: np.concatenate(cells) for cell_type, cells in out.items()}


def _between(
    fields: MeridianFields,
    loads: PinLoads,
    instant: int,
    nu: float,
    between: Sequence[tuple[float, float]],
) -> BodyPart:
    """The uncut pin between its pieces, in intervals of z, m, turned about the axis."""
    count = len(fields.displacement)
    triangles, to_nodes = np.zeros((0, 3), dtype=np.int64), [sp.eye(count, format="csr")]
    first = count
    for low, high in between:
        cells, nodes = clipped(fields.points[:count, 1], fields.triangles, low, high)
        triangles = np.concatenate(
            [triangles, np.where(cells < count, cells, cells - count + first)]
        )
        to_nodes.append(nodes[count:])
        first += nodes.shape[0] - count
    matrix = sp.vstack(to_nodes, format="csr")

    def at_nodes(values: Floats) -> Floats:
        known = values[:count]
        return np.asarray((matrix @ known.reshape(count, -1)).reshape(-1, *values.shape[1:]))

    points = at_nodes(fields.points)
    clipped_fields = replace(
        fields,
        points=points,
        stress=at_nodes(fields.stress),
        displacement=at_nodes(fields.displacement),
        triangles=upright(points, triangles),
        unread=fields.unread[fields.unread < count],
        forces=None,
    )
    solid = revolve_solid(clipped_fields, loads, instant, nu)
    return BodyPart(solid.points, {solid.cell_type: solid.cells}, solid.displacement, solid.stress)


def _piece(
    fields: MeridianFields, piece: LocalFields, amounts: Floats, ends: tuple[float, float]
) -> BodyPart:
    """A piece between two z, m, displaced by the loads and its own cuts.

    amounts: (L,) of the unit loads.
    """
    turn, inner = turn_of(piece.piece.angle), piece.inner.whole(amounts)
    points = inner.points @ turn.T + [0.0, 0.0, piece.piece.origin]
    changed = inner.changed @ rotation(turn).T
    displaced = inner.displaced @ turn.T
    long = MAX_EDGE * piece.piece.profile.largest_diameter
    corners = fields.points[fields.triangles]
    middles, sizes = cKDTree(corners.mean(axis=1)), np.ptp(corners, axis=1).max(axis=1)
    cells = inner.cells
    for _ in range(MAX_HALVINGS):
        x, y, z = points[cells[:, :4]].mean(axis=1).T
        nearest = middles.query(np.stack([np.hypot(x, y), z], axis=1))[1]
        longest = np.minimum(long, MAX_COARSENESS * sizes[nearest])
        cells, to_nodes = halved(points, cells, MAX_BENT_EDGE, longest)
        points, changed, displaced = (to_nodes @ x for x in (points, changed, displaced))
    stress, moved = _uncut(fields, points, piece.units, amounts)
    stress += changed
    moved += displaced - rigid(piece.moved[0] @ amounts[:, None], points)[..., 0]
    return _cropped(BodyPart(points, {"tetra10": cells}, moved, stress), ends)


def _cropped(part: BodyPart, ends: tuple[float, float]) -> BodyPart:
    """The part between two z, m. Quadratic tetrahedra that the ends cut become linear ones."""
    cells, z = part.cells["tetra10"], part.points[:, 2]
    near = 1e-9 * float(np.ptp(z))
    low, high = ends[0] - near, ends[1] + near
    whole = ((z[cells] >= low) & (z[cells] <= high)).all(axis=1)
    some = ~whole & (z[cells].max(axis=1) > ends[0]) & (z[cells].min(axis=1) < ends[1])
    eighths = cells[some][:, EIGHT_TETRAHEDRA].reshape(-1, 4)
    tetrahedra, to_nodes = clipped(z, eighths, *ends)
    tetrahedra = upright(to_nodes @ part.points, tetrahedra)
    used, numbers = np.unique(
        np.concatenate([cells[whole].ravel(), tetrahedra.ravel()]), return_inverse=True
    )
    ten = numbers[: cells[whole].size].reshape(-1, 10)
    to_used = to_nodes[used]
    return BodyPart(
        to_used @ part.points,
        {"tetra10": ten, "tetra": numbers[ten.size :].reshape(-1, 4)},
        to_used @ part.displacement,
        to_used @ part.stress,
    )


def _uncut(
    fields: MeridianFields, points: Floats, units: tuple[Unit, ...], amounts: Floats
) -> tuple[Floats, Floats]:
    """The stress (P, 6), Pa, and displacement (P, 3), m, of the uncut pin under all unit loads.

    points: (P, 3) m.
    amounts: (L,) of the unit loads.
    """
    x, y, z = points.T
    at, angle = np.stack([np.hypot(x, y), z], axis=1), np.arctan2(y, x)
    to_points, count = _interpolation(fields, at), len(fields.displacement)
    stress, moved = np.zeros((len(at), 6)), np.zeros((len(at), 3))
    waves: dict[tuple[int, int], tuple[Unit, Floats, Floats]] = {}
    for (load, phase), amount in zip(units, amounts.tolist(), strict=True):
        k, key = fields.loads.index(load), (load.n, phase)
        _, s, u = waves.get(key, ((load, phase), 0.0, 0.0))
        s = s + amount * fields.stress[:count, :, k]
        waves[key] = (load, phase), s, u + amount * fields.displacement[:, :, k]
    for unit, s, u in waves.values():
        stress += cartesian((to_points @ s)[..., None], angle, 0.0, (unit,))[..., 0]
        moved += of_units((to_points @ u)[..., None], angle, (unit,))[..., 0]
    return stress, moved


def _interpolation(fields: MeridianFields, at: Floats) -> sp.csr_matrix:
    """A matrix (P, D) that interpolates values at the points of the section quadratically to points
    (P, 2).

    The four quarters of each element follow each other among the triangles. Points outside of all
    triangles by round-off have the value of the nearest one.
    """
    corners = fields.points[fields.triangles]
    edges = np.linalg.inv((corners[:, 1:] - corners[:, :1]).swapaxes(1, 2))
    tree = cKDTree(corners.mean(axis=1))
    best = np.full(len(at), -np.inf)
    weights, triangle = np.zeros((len(at), 3)), np.zeros(len(at), dtype=np.int64)
    for count in NEAR_TRIANGLES:
        left = np.flatnonzero(best < -INSIDE_TOLERANCE)
        near = np.asarray(tree.query(at[left], min(count, len(corners)))[1])
        rest = np.einsum("pkab,pkb->pka", edges[near], at[left, None] - corners[near, 0])
        w = np.concatenate([1.0 - rest.sum(axis=2, keepdims=True), rest], axis=2)
        chosen = w.min(axis=2).argmax(axis=1)
        rows = np.arange(len(left))
        weights[left], triangle[left] = w[rows, chosen], near[rows, chosen]
        best[left] = weights[left].min(axis=1)
    weights = np.clip(weights, 0.0, None)
    weights /= weights.sum(axis=1, keepdims=True)
    element, quarter = np.divmod(triangle, 4)
    b = np.einsum("pi,pij->pj", weights, SIX_NODES[QUARTER_TRIANGLES[quarter]])
    shapes = np.concatenate([b * (2.0 * b - 1.0), 4.0 * b * b[:, [1, 2, 0]]], axis=1)
    quarters = fields.triangles.reshape(-1, 4, 3)
    nodes = np.concatenate([quarters[:, [0, 1, 2], [0, 1, 2]], quarters[:, 3]], axis=1)
    row, column = np.arange(len(at)).repeat(6), nodes[element].ravel()
    shape = len(at), len(fields.displacement)
    return sp.csr_matrix((shapes.ravel(), (row, column)), shape=shape)

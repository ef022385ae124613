"""The surface of a cut pin for views: the surfaces of the local solids, and the uncut pin between
them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree

from fea.core.pin_loads import Unit
from fea.cut.frames import cartesian
from fea.cut.local_fields import LocalFields
from fea.cut.movement import axis_kept, of_units, rigid
from fea.cut.region import zone
from fea.cut.supports import ClampReaction, reached
from fea.harmonic.fields import MeridianFields
from pinbase.arrays import Floats, Ints, Mask

# Chosen by judgement:
CUT_VIEW_SECTORS = 72  # sectors about the axis, away from the pieces
DISPLACEMENT_FIT_POINTS = 40  # nearest points of a piece in a fit of its displacements
TRANSVERSE_DISTANCE_WEIGHT = 0.1  # weight of distances across the pin in the choice of these points
PIECE_END_TOLERANCE = 1e-9  # of a piece's length


@dataclass(frozen=True)
class ShownCut:
    """The surface that views show, under L unit loads, each in one phase.

    points: (P, 3) m.
    triangles: (M, 3).
    stress: (P, 6, L) Pa.
    displacement: (P, 3, L) m.
    read: (P,) the points that are searched for the maximum; between the pieces all points, also
    those in zones.
    outline: (P,) the points on the outline of the pin without cuts.
    between: (U, 2) for the first U points, which lie on the pin between its pieces, the two points
    of its section between which each lies.
    """

    points: Floats
    triangles: Ints
    stress: Floats
    displacement: Floats
    read: Mask
    outline: Mask
    between: Ints = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))

    def read_in(self, section: Mask) -> Mask:
        """A mask (P,) of the points that are searched for the maximum.

        section: (S,) mask of the points of the uncut pin's section that are read, outside of zones.
        """
        read = self.read.copy()
        read[: len(self.between)] = section[self.between].all(axis=1)
        return read


def shown(
    fields: MeridianFields, pieces: Sequence[LocalFields], first_clamp: ClampReaction | None
) -> ShownCut:
    """The whole surface of a cut pin.

    fields: of the pin without cuts.
    first_clamp: stays in place; without a clamp, both ends of the axis stay on it.
    """
    between = [_instead_of_uncut(piece) for piece in pieces]
    uncut = _revolved(fields, pieces[0].units, between)
    parts = [uncut, *map(_piece, pieces, own_ends(pieces))]
    starts = np.cumsum([0, *(len(part.points) for part in parts)])
    points = np.concatenate([p.points for p in parts])
    displacement = np.concatenate([p.displacement for p in parts])  # the largest array: in place
    # Displacements add up: the pin above a piece moves with the piece's upper end.
    for piece, start in zip(pieces, starts[1:], strict=False):
        end = start + len(piece.points)
        displacement[:start] += moved_by(piece, points[:start])
        displacement[end:] += moved_by(piece, points[end:])
        displacement[start:end] += piece.displaced
    length = float(fields.points[:, 1].max())
    displacement -= rigid(support_motion(pieces, first_clamp, length), points)
    return ShownCut(
        points,
        np.concatenate([p.triangles + i for p, i in zip(parts, starts, strict=False)]),
        np.concatenate([p.stress for p in parts]),
        displacement,
        np.concatenate([p.read for p in parts]),
        np.concatenate([p.outline for p in parts]),
        uncut.between,
    )


def _instead_of_uncut(piece: LocalFields) -> tuple[float, float]:
    """The z, m, between which a piece is shown instead of the uncut pin.

    They include the end faces of the pin that the piece has, since its cuts may open into them.
    """
    low, high = piece.free_ends
    return -math.inf if low else piece.piece.z0, math.inf if high else piece.piece.z1


def own_ends(pieces: Sequence[LocalFields]) -> list[tuple[float, float]]:
    """The z of both ends, m, between which each piece is shown.

    Where two pieces overlap, each is shown up to midway between their cuts.
    """
    low = [p.piece.z0 for p in pieces]
    high = [p.piece.z1 for p in pieces]
    for k in range(len(pieces) - 1):
        if high[k] > low[k + 1]:
            high[k] = low[k + 1] = 0.5 * (zone(pieces[k].piece)[1] + zone(pieces[k + 1].piece)[0])
    return list(zip(low, high, strict=True))


def _piece(piece: LocalFields, ends: tuple[float, float]) -> ShownCut:
    """The surface of a piece between two z, m."""
    z = piece.points[piece.triangles, 2]
    here = (z.max(axis=1) >= ends[0]) & (z.min(axis=1) <= ends[1])
    outline = np.isin(np.arange(len(piece.points)), piece.outer)
    triangles = piece.triangles[here]
    return ShownCut(piece.points, triangles, piece.stress, piece.uncut, piece.read, outline)


def support_motion(
    pieces: Sequence[LocalFields], first_clamp: ClampReaction | None, length: float
) -> Floats:
    """The rigid-body motion (6, L) of the support that all cuts cause, which is subtracted.

    length: m, of the pin.
    """
    whole = np.sum([p.moved[1] - p.moved[0] for p in pieces], axis=0)
    return reached(first_clamp, pieces) if first_clamp else axis_kept(whole, length)


def moved_by(piece: LocalFields, points: Floats) -> Floats:
    """The displacement (P, 3, L), m, of points (P, 3), m, of the pin by the cuts of a piece.

    It is relative to the pin below the piece. Points beside the piece move with its outline.
    """
    z0, z1 = piece.piece.z0, piece.piece.z1
    near = PIECE_END_TOLERANCE * (z1 - z0)
    out = np.zeros((len(points), 3, len(piece.units)))
    above = np.flatnonzero(points[:, 2] >= z1 - near)
    out[above] = rigid(piece.moved[1] - piece.moved[0], points[above])
    amid = np.flatnonzero((points[:, 2] > z0 + near) & (points[:, 2] < z1 - near))
    if len(amid):
        out[amid] = _beside(piece, points[amid])
    return out


def _beside(piece: LocalFields, points: Floats) -> Floats:
    """The displacement (P, 3, L), m, by the cuts of a piece at points (P, 3), m, of another piece
    beside it.

    Linear functions are fitted to the displacements of the piece's outline nearby, all around the
    axis.
    """
    outline = piece.points[piece.outer]
    squeezed = np.array([TRANSVERSE_DISTANCE_WEIGHT, TRANSVERSE_DISTANCE_WEIGHT, 1.0])
    count = min(DISPLACEMENT_FIT_POINTS, len(outline))
    neighbours = cKDTree(outline * squeezed).query(points * squeezed, count)
    distance, near = (np.asarray(x) for x in neighbours)
    confidence = 1.0 - (distance / (1.001 * distance[:, -1:])) ** 2
    offsets = (outline[near] - points[:, None]) / np.abs(outline).max()
    terms = np.concatenate([np.ones((*near.shape, 1)), offsets], axis=2) * confidence[..., None]
    weights = np.linalg.pinv(terms)[:, 0] * confidence
    return np.asarray(np.einsum("ps,psal->pal", weights, piece.displaced[piece.outer][near]))


def _revolved(
    fields: MeridianFields, units: tuple[Unit, ...], pieces: Sequence[tuple[float, float]]
) -> ShownCut:
    """The outline of the uncut pin turned about the axis, outside of the pieces."""
    ends = np.arange(fields.skin).reshape(-1, 5)[:, [0, 4]]
    rows, part = ends, np.tile([0.0, 1.0], (len(ends), 1))
    # Edges of the outline, cut where pieces begin and end: each from a to b, from and to a part of
    # its length.
    for low, high in pieces:
        rows, part = _outside_of(fields.points[:, 1], rows, part, low, high)
    a, b, t = rows[:, 0].repeat(2), rows[:, 1].repeat(2), part.ravel()

    def along(values: Floats) -> Floats:
        w = t.reshape(-1, *(1,) * (values.ndim - 1))
        return np.asarray((1.0 - w) * values[a] + w * values[b])

    columns = [fields.loads.index(load) for load, _ in units]
    r, z = along(fields.points[: fields.skin]).T
    stress, moved = (
        along(x[: fields.skin])[..., columns] for x in (fields.stress, fields.displacement)
    )
    sectors = np.arange(CUT_VIEW_SECTORS)
    angle = sectors * 2.0 * np.pi / CUT_VIEW_SECTORS
    heights = np.broadcast_to(z[:, None], (len(z), CUT_VIEW_SECTORS))
    points = np.stack([r[:, None] * np.cos(angle), r[:, None] * np.sin(angle), heights], axis=2)
    first = CUT_VIEW_SECTORS * 2 * np.arange(len(rows))[:, None]
    i, j = first + sectors, first + (sectors + 1) % CUT_VIEW_SECTORS
    quads = np.stack([i, j, j + CUT_VIEW_SECTORS, i + CUT_VIEW_SECTORS], axis=2).reshape(-1, 4)
    everywhere = np.ones(len(a) * CUT_VIEW_SECTORS, dtype=bool)
    return ShownCut(
        points.reshape(-1, 3),
        quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3),
        cartesian(stress[:, None], angle, 0.0, units).reshape(-1, 6, len(units)),
        of_units(moved.repeat(CUT_VIEW_SECTORS, axis=0), np.tile(angle, len(a)), units),
        everywhere,
        everywhere,
        np.stack([a, b], axis=1).repeat(CUT_VIEW_SECTORS, axis=0),
    )


def _outside_of(
    z: Floats, rows: Ints, part: Floats, low: float, high: float
) -> tuple[Ints, Floats]:
    """The parts of edges that lie outside an interval of z.

    rows: (E, 2) numbers of the points of each edge.
    part: (E, 2) where each edge begins and ends, of its length.
    low, high: ends of the interval, m.
    """
    out_rows, out_part = [], []
    for (a, b), (s, t) in zip(rows, part, strict=True):
        at = [z[a] + x * (z[b] - z[a]) for x in (s, t)]
        if max(at) <= low or min(at) >= high:
            out_rows.append((a, b))
            out_part.append((s, t))
            continue
        for end in (low, high):
            if min(at) < end < max(at):
                cut = (end - z[a]) / (z[b] - z[a])
                outer = (s, cut) if (at[0] < end) == (end == low) else (cut, t)
                out_rows.append((a, b))
                out_part.append(outer)
    return np.array(out_rows, dtype=np.int64).reshape(-1, 2), np.array(out_part).reshape(-1, 2)

"""Results of a cut pin: the harmonic model of the uncut one, and local solids about its cuts."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fea.core.mesh_result import MeshResult
from fea.core.pin_loads import AnyLoads, PinLoads
from fea.core.solution import Picture
from fea.core.voigt import ENTRIES, TENSOR
from fea.cut.local_fields import (
    RATIO,
    RISE,
    LocalFields,
    LocalFineness,
    local_fields,
    mesh_of,
    section_points,
)
from fea.cut.region import surface_ends, zone
from fea.cut.supports import ClampMotions, Support, motions, reactions
from fea.harmonic.evaluate import (
    HarmonicAnswer,
    HarmonicSolution,
    SectionProblem,
    harmonic_result,
    harmonic_solution,
)
from fea.harmonic.fields import MeridianFields
from fea.harmonic.stress_recovery import NOWHERE
from fea.singular.singularities import VARIED, Singularity
from fea.solid.nodal_loads import Unit
from fea.solid.superposition import squares
from geometry import CutPin
from geometry.arrays import Floats, Ints, Mask
from geometry.mesh.cut_piece import Piece
from geometry.mesh.sizing import Grade

FINE = 0.25  # element of the first section about a cut, of its radius
GROWTH = 0.5  # of that with the distance
LEAST = 1e-3  # of the stress: what brings less is solved as if it brought so much
SECTORS = 48  # of the surface that is shown, away from the pieces


@dataclass(frozen=True)
class CutSolution:
    """The uncut pin, whose stress where it is cut does not count, and the pieces about the cuts.
    reactions: motions of redundant clamps that go with loads.
    """

    section: HarmonicSolution
    pieces: tuple[LocalFields, ...]
    reactions: ClampMotions

    @property
    def corners(self) -> tuple[Singularity, ...]:
        """Sharp inner corners of the cuts."""
        return tuple(c.singularity for piece in self.pieces for c in piece.corners)

    def idle(self, results: Sequence[tuple[PinLoads, MeshResult]]) -> tuple[LocalFields, ...]:
        """Pieces that need no finer mesh: in no case may their stress reach the largest one, nor
        swing as much as in another piece.
        """
        out = set(range(len(self.pieces)))
        for loads, result in results:
            held = self.reactions.held(loads)
            swings = [piece.swing(held) * (1.0 + RISE / piece.finer**2) for piece in self.pieces]
            for k, piece in enumerate(self.pieces):
                most = piece.may_reach(held, result.maximum)
                if most or (len(loads) > 1 and swings[k] >= max(swings) / (1.0 + RISE)):
                    out.discard(k)
        return tuple(self.pieces[k] for k in sorted(out))


def cut_solution(
    problem: SectionProblem,
    pieces: Sequence[Piece],
    level: int,
    before: Collection[MeshResult] = (),
    bands: Sequence[tuple[float, float]] = (),
    distance: float = 0.1,
    finer: LocalFineness | None = None,
    kept: Sequence[LocalFields] = (),
) -> CutSolution:
    """As fea.harmonic.evaluate.harmonic_solution, on mesh number `level` of section and pieces.
    bands: loaded ones with cuts in them (fea.cut.region.loaded_bands); distance: as
    fea.cut.inner_corners; finer: of the pieces, in place of the level's; kept: what is
    known of pieces that this mesh need not know better.

    Raises: MeshError, SolveError.
    """
    material, clamps, cases = problem.material, problem.clamps, problem.cases
    high = [p for result in before for p in result.local_high]
    finer = finer or LocalFineness.of(level)
    known = [next((k for k in kept if k.piece == piece), None) for piece in pieces]
    models = [
        mesh_of(piece, material, clamps, finer, high, bands)
        for piece, there in zip(pieces, known, strict=True)
        if there is None
    ]
    points = [section_points(model) for model in models]
    supports = _supports(problem)
    moved = motions(supports)
    section = harmonic_solution(
        replace(problem, besides=tuple(dict.fromkeys(load for load, _ in moved))),
        level, RATIO, before,
        np.concatenate([NOWHERE, *points]), [_fine(piece, level) for piece in pieces],
    )  # fmt: skip
    at = np.split(section.elsewhere, np.cumsum([len(p) for p in points]))
    units = _units(cases) or tuple((load, load.phases[0]) for load in section.fields.loads[:1])
    units += moved
    weight = _weight(cases, units, section.fields)
    new = iter(
        local_fields(model, section.fields, stress, units, problem.singularities, distance, weight)
        for model, stress in zip(models, at[:-1], strict=True)
    )
    found = tuple(there or next(new) for there in known)
    fields = _without(section.fields, [zone(piece) for piece in pieces])
    section = replace(section, fields=fields, elsewhere=NOWHERE)
    return CutSolution(section, found, reactions(supports, found))


def _supports(problem: SectionProblem) -> list[Support]:
    """The clamps of a section in the order of z."""
    cut = CutPin(problem.pin)
    found = [Support(name, 0.5 * sum(surface_ends(cut, name))) for name in problem.clamps]
    return sorted(found, key=lambda support: support.z)


def _fine(piece: Piece, level: int) -> Grade:
    """How fine the section is about a piece's cuts."""
    radius = piece.profile.largest_diameter / 2.0
    low, high = zone(piece)
    places = np.linspace(low, high, max(2, round((high - low) / radius)))
    at = tuple((x * radius, float(z)) for z in places for x in (0.2, 0.8))
    return Grade(at, radius * FINE / RATIO ** (level / 2.0), radius, GROWTH)


def _units(cases: tuple[PinLoads, ...]) -> tuple[Unit, ...]:
    """Unit loads in the phases in which they ever act, of a motion in all."""
    found: dict[Unit, None] = {}
    for case in cases:
        for load, amounts in case.coefficients().items():
            found |= {
                (load, p): None
                for p in load.phases
                if case.times is not None or amounts[:, p].any()
            }
    return tuple(found)


def _weight(cases: tuple[PinLoads, ...], units: tuple[Unit, ...], fields: MeridianFields) -> Floats:
    """How much of the stress in any case a unit load brings, (L,): 1 the most; of one whose amount
    is not known here, 1, too.
    """
    own = [fields.loads.index(load) for load, _ in units]
    stress, out = np.abs(fields.stress).max(axis=(0, 1))[own], np.zeros(len(units))
    for case in cases:
        amounts = case.coefficients()
        most = np.array([np.abs(amounts[u][:, p]).max() if u in amounts else 0.0 for u, p in units])
        each = most * stress
        out = np.maximum(out, each / (each.max() or 1.0))
    known = {load for case in cases for load in case.coefficients()}
    return np.where([u in known for u, _ in units], np.maximum(out, LEAST), 1.0)


def _without(fields: MeridianFields, zones: Sequence[tuple[float, float]]) -> MeridianFields:
    z = fields.points[:, 1]
    cut = [np.flatnonzero((z >= low) & (z <= high)) for low, high in zones]
    return replace(fields, unread=np.unique(np.concatenate([fields.unread, *cut])))


@dataclass(frozen=True)
class ShownCut:
    """The surface as it is shown: points (P, 3) m, triangles (M, 3), and of L unit loads, each in
    one phase, stress (P, 6, L) Pa and displacement (P, 3, L) m; read: (P,) where the maximum is
    looked for.
    """

    points: Floats
    triangles: Ints
    stress: Floats
    displacement: Floats
    read: Mask


class CutAnswer:
    """What a solution says of any loads made of its unit loads (fea.core.solution)."""

    def __init__(self, solution: CutSolution, singularities: tuple[Singularity, ...]) -> None:
        self.solution, self.singularities = solution, singularities
        self.section = HarmonicAnswer(solution.section, singularities)

    def maxima(self, loads: AnyLoads, least: float = 0.0) -> Floats:
        """Largest von Mises stress (T,) Pa at every instant outside the singularities."""
        loads = self.solution.reactions.held(loads)
        local = np.max([piece.largest(loads)[0] for piece in self.solution.pieces], axis=0)
        uncut = self.section.maxima(loads, max(least, float(local.min())))
        return np.asarray(np.maximum(local, uncut))

    def largest(self, loads: AnyLoads) -> tuple[float, int]:
        """The largest of these (Pa), and the number of its instant."""
        loads = self.solution.reactions.held(loads)
        value, instant = self.section.largest(loads)
        for piece in self.solution.pieces:
            here, _ = piece.largest(loads)
            if here.max() > value:
                value, instant = float(here.max()), int(here.argmax())
        return value, instant

    def picture(self, loads: PinLoads, instant: int) -> Picture:
        """The surface at one instant, with its envelope over all."""
        surface, c = self.surface, self.coefficients(loads)
        largest = np.zeros(len(surface.points))
        found = squares(surface.stress)
        for k in range(0, len(c), 64):
            np.maximum(largest, found(c[k : k + 64]).max(axis=1), out=largest)
        return Picture(
            points=surface.points,
            cells=surface.triangles,
            cell_type="triangle",
            displacement=surface.displacement @ c[instant],
            stress=surface.stress @ c[instant],
            envelope=np.sqrt(largest),
        )

    def coefficients(self, loads: AnyLoads) -> Floats:
        """How much of each unit load of the surface acts at each instant, (T, L)."""
        return self.solution.pieces[0].coefficients(self.solution.reactions.held(loads))

    @cached_property
    def surface(self) -> ShownCut:
        """The pieces in place, the uncut pin between them."""
        pieces = self.solution.pieces
        between = [(p.piece.z0, p.piece.z1) for p in pieces]
        uncut = _revolved(self.section, pieces[0].units, between)
        parts = [uncut, *(_shown(piece) for piece in pieces)]
        starts = np.cumsum([0, *(len(part.points) for part in parts)])
        return ShownCut(
            np.concatenate([p.points for p in parts]),
            np.concatenate([p.triangles + i for p, i in zip(parts, starts, strict=False)]),
            np.concatenate([p.stress for p in parts]),
            np.concatenate([p.displacement for p in parts]),
            np.concatenate([p.read for p in parts]),
        )


def _shown(piece: LocalFields) -> ShownCut:
    return ShownCut(piece.points, piece.triangles, piece.stress, piece.displacement, piece.read)


def _revolved(
    section: HarmonicAnswer, units: tuple[Unit, ...], pieces: Sequence[tuple[float, float]]
) -> ShownCut:
    """The outline turned about the axis, without what lies in the pieces."""
    fields = section.fields
    ends = np.arange(fields.skin).reshape(-1, 5)[:, [0, 4]]
    rows, part = [ends], [np.tile([0.0, 1.0], (len(ends), 1))]
    keep_rows, keep_part = np.concatenate(rows), np.concatenate(part)
    for low, high in pieces:
        keep_rows, keep_part = _outside_of(fields.points[:, 1], keep_rows, keep_part, low, high)
    a, b, t = keep_rows[:, 0].repeat(2), keep_rows[:, 1].repeat(2), keep_part.ravel()

    def along(values: Floats) -> Floats:
        w = t.reshape(-1, *(1,) * (values.ndim - 1))
        return np.asarray((1.0 - w) * values[a] + w * values[b])

    own = [fields.loads.index(load) for load, _ in units]
    r, z = along(fields.points[: fields.skin]).T
    stress, moved = (
        along(x[: fields.skin])[..., own] for x in (fields.stress, fields.displacement)
    )
    angle = np.arange(SECTORS) * 2.0 * np.pi / SECTORS
    n, phase = (np.array(x) for x in ([load.n for load, _ in units], [p for _, p in units]))
    psi = n * angle[:, None] - phase * np.pi / 2.0
    even, odd = np.cos(psi), np.sin(psi)
    stress = np.where([[x] for x in (True, True, True, False, True, False)],
                      stress[:, None] * even[:, None], stress[:, None] * odd[:, None])  # fmt: skip
    moved = np.where([[True], [False], [True]], moved[:, None] * even[:, None],
                     moved[:, None] * odd[:, None])  # fmt: skip
    turn = np.zeros((SECTORS, 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
    turn[:, 1, 0] = np.sin(angle)
    turn[:, 0, 1] = -np.sin(angle)
    turn[:, 2, 2] = 1.0
    tensor = np.einsum("sai,psijl,sbj->psabl", turn, stress[:, :, TENSOR], turn, optimize=True)
    points = np.stack([r[:, None] * np.cos(angle), r[:, None] * np.sin(angle),
                       np.broadcast_to(z[:, None], (len(z), SECTORS))], axis=2)  # fmt: skip
    i = SECTORS * 2 * np.arange(len(keep_rows))[:, None] + np.arange(SECTORS)
    j = SECTORS * 2 * np.arange(len(keep_rows))[:, None] + (np.arange(SECTORS) + 1) % SECTORS
    quads = np.stack([i, j, j + SECTORS, i + SECTORS], axis=2).reshape(-1, 4)
    read = fields.outside(section.singularities)[: fields.skin]
    count = len(units)
    return ShownCut(
        points.reshape(-1, 3),
        quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3),
        np.stack([tensor[:, :, a, b] for a, b in ENTRIES], axis=2).reshape(-1, 6, count),
        np.einsum("sai,psil->psal", turn, moved).reshape(-1, 3, count),
        (read[a] & read[b]).repeat(SECTORS),
    )


def _outside_of(
    z: Floats, rows: Ints, part: Floats, low: float, high: float
) -> tuple[Ints, Floats]:
    """Edges between points `rows` (E, 2), from one to another part of their length (E, 2), without
    what lies between two z.
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


def cut_result(
    solution: CutSolution,
    singularities: tuple[Singularity, ...],
    loads: PinLoads,
    own: Collection[Singularity] | None = None,
) -> MeshResult:
    """Maximum outside the singularities, of the uncut pin away from its cuts and about these."""
    held = solution.reactions.held(loads)
    assert isinstance(held, PinLoads)
    loads = held
    result = harmonic_result(solution.section, singularities, loads, own)
    high: list[tuple[float, float, float]] = []
    highest, whole = None, result.maximum
    for piece in solution.pieces:
        value, point = piece.largest(loads)
        instant = int(value.argmax())
        high += piece.high(loads, instant)
        if value[instant] > whole:
            whole, highest = float(value[instant]), (piece, instant, int(point[instant]))
    parts = [result.unknowns, *(piece.unknowns for piece in solution.pieces)]
    inside = tuple(at for piece in solution.pieces for at in piece.inside(loads))
    result = replace(
        result,
        unknowns=sum(parts),
        at_once=max(parts),
        local_high=tuple(high),
        energy=None,
        singularities=(*result.singularities, *inside),
    )
    interval = result.interval or (result.maximum, result.maximum)
    if highest is not None:
        piece, instant, at = highest
        x, y, z = piece.points[at].tolist()
        beside = (p for p in solution.pieces if p is not piece)
        others = sum(p.felt_at((x, y, z), loads, instant) for p in beside)
        result = replace(
            result,
            maximum=whole,
            instant=instant,
            location=(x, y, z),
            scatter=whole * float(piece.scatter[at]),
            truncated=piece.left_at_ends(loads, instant) + others,
            beside=others,
        )
    if not result.governed:
        return replace(result, interval=None)
    varied = [max(p.varied(loads, times) for p in solution.pieces) for times in VARIED]
    low, top = max(interval[0], min(varied)), max(interval[1], max(varied))
    return replace(result, interval=(low, top))

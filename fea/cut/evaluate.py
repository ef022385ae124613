"""The maxima of a cut pin: the harmonic model of the uncut pin, and local solids about its cuts."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fea.core.memory import most_unknowns
from fea.core.mesh_result import MeshMaximum
from fea.core.model import MeshBefore, MeshProblem, MeshSequence
from fea.core.pin_loads import PinLoads, Unit
from fea.core.zone import DISTANCE_VARIATIONS, Zone
from fea.cut.field import CutField, CutSolution
from fea.cut.local_fields import LocalFields
from fea.cut.local_solution import LOCAL_MESH_RATIO, LocalFineness, LocalMesh, UncutPin
from fea.cut.region import PIECE_REACH, REACH_FACTOR, pieces, surface_ends, zone
from fea.cut.supports import ClampReaction, motions, reactions
from fea.harmonic.evaluate import harmonic_result, section_problem
from fea.harmonic.fields import MeridianFields
from fea.harmonic.first_mesh import FirstMesh
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.harmonic.stress_recovery import NO_POINTS
from geometry import CutPin
from geometry.mesh.cut_piece import Piece
from geometry.mesh.sizing import Grade
from pinbase.arrays import Floats
from pinbase.memo import Memo

CUT_SECTION_ELEMENT = 0.25  # element size of the first section about a cut, of the piece's radius
# The scatter was measured on holes under superposed tension, bending and torsion (benchmarks
# cut-scatter), where 95 % of maxima are off by less.
LOCAL_MESHES = MeshSequence(
    ratio=LOCAL_MESH_RATIO, growth=1.4, max_meshes=5, max_unknowns=600_000, scatter=0.05
)
# Factor of the distance up to which cuts share a local solid, if local solids disturb each other.
PIECE_SPACING_FACTOR = 2.0
TRUNCATION_SHARE = 0.2  # of the tolerance: a larger truncation error makes local solids longer
CUT_SECTION_GROWTH = 0.5  # growth of the section's elements with the distance from a cut
# The relative stress of a unit load is rounded up to a power of this, so that the same solution
# serves other amounts of the loads. The least is this squared.
UNIT_WEIGHT_STEP = 1.0 / 32.0


def cut_solution(
    problem: SectionProblem,
    pieces: Sequence[Piece],
    level: int,
    before: Collection[MeshMaximum] = (),
    bands: Sequence[tuple[float, float]] = (),
    distance: float = 0.1,
    finer: LocalFineness | None = None,
    reused: Sequence[LocalFields] = (),
    max_unknowns: float = math.inf,
) -> CutSolution:
    """Solve all unit loads on mesh number `level` of the section and of the pieces.

    The arguments are those of fea.harmonic.section_solution.harmonic_solution, and:
    bands: ends of the loaded bands that have cuts (fea.cut.region.loaded_bands).
    distance: the excluded distance, as in fea.cut.inner_corners.
    finer: fineness of the pieces; by default that of the level.
    reused: fields of pieces that need no finer mesh.
    max_unknowns: largest number of unknowns of a piece.

    Raises: MeshError, SolveError.
    """
    material, clamps, cases = problem.material, problem.clamps, problem.cases
    high = [p for result in before for p in result.local_high]
    finer = finer or LocalFineness.of(level)
    known = [next((k for k in reused if k.piece == piece), None) for piece in pieces]
    memo = problem.memo or Memo()
    meshes = [
        LocalMesh(piece, material, clamps, finer, high, bands, max_unknowns, memo)
        for piece, reused_piece in zip(pieces, known, strict=True)
        if reused_piece is None
    ]
    points = [mesh.section_points for mesh in meshes]
    supports = _supports(problem)
    moved = motions(supports)
    section = harmonic_solution(
        replace(problem, extra_loads=tuple(dict.fromkeys(load for load, _ in moved))),
        level, LOCAL_MESH_RATIO, before,
        np.concatenate([NO_POINTS, *points]), [fine_about(piece, level) for piece in pieces],
    )  # fmt: skip
    at = np.split(section.elsewhere, np.cumsum([len(p) for p in points]))
    units = _units(cases) or tuple((load, load.phases[0]) for load in section.fields.loads[:1])
    units += moved
    uncut, weight = section.fields, _weight(cases, units, section.fields)
    solved = UncutPin(uncut, units, problem.singularities, distance, weight)
    new = iter(mesh.fields(solved, x) for mesh, x in zip(meshes, at[:-1], strict=True))
    local = tuple(reused_piece or next(new) for reused_piece in known)
    fields = _without(uncut, [zone(piece) for piece in pieces])
    section = replace(section, fields=fields, elsewhere=NO_POINTS)
    first_clamp = next(iter(supports), None)
    return CutSolution(section, local, uncut, reactions(supports, local), first_clamp)


def _supports(problem: SectionProblem) -> list[ClampReaction]:
    """The clamps of a section in the order of z."""
    cut = CutPin(problem.pin)
    reactions = [ClampReaction(name, 0.5 * sum(surface_ends(cut, name))) for name in problem.clamps]
    return sorted(reactions, key=lambda support: support.z)


def fine_about(piece: Piece, level: int) -> Grade:
    """The fineness of the section about a piece's cuts on mesh number `level`."""
    radius = piece.profile.largest_diameter / 2.0
    low, high = zone(piece)
    places = np.linspace(low, high, max(2, round((high - low) / radius)))
    at = tuple((x * radius, float(z)) for z in places for x in (0.2, 0.8))
    return Grade(
        at,
        radius * CUT_SECTION_ELEMENT / LOCAL_MESH_RATIO ** (level / 2.0),
        radius,
        CUT_SECTION_GROWTH,
    )


def _units(cases: tuple[PinLoads, ...]) -> tuple[Unit, ...]:
    """The unit loads in the phases in which they act in any case; in all phases for a motion."""
    units: dict[Unit, None] = {}
    for case in cases:
        for load, amounts in case.coefficients().items():
            units |= {
                (load, p): None
                for p in load.phases
                if case.times is not None or amounts[:, p].any()
            }
    return tuple(units)


def _weight(cases: tuple[PinLoads, ...], units: tuple[Unit, ...], fields: MeridianFields) -> Floats:
    """The stress (L,) of each unit load, relative to the largest and rounded up; the largest over
    all cases.

    It is 1 for the load with the largest stress, and for a load whose amount is not known here.
    """
    columns = [fields.loads.index(load) for load, _ in units]
    stress, out = np.abs(fields.stress).max(axis=(0, 1))[columns], np.zeros(len(units))
    for case in cases:
        amounts = case.coefficients()
        most = np.array([np.abs(amounts[u][:, p]).max() if u in amounts else 0.0 for u, p in units])
        shares = most * stress
        out = np.maximum(out, shares / (shares.max() or 1.0))
    known = {load for case in cases for load in case.coefficients()}
    steps = np.floor(np.log(np.maximum(out, UNIT_WEIGHT_STEP**2)) / np.log(UNIT_WEIGHT_STEP))
    rounded = UNIT_WEIGHT_STEP**steps
    return np.where([u in known for u, _ in units], rounded, 1.0)


def _without(fields: MeridianFields, zones: Sequence[tuple[float, float]]) -> MeridianFields:
    z = fields.points[:, 1]
    cut = [np.flatnonzero((z >= low) & (z <= high)) for low, high in zones]
    return replace(fields, unread=np.unique(np.concatenate([fields.unread, *cut])))


@dataclass(frozen=True)
class CutMesh:
    """One mesh solved with local solids (fea.core.model.MeshSolution).

    reach: the length of the solids beyond the cuts, of the diameter.
    spacing: factor of the distance up to which cuts share a solid (fea.cut.region.pieces).
    """

    problem: MeshProblem
    solution: CutSolution
    reach: float
    spacing: float

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones of the problem, and the sharp corners of the cuts."""
        return (*self.problem.zones, *self.solution.corners)

    @property
    def solids(self) -> tuple[tuple[float, float], ...]:
        """The ends of the solids about the cuts, z in m."""
        return tuple((p.piece.z0, p.piece.z1) for p in self.solution.pieces)

    def field(self, case: str) -> CutField:
        """The stress of one case, which is not read in the zones that its loads make singular."""
        return CutField(self.solution, self.problem.zones_of(case))

    def maximum(self, loads: PinLoads) -> MeshMaximum:
        """The maximum of a case."""
        return cut_result(
            self.solution, self.problem.zones, loads, self.problem.zones_of(loads.case)
        )


class LocalSolids:
    """The model of a body of revolution with cuts, solid about the cuts (fea.core.model.Model).

    The pin of a problem is the one without cuts.
    cut: the pin with its cuts.
    bands: ends of the loaded bands that have cuts (fea.cut.region.loaded_bands).
    memo: a store of meshes and unit fields, shared with other problems.
    first: solves the first mesh where contact pressures act.
    """

    name: Literal["harmonic+local"] = "harmonic+local"
    meshes = LOCAL_MESHES

    def __init__(
        self,
        cut: CutPin,
        bands: tuple[tuple[float, float], ...] = (),
        memo: Memo | None = None,
        first: FirstMesh | None = None,
    ) -> None:
        self._cut, self._bands = cut, bands
        self._memo, self._first = memo, first

    def solve(self, problem: MeshProblem, level: int, before: MeshBefore | None = None) -> CutMesh:
        """Solve all unit loads on mesh number `level` (fea.core.model.Model.solve).

        Local solids grow where their ends or each other disturb the maximum on the mesh before.
        Those whose stress matters in no case are reused from it.
        """
        reach, spacing = PIECE_REACH, 1.0
        reused: tuple[LocalFields, ...] = ()
        results = () if before is None else tuple(before.results)
        below = None if before is None else before.solution
        if isinstance(below, CutMesh) and before is not None:
            reach, spacing = below.reach, below.spacing
            cases = [(case, before.maxima[case.case]) for case in problem.cases]
            reused = below.solution.idle(cases)
            most = TRUNCATION_SHARE * problem.tolerance
            if any(r.beside > most * r.maximum for r in results):
                spacing *= PIECE_SPACING_FACTOR
            elif level > 1 and any(r.truncated > most * r.maximum for r in results):
                reach *= REACH_FACTOR
        local = pieces(self._cut, problem.clamps, reach, self._bands, spacing)
        posed = section_problem(problem, self._memo, self._first)
        count = len({load for load, _ in _units(problem.cases)}) or 1
        solution = cut_solution(
            posed, local, level, results, self._bands, problem.distance, reused=reused,
            max_unknowns=most_unknowns(problem.memory, count),
        )  # fmt: skip
        return CutMesh(problem, solution, reach, spacing)


def cut_result(
    solution: CutSolution,
    singularities: tuple[Zone, ...],
    loads: PinLoads,
    case_zones: Collection[Zone] | None = None,
) -> MeshMaximum:
    """The maximum outside the singularities, of the uncut pin away from its cuts and of the local
    solids.

    singularities: those of the uncut pin in all cases.
    case_zones: those that this case makes singular; all by default.
    """
    all_loads = solution.reactions.with_motions(loads)
    assert isinstance(all_loads, PinLoads)
    loads = all_loads
    result = harmonic_result(solution.section, singularities, loads, case_zones)
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
    varied = [max(p.varied(loads, times) for p in solution.pieces) for times in DISTANCE_VARIATIONS]
    low, top = max(interval[0], min(varied)), max(interval[1], max(varied))
    return replace(result, interval=(low, top))

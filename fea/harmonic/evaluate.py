"""The maxima of a pin's cases in the harmonic model on one mesh."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from fea.core.mesh_result import MeshMaximum, at_angle
from fea.core.model import MeshBefore, MeshProblem, MeshSequence
from fea.core.pin_loads import PinLoads
from fea.core.zone import Zone
from fea.harmonic.field import HarmonicField
from fea.harmonic.first_mesh import FirstMesh
from fea.harmonic.free_surface import reader
from fea.harmonic.near_singularities import inside, interval
from fea.harmonic.section_solution import HarmonicSolution, SectionProblem, harmonic_solution
from fea.harmonic.superposition import Circumference, Crest
from geometry import ArgumentError, body_of_revolution
from pinbase.arrays import Floats, Mask
from pinbase.memo import Memo

# The largest remainder of a pressure's series over its last term: terms vary as +-1/(n^2 - 1).
SERIES_REMAINDER_RATIO = 0.6
# Places of high stress: least stress, of the maximum; least spacing, of r; largest number.
REFINE_ABOVE, MIN_SPACING, MAX_PLACES = 0.95, 0.1, 3
# The scatter was measured on random shoulders (benchmarks coverage). Nodes lie on the edges of
# zones, so that the maximum outside converges at least linearly.
SECTION_MESHES = MeshSequence(
    ratio=2.0**0.5, growth=2.0, max_meshes=7, max_unknowns=400_000, scatter=0.026, min_order=1.0
)
# The first mesh resolves the rings of a contact pressure, so that two meshes are enough.
PRESSED_SECTION_MESHES = replace(SECTION_MESHES, ratio=2.0, min_meshes=2)


@dataclass(frozen=True)
class HarmonicMesh:
    """One mesh solved by the harmonic model (fea.core.model.MeshSolution)."""

    problem: MeshProblem
    solution: HarmonicSolution

    solids: ClassVar[tuple[tuple[float, float], ...]] = ()

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones of the problem."""
        return self.problem.zones

    def field(self, case: str) -> HarmonicField:
        """The stress of one case, which is not read in the zones that its loads make singular."""
        return HarmonicField(self.solution, self.problem.zones_of(case))

    def maximum(self, loads: PinLoads) -> MeshMaximum:
        """The maximum of a case."""
        return harmonic_result(
            self.solution, self.problem.zones, loads, self.problem.zones_of(loads.case)
        )


class Harmonic:
    """The harmonic model of any body of revolution (fea.core.model.Model).

    memo: a store of meshes and unit fields, shared with other problems.
    first: solves the first mesh where contact pressures act.
    pressed: whether contact pressures act, so that fewer meshes are needed.
    """

    name = "harmonic"

    def __init__(
        self, memo: Memo | None = None, first: FirstMesh | None = None, pressed: bool = False
    ) -> None:
        self.meshes = PRESSED_SECTION_MESHES if pressed else SECTION_MESHES
        self._memo, self._first = memo, first

    def solve(
        self, problem: MeshProblem, level: int, before: MeshBefore | None = None
    ) -> HarmonicMesh:
        """Solve all unit loads on mesh number `level` (fea.core.model.Model.solve)."""
        posed = section_problem(problem, self._memo, self._first)
        results = () if before is None else before.results
        return HarmonicMesh(problem, harmonic_solution(posed, level, self.meshes.ratio, results))


def section_problem(
    problem: MeshProblem, memo: Memo | None = None, first: FirstMesh | None = None
) -> SectionProblem:
    """The problem of the section of a pin.

    Raises: ArgumentError for a pin that is not a body of revolution.
    """
    pin = body_of_revolution(problem.pin)
    if pin is None:
        raise ArgumentError(
            f"pin {problem.pin.name} is not a body of revolution", "not-axisymmetric"
        )
    return SectionProblem(
        pin, problem.material, problem.clamps, problem.cases, problem.zones, first, memo=memo
    )


def harmonic_result(
    solution: HarmonicSolution,
    singularities: tuple[Zone, ...],
    loads: PinLoads,
    case_zones: Collection[Zone] | None = None,
) -> MeshMaximum:
    """The maximum outside the singularities, and the maximum inside each of them.

    singularities: those of all cases.
    case_zones: those that this case makes singular; all by default.
    """
    around = reader(solution.fields, loads, solution.nu)
    fields = around.fields
    excluded = singularities if case_zones is None else case_zones
    among = fields.outside(excluded)
    top = around.top(among)
    result = MeshMaximum(
        unknowns=fields.unknowns,
        maximum=top.value,
        instant=top.instant,
        location=at_angle(fields.points[top.point], top.angle),
        singularities=tuple(
            replace(inside(fields, around, p, close, solution.nu), acts=p in excluded)
            for p, close in zip(singularities, solution.close, strict=True)
        ),
        left_out=_left_out(around, loads, top),
        high=high_places(around, fields.points, among, top),
        quiet=solution.quiet,
        energy=fields.energy,
    )
    return (
        replace(result, interval=interval(fields, around, excluded)) if result.governed else result
    )


def high_places(
    around: Circumference, points: Floats, among: Mask, top: Crest, least: float = REFINE_ABOVE
) -> tuple[tuple[float, float], ...]:
    """The points (r, z), m, at which stress is nearly the maximum, the highest first, well apart.

    among: (S,) mask of the points that are searched.
    least: the least stress there, as a fraction of the maximum.
    """
    rows = np.flatnonzero(among)
    now = slice(top.instant, top.instant + 1)
    for bound in (around.reach, around.bound):
        rows = rows[bound(rows, now)[:, 0] >= least * top.value]
    value, _ = around.largest_over_angle(rows, np.full(len(rows), top.instant))
    places: list[Floats] = []
    for k in np.argsort(-value, kind="stable"):
        if value[k] < least * top.value or len(places) == MAX_PLACES:
            break
        at = points[rows[k]]
        if all(np.hypot(*(at - other)) > MIN_SPACING * at[0] for other in places):
            places.append(at)
    return tuple((float(r), float(z)) for r, z in places)


def _left_out(around: Circumference, loads: PinLoads, top: Crest) -> float:
    """The error, Pa, from truncating the series of a bearing pressure.

    It is derived from the stress of the last harmonic at the maximum, since a thin tube that
    becomes oval is affected more by that harmonic than a solid pin.
    """
    if loads.distribution != "cosine" or around.highest != loads.terms:
        return 0.0
    largest = around.highest_harmonic_at(np.array([top.point]), np.array([top.instant]))
    return SERIES_REMAINDER_RATIO * float(largest[0])

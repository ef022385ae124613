"""Results of the harmonic model for a pin's cases on one mesh."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial

import numpy as np

from fea.core.material import Material
from fea.core.mesh_result import FEATURE_READING_DISTANCE, MeshMaximum, Point
from fea.core.model import MeshBefore, MeshProblem, MeshSequence
from fea.core.pin_loads import Loads, PinLoads, UnitLoad
from fea.core.solution import Picture
from fea.core.zone import DISTANCE_VARIATIONS, Zone
from fea.harmonic.beneath import just_beneath
from fea.harmonic.fields import MeridianFields
from fea.harmonic.free_surface import reader
from fea.harmonic.kept_fields import FirstMesh
from fea.harmonic.model import HarmonicModel
from fea.harmonic.near_singularities import CORNER_ELEMENT_SIZES, felt_beyond, inside, interval
from fea.harmonic.quiet_corners import low_stress_fillets, numerous_fillets
from fea.harmonic.revolve import revolve
from fea.harmonic.stress_recovery import NO_POINTS
from fea.harmonic.superposition import Circumference, Crest
from fea.singular.probes import rim
from fea.singular.singularities import smooth_edges
from geometry import ArgumentError, Pin, body_of_revolution
from geometry.mesh.section_mesh import MeridianMesh, meridian_mesh
from geometry.mesh.sizing import Grade, SectionSize, Spot, size_at
from pinbase.arrays import Floats, Mask

FIRST_MESH_SIZE = SectionSize()  # of the first mesh
BAND_EDGE_ELEMENT = 0.04  # element at the edge of any band, of the diameter
LOAD_EDGE_ELEMENT = 0.2  # element at a load's edge, of the excluded distance
MIN_ZONE_STRESS = 0.5  # of the maximum elsewhere
# The remainder of a pressure's series over its last harmonic, at most: terms go as +-1/(n^2 - 1).
SERIES_REMAINDER_RATIO = 0.6
LOW_STRESS_POWER = 0.5  # power of the refinement where stresses are low
# Places of high stress: least stress, of the maximum; least distance, of r; their number at most.
REFINE_ABOVE, MIN_SPACING, MAX_PLACES = 0.95, 0.1, 3
RING_END_ELEMENT = 0.25  # of a ring of contact pressure: the elements at its ends
# The scatter was measured on random shoulders (benchmarks coverage). Nodes lie on the edges of
# zones, so that the maximum outside converges at least linearly.
SECTION_MESHES = MeshSequence(
    ratio=2.0**0.5, growth=2.0, max_meshes=7, max_unknowns=400_000, scatter=0.026, min_order=1.0
)
# The first mesh resolves the rings of a contact pressure, so that two are enough.
PRESSED_SECTION_MESHES = replace(SECTION_MESHES, ratio=2.0, min_meshes=2)
PATCH_ELEMENTS = 2.0  # elements of the first mesh about such a place, in which all are refined


@dataclass(frozen=True)
class HarmonicSolution:
    """The fields of a body of revolution on one mesh.

    close: element size at each singularity, relative to its scale.
    nu: Poisson's ratio.
    ends: where pressures end on the outline, (r, z) in m.
    quiet: fillets where the mesh is coarse (fea.harmonic.quiet_corners).
    elsewhere: stress (P, 6, K) Pa at the points that were requested.
    """

    fields: MeridianFields
    close: tuple[float, ...]
    nu: float
    ends: tuple[tuple[float, float], ...] = ()
    quiet: tuple[int, ...] = ()
    elsewhere: Floats = field(default_factory=lambda: np.zeros((0, 6, 0)))

    @property
    def mesh(self) -> MeridianMesh:
        """The mesh of the section."""
        assert self.fields.mesh is not None
        return self.fields.mesh


@dataclass(frozen=True)
class SectionProblem:
    """A body of revolution of a material, clamped at surfaces (by name), in some cases.

    singularities: those of any of the cases.
    first: where the first mesh is kept for other loads.
    besides: additional unit loads to be solved.
    """

    pin: Pin
    material: Material
    clamps: tuple[str, ...]
    cases: tuple[PinLoads, ...]
    singularities: tuple[Zone, ...]
    first: FirstMesh | None = None
    besides: tuple[UnitLoad, ...] = ()


def harmonic_solution(
    problem: SectionProblem,
    level: int,
    ratio: float,
    before: Collection[MeshMaximum] = (),
    elsewhere: Floats = NO_POINTS,
    grades: Sequence[Grade] = (),
) -> HarmonicSolution:
    """Solve all unit loads of the cases on mesh number `level`, each `ratio` times finer than the
    one before.

    before: mesh results from which to refine: by the ratio where they have high stresses, by its
    root elsewhere; without any, everywhere.
    elsewhere: points (P, 2), r and z in m, at which stress is read too, but no maximum is searched.
    grades: fineness of the mesh at these points.

    Raises: MeshError, SolveError.
    """
    pin, material, cases = problem.pin, problem.material, problem.cases
    singularities = problem.singularities
    close = tuple(
        CORNER_ELEMENT_SIZES[
            min(level, len(CORNER_ELEMENT_SIZES) - 1) if _matters(k, before) else 0
        ]
        for k in range(len(singularities))
    )
    spots = partial(_spots, pin, cases, singularities, close)
    high = dict.fromkeys(singularity for result in before for singularity in result.high)
    finer = list(grades)
    for singularity in high:
        coarse = size_at(pin, FIRST_MESH_SIZE, spots(1.0), singularity)
        now = size_at(pin, FIRST_MESH_SIZE.finer(ratio**level), spots(ratio**level), singularity)
        finer.append(Grade((singularity,), now, PATCH_ELEMENTS * coarse, FIRST_MESH_SIZE.growth))
    factor = ratio ** (level * LOW_STRESS_POWER if high else level)

    loads = _unit_loads(cases) + problem.besides
    rings = tuple(dict.fromkeys(name for load in loads for name, _ in load.parts))
    finer += _at_rings(pin, rings)
    ends = _ends(pin, problem.clamps, loads)

    def solved(size: SectionSize, grades: list[Grade], quiet: tuple[int, ...]) -> MeridianFields:
        places = spots(factor)
        read = np.concatenate([elsewhere, _rims(pin, singularities), just_beneath(pin, rings)])

        def model() -> HarmonicModel:
            section = meridian_mesh(pin, size, places, grades, quiet)
            return HarmonicModel(pin, section, material, problem.clamps)

        elastic = material.youngs_modulus, material.poisson_ratio, material.density
        mesh = size, tuple(places), tuple(grades), quiet, read.tobytes(), ends
        key = pin, elastic, problem.clamps, *mesh
        return (problem.first or FirstMesh()).fields(level, model, key, (loads, read, ends))

    quiet = numerous_fillets(pin)
    if quiet:
        known = [result.quiet for result in before]
        quiet = (
            known[0]
            if known
            else low_stress_fillets(
                pin,
                solved(FIRST_MESH_SIZE, [], quiet),
                cases,
                singularities,
                material.poisson_ratio,
            )
        )
    fields, more = _apart(solved(FIRST_MESH_SIZE.finer(factor), finer, quiet), len(elsewhere))
    return HarmonicSolution(fields, close, material.poisson_ratio, ends, quiet, more)


def _apart(fields: MeridianFields, count: int) -> tuple[MeridianFields, Floats]:
    """The fields without the first points after those that have a displacement, and the stress at
    these.
    """
    if not count:
        return fields, np.zeros((0, *fields.stress.shape[1:]))
    first = len(fields.displacement)
    here, rest = slice(first, first + count), np.r_[:first, first + count : len(fields.points)]
    unread = np.flatnonzero(np.isin(rest, fields.unread))
    body = replace(fields, points=fields.points[rest], stress=fields.stress[rest], unread=unread)
    return body, fields.stress[here]


def _at_rings(pin: Pin, rings: tuple[str, ...]) -> list[Grade]:
    """The fineness of the mesh at the ends of rings of contact pressure.

    It is such that the elements that feel the steps of pressure (fea.core.pressed) lie beside them.
    """
    bands = (pin.band(name) for name in rings)
    return [
        Grade(
            ((b.radius, b.z0), (b.radius, b.z1)),
            RING_END_ELEMENT * b.length,
            0.0,
            FIRST_MESH_SIZE.growth,
        )
        for b in bands
    ]


def _unit_loads(cases: tuple[PinLoads, ...]) -> tuple[UnitLoad, ...]:
    loads = tuple(dict.fromkeys(load for case in cases for load in case.coefficients()))
    return loads or (UnitLoad(cases[0].surfaces[0], "force", 1),)  # whose coefficient is zero


@lru_cache(64)
def _rims(pin: Pin, singularities: tuple[Zone, ...]) -> Floats:
    """The points (P, 2) about singularities at which stress is read, on every mesh of a pin."""
    read = [rim(pin, p, d) for p in singularities for d in _distances(p)]
    return np.concatenate([NO_POINTS, *read])


def _distances(singularity: Zone) -> tuple[float, ...]:
    """The distances from a singularity, m, at which stress is read on a circle about it."""
    radii = (singularity.varied(times).radius for times in (1.0, *DISTANCE_VARIATIONS))
    return tuple(dict.fromkeys((*radii, FEATURE_READING_DISTANCE * singularity.feature)))


def _ends(
    pin: Pin, clamps: tuple[str, ...], loads: tuple[UnitLoad, ...]
) -> tuple[tuple[float, float], ...]:
    """The places where a pressure ends on a smooth surface, (r, z) in m.

    Contact pressure does not end where a cell does: its steps belong to the cells, and are not
    read.
    """
    pushed = {name for load in loads if load.kind == "pressure" for name in load.surfaces}
    if not clamps and any(load.n <= 1 and not load.shears for load in loads):
        pushed |= set(pin.connections)  # which react the imbalance
    cells = {name for load in loads if load.parts for name in load.surfaces}
    return smooth_edges(pin, pushed, clamps, cells)


def _spots(
    pin: Pin,
    cases: tuple[PinLoads, ...],
    singularities: tuple[Zone, ...],
    close: tuple[float, ...],
    factor: float,
) -> list[Spot]:
    """The spots where the mesh is refined: singularities, with elements `close` (of their scale),
    and edges of bands, `factor` times finer than on the first mesh.
    """
    spots = [
        _spot(p, near if p.measured else CORNER_ELEMENT_SIZES[0] / factor, factor)
        for p, near in zip(singularities, close, strict=True)
    ]
    taken = {(s.r, s.z) for s in spots}
    for name in dict.fromkeys(name for case in cases for name in case.surfaces):
        band = pin.band(name)
        for at in {(band.radius, band.z0), (band.radius, band.z1)} - taken:
            d = 2.0 * band.radius
            spots.append(Spot(*at, BAND_EDGE_ELEMENT * d / factor, 4.0 * BAND_EDGE_ELEMENT * d))
    return sorted(spots)


def _spot(singularity: Zone, near: float, factor: float) -> Spot:
    """The spot at a singularity.

    near: size of the element there, of the singularity's scale.
    """
    p = singularity
    size = near * p.scale
    if p.kind == "edge of a load":
        size = LOAD_EDGE_ELEMENT * p.radius / factor
    return Spot(p.r, p.z, size, p.radius)


def _matters(singularity: int, before: Collection[MeshMaximum]) -> bool:
    """Return whether stress in a singularity is so large that it may govern, so that its growth is
    measured.
    """
    return any(
        result.singularities[singularity].felt >= MIN_ZONE_STRESS * result.maximum
        for result in before
    )


@dataclass(frozen=True)
class HarmonicMesh:
    """A mesh solved by the harmonic model (fea.core.model.MeshSolution)."""

    problem: MeshProblem
    solution: HarmonicSolution

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones of the problem."""
        return self.problem.zones

    def field(self, case: str) -> HarmonicField:
        """The stress as one case sees it."""
        return HarmonicField(self.solution, self.problem.zones_of(case))

    def maximum(self, loads: PinLoads) -> MeshMaximum:
        """The maximum of a case."""
        return harmonic_result(
            self.solution, self.problem.zones, loads, self.problem.zones_of(loads.case)
        )


class Harmonic:
    """The harmonic model of any body of revolution (fea.core.model.Model).

    first: the solution on the first mesh of an earlier run.
    pressed: whether contact pressures act.
    """

    name = "harmonic"

    def __init__(self, first: FirstMesh | None = None, pressed: bool = False) -> None:
        self.meshes = PRESSED_SECTION_MESHES if pressed else SECTION_MESHES
        self._first = first or FirstMesh()

    def solve(
        self, problem: MeshProblem, level: int, before: MeshBefore | None = None
    ) -> HarmonicMesh:
        """Solve one mesh, as every model does."""
        posed = section_problem(problem, self._first)
        results = () if before is None else before.results
        return HarmonicMesh(problem, harmonic_solution(posed, level, self.meshes.ratio, results))


def section_problem(problem: MeshProblem, first: FirstMesh | None = None) -> SectionProblem:
    """The problem of a pin's section.

    Raises: ArgumentError for a pin that is not a body of revolution.
    """
    pin = body_of_revolution(problem.pin)
    if pin is None:
        raise ArgumentError(
            f"pin {problem.pin.name} is not a body of revolution", "not-axisymmetric"
        )
    return SectionProblem(
        pin, problem.material, problem.clamps, problem.cases, problem.zones, first
    )


class HarmonicField:
    """The stress of a section under any combination of its unit loads (fea.core.solution)."""

    def __init__(self, solution: HarmonicSolution, singularities: tuple[Zone, ...]) -> None:
        self.solution, self.singularities = solution, singularities
        self.fields = solution.fields

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest von Mises stress (T,) Pa at every instant outside the singularities, or
        `least` where it does not exceed that.
        """
        around = self.reader(loads)
        return around.maxima(around.fields.outside(self.singularities), least)

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest of these (Pa), and the number of its instant."""
        around = self.reader(loads)
        top = around.top(around.fields.outside(self.singularities))
        return top.value, top.instant

    def reader(self, loads: Loads) -> Circumference:
        """The points and angles at which the largest stress under these loads is searched
        (fea.harmonic.free_surface).
        """
        return reader(self.fields, loads, self.solution.nu)

    def picture(self, loads: PinLoads, instant: int) -> Picture:
        """The surface at one instant, with its envelope over all instants."""
        return revolve(self.fields, loads, instant, self.solution.nu)


def harmonic_result(
    solution: HarmonicSolution,
    singularities: tuple[Zone, ...],
    loads: PinLoads,
    case_zones: Collection[Zone] | None = None,
) -> MeshMaximum:
    """The maximum outside the singularities, and that inside each of them.

    case_zones: the singularities of this case, where others have more; all by default.
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
        location=_location(fields.points[top.point], top.angle),
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


def around_governing(
    solution: HarmonicSolution,
    singularities: tuple[Zone, ...],
    loads: Loads,
    maximum: float,
) -> tuple[float, float] | None:
    """The interval of a mesh result alone, given its maximum, Pa."""
    around = reader(solution.fields, loads, solution.nu)
    if not felt_beyond(around.fields, around, singularities, maximum):
        return None
    return interval(around.fields, around, singularities)


def high_places(
    around: Circumference, points: Floats, among: Mask, top: Crest, least: float = REFINE_ABOVE
) -> tuple[tuple[float, float], ...]:
    """Points (r, z) where stress is nearly the maximum, the highest first, well apart.

    least: the least stress there, as a fraction of the maximum.
    """
    rows = np.flatnonzero(among)
    now = slice(top.instant, top.instant + 1)
    for bound in (around.reach, around.bound):
        rows = rows[bound(rows, now)[:, 0] >= least * top.value]
    value, _ = around.round(rows, np.full(len(rows), top.instant))
    places: list[Floats] = []
    for k in np.argsort(-value, kind="stable"):
        if value[k] < least * top.value or len(places) == MAX_PLACES:
            break
        at = points[rows[k]]
        if all(np.hypot(*(at - other)) > MIN_SPACING * at[0] for other in places):
            places.append(at)
    return tuple((float(r), float(z)) for r, z in places)


def _left_out(around: Circumference, loads: PinLoads, top: Crest) -> float:
    """The error from truncating the series of a bearing pressure, Pa, by its last harmonic at the
    maximum.

    A thin tube that becomes oval feels more of that harmonic than a solid pin.
    """
    n, largest = around.last(np.array([top.point]))
    if loads.distribution != "cosine" or n != loads.terms:
        return 0.0
    return SERIES_REMAINDER_RATIO * float(largest[0, top.instant])


def _location(point: Floats, angle: float) -> Point:
    r, z = (float(x) for x in point)
    return (r * float(np.cos(angle)), r * float(np.sin(angle)), z)

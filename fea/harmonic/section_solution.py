"""Unit fields of a body of revolution on one mesh of its section, fine where stress is high."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial

import numpy as np

from fea.core.hardened import core_boundary
from fea.core.material import Material
from fea.core.mesh_result import FEATURE_READING_DISTANCE, MeshMaximum
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.core.zone import DISTANCE_VARIATIONS, Zone
from fea.harmonic.beneath import just_beneath
from fea.harmonic.fields import MeridianFields
from fea.harmonic.first_mesh import FirstMesh
from fea.harmonic.model import HarmonicModel
from fea.harmonic.near_singularities import CORNER_ELEMENT_SIZES
from fea.harmonic.quiet_corners import low_stress_fillets, numerous_fillets
from fea.harmonic.stress_recovery import NO_POINTS
from fea.singular.probes import rim
from fea.singular.singularities import smooth_edges
from geometry import Pin
from geometry.mesh.section_mesh import MeridianMesh, meridian_mesh
from geometry.mesh.sizing import Grade, SectionSize, Spot, size_at
from pinbase.arrays import Floats
from pinbase.memo import Memo

FIRST_MESH_SIZE = SectionSize()
BAND_EDGE_ELEMENT = 0.04  # element size at the edge of any band, of the diameter
LOAD_EDGE_ELEMENT = 0.2  # element size at the edge of a load, of the excluded distance
MIN_ZONE_STRESS = 0.5  # least stress in a zone that may govern, of the maximum elsewhere
LOW_STRESS_POWER = 0.5  # power of the refinement ratio where stresses are low
RING_END_ELEMENT = 0.25  # element size at the ends of a ring of contact pressure, of its length
# Radius, in elements of the first mesh, within which a mesh is refined about high stress.
PATCH_ELEMENTS = 2.0


@dataclass(frozen=True)
class HarmonicSolution:
    """The fields of a body of revolution on one mesh.

    close: element size at each singularity, relative to the scale of its zone.
    nu: Poisson's ratio.
    ends: the places (r, z), m, on the outline where pressures end.
    quiet: the fillets at which the mesh is coarse (fea.harmonic.quiet_corners).
    elsewhere: stress (P, 6, K), Pa, at the additional points that were requested.
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
    first: solves the first mesh where contact pressures act.
    extra_loads: additional unit loads to be solved.
    memo: a store of meshes and unit fields, shared with other problems.
    """

    pin: Pin
    material: Material
    clamps: tuple[str, ...]
    cases: tuple[PinLoads, ...]
    singularities: tuple[Zone, ...]
    first: FirstMesh | None = None
    extra_loads: tuple[UnitLoad, ...] = ()
    memo: Memo | None = None


def harmonic_solution(
    problem: SectionProblem,
    level: int,
    ratio: float,
    before: Collection[MeshMaximum] = (),
    elsewhere: Floats = NO_POINTS,
    grades: Sequence[Grade] = (),
) -> HarmonicSolution:
    """Solve all unit loads of the cases on mesh number `level`.

    Each mesh is `ratio` times finer than the one before.
    before: the results of the mesh before, for each case. Where they have high stress the mesh is
    refined by the ratio, elsewhere by its square root. Without any, it is refined by the ratio
    everywhere.
    elsewhere: additional points (P, 2), r and z in m, at which stress is read but which take no
    part in the search for the maximum.
    grades: the fineness of the mesh at further places.

    Raises: MeshError, SolveError.
    """
    pin, material, cases = problem.pin, problem.material, problem.cases
    singularities = problem.singularities
    close = tuple(
        CORNER_ELEMENT_SIZES[min(level, len(CORNER_ELEMENT_SIZES) - 1) if matters(k, before) else 0]
        for k in range(len(singularities))
    )
    spots = partial(_spots, pin, cases, singularities, close)
    high = dict.fromkeys(place for result in before for place in result.high)
    finer = [*grades, *(_at_high_stress(pin, spots, ratio**level, place) for place in high)]
    factor = ratio ** (level * LOW_STRESS_POWER if high else level)

    loads = _unit_loads(cases) + problem.extra_loads
    rings = tuple(dict.fromkeys(name for load in loads for name, _ in load.parts))
    finer += finer_at_rings(pin, rings)
    ends = _ends(pin, problem.clamps, loads)

    places, inside = tuple(spots(factor)), (_rims(pin, singularities), just_beneath(pin, rings))
    read = np.concatenate([elsewhere, *inside, core_boundary(pin, material.hardened)])
    first = None if level else problem.first
    solved = partial(_unit_fields, problem, first, (loads, read, ends), places)
    quiet = numerous_fillets(pin)
    if quiet and before:
        quiet = next(iter(before)).quiet
    elif quiet:
        nu, coarse = material.poisson_ratio, solved(FIRST_MESH_SIZE, [], quiet)
        quiet = low_stress_fillets(pin, coarse, cases, singularities, nu)
    fields, stress_elsewhere = _without_extra(
        solved(FIRST_MESH_SIZE.finer(factor), finer, quiet), len(elsewhere)
    )
    return HarmonicSolution(fields, close, material.poisson_ratio, ends, quiet, stress_elsewhere)


def _unit_fields(
    problem: SectionProblem,
    first: FirstMesh | None,
    request: tuple[tuple[UnitLoad, ...], Floats, tuple[tuple[float, float], ...]],
    places: tuple[Spot, ...],
    size: SectionSize,
    grades: list[Grade],
    quiet: tuple[int, ...],
) -> MeridianFields:
    """The unit fields on a mesh, solved once for each mesh and set of loads.

    first: the first mesh under contact pressures, which solves them; None on other meshes.
    request: the unit loads, the points at which stress is read, and the ends of pressures.
    places, size, grades, quiet: arguments of the mesh.
    """
    pin, material, (loads, read, ends) = problem.pin, problem.material, request

    def model() -> HarmonicModel:
        section = meridian_mesh(pin, size, places, grades, quiet)
        return HarmonicModel(pin, section, material, problem.clamps)

    mesh = size, places, tuple(grades), quiet, read.tobytes(), ends
    key = pin, material.elastic_part, problem.clamps, *mesh
    if first is not None:
        return first.fields(model, key, request)
    memo = problem.memo or Memo()

    def fields() -> MeridianFields:
        # Any change of load changes the patterns of pressure, but not the mesh: its model is kept.
        pressed = any(load.parts for load in loads)
        solved_before = memo.get(("model", *key), model) if pressed else model()
        return solved_before.solve(*request)

    return memo.get(("fields", loads, *key), fields)


def _without_extra(fields: MeridianFields, count: int) -> tuple[MeridianFields, Floats]:
    """The fields without the additional points, and the stress at these.

    The additional points are the first `count` after those that have a displacement.
    """
    if not count:
        return fields, np.zeros((0, *fields.stress.shape[1:]))
    first = len(fields.displacement)
    here, rest = slice(first, first + count), np.r_[:first, first + count : len(fields.points)]
    unread = np.flatnonzero(np.isin(rest, fields.unread))
    body = replace(fields, points=fields.points[rest], stress=fields.stress[rest], unread=unread)
    return body, fields.stress[here]


def _at_high_stress(
    pin: Pin, spots: Callable[[float], list[Spot]], factor: float, place: tuple[float, float]
) -> Grade:
    """The fineness of the mesh about a place of high stress, `factor` times that of the first mesh.

    spots: gives the spots of a mesh that is finer than the first by a factor.
    place: (r, z), m.
    """
    coarse = size_at(pin, FIRST_MESH_SIZE, spots(1.0), place)
    now = size_at(pin, FIRST_MESH_SIZE.finer(factor), spots(factor), place)
    return Grade((place,), now, PATCH_ELEMENTS * coarse, FIRST_MESH_SIZE.growth)


def finer_at_rings(pin: Pin, rings: tuple[str, ...]) -> list[Grade]:
    """The fineness of the mesh at the ends of rings of contact pressure.

    Elements there are so small that those disturbed by the steps of pressure lie beside the ring
    (fea.core.pressed).
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
    """The places (r, z), m, where a pressure ends on a smooth surface.

    The ends of contact pressure are not among them: its steps belong to its cells, and stress is
    not read there.
    """
    pushed = {name for load in loads if load.kind in ("pressure", "tilt") for name in load.surfaces}
    if not clamps and any(load.n <= 1 and not load.shears for load in loads):
        pushed |= set(pin.connections)  # their bands react the imbalance by pressures
    cells = {name for load in loads if load.parts for name in load.surfaces}
    return smooth_edges(pin, pushed, clamps, cells)


def _spots(
    pin: Pin,
    cases: tuple[PinLoads, ...],
    singularities: tuple[Zone, ...],
    close: tuple[float, ...],
    factor: float,
) -> list[Spot]:
    """The spots where the mesh is refined: singularities and edges of bands.

    close: element size at each singularity, relative to the scale of its zone.
    factor: how much finer the mesh is than the first mesh.
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

    near: element size there, relative to the scale of the zone.
    factor: how much finer the mesh is than the first, for edges of loads.
    """
    p = singularity
    size = near * p.scale
    if p.kind == "edge of a load":
        size = LOAD_EDGE_ELEMENT * p.radius / factor
    return Spot(p.r, p.z, size, p.radius)


def matters(singularity: int, before: Collection[MeshMaximum]) -> bool:
    """Return whether stress in a singular zone is so large that it may govern, so that its growth
    is measured.

    singularity: the number of the zone.
    """
    return any(
        result.singularities[singularity].felt >= MIN_ZONE_STRESS * result.maximum
        for result in before
    )

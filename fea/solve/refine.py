"""Finer and finer meshes of one model, until every case of a pin is converged or decided."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from types import MappingProxyType
from typing import Literal

import numpy as np

from fea.core.material import Material
from fea.core.memory import too_much
from fea.core.mesh_result import MeshMaximum
from fea.core.over_time import Between, rise_between, through_time, with_crest
from fea.core.peak import NO_REASON, Maximum, Reason
from fea.core.pin_loads import PinLoads
from fea.core.solution import StressField
from fea.core.zone import Zone
from fea.cut.evaluate import CutField, CutSolution, cut_result, cut_solution
from fea.cut.local_fields import LOCAL_MESH_RATIO, LocalFields
from fea.cut.region import PIECE_REACH, REACH_FACTOR, pieces
from fea.harmonic.evaluate import (
    HarmonicField,
    SectionProblem,
    harmonic_result,
    harmonic_solution,
)
from fea.harmonic.kept_fields import FirstMesh
from fea.singular.singularities import begins, find_singularities
from fea.solid.evaluate import SolidField, solid_result, solid_solution
from fea.solve.requirement import Requirement, accurate_enough, reasons
from fea.solve.verdict import MIN_MESHES, MeshHistory, judge
from geometry import CutPin, Pin, PinLike
from geometry.mesh.cut_piece import Piece
from geometry.mesh.solid_mesh import MeshSize

Progress = Callable[[str], None]
MeshedModel = Literal["harmonic", "harmonic+local", "solid"]

MESH_RATIO = 2.0**0.5  # from one mesh to the next
HALVING_RATIO = (
    2.0  # the same where the mesh is given, or as fine as the rings of contact pressure are
)
MIN_CONTACT_MESHES = (
    2  # meshes of a pin in contact: its first one resolves all that is on its surface
)
LOCAL_MODEL: Literal["harmonic+local"] = "harmonic+local"
MAX_MESHES = {"harmonic": 7, LOCAL_MODEL: 5, "solid": 4}
MAX_UNKNOWNS = {"harmonic": 400_000, LOCAL_MODEL: 600_000, "solid": 300_000}
UNKNOWNS_EXPONENT = {
    "harmonic": 2.0,
    LOCAL_MODEL: 1.4,
    "solid": 3.0,
}  # power of the ratio with which unknowns grow
NO_MOTION: Mapping[str, Between] = MappingProxyType({})
PIECE_SPACING_FACTOR = (
    2.0  # times as far from each other cuts are in one local solid, if they disturb others
)
TRUNCATION_SHARE = 0.2  # of the tolerance: more of it makes local solids longer


@dataclass(frozen=True)
class Solution:
    """A peak and the answer behind it, None for an unconstrained pin that cannot be solved. loads:
    those of the case, with the instants added to find the maximum; instant: index of the governing
    one.
    """

    peak: Maximum
    answer: StressField | None
    loads: PinLoads
    instant: int = 0


@dataclass(frozen=True)
class PinJob:
    """A pin to be solved, constrained at surfaces (by its own names). cut: the pin with its cuts,
    where `pin` is the one without; beyond: how far local solids reach past these
    and how far from each other cuts are in one (fea.cut.region.pieces); bands: loaded ones with
    cuts in them.
    """

    pin: PinLike
    material: Material
    constrained: tuple[str, ...]
    asked: Requirement
    progress: Progress
    between: Mapping[str, Between]
    first: FirstMesh
    cut: CutPin | None = None
    beyond: float = PIECE_REACH
    bands: tuple[tuple[float, float], ...] = ()
    apart: float = 1.0

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """What is solid of it."""
        if self.cut is None:
            return ()
        return pieces(self.cut, self.constrained, self.beyond, self.bands, self.apart)


def ratio_of(pin: PinLike, model: str) -> float:
    """From one mesh of a pin to the next."""
    if model == LOCAL_MODEL:
        return LOCAL_MESH_RATIO
    return HALVING_RATIO if pin.meshed else MESH_RATIO


def unknowns_after(pin: PinLike, model: str, unknowns: int) -> float:
    """Of the mesh that comes after one with so many, roughly."""
    grown: float = ratio_of(pin, model) ** UNKNOWNS_EXPONENT[model]
    return unknowns * grown


def count_loads(cases: tuple[PinLoads, ...]) -> int:
    """Unit loads of all the cases, at least one."""
    return max(1, len({load for case in cases for load in case.coefficients()}))


def singularities_of(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    distance: float = 0.1,
) -> tuple[Zone, ...]:
    """Zones of unbounded stress in any of the cases; for bodies of revolution only."""
    if not isinstance(pin, Pin):
        return ()
    acting = {load for case in cases for load in case.coefficients() if load.shears}
    loaded = {load.surface for load in acting}
    if acting and not clamps:  # all bands react the imbalance
        loaded |= set(pin.connections)
    nu = material.poisson_ratio
    return find_singularities(pin, clamps, tuple(sorted(loaded)), nu, distance)


def job_singularities(job: PinJob, cases: tuple[PinLoads, ...]) -> tuple[Zone, ...]:
    """Zones of unbounded stress in any of the cases of a job, which end where its cuts begin."""
    found = singularities_of(job.pin, job.material, job.constrained, cases, job.asked.distance)
    openings = () if job.cut is None else tuple(cut.opens for cut in job.cut.cuts.values())
    return tuple(
        p.up_to(*(begins(max(a - p.z, p.z - b), (b - a) / 2.0) for a, b in openings)) for p in found
    )


def refined(
    job: PinJob,
    model: MeshedModel,
    cases: tuple[PinLoads, ...],
    notes: dict[str, Reason],
) -> dict[str, Solution]:
    """Finer and finer meshes until every case is converged or decided, or a limit is reached."""
    pin, asked = job.pin, job.asked
    pressed = model == "harmonic" and any(case.pressed is not None for case in cases)
    ratio, fewest = (
        (HALVING_RATIO, MIN_CONTACT_MESHES) if pressed else (ratio_of(pin, model), MIN_MESHES)
    )
    singularities = job_singularities(job, cases)
    own = {case.case: job_singularities(job, (case,)) for case in cases}
    seen = {
        c.case: MeshHistory(pin.name, c.case, model, (), (), ratio, fewest=fewest) for c in cases
    }
    kept: tuple[LocalFields, ...] = ()
    for level in range(asked.meshes or MAX_MESHES[model]):
        before = {case: s.results[-1] for case, s in seen.items() if s.results}
        largest = max((r.at_once or r.unknowns for r in before.values()), default=0)
        finer = largest * ratio ** UNKNOWNS_EXPONENT[model]
        if level and finer > MAX_UNKNOWNS[model]:
            break
        unit_loads = count_loads(cases)
        section, local = (unit_loads if model == m else 0 for m in ("harmonic", LOCAL_MODEL))
        if level and (excess := too_much(finer, asked.memory, section, local)):
            text = f"; on the next mesh {excess}: allow more, or increase --tolerance"
            limit = Reason(text, ("memory-limit",))
            notes = {case: notes.get(case, NO_REASON) + limit for case in own}
            break
        job.progress(f"pin {pin.name}, {model} model, mesh {level + 1}")
        start = time.perf_counter()
        mesh = _mesh(job, (model, ratio), cases, singularities, own, level, before, kept)
        if not level:
            cases = tuple(_through_time(job, mesh, case) for case in cases)
        for case in cases:
            now, end = mesh.result(case), time.perf_counter()
            seen[case.case] = seen[case.case].then(now, end - start)
            start = end
        if all(accurate_enough(asked, job.material, s) for s in seen.values()):
            break
        if mesh.cut is not None:
            kept = mesh.cut.idle([(case, seen[case.case].results[-1]) for case in cases])
        if any(_too_near(s.results[-1], asked.tolerance) for s in seen.values()):
            job = replace(job, apart=PIECE_SPACING_FACTOR * job.apart)
        elif level and any(_too_short(s.results[-1], asked.tolerance) for s in seen.values()):
            job = replace(job, beyond=REACH_FACTOR * job.beyond)
    why, out = reasons(asked, job.material, model), {}
    for case in cases:
        case, s = _at_crest(job, mesh, case, seen[case.case])
        peak = judge(s, mesh.singularities, asked.tolerance, notes.get(case.case, NO_REASON))
        instant = s.results[-1].instant
        governing = case.at(np.array([instant]))
        peak = replace(peak, governing=governing, history=s.under(governing))
        answer = mesh.answers[case.case]
        if isinstance(answer, CutField):
            solids = tuple((p.piece.z0, p.piece.z1) for p in answer.solution.pieces)
            peak = replace(peak, solids=solids)
        out[case.case] = Solution(with_reason(peak, why(s)), answer, case, instant)
    return out


def _too_near(result: MeshMaximum, tolerance: float) -> bool:
    """Whether cuts in other local solids take much of it."""
    return result.beside > TRUNCATION_SHARE * tolerance * result.maximum


def _too_short(result: MeshMaximum, tolerance: float) -> bool:
    """Whether the ends of local solids take much of the error that is allowed."""
    return result.truncated > TRUNCATION_SHARE * tolerance * result.maximum


@dataclass(frozen=True)
class _Mesh:
    """One solved mesh: its singular zones, its result for a case, and its answers; cut: of a model
    with local solids.
    """

    singularities: tuple[Zone, ...]
    result: Callable[[PinLoads], MeshMaximum]
    answers: dict[str, StressField]
    cut: CutSolution | None = None


def _mesh(
    job: PinJob,
    made: tuple[MeshedModel, float],
    cases: tuple[PinLoads, ...],
    singularities: tuple[Zone, ...],
    own: dict[str, tuple[Zone, ...]],
    level: int,
    before: dict[str, MeshMaximum],
    kept: tuple[LocalFields, ...],
) -> _Mesh:
    model, ratio = made
    if model != "solid":
        assert isinstance(job.pin, Pin)
        problem = SectionProblem(
            job.pin, job.material, job.constrained, cases, singularities, job.first,
        )  # fmt: skip
        answers: dict[str, StressField]
        if model == LOCAL_MODEL:
            cut = cut_solution(
                problem, job.pieces, level, before.values(), job.bands, job.asked.distance,
                kept=kept,
            )  # fmt: skip
            answers = {c: CutField(cut, mine) for c, mine in own.items()}
            return _Mesh(
                (*singularities, *cut.corners),
                lambda c: cut_result(cut, singularities, c, own[c.case]),
                answers,
                cut,
            )
        section = harmonic_solution(problem, level, ratio, before.values())
        answers = {c: HarmonicField(section, mine) for c, mine in own.items()}
        return _Mesh(
            singularities,
            lambda c: harmonic_result(section, singularities, c, own[c.case]),
            answers,
        )
    size, asked = MeshSize().finer(ratio**level), job.asked
    solid = solid_solution(
        job.pin,
        job.material,
        job.constrained,
        cases,
        singularities,
        size,
        asked.distance,
        memory=asked.memory,
    )
    answers = dict.fromkeys(own, SolidField(solid))
    return _Mesh(solid.singularities, partial(solid_result, solid, before, ratio), answers)


def _through_time(job: PinJob, mesh: _Mesh, case: PinLoads) -> PinLoads:
    """A case's loads with the instants that matter according to the first mesh."""
    between = job.between.get(case.case)
    if between is None:
        return case
    return through_time(mesh.answers[case.case], case, between, job.asked.tolerance)


def _at_crest(
    job: PinJob, mesh: _Mesh, case: PinLoads, seen: MeshHistory
) -> tuple[PinLoads, MeshHistory]:
    """With the instant at which the last mesh has its maximum, and the rise between instants."""
    between, answer = job.between.get(case.case), mesh.answers[case.case]
    if between is None:
        return case, seen
    more, last = with_crest(answer, case, between), seen.results[-1]
    if len(more) > len(case):
        last = mesh.result(more)
    last = replace(last, between=rise_between(answer, more, between))
    return more, replace(seen, results=(*seen.results[:-1], last))


def with_reason(peak: Maximum, why: Reason) -> Maximum:
    """With the reason for its model."""
    return replace(peak, why=why.text, reasons=peak.reasons + why.codes)

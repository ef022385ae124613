"""The choice of model: the smallest that is accurate enough, on meshes as fine as necessary.

beam      where its error is enough to decide                   (fea.beam.error_model)
harmonic  any body of revolution                                (fea.harmonic.evaluate)
harmonic+local   such a body with cuts, solid about these       (fea.cut.evaluate)
solid     any other body, and to check the others               (fea.solid.evaluate)
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from types import MappingProxyType
from typing import Literal

import numpy as np

from fea.asked import DECIDED, Asked, Goal, Model, decided, enough, reasons
from fea.beam.error_model import PLAIN
from fea.beam.model import BeamAnswer
from fea.core.equilibrium import Balance, out_of_balance
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.memory import too_much
from fea.core.mesh_result import MeshResult
from fea.core.over_time import Between, rise_between, through_time, with_crest
from fea.core.peak import NOTHING, Note, Peak
from fea.core.pin_loads import PinLoads
from fea.core.solution import Answer
from fea.cut.evaluate import CutAnswer, cut_result, cut_solution
from fea.cut.local_fields import RATIO
from fea.cut.region import BEYOND, LONGER, at_corner, pieces, refused
from fea.harmonic.evaluate import (
    FirstMesh,
    HarmonicAnswer,
    harmonic_result,
    harmonic_solution,
)
from fea.singular.singularities import Singularity, find_singularities, lug_edges
from fea.solid.evaluate import SolidAnswer, solid_result, solid_solution
from fea.verdict import Seen, judge
from geometry import ArgumentError, CutPin, GeometryError, Pin, PinLike
from geometry.mesh.cut_piece import Piece
from geometry.mesh.solid_mesh import MeshError, MeshSize

__all__ = [
    "Asked", "Goal", "Model", "Solution", "count_loads", "decided", "enough", "imbalance",
    "ratio_of", "singularities_of", "solve_pin", "unknowns_after",
]  # fmt: skip

Progress = Callable[[str], None]
_Model = Literal["harmonic", "harmonic+local", "solid"]

STEP = 2.0**0.5  # from one mesh to the next
HALF = 2.0  # the same where the mesh is given
LOCAL: Literal["harmonic+local"] = "harmonic+local"
MESHES = {"harmonic": 7, LOCAL: 5, "solid": 4}
MOST_UNKNOWNS = {"harmonic": 400_000, LOCAL: 300_000, "solid": 300_000}
GROWTH = {"harmonic": 2.0, LOCAL: 1.4, "solid": 3.0}  # power of the ratio with which unknowns grow
AS_USUAL = Asked()
NO_MOTION: Mapping[str, Between] = MappingProxyType({})
TRUNCATED = 0.2  # of the tolerance: more of it makes local solids longer
TELL = 1e-6  # of the largest load: smaller imbalances are not reported


@dataclass(frozen=True)
class Solution:
    """A peak and the answer behind it, None for an unconstrained pin that cannot be solved. loads:
    those of the case, with the instants added to find the maximum; instant: index of the governing
    one.
    """

    peak: Peak
    answer: Answer | None
    loads: PinLoads
    instant: int = 0


def solve_pin(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    asked: Asked = AS_USUAL,
    progress: Progress = lambda _: None,
    between: Mapping[str, Between] = NO_MOTION,
    first: FirstMesh | None = None,
) -> tuple[Solution, ...]:
    """Solutions of a pin's cases, one each. clamps: names of the clamped surfaces. between: for the
    cases that are motions, the loads at any time; in others only the given instants count. first:
    what was solved on the first mesh before, of a body of revolution.

    Raises: ArgumentError for a model that does not apply to this pin; MeshError, SolveError.
    """
    if asked.model in ("beam", "harmonic") and not isinstance(pin, Pin):
        raise ArgumentError(
            f"pin {pin.name} is not a body of revolution, which the {asked.model} model needs: use "
            "auto or solid",
            "not-axisymmetric",
        )
    constrained = tuple(pin.surface(name) for name in clamps)
    job = _Job(pin, material, constrained, asked, progress, between, first or FirstMesh())
    balances = {} if clamps else {c.case: out_of_balance(pin, c, material.density) for c in cases}
    shares = {case: imbalance(pin, balance) for case, balance in balances.items()}
    notes = {case: _reacted(share) for case, share in shares.items() if share}
    out: dict[str, Solution] = {}
    for case in cases:
        if case.case in balances and (refusal := balances[case.case].refusal):
            codes = (balances[case.case].code,)
            peak = Peak(pin.name, case.case, asked.model, "rigid", refusal, reasons=codes)
            out[case.case] = Solution(peak, None, case)
    live = tuple(c for c in cases if c.case not in out)
    if live and isinstance(pin, CutPin) and not pin.revolved and asked.model == "auto":
        found, job = _with_local_solids(job, pin, live, notes)
        out |= found
        live = tuple(c for c in live if c.case not in out)
    if isinstance(pin, Pin) and asked.model in ("auto", "beam"):
        out |= _beam(job, pin, live, notes)
        live = tuple(c for c in live if c.case not in out)
    if live:
        model: _Model = (
            "solid" if asked.model == "solid" or not isinstance(pin, Pin) else "harmonic"
        )
        try:
            out |= _refined(job, model, live, notes)
        except (MeshError, SolveError) as error:
            if asked.model != "auto" or not isinstance(pin, Pin):
                raise
            out |= _instead(job, pin, live, notes, str(error))
    for name, share in shares.items():
        out[name] = replace(out[name], peak=replace(out[name].peak, imbalance=share))
    return tuple(out[c.case] for c in cases)


@dataclass(frozen=True)
class _Job:
    pin: PinLike
    material: Material
    constrained: tuple[str, ...]
    asked: Asked
    progress: Progress
    between: Mapping[str, Between]
    first: FirstMesh
    cut: CutPin | None = None
    beyond: float = BEYOND

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """That are solid."""
        return pieces(self.cut, self.constrained, self.beyond) if self.cut else ()


def ratio_of(pin: PinLike, model: str) -> float:
    """From one mesh of a pin to the next."""
    if model == LOCAL:
        return RATIO
    return HALF if pin.meshed else STEP


def unknowns_after(pin: PinLike, model: str, unknowns: int) -> float:
    """Of the mesh that comes after one with so many, roughly."""
    grown: float = ratio_of(pin, model) ** GROWTH[model]
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
) -> tuple[Singularity, ...]:
    """Zones of unbounded stress in any of the cases; for bodies of revolution only."""
    if not isinstance(pin, Pin):
        return ()
    acting = {load for case in cases for load in case.coefficients() if load.shears}
    loaded = {load.surface for load in acting}
    if acting and not clamps:  # all bands react the imbalance
        loaded |= set(pin.connections)
    nu = material.poisson_ratio
    found = find_singularities(pin, clamps, tuple(sorted(loaded)), nu, distance)
    edges = dict.fromkeys(edge for case in cases for edge in case.lug_edges)
    return (*found, *lug_edges(pin, edges, distance))


def _singularities(job: _Job, cases: tuple[PinLoads, ...]) -> tuple[Singularity, ...]:
    return singularities_of(job.pin, job.material, job.constrained, cases, job.asked.distance)


def _beam(
    job: _Job, pin: Pin, cases: tuple[PinLoads, ...], notes: dict[str, Note]
) -> dict[str, Solution]:
    """The cases for which a beam is accurate enough; all if the beam model is requested."""
    asked = job.asked
    if asked.model == "auto" and asked.goal == "value" and asked.tolerance < PLAIN:
        return {}  # below the error of any beam
    out = {}
    for case in cases:
        singularities = _singularities(job, (case,)) if asked.model == "auto" else ()
        if any(p.kind != "edge of a load" for p in singularities):
            continue  # where a beam cannot see the singularity
        found, why = _by_beam(job, pin, case, notes), Note("beam: requested", ("requested",))
        peak = found.peak
        if asked.model == "auto":
            assert isinstance(found.answer, BeamAnswer)
            if found.answer.estimate.error is None:
                continue
            value, error = peak.max_von_mises or 0.0, peak.error_estimate or 0.0
            if decided(asked, job.material, value - error, value + error):
                why = Note(f"beam: {DECIDED}", ("beam-decides",))
            elif peak.verdict == "converged":
                why = Note("beam: its error is within the tolerance", ("beam-within-tolerance",))
            else:
                continue
        out[case.case] = replace(found, peak=_because(peak, why))
    return out


def _because(peak: Peak, why: Note) -> Peak:
    return replace(peak, why=why.text, reasons=peak.reasons + why.codes)


def _by_beam(job: _Job, pin: Pin, case: PinLoads, notes: dict[str, Note]) -> Solution:
    start, rise = time.perf_counter(), 0.0
    answer = BeamAnswer(pin, job.material, job.constrained, case)
    if between := job.between.get(case.case):
        case = through_time(answer, case, between, job.asked.tolerance)
        rise = rise_between(answer, case, between)
        answer = BeamAnswer(pin, job.material, job.constrained, case)
    instant, spent = answer.estimate.instant, time.perf_counter() - start
    peak = answer.peak(job.asked.tolerance, spent, notes.get(case.case, NOTHING), rise)
    return Solution(replace(peak, governing=case.at(np.array([instant]))), answer, case, instant)


def _instead(
    job: _Job, pin: Pin, cases: tuple[PinLoads, ...], notes: dict[str, Note], failure: str
) -> dict[str, Solution]:
    """Beams, with their own error, where no harmonic mesh could be solved."""
    out = {}
    for case in cases:
        note = notes.get(case.case, NOTHING) + Note(f"; the harmonic model failed: {failure}")
        found = _by_beam(job, pin, case, {case.case: note})
        why = Note("beam: the harmonic model failed", ("harmonic-failed",))
        out[case.case] = replace(found, peak=_because(found.peak, why))
    return out


def _with_local_solids(
    job: _Job, pin: CutPin, cases: tuple[PinLoads, ...], notes: dict[str, Note]
) -> tuple[dict[str, Solution], _Job]:
    """Of a pin with holes, none where it must be solid as a whole; and the job with the reason."""
    local = replace(job, pin=pin.profile)
    loaded = [name for case in cases for name in case.surfaces]
    if not job.constrained:
        loaded += pin.connections  # which react the imbalance
    why = refused(pin, job.constrained, loaded)
    why = why or at_corner(pin, _singularities(local, cases))
    if why is None:
        try:
            return _refined(replace(local, cut=pin), LOCAL, cases, notes), job
        except (MeshError, SolveError, GeometryError) as error:
            text = f"solid: a local solid about the cuts failed: {error}"
            why = Note(text, ("not-axisymmetric", "local-failed"))
    return {}, replace(job, asked=replace(job.asked, because=why))


def _refined(
    job: _Job,
    model: _Model,
    cases: tuple[PinLoads, ...],
    notes: dict[str, Note],
) -> dict[str, Solution]:
    """Finer and finer meshes until every case is converged or decided, or a limit is reached."""
    pin, asked = job.pin, job.asked
    ratio = ratio_of(pin, model)
    singularities = _singularities(job, cases)
    own = {case.case: _singularities(job, (case,)) for case in cases}
    seen = {case.case: Seen(pin.name, case.case, model, (), (), ratio) for case in cases}
    for level in range(asked.meshes or MESHES[model]):
        before = {case: s.results[-1] for case, s in seen.items() if s.results}
        largest = max((result.unknowns for result in before.values()), default=0)
        finer = unknowns_after(pin, model, largest)
        if level and finer > MOST_UNKNOWNS[model]:
            break
        unit_loads = count_loads(cases) if model == "harmonic" else 0
        if level and (excess := too_much(finer, asked.memory, unit_loads)):
            text = f"; on the next mesh {excess}: allow more, or increase --tolerance"
            limit = Note(text, ("memory-limit",))
            notes = {case: notes.get(case, NOTHING) + limit for case in own}
            break
        job.progress(f"pin {pin.name}, {model} model, mesh {level + 1}")
        start = time.perf_counter()
        mesh = _mesh(job, model, cases, singularities, own, level, before)
        if not level:
            cases = tuple(_through_time(job, mesh, case) for case in cases)
        for case in cases:
            now, end = mesh.result(case), time.perf_counter()
            seen[case.case] = seen[case.case].then(now, end - start)
            start = end
        if all(enough(asked, job.material, s) for s in seen.values()):
            break
        if any(_too_short(s.results[-1], asked.tolerance) for s in seen.values()):
            job = replace(job, beyond=LONGER * job.beyond)
    why, out = reasons(asked, job.material, model), {}
    for case in cases:
        case, s = _at_crest(job, mesh, case, seen[case.case])
        peak = judge(s, mesh.singularities, asked.tolerance, notes.get(case.case, NOTHING))
        instant = s.results[-1].instant
        governing = case.at(np.array([instant]))
        peak = replace(peak, governing=governing, history=s.under(governing))
        peak = _because(peak, why(s))
        out[case.case] = Solution(peak, mesh.answers[case.case], case, instant)
    return out


def _too_short(result: MeshResult, tolerance: float) -> bool:
    """Whether the ends of local solids take much of the error that is allowed."""
    return result.truncated > TRUNCATED * tolerance * result.maximum


@dataclass(frozen=True)
class _Mesh:
    """One solved mesh: its singular zones, its result for a case, and its answers."""

    singularities: tuple[Singularity, ...]
    result: Callable[[PinLoads], MeshResult]
    answers: dict[str, Answer]


def _mesh(
    job: _Job,
    model: _Model,
    cases: tuple[PinLoads, ...],
    singularities: tuple[Singularity, ...],
    own: dict[str, tuple[Singularity, ...]],
    level: int,
    before: dict[str, MeshResult],
) -> _Mesh:
    pin, ratio = job.pin, ratio_of(job.pin, model)
    if model != "solid":
        assert isinstance(pin, Pin)
        common = (
            job.material, job.constrained, cases, singularities, level, ratio, before.values(),
            job.first,
        )  # fmt: skip
        answers: dict[str, Answer]
        if model == LOCAL:
            cut = cut_solution(pin, job.pieces, *common, job.asked.distance)
            answers = {c: CutAnswer(cut, mine) for c, mine in own.items()}
            return _Mesh(
                (*singularities, *cut.corners),
                lambda c: cut_result(cut, singularities, c, own[c.case]),
                answers,
            )
        section = harmonic_solution(pin, *common)
        answers = {c: HarmonicAnswer(section, mine) for c, mine in own.items()}
        return _Mesh(
            singularities,
            lambda c: harmonic_result(section, singularities, c, own[c.case]),
            answers,
        )
    size, asked = MeshSize().finer(ratio**level), job.asked
    solid = solid_solution(
        pin,
        job.material,
        job.constrained,
        cases,
        singularities,
        size,
        asked.distance,
        memory=asked.memory,
    )
    answers = dict.fromkeys(own, SolidAnswer(solid))
    return _Mesh(solid.singularities, partial(solid_result, solid, before, ratio), answers)


def _through_time(job: _Job, mesh: _Mesh, case: PinLoads) -> PinLoads:
    """A case's loads with the instants that matter according to the first mesh."""
    between = job.between.get(case.case)
    if between is None:
        return case
    return through_time(mesh.answers[case.case], case, between, job.asked.tolerance)


def _at_crest(job: _Job, mesh: _Mesh, case: PinLoads, seen: Seen) -> tuple[PinLoads, Seen]:
    """With the instant at which the last mesh has its maximum, and the rise between instants."""
    between, answer = job.between.get(case.case), mesh.answers[case.case]
    if between is None:
        return case, seen
    more, last = with_crest(answer, case, between), seen.results[-1]
    if len(more) > len(case):
        last = mesh.result(more)
    last = replace(last, between=rise_between(answer, more, between))
    return more, replace(seen, results=(*seen.results[:-1], last))


def imbalance(pin: PinLike, balance: Balance) -> tuple[float, float] | None:
    """Force and couple that the bands react, relative; None if negligible."""
    if not balance.largest:
        return None
    force = balance.force / balance.largest
    couple = balance.couple / balance.largest / pin.length
    return (force, couple) if max(force, couple) >= TELL else None


def _reacted(share: tuple[float, float]) -> Note:
    """The imbalance that the bands react, as the end of a note."""
    force, couple = share
    return Note(
        f"; the bearing bands react a residual imbalance: a force of {force:.2g} of the largest "
        f"load and a couple of {couple:.2g} of that load times the length",
        ("imbalance-reacted",),
    )

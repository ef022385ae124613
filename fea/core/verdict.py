"""The verdict on the maximum of a case: whether it exists, and whether it is accurate enough.

A model and the support of its pin gather evidence: a value and all parts of its error. The evidence
is judged once, when it is complete, so that verdict, error and note always agree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fea.core.linear_solver import SolveError
from fea.core.mesh_history import MeshHistory
from fea.core.mesh_result import MeshMaximum
from fea.core.peak import (
    NO_BOUND,
    NO_REASON,
    ErrorParts,
    Maximum,
    Reason,
    Refinement,
    SingularZone,
    Verdict,
    accuracy,
    widened,
)
from fea.core.pin_loads import PinLoads
from fea.core.zone import Zone
from pinbase.dimensions import Point, Stress

KIND_ARTICLES = {
    "sharp corner": "a", "edge of a clamp": "the", "edge of a load": "the"
}  # fmt: skip
ONE_MESH = Reason(
    "only one mesh was solved, which tells no error", ("too-few-meshes", "no-error-known")
)
TWO_MESHES = Reason(
    "only 2 meshes were solved, so that its error is a rough estimate", ("too-few-meshes",)
)


@dataclass(frozen=True)
class Evidence:
    """The maximum of a case with everything that is needed to judge it.

    value: maximum outside the singular zones, Pa.
    parts: parts of its error.
    location: (x, y, z) in the pin's axes, m.
    zones: zones of unbounded stress.
    excluded: where one of these governs, the maximum outside half and twice the excluded distance,
    Pa, without its error.
    doubt: reason why the parts do not show the error, which then does not count as within the
    tolerance.
    omissions: what the model leaves out of the surface's stress.
    remarks: on the support and on limits, at the end of the note.
    why: reason for the model.
    governing, history, imbalance, solids: as in Maximum.
    """

    pin: str
    case: str
    model: str
    value: Stress
    parts: ErrorParts
    location: Point
    history: tuple[Refinement, ...] = ()
    zones: tuple[SingularZone, ...] = ()
    excluded: tuple[Stress, Stress] | None = None
    doubt: Reason | None = None
    omissions: Reason = NO_REASON
    remarks: Reason = NO_REASON
    why: Reason = NO_REASON
    governing: PinLoads | None = None
    imbalance: tuple[float, float] | None = None
    solids: tuple[tuple[float, float], ...] = ()

    @property
    def unbounded(self) -> bool:
        """Whether the error is unknown."""
        return self.doubt is not None and not NO_BOUND.isdisjoint(self.doubt.codes)

    def with_parts(self, **parts: Stress) -> Evidence:
        """The evidence with some parts of the error replaced, Pa, by their names in ErrorParts."""
        return replace(self, parts=replace(self.parts, **parts))

    def remarked(self, remark: Reason) -> Evidence:
        """The evidence with one more remark."""
        return replace(self, remarks=self.remarks + remark)


def evidence_of(
    seen: MeshHistory, singularities: Sequence[Zone], remarks: Reason = NO_REASON
) -> Evidence:
    """The evidence of a sequence of meshes.

    Raises: SolveError where the stress is not finite.
    """
    last = seen.results[-1]
    if not last.maximum < float("inf"):
        raise SolveError(
            f"pin {seen.pin}, case {seen.case}: the stress is not finite", "not-finite"
        )
    doubt = None
    if len(seen.results) < seen.meshes.min_meshes:
        doubt = TWO_MESHES if len(seen.results) > 1 else ONE_MESH
    return Evidence(
        seen.pin, seen.case, seen.model, last.maximum, seen.parts, last.location, seen.history,
        zones(last, singularities), seen.excluded, doubt, remarks=remarks,
    )  # fmt: skip


def zones(result: MeshMaximum, singularities: Sequence[Zone]) -> tuple[SingularZone, ...]:
    """The singular zones that the loads of the case make singular, in the form of results."""
    return tuple(
        SingularZone(
            location=inside.location,
            kind=f"{KIND_ARTICLES[singularity.kind]} {singularity.kind}",
            between=singularity.between,
            exponent=inside.exponent,
            exponent_theory=singularity.theory,
            excluded=singularity.radius,
            governs=inside.felt > result.maximum,
            max_von_mises=inside.maximum,
            advice=singularity.advice,
            strength=inside.strength,
            felt=inside.felt,
        )
        for singularity, inside in zip(singularities, result.singularities, strict=True)
        if inside.acts
    )


def judge(
    evidence: Evidence, tolerance: float, other_place: tuple[float, float] | None = None
) -> Maximum:
    """The maximum of a case with its verdict.

    tolerance: of the error, relative.
    other_place: bounds, Pa, of the place with the smaller value. Its upper bound may exceed that of
    the evidence; the error of the row then covers it.

    Raises: SolveError where a zone governs and stress is read nowhere outside the zones.
    """
    least, most = other_place or (0.0, 0.0)
    own = evidence.parts.total
    error = max(own, most - evidence.value)
    relative, own_relative = (x / evidence.value if evidence.value else 0.0 for x in (error, own))
    known = evidence.doubt is None and relative <= tolerance
    verdict: Verdict = "converged" if known else "unconverged"
    reason = evidence.doubt or accuracy(relative, tolerance, known)
    governing, interval = [zone for zone in evidence.zones if zone.governs], None
    if governing and not evidence.value:
        raise SolveError(
            f"pin {evidence.pin}: all of its surface lies within the excluded distance of places "
            "without a finite stress; reduce analysis.excluded_distance",
            "all-excluded",
        )
    if governing:
        verdict = "singular"
        at_surface = evidence.doubt or accuracy(own_relative, tolerance, own_relative <= tolerance)
        low, high = widened(evidence.excluded or (evidence.value, evidence.value), own_relative)
        reason = _unbounded(governing, evidence.value, (low, high), at_surface)
        interval = max(low, least), max(high, most)
        error = max(evidence.value - interval[0], interval[1] - evidence.value)
    note = reason + evidence.omissions + evidence.remarks
    return Maximum(
        pin=evidence.pin,
        case=evidence.case,
        model=evidence.model,
        verdict=verdict,
        note=note.text,
        max_von_mises=evidence.value,
        error_estimate=error,
        location=evidence.location,
        governing=evidence.governing,
        history=evidence.history,
        singular_at=evidence.zones,
        why=evidence.why.text,
        interval=interval,
        parts=evidence.parts,
        reasons=note.codes + evidence.why.codes,
        imbalance=evidence.imbalance,
        solids=evidence.solids,
    )


def _unbounded(
    governing: Sequence[SingularZone],
    value: float,
    interval: tuple[float, float],
    at_surface: Reason,
) -> Reason:
    """The reason why no maximum exists, with the stress outside the zones.

    value: the maximum outside the zones, Pa.
    interval: its bounds with half and twice the excluded distance, Pa.
    at_surface: reason that states the accuracy of the value.
    """
    worst = max(governing, key=lambda zone: zone.max_von_mises)
    ends = " to ".join(f"{end / value - 1.0:+.0%}" for end in interval)
    outside = "" if at_surface.codes == ("within-tolerance",) else f"; outside, {at_surface.text}"
    text = f"{_nowhere(worst)}; half and twice the excluded distance give {ends}{outside}"
    return Reason(text, at_surface.codes)


def _nowhere(zone: SingularZone) -> str:
    first, second = zone.between
    where = f"{zone.kind} ({first} / {second})"
    if zone.exponent_theory == 0.0:
        return f"no maximum exists: at {where} stress grows as log(1/distance)"
    exponents = ((zone.exponent, "measured"), (zone.exponent_theory, "theoretical"))
    listed = ", ".join(f"{s:.2f} {how}" for s, how in exponents if s is not None)
    if not listed:
        return f"no maximum exists: at {where} stress grows without bound"
    return f"no maximum exists: at {where} stress grows as distance^-s, s = {listed}"

"""A verdict from successive meshes: is the maximum accurate enough, and does one exist at all?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fea.core.linear_solver import SolveError
from fea.core.mesh_result import MeshMaximum
from fea.core.model import MeshSequence
from fea.core.peak import (
    NO_REASON,
    ErrorParts,
    Maximum,
    Reason,
    Refinement,
    SingularZone,
    Verdict,
    accuracy,
    discretisation_error,
)
from fea.core.pin_loads import PinLoads
from fea.core.zone import Zone

KIND_ARTICLES = {
    "sharp corner": "a", "edge of a clamp": "the", "edge of a load": "the"
}  # fmt: skip


@dataclass(frozen=True)
class MeshHistory:
    """The meshes of one case so far, from coarse to fine.

    seconds: solution time of each.
    meshes: how they are refined.
    first: how many meshes of a run are coarser than the first of these.
    """

    pin: str
    case: str
    model: str
    results: tuple[MeshMaximum, ...]
    seconds: tuple[float, ...]
    meshes: MeshSequence
    first: int = 0

    def appended(self, result: MeshMaximum, spent: float) -> MeshHistory:
        """The history with the result of one more mesh, which took `spent` seconds."""
        return replace(self, results=(*self.results, result), seconds=(*self.seconds, spent))

    @property
    def history(self) -> tuple[Refinement, ...]:
        """Maxima outside the singular zones, mesh by mesh."""
        return tuple(
            Refinement(result.unknowns, result.maximum, spent)
            for result, spent in zip(self.results, self.seconds, strict=True)
        )

    def under(self, loads: PinLoads) -> tuple[Refinement, ...]:
        """The history with the strain energy of each mesh under loads of one instant."""
        return tuple(
            replace(step, strain_energy=result.energy.of(loads) if result.energy else None)
            for step, result in zip(self.history, self.results, strict=True)
        )

    @property
    def error(self) -> float:
        """Estimated error of the last maximum, Pa."""
        return self.parts.total

    @property
    def parts(self) -> ErrorParts:
        """The parts of the error of the last maximum.

        That of the mesh follows from the sequence of meshes, but is never less than the scatter
        with the positions of nodes.
        """
        last = self.results[-1]
        if len(self.results) == 1:
            return ErrorParts(last.maximum)  # as large as the value
        mesh = self._of_mesh(last)
        return ErrorParts(mesh, last.between, last.left_out, truncation=last.truncated)

    def _of_mesh(self, last: MeshMaximum) -> float:
        finer = self.meshes.ratio ** (self.first + len(self.results) - 1)
        scatter = max(last.scatter, self.meshes.scatter * last.maximum / finer**2)
        return discretisation_error(self.history, self.meshes.ratio, scatter, self.meshes.min_order)

    @property
    def relative(self) -> float:
        """The error over the maximum."""
        largest = self.results[-1].maximum
        return self.error / largest if largest else 0.0

    @property
    def range(self) -> tuple[float, float]:
        """The bounds of the maximum, Pa, from its error.

        Where stress is larger in an excluded zone, they are those of half and twice the excluded
        distance, with the error, and with the change of both from the mesh before: so near to the
        zone they are known less well than the maximum.
        """
        last = self.results[-1]
        if not last.governed:
            return last.maximum - self.error, last.maximum + self.error
        low, high = last.interval or (last.maximum, last.maximum)
        for before in self.results[-2:-1]:
            if before.interval is not None:
                low -= abs(low - before.interval[0])
                high += abs(high - before.interval[1])
        return max(0.0, low * (1.0 - self.relative)), high * (1.0 + self.relative)

    def known(self, tolerance: float) -> bool:
        """Return whether the error is within `tolerance`, relative."""
        return len(self.results) >= self.meshes.min_meshes and self.relative <= tolerance


def zones(result: MeshMaximum, singularities: Sequence[Zone]) -> tuple[SingularZone, ...]:
    """The singular zones to report."""
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
    seen: MeshHistory, singularities: Sequence[Zone], tolerance: float, note: Reason = NO_REASON
) -> Maximum:
    """The peak of a case with its verdict.

    note: appended to the note of the verdict.

    Raises: SolveError when the stress is not finite.
    """
    last = seen.results[-1]
    if not last.maximum < float("inf"):
        raise SolveError(
            f"pin {seen.pin}, case {seen.case}: the stress is not finite", "not-finite"
        )
    reported = zones(last, singularities)
    governing = [zone for zone in reported if zone.governs]
    known = seen.known(tolerance)
    verdict: Verdict = "converged" if known else "unconverged"
    verdict_reason = accuracy(seen.relative, tolerance, known)
    if len(seen.results) < seen.meshes.min_meshes and not known:
        meshes = "one mesh was" if len(seen.results) == 1 else f"{len(seen.results)} meshes were"
        text = f"only {meshes} solved, too few to estimate the error"
        verdict_reason = Reason(text, ("too-few-meshes",))
    error, interval = seen.error, None
    if governing:
        verdict = "singular"
        worst = max(governing, key=lambda zone: zone.max_von_mises)
        interval = seen.range
        error = max(last.maximum - interval[0], interval[1] - last.maximum)
        ends = " to ".join(f"{end / last.maximum - 1.0:+.0%}" for end in interval)
        outside = "" if known else f"; outside, {verdict_reason.text}"
        text = f"{_nowhere(worst)}; half and twice the excluded distance give {ends}{outside}"
        verdict_reason = Reason(text, verdict_reason.codes)
    verdict_reason = verdict_reason + note
    return Maximum(
        pin=seen.pin,
        case=seen.case,
        model=seen.model,
        verdict=verdict,
        note=verdict_reason.text,
        max_von_mises=last.maximum,
        error_estimate=error,
        location=last.location,
        history=seen.history,
        singular_at=reported,
        interval=interval,
        parts=seen.parts,
        reasons=verdict_reason.codes,
    )


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

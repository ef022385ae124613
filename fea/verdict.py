"""From what successive meshes say to a verdict: is the maximum known, and is there one at all?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fea.linear import SolveError
from fea.look import Look
from fea.peak import Peak, Refinement, SingularZone, Verdict, discretisation_error
from fea.zones import Place

LEAST_ORDER = {"harmonic": 1.0}  # meshes of sections have points at the rims of what is excluded
NOISE = {"harmonic": 0.026}  # of the maximum on the first mesh, where nodes happen to lie; ~ h^2
FEWEST = 3  # meshes before a maximum may be called converged: two can agree by chance

ARTICLES = {"sharp corner": "a", "edge of a clamp": "the", "edge of a load": "the"}


@dataclass(frozen=True)
class Seen:
    """The meshes of one case so far, coarse to fine, each `ratio` times finer than the one before;
    seconds: what each took. first: how many meshes of a run are coarser than the first of these.
    """

    pin: str
    case: str
    model: str
    looks: tuple[Look, ...]
    seconds: tuple[float, ...]
    ratio: float
    first: int = 0

    @property
    def history(self) -> tuple[Refinement, ...]:
        """Maxima outside the singular places, mesh by mesh."""
        return tuple(
            Refinement(look.unknowns, look.maximum, spent)
            for look, spent in zip(self.looks, self.seconds, strict=True)
        )

    @property
    def error(self) -> float:
        """Estimated error of the last maximum, Pa: from the meshes' sequence, but never less than
        what a mesh is off by where its nodes happen to lie; and what the loads leave out.
        """
        last = self.looks[-1]
        if len(self.looks) == 1:
            return last.maximum
        least = LEAST_ORDER.get(self.model, 0.5)
        estimate = discretisation_error(self.history, self.ratio, last.scatter, least)
        finer = self.ratio ** (self.first + len(self.looks) - 1)
        noise = NOISE.get(self.model, 0.0) * last.maximum / finer**2
        return max(estimate, noise) + last.left_out

    @property
    def relative(self) -> float:
        """The same over the maximum."""
        largest = self.looks[-1].maximum
        return self.error / largest if largest else 0.0

    def known(self, tolerance: float) -> bool:
        """Whether the maximum is known to `tolerance`."""
        return len(self.looks) >= FEWEST and self.relative <= tolerance


def zones(look: Look, places: Sequence[Place]) -> tuple[SingularZone, ...]:
    """What is to be told of each singular place."""
    return tuple(
        SingularZone(
            location=inside.location,
            kind=f"{ARTICLES[place.kind]} {place.kind}",
            between=place.between,
            exponent=inside.exponent,
            exponent_theory=place.theory,
            excluded=place.radius,
            governs=inside.felt > look.maximum,
            max_von_mises=inside.maximum,
            advice=place.advice,
        )
        for place, inside in zip(places, look.places, strict=True)
        if inside.acts
    )


def judge(seen: Seen, places: Sequence[Place], tolerance: float, note: str = "") -> Peak:
    """The peak of a case; `note` is put behind the verdict's own sentence.

    Raises: SolveError when the stress is not finite.
    """
    last = seen.looks[-1]
    if not last.maximum < float("inf"):
        raise SolveError(f"pin {seen.pin}, case {seen.case}: the stress is not finite")
    found = zones(last, places)
    governing = [zone for zone in found if zone.governs]
    known = seen.known(tolerance)
    verdict: Verdict = "converged" if known else "unconverged"
    told = f"known to {seen.relative:.1%}" + (
        "" if known else f" only, {tolerance:.1%} was asked for"
    )
    if len(seen.looks) == 1 and not known:
        told = "from one mesh only, so the error is not known"
    if governing:
        verdict = "singular"
        worst = max(governing, key=lambda zone: zone.max_von_mises)
        told = f"{_nowhere(worst)}; outside of what is excluded, {told}"
    return Peak(
        pin=seen.pin,
        case=seen.case,
        model=seen.model,
        verdict=verdict,
        note=told + note,
        max_von_mises=last.maximum,
        error_estimate=seen.error,
        location=last.location,
        instant=last.instant,
        history=seen.history,
        singular_at=found,
    )


def _nowhere(zone: SingularZone) -> str:
    first, second = zone.between
    where = f"{zone.kind} ({first} / {second})"
    if zone.exponent_theory == 0.0:
        return f"no maximum exists: at {where} stress grows like log(1/distance)"
    exponents = ((zone.exponent, "measured"), (zone.exponent_theory, "by theory"))
    told = ", ".join(f"{s:.2f} {how}" for s, how in exponents if s is not None)
    if not told:
        return f"no maximum exists: at {where} stress grows without bound"
    return f"no maximum exists: at {where} stress grows like distance^-s, s = {told}"

"""The judgement of a maximum stress against yield, and the outcomes that rows can have."""

from __future__ import annotations

from dataclasses import dataclass

from fea.core.peak import Maximum, meets_limit

SAFE, FAILS, NOT_DECIDED = "safe", "fails", "not decided"
DEPENDS = "depends"  # safe as described, but not over a whole range that the study leaves open
BELOW_YIELD, YIELDS = "below yield", "yields"  # outcomes where no safety factor is required
OUTCOME_ORDER = {FAILS: 0, YIELDS: 0, NOT_DECIDED: 1, DEPENDS: 2, SAFE: 3, BELOW_YIELD: 3}


@dataclass(frozen=True)
class Judgement:
    """A maximum stress compared with the yield strength and the required safety factor.

    The judgement is made once, in SI, so that factors and decisions cannot depend on the units of a
    report.

    safety_factor: yield strength over the maximum stress; None if either is missing.
    interval: the range of the safety factor over the interval of the maximum, if it has one. The
    upper end is None where the stress may be zero.
    required: the required safety factor. None if none is required: then the pin must only not
    yield.
    decided: whether the maximum with its error stays below the permitted stress; None where this
    could not be determined.
    """

    safety_factor: float | None = None
    interval: tuple[float, float | None] | None = None
    required: float | None = None
    decided: bool | None = None

    @property
    def yields(self) -> bool | None:
        """Whether the maximum exceeds the yield strength; None without a factor."""
        return None if self.safety_factor is None else self.safety_factor < 1.0

    @property
    def outcome(self) -> str:
        """The outcome for a pin that is exactly as the study describes it."""
        if self.decided is None:
            return NOT_DECIDED
        if self.required is None:
            return BELOW_YIELD if self.decided else YIELDS
        return SAFE if self.decided else FAILS


def against_yield(peak: Maximum, strength: float | None, required: float | None) -> Judgement:
    """Return the judgement of a maximum stress.

    strength: yield strength, Pa, None for a material without one. In a pin with a hardened surface
    the yield strength at the place of the maximum replaces it.
    required: the required safety factor.
    """
    strength = peak.yield_strength(strength)
    if strength is None:
        return Judgement(required=required)
    interval = None
    if peak.interval is not None:
        low, high = peak.interval
        interval = strength / high, strength / low if low > 0.0 else None
    decided = meets_limit(peak, strength / (required or 1.0))
    return Judgement(peak.safety_factor(strength), interval, required, decided)

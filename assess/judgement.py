"""The judgement of a maximum stress against yield."""

from __future__ import annotations

from dataclasses import dataclass

from fea.core.peak import Maximum, meets_limit


@dataclass(frozen=True)
class Judgement:
    """A maximum against the yield strength and the required factor.

    It is made once, in SI: factors and decisions cannot depend on the units of a report.

    safety_factor: yield strength over the maximum, None without either.
    interval: of that factor over the interval of the maximum, if it has one; the upper end is None
    where no stress may be left.
    required: factor of safety, None where none is required, and the pin only must not yield.
    decided: whether the maximum with its error stays below what is permitted; None where that is
    open.
    """

    safety_factor: float | None = None
    interval: tuple[float, float | None] | None = None
    required: float | None = None
    decided: bool | None = None

    @property
    def yields(self) -> bool | None:
        """Whether the maximum exceeds the yield strength; None without a factor."""
        return None if self.safety_factor is None else self.safety_factor < 1.0


def against_yield(peak: Maximum, strength: float | None, required: float | None) -> Judgement:
    """Return the judgement of a maximum.

    strength: yield strength, Pa, None for a material without one.
    required: factor of safety.
    """
    if strength is None:
        return Judgement(required=required)
    interval = None
    if peak.interval is not None:
        low, high = peak.interval
        interval = strength / high, strength / low if low > 0.0 else None
    decided = meets_limit(peak, strength / (required or 1.0))
    return Judgement(peak.safety_factor(strength), interval, required, decided)

"""Whether a row meets the factor that is required of it, by how much, and which row is worst."""

from __future__ import annotations

from math import inf

from reports.data.results import PinResult, Results

SAFE, FAILS, NOT_DECIDED = "safe", "fails", "not decided"
BELOW, YIELDS = "below yield", "yields"  # where no factor is required
ORDER = {FAILS: 0, YIELDS: 0, NOT_DECIDED: 1, SAFE: 2, BELOW: 2}

Ends = tuple[float, float]


def outcome(pin: PinResult) -> str:
    """Whether a pin meets its required factor: safe, fails or not decided; without a required
    factor, whether it yields.

    An unconverged row may have an error small enough to decide. A singular one can only fail or
    yield, because the stress inside the excluded zones is unbounded.
    """
    if pin.verdict in ("rigid", "failed") or (
        pin.verdict == "unconverged" and pin.meets_required is None
    ):
        return NOT_DECIDED
    if pin.meets_required is not None:
        found = SAFE if pin.meets_required else FAILS
    elif pin.yields is not None:
        found = YIELDS if pin.yields else BELOW
    else:
        return NOT_DECIDED
    return NOT_DECIDED if pin.verdict == "singular" and found in (SAFE, BELOW) else found


def limit(results: Results) -> float:
    """The factor that is required; where none is, 1, at which a pin yields."""
    return results.required_safety_factor or 1.0


def utilisation(pin: PinResult, limit: float) -> Ends | None:
    """Required over actual factor: from the lower to the upper end of a range, inf where no end is
    known; equal where the factor is a number, None where there is none.
    """
    if pin.safety_factor is None:
        return None
    low, high = pin.safety_factor_interval or (pin.safety_factor, pin.safety_factor)
    return (0.0 if high is None else limit / high), (limit / low if low else inf)


def margin(pin: PinResult, limit: float) -> Ends | None:
    """Margin of safety, actual over required factor less 1; ends as of `utilisation`."""
    used = utilisation(pin, limit)
    if used is None:
        return None
    low, high = used
    return (1.0 / high - 1.0), (1.0 / low - 1.0 if low else inf)


def worst_first(results: Results) -> list[PinResult]:
    """The rows: first those that fail, then those not decided, each by their utilisation."""

    def place(pin: PinResult) -> tuple[int, float]:
        used = utilisation(pin, 1.0)
        return ORDER[outcome(pin)], -inf if used is None else -used[1]

    return sorted(results.pins, key=place)

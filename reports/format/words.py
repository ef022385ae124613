"""Words for verdicts and outcomes, and the sentences that explain the results."""

from __future__ import annotations

from reports.data.decision import (
    FAILS,
    NOT_DECIDED,
    SAFE,
    YIELDS,
    outcome,
    worst_first,
)
from reports.data.results import PinResult, Results
from reports.format.numbers import short
from reports.format.ranges import factor_range

BEYOND = "beyond yield"

READING = (
    "One row per pin and case, the worst first. The maximum is the largest von Mises stress "
    "anywhere in the pin, except in excluded zones, at any instant; ± is its estimated error, from "
    "successive meshes; the safety factor is the yield strength divided by the maximum. The "
    "utilisation is the required factor (1 if none is required) divided by the safety factor, the "
    "margin of safety its inverse less 1. A solid model reports the "
    "mean over several rotations of the loads about the axis; pictures and VTU files show one "
    "orientation, so their maximum may differ by up to the ±."
)
JOINT = (
    "Joint is the range of the maximum over properties of the joint that are seldom known: other "
    "clearances, lugs of half and twice the stiffness, and lugs that are guided or free to tilt. "
    "It is not part of the ±, and the result is decided without it. For pins that are not solved "
    "in contact, it is that of a beam on foundations in their lugs, or in assumed ones, with its "
    "error."
)
RESULTS = {
    SAFE: "the pin meets its required safety factor.",
    FAILS: "the pin does not meet its required safety factor.",
    NOT_DECIDED: "the results do not show whether the pin meets it; the verdict gives the reason, "
    "or the material has no yield strength.",
}
# What each verdict means, one sentence each.
MEANING = {
    "converged": "the estimated error is within the requested tolerance.",
    "unconverged": "the estimated error exceeds the requested tolerance; the result is decided "
    "only if the whole error range lies on one side of the required factor.",
    "singular": "the largest stress grows without bound as the mesh is refined, so there is no "
    "maximum; the results are those outside the excluded zones, as ranges over half and twice the "
    "excluded distance, mesh error included, and can show that a pin fails but not that it is "
    "safe.",
    "rigid": "the pin is not constrained and its loads are not in equilibrium, so it was not "
    "solved.",
    "failed": "the numerical solution failed; the note gives the reason.",
    BEYOND: "the stress exceeds the yield strength, so linear elasticity is not valid and the real "
    "stress is different.",
}


def verdict_words(verdict: str, yields: bool | None) -> str:
    """A verdict, and whether the stress is beyond yield."""
    return f"{verdict}, {BEYOND}" if yields else verdict


def undecided_because(pin: PinResult) -> str:
    """Why a row is not decided."""
    if pin.max_von_mises == 0.0:
        return "no stress"
    reasons = {
        "unconverged": "not converged",
        "converged": "no yield strength",
        "rigid": "unconstrained",
        "failed": "numerics failed",
    }
    return reasons.get(pin.verdict, pin.verdict)


def result_words(pin: PinResult) -> str:
    """The outcome of a row, and what else is to be known of its factor: "not decided: singular",
    "fails (yields)".
    """
    found = outcome(pin)
    if found == NOT_DECIDED:
        return f"{found}: {undecided_because(pin)}"
    more = [undecided_because(pin)] * (pin.verdict != "converged")
    more += [YIELDS] * bool(pin.yields and found != YIELDS)
    return f"{found} ({', '.join(more)})" if more else found


def headline(results: Results) -> str:
    """The worst row in one sentence: whether its pin is safe, its factor, what is required, and in
    which case; of safe pins, that all of them are. Empty when nothing was solved.
    """
    if not results.pins:
        return ""
    worst = worst_first(results)[0]
    factor, required = f"FoS {factor_range(worst)}", results.required_safety_factor
    needed = "1 at yield" if required is None else f"{short(required)} required"
    found = outcome(worst)
    if found == NOT_DECIDED:
        known = f"; {factor}, {needed}" if worst.safety_factor is not None else ""
        why = undecided_because(worst)
        return f"Whether pin {worst.pin} is safe is not decided: {why} ({worst.case}){known}."
    if found in (FAILS, YIELDS):
        return f"Pin {worst.pin} {found}: {factor} < {needed} ({worst.case})."
    names = {pin.pin for pin in results.pins}
    if len(names) == 1:
        state = "is safe" if found == SAFE else "stays below yield"
        return f"Pin {worst.pin} {state}: {factor} ≥ {needed} ({worst.case})."
    state = "are safe" if found == SAFE else "stay below yield"
    lowest = f"lowest {factor} ≥ {needed}"
    return f"All {len(names)} pins {state}: {lowest} (pin {worst.pin}, {worst.case})."

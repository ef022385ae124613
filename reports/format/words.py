"""Words for verdicts and outcomes, and the sentences that explain the results."""

from __future__ import annotations

from reports.data.results import PinResult

SAFE, FAILS, NOT_DECIDED = "safe", "fails", "not decided"
BELOW, YIELDS = "below yield", "yields"  # where no factor is required
BEYOND = "beyond yield"

READING = (
    "One row per pin and case. The maximum is the largest von Mises stress anywhere in the pin, "
    "except in excluded zones, at any instant; ± is its estimated error, from successive meshes; "
    "the safety factor is the yield strength divided by the maximum. A solid model reports the "
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


def undecided_because(pin: PinResult) -> str:
    """Why a row is not decided."""
    reasons = {"unconverged": "not converged", "converged": "no yield strength"}
    return reasons.get(pin.verdict, pin.verdict)

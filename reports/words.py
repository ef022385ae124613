"""Words for verdicts and the sentences that say how to read the results."""

from __future__ import annotations

from reports.results import PinResult

WORDS = {
    "converged": "converged",
    "unconverged": "unconverged",
    "singular": "singular",
    "rigid": "not solved",
    "failed": "failed",
}
BEYOND = "beyond yield"

READING = (
    "Each row is one pin in one case: the largest von Mises stress in the pin at any instant, its "
    "estimated error (±) from successive meshes, and the yield stress over that maximum. The solid "
    "model gives the mean over turning the loads about the axis; pictures and VTU files show the "
    "pin as it is loaded, and their maximum may differ by as much as the ±."
)
# What each word beside a factor means, one sentence each.
MEANING = {
    "converged": "the error is within the accuracy that was asked for, so the number is a value.",
    "unconverged": "the error is larger than was asked for, so the number is no value; it decides "
    "only where its whole range of error lies on one side of what is required.",
    "singular": "where stress is largest it grows without bound on finer and finer meshes, so the "
    "true maximum does not exist; the numbers are those outside the excluded zones, where a factor "
    "below the required one is enough to say that the pin misses it, and no factor shows that it "
    "meets it.",
    "not solved": "nothing holds the pin and its loads are not in balance, so there is no number.",
    "failed": "the numerics failed, for the reason given, so there is no number.",
    BEYOND: "the stress is above the yield stress, where linear elasticity has ended: it is not "
    "what the material does.",
}


def word(verdict: str) -> str:
    """A verdict as people say it."""
    return WORDS.get(verdict, verdict)


def verdict_words(verdict: str, yields: bool | None) -> str:
    """A verdict as people say it, and whether its stress is beyond yield."""
    return f"{word(verdict)}, {BEYOND}" if yields else word(verdict)


def outcome(pin: PinResult) -> str:
    """One word for a row: meets, misses or no value; yields or holds where nothing is required.

    An unconverged row may have an error small enough to say whether it meets what is required. A
    singular one can only miss or yield: more stress than is read has no bound.
    """
    if pin.verdict in ("rigid", "failed") or (
        pin.verdict == "unconverged" and pin.meets_required is None
    ):
        return "no value"
    if pin.meets_required is not None:
        found = "meets" if pin.meets_required else "misses"
    elif pin.yields is not None:
        found = "yields" if pin.yields else "holds"
    else:
        return "no value"
    return "no value" if pin.verdict == "singular" and found in ("meets", "holds") else found

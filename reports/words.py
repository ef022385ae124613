"""Words for verdicts and the sentences that say how to read the results."""

from __future__ import annotations

from reports.numbers import engineering, short
from reports.results import PinResult, Results

WORDS = {"converged": "converged", "unconverged": "unconverged", "rigid": "not solved"}

READING = (
    "Each row is one pin in one case: the largest von Mises stress anywhere on the pin and at any "
    "instant, its estimated error (±) from successive meshes, and the yield stress over that "
    "maximum. An unconverged row gives no value: a peak at a sharp corner or at the edge "
    "of a clamp grows with every finer mesh, so its number says more about the mesh than about "
    "the pin. A row that is not solved has no number; its note says why. The maximum is a mean "
    "over turning the loads about the axis; pictures and VTU files show the pin as it is loaded, "
    "and their maximum may differ by as much as the ±."
)


def word(verdict: str) -> str:
    """A verdict as people say it."""
    return WORDS.get(verdict, verdict)


def outcome(pin: PinResult) -> str:
    """One word for a row: meets, misses or no value; yields or holds where nothing is required."""
    if pin.verdict != "converged":
        return "no value"
    if pin.meets_required is not None:
        return "meets" if pin.meets_required else "misses"
    if pin.yields is None:
        return "no value"
    return "yields" if pin.yields else "holds"


def summary(results: Results) -> str:
    """What the safety factors say, in a few short sentences."""
    if not results.pins:
        return "No pin was solved."
    parts = [_against_required(results), _lowest(results), _no_values(results)]
    return " ".join(part for part in parts if part)


def _against_required(results: Results) -> str:
    required = results.required_safety_factor
    good, bad = ("meets", "misses") if required is not None else ("holds", "yields")
    outcomes: dict[str, set[str]] = {}
    for pin in results.pins:
        outcomes.setdefault(pin.pin, set()).add(outcome(pin))
    meeting = [pin for pin, found in outcomes.items() if found == {good}]
    missing = [pin for pin, found in outcomes.items() if bad in found]
    open_ = [pin for pin in outcomes if pin not in meeting and pin not in missing]
    factor = "" if required is None else f" the required safety factor {short(required)}"
    one = len(outcomes) == 1
    done = (
        ("meet", "meets")[one] if required is not None else ("stay", "stays")[one] + " below yield"
    )
    failed = ("misses it", "miss it") if required is not None else ("yields", "yield")
    text = f"{len(meeting)} of {_count(len(outcomes), 'pin')} {done}{factor} in every case"
    if missing:
        text += f"; {_names(missing)} {failed[len(missing) > 1]}"
    if open_:
        text += f"; {_names(open_)} {('is', 'are')[len(open_) > 1]} undecided"
    return text + "."


def _lowest(results: Results) -> str:
    known = [p for p in results.pins if p.verdict == "converged" and p.safety_factor is not None]
    if not known:
        return ""
    pin = min(known, key=lambda p: p.safety_factor or 0.0)
    return f"Lowest factor: {engineering(pin.safety_factor)}, pin {pin.pin}, case {pin.case}."


def _no_values(results: Results) -> str:
    loose = sum(p.verdict == "unconverged" for p in results.pins)
    unsolved = sum(p.verdict == "rigid" for p in results.pins)
    text = ""
    if loose:
        text = f"{_count(loose, 'peak')} of {len(results.pins)} did not converge and "
        text += "is no value." if loose == 1 else "are no values."
    if unsolved:
        text += f" {unsolved} of {len(results.pins)} could not be solved."
    return text.strip()


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" + ("" if number == 1 else "s")


def _names(pins: list[str]) -> str:
    return ("pin " if len(pins) == 1 else "pins ") + ", ".join(pins)

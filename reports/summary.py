"""What the safety factors say, in a few short sentences."""

from __future__ import annotations

from reports.numbers import engineering, short
from reports.results import PinResult, Results
from reports.words import BEYOND, outcome


def summary(results: Results) -> str:
    """Who meets what is required, the lowest factors, and which rows are no values."""
    if not results.pins:
        return "No pin was solved."
    parts = [_against_required(results), _lowest(results), _yielding(results), _no_values(results)]
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
    """Of the converged rows; of the singular ones only where it is lower still."""
    converged, singular = (_least(results, verdict) for verdict in ("converged", "singular"))
    text = ""
    if converged is not None:
        text = f"Lowest converged factor: {_factor(converged)}."
    if singular is not None and (converged is None or _size(singular) < _size(converged)):
        text += f" Lowest factor of a singular row, outside its zones: {_factor(singular)}."
    return text.strip()


def _least(results: Results, verdict: str) -> PinResult | None:
    found = [p for p in results.pins if p.verdict == verdict and p.safety_factor is not None]
    return min(found, key=_size) if found else None


def _size(pin: PinResult) -> float:
    return pin.safety_factor or 0.0


def _factor(pin: PinResult) -> str:
    return f"{engineering(pin.safety_factor)}, pin {pin.pin}, case {pin.case}"


def _yielding(results: Results) -> str:
    pins = list(dict.fromkeys(p.pin for p in results.pins if p.yields))
    if not pins:
        return ""
    return f"{BEYOND.capitalize()}, where linear elasticity has ended: {_names(pins)}."


def _no_values(results: Results) -> str:
    total = len(results.pins)
    verdicts = [p.verdict for p in results.pins]
    singular, loose = verdicts.count("singular"), verdicts.count("unconverged")
    unsolved = verdicts.count("rigid") + verdicts.count("failed")
    text = ""
    if singular:
        text = f"{_count(singular, 'row')} of {total} {('are', 'is')[singular == 1]} singular: "
        text += "the true maximum does not exist."
    if loose:
        text += f" {_count(loose, 'peak')} of {total} did not converge and "
        text += "is no value." if loose == 1 else "are no values."
    if unsolved:
        text += f" {unsolved} of {total} could not be solved."
    return text.strip()


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" + ("" if number == 1 else "s")


def _names(pins: list[str]) -> str:
    return ("pin " if len(pins) == 1 else "pins ") + ", ".join(pins)

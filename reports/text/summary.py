"""What the safety factors say, in a few short sentences."""

from __future__ import annotations

from collections.abc import Iterable

from reports.data.decision import BELOW, FAILS, NOT_DECIDED, SAFE, YIELDS, outcome
from reports.data.governing import governing
from reports.data.results import PinResult, Results
from reports.format.numbers import engineering, short
from reports.format.words import BEYOND, undecided_because

LISTED = 4  # cases of a pin; of more, their number is given


def summary(results: Results) -> str:
    """How many pins are safe, which are not, and the rows without a maximum."""
    if not results.pins:
        return "No pin was solved."
    ways = (_against_required, _over_joints, _left_out, _yielding, _negative, _unknown)
    return " ".join(part for part in (way(results) for way in ways) if part)


def _against_required(results: Results) -> str:
    required = results.required_safety_factor
    good, bad = (SAFE, FAILS) if required is not None else (BELOW, YIELDS)
    outcomes: dict[str, set[str]] = {}
    for pin in results.pins:
        outcomes.setdefault(pin.pin, set()).add(outcome(pin))
    safe = [pin for pin, found in outcomes.items() if found == {good}]
    failing = [pin for pin, found in outcomes.items() if bad in found]
    open_ = [pin for pin in outcomes if pin not in safe and pin not in failing]
    factor = "" if required is None else f" (required factor {short(required)})"
    total = len(outcomes)
    text = f"{len(safe)} of {_count(total, 'pin')} {_is(total)} {good} in all cases{factor}"
    if failing:
        text += f"; {bad}: {', '.join(failing)}"
    if open_:
        text += f"; not decided: {_with_reasons(open_, results)}"
    return text + "."


def _with_reasons(pins: list[str], results: Results) -> str:
    """The pins with why they are not decided, equal reasons together."""
    together: dict[str, list[str]] = {}
    for pin in pins:
        rows = [p for p in results.pins if p.pin == pin and outcome(p) == NOT_DECIDED]
        why = ", ".join(dict.fromkeys(undecided_because(p) for p in rows))
        together.setdefault(why, []).append(pin)
    return ", ".join(f"{', '.join(names)} ({why})" for why, names in together.items())


def _over_joints(results: Results) -> str:
    """The rows on which another joint, as likely, would decide otherwise."""
    limit = 1.0 if results.required_safety_factor is None else results.required_safety_factor
    rows = _listed((p.pin, p.case) for p in results.pins if _depends_on_joint(p, limit))
    return f"The result changes within the range of the joint: {rows}." if rows else ""


def _left_out(results: Results) -> str:
    """The rows whose stress is larger at the rounded edges of lugs, which are excluded."""
    rows = _listed(
        (p.pin, p.case)
        for p in results.pins
        if any(
            zone.kind.endswith("rounded edge of a lug")
            and zone.max_von_mises > (p.max_von_mises or 0.0)
            for zone in p.singular_at
        )
    )
    text = "Larger contact stress at the rounded edges of lugs is local and left out"
    return f"{text}: {rows}.{_largest_at_edges(results)}" if rows else ""


def _largest_at_edges(results: Results) -> str:
    """What it is estimated to be."""
    edges = [
        (band.edge_von_mises, p)
        for p in results.pins
        for band in (p.joint.bands if p.joint else ())
        if band.edge_von_mises is not None
    ]
    if not edges:
        return ""
    most, p = max(edges, key=lambda edge: edge[0])
    rows = _listed([(p.pin, p.case)])
    return f" The largest is estimated at {engineering(most, 2)} {results.units.stress}: {rows}."


def _depends_on_joint(pin: PinResult, limit: float) -> bool:
    over = pin.joint.range if pin.joint else None
    if over is None or outcome(pin) == NOT_DECIDED:
        return False
    low, high = over.max_von_mises
    strength = (pin.safety_factor or 0.0) * (pin.max_von_mises or 0.0)
    return (strength >= limit * low) != (strength >= limit * high)


def _yielding(results: Results) -> str:
    pins = list(dict.fromkeys(p.pin for p in results.pins if p.yields))
    if not pins:
        return ""
    return f"{BEYOND.capitalize()}, where linear elasticity is not valid: {_names(pins)}."


def _negative(results: Results) -> str:
    rows = _listed((m.pin, m.case) for m in governing(results) if m.used > 1.0)
    return f"Negative margins of safety: {rows}." if rows else ""


def _listed(rows: Iterable[tuple[str, str]]) -> str:
    """Pins with their cases in parentheses, of many their number; without any, the pin alone."""
    cases: dict[str, list[str]] = {}
    for pin, case in rows:
        cases.setdefault(pin, []).extend([case] if case else [])
    return ", ".join(pin + _of_cases(found) for pin, found in cases.items())


def _of_cases(cases: list[str]) -> str:
    if not cases:
        return ""
    return f" ({', '.join(cases) if len(cases) <= LISTED else f'{len(cases)} cases'})"


def _unknown(results: Results) -> str:
    total = len(results.pins)
    verdicts = [p.verdict for p in results.pins]
    singular = verdicts.count("singular")
    wide = [outcome(p) for p in results.pins if p.verdict == "unconverged"]
    loose = wide.count(NOT_DECIDED)
    unsolved = verdicts.count("rigid") + verdicts.count("failed")
    text = ""
    if singular:
        text = f"{_of(singular, total)} {_is(singular)} singular: no maximum exists."
    if loose:
        text += f" {_of(loose, total)} did not converge."
    if decided := len(wide) - loose:
        tolerance = f"{short(100.0 * results.tolerance)} %"
        text += f" {_of(decided, total)} {_is(decided)} decided with an error above {tolerance}."
    if unsolved:
        text += f" {_of(unsolved, total)} could not be solved."
    return text.strip() or f"All maxima have converged to {short(100.0 * results.tolerance)} %."


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" + ("" if number == 1 else "s")


def _of(number: int, total: int) -> str:
    return f"{number} of {_count(total, 'row')}"


def _is(number: int) -> str:
    return "is" if number == 1 else "are"


def _names(pins: list[str]) -> str:
    return ("pin " if len(pins) == 1 else "pins ") + ", ".join(pins)

"""The certainty of a run in sentences: errors, open values, and checks that were not made."""

from __future__ import annotations

from collections.abc import Sequence

from assess.judgement import DEPENDS, FAILS, NOT_DECIDED
from fea.support.records import TOGETHER
from reports.data.decision import limit
from reports.data.dependence import PRESS_FIT
from reports.data.over_loads import BENEATH_CONTACT, IMPULSE_RANGES_TOGETHER
from reports.data.overview import GOOD, PinLine
from reports.data.results import Results
from reports.data.row import Dependence, PinResult, Units
from reports.data.unknowns import (
    NO_SPREAD,
    Owner,
    Unknown,
    decided_by,
    factor_spread,
    without_range,
)
from reports.format.numbers import DASH, engineering, short, threshold
from reports.format.ranges import factor_text
from reports.format.units import unit_name
from reports.tables.strength.margins import not_made_briefly
from reports.text.load_path import names

OPEN_DIGITS = 4  # significant digits of open values; fitted ones have many more
MAX_FLIPS = 3  # largest number of values named that change an outcome
MEASURED = {
    "landing": "force over time at landing",
    "joint": "clearance and stiffness of the lugs",
    "links": "stiffness of the links",
    "strength": "yield strength",
}
MIN_TIMES = 1.5  # smaller ratios are given as a percentage
Content = list[str]


def accuracy(lines: Sequence[PinLine], results: Results) -> Content:
    """Return a sentence on the errors of the maxima in the governing cases.

    It names the largest error of the other cases if that exceeds both these errors and the
    tolerance. The list is empty where no maximum has an error.
    """
    unknown = names([x.row.pin for x in lines if not x.row.maximum.bounded])
    most = _largest_error([x.row for x in lines])
    if most is None:
        return [f"unknown for {unknown}."] if unknown else []
    text = f"up to {engineering(100.0 * most, 2)} %" if most >= 1e-4 else "below 0.01 %"
    every = _largest_error(results.pins) or 0.0
    if every > max(most, results.tolerance):
        text += f" in the governing cases, {engineering(100.0 * every, 2)} % in others"
    return [f"{text}{f'; unknown for {unknown}' if unknown else ''}."]


def _largest_error(rows: Sequence[PinResult]) -> float | None:
    """Return the largest relative error of the rows that have a maximum with a known error."""
    return max(
        (
            row.error_estimate / row.max_von_mises
            for row in rows
            if row.max_von_mises
            and row.verdict != "singular"
            and row.error_estimate is not None
            and row.maximum.bounded
        ),
        default=None,
    )


def excess_stress(lines: Sequence[PinLine]) -> Content:
    """Return a sentence on the stress of the failing pin nearest to its factor, for comparison with
    the errors; nothing where no pin fails.
    """
    rows = _failing(lines)
    if not rows:
        return []
    ratio, nearest = min(
        ((limit(row) / (row.safety_factor or 1.0), row) for row in rows), key=lambda x: x[0]
    )
    stress = f"{'Even ' * (len(rows) > 1)}{nearest.pin} has"
    if ratio >= MIN_TIMES:
        return [f"{stress} {engineering(ratio, 2)} times the permitted stress."]
    return [f"{stress} {engineering(100.0 * (ratio - 1.0), 2)} % more than the permitted stress."]


def certainty(lines: Sequence[PinLine]) -> Content:
    """Return a sentence on the pins whose outcome holds or changes over the open values.

    It names the pins that fail at all open values, those that fail as described but are safe at
    some, and those that are safe as described but fail at some.
    """
    rows = _failing(lines)
    whatever = [r.pin for r in rows if not r.depends_on and factor_spread(r)]
    within = [r.pin for r in rows if r.depends_on]
    depending = [x.pin for x in lines if x.check.row is not None and x.outcome == DEPENDS]
    parts = []
    if whatever:
        parts.append(f"{names(whatever)} {state(FAILS, whatever)} at all open values")
    if within:
        fail, are = ("fail", "are") if len(within) > 1 else ("fails", "is")
        parts.append(f"{names(within)} {fail} as described and {are} safe at some")
    if rows and depending:
        are, fail = ("are", "fail") if len(depending) > 1 else ("is", "fails")
        parts.append(f"{names(depending)} {are} safe as described and {fail} at some")
    return [f"{'; '.join(parts)}."] if parts else []


def _failing(lines: Sequence[PinLine]) -> list[PinResult]:
    return [x.row for x in lines if x.row.decided is False and x.row.safety_factor]


def skipped_checks(results: Results, lines: Sequence[PinLine], formulas: bool = True) -> Content:
    """Return a sentence on the checks that lack data; nothing if all were made.

    formulas: whether to name checks by formula, which the matrix of requirements lists, too.
    """
    without = list(dict.fromkeys(x.pin for x in lines if without_range(x.row)))
    parts = [f"joint range of {names(without)}"] if without else []
    parts += ["fatigue"] * (results.fatigue is None)
    parts += [text] if formulas and (text := not_made_briefly(results)) else []
    return [f"Skipped: {'; '.join(parts)}."] if parts else []


def measure_first(unknown: Sequence[Unknown], lines: Sequence[PinLine] = ()) -> Content:
    """Return a sentence on the open value to measure first."""
    matters = [x for x in unknown if x.ratio > NO_SPREAD]
    if not matters:
        return []
    if deciding := decided_by(unknown):
        owner, pins = next(iter(deciding.items()))
        return [f"Measure first: {_measured(owner, pins, unknown)} ({names(pins)})."]
    first = matters[0]
    row, value = first.largest
    low, high = (factor_text(end, row.required or 1.0) for end in (value.low, value.high))
    depending = [x.pin for x in lines if x.outcome == DEPENDS and x.check.row is None]
    others = list(dict.fromkeys(depending))
    nothing = "Nothing open changes an outcome alone"
    if others:
        nothing = f"Checks besides yield depend on what is open ({names(others)})"
    return [f"{nothing}; {first.what} matters most (factor of {row.pin} {low} to {high})."]


def _measured(owner: Owner, pins: Sequence[str], unknown: Sequence[Unknown]) -> str:
    """Return the quantity to measure first in the range of an owner.

    A joint has several quantities: those that alone change the outcomes of all its pins, if there
    are such.
    """
    of_joint = [x for x in unknown if owner == "joint" and x.rows[0][1].owner == owner]
    deciding = {x.what: {row.pin for row, _ in x.flipped} for x in of_joint if x.flipped}
    if set(pins) <= set[str]().union(*deciding.values()):
        return names(list(deciding))
    return MEASURED[owner]


def flips_words(unknown: Unknown, units: Units, lines: Sequence[PinLine] = ()) -> str:
    """Return whether a value alone changes an outcome: "F fails at half-sine", "no".

    Checks by formula state only the ranges on which they depend together: "perhaps: A in shear".
    """
    told = [_flip(row, d, units) for row, d in unknown.flipped]
    if told:
        rest = f" and {len(told) - MAX_FLIPS} more" if len(told) > MAX_FLIPS else ""
        return f"{'; '.join(told[:MAX_FLIPS])}{rest}"
    concerned = {row.pin: value.owner for row, value in unknown.rows}
    perhaps = [
        f"{x.pin} in {x.check.check}"
        for x in lines
        if x.check.row is None
        and x.outcome == DEPENDS
        and concerned.get(x.pin, "none") in x.check.reason
    ]
    return f"perhaps: {', '.join(perhaps)}" if perhaps else "no"


def range_words(unknown: Unknown, units: Units) -> str:
    """Return the range of an open value."""
    parts = [state for state in unknown.states if state != given_words(unknown)]
    if unknown.ends:
        dimension = unknown.rows[0][1].dimension
        ends = dict.fromkeys(_number(end) for end in unknown.ends)
        parts.insert(0, f"{' to '.join(ends)} {unit_name(dimension, units)}")
    return ("; " if any("," in part for part in parts) else ", ").join(parts)


def given_words(unknown: Unknown) -> str:
    """Return the study's own value in the unit of the range; a dash for none, or several."""
    given = {value.given for _, value in unknown.rows}
    value = given.pop() if len(given) == 1 else None
    return _number(value) if isinstance(value, float) else value or DASH


def _number(value: float) -> str:
    return short(float(f"{value:.{OPEN_DIGITS}g}"))


def _flip(row: PinResult, d: Dependence, units: Units) -> str:
    state = "may fail" if row.as_described in GOOD else "is safe"
    at = f"with {d.value or d.what}" if d.over == "links" else _threshold_words(d, units)
    return f"{row.pin} {state} {'with ' if at and at == d.value else ''}{at}".strip()


def flips(row: PinResult, units: Units) -> str:
    """Return the values that change the outcome of a row: "clearance (above 0.0007 in), pulse
    (half-sine)".
    """
    told = []
    for d in row.depends_on:
        if d.over == BENEATH_CONTACT:
            told.append("stress beneath contact")
            continue
        what = d.value if d.what == BENEATH_CONTACT else d.what
        if d.what == TOGETHER or what == IMPULSE_RANGES_TOGETHER:
            what = f"the {d.over} values together"
        at = (
            "" if d.what == TOGETHER else _threshold_words(d, units)
        )  # several properties would be a list
        told.append(f"{what} ({at})" if at else what)
    return ", ".join(dict.fromkeys(told))


def _threshold_words(d: Dependence, units: Units) -> str:
    """Return the values at which an outcome differs, "above 0.0007 in", "half-sine"; or nothing."""
    value = d.flips_at if d.flips_at is not None else d.at
    if value is None or d.over == PRESS_FIT:
        return "" if d.what == BENEATH_CONTACT else d.value
    side = "" if d.given is None else "above " if (d.at or value) > d.given else "below "
    return f"{side}{threshold(value)} {unit_name(d.dimension, units)}"


def state(outcome: str, pins: Sequence[str]) -> str:
    """Return an outcome as the verb of a sentence about the pins."""
    plural = len(pins) > 1
    if outcome == NOT_DECIDED:
        return "are not decided" if plural else "is not decided"
    return outcome.removesuffix("s") if plural else outcome

"""The overview of a run in sentences: the outcome, the reasons, the changes needed, the
certainty.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, NOT_DECIDED, OUTCOME_ORDER, SAFE, YIELDS
from assess.strength.fatigue_life import FATIGUE_LIFE
from pinbase.grouped import grouped
from pinbase.rounding import rounded_up
from reports.data.changes import Remedy, command, size_command
from reports.data.decision import largest_factor, limit
from reports.data.dependence import PRESS_FIT
from reports.data.overview import GOOD, PinLine, QuietCase, quiet_cases
from reports.data.results import PinShape, Results
from reports.data.row import PinResult
from reports.format.numbers import engineering, short, threshold
from reports.format.place_words import action, place_words
from reports.format.ranges import factor_range
from reports.format.words import WITHIN_ERROR, undecided_because
from reports.tables.strength.changes import singularity_remedies, unsized_notes
from reports.text.certainty import Content, flips, state
from reports.text.load_path import load_path, names
from reports.text.lug_advice import lug_advice, lug_peaks

MAX_NAMED_CASES = 4
ROUND_OFF = 1e-9
STRONGER = 3.0  # required over given strength; no steel exceeds it
OVER_RANGES_TEXT = "Add --over-ranges to size over all that is open."
ESTIMATES_TEXT = (
    "Diameters are estimates: of five pins tried, 0.9 to 1.1 times what pinstress size found."
)


def decisions(results: Results, lines: Sequence[PinLine]) -> str:
    """Return sentences on the pins that do not fail, and on cases that never govern.

    lines: those of the pins (`pin_lines`), as in all functions of this module.
    """
    parts = [
        _undecided(lines),
        _depending(results, lines),
        _good(lines),
        _other_rows(results, lines),
    ]
    quiet = quiet_cases(results, lines)
    if len(quiet) > MAX_NAMED_CASES:
        parts.append(_all_quiet(quiet))
    else:
        parts += [_quiet(case, len(lines)) for case in quiet]
    return " ".join(part for part in parts if part)


def why(results: Results, lines: Sequence[PinLine], most: int, places: bool = True) -> Content:
    """Return sentences on the forces, the internal forces that govern, and the largest stresses.

    most: largest number of pins whose stress is given.
    places: whether to name the places of the largest stresses of several pins.
    """
    solved = [line for line in lines if line.row.max_von_mises]
    if not solved:
        return _unsolved(lines)
    bad = [line for line in solved if line.outcome not in GOOD] or solved[:1]
    shapes = {shape.pin: shape for shape in results.shapes} if places or len(bad) == 1 else {}
    failing = [line for line in bad if line.outcome in (FAILS, YIELDS)] or bad
    path = load_path(results, [line.row for line in solved])
    parts = [path, _dominating(failing), _peaks(results, bad[:most], shapes)]
    parts.append(lug_peaks(lines, results.units))
    return [part for part in (*_unsolved(lines), *parts) if part]


def _unsolved(lines: Sequence[PinLine]) -> Content:
    """Return the note on each pin without a solution; pins with the same note share it."""
    notes = grouped((x.row.note, x.pin) for x in lines if x.row.max_von_mises is None)
    told = ((names(list(dict.fromkeys(pins))), note) for note, pins in notes.items() if note)
    return [f"{which}: {note.removesuffix('.')}." for which, note in told]


@dataclass(frozen=True)
class Actions:
    """The changes by which the pins reach their factor.

    repairs: sentences on failing checks by formula, and on singularities that can be removed.
    remarks: sentences on diameters and on other ways.
    command: the command that sizes the pins; empty if none can be sized.
    """

    repairs: Content
    remarks: Content
    command: str


def actions(results: Results, lines: Sequence[PinLine], study: str = "") -> Actions:
    """Return the changes by which the pins reach their factor.

    study: its path, by default its name.
    """
    repairs = [*lug_advice(results, lines), *_exceeded(lines), *_singular(lines)]
    repairs += [*unsized_notes(results), *_loose(results), *_near(lines)]
    required = largest_factor(results.pins)
    if not results.changes:
        open_ = [x.pin for x in lines if x.diameter and x.diameter.whatever]
        larger = f"or make {'it' if len(open_) == 1 else 'them'} larger."
        remarks = [f"{narrow_ranges(open_)}, {larger}"] if open_ else []
        over = size_command(open_, study or results.study, required, over_ranges=True)
        return Actions(repairs, remarks, over)
    needed = [line for line in lines if line.diameter and line.diameter.needed]
    remarks = [ESTIMATES_TEXT] if needed else []
    remarks += [*_eyes(results, needed), *_other_ways(results, "Or a" if needed else "A")]
    sizing = command(results.changes, study or results.study, required)
    if sizing and any(line.spread for line in needed):
        remarks.append(OVER_RANGES_TEXT)
    return Actions(repairs, remarks, sizing)


def narrow_ranges(pins: Sequence[str]) -> str:
    """Return the advice to narrow the ranges on which pins depend, without a full stop."""
    return f"Narrow the ranges on which {names(pins)} depend{'s' * (len(pins) == 1)}"


def _undecided(lines: Sequence[PinLine]) -> str:
    open_ = [line for line in lines if line.outcome == NOT_DECIDED]
    alone = _one_pin(lines)
    if alone:  # the headline describes the worst case of a single pin
        open_ = [line for line in open_ if line is not lines[0]]
    if not open_:
        return ""
    told = (
        f"{x.row.case if alone else x.pin} ({x.check.reason or undecided_because(x.row)})"
        for x in open_
    )
    return f"Not decided{' in' if alone else ':'} {', '.join(dict.fromkeys(told))}."


def _one_pin(lines: Sequence[PinLine]) -> bool:
    """Return whether the lines are the cases of a single pin."""
    return len({line.pin for line in lines}) == 1


def _depending(results: Results, lines: Sequence[PinLine]) -> str:
    open_ = [line for line in lines if line.outcome == DEPENDS]
    told = [f"{x.pin} on {flips(x.row, results.units)}" for x in open_]
    if not told or _one_pin(lines):  # the headline describes a single pin
        return ""
    first, *rest = told
    return f"{first.replace(' on ', ' depends on ', 1)}{''.join(f'; {x}' for x in rest)}."


def _good(lines: Sequence[PinLine]) -> str:
    good = [line for line in lines if line.outcome in GOOD]
    if not good or len(good) == len(lines):
        return ""
    state = "safe" if any(x.outcome == SAFE for x in good) else BELOW_YIELD
    if _one_pin(lines):
        cases = [x.check.case for x in good if x.check.case]
        return f"{state.capitalize()} in {names(cases)}." if cases else ""
    return f"{names([x.pin for x in good])} {'are' if len(good) > 1 else 'is'} {state}."


def _other_rows(results: Results, lines: Sequence[PinLine]) -> str:
    """Return sentences, by case, on the rows that are not safe, other than the worst row of each
    pin.
    """
    shown = {(x.row.pin, x.row.case) for x in lines}
    others = [r for r in results.pins if r.outcome not in GOOD and (r.pin, r.case) not in shown]
    by_case: dict[str, dict[str, list[str]]] = {}
    for row in sorted(others, key=lambda r: OUTCOME_ORDER[r.outcome]):
        by_case.setdefault(row.case, {}).setdefault(row.outcome, []).append(row.pin)
    told = [
        f"in {case} " + ", ".join(f"{names(p)} {state(s, p)}" for s, p in of.items())
        for case, of in by_case.items()
    ]
    if len(told) > MAX_NAMED_CASES:
        return f"Pins are not safe in {len(told)} other cases either (safety_factors.csv)."
    return f"Also {'; '.join(told)}." if told else ""


def _all_quiet(cases: Sequence[QuietCase]) -> str:
    """Return a sentence on many cases in which all pins are safe."""
    lowest = [case.lowest for case in cases if case.lowest is not None]
    state = "safe" if lowest and all(row.required for row in lowest) else BELOW_YIELD
    text = f"In {len(cases)} other cases all pins are {state}"
    if not lowest:
        return f"{text}."
    row = min(lowest, key=lambda row: row.safety_factor or 0.0)
    return f"{text}, lowest {factor_range(row)} ({row.pin}, {row.case})."


def _quiet(case: QuietCase, pins: int) -> str:
    low = case.lowest
    state = "safe" if low is not None and low.required else BELOW_YIELD
    every = "all are" if case.pins > 1 else "the pin is"
    if 1 < case.pins < pins:
        every = f"the {case.pins} pins solved are"
    of = f" ({low.pin})" if low and pins > 1 else ""
    least = f", lowest {factor_range(low)}{of}" if low else ""
    return f"In {case.case} {every} {state}{least}."


def _dominating(lines: Sequence[PinLine]) -> str:
    """Return a sentence on the internal forces that govern pins."""
    # Each pin is named once, even if it has several lines.
    pairs = dict.fromkeys((kind, line.pin) for line in lines if (kind := action(line.row)))
    by_action = grouped(pairs)
    told = [
        f"{kind} {'dominates ' * (not k)}{names(pins)}"
        for k, (kind, pins) in enumerate(by_action.items())
    ]
    text = ", ".join(told)
    return f"{text[0].upper()}{text[1:]}." if text else ""


def _peaks(results: Results, lines: Sequence[PinLine], shapes: dict[str, PinShape]) -> str:
    """Return a sentence on the largest stress of pins.

    shapes: of the pins whose places are named.
    """
    unit = results.units.stress
    single = len(lines) == 1
    limits = [_permitted(line.row) for line in lines]
    common = len(set(limits)) == 1
    told = [
        f"{x.pin}{' reaches' * single} {engineering(x.row.max_von_mises, 3)}{f' {unit}' * single}"
        f"{_place(x, shapes)}{'' if common or not limit else f' of {limit}'}"
        for x, limit in zip(lines, limits, strict=True)
    ]
    if single:
        return f"{told[0]}."
    end = f"; {limits[0].replace(' ', ' is ', 1)}" if common and limits[0] else ""
    return f"Largest von Mises stress [{unit}]: {', '.join(told)}{end}."


def _permitted(row: PinResult) -> str:
    """Return the permitted stress of a row in words: "22,500 permitted"."""
    if not row.yield_strength:
        return ""
    word = "permitted" if row.required else "yield strength"
    # The strength is factor times stress, so rows of one material may differ by round-off.
    permitted = float(f"{row.yield_strength / limit(row):.9g}")
    return f"{engineering(permitted, 3)} {word}"


def _place(line: PinLine, shapes: dict[str, PinShape]) -> str:
    """Return the place of a pin's largest stress in brackets; empty without a shape of the pin."""
    shape = shapes.get(line.pin)
    words = place_words(line.row, shape) if shape else ""
    return f" ({words})" if words else ""


def _exceeded(lines: Sequence[PinLine]) -> Content:
    """Return a sentence on each check by formula that a pin fails, for its worst case."""
    checks = [x for x in lines if x.check.row is None and not x.check.lug]
    failing = [x for x in checks if x.outcome == FAILS and x.check.factor]
    used = grouped(((x.pin, x.check.check), x.check.used) for x in failing)
    return [f"{pin} needs {_lacking(check, max(shares))}." for (pin, check), shares in used.items()]


def _lacking(check: str, used: float) -> str:
    """Return the increase that a check needs.

    used: required over actual factor. Damage grows with a power of stress, so for fatigue the life
    is given instead of the strength.
    """
    if check == FATIGUE_LIFE:
        return f"{engineering(used, 3)} times the life that it has ({check})"
    return f"{engineering(100.0 * (used - 1.0), 2)} % more strength, or less load ({check})"


def _singular(lines: Sequence[PinLine]) -> Content:
    """Return the remedies of the singularities that govern pins that are not safe."""
    rows = [x.row for x in lines if x.outcome not in GOOD]
    ways = singularity_remedies(zone for row in rows for zone in row.singular_at if zone.governs)
    return [f"For a maximum instead of a range: {'; '.join(ways)}."] if ways else []


def _eyes(results: Results, lines: Sequence[PinLine]) -> Content:
    """Return a sentence on the pins that would not fit into their lugs."""
    small = [x for x in lines if x.diameter and x.diameter.too_large(x.diameter.needed)]
    if not small:
        return []
    eyes = {engineering(x.diameter.eye, 3) for x in small if x.diameter}
    return [
        f"{names([x.pin for x in small])} would not fit lugs of {', '.join(sorted(eyes))} "
        f"{results.units.length} outer diameter: enlarge the lugs or add shear planes."
    ]


def _loose(results: Results) -> Content:
    """Return a sentence on each pin that comes loose, with the interference that would hold it."""
    lost = grouped(
        (r.pin, (r.case, d)) for r in results.pins for d in r.depends_on if d.over == PRESS_FIT
    )
    told = []
    for pin, cases in lost.items():
        where = names(list(dict.fromkeys(case for case, _ in cases)))
        most = max(d.flips_at or 0.0 for _, d in cases)
        needed = f"{threshold(rounded_up(most))} {results.units.length}"
        told.append(
            f"{pin} needs an interference of more than {needed}, or something else that retains it "
            f"({where})."
        )
    return told


def _near(lines: Sequence[PinLine]) -> Content:
    """Return a sentence on the pins that are not decided because a limit is within their error."""
    rows = [x.row for x in lines if x.outcome == NOT_DECIDED and x.check.row is not None]
    near = [row.pin for row in rows if undecided_because(row).startswith(WITHIN_ERROR)]
    return [f"A smaller tolerance may decide {names(near)}."] if near else []


def _other_ways(results: Results, article: str) -> Content:
    """Return sentences on a stronger material and a longer impulse for the worst pin.

    article: the beginning of the first sentence, "Or a" after another way.
    """
    worst: Remedy = results.changes[0]
    row = results[worst.pin, worst.case]
    strength = f"{engineering(rounded_up(worst.yield_strength), 3)} {results.units.stress}"
    given = row.yield_strength or 0.0
    # Unlike the factor, the strength includes errors and the stress beneath contact.
    contact = row.maximum.places.contact if row.maximum.places else None
    if contact and worst.yield_strength <= (1.0 + ROUND_OFF) * worst.required * contact.upper_end:
        strength += " beneath its lugs, error included"
    parts = []
    if worst.yield_strength > STRONGER * given:
        parts.append(f"No stronger material: {worst.pin} needs a yield strength of {strength}.")
    else:
        parts.append(f"{article} yield strength of {strength} for {worst.pin}.")
    if worst.impulse_time and worst.given_time:
        needed, unit = engineering(rounded_up(worst.impulse_time), 3), results.units.time
        longest = float(row.landing.impulse_time.max()) if row.landing else worst.impulse_time
        parts.append(
            f"Nor an impulse of at most {short(longest)} {unit}: {worst.pin} needs {needed} {unit}."
            if longest < worst.impulse_time
            else f"Or an impulse time of {needed} instead of {short(worst.given_time)} {unit} for "
            f"{worst.pin}."
        )
    return parts

"""Words for verdicts and outcomes, and the sentences that explain the results."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, NOT_DECIDED, SAFE, YIELDS
from fea.support.records import TOGETHER
from reports.data.decision import worst_first
from reports.data.dependence import PRESS_FIT, SEVERAL_TOGETHER
from reports.data.headline import JudgedCheck, worst_checks
from reports.data.over_loads import BENEATH_CONTACT
from reports.data.results import Results
from reports.data.row import Dependence, PinResult, Units
from reports.format.numbers import engineering, margin_text, short, threshold
from reports.format.ranges import factor_range, factor_text
from reports.format.units import unit_name

BEYOND_YIELD = "beyond yield"
WITHIN_ERROR = "within its error"  # of a limit, so that a row is not decided
MAX_NAMED_PINS = 6  # in the first sentence; of further pins the number is given
MAX_NAMED_PROPERTIES = 4  # of a range; of further ones the number is given

RESULT_ROWS_NOTE = (
    "One row per pin and case, the worst first. The maximum is the larger von Mises stress of the "
    "pin's surface, except in excluded zones, and of its sections under axial force, bending, "
    "shear and torsion, at any instant; ± is its estimated error; the safety factor is the yield "
    "strength divided by the maximum. The utilisation is the required factor (1 if none is "
    "required) divided by the safety factor, the margin of safety its inverse less 1. A solid "
    "model reports the mean over several rotations of the loads about the axis; pictures and VTU "
    "files show one orientation, so their maximum may differ by up to the ±."
)
SHARING_NOTE = (
    "Links is the range of the maximum over the stiffness of links of which none is stated, each a "
    "tenth and ten times as stiff as the others, then all in torsion: by it redundant joints share "
    "what statics leaves open. It is not part of the ±; [mechanism.link_stiffness] closes it."
)
JOINT_RANGE_NOTE = (
    "Joint is the range of the maximum over properties of the joint that are seldom known: other "
    "clearances, lugs of half and twice the stiffness, and lugs that are guided or free to tilt. "
    "It is not part of the ±; a pin that fails within it is not safe, its result depends on the "
    "joint. For pins that are not solved in contact, it is that of a beam on foundations in their "
    "lugs, or in assumed ones, with its error."
)
BENEATH_CONTACT_NOTE = (
    "Beneath is the largest von Mises stress farther than a tenth of the diameter from where lugs "
    "press on the pin. It is not part of the maximum; a pin is safe only if it meets the required "
    "factor there too, with its error. Contact stress at the edges of lugs is reported by itself "
    "(contact_edges.csv)."
)
OUTCOME_MEANINGS = {
    SAFE: "the pin meets its required safety factor, with the error of its maximum and over all "
    "that the study leaves open.",
    DEPENDS: "the pin meets its required safety factor as the study describes it, but not within "
    "the range of its joint or of its landing, where the value at which it fails is named, or not "
    "beneath its contact with lugs, where the depth is named.",
    FAILS: "the pin does not meet its required safety factor as the study describes it, whether or "
    "not it would elsewhere within these ranges.",
    NOT_DECIDED: "the results do not show whether the pin meets it; the verdict gives the reason, "
    "or the factor is within its error of the required one, or the material has no yield strength.",
}
# The meaning of each verdict, in one sentence.
VERDICT_MEANINGS = {
    "converged": "the estimated error is within the requested tolerance.",
    "unconverged": "the estimated error exceeds the requested tolerance; like any other, the "
    "result is decided only if the whole error range lies on one side of the required factor.",
    "singular": "the largest stress grows without bound as the mesh is refined, so there is no "
    "maximum; the results are those outside the excluded zones, as ranges over half and twice the "
    "excluded distance, mesh error included, and can show that a pin fails but not that it is "
    "safe.",
    "rigid": "the pin is not constrained and its loads are not in equilibrium, so it was not "
    "solved.",
    "failed": "the numerical solution failed; the note gives the reason.",
    BEYOND_YIELD: "the stress exceeds the yield strength, so linear elasticity is not valid and "
    "the real stress is different.",
}


def verdict_words(verdict: str, yields: bool | None) -> str:
    """Return a verdict, followed by "beyond yield" if the stress is."""
    return f"{verdict}, {BEYOND_YIELD}" if yields else verdict


def undecided_because(pin: PinResult) -> str:
    """Return the reason why a row is not decided."""
    if pin.max_von_mises == 0.0:
        return "no stress"
    if pin.verdict == "converged" and pin.safety_factor is not None:
        limit = "yield" if pin.required is None else "the required factor"
        return f"{WITHIN_ERROR} of {limit}"
    reasons = {
        "unconverged": "not converged",
        "converged": "no yield strength",
        "rigid": "unconstrained",
        "failed": "solution failed",
    }
    return reasons.get(pin.verdict, pin.verdict)


def result_words(pin: PinResult) -> str:
    """Return the outcome of a row, with the reason if it is open: "not decided: singular",
    "depends: joint".
    """
    if pin.outcome == NOT_DECIDED:
        why = undecided_because(pin)
        return f"{pin.outcome}: {WITHIN_ERROR if why.startswith(WITHIN_ERROR) else why}"
    if pin.outcome == DEPENDS:
        return f"{pin.outcome}: {over_words(pin.depends_on)}"
    return pin.outcome


def over_words(depends_on: Sequence[Dependence]) -> str:
    """Return the dependences of an outcome in brief: "joint, beneath contact"."""
    short_names = (f"{d.over} contact" if d.over == BENEATH_CONTACT else d.over for d in depends_on)
    return ", ".join(dict.fromkeys(short_names))


def depends_words(depends_on: Sequence[Dependence], units: Units) -> str:
    """Return the dependences of an outcome, with the values at which the outcome changes.

    Examples: "the range of the joint (clearance above 0.0031 in, tilt guided)", "stress beneath
    contact (factor 1.08, too low to a depth of 0.31 in)".
    """
    below = [_beneath(d, units) for d in depends_on if d.over == BENEATH_CONTACT]
    ranges = _ranges(depends_on, units)
    lost = _lost_fits(depends_on)
    return " and ".join([*(f"stress beneath contact ({x})" for x in below), *ranges, *lost])


def but_words(depends_on: Sequence[Dependence], units: Units, fails: str = "fails") -> str:
    """Return the dependences as a clause on a pin.

    Example: "but not beneath contact (..), and fails within the range of the joint (..)".
    fails: the verb.
    """
    below = [
        f"not beneath contact ({_beneath(d, units)})"
        for d in depends_on
        if d.over == BENEATH_CONTACT
    ]
    ranges = [f"{fails} within {x}" for x in _ranges(depends_on, units)]
    loose = [f"comes loose ({x})" for x in _lost_fits(depends_on)]
    return f"but {', and '.join([*below, *ranges, *loose])}"


def _lost_fits(depends_on: Sequence[Dependence]) -> list[str]:
    """Return a text for each lost press fit: "press fit lost in A above 75.3 degC"."""
    return [f"{d.what} {d.value}" for d in depends_on if d.over == PRESS_FIT]


def _ranges(depends_on: Sequence[Dependence], units: Units) -> list[str]:
    """Return a list with one text that names all ranges; empty without ranges."""
    parts = []
    for over in dict.fromkeys(d.over for d in depends_on):
        if over in (BENEATH_CONTACT, PRESS_FIT):
            continue
        properties = list(
            dict.fromkeys(_dependence(d, units) for d in depends_on if d.over == over)
        )
        if len(properties) > MAX_NAMED_PROPERTIES:
            properties = [
                *properties[: MAX_NAMED_PROPERTIES - 1],
                f"and {len(properties) - MAX_NAMED_PROPERTIES + 1} others",
            ]
        parts.append(f"the {over} ({', '.join(properties)})")
    return [f"the range of {' and of '.join(parts)}"] if parts else []


def _beneath(d: Dependence, units: Units) -> str:
    """Return the factor beneath contact, and the depth to which the stress is too high."""
    factor = f"factor {engineering(d.factor, 3)}"
    if d.value:
        return f"{factor} {d.value}"
    return f"{factor}, too low to a depth of {engineering(d.reach, 2)} {units.length}"


def _dependence(d: Dependence, units: Units) -> str:
    what, value = (
        (f"beneath contact at {d.value}", "") if d.what == BENEATH_CONTACT else (d.what, d.value)
    )
    if what == TOGETHER and d.over == "joint":
        return SEVERAL_TOGETHER  # the table of the range has their values
    if d.at is None:
        return f"{what} {value}".strip()
    unit = unit_name(d.dimension, units)
    flips = d.at if d.flips_at is None else d.flips_at
    side = "" if d.given is None else "above " if d.at > d.given else "below "
    return f"{what} {side}{threshold(flips)} {unit}"


def headline(results: Results) -> str:
    """Return the outcome of all pins in one sentence; empty if no pin was solved.

    If several pins were solved and some fail, the sentence gives their number and names, the
    required factor and the case. If all are safe, it gives the lowest factor. Otherwise it
    describes the worst pin.
    """
    worst = worst_checks(results)
    if not worst:
        return ""
    checks = sorted(worst.values(), key=lambda check: check.rank)
    first = checks[0]
    if len(checks) > 1 and first.outcome in (FAILS, YIELDS):
        return _failing([check for check in checks if check.outcome in (FAILS, YIELDS)], results)
    if first.outcome in (SAFE, BELOW_YIELD):
        return _all_safe(results, first, len(worst))
    if first.row is None:
        return _of_margin(first)
    row, (factor, needed) = first.row, _factor_words(first.row)
    if first.outcome == NOT_DECIDED:
        known = f"; {factor}, {needed}" if row.safety_factor is not None else ""
        why = undecided_because(row)
        return f"Whether pin {row.pin} is safe is not decided: {why} ({row.case}){known}."
    if first.outcome in (FAILS, YIELDS):
        return f"Pin {row.pin} {first.outcome}: {factor} < {needed} ({row.case})."
    state, fails = ("is safe", "fails") if row.required else ("stays below yield", "yields")
    described = f"{factor} ≥ {needed}" if row.max_von_mises else "no load stresses it"
    return (
        f"Pin {row.pin} {state} as described ({described}; {row.case}), "
        f"{but_words(row.depends_on, results.units, fails)}."
    )


def _failing(checks: Sequence[JudgedCheck], results: Results) -> str:
    """Return the sentence on the pins that fail, the worst first.

    Example: "5 of 9 pins miss the required factor 10 (landing): E, J, A, D, G."
    """
    pins = len({row.pin for row in results.pins})
    cases, required = ({getattr(c, key) for c in checks} for key in ("case", "required"))
    by_stress = all(check.row is not None for check in checks)
    one = len(checks) == 1
    verb = "fails" if one else "fail"
    if by_stress and len(required) == 1:
        asked = all(check.row and check.row.required for check in checks)
        missed = f"{'misses' if one else 'miss'} the required factor {short(required.pop())}"
        verb = missed if asked else ("yields" if one else "yield")
    case = f" ({cases.pop()})" if len(cases) == 1 and "" not in cases else ""
    told = [_failing_pin(check, not case) for check in checks[:MAX_NAMED_PINS]]
    more = f" and {len(checks) - MAX_NAMED_PINS} more" if len(checks) > MAX_NAMED_PINS else ""
    count = f"{len(checks)} of {pins} pins"
    return f"{count} {verb}{case}: {', '.join(told)}{more}."


def _failing_pin(check: JudgedCheck, with_case: bool) -> str:
    more = [check.case] * (with_case and bool(check.case))
    if check.lug:
        more += [f"lug {check.lug}"]
    elif check.row is None:
        more += [margin_words(replace(check, case=""))]
    return f"{check.pin} ({', '.join(more)})" if more else check.pin


def _factor_words(row: PinResult) -> tuple[str, str]:
    """Return the safety factor and the required one as text."""
    required = row.required
    needed = "1 at yield" if required is None else f"{short(required)} required"
    return f"factor {factor_range(row)}", needed


def _all_safe(results: Results, least: JudgedCheck, pins: int) -> str:
    """Return the sentence that all pins are safe.

    least: the worst of all checks, which may be another check than stress against yield.
    """
    row = worst_first(results)[0]
    factor, needed = _factor_words(row)
    safe = row.outcome == SAFE
    every = "Both pins" if pins == 2 else f"All {pins} pins"
    loaded = least.row is None and least.used != 0.0
    other = f"; {margin_words(least)}, pin {least.pin}" if loaded else ""
    if row.max_von_mises == 0.0:
        who = f"Pin {row.pin} is" if pins == 1 else f"{every} are"
        return f"{who} safe: no load stresses {'it' if pins == 1 else 'them'}{other}."
    if pins == 1:
        state = "is safe" if safe else "stays below yield"
        return f"Pin {row.pin} {state}: {factor} ≥ {needed} ({row.case}){other}."
    state = "are safe" if safe else "stay below yield"
    return f"{every} {state}: lowest {factor} ≥ {needed} (pin {row.pin}, {row.case}){other}."


def _of_margin(check: JudgedCheck) -> str:
    """Return the sentence on a check other than that of the model's stress against yield."""
    if check.outcome == FAILS:
        return f"Pin {check.pin} fails: {margin_words(check)}."
    if check.outcome == DEPENDS:
        over = f"range of the {check.reason}" if check.reason else "study's ranges"
        return (
            f"Pin {check.pin} is safe as described, but within the {over} it may fail: "
            f"{margin_words(check)}."
        )
    why = f"{check.check}: {check.reason}" if check.reason else margin_words(check)
    return f"Whether pin {check.pin} is safe is not decided: {why}."


def margin_words(check: JudgedCheck) -> str:
    """Return a check with its margin of safety, or its factor and the required one, and
    its case.
    """
    case = f" ({check.case})" if check.case else ""
    name = "" if check.stated else "margin of safety "
    return f"{check.check}, {name}{spare_words(check)}{case}"


def not_judged(pins: Iterable[str], checks: Iterable[str]) -> str:
    """Return sentences on the checks that a search leaves out and `pinstress run` makes; empty
    without any.

    pins: those with lugs, which are not checked. checks: those other than yield.
    """
    names, others = (", ".join(dict.fromkeys(x)) for x in (pins, checks))
    of_lugs = f"The lugs of {names} are not checked here: `pinstress run` checks them, too."
    of_checks = f"Pins are checked against yield only: `pinstress run` also checks {others}."
    return " ".join([of_lugs] * bool(names) + [of_checks] * bool(others))


def spare_words(check: JudgedCheck) -> str:
    """Return the margin of safety of a check, or the factor that a requirement states for it."""
    if check.stated:
        factor = factor_text(check.factor, check.required)
        return f"factor {factor}, {short(check.required)} required"
    if check.used == 0.0:
        return "∞"
    return margin_text(1.0 / check.used - 1.0)

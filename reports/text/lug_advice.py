"""Changes of a lug that fails: its thickness, its eye, its material, or the joint.

Where the pin loads a lug evenly, the stress at the bore is F / (D t) times a factor of the eye,
Ekvall's 2.75 (W/D - 1)^-0.675. It falls with the thickness and with a wider eye. Where a pin bends
and loads the face of its lug, neither helps much; a stiffer pin does, in an eye that grows with it.
Scaling the whole joint divides the stress by the square of the scale. On clevises that were solved
again the needed factor was reached within 4 %, or exceeded. A clause states the dimension that just
passes it.

Source: J. C. Ekvall, J. Aircraft 23(5), 1986, 438-443.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import sqrt

from assess.clauses.ekvall import BORE_EXPONENT, TESTED_WIDTHS
from assess.judgement import FAILS
from assess.margin import PinMargin
from pinbase.grouped import grouped
from pinbase.rounding import rounded_up
from reports.data.headline import JudgedCheck, checks_of
from reports.data.lug_modes import BORE_STRESS, bore_wall, lug_mode
from reports.data.overview import PinLine
from reports.data.results import LugSketch, PinShape, Results
from reports.data.row import Units
from reports.format.numbers import engineering
from reports.format.ranges import factor_text
from reports.format.units import unit_name

MAX_STRENGTH_RATIO = 3.0  # required over given strength; no steel exceeds it
MAX_THICKNESS_RATIO = 3.0  # required over given; beyond it the whole joint has to grow
FACE_SHARE = 0.2  # of a lug's thickness; a maximum nearer to a face is caused by bending
MAX_TOLD_LUGS = 3  # sentences with changes; the other lugs are only named
SIZE_NOTE = "The command changes pins, not lugs."
PASSING_WORDS = {
    "outer_diameter": "an eye of {}",
    "thickness": "{} of thickness",
    "diameter": "a pin of {}",
    "interference": "an interference of {}",
}


def lug_advice(results: Results, lines: Iterable[PinLine]) -> list[str]:
    """Return sentences on the failing lugs of the pins whose worst check is one of a lug."""
    failing = _with_others(_failing(lines), results)
    whole = [
        c
        for c in failing
        if c.used > MAX_THICKNESS_RATIO and _at_bore(c) and not _pressed(_lug(c, results))
    ]
    alone = [c for c in failing if c not in whole]
    told = [_of_whole(whole)] if whole else []
    alike = list(grouped((_needs(check, results), check) for check in alone).items())
    told += [_of_lugs(needs, checks) for needs, checks in alike[:MAX_TOLD_LUGS]]
    if rest := [c for _, checks in alike[MAX_TOLD_LUGS:] for c in checks]:
        told.append(f"Likewise {_and([f'lug {c.lug} of {c.pin}' for c in rest])}.")
    return [*told, SIZE_NOTE] if failing and results.changes else told


def lug_peaks(lines: Iterable[PinLine], units: Units) -> str:
    """Return a sentence on the stress at the bore of the lugs that fail by it; empty
    without any.
    """
    told = [
        f"{_with_wall(c)} {engineering(c.margin.demand, 3)} {units.stress}"
        for c in _failing(lines)
        if c.margin and _at_bore(c)
    ]
    return f"At the bore of lug{'s' * (len(told) > 1)} {_and(told)} (with error)." if told else ""


def _failing(lines: Iterable[PinLine]) -> list[JudgedCheck]:
    """Return the checks of lugs that fail, each in its worst case."""
    checks = [line.check for line in lines if line.check.outcome == FAILS]
    return _each_once(check for check in checks if check.lug and check.factor)


def _each_once(checks: Iterable[JudgedCheck]) -> list[JudgedCheck]:
    """Return the worst of every check of a lug over the cases."""
    worst_first = sorted(checks, key=lambda check: check.rank)
    alike = grouped(((check.pin, check.lug, check.check), check) for check in worst_first)
    return [same[0] for same in alike.values()]


def _with_others(failing: list[JudgedCheck], results: Results) -> list[JudgedCheck]:
    """Return the failing checks, and the worst of each other lug of these pins that fails.

    Both walls of a bushed lug are included, because a change for one does not make the others safe.
    """
    if not failing:
        return failing
    pins = {c.pin for c in failing}
    # results.margins has every check only at its worst place, so only for one lug.
    rows = [row for row in results.pins if row.pin in pins]
    margins = (PinMargin(row.pin, row.case, m) for row in rows for m in row.margins)
    others = sorted(checks_of(results, margins), key=lambda check: check.rank)
    others = [c for c in others if c.lug and c.factor and c.outcome == FAILS]
    alike = grouped(((c.pin, c.lug, bore_wall(c.check)), c) for c in (*failing, *others))
    return [same[0] for same in alike.values()]


def _with_wall(check: JudgedCheck) -> str:
    """Return the name of a lug, followed for a bushed lug by the wall in brackets."""
    wall = bore_wall(check.check)
    return f"{check.lug} ({wall})" if wall else check.lug


def _at_bore(check: JudgedCheck) -> bool:
    return lug_mode(check.check) == BORE_STRESS


def _of_whole(checks: Sequence[JudgedCheck]) -> str:
    """Return the sentence on lugs for which no change of the eye alone is enough."""
    named = _and([f"{c.lug} of {c.pin}" for c in checks])
    factors = _and([engineering(c.factor, 3) for c in checks])
    times = _and([engineering(sqrt(c.used), 2) for c in checks])
    s, verb = ("s", "need") if len(checks) > 1 else ("", "needs")
    return (
        f"Lug{s} {named} (factor{s} {factors} at the bore) {verb} pin, eye and thickness about "
        f"{times} times as large: no wider eye and no stronger steel is enough."
    )


@dataclass(frozen=True)
class Needs:
    """The changes that similar lugs of a pin need.

    wall: of bushed lugs.
    factor: with its place.
    change: a sufficient change.
    """

    pin: str
    wall: str
    factor: str
    change: str


def _needs(check: JudgedCheck, results: Results) -> Needs:
    """Return the changes that the lug of a check needs."""
    lug, ways, wall = _lug(check, results), _ways(check, results), bore_wall(check.check)
    where = "at the bore" if _at_bore(check) else check.check
    if wall == "hole":
        where = "at the hole about its bushing"
    factor = f"factor {factor_text(check.factor, check.required)} {where}"
    return Needs(check.pin, wall, factor, _or(ways, _pressed(lug)))


def _of_lugs(needs: Needs, checks: Sequence[JudgedCheck]) -> str:
    """Return the sentence on similar lugs. checks: one of each lug."""
    many, which = len(checks) > 1, _and([c.lug for c in checks])
    of_bushing = f"The bushing{'s' * many} of l" if needs.wall == "bushing" else "L"
    lugs = f"{of_bushing}ug{'s' * many} {which} of {needs.pin}"
    return f"{lugs} ({needs.factor}) need{'s' * (not many)} {needs.change}."


def _lug(check: JudgedCheck, results: Results) -> LugSketch | None:
    """Return the lug of a check."""
    shape = _shape(check, results)
    return next((x for x in shape.lugs if x.connection == check.lug), None) if shape else None


def _shape(check: JudgedCheck, results: Results) -> PinShape | None:
    return next((s for s in results.shapes if s.pin == check.pin), None)


def _pressed(lug: LugSketch | None) -> bool:
    """Return whether the press fit of a bushing stresses a lug; no size reduces this part of the
    stress in proportion.
    """
    return lug is not None and lug.interference > 0.0


def _ways(check: JudgedCheck, results: Results) -> list[str]:
    """Return the changes of which each is enough by itself, as an estimate."""
    ways, units = list[str](), results.units
    shape, lug = _shape(check, results), _lug(check, results)
    if _at_bore(check) and shape and lug and not _pressed(lug):
        bore = _bore(shape, lug)
        ways += (
            _of_face(check.used, lug, bore, units)
            if _at_face(check, lug)
            else [*_of_eye(check.used, lug, bore + 2.0 * lug.bushing, units)]
        )
    elif check.margin and (passing := check.margin.passing):
        size = f"{engineering(passing.value, 3)} {units.length}"
        ways.append(PASSING_WORDS.get(passing.symbol, f"{passing.symbol} {{}}").format(size))
    if check.used <= MAX_STRENGTH_RATIO:
        ways.append(_stronger(check, units))
    return ways


def _at_face(check: JudgedCheck, lug: LugSketch) -> bool:
    """Return whether the stress is largest near a face of the lug."""
    z = check.margin.z if check.margin else None
    start, end = lug.z
    return z is not None and min(z - start, end - z) < FACE_SHARE * (end - start)


def _of_face(used: float, lug: LugSketch, pin: float, units: Units) -> list[str]:
    """Return the pin and eye that are enough where a bending pin loads the face of a lug."""
    return [
        f"a stiffer pin, of {_now(used, pin, units)}, in an eye of "
        f"{_now(used, lug.outer_diameter, units)}"
    ]


def _of_eye(used: float, lug: LugSketch, hole: float, units: Units) -> Iterator[str]:
    """Yield a sufficient thickness, and a sufficient width of the eye if it is within the tested
    widths.
    """
    width, thickness = lug.outer_diameter, lug.z[1] - lug.z[0]
    yield f"a thickness of {_now(used, thickness, units)}"
    if hole > 0.0:
        wider = hole * (1.0 + (width / hole - 1.0) * used ** (-1.0 / BORE_EXPONENT))
        if wider <= TESTED_WIDTHS[1] * hole:
            yield f"an eye of {_now(wider / width, width, units)}"


def _now(times: float, now: float, units: Units) -> str:
    return f"{engineering(times * now, 3)} {units.length} (now {engineering(now, 3)})"


def _stronger(check: JudgedCheck, units: Units) -> str:
    margin = check.margin
    if margin is None or margin.dimension != "stress" or margin.allowable is None:
        return f"{engineering(100.0 * (check.used - 1.0), 2)} % more strength"
    kind = "a yield" if margin.level == "limit" else "an ultimate"
    strength = engineering(rounded_up(check.used * margin.allowable), 3)
    return f"{kind} strength of {strength} {unit_name('stress', units)}"


def _bore(shape: PinShape, lug: LugSketch) -> float:
    """Return the diameter of the pin in a lug."""
    z = 0.0
    for length, diameter, *_ in shape.segments:
        if z <= 0.5 * (lug.z[0] + lug.z[1]) < z + length:
            return diameter
        z += length
    return 0.0


def _and(parts: Sequence[str]) -> str:
    return " and ".join(filter(None, [", ".join(parts[:-1]), parts[-1]]))


def _or(ways: Sequence[str], pressed: bool) -> str:
    if not ways:
        return "less interference or less load" if pressed else "less load"
    return " or ".join(filter(None, [", ".join(ways[:-1]), ways[-1]]))

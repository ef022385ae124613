"""Variations of the uncertain properties of a joint, to see which results depend on them.

By default a clearance goes from none to twice the given one (to a free running fit where none is
given), the lugs are half and twice as stiff, and the tilt is free and guided. A lug may have ranges
of its own. Both ends of each range are tried, for all lugs at once, then the ends of all properties
that go farthest, together. What a temperature adds to a clearance (Lug.growth) is not varied.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from fea.support.lugs.lug import Lug
from fea.support.records import TOGETHER
from geometry import Pin

DEFAULT_FIT_CLEARANCE = 0.002  # of the diameter: a free running fit, where no clearance is given
DEFAULT_STIFFNESS_FACTOR = 2.0
LOW_END_TEXT, HIGH_END_TEXT = "low end of its range", "high end of its range"
RANGE_ENDS = (0, 1)
# Of the stress: what one property alone does, below which it does not tell what it does together
# with others. Chosen by judgement.
LITTLE_EFFECT = 0.02


@dataclass(frozen=True)
class JointChange:
    """A joint with one property changed, or with several together.

    what, value: the property, and its value in words.
    lugs: with the change.
    softness: how many times softer each lug is.
    length: the value, m, if it is a length, the largest of all lugs.
    """

    what: str
    value: str
    lugs: tuple[Lug, ...]
    softness: tuple[float, ...]
    length: float | None = None


def joint_variations(pin: Pin, lugs: Sequence[Lug]) -> Iterator[JointChange]:
    """The variations of the lugs on a pin's bands, one property at a time, without those that
    change nothing.
    """
    same = (1.0,) * len(lugs)
    changes = []
    for end in RANGE_ENDS:
        loose, words = zip(*(_with_clearance(pin, lug, end) for lug in lugs), strict=True)
        size = max(lug.clearance for lug in loose)
        changes.append(JointChange("clearance", _in_words(words), loose, same, size))
    for end in RANGE_ENDS:
        stiff, words = zip(*(_stiffness(lug, end) for lug in lugs), strict=True)
        by = tuple(1.0 / times for times in stiff)
        changes.append(JointChange("stiffness of the lugs", _in_words(words), tuple(lugs), by))
    for end in RANGE_ENDS:
        tilted, words = zip(*(_tilted(lug, end) for lug in lugs), strict=True)
        changes.append(JointChange("tilt", _in_words(words), tilted, same))
    unchanged = (tuple(lugs), same)
    return (change for change in changes if (change.lugs, change.softness) != unchanged)


def worst_together(
    lugs: Sequence[Lug],
    changes: Sequence[JointChange],
    measures: Sequence[Sequence[float]],
) -> list[JointChange]:
    """The changes of several properties at once that raise one of some measures most, or lower the
    first of them.

    What each raises alone is taken to raise it together, too; of one that alone does little beside
    others, both ends are tried: in a clearance stiff lugs raise the stress that without it they
    leave alone.
    measures: of each change, over those of the joint as given.
    """
    out: dict[str, JointChange] = {}
    for k, way in _ways(len(measures[0])) if measures else ():
        beyond = [way * (of_change[k] - 1.0) for of_change in measures]
        by_property: dict[str, list[tuple[float, JointChange]]] = {}
        for change, amount in zip(changes, beyond, strict=True):
            by_property.setdefault(change.what, []).append((amount, change))
        matters = max(map(abs, beyond)) >= LITTLE_EFFECT and way > 0.0
        each = [_to_combine(ends, matters) for ends in by_property.values()]
        for several in itertools.product(*each):
            together = [change for change in several if change is not None]
            if len(together) > 1:
                both = _combined(lugs, together)
                out[both.value] = both
    return list(out.values())


def _to_combine(
    ends: Sequence[tuple[float, JointChange]], matters: bool
) -> list[JointChange | None]:
    """The changes of one property that are combined with others; None: it stays as given.

    ends: with how much each raises the measure. matters: whether another property does so much that
    a little tells nothing.
    """
    most, farthest = max(ends, key=lambda x: x[0])
    if matters and all(abs(amount) < LITTLE_EFFECT for amount, _ in ends):
        both = [change for _, change in ends]
        return [*both, None][:2]
    return [farthest if most > 0.0 else None]


def _ways(measures: int) -> list[tuple[int, float]]:
    """The measures that are raised, 1, or lowered, -1."""
    return [*((k, 1.0) for k in range(measures)), (0, -1.0)]


def _combined(lugs: Sequence[Lug], changes: Sequence[JointChange]) -> JointChange:
    """Several changes at once, of one property each."""
    whole, softness = list(lugs), [1.0] * len(lugs)
    for change in changes:
        for k, (given, lug) in enumerate(zip(lugs, change.lugs, strict=True)):
            if lug.clearance != given.clearance:
                whole[k] = replace(whole[k], clearance=lug.clearance)
            if lug.tilt != given.tilt:
                whole[k] = replace(whole[k], tilt=lug.tilt)
            softness[k] *= change.softness[k]
    words = ", ".join(f"{change.what} {change.value}" for change in changes)
    return JointChange(TOGETHER, words, tuple(whole), tuple(softness))


def pressed_in(change: JointChange) -> bool:
    """Whether the pin is pressed into a lug of a joint that is changed so."""
    return any(lug.clearance < 0.0 for lug in change.lugs)


def with_stiffness(lug: Lug, times: float) -> Lug:
    """The lug, and its bushing, so many times as stiff."""
    return lug.with_materials(lambda m: replace(m, youngs_modulus=m.youngs_modulus / times))


def _with_clearance(pin: Pin, lug: Lug, end: int) -> tuple[Lug, str]:
    if lug.range.clearance is not None:
        return replace(lug, clearance=lug.range.clearance[end]), (LOW_END_TEXT, HIGH_END_TEXT)[end]
    if end == 0:
        return replace(lug, clearance=lug.growth), "none"
    given = lug.clearance - lug.growth  # by the study
    if given:
        return replace(lug, clearance=2.0 * given + lug.growth), "twice the given"
    fit = DEFAULT_FIT_CLEARANCE * 2.0 * pin.band(lug.connection).radius
    words = f"{DEFAULT_FIT_CLEARANCE:g} of the diameter"
    return replace(lug, clearance=fit + lug.growth), words


def _stiffness(lug: Lug, end: int) -> tuple[float, str]:
    times = (lug.range.stiffness or (1.0 / DEFAULT_STIFFNESS_FACTOR, DEFAULT_STIFFNESS_FACTOR))[end]
    return times, f"times {times:g}"


def _tilted(lug: Lug, end: int) -> tuple[Lug, str]:
    if lug.range.tilt is not None:
        return replace(lug, tilt=lug.range.tilt[end]), (LOW_END_TEXT, HIGH_END_TEXT)[end]
    return replace(lug, tilt=(0.0, math.inf)[end]), ("free", "guided")[end]


def _in_words(words: Sequence[str]) -> str:
    return " or ".join(sorted(set(words), reverse=True))

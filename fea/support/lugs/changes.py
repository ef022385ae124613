"""Variations of the uncertain properties of a joint, to see which results depend on them.

By default a clearance ranges from zero to twice the given one (to a free running fit where none is
given), the lugs are half and twice as stiff, and the tilt is free and guided. A lug may have its
own ranges. Both ends of each range are tried for all lugs at once, alone and together with the ends
of the other properties. The part of a clearance that temperature adds (Lug.growth) is not varied.
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
TILT = "tilt"


@dataclass(frozen=True)
class JointChange:
    """A joint with one property changed, or with several together.

    what, value: name of the property, and its value in words.
    lugs: with the change, but for their stiffness.
    softness: factor on the compliance of each lug.
    length: the value if it is a length, the largest of all lugs, m.
    """

    what: str
    value: str
    lugs: tuple[Lug, ...]
    softness: tuple[float, ...]
    length: float | None = None


def joint_variations(pin: Pin, lugs: Sequence[Lug]) -> Iterator[JointChange]:
    """Yield the variations of the lugs of a pin: one property at a time, then several together,
    without those that change nothing.
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
        changes.append(JointChange(TILT, _in_words(words), tilted, same))
    unchanged = (tuple(lugs), same)
    alone = [change for change in changes if (change.lugs, change.softness) != unchanged]
    yield from alone
    yield from _corners(lugs, alone)


def _corners(lugs: Sequence[Lug], changes: Sequence[JointChange]) -> Iterator[JointChange]:
    """Yield every combination of two or more properties, each at one end of its range.

    All combinations are needed, since the effects of single properties do not show the worst one:
    with clearance stiff lugs may raise a stress that without clearance soft lugs raise. Where a
    property has only one change, its other end is the given value. Tilt may also be as given in a
    combination: some lugs may be free and others guided, which is neither of its ends.
    """
    by_property: dict[str, list[JointChange]] = {}
    for change in changes:
        by_property.setdefault(change.what, []).append(change)
    states = (
        [*ends, None] if what == TILT else [*ends, None][:2] for what, ends in by_property.items()
    )
    for ends in itertools.product(*states):
        several = [change for change in ends if change is not None]
        if len(several) > 1:
            yield combined(lugs, several)


def combined(lugs: Sequence[Lug], changes: Sequence[JointChange]) -> JointChange:
    """The change that makes several changes at once, each of another property."""
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
    """Whether the pin is pressed into a lug of the changed joint."""
    return any(lug.clearance < 0.0 for lug in change.lugs)


def softened(lug: Lug, softness: float) -> Lug:
    """The lug and its bushing with their moduli divided by a factor."""
    return lug.with_materials(lambda m: replace(m, youngs_modulus=m.youngs_modulus / softness))


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

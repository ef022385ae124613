"""Dependence of a row's outcome on values within the study's own ranges."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from assess.judgement import BELOW_YIELD, NOT_DECIDED, SAFE
from fea.core.places import ContactPlace
from fea.support.records import FRICTION, TOGETHER, JointRange, JointResult, LostFit, Variation
from reports.data.decision import factor_ends
from reports.data.over_loads import BENEATH_CONTACT, JudgedStress, over_landings, over_links
from reports.data.row import Dependence, PinResult

WITH_ERROR = "with its error"  # stress beneath contact that is too large only with its error
SEVERAL_TOGETHER = "several properties together"  # of a joint
# For a pin that is loose at the temperature of the case: strong enough, not known to be retained
PRESS_FIT, LOST_FIT = "press fit", "press fit lost in"
YIELD_STRENGTH = "yield strength"


def depends_on(pin: PinResult) -> tuple[Dependence, ...]:
    """Return the values on which the outcome of a row depends.

    The result is empty where no value changes the outcome, and where the outcome as described is
    not decided. The stress beneath contact comes first, then the ranges: first that of the joint,
    last that of the yield strength. The outcome for a pin that comes loose depends on what else
    retains it.
    """
    described = pin.as_described
    if pin.max_von_mises == 0.0:  # an unloaded pin may come loose, too
        return tuple(_loose(pin.lost_fits, math.inf))
    if described == NOT_DECIDED or not pin.max_von_mises or not pin.safety_factor:
        return ()
    strength = pin.safety_factor * pin.max_von_mises
    contact = pin.places.contact if pin.places else None
    high, low = (strength / end for end in factor_ends(pin))
    permitted = strength / (pin.required or 1.0)
    judged = JudgedStress(
        low, pin.max_von_mises, high, strength, permitted, described in (SAFE, BELOW_YIELD)
    )
    contact, joint = _as_of_row(contact, pin.joint, strength)
    ranges = _over_loads_and_joint(pin, judged, contact, joint)
    if pin.strength_range is not None:
        ranges += _over_strength(pin, judged, contact, joint, alone=not ranges)
    return tuple(ranges)


def _over_strength(
    pin: PinResult, judged: JudgedStress, contact: ContactPlace | None,
    joint: JointResult | None, alone: bool,
) -> Iterator[Dependence]:  # fmt: skip
    """Yield the yield strength if it changes the outcome within its range, alone or with other
    ranges.

    alone: whether no other range changes the outcome; only then are combinations with others tried.
    """
    assert pin.strength_range is not None
    end = pin.strength_range[0 if judged.safe else 1]
    deep = contact.upper_end if contact else 0.0
    if judged.safe and deep > judged.permitted:  # too large beneath contact even as described
        deep = 0.0
    most = max(judged.high, deep)
    permitted = judged.permitted * end / judged.strength
    if (most > permitted) if judged.safe else (most <= permitted):
        maximum = max(judged.maximum, deep) if judged.safe else judged.maximum
        flips = judged.strength * most / judged.permitted
        yield Dependence(
            YIELD_STRENGTH, "", "strength", end / maximum, given=judged.strength, at=end,
            flips_at=flips, dimension="stress",
        )  # fmt: skip
    elif alone:
        there = replace(judged, strength=end, permitted=permitted)
        others = _over_loads_and_joint(pin, there, contact, joint)
        if others:
            over = joined(["strength", *others[0].over.replace(" and ", ", ").split(", ")])
            factors = [d.factor for d in others]
            factor = min(factors) if judged.safe else max(factors)
            yield Dependence(TOGETHER, "", over, factor)


def _over_loads_and_joint(
    pin: PinResult, judged: JudgedStress, contact: ContactPlace | None, joint: JointResult | None
) -> list[Dependence]:
    """Return the loads and properties of the joint that change the outcome of a row at one yield
    strength.
    """
    strength = judged.strength
    ranges = [*_beneath(judged, contact), *_over_joint(judged, contact, joint)]
    if judged.safe:  # a loose pin is strong enough, but what retains it is not known
        ranges += _loose(pin.lost_fits, strength / judged.maximum)
    if pin.landing is not None:
        ranges += over_landings(judged, contact, pin.landing)
    if pin.sharing is not None:
        ranges += over_links(judged, contact, pin.sharing)
    return ranges or list(_together(judged, contact, joint, pin))


def _loose(lost: Sequence[LostFit], factor: float) -> Iterator[Dependence]:
    """Yield the interference of the lugs in which a pin comes loose; the lug that lacks most
    interference gives the numbers.
    """
    if lost:
        worst, where = max(lost, key=lambda x: x.needed), ", ".join(x.where for x in lost)
        yield Dependence(
            LOST_FIT, where, PRESS_FIT, factor, given=worst.given, flips_at=worst.needed,
            dimension="length",
        )  # fmt: skip


def joined(names: Sequence[str]) -> str:
    """Return names as a list in words: "strength, joint and landing"."""
    return f"{', '.join(names[:-1])} and {names[-1]}"


def _as_of_row(
    contact: ContactPlace | None, joint: JointResult | None, strength: float
) -> tuple[ContactPlace | None, JointResult | None]:
    """Return contact and joint with the stress beneath contact scaled to the yield strength of the
    row.

    In a pin with a hardened surface the stress beneath contact is in the core, whose strength
    differs from that of the row.
    """
    if contact is None or contact.strength is None:
        return contact, joint
    scale = strength / contact.strength
    contact = replace(
        contact, beneath=scale * contact.beneath, beneath_error=scale * contact.beneath_error,
        depths=tuple((scale * stress, depth) for stress, depth in contact.depths),
    )  # fmt: skip
    if joint is None or joint.range is None:
        return contact, joint
    over = tuple(
        replace(v, beneath=None if v.beneath is None else scale * v.beneath)
        for v in joint.range.variations
    )
    return contact, replace(joint, range=replace(joint.range, variations=over))


def _together(
    judged: JudgedStress, contact: ContactPlace | None, joint: JointResult | None, pin: PinResult
) -> Iterator[Dependence]:
    """Yield the ranges of joint, landing and links together if none alone changes the outcome.

    The ranges were not solved together. Each multiplies the stress by the ratio by which it changes
    the stress alone, which is exact where stress is proportional to the loads.
    """
    extreme, over = max if judged.safe else min, joint.range if joint else None
    loads = {"landing": pin.landing, "links": pin.sharing}
    ratios = {
        what: float(extreme(judged.maximum, *each.max_von_mises)) / judged.maximum
        for what, each in loads.items()
        if each is not None
    }
    if len(ratios) + (over is not None) < 2:
        return
    load_ratio, variations = math.prod(ratios.values()), over.variations if over else ()
    counted = [v for v in variations if judged.safe or v.what != FRICTION]
    most = _largest_over_joint(judged, over) if over and judged.safe else judged.high
    beneath = [contact.upper_end if contact else 0.0, *(_upper_end(contact, v) for v in counted)]
    tops = [most] if judged.safe else [_top(judged, v) for v in counted]
    top, deep = (load_ratio * extreme(x) for x in ([judged.high, *tops], beneath))
    if (max(top, deep) > judged.permitted) == judged.safe:
        ends = over.max_von_mises if over else ()
        stress = load_ratio * extreme((judged.maximum, *ends))
        factor = judged.strength / (max(stress, deep) if judged.safe else stress)
        yield Dependence(TOGETHER, "", joined([*["joint"] * (over is not None), *ratios]), factor)


def _beneath(judged: JudgedStress, contact: ContactPlace | None) -> Iterator[Dependence]:
    """Yield the stress beneath contact if it contradicts a row that is safe as described.

    It contradicts the row if its upper end exceeds the permitted stress.
    """
    if contact is None or not judged.safe or contact.upper_end <= judged.permitted:
        return
    exceeds = contact.beneath > judged.permitted
    yield Dependence(
        BENEATH_CONTACT, "" if exceeds else WITH_ERROR, BENEATH_CONTACT,
        judged.strength / (contact.beneath if exceeds else contact.upper_end),
        reach=contact.depth(judged.permitted),
    )  # fmt: skip


def _over_joint(
    judged: JudgedStress, contact: ContactPlace | None, joint: JointResult | None
) -> Iterator[Dependence]:
    """Yield the variations of the joint that change the outcome.

    A row that fails becomes safe by a variation only if the stress beneath contact is then safe,
    too, and never by friction. A row that is safe, also beneath contact, may become unsafe at
    either place.
    """
    over = joint.range if joint else None
    if joint is None or over is None:
        return
    given = max((band.clearance for band in joint.bands), default=None)
    deep = [v for v in over.variations if _upper_end(contact, v) > judged.permitted]
    turning = [
        v
        for v in over.variations
        if judged.turns(v.max_von_mises, v.interval)
        and (judged.safe or (v not in deep and v.what != FRICTION))
    ]
    way = 1.0 if judged.safe else -1.0
    turning = _alone_first(turning, lambda v: way * _counted(judged, v))
    reads_beneath = contact is not None and judged.safe and contact.upper_end <= judged.permitted
    enough = reads_beneath and any(v.what != TOGETHER for v in deep)  # one property suffices
    if enough:
        turning = [v for v in turning if v.what != TOGETHER]
    for v in turning:
        yield Dependence(
            v.what, v.value, "joint", judged.strength / _counted(judged, v),
            given=given if v.length is not None else None, at=v.length,
            flips_at=_crossing(judged, v, given, over.model), dimension="length",
        )  # fmt: skip
    largest = _largest_over_joint(judged, over)
    if not (turning or enough) and judged.safe and largest > judged.permitted:
        lugs = "assumed lugs" if over.assumed else "its lugs"
        what, value = "joint", f"contact with {lugs}"
        if over.model == "contact":  # only with friction, which multiplies the stress of the others
            what, value = TOGETHER, f"all properties and {FRICTION}"
        factor = judged.strength / over.max_von_mises[1]
        yield Dependence(what, value, "joint", factor)
    if contact is None or not reads_beneath:
        return
    beneath = _alone_first([v for v in deep if v not in turning], lambda v: _upper_end(contact, v))
    if any(v.what == TOGETHER for v in turning):  # reported already
        beneath = [v for v in beneath if v.what != TOGETHER]
    for v in beneath:
        end = _upper_end(contact, v)
        what = f"{v.what} {v.value}" if v.length is None else v.what
        what = SEVERAL_TOGETHER if v.what == TOGETHER else what
        yield Dependence(
            BENEATH_CONTACT, what, "joint", judged.strength / end,
            given=given if v.length is not None else None, at=v.length,
            flips_at=_on_the_way(judged, v, given, (contact.upper_end, end)), dimension="length",
        )  # fmt: skip


def _largest_over_joint(judged: JudgedStress, over: JointRange) -> float:
    """Return the largest stress over the joint with its error. Friction multiplies that of all
    other variations.
    """
    tops = [_top(judged, v) for v in over.variations if v.what != FRICTION]
    tops += [over.max_von_mises[1]] if over.model == "foundation" else []
    rubbed = (v.max_von_mises / judged.maximum for v in over.variations if v.what == FRICTION)
    return max([judged.high, *tops]) * max([1.0, *rubbed])


def _top(judged: JudgedStress, v: Variation) -> float:
    """Return the upper end of the stress of a variation; an interval includes the error already."""
    return v.interval[1] if v.interval else v.max_von_mises * judged.high / judged.maximum


def _alone_first(
    variations: list[Variation], beyond: Callable[[Variation], float]
) -> list[Variation]:
    """Return the variations of a single property, or if there are none the variation of several
    properties that goes farthest.

    Whatever one property changes alone, all together change, too.
    beyond: tells how far a variation goes.
    """
    return [v for v in variations if v.what != TOGETHER] or sorted(variations, key=beyond)[-1:]


def _upper_end(contact: ContactPlace | None, v: Variation) -> float:
    """Return the upper end of the stress beneath contact in a variation of the joint.

    Its relative error is taken from the joint as described. The result is 0 without such a stress.
    """
    if contact is None or not contact.beneath or v.beneath is None:
        return 0.0
    return v.beneath * contact.upper_end / contact.beneath


def _counted(judged: JudgedStress, v: Variation) -> float:
    """Return the stress that decides a variation: for a safe row the upper end of its interval, if
    any.
    """
    return v.interval[1] if judged.safe and v.interval else v.max_von_mises


def _crossing(judged: JudgedStress, v: Variation, given: float | None, model: str) -> float | None:
    """Return the length at which the permitted stress is reached, interpolated linearly.

    The length lies between the given length and the varied one. On foundations it is the varied
    length, since the maximum as given is then of another model.
    """
    if model == "foundation":
        return v.length
    end = judged.high if judged.safe else judged.low
    low = v.interval[0] if v.interval else v.max_von_mises * end / judged.maximum
    return _on_the_way(judged, v, given, (end, _top(judged, v) if judged.safe else low))


def _on_the_way(
    judged: JudgedStress, v: Variation, given: float | None, ends: tuple[float, float]
) -> float | None:
    """Return the length at which the permitted stress is reached, interpolated between `ends`.

    ends: the stress at the given length and at the varied one.
    """
    (first, last) = ends
    if v.length is None or given is None or first == last:
        return v.length
    part = (judged.permitted - first) / (last - first)
    return given + min(max(part, 0.0), 1.0) * (v.length - given)

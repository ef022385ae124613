"""Dependence of a row's outcome on ranges of loads: those of a landing and of the stiffness of
links.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fea.core.places import ContactPlace
from pinbase.arrays import Mask
from pinbase.dimensions import Floats
from reports.data.row import Dependence, LandingRange, SharingRange

BENEATH_CONTACT: Literal["beneath"] = "beneath"
IMPULSE_RANGES_TOGETHER = "impulse time, velocity change and pulse together"


@dataclass(frozen=True)
class JudgedStress:
    """A maximum stress and the stresses by which its outcome is judged, all in one unit.

    low, high: the ends of its error.
    strength: yield strength.
    permitted: the stress that the required factor permits.
    safe: the outcome as described.
    """

    low: float
    maximum: float
    high: float
    strength: float
    permitted: float
    safe: bool

    def turns(self, stress: float, ends: tuple[float, float] | None = None) -> bool:
        """Return whether another maximum changes the outcome.

        The other maximum has the same relative error, or its own ends. A change from "fails" to
        "safe" must be certain; for a change from "safe" to "fails" it suffices that it is possible.
        """
        low, high = ends or (stress * self.low / self.maximum, stress * self.high / self.maximum)
        return (high > self.permitted) if self.safe else (max(low, high) <= self.permitted)


def over_links(
    judged: JudgedStress, contact: ContactPlace | None, shared: SharingRange
) -> Iterator[Dependence]:
    """Yield the stiffnesses of links that change the outcome, also by stress beneath contact."""
    at_low, most = (upper_end_beneath(contact, x) for x in shared.beneath or (0.0, 0.0))
    low, high = shared.max_von_mises
    if judged.safe:
        if shared.highest and highest_over_links(judged, shared) > judged.permitted:
            yield Dependence(shared.highest, "", "links", judged.strength / high)
        elif contact is not None and contact.upper_end <= judged.permitted < most:
            yield Dependence(BENEATH_CONTACT, shared.deepest, "links", judged.strength / most)
    elif shared.lowest and judged.turns(low) and at_low <= judged.permitted:
        yield Dependence(shared.lowest, "", "links", judged.strength / low)


def highest_over_links(judged: JudgedStress, shared: SharingRange) -> float:
    """Return the largest stress over the stiffness of the links with its error."""
    return max(shared.upper_end, shared.max_von_mises[1] * judged.high / judged.maximum)


def ratios_over_loads(
    judged: JudgedStress,
    contact: ContactPlace | None,
    landing: LandingRange | None,
    shared: SharingRange | None,
) -> Iterator[tuple[str, tuple[float, float]]]:
    """Yield the ranges of loads that a row has, each with its ratios to the row's stress: of the
    maximum, for a safe row with its error, where it is farthest, and of that beneath contact.
    """
    deep = contact.beneath if contact and contact.beneath else 1.0

    def ratio(stress: Sequence[float], ends: Sequence[float]) -> float:
        if judged.safe:
            return max(1.0, max(stress) / judged.maximum, max(ends) / judged.high)
        return min(1.0, min(stress) / judged.maximum)

    if landing is not None:
        stress, ends = landing.max_von_mises.tolist(), upper_ends(judged, landing).tolist()
        beneath = [deep] * len(stress) if landing.beneath is None else landing.beneath.tolist()
        most = max(deep, *beneath) if judged.safe else beneath[int(np.argmin(stress))]
        yield "landing", (ratio(stress, ends), most / deep)
    if shared is not None:
        at_low, largest = shared.beneath or (deep, deep)
        most = max(deep, largest) if judged.safe else at_low
        ends = [highest_over_links(judged, shared)]
        yield "links", (ratio(shared.max_von_mises, ends), most / deep)


def upper_end_beneath(contact: ContactPlace | None, stress: float) -> float:
    """Return a stress beneath contact under other loads with its error, relatively that of the
    row's.
    """
    if contact is None or not contact.beneath:
        return 0.0
    return stress * contact.upper_end / contact.beneath


def over_landings(
    judged: JudgedStress, contact: ContactPlace | None, r: LandingRange
) -> list[Dependence]:
    """Return the dependences over a landing's range, also by the stress beneath contact.

    A row that fails is safe at another value only if the stress beneath contact is safe, too.
    """
    ends = upper_ends(judged, r)
    if contact is None or contact.beneath <= 0.0 or r.beneath is None:
        return list(_over_landing(judged, r, ends))
    deep_ends = r.beneath * (contact.upper_end / contact.beneath)
    if not judged.safe:
        return list(_over_landing(judged, r, np.maximum(ends, deep_ends)))
    over_landing = list(_over_landing(judged, r, ends))
    if over_landing or contact.upper_end > judged.permitted:
        return over_landing
    deep = replace(judged, low=contact.beneath, maximum=contact.beneath, high=contact.upper_end)
    return [
        replace(d, what=BENEATH_CONTACT, value=f"{d.what} {d.value}".strip())
        for d in _over_landing(deep, replace(r, max_von_mises=r.beneath), deep_ends)
    ]


def upper_ends(judged: JudgedStress, r: LandingRange) -> Floats:
    """Return the maxima (P,) over a landing's range with their errors."""
    return r.max_von_mises * np.maximum(1.0 + r.error, judged.high / judged.maximum)


LandingAxis = tuple[str, str, Floats, float, Mask]


def landing_axes(r: LandingRange) -> tuple[tuple[LandingAxis, LandingAxis], Mask]:
    """Return the axes of a landing's range, impulse time and velocity change, and a mask.

    An axis: name, dimension, values (P,), the value of the case, and a mask (P,) of the points that
    differ from the case in this quantity only. The last mask (P,) has the points with the time and
    velocity change of the case.
    """
    time, velocity = (
        np.isclose(x, given)
        for x, given in zip((r.impulse_time, r.velocity_change), r.nominal, strict=True)
    )
    pulse = np.array([name == r.nominal_pulse for name in r.pulses])
    axes = (
        ("impulse time", "time", r.impulse_time, r.nominal[0], velocity & pulse),
        ("velocity change", "velocity", r.velocity_change, r.nominal[1], time & pulse),
    )
    return axes, time & velocity


def _over_landing(judged: JudgedStress, r: LandingRange, ends: Floats) -> Iterator[Dependence]:
    """Yield the ranges that change the outcome alone, or all ranges together if none does.

    ends: the stresses (P,) with their errors.
    """
    axes, other_pulses = landing_axes(r)
    turned = (ends > judged.permitted) == judged.safe
    any_alone = False
    for what, dimension, values, given, alone in axes:
        here = _nearest(values, given, alone & turned)
        if here is not None:
            any_alone = True
            at, stress = float(values[here]), float(r.max_von_mises[here])
            end = float(ends[here]) if judged.safe else stress * judged.low / judged.maximum
            first = judged.high if judged.safe else judged.low
            flips = _between(judged.permitted, (given, first), (at, end))
            yield Dependence(
                what, "", "landing", judged.strength / stress,
                given=given, at=at, flips_at=flips, dimension=dimension,
            )  # fmt: skip
    for k in np.flatnonzero(other_pulses & turned):
        if r.pulses[int(k)] == r.nominal_pulse:
            continue
        any_alone = True
        factor = judged.strength / float(r.max_von_mises[k])
        yield Dependence("pulse", r.pulses[int(k)], "landing", factor)
    if not any_alone and turned.any():
        extreme = np.max if judged.safe else np.min
        factor = judged.strength / float(extreme(r.max_von_mises))
        yield Dependence(IMPULSE_RANGES_TOGETHER, "", "landing", factor)


def _nearest(values: Floats, given: float, which: Sequence[bool] | Floats) -> int | None:
    """Return the index of the marked value that is nearest in ratio to that of the case."""
    places = np.flatnonzero(which)
    if not len(places):
        return None
    away = np.abs(np.log(values[places] / given))
    return int(places[np.argmin(away)])


def _between(wanted: float, one: tuple[float, float], other: tuple[float, float]) -> float:
    """Return the value at which a stress, a power law through two points, reaches the wanted one.

    one, other: value and stress at each point.
    """
    (x, a), (y, b) = one, other
    if not (a > 0.0 and b > 0.0 and a != b):
        return y
    part = min(max(math.log(wanted / a) / math.log(b / a), 0.0), 1.0)
    return float(x * (y / x) ** part)

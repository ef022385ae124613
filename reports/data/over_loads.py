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
    """Yield the stiffnesses of links that change the outcome, also by the stress beneath contact,
    which scales with the maximum.
    """
    deep = contact.upper_end if contact else 0.0
    low, high = shared.max_von_mises
    for what, stress in ((shared.lowest, low), (shared.highest, high)):
        beneath = deep * stress / judged.maximum
        if not what:
            continue
        if judged.turns(stress) and (judged.safe or beneath <= judged.permitted):
            yield Dependence(what, "", "links", judged.strength / stress)
        elif judged.safe and deep <= judged.permitted < beneath:
            yield Dependence(BENEATH_CONTACT, what, "links", judged.strength / beneath)


def over_landings(
    judged: JudgedStress, contact: ContactPlace | None, r: LandingRange
) -> list[Dependence]:
    """Return the dependences over a landing's range, also by the stress beneath contact, which
    scales with the maximum.

    A row that fails is safe at another value only if the stress beneath contact is safe, too.
    """
    if contact is None or contact.beneath <= 0.0:
        return list(_over_landing(judged, r))
    if not judged.safe:
        return list(_over_landing(replace(judged, high=max(judged.high, contact.upper_end)), r))
    if (over_landing := list(_over_landing(judged, r))) or contact.upper_end > judged.permitted:
        return over_landing
    deep = replace(judged, low=contact.beneath, maximum=contact.beneath, high=contact.upper_end)
    scaled = replace(r, max_von_mises=r.max_von_mises * (contact.beneath / judged.maximum))
    return [
        replace(d, what=BENEATH_CONTACT, value=f"{d.what} {d.value}".strip())
        for d in _over_landing(deep, scaled)
    ]


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


def _over_landing(judged: JudgedStress, r: LandingRange) -> Iterator[Dependence]:
    """Yield the ranges that change the outcome alone, or all ranges together if none does."""
    axes, other_pulses = landing_axes(r)
    turned = np.array([judged.turns(float(stress)) for stress in r.max_von_mises])
    any_alone = False
    for what, dimension, values, given, alone in axes:
        here = _nearest(values, given, alone & turned)
        if here is not None:
            any_alone = True
            at, stress = float(values[here]), float(r.max_von_mises[here])
            flips = _between(judged, (given, judged.maximum), (at, stress))
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


def _between(judged: JudgedStress, one: tuple[float, float], other: tuple[float, float]) -> float:
    """Return the value at which the stress, a power law through two points, reaches the permitted
    one.

    one, other: value and stress at each point.
    """
    end = judged.high if judged.safe else judged.low
    wanted = judged.permitted * judged.maximum / end
    (x, a), (y, b) = one, other
    if not (a > 0.0 and b > 0.0 and a != b):
        return y
    part = min(max(math.log(wanted / a) / math.log(b / a), 0.0), 1.0)
    return float(x * (y / x) ** part)

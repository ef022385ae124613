"""The values that a study leaves open, and the range of a pin's factor over them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from fea.support.records import FRICTION, TOGETHER, Variation
from pinbase.grouped import grouped
from reports.data.decision import beneath_factor
from reports.data.dependence import YIELD_STRENGTH
from reports.data.over_loads import BENEATH_CONTACT, landing_axes
from reports.data.row import Dependence, LandingRange, PinResult

Owner = Literal["joint", "landing", "links", "strength"]
Ends = tuple[float, float]
LINK_STATES = ("times 0.1", "times 10")  # range of the stiffness of links where it is not stated
NO_SPREAD = 1.005  # up to this ratio of factors (0.5 %) a value does not matter


@dataclass(frozen=True)
class OpenValue:
    """A value that is open, and the factors of a row over it, with all other values as described.

    what: "impulse time", "clearance".
    owner: of its range.
    ends: the smallest and the largest value, of `dimension`, if any.
    states: values in words.
    given: the value of the study, a number or a state; None where it has none.
    low, high: the ends of the factor, including that at the row's own value.
    flips: the value that changes the row's outcome; None if none does.
    """

    what: str
    owner: Owner
    dimension: str
    ends: Ends | None
    states: tuple[str, ...]
    given: float | str | None
    low: float
    high: float
    flips: Dependence | None

    @property
    def ratio(self) -> float:
        """The larger over the smaller factor."""
        return self.high / self.low if self.low > 0.0 else math.inf


@dataclass(frozen=True)
class Unknown:
    """An open value over all rows.

    rows: the rows with this value, each with its factors.
    """

    rows: tuple[tuple[PinResult, OpenValue], ...]

    @property
    def what(self) -> str:
        """The name of the open value."""
        return self.rows[0][1].what

    @property
    def flipped(self) -> list[tuple[PinResult, Dependence]]:
        """The rows whose outcome the value changes, each with the dependence."""
        return [(row, value.flips) for row, value in self.rows if value.flips]

    @property
    def largest(self) -> tuple[PinResult, OpenValue]:
        """The row whose factor changes most.

        A row that may lose all its stress comes last: its factor may be infinite, which says
        nothing about the other rows.
        """
        return max(self.rows, key=lambda x: (math.isfinite(x[1].ratio), x[1].ratio))

    @property
    def ratio(self) -> float:
        """The largest ratio of factors of any row over the range of the value."""
        return self.largest[1].ratio

    @property
    def ends(self) -> Ends | None:
        """The smallest and the largest value of all rows."""
        ends = [end for _, value in self.rows for end in value.ends or ()]
        return (min(ends), max(ends)) if ends else None

    @property
    def states(self) -> list[str]:
        """The values in words, each once."""
        return list(dict.fromkeys(state for _, value in self.rows for state in value.states))


def decided_by(unknown: Sequence[Unknown]) -> dict[Owner, list[str]]:
    """Return the pins whose outcome changes within the range of the joint, the landing, the links
    or the strength, by owner of the range, most pins first.

    Values that change an outcome only together count for each of their owners.
    """
    rows = {(row.pin, row.case): row for each in unknown for row, _ in each.rows}.values()
    owners: dict[Owner, list[str]] = {"landing": [], "joint": [], "links": [], "strength": []}
    for owner, pins in owners.items():
        pins += dict.fromkeys(r.pin for r in rows if any(owner in d.over for d in r.depends_on))
    ranked = sorted(owners, key=lambda owner: -len(owners[owner]))
    return {owner: owners[owner] for owner in ranked if owners[owner]}


def unknowns(rows: Iterable[PinResult]) -> list[Unknown]:
    """Return the open values: those that change the outcomes of most rows first, then by their
    effect.
    """
    by_name = grouped((value.what, (row, value)) for row in rows for value in open_values(row))
    every = [Unknown(tuple(values)) for values in by_name.values()]
    return sorted(every, key=lambda u: (-len(u.flipped), -u.ratio))


def open_values(row: PinResult) -> Iterator[OpenValue]:
    """Yield the values that are open for a row; none if the row has no factor."""
    if not row.safety_factor or not row.max_von_mises:
        return
    if row.landing is not None:
        yield from _of_landing(row, row.landing)
    yield from _of_joint(row)
    if row.sharing is not None:
        low, high = _factors(row, row.sharing.max_von_mises)
        flip = next((d for d in row.depends_on if d.over == "links"), None)
        yield OpenValue(
            "stiffness of the links", "links", "1", None, LINK_STATES, None, low, high, flip
        )
    if row.strength_range is not None:
        ends, given = row.strength_range, row.yield_strength
        low, high = (end / row.max_von_mises for end in ends)
        flip = next((d for d in row.depends_on if d.what == YIELD_STRENGTH), None)
        yield OpenValue(YIELD_STRENGTH, "strength", "stress", ends, (), given, low, high, flip)


def factor_spread(row: PinResult) -> Ends | None:
    """Return the ends of a row's factor over all that is open together, without its error.

    The ratios over the joint, the landing, the links and the strength are multiplied. The result is
    None where nothing is open, or the row has no factor.
    """
    factor, stress = row.safety_factor, row.max_von_mises
    if not factor or not stress:
        return None
    low = high = factor
    over = row.joint.range if row.joint else None
    if over is not None:
        least, most = over.max_von_mises
        low, high = low * stress / max(most, stress), _divided(high * stress, min(least, stress))
    if row.landing is not None:
        ratios = row.landing.max_von_mises / stress
        low, high = low / max(float(ratios.max()), 1.0), _divided(high, min(ratios.min(), 1.0))
    if row.sharing is not None:
        least, most = row.sharing.max_von_mises
        low, high = low * stress / most, _divided(high * stress, least)
    if row.strength_range is not None:
        least, most = row.strength_range
        low, high = low * least / (factor * stress), high * most / (factor * stress)
    ranges = over, row.landing, row.sharing, row.strength_range
    return None if all(each is None for each in ranges) else (low, high)


def growth(row: PinResult | None) -> tuple[float, float]:
    """Return the ratio, at least 1, of the largest stress over all that is open together to the
    stress of a row, and that of the stress beneath contact; 1 for None or a row without a factor.
    """
    spread = factor_spread(row) if row else None
    if row is None or spread is None or not row.safety_factor:
        return 1.0, 1.0
    return max(row.safety_factor / spread[0], 1.0), _growth_beneath(row)


def _growth_beneath(row: PinResult) -> float:
    """Return the growth of the stress beneath contact, as `growth` does; 1 without contact.

    The ratios over the joint, the landing, the links and the strength are multiplied.
    """
    contact = row.places.contact if row.places else None
    if contact is None or not contact.beneath:
        return 1.0
    ratios = list[float]()
    if row.joint is not None and row.joint.range is not None:
        ratios += _ratios_over_joint(row.joint.range.variations, contact.beneath)
    if row.landing is not None and row.landing.beneath is not None:
        ratios.append(float(row.landing.beneath.max()) / contact.beneath)
    if row.sharing is not None and row.sharing.beneath is not None:
        ratios.append(row.sharing.beneath[1] / contact.beneath)
    if row.strength_range is not None and row.yield_strength:
        ratios.append(row.yield_strength / row.strength_range[0])
    return math.prod(max(1.0, ratio) for ratio in ratios)


def _ratios_over_joint(variations: Iterable[Variation], beneath: float) -> Iterable[float]:
    """Return the largest ratio of the stress beneath contact over each property of the joint, or
    over all properties where they were solved together.
    """
    known = [(x.what, (x.beneath or 0.0) / beneath) for x in variations]
    together = any(what == TOGETHER for what, _ in known)
    groups = grouped(("" if together else what, ratio) for what, ratio in known)
    return [max(ratios) for ratios in groups.values()]


def least_factor(row: PinResult) -> float:
    """Return the least factor of a row over all that is open together, also by the stress beneath
    contact; inf without a factor.
    """
    spread = factor_spread(row)
    known = spread[0] if spread else row.safety_factor or math.inf
    return min(known, beneath_factor(row) / _growth_beneath(row))


def without_range(row: PinResult) -> bool:
    """Return whether the range of a prescribed support over the joint is not known."""
    joint = row.joint
    return joint is not None and bool(joint.remark) and not joint.range and not joint.bands


def _of_landing(row: PinResult, r: LandingRange) -> Iterator[OpenValue]:
    axes, other_pulses = landing_axes(r)
    for what, dimension, values, given, alone in axes:
        here = values[alone]
        if len(here) > 1:
            low, high = _factors(row, r.max_von_mises[alone].tolist())
            ends = float(here.min()), float(here.max())
            flip = _flip(row, "landing", what)
            yield OpenValue(what, "landing", dimension, ends, (), given, low, high, flip)
    states = tuple(dict.fromkeys(r.pulses))
    if len(states) > 1:
        low, high = _factors(row, r.max_von_mises[other_pulses].tolist())
        flip = _flip(row, "landing", "pulse")
        given_pulse = r.nominal_pulse or None
        yield OpenValue("pulse", "landing", "1", None, states, given_pulse, low, high, flip)


def _of_joint(row: PinResult) -> Iterator[OpenValue]:
    joint = row.joint
    over = joint.range if joint else None
    if joint is None or over is None:
        return
    given = max((band.clearance for band in joint.bands), default=None)
    for what in dict.fromkeys(v.what for v in over.variations if v.what != TOGETHER):
        here = [v for v in over.variations if v.what == what]
        ends = [v.length for v in here if v.length is not None]
        ends += [given] if ends and given is not None else []
        stresses = [s for v in here for s in v.interval or (v.max_von_mises,)]
        if what == FRICTION:  # a reduction of stress by friction is not relied on
            stresses = [max(stresses)]
        low, high = _factors(row, stresses)
        yield OpenValue(
            what, "joint", "length", (min(ends), max(ends)) if ends else None,
            tuple(v.value for v in here if v.length is None), given if ends else None, low, high,
            _flip(row, "joint", what),
        )  # fmt: skip


def _factors(row: PinResult, stresses: Sequence[float]) -> Ends:
    """Return the ends of the factor over given maxima and the maximum of the row."""
    every = [*stresses, row.max_von_mises or 0.0]
    strength = row.yield_strength or 0.0
    return strength / max(every), _divided(strength, min(every))


def _divided(factor: float, least: float) -> float:
    """Return a number over the least stress; inf where the stress is zero."""
    return float(factor / least) if least > 0.0 else math.inf


def _flip(row: PinResult, owner: Owner, what: str) -> Dependence | None:
    """Return the dependence of a row's outcome on an open value; that of the maximum comes before
    that of stress beneath contact.
    """
    for d in sorted(row.depends_on, key=lambda d: d.what == BENEATH_CONTACT):
        named = d.value if d.what == BENEATH_CONTACT else d.what
        if d.over == owner and (named == what or named.startswith(f"{what} ")):
            return d
    return None

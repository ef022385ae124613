"""The values that a study leaves open, and how far the factor of a pin spreads over them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fea.support.records import FRICTION
from reports.data.dependence import BENEATH_CONTACT
from reports.data.results import Dependence, LandingRange, PinResult

Owner = Literal["joint", "landing"]
Ends = tuple[float, float]
NO_SPREAD = 1.005  # ratio of factors up to which a value does not matter: 0.5 %


@dataclass(frozen=True)
class OpenValue:
    """A value that is open, and the factors of a row over it, all other values as described.

    what: "impulse time", "clearance". owner: of its range.
    ends: the smallest and the largest value, of `dimension`, or none; states: others, in words.
    given: the value of the study, a number or a state, None where it has none.
    low, high: ends of the factor, at the row's own value too.
    flips: what changes the row's outcome; None if nothing does.
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

    rows: the rows that it concerns, each with its factors.
    """

    rows: tuple[tuple[PinResult, OpenValue], ...]

    @property
    def what(self) -> str:
        """The name of the open value."""
        return self.rows[0][1].what

    @property
    def flipped(self) -> list[tuple[PinResult, Dependence]]:
        """The rows whose outcome it changes, and at which value."""
        return [(row, value.flips) for row, value in self.rows if value.flips]

    @property
    def ratio(self) -> float:
        """The largest ratio of factors of a row over its range."""
        return max(value.ratio for _, value in self.rows)

    @property
    def ends(self) -> Ends | None:
        """The smallest and the largest value of all rows."""
        ends = [end for _, value in self.rows for end in value.ends or ()]
        return (min(ends), max(ends)) if ends else None

    @property
    def states(self) -> list[str]:
        """The states that are no numbers, each once."""
        return list(dict.fromkeys(state for _, value in self.rows for state in value.states))


def decided_by(unknown: Sequence[Unknown]) -> dict[Owner, list[str]]:
    """Return the pins whose outcome changes within the joint or the landing, most pins first.

    Values that only together change an outcome count too.
    """
    rows = {(row.pin, row.case): row for each in unknown for row, _ in each.rows}.values()
    owners: dict[Owner, list[str]] = {"landing": [], "joint": []}
    for owner, pins in owners.items():
        pins += dict.fromkeys(r.pin for r in rows if any(owner in d.over for d in r.depends_on))
    ranked = sorted(owners, key=lambda owner: -len(owners[owner]))
    return {owner: owners[owner] for owner in ranked if owners[owner]}


def unknowns(rows: Iterable[PinResult]) -> list[Unknown]:
    """Return what is open: first what changes the outcomes of most rows, then by its effect."""
    by_name: dict[str, list[tuple[PinResult, OpenValue]]] = {}
    for row in rows:
        for value in open_values(row):
            by_name.setdefault(value.what, []).append((row, value))
    every = [Unknown(tuple(values)) for values in by_name.values()]
    return sorted(every, key=lambda u: (-len(u.flipped), -u.ratio))


def open_values(row: PinResult) -> Iterator[OpenValue]:
    """Yield the values that are open for a row; none without a factor."""
    if not row.safety_factor or not row.max_von_mises:
        return
    if row.landing is not None:
        yield from _of_landing(row, row.landing)
    yield from _of_joint(row)


def factor_spread(row: PinResult) -> Ends | None:
    """Return the ends of a row's factor over all that is open together, without its error.

    Ratios over the joint and over the landing multiply: they were not solved together.
    None where nothing is open, or the row has no factor.
    """
    factor, stress = row.safety_factor, row.max_von_mises
    if not factor or not stress:
        return None
    low = high = factor
    over = row.joint.range if row.joint else None
    if over is not None:
        least, most = over.max_von_mises
        low, high = low * stress / max(most, stress), high * stress / min(least, stress)
    if row.landing is not None:
        ratios = row.landing.max_von_mises / stress
        low, high = low / max(float(ratios.max()), 1.0), high / min(float(ratios.min()), 1.0)
    return None if over is None and row.landing is None else (low, high)


def without_range(row: PinResult) -> bool:
    """Return whether the range of a prescribed support over the joint is not known."""
    joint = row.joint
    return joint is not None and bool(joint.remark) and not joint.range and not joint.bands


def _of_landing(row: PinResult, r: LandingRange) -> Iterator[OpenValue]:
    time, velocity = (
        np.isclose(x, given)
        for x, given in zip((r.impulse_time, r.velocity_change), r.nominal, strict=True)
    )
    pulse = np.array([name == r.nominal_pulse for name in r.pulses])
    axes = (
        ("impulse time", "time", r.impulse_time, r.nominal[0], velocity & pulse),
        ("velocity change", "velocity", r.velocity_change, r.nominal[1], time & pulse),
    )
    for what, dimension, values, given, alone in axes:
        here = values[alone]
        if len(here) > 1:
            low, high = _factors(row, r.max_von_mises[alone].tolist())
            ends = float(here.min()), float(here.max())
            flip = _flip(row, "landing", what)
            yield OpenValue(what, "landing", dimension, ends, (), given, low, high, flip)
    states = tuple(dict.fromkeys(r.pulses))
    if len(states) > 1:
        low, high = _factors(row, r.max_von_mises[time & velocity].tolist())
        flip = _flip(row, "landing", "pulse")
        given_pulse = r.nominal_pulse or None
        yield OpenValue("pulse", "landing", "1", None, states, given_pulse, low, high, flip)


def _of_joint(row: PinResult) -> Iterator[OpenValue]:
    joint = row.joint
    over = joint.range if joint else None
    if joint is None or over is None:
        return
    given = max((band.clearance for band in joint.bands), default=None)
    for what in dict.fromkeys(v.what for v in over.variations):
        here = [v for v in over.variations if v.what == what]
        ends = [v.length for v in here if v.length is not None]
        ends += [given] if ends and given is not None else []
        stresses = [s for v in here for s in v.interval or (v.max_von_mises,)]
        if what == FRICTION:  # what it takes off the stress is not relied on
            stresses = [max(stresses)]
        low, high = _factors(row, stresses)
        yield OpenValue(
            what, "joint", "length", (min(ends), max(ends)) if ends else None,
            tuple(v.value for v in here if v.length is None), given if ends else None, low, high,
            _flip(row, "joint", what),
        )  # fmt: skip


def _factors(row: PinResult, stresses: Sequence[float]) -> Ends:
    """Return the ends of the factor over some maxima and that of the row."""
    every = [*stresses, row.max_von_mises or 0.0]
    strength = row.yield_strength or 0.0
    return strength / max(every), strength / min(every) if min(every) > 0.0 else math.inf


def _flip(row: PinResult, owner: Owner, what: str) -> Dependence | None:
    """Return the dependence of a row's outcome on an open value, the maximum's first."""
    for d in sorted(row.depends_on, key=lambda d: d.what == BENEATH_CONTACT):
        named = d.value if d.what == BENEATH_CONTACT else d.what
        if d.over == owner and (named == what or named.startswith(f"{what} ")):
            return d
    return None

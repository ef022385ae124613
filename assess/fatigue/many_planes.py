"""Damage on many planes and in many directions at once, for the search of the critical plane.

Rainflow counting cannot be vectorised over the instants, but it can over the planes: all planes
advance by one step together, each with its own stack of turning points. A repeated part of the
spectrum is counted at most three times; the third count stands for all later repetitions, because
from then on four-point counting closes the same cycles every time.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import TypeVar

import numpy as np

from assess.fatigue.flight import RAINFLOW_PASSES, Flight
from assess.fatigue.sn_curve import Life
from pinbase.arrays import Floats, Ints, Mask

PLANE_INSTANT_BATCH = 1_000_000  # planes times instants processed at once; limits memory
MIN_SHEAR_STEP = 1e-6  # relative to the largest shear stress of a case: smaller is round-off
INITIAL_STACK_DEPTH = 16  # turning points for which a stack has room at first

T = TypeVar("T")


@dataclass(frozen=True)
class OnPlanes:
    """The damage (M,) on M planes until the spectrum repeats itself.

    softer: (M,) the damage if the knee were lowered by SOFTENED_KNEE_RATIO (sn_curve).
    largest: (M,) largest equivalent amplitude, Pa.
    """

    damage: Floats
    softer: Floats
    largest: Floats

    def order(self) -> Ints:
        """Return the numbers of the planes, the worst first."""
        return np.lexsort((-self.largest, -self.damage))


def on_planes(
    cases: Sequence[Floats], flight: Flight, planes: tuple[Floats, Floats], k: float, life: Life
) -> OnPlanes:
    """Return the damage on M planes, each with one direction of the shear stress.

    cases: stress (T, 6), Pa, of each load case, which begins and ends at zero.
    planes: normals (M, 3) and directions (M, 3).
    k: Findley's.
    life: S-N curve.
    """
    normals, ways = planes
    longest = max(len(stress) for stress in cases)
    size = max(1, PLANE_INSTANT_BATCH // longest)
    parts = []
    for start in range(0, len(normals), size):
        here = slice(start, start + size)
        across, along = _components(normals[here], ways[here]), _components(normals[here])
        count = _Count(len(across), k, life)
        # Cycles that close within a case are counted once for all its occurrences. The turning
        # points that remain open then go through the whole spectrum.
        left = [
            count.alone(_turns(across @ stress.T, along @ stress.T), flight.order.count(case))
            for case, stress in enumerate(cases)
        ]
        for n in range(RAINFLOW_PASSES):
            for case, weight in _blocks(flight):
                for point in zip(*left[case], strict=True):
                    count.step(*point, weight if n == RAINFLOW_PASSES - 1 else 0)
        parts.append(count.totals)
    return OnPlanes(*(np.concatenate(x) for x in zip(*parts, strict=True)))


def _components(normals: Floats, ways: Floats | None = None) -> Floats:
    """Return the weights (M, 6) of the stress components in the traction on planes along `ways`.

    ways: directions (M, 3), by default the normals.
    """
    a, b = normals.T, (normals if ways is None else ways).T
    shear = [a[i] * b[j] + a[j] * b[i] for i, j in ((1, 2), (0, 2), (0, 1))]
    return np.stack([*(a * b), *shear], axis=1)


def _turns(shear: Floats, normal: Floats) -> tuple[Floats, Floats]:
    """Return the turning points of the shear stress and, for each, the largest normal stress up to
    the next one, (K, M) each.

    The histories start from zero and return to it; the final zero is omitted. Planes with fewer
    turning points repeat their last one.
    shear, normal: (M, T) Pa.
    """
    zero = np.zeros((len(shear), 1))
    grain = MIN_SHEAR_STEP * float(np.abs(shear).max(initial=0.0)) or 1.0
    whole = np.concatenate([zero, np.round(shear / grain) * grain, zero], axis=1)
    top = np.concatenate([zero, normal, zero], axis=1)
    slope = np.sign(np.diff(whole, axis=1)).astype(np.int8)
    ahead = slope.copy()  # the slope of the next step that is not zero
    for t in range(ahead.shape[1] - 2, -1, -1):
        ahead[:, t] = np.where(ahead[:, t], ahead[:, t], ahead[:, t + 1])
    turn = np.ones(whole.shape, dtype=bool)
    turn[:, 1:-1] = (slope[:, :-1] != 0) & (ahead[:, 1:] == -slope[:, :-1])
    largest = np.maximum.reduceat(top.ravel(), np.flatnonzero(turn))
    row, column = np.nonzero(turn)
    place = np.cumsum(turn, axis=1)[row, column] - 1
    inner = column < whole.shape[1] - 1
    row, place = row[inner], place[inner]
    values = np.full((int(place.max()) + 1, len(shear)), np.nan)
    tops = np.zeros_like(values)
    values[place, row], tops[place, row] = whole[turn][inner], largest[inner]
    for one, two in pairwise(values):
        np.copyto(two, one, where=np.isnan(two))
    return values, np.maximum(tops, 0.0)


def _blocks(flight: Flight) -> Iterator[tuple[int, int]]:
    """Yield the cases in their order, and how many times their cycles count."""
    for unit, often in _thrice(flight.each):
        for case, n in _thrice(unit):
            yield case, often * n


def _thrice(items: Iterable[T]) -> Iterator[tuple[T, int]]:
    """Yield the items with their weights; of a run of equal items at most three are yielded, and
    the third has the weight of all that remain.
    """
    for item, run in groupby(items):
        n = sum(1 for _ in run)
        yield from ((item, 1) for _ in range(min(n, 2)))
        if n > 2:
            yield item, n - 2


class _Count:
    """Four-point rainflow counting of M histories in parallel.

    Each history has a stack of turning points that are still open: their values, `_value`
    (depth, M), the largest normal stress up to the next point of the history, `_raw`, and the
    largest normal stress up to the next open point, `_top`.
    """

    def __init__(self, size: int, k: float, life: Life) -> None:
        self._k, self._life = k, life
        self._value, self._raw, self._top = (
            np.zeros((INITIAL_STACK_DEPTH, size)) for _ in range(3)
        )
        self._n = np.zeros(size, dtype=np.int64)
        self.totals = np.zeros(size), np.zeros(size), np.zeros(size)

    def alone(self, turns: tuple[Floats, Floats], often: int) -> tuple[Floats, Floats, Floats]:
        """Count the cycles that close within a case, which occurs `often` times.

        Return the arguments of `step` for the turning points that remain open, (K, M) each.
        """
        within = _Count(len(self._n), self._k, self._life)
        within.totals = self.totals
        for value, top in zip(*turns, strict=True):
            within.step(value, top, top, often)
        count = int(within._n.max())
        beyond = np.arange(count)[:, None] >= within._n
        last = within._value[within._n - 1, np.arange(len(within._n))]
        value = np.where(beyond, last, within._value[:count])
        raw, top = (np.where(beyond, 0.0, kind[:count]) for kind in (within._raw, within._top))
        return value, raw, top

    def step(self, x: Floats, raw: Floats, top: Floats, weight: int) -> None:
        """Advance each history by one value.

        x: (M,) the values, Pa.
        raw, top: (M,) normal stresses as in `_Count`.
        weight: how many times the cycles closed by this step count.
        """
        n = self._n
        every = np.arange(len(n))
        last = self._value[n - 1, every]  # not used where the stack is empty
        # A repeated value only raises the normal stress; a value farther in the same direction
        # replaces the last point; a reversal may close cycles.
        same = (n > 0) & (x == last)
        onward = ~same & (n > 1) & ((x - last) * (last - self._value[n - 2, every]) > 0.0)
        self._raise(self._raw, same, 1, raw)
        self._raise(self._top, same, 1, top)
        self._raise(self._top, onward, 2, self._top[n - 1, every])
        self._n = n = n - onward
        reverses = np.flatnonzero(~same & ~onward & (n > 3))
        while len(reverses):
            reverses = self._close(reverses, weight)
        self._push(np.flatnonzero(~same), x, raw, top)

    def _raise(self, kind: Floats, which: Mask, back: int, top: Floats) -> None:
        """Raise the entries of a stack that are `back` below its end to at least `top`."""
        at = np.flatnonzero(which)
        row = self._n[at] - back
        kind[row, at] = np.maximum(kind[row, at], top[at])

    def _push(self, at: Ints, x: Floats, raw: Floats, top: Floats) -> None:
        """Push a point on the stacks of the histories `at`; the arrays grow if needed."""
        row = self._n[at]
        if len(at) and row.max() >= len(self._value):
            more = ((0, len(self._value)), (0, 0))
            self._value, self._raw, self._top = (
                np.pad(a, more) for a in (self._value, self._raw, self._top)
            )
        self._value[row, at], self._raw[row, at], self._top[row, at] = x[at], raw[at], top[at]
        self._n[at] += 1

    def _close(self, at: Ints, weight: int) -> Ints:
        """Close the cycle before the last point of each history, if there is one.

        Return the histories that may have another cycle to close.
        """
        n = self._n[at]
        a, b, c, d = (self._value[n - j, at] for j in (4, 3, 2, 1))
        size = np.abs(b - c)
        # Four-point rule: the inner range b-c lies within both ranges beside it.
        closes = (size <= np.abs(a - b)) & (size <= np.abs(c - d))
        at, n, size, d = at[closes], n[closes], size[closes], d[closes]
        tops = [self._top[n - j, at] for j in (4, 3, 2)]
        if weight:
            largest = np.maximum(tops[1], self._raw[n - 2, at])
            self._add(at, 0.5 * size + self._k * largest, weight)
        self._top[n - 4, at] = np.maximum(np.maximum(*tops[:2]), tops[2])
        for kind in (self._value, self._raw, self._top):
            kind[n - 3, at] = kind[n - 1, at]
        self._n[at] = n - 2
        return at[n > 5]

    def _add(self, at: Ints, findley: Floats, weight: int) -> None:
        """Add the damage of cycles with Findley's f, Pa, to the totals."""
        equivalent = 2.0 / (self._k + np.hypot(1.0, self._k)) * findley
        damage, softer, largest = self.totals
        damage[at] += weight * self._life.damage(equivalent)
        softer[at] += weight * self._life.softer(equivalent)
        largest[at] = np.maximum(largest[at], equivalent)

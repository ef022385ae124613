"""The largest von Mises stress over the circumference, by superposing unit fields of harmonics.

In the metric of von Mises a stress is five numbers whose squares sum to the equivalent stress
squared (fea.harmonic.five_numbers); over the circumference three of them vary as cos psi and two as
sin psi.

One harmonic alone: the square is a quadratic form of (cos n theta, sin n theta) with entries A, B,
C, so its maximum is known in closed form:

    (A + C) / 2 + sqrt(((A - C) / 2)^2 + B^2)

Several harmonics: `Circumference._search` is a branch and bound over points and instants. Its
bounds, from the cheapest and loosest to the dearest and tightest, are

1. `reach`: the sum over unit loads of the most that each does at the point, a matrix product;
2. `bound`: the sum over harmonics of the maxima above. It is a bound since von Mises is a seminorm:
   the stress of a sum is at most the sum of the stresses;
3. `_tightened`: the LOW_HARMONICS lowest harmonics are sampled together, only the maxima of the
   others are added;
4. `_near_anchors`: loads that change little over many instants would all be evaluated. A few of
   the instants are sampled with all harmonics; the stress of another one exceeds that of the
   nearest of them by no more than what the difference of their loads does, by `reach`.

Pairs of a point and an instant that no bound rules out are evaluated (`round`): von Mises squared
is a trigonometric polynomial, so samples determine its highest crest
(fea.harmonic.trigonometric_maximum). Points come in falling order of `reach`, so the search ends at
the first batch that cannot exceed what has been reached.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from fea.core.pin_loads import Loads, require_solved
from fea.harmonic.fields import MeridianFields
from fea.harmonic.five_numbers import COS, COSINE_COMPONENTS, EVEN_COUNT, SIN, numbers
from fea.harmonic.sampled_waves import (
    crest_all_round,
    crest_where_read,
    sampled,
    steady_crests,
)
from fea.harmonic.trigonometric_maximum import form_maximum, one_wave, upper_bound
from pinbase.arrays import Floats, Ints, Mask

Instants = slice | Ints

# The sizes below change the time of the search, never its result; chosen by judgement.
FIRST_PAIRS = 16  # pairs of points and instants that are evaluated first
PAIR_BATCH = 4096  # pairs sampled at once: limits the memory of the samples
POINT_BATCH = 64  # points bounded together
# Points and angles of an envelope at once: their samples stay in the cache. Tuned on 240 instants
# of 13 harmonics, where 16 points at all 120 angles took three times as long.
CACHED_POINT_BATCH, CACHED_ANGLE_BATCH = 4, 24
ANCHORS = 24  # instants from which the stress of others is bounded, if there are many more
MIN_INSTANTS_PER_ANCHOR = 4  # fewer are evaluated one by one
LOW_HARMONICS = 4  # lowest harmonics, which are sampled together for a tighter bound
# Unit loads of one harmonic up to which quadratic forms take fewer operations than summed stresses.
MAX_QUADRATIC_FORM_LOADS = 4
ALL_INSTANTS = slice(None)
ROUND_OFF = 1e-12  # relative, of a stress
SAME_POINT = 1e-9  # relative: places and stresses that differ by no more differ by round-off


@dataclass(frozen=True)
class Crest:
    """The largest von Mises stress (Pa), at a point (its number), an instant and an angle (rad)."""

    value: float
    point: int
    instant: int
    angle: float


class Region(Protocol):
    """The part of the circumference on which each point is read, instant by instant."""

    def masked(self, points: Ints) -> Mask:
        """Mask (J,) of the points (J,) that are read on a part of the circumference only."""
        ...

    def read(self, points: Ints, instants: Ints) -> Mask:
        """The arcs (J, ARC_COUNT) on which pairs of points and instants, (J,) each, are read.

        Source of the arcs: fea.core.pressed.
        """
        ...


class Circumference:
    """The von Mises stress of one case at all points of a section, at any instant and angle.

    fields: of the unit loads at S points.
    loads: T instants of the case.
    region: where on the circumference points are read; all round by default.

    Raises: ArgumentError when a unit load that acts is not among the fields.
    """

    def __init__(self, fields: MeridianFields, loads: Loads, region: Region | None = None) -> None:
        self.region, self._loads = region, loads
        acting = loads.coefficients()
        require_solved(loads.case, acting, fields.loads)
        units = sorted(acting, key=lambda load: load.n)
        by_phase = np.zeros((len(loads), len(units), 2))
        for k, load in enumerate(units):
            by_phase[:, k] = acting[load]
        self.count = len(loads)
        self.points = len(fields.points)
        self._first, self._second = by_phase[..., 0], by_phase[..., 1]  # (T, K)
        self._at = tuple(fields.loads.index(load) for load in units)
        unit_numbers = numbers(fields, self._at)
        self.fields, self._five, self._unit_reach = fields, unit_numbers.five, unit_numbers.reach
        self._n = np.array([load.n for load in units], dtype=np.int64)
        starts = np.flatnonzero(np.diff(self._n, prepend=-1))
        self._amount_products: dict[int, tuple[Floats, Floats, Floats]] = {}
        self._waves = [slice(*ends) for ends in itertools.pairwise([*starts, len(units)])]

    @property
    def twists(self) -> bool:
        """Whether nothing but torsion acts."""
        return not self._n.any() and not self._first.any()

    @property
    def odd(self) -> bool:
        """Whether only odd harmonics act, so that stresses change sign over half a turn."""
        return bool((self._n % 2 == 1).all())

    def bound(self, points: Ints, instants: Instants = ALL_INSTANTS) -> Floats:
        """An upper bound (J, T), Pa, of the von Mises stress over the circumference.

        points: (J,) numbers.
        instants: T of them, all by default. Exact where one harmonic acts alone.
        """
        return self._sum(points, self._waves, instants)

    def _sum(self, points: Ints, waves: Sequence[slice], instants: Instants) -> Floats:
        """The sum (J, T), Pa, of the maxima of some harmonics, each taken by itself."""
        out = np.zeros((len(points), len(self._first[instants])))
        for wave in waves:
            out += self._of_harmonic(points, wave, instants)
        return out

    @property
    def highest(self) -> int:
        """The highest harmonic that acts, 0 if none does."""
        return int(self._n[-1]) if len(self._n) else 0

    def _of_harmonic(self, points: Ints, wave: slice, instants: Instants = ALL_INSTANTS) -> Floats:
        """The largest von Mises stress (J, T), Pa, of one harmonic by itself.

        wave: the columns of its unit loads.
        """
        five = self._five[points, :, wave]
        if wave.stop - wave.start > MAX_QUADRATIC_FORM_LOADS:
            return self._of_summed_loads(five, wave, instants)
        # The square is quadratic in the load amounts: its forms are built once per point and
        # contracted with the products of amounts at each instant.
        first, second, mixed = (x[instants] for x in self._products(wave))
        even, odd = (x.swapaxes(1, 2) @ x for x in (five[:, COS], five[:, SIN]))
        if self._n[wave.start] == 0:
            # n = 0: nothing varies over the circumference, so the square itself is the maximum.
            square = _forms(even, first) + _forms(odd, second)
        else:
            apart = even - odd
            total = _forms(even + odd, first + second)
            square = form_maximum(total, _forms(apart, first - second), _forms(apart, mixed))
        return np.sqrt(np.maximum(square, 0.0, out=square), out=square)

    def _of_summed_loads(self, five: Floats, wave: slice, instants: Instants) -> Floats:
        """The same for stresses (J, 5, K), which are summed over the loads first."""
        first, second = self._first[instants, wave].T, self._second[instants, wave].T
        flat = np.ascontiguousarray(five).reshape(-1, five.shape[2])
        shape = (len(five), 5, first.shape[1])
        one, other = ((flat @ x).reshape(shape) for x in (first, second))
        if self._n[wave.start] == 0:
            square = np.square(one[:, COS]).sum(axis=1) + np.square(other[:, SIN]).sum(axis=1)
        else:
            # The sine parts lag by a quarter wave, so their phases swap places, one with its sign
            # changed. Then `one` multiplies cos n theta and `other` sin n theta in all five
            # numbers.
            one[:, SIN], other[:, SIN] = -other[:, SIN], one[:, SIN].copy()
            A, C = np.square(one).sum(axis=1), np.square(other).sum(axis=1)
            square = form_maximum(A + C, A - C, np.einsum("jit,jit->jt", one, other))
        return np.asarray(np.sqrt(np.maximum(square, 0.0)))

    def _products(self, wave: slice) -> tuple[Floats, Floats, Floats]:
        """Products (T, K, K) of the amounts of two unit loads of a harmonic at each instant.

        They are those of both first phases, of both second phases, and of one of each.
        """
        if wave.start not in self._amount_products:
            a, b = self._first[:, wave], self._second[:, wave]
            aa, bb, ab = (x[:, :, None] * y[:, None, :] for x, y in ((a, a), (b, b), (a, b)))
            self._amount_products[wave.start] = aa, bb, ab
        return self._amount_products[wave.start]

    def maxima(self, among: Mask, least: float = 0.0) -> Floats:
        """The largest von Mises stress (T,), Pa, at every instant over the points of a mask (S,).

        least: Pa; the result at instants at which no point exceeds it.
        """
        return self._search(among, together=False, least=least)[0]

    def each(self, among: Mask, least: Floats | float = 0.0) -> tuple[Floats, Ints]:
        """The same with the points (T,) where they are; `least` may be one for each instant."""
        value, point = self._search(among, together=False, least=least)
        return value, self._first_there(point, among)

    def _first_there(self, points: Ints, among: Mask) -> Ints:
        """The first points of a mask (S,) with the place and the stress of these.

        Elements share points, on which they find the same stress but for round-off, each in its own
        directions along the outline, so that a search may find either.
        """
        if self.region is not None:
            return points
        one, i = np.unique(points, return_inverse=True)
        first = [next((x for x in self._like(int(k)) if among[x]), k) for k in one]
        return np.array(first, dtype=np.int64)[i]

    def _like(self, point: int) -> list[int]:
        """The points with the place and the stress of a point, rising."""
        known: dict[tuple[object, ...], list[int]] = self.fields.derived
        key = "like", self._at, point
        if key not in known:
            place, reach = self.fields.points[point], self._unit_reach[point]
            apart = np.abs(self.fields.points - place).max(axis=1)
            there = np.flatnonzero(apart <= SAME_POINT * np.abs(place).max())
            differ = np.abs(self._unit_reach[there] - reach) <= SAME_POINT * reach
            known[key] = there[differ.all(axis=1)].tolist()
        return known[key]

    def top(self, among: Mask, least: float = 0.0) -> Crest:
        """The largest von Mises stress over the points of a mask (S,) and over all instants.

        least: Pa; the value of the result where no point exceeds it.
        """
        reached, point = self._search(among, together=True, least=least)
        point, instant = self._first_there(point, among), int(reached.argmax())
        find = self.round if self.region is not None else self.crests
        value, angle = find(point[[instant]], np.array([instant]))
        most = float(value[0]) if reached[instant] > least else least
        return Crest(most, int(point[instant]), instant, float(angle[0]))

    def _search(self, among: Mask, together: bool, least: Floats | float) -> tuple[Floats, Ints]:
        """The maximum (T,), Pa, at every instant and its point (T,), by branch and bound.

        among: (S,) the points that are searched.
        together: only the largest of all instants is needed; those of other instants may be too
        low.
        least: Pa, the value to exceed, or one (T,) for each instant.
        """
        rows, reach = self._by_reach(np.flatnonzero(among))
        best = np.full(self.count, least)
        point = np.full(self.count, rows[0] if len(rows) else 0)
        # Step 1: evaluate the most promising pairs, since a high incumbent rules out most of the
        # others.
        if len(self._waves) > 1 and len(rows):
            i, t = self._likely_pairs(rows[:POINT_BATCH], together)
            _update_best(best, point, t, self.round(i, t, np.full(len(t), least))[0], i)
        # Step 2: go through the points, batch by batch, in falling order of what they can reach.
        for k in range(0, len(rows), POINT_BATCH):
            # No later point reaches more than this one, so the search is complete.
            if reach[k] <= (best.max() if together else best.min()):
                break
            here = rows[k : k + POINT_BATCH]
            # Step 3: drop the instants at which no point of the batch can exceed the incumbent.
            hopeful = self.reach(here).max(axis=0) > (best.max() if together else best)
            if not hopeful.any():
                continue
            # Step 4: bound the remaining pairs more tightly; -1 marks pairs that are ruled out.
            bound = np.full((len(here), self.count), -1.0)
            bound[:, hopeful] = self._tightened(here, hopeful, best.max() if together else best)
            if self.count >= MIN_INSTANTS_PER_ANCHOR * ANCHORS and len(self._waves) > 1:
                self._near_anchors(bound, here, best.max() if together else best)
            if len(self._waves) < 2 and self.region is None:  # the bound is the maximum
                highest = bound.argmax(axis=0)
                value = bound[highest, np.arange(self.count)]
                more = value > best
                best[more], point[more] = value[more], here[highest[more]]
                continue
            # Step 5: evaluate pairs in falling order of their bound; the incumbent rises meanwhile
            # and rules out more of them.
            for i, t in self._pairs_above(bound, best, together):
                beat = np.full(len(t), best.max()) if together else best[t]
                value = self.round(here[i], t, beat)[0]
                bound[i, t] = -1.0
                _update_best(best, point, t, value, here[i])
        return best, point

    def _likely_pairs(self, points: Ints, together: bool) -> tuple[Ints, Ints]:
        """Pairs of points and instants, (P,) each, with the greatest `reach`.

        Their true values are the first incumbents of the search.
        together: the FIRST_PAIRS best of all instants; otherwise the best point of each instant.
        """
        reach = self.reach(points)
        if not together:
            return points[reach.argmax(axis=0)], np.arange(self.count)
        most = np.argsort(-reach, axis=None, kind="stable")[:FIRST_PAIRS]
        i, t = np.unravel_index(most, reach.shape)
        return points[i], t

    def _tightened(self, points: Ints, instants: Mask, beat: Floats | float) -> Floats:
        """A bound (J, T), Pa, at the instants of a mask that is tighter where it exceeds `beat`.

        The lowest harmonics are sampled together there, which keeps their mutual cancellation; the
        maxima of the higher ones are added.
        beat: Pa, one for all instants or (T,).
        """
        at = np.flatnonzero(instants)
        low, high = self._waves[:LOW_HARMONICS], self._waves[LOW_HARMONICS:]
        if not high:
            return self.bound(points, at)
        higher = self._sum(points, high, at)
        bound = higher + self._sum(points, low, at)
        i, t = np.nonzero(bound > (beat[at] if isinstance(beat, np.ndarray) else beat))
        degree = 2 * int(self._n[low[-1].start])
        for k in range(0, len(i), PAIR_BATCH):
            here, now = i[k : k + PAIR_BATCH], t[k : k + PAIR_BATCH]
            samples = self._samples(points[here], at[now], low, degree)
            tight = np.sqrt(upper_bound(samples, degree)) + higher[here, now]
            bound[here, now] = np.minimum(bound[here, now], tight)
        return bound

    def _near_anchors(self, bound: Floats, points: Ints, beat: Floats | float) -> None:
        """Lower bounds (J, T), Pa, in place, by what changes since the nearest anchor.

        beat: Pa, one for all instants or (T,); lower bounds are left.
        """
        nearest, change = self._anchors
        i, t = np.nonzero(bound > beat)
        pairs, pair = np.unique(i * self.count + nearest[t], return_inverse=True)
        if len(pairs) * MIN_INSTANTS_PER_ANCHOR > len(i):
            return
        at, anchor = np.divmod(pairs, self.count)
        there, degree = np.empty(len(pairs)), 2 * self.highest
        for k in range(0, len(pairs), PAIR_BATCH):
            here = slice(k, k + PAIR_BATCH)
            samples = self._samples(points[at[here]], anchor[here], self._waves, degree)
            there[here] = np.sqrt(upper_bound(samples, degree))
        more = (self._unit_reach[points] @ change)[i, t] * (1.0 + ROUND_OFF)
        bound[i, t] = np.minimum(bound[i, t], there[pair] + more)

    @cached_property
    def _anchors(self) -> tuple[Ints, Floats]:
        """The nearest anchor (T,) of every instant, and the change of amounts (K, T) since it.

        Each anchor is the instant whose loads differ most from those of all before it.
        """
        weights = self._unit_reach.max(axis=0)
        nearest = np.zeros(self.count, dtype=np.int64)
        change, far, anchor = np.empty((len(weights), self.count)), np.full(self.count, np.inf), 0
        for _ in range(ANCHORS):
            since = np.hypot(
                self._first - self._first[anchor], self._second - self._second[anchor]
            ).T
            distance = weights @ since
            nearer = distance < far
            nearest[nearer], far[nearer] = anchor, distance[nearer]
            change[:, nearer] = since[:, nearer]
            anchor = int(far.argmax())
        return nearest, change

    def _by_reach(self, rows: Ints) -> tuple[Ints, Floats]:
        """Points (J,) in falling order of their reach at any instant, and that reach (J,), Pa."""
        reach = self._reach[rows]
        order = np.argsort(-reach, kind="stable")
        return rows[order], reach[order]

    @cached_property
    def _reach(self) -> Floats:
        """The largest `reach` of each point over all instants, (S,) Pa."""
        rows = np.arange(self.points)
        parts = [rows[k : k + PAIR_BATCH] for k in range(0, self.points, PAIR_BATCH)]
        return np.concatenate([self.reach(part).max(axis=1, initial=0.0) for part in parts])

    def reach(self, points: Ints, instants: Instants = ALL_INSTANTS) -> Floats:
        """The loosest bound (J, T), Pa: the sum over unit loads of the most that each does."""
        # The factor covers round-off, so that a bound is never below the value that it bounds.
        return np.asarray(
            (self._unit_reach[points] @ self._amplitudes[:, instants]) * (1.0 + ROUND_OFF)
        )

    @cached_property
    def _amplitudes(self) -> Floats:
        """Amounts (K, T) of the unit loads irrespective of their phase."""
        return np.ascontiguousarray(np.hypot(self._first, self._second).T)

    def _pairs_above(
        self, bound: Floats, best: Floats, together: bool
    ) -> Iterator[tuple[Ints, Ints]]:
        """Batches of pairs whose bound (J, T) exceeds the incumbent, those furthest above it first.

        The caller changes `bound` and `best`, the incumbents (T,), between batches. Batches grow
        fourfold: the first ones usually settle the maximum; if they do not, large batches are
        quicker.
        """
        batch = FIRST_PAIRS if together else max(FIRST_PAIRS, self.count)
        while True:
            i, t = np.nonzero(bound > (best.max() if together else best))
            if not len(i):
                return
            if len(i) > batch:
                ahead = bound[i, t] if together else bound[i, t] - best[t]
                few = np.argpartition(-ahead, batch)[:batch]
                i, t = i[few], t[few]
            yield i, t
            batch *= 4

    def round(
        self, points: Ints, instants: Ints, beat: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """The largest von Mises stress (J,), Pa, over the circumference, and its angle (J,), rad.

        points, instants: (J,) each, pairs of them.
        beat: (J,) Pa; where a pair cannot exceed it, any value below it may be returned.
        """
        beat = np.zeros(len(points)) if beat is None else beat
        value, angle = np.zeros(len(points)), np.zeros(len(points))
        for k in range(0, len(points), PAIR_BATCH):
            here = np.arange(k, min(k + PAIR_BATCH, len(points)))
            some = np.zeros(len(here), dtype=bool)
            if self.region is not None:
                some = self.region.masked(points[here])
            for find, rows in (
                (self._crests_all_round, here[~some]),
                (self._crests_where_read, here[some]),
            ):
                if len(rows):
                    value[rows], angle[rows] = find(points[rows], instants[rows], beat[rows])
        return value, angle

    def crests(self, points: Ints, instants: Ints) -> tuple[Floats, Floats]:
        """The same as `round` at points that are read all round, but to the last bit the same
        whichever other pairs are evaluated.
        """
        n = self._n[[wave.start for wave in self._waves]]
        back, forth = self._waves_apart(points, instants)
        return steady_crests(n, back, forth)

    def last_at(self, points: Ints, instants: Ints) -> Floats:
        """The largest stress (J,), Pa, of the highest harmonic alone at pairs, as steadily."""
        if not self._waves:
            return np.zeros(len(points))
        back, forth = (np.array(x[:, :, -1:]) for x in self._waves_apart(points, instants))
        return one_wave(self._n[-1:], back, forth)[0]

    def of_instant(self, instant: int) -> Circumference:
        """The same points at one instant alone."""
        return Circumference(self.fields, self._loads.at(np.array([instant])), self.region)

    def _waves_apart(self, points: Ints, instants: Ints) -> tuple[Floats, Floats]:
        """The factors of `_pair_waves` for all harmonics, each pair summed by itself."""
        five, starts = self._five[points], [wave.start for wave in self._waves]
        summed = (
            np.add.reduceat(five * x[instants][:, None], starts, axis=2)
            for x in (self._first, self._second)
        )
        # In C order, so that later sums run along memory however many pairs there are.
        a, b = (np.ascontiguousarray(x) for x in summed)
        back, forth = a.copy(), b.copy()
        back[:, SIN], forth[:, SIN] = -b[:, SIN], a[:, SIN]
        return back, forth

    def _crests_where_read(
        self, points: Ints, instants: Ints, beat: Floats
    ) -> tuple[Floats, Floats]:
        """The same as `round` at points that are read on a part of the circumference only."""
        assert self.region is not None
        n = self._n[[wave.start for wave in self._waves]]
        read = self.region.read(points, instants)
        back, forth = self._pair_waves(points, instants, self._waves)
        return crest_where_read(n, back, forth, read)

    def _crests_all_round(
        self, points: Ints, instants: Ints, beat: Floats
    ) -> tuple[Floats, Floats]:
        """The same as `round` at points that are read all round."""
        n = self._n[[wave.start for wave in self._waves]]
        back, forth = self._pair_waves(points, instants, self._waves)  # (J, 5, W)
        return crest_all_round(n, back, forth, beat)

    def _samples(self, points: Ints, instants: Ints, waves: Sequence[slice], degree: int) -> Floats:
        """Von Mises squared (J, A), Pa^2, of some harmonics together at equally spaced angles."""
        n = self._n[[wave.start for wave in waves]]
        return sampled(n, *self._pair_waves(points, instants, waves), degree)

    def _pair_waves(
        self, points: Ints, instants: Ints, waves: Sequence[slice]
    ) -> tuple[Floats, Floats]:
        """The factors (J, 5, W) of cos n theta, and of sin n theta, in the five numbers.

        points, instants: (J,) each.
        waves: W harmonics.
        """
        back, forth = (np.empty((len(points), 5, len(waves))) for _ in range(2))
        one, i = np.unique(points, return_inverse=True)
        now, t = np.unique(instants, return_inverse=True)
        for w, wave in enumerate(waves):
            five = np.ascontiguousarray(self._five[one, :, wave])
            a, b = ((five @ x[now, wave].T)[i, :, t] for x in (self._first, self._second))
            # As in `_of_summed_loads`: the sine parts lag by a quarter wave.
            back[:, :EVEN_COUNT, w], back[:, EVEN_COUNT:, w] = a[:, :EVEN_COUNT], -b[:, EVEN_COUNT:]
            forth[:, :EVEN_COUNT, w], forth[:, EVEN_COUNT:, w] = (
                b[:, :EVEN_COUNT],
                a[:, EVEN_COUNT:],
            )
        return back, forth

    def envelope(self, points: Ints, angles: Floats, read: Mask | None = None) -> Floats:
        """The largest von Mises stress (J, A), Pa, over all instants.

        points: (J,) numbers.
        angles: (A,) rad.
        read: (A, J, T) where it counts, everywhere by default. -1 where it never does.
        """
        parts = (
            slice(k, k + CACHED_POINT_BATCH) for k in range(0, len(points), CACHED_POINT_BATCH)
        )
        out = [
            self._squares_over_time(points[part], angles, None if read is None else read[:, part])
            for part in parts
        ]
        square = np.concatenate([np.zeros((0, len(angles))), *out])
        return np.where(square < 0.0, -1.0, np.sqrt(np.maximum(square, 0.0)))

    def _squares_over_time(self, points: Ints, angles: Floats, read: Mask | None) -> Floats:
        """The largest square (J, A), Pa^2, over all instants.

        The five numbers of each harmonic are found once; then they are combined at each angle.
        """
        turns = np.outer(angles, self._n[[wave.start for wave in self._waves]])
        c, s = np.cos(turns), np.sin(turns)
        parts = []
        for part, signed in ((COS, (c, s)), (SIN, (s, -c))):
            five = np.ascontiguousarray(self._five[points, part].swapaxes(0, 1))
            five = five.reshape(five.shape[0] * five.shape[1], five.shape[2])
            amounts = [
                (five[:, wave] @ phase[wave]).ravel()
                for phase in (self._first.T, self._second.T)
                for wave in self._waves
            ]
            if amounts:
                parts.append((np.concatenate(signed, axis=1), np.stack(amounts)))
        out = np.empty((len(points), len(angles)))
        for k in range(0, len(angles), CACHED_ANGLE_BATCH):
            here = slice(k, k + CACHED_ANGLE_BATCH)
            total = np.zeros((len(angles[here]), len(points) * self.count))
            for factors, amount in parts:
                # Each of the five numbers is combined from all harmonics at each angle, squared
                # and summed.
                at = (factors[here] @ amount).reshape(len(total), -1, total.shape[1])
                total += np.square(at, out=at).sum(axis=1)
            square = total.reshape(len(total), len(points), self.count)
            if read is not None:
                square[~read[here]] = -1.0
            out[:, here] = square.max(axis=2).T
        return out

    def stress(self, points: Ints, instant: int, angles: Floats) -> Floats:
        """Stress (J, A, 6), Pa, at an instant: rr, tt, zz, tz, rz, rt.

        points: (J,) numbers.
        angles: (A,) rad.
        """
        # The loads of a harmonic are summed first, then harmonics at each angle.
        here = self.fields.stress[points]
        summed = np.empty((2, len(self._waves), len(points), 6))
        for w, wave in enumerate(self._waves):
            unit = here[:, :, self._at[wave]]
            for phase, amounts in enumerate((self._first, self._second)):
                summed[phase, w] = unit @ amounts[instant, wave]
        turns = np.outer(angles, self._n[[wave.start for wave in self._waves]])
        c, s = np.cos(turns), np.sin(turns)
        out = np.empty((len(angles), len(points), 6))
        for some, factors in ((COSINE_COMPONENTS, (c, s)), (~COSINE_COMPONENTS, (s, -c))):
            parts = np.ascontiguousarray(summed[..., some])
            out[..., some] = np.tensordot(np.stack(factors, axis=1), parts, axes=2)
        return out.swapaxes(0, 1)


def _update_best(best: Floats, point: Ints, t: Ints, value: Floats, at: Ints) -> None:
    """Replace the best values of instants, in place, by values that exceed them.

    best, point: (T,) the best values so far and their points.
    t, value, at: (J,) instants, values and points.
    """
    order = np.argsort(value, kind="stable")
    t, value, at = t[order], value[order], at[order]
    more = value > best[t]
    best[t[more]], point[t[more]] = value[more], at[more]  # the last one stays


def _forms(form: Floats, products: Floats) -> Floats:
    """The values (J, T) of forms (J, K, K) for T pairs of vectors with products (T, K, K)."""
    size = form.shape[1] * form.shape[2]  # there may be no points
    return np.asarray(form.reshape(-1, size) @ products.reshape(-1, size).T)

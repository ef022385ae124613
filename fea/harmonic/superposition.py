"""The largest von Mises stress over the circumference, by branch and bound.

The bounds of `Circumference._search`, from the cheapest and loosest to the dearest and tightest,
are:

1. `reach`: the sum over unit loads of the most that each can cause at the point, a matrix product;
2. `bound`: the sum over harmonics of the maximum of each. It is a bound since von Mises is a
   seminorm: the stress of a sum is at most the sum of the stresses;
3. `_tightened`: the LOW_HARMONICS lowest harmonics are sampled together, and only the maxima of the
   others are added;
4. `_near_anchors`: for loads that change little over many instants, which would otherwise all be
   evaluated. A few instants ("anchors") are sampled with all harmonics. The stress of another
   instant exceeds that of the nearest anchor by no more than what the difference of their loads can
   cause, by `reach`.

Pairs of a point and an instant that no bound rules out are evaluated (`largest_over_angle`). Points
come in falling order of `reach`, so the search ends at the first batch that cannot exceed the
maximum found so far (the incumbent).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fea.harmonic.superposed_stress import PAIR_BATCH, ROUND_OFF, SuperposedStress
from fea.harmonic.trigonometric_maximum import upper_bound
from pinbase.arrays import Floats, Ints, Mask

# These sizes change the time of the search, never its result. They are chosen by judgement.
FIRST_PAIRS = 16  # pairs of points and instants that are evaluated first
POINT_BATCH = 64  # points bounded together
ANCHORS = 24  # instants from which the stress of others is bounded, if there are many more
MIN_INSTANTS_PER_ANCHOR = 4  # with fewer, anchors cost no less than evaluating the instants
LOW_HARMONICS = 4  # number of lowest harmonics sampled together for a tighter bound
SAME_POINT = 1e-9  # relative difference of places and of stresses that is round-off


@dataclass(frozen=True)
class Crest:
    """The largest von Mises stress (Pa), at a point (its number), an instant and an angle (rad)."""

    value: float
    point: int
    instant: int
    angle: float


class Circumference(SuperposedStress):
    """The stress of one case at all points of a section, with the search for its maxima."""

    def maxima(self, among: Mask, least: float = 0.0) -> Floats:
        """The largest von Mises stress (T,), Pa, at every instant over the points of a mask (S,).

        least: Pa, the result at instants at which no point exceeds it.
        """
        return self._search(among, together=False, least=least)[0]

    def each(self, among: Mask, least: Floats | float = 0.0) -> tuple[Floats, Ints]:
        """Return what `maxima` does, and the points (T,) where these stresses are.

        least: Pa, one for all instants or one (T,) for each.
        """
        value, point = self._search(among, together=False, least=least)
        return value, self._first_coinciding(point, among)

    def _first_coinciding(self, points: Ints, among: Mask) -> Ints:
        """The first points of a mask (S,) at the same places as the given ones and with the same
        stress.

        Elements share points. At a shared point they have the same stress but for round-off, since
        each reads it in its own directions along the outline. A search may find either; the first
        one makes its result unique.
        """
        if self.region is not None:
            return points
        one, i = np.unique(points, return_inverse=True)
        first = [next((x for x in self._coinciding(int(k)) if among[x]), k) for k in one]
        return np.array(first, dtype=np.int64)[i]

    def _coinciding(self, point: int) -> list[int]:
        """The numbers, rising, of the points with the same place and the same stress as a point."""
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

        least: Pa, the value of the result where no point exceeds it.
        """
        reached, point = self._search(among, together=True, least=least)
        point, instant = self._first_coinciding(point, among), int(reached.argmax())
        find = self.largest_over_angle if self.region is not None else self.crests
        value, angle = find(point[[instant]], np.array([instant]))
        most = float(value[0]) if reached[instant] > least else least
        return Crest(most, int(point[instant]), instant, float(angle[0]))

    def _search(self, among: Mask, together: bool, least: Floats | float) -> tuple[Floats, Ints]:
        """The maximum (T,), Pa, at every instant and its point (T,), by branch and bound.

        among: (S,) mask of the points that are searched.
        together: only the largest value of all instants is needed; those of other instants may be
        too low.
        least: Pa, the value to exceed, one for all instants or one (T,) for each.
        """
        rows, reach = self._by_reach(np.flatnonzero(among))
        best = np.full(self.count, least)
        point = np.full(self.count, rows[0] if len(rows) else 0)
        # Step 1: evaluate the most promising pairs, since a high incumbent rules out most of the
        # others.
        if len(self._waves) > 1 and len(rows):
            i, t = self._likely_pairs(rows[:POINT_BATCH], together)
            _update_best(
                best, point, t, self.largest_over_angle(i, t, np.full(len(t), least))[0], i
            )
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
                value = self.largest_over_angle(here[i], t, beat)[0]
                bound[i, t] = -1.0
                _update_best(best, point, t, value, here[i])
        return best, point

    def _likely_pairs(self, points: Ints, together: bool) -> tuple[Ints, Ints]:
        """The pairs of points and instants, (P,) each, with the greatest `reach`.

        Their true values are the first incumbents of the search.
        together: return the FIRST_PAIRS best pairs of all instants; otherwise the best point of
        each instant.
        """
        reach = self.reach(points)
        if not together:
            return points[reach.argmax(axis=0)], np.arange(self.count)
        most = np.argsort(-reach, axis=None, kind="stable")[:FIRST_PAIRS]
        i, t = np.unravel_index(most, reach.shape)
        return points[i], t

    def _tightened(self, points: Ints, instants: Mask, beat: Floats | float) -> Floats:
        """A bound (J, T), Pa, at the instants of a mask, tightened where it exceeds `beat`.

        There the lowest harmonics are sampled together, which keeps their mutual cancellation. The
        maxima of the higher ones are added.
        beat: Pa, one for all instants or one (T,) for each.
        """
        at = np.flatnonzero(instants)
        low, high = self._waves[:LOW_HARMONICS], self._waves[LOW_HARMONICS:]
        if not high:
            return self.bound(points, at)
        higher = self._sum(points, high, at)
        bound = higher + self._sum(points, low, at)
        # Only pairs that the cheap bound leaves are sampled: samples cost the most here.
        i, t = np.nonzero(bound > (beat[at] if isinstance(beat, np.ndarray) else beat))
        degree = 2 * int(self._n[low[-1].start])
        for k in range(0, len(i), PAIR_BATCH):
            here, now = i[k : k + PAIR_BATCH], t[k : k + PAIR_BATCH]
            samples = self._samples(points[here], at[now], low, degree)
            tight = np.sqrt(upper_bound(samples, degree)) + higher[here, now]
            bound[here, now] = np.minimum(bound[here, now], tight)
        return bound

    def _near_anchors(self, bound: Floats, points: Ints, beat: Floats | float) -> None:
        """Lower bounds (J, T), Pa, in place, to what the nearest anchor and the change of loads
        from it allow.

        beat: Pa, one for all instants or one (T,) for each; bounds that do not exceed it are left
        unchanged.
        """
        nearest, change = self._anchors
        i, t = np.nonzero(bound > beat)
        # The remaining pairs share anchors. If too few share each, evaluating them costs no more.
        pairs, pair = np.unique(i * self.count + nearest[t], return_inverse=True)
        if len(pairs) * MIN_INSTANTS_PER_ANCHOR > len(i):
            return
        at, anchor = np.divmod(pairs, self.count)
        there, degree = np.empty(len(pairs)), 2 * self.highest
        for k in range(0, len(pairs), PAIR_BATCH):
            here = slice(k, k + PAIR_BATCH)
            samples = self._samples(points[at[here]], anchor[here], self._waves, degree)
            there[here] = np.sqrt(upper_bound(samples, degree))
        # By the triangle inequality: stress at the anchor, plus the most that the change of loads
        # can cause.
        more = (self._unit_reach[points] @ change)[i, t] * (1.0 + ROUND_OFF)
        bound[i, t] = np.minimum(bound[i, t], there[pair] + more)

    @cached_property
    def _anchors(self) -> tuple[Ints, Floats]:
        """The nearest anchor (T,) of every instant, and the change (K, T) of the unit loads'
        amounts from it.

        Each anchor is the instant whose loads differ most from those of all anchors before it.
        """
        weights = self._unit_reach.max(axis=0)
        nearest = np.zeros(self.count, dtype=np.int64)
        change, far, anchor = np.empty((len(weights), self.count)), np.full(self.count, np.inf), 0
        for _ in range(ANCHORS):
            # Greedy: the farthest instant becomes the next anchor, so that none stays far from all.
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

    def _pairs_above(
        self, bound: Floats, best: Floats, together: bool
    ) -> Iterator[tuple[Ints, Ints]]:
        """Yield batches of pairs whose bound (J, T) exceeds the incumbent, those furthest above it
        first.

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

    def of_instant(self, instant: int) -> Circumference:
        """The stress at the same points at a single instant."""
        return Circumference(self.fields, self._loads.at(np.array([instant])), self.region)


def _update_best(best: Floats, point: Ints, t: Ints, value: Floats, at: Ints) -> None:
    """Replace the best values of instants, in place, by values that exceed them.

    best, point: (T,) the best values so far and their points.
    t, value, at: (J,) instants, values and points.
    """
    order = np.argsort(value, kind="stable")
    t, value, at = t[order], value[order], at[order]
    more = value > best[t]
    best[t[more]], point[t[more]] = value[more], at[more]  # the last, the largest, stays

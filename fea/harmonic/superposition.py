"""The largest von Mises stress over the circumference, by superposing unit fields of several
harmonics.

In a metric of von Mises a stress is five numbers whose squares sum to his equivalent squared; over
the circumference three of them go as cos psi and two as sin psi. With one harmonic alone the square
is a quadratic form of (cos n theta, sin n theta) with entries A, B, C, so that its maximum is
closed:

    (A + C) / 2 + sqrt(((A - C) / 2)^2 + B^2)

With several, von Mises being a seminorm, the sum of these maxima is a bound from above; only points
whose bound exceeds what has been found elsewhere are sampled; von Mises squared is a trigonometric
polynomial, so samples give its highest crest (fea.harmonic.trigonometric_maximum). What each unit
load can do at a point at most is a coarser bound, which says in what order points are looked at and
when to stop.
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
from fea.harmonic.sampled_waves import crest_all_round, crest_where_read, sampled
from fea.harmonic.trigonometric_maximum import closed, upper_bound
from pinbase.arrays import Floats, Ints, Mask

Instants = slice | Ints

FIRST_PAIRS = 16  # pairs of points and instants that are sampled to begin with
PAIR_BATCH = 4096  # pairs sampled at once
POINT_BATCH = 64  # points looked at together
CACHED_POINT_BATCH = (
    16  # the same at all instants and angles, so that they stay in the processor's cache
)
LOW_HARMONICS = 4  # harmonics whose sum is sampled for a closer bound
MAX_QUADRATIC_FORM_LOADS = (
    4  # unit loads of a harmonic: up to so many, quadratic forms of them take less than sums
)
ALL_INSTANTS = slice(None)


@dataclass(frozen=True)
class Crest:
    """The largest von Mises stress (Pa), at a point (its number), an instant and an angle (rad)."""

    value: float
    point: int
    instant: int
    angle: float


class Region(Protocol):
    """Where on the circumference points are read, at the instants of a case."""

    def masked(self, points: Ints) -> Mask:
        """Which of some points (J,) are read on a part of it only."""
        ...

    def read(self, points: Ints, instants: Ints) -> Mask:
        """On which arcs (J, BINS) pairs of points and instants are read (fea.core.pressed)."""
        ...


class Circumference:
    """A case on the section's points; region: where these are read, all round by default."""

    def __init__(self, fields: MeridianFields, loads: Loads, region: Region | None = None) -> None:
        self.region = region
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
        found = numbers(fields, self._at)
        self.fields, self._five, self._each = fields, found.five, found.each
        self._n = np.array([load.n for load in units], dtype=np.int64)
        starts = np.flatnonzero(np.diff(self._n, prepend=-1))
        self._kept: dict[int, tuple[Floats, Floats, Floats]] = {}
        self._waves = [slice(*ends) for ends in itertools.pairwise([*starts, len(units)])]

    @property
    def twists(self) -> bool:
        """Whether nothing acts but torsion."""
        return not self._n.any() and not self._first.any()

    @property
    def odd(self) -> bool:
        """Whether only odd harmonics act, so that half a turn changes the signs of stresses."""
        return bool((self._n % 2 == 1).all())

    def bound(self, points: Ints, instants: Instants = ALL_INSTANTS) -> Floats:
        """At least the largest von Mises stress over the circumference, (J, T) Pa, at points (J,)
        and instants; exactly it where only one harmonic acts.
        """
        return self._sum(points, self._waves, instants)

    def _sum(self, points: Ints, waves: Sequence[slice], instants: Instants) -> Floats:
        out = np.zeros((len(points), len(self._first[instants])))
        for wave in waves:
            out += self._alone(points, wave, instants)
        return out

    def last(self, points: Ints) -> tuple[int, Floats]:
        """The highest harmonic that acts, and its largest stress by itself, (J, T) Pa."""
        if not self._waves:
            return 0, np.zeros((len(points), self.count))
        wave = self._waves[-1]
        return int(self._n[wave.start]), self._alone(points, wave)

    def _alone(self, points: Ints, wave: slice, instants: Instants = ALL_INSTANTS) -> Floats:
        five = self._five[points, :, wave]
        if wave.stop - wave.start > MAX_QUADRATIC_FORM_LOADS:
            return self._summed(five, wave, instants)
        first, second, mixed = (x[instants] for x in self._products(wave))
        even, odd = (x.swapaxes(1, 2) @ x for x in (five[:, COS], five[:, SIN]))
        if self._n[wave.start] == 0:
            square = _forms(even, first) + _forms(odd, second)
        else:
            apart = even - odd
            total = _forms(even + odd, first + second)
            square = closed(total, _forms(apart, first - second), _forms(apart, mixed))
        return np.sqrt(np.maximum(square, 0.0, out=square), out=square)

    def _summed(self, five: Floats, wave: slice, instants: Instants) -> Floats:
        """The same, of stresses (J, 5, K) that are summed over the unit loads first."""
        first, second = self._first[instants, wave].T, self._second[instants, wave].T
        flat = np.ascontiguousarray(five).reshape(-1, five.shape[2])
        shape = (len(five), 5, first.shape[1])
        one, other = ((flat @ x).reshape(shape) for x in (first, second))
        if self._n[wave.start] == 0:
            square = np.square(one[:, COS]).sum(axis=1) + np.square(other[:, SIN]).sum(axis=1)
        else:
            one[:, SIN], other[:, SIN] = -other[:, SIN], one[:, SIN].copy()
            A, C = np.square(one).sum(axis=1), np.square(other).sum(axis=1)
            square = closed(A + C, A - C, np.einsum("jit,jit->jt", one, other))
        return np.asarray(np.sqrt(np.maximum(square, 0.0)))

    def _products(self, wave: slice) -> tuple[Floats, Floats, Floats]:
        """Of two loads' amounts at an instant: of the first phases, the second ones, one of each;
        (T, K, K).
        """
        if wave.start not in self._kept:
            a, b = self._first[:, wave], self._second[:, wave]
            aa, bb, ab = (x[:, :, None] * y[:, None, :] for x, y in ((a, a), (b, b), (a, b)))
            self._kept[wave.start] = aa, bb, ab
        return self._kept[wave.start]

    def maxima(self, among: Mask, least: float = 0.0) -> Floats:
        """Over the points of a mask (S,), at every instant (T,), Pa; `least` where they do not
        exceed that.
        """
        return self._search(among, together=False, least=least)[0]

    def exceeds(self, among: Mask, value: float) -> bool:
        """Whether any of the points of a mask (S,) does so at any instant; value: Pa."""
        return bool(self._search(among, together=True, least=value, soon=True)[0].max() > value)

    def top(self, among: Mask, least: float = 0.0) -> Crest:
        """Over the points of a mask (S,) and all instants; of the value `least`, Pa, where none
        exceeds that.
        """
        value, point = self._search(among, together=True, least=least)
        instant = int(value.argmax())
        angle = self.round(point[[instant]], np.array([instant]))[1]
        return Crest(float(value[instant]), int(point[instant]), instant, float(angle[0]))

    def _search(
        self, among: Mask, together: bool, least: float = 0.0, soon: bool = False
    ) -> tuple[Floats, Ints]:
        """At every instant the maximum (T,) Pa, at least `least`, and its point (T,); `together`:
        the largest of all is right, those of other instants need not be; soon: any beyond `least`
        will do.

        Points are looked at in the order of what they can reach at most.
        """
        rows, reach = self._in_order(np.flatnonzero(among))
        best = np.full(self.count, least)
        point = np.full(self.count, rows[0] if len(rows) else 0)
        if len(self._waves) > 1 and len(rows):
            i, t = self._likely(rows[:POINT_BATCH], together)
            _raise(best, point, t, self.round(i, t, np.full(len(t), least))[0], i)
        for k in range(0, len(rows), POINT_BATCH):
            if reach[k] <= (best.max() if together else best.min()):
                break
            if soon and best.max() > least:
                break
            here = rows[k : k + POINT_BATCH]
            hopeful = self.reach(here).max(axis=0) > (best.max() if together else best)
            if not hopeful.any():
                continue
            bound = np.full((len(here), self.count), -1.0)
            bound[:, hopeful] = self._closer(here, hopeful, best.max() if together else best)
            if len(self._waves) < 2 and self.region is None:  # the bound is the maximum
                highest = bound.argmax(axis=0)
                value = bound[highest, np.arange(self.count)]
                more = value > best
                best[more], point[more] = value[more], here[highest[more]]
                continue
            for i, t in self._worth(bound, best, together):
                beat = np.full(len(t), best.max()) if together else best[t]
                value = self.round(here[i], t, beat)[0]
                bound[i, t] = -1.0
                _raise(best, point, t, value, here[i])
        return best, point

    def _likely(self, points: Ints, together: bool) -> tuple[Ints, Ints]:
        """Points and instants (P,) that can reach most: what they do reach rules out many others
        before these are looked at closely.
        """
        reach = self.reach(points)
        if not together:
            return points[reach.argmax(axis=0)], np.arange(self.count)
        most = np.argsort(-reach, axis=None, kind="stable")[:FIRST_PAIRS]
        i, t = np.unravel_index(most, reach.shape)
        return points[i], t

    def _closer(self, points: Ints, instants: Mask, beat: Floats | float) -> Floats:
        """A bound (J, T) Pa for instants of a mask, closer where it exceeds `beat` and many
        harmonics act: of the lowest ones together, sampled, and of each of the others.
        """
        at = np.flatnonzero(instants)
        low, high = self._waves[:LOW_HARMONICS], self._waves[LOW_HARMONICS:]
        if not high:
            return self.bound(points, at)
        rest = self._sum(points, high, at)
        out = rest + self._sum(points, low, at)
        i, t = np.nonzero(out > (beat[at] if isinstance(beat, np.ndarray) else beat))
        degree = 2 * int(self._n[low[-1].start])
        for k in range(0, len(i), PAIR_BATCH):
            here, now = i[k : k + PAIR_BATCH], t[k : k + PAIR_BATCH]
            samples = self._samples(points[here], at[now], low, degree)
            together = np.sqrt(upper_bound(samples, degree)) + rest[here, now]
            out[here, now] = np.minimum(out[here, now], together)
        return out

    def _in_order(self, rows: Ints) -> tuple[Ints, Floats]:
        """Points, those first that can reach most, and how much, Pa."""
        reach = self._reach[rows]
        order = np.argsort(-reach, kind="stable")
        return rows[order], reach[order]

    @cached_property
    def _reach(self) -> Floats:
        """The largest of these at any instant, (S,) Pa."""
        rows = np.arange(self.points)
        parts = [rows[k : k + PAIR_BATCH] for k in range(0, self.points, PAIR_BATCH)]
        return np.concatenate([self.reach(part).max(axis=1, initial=0.0) for part in parts])

    def reach(self, points: Ints, instants: Instants = ALL_INSTANTS) -> Floats:
        """A bound that is sooner found: the sum over unit loads of what each can do by itself."""
        return np.asarray((self._each[points] @ self._most[:, instants]) * (1.0 + 1e-12))

    @cached_property
    def _most(self) -> Floats:
        """Amounts of the unit loads whatever their phases, (K, T)."""
        return np.ascontiguousarray(np.hypot(self._first, self._second).T)

    def _worth(self, bound: Floats, best: Floats, together: bool) -> Iterator[tuple[Ints, Ints]]:
        """Pairs of points and instants whose bound (J, T) exceeds the best so far, both of which
        change meanwhile: the highest ones first, then more and more.
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
        """Largest von Mises stress (J,) Pa over the circumference at pairs of points and instants,
        and the angle (rad) where it is. beat: (J,) Pa, of pairs that cannot exceed it any value
        below it.
        """
        beat = np.zeros(len(points)) if beat is None else beat
        value, angle = np.zeros(len(points)), np.zeros(len(points))
        for k in range(0, len(points), PAIR_BATCH):
            here = np.arange(k, min(k + PAIR_BATCH, len(points)))
            some = np.zeros(len(here), dtype=bool)
            if self.region is not None:
                some = self.region.masked(points[here])
            for find, rows in ((self._round, here[~some]), (self._round_partly, here[some])):
                if len(rows):
                    value[rows], angle[rows] = find(points[rows], instants[rows], beat[rows])
        return value, angle

    def _round_partly(self, points: Ints, instants: Ints, beat: Floats) -> tuple[Floats, Floats]:
        """The same of points that are read on a part of the circumference."""
        assert self.region is not None
        n = self._n[[wave.start for wave in self._waves]]
        read = self.region.read(points, instants)
        back, forth = self._parts(points, instants, self._waves)
        return crest_where_read(n, back, forth, read)

    def _round(self, points: Ints, instants: Ints, beat: Floats) -> tuple[Floats, Floats]:
        n = self._n[[wave.start for wave in self._waves]]
        back, forth = self._parts(points, instants, self._waves)  # (J, 5, W)
        return crest_all_round(n, back, forth, beat)

    def _samples(self, points: Ints, instants: Ints, waves: Sequence[slice], degree: int) -> Floats:
        """Von Mises squared (J, A), Pa^2, of some harmonics at even angles."""
        n = self._n[[wave.start for wave in waves]]
        return sampled(n, *self._parts(points, instants, waves), degree)

    def _parts(self, points: Ints, instants: Ints, waves: Sequence[slice]) -> tuple[Floats, Floats]:
        """Of pairs of points and instants what goes as cos n theta and as sin n theta, by wave,
        (J, 5, W) each.
        """
        back, forth = (np.empty((len(points), 5, len(waves))) for _ in range(2))
        one, i = np.unique(points, return_inverse=True)
        now, t = np.unique(instants, return_inverse=True)
        for w, wave in enumerate(waves):
            five = np.ascontiguousarray(self._five[one, :, wave])
            a, b = ((five @ x[now, wave].T)[i, :, t] for x in (self._first, self._second))
            back[:, :EVEN_COUNT, w], back[:, EVEN_COUNT:, w] = a[:, :EVEN_COUNT], -b[:, EVEN_COUNT:]
            forth[:, :EVEN_COUNT, w], forth[:, EVEN_COUNT:, w] = (
                b[:, :EVEN_COUNT],
                a[:, EVEN_COUNT:],
            )
        return back, forth

    def envelope(self, points: Ints, angles: Floats, read: Mask | None = None) -> Floats:
        """Largest von Mises stress (J, A) Pa over all instants at points (J,) and angles (rad);
        read: (J, A, T) where it counts, all by default; -1 where it never does.
        """
        parts = (
            slice(k, k + CACHED_POINT_BATCH) for k in range(0, len(points), CACHED_POINT_BATCH)
        )
        out = [
            self._over_time(points[part], angles, None if read is None else read[part])
            for part in parts
        ]
        square = np.concatenate([np.zeros((0, len(angles))), *out])
        return np.where(square < 0.0, -1.0, np.sqrt(np.maximum(square, 0.0)))

    def _over_time(self, points: Ints, angles: Floats, read: Mask | None) -> Floats:
        """Its square (J, A): the numbers of every harmonic first, then those at each angle."""
        turns = np.outer(angles, self._n[[wave.start for wave in self._waves]])
        c, s = np.cos(turns), np.sin(turns)
        total = np.zeros((len(angles), len(points), self.count))
        for part, signed in ((COS, (c, s)), (SIN, (s, -c))):
            five = self._five[points, part]
            amounts = [
                five[:, :, wave] @ phase[:, wave].T
                for phase in (self._first, self._second)
                for wave in self._waves
            ]
            if amounts:
                at = np.tensordot(np.concatenate(signed, axis=1), np.stack(amounts), axes=1)
                total += np.square(at, out=at).sum(axis=2)
        if read is not None:
            total[~read.swapaxes(0, 1)] = -1.0
        return np.asarray(total.max(axis=2).T)

    def stress(self, points: Ints, instant: int, angles: Floats) -> Floats:
        """Stress (J, A, 6) in Pa at points and angles (A,): rr, tt, zz, tz, rz, rt."""
        out = np.zeros((len(points), len(angles), 6))
        here = self.fields.stress[points]
        for wave in self._waves:
            unit = here[:, :, self._at[wave]]
            first, second = (unit @ x[instant, wave] for x in (self._first, self._second))
            c, s = np.cos(self._n[wave.start] * angles), np.sin(self._n[wave.start] * angles)
            back = first[:, None] * c[:, None] + second[:, None] * s[:, None]
            forth = first[:, None] * s[:, None] - second[:, None] * c[:, None]
            out += np.where(COSINE_COMPONENTS, back, forth)
        return out


def _raise(best: Floats, point: Ints, t: Ints, value: Floats, at: Ints) -> None:
    """Put values (J,) at points into the best so far of their instants (T,), if they exceed it."""
    order = np.argsort(value, kind="stable")
    t, value, at = t[order], value[order], at[order]
    more = value > best[t]
    best[t[more]], point[t[more]] = value[more], at[more]  # the last one stays


def _forms(form: Floats, products: Floats) -> Floats:
    """Quadratic forms (J, K, K) of T pairs of vectors, whose products are (T, K, K); (J, T)."""
    size = form.shape[1] * form.shape[2]  # there may be no points
    return np.asarray(form.reshape(-1, size) @ products.reshape(-1, size).T)

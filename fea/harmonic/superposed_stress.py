"""The von Mises stress over the circumference, by superposing unit fields of harmonics.

In the metric of von Mises a stress is five numbers whose squares sum to the equivalent stress
squared (fea.harmonic.five_numbers). Over the circumference three of them vary as cos psi and two as
sin psi.

If one harmonic acts alone, the square is a quadratic form of (cos n theta, sin n theta) with
entries A, B, C, so its maximum is known in closed form:

    (A + C) / 2 + sqrt(((A - C) / 2)^2 + B^2)

If several harmonics act, von Mises squared is a trigonometric polynomial, so samples determine its
highest crest (fea.harmonic.trigonometric_maximum).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import cached_property
from typing import Protocol

import numpy as np

from fea.core.pin_loads import Loads, require_solved
from fea.harmonic.fields import MeridianFields
from fea.harmonic.five_numbers import COS, COSINE_COMPONENTS, SIN, numbers
from fea.harmonic.sampled_waves import crest_all_round, crest_where_read, sampled, steady_crests
from fea.harmonic.trigonometric_maximum import form_maximum, one_wave
from pinbase.arrays import Floats, Ints, Mask

Instants = slice | Ints

# These sizes change the time, never the result. They are chosen by judgement.
PAIR_BATCH = 4096  # pairs of points and instants evaluated together: limits their memory
# Pairs of points and instants, and angles, of an envelope evaluated together, so that their samples
# stay in the cache. Tuned on 240 instants of 13 harmonics, where 16 points at all 120 angles took
# three times as long.
CACHED_PAIR_BATCH, CACHED_ANGLE_BATCH = 960, 24
ALL_INSTANTS = slice(None)
ROUND_OFF = 1e-12  # relative, of a stress


class Region(Protocol):
    """The part of the circumference on which each point is read, instant by instant."""

    def masked(self, points: Ints) -> Mask:
        """A mask (J,) of the points (J,) that are read on part of the circumference only."""

    def read(self, points: Ints, instants: Ints) -> Mask:
        """The arcs (J, ARC_COUNT) on which pairs of points and instants, (J,) each, are read.

        Source of the arcs: fea.core.pressed.
        """


class SuperposedStress:
    """The von Mises stress of one case at all points of a section, at any instant and angle.

    fields: of the unit loads at S points.
    loads: T instants of the case.
    region: the part of the circumference on which points are read; all of it by default.

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
        self._waves = [slice(*ends) for ends in itertools.pairwise([*starts, len(units)])]
        self._orders = self._n[starts]  # the harmonic of each wave

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

        The bound is the sum over harmonics of the maximum of each, so it is exact where one
        harmonic acts alone.
        points: (J,) numbers.
        instants: T of them, all by default.
        """
        return self._sum(points, self._waves, instants)

    def _sum(self, points: Ints, waves: Sequence[slice], instants: Instants) -> Floats:
        """The sum (J, T), Pa, over some harmonics of the largest von Mises stress of each."""
        out = np.zeros((len(points), len(self._first[instants])))
        for wave in waves:
            out += self._of_harmonic(points, wave, instants)
        return out

    @property
    def highest(self) -> int:
        """The highest harmonic that acts, 0 if none does."""
        return int(self._n[-1]) if len(self._n) else 0

    def _of_harmonic(self, points: Ints, wave: slice, instants: Instants = ALL_INSTANTS) -> Floats:
        """The largest von Mises stress (J, T), Pa, of one harmonic acting alone.

        wave: the columns of its unit loads.
        """
        five = self._five[points, :, wave]
        first, second = self._first[instants, wave].T, self._second[instants, wave].T
        flat = np.ascontiguousarray(five).reshape(-1, five.shape[2])
        shape = (len(five), 5, first.shape[1])
        phase_0, phase_1 = ((flat @ x).reshape(shape) for x in (first, second))
        if self._n[wave.start] == 0:
            # Nothing varies over the circumference, so the square itself is the maximum.
            square = np.square(phase_0[:, COS]).sum(axis=1) + np.square(phase_1[:, SIN]).sum(axis=1)
        else:
            # The sine parts lag by a quarter wave. So their phases swap places, one of them with
            # its sign changed. Then `phase_0` multiplies cos n theta and `phase_1` multiplies
            # sin n theta in all five numbers.
            phase_0[:, SIN], phase_1[:, SIN] = -phase_1[:, SIN], phase_0[:, SIN].copy()
            A, C = np.square(phase_0).sum(axis=1), np.square(phase_1).sum(axis=1)
            square = form_maximum(A + C, A - C, np.einsum("jit,jit->jt", phase_0, phase_1))
        return np.asarray(np.sqrt(np.maximum(square, 0.0, out=square)))

    def reach(self, points: Ints, instants: Instants = ALL_INSTANTS) -> Floats:
        """The loosest upper bound (J, T), Pa: the sum over unit loads of the most that each can
        cause.
        """
        # The factor covers round-off, so that a bound is never below the value that it bounds.
        return np.asarray(
            (self._unit_reach[points] @ self._amplitudes[:, instants]) * (1.0 + ROUND_OFF)
        )

    @cached_property
    def _amplitudes(self) -> Floats:
        """The amounts (K, T) of the unit loads, both phases combined."""
        return np.ascontiguousarray(np.hypot(self._first, self._second).T)

    def largest_over_angle(
        self, points: Ints, instants: Ints, beat: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """The largest von Mises stress (J,), Pa, over the circumference, and its angle (J,), rad.

        points, instants: (J,) each, which make J pairs.
        beat: (J,) Pa, the value to exceed. Where a pair cannot exceed it, any value below it may be
        returned.
        """
        beat = np.zeros(len(points)) if beat is None else beat
        value, angle = np.zeros(len(points)), np.zeros(len(points))
        for k in range(0, len(points), PAIR_BATCH):
            here = np.arange(k, min(k + PAIR_BATCH, len(points)))
            some = np.zeros(len(here), dtype=bool)
            if self.region is not None:
                some = self.region.masked(points[here])
            for rows, region in ((here[~some], None), (here[some], self.region)):
                if not len(rows):
                    continue
                at = points[rows], instants[rows]
                cosine, sine = self._pair_waves(*at, self._waves)  # (J, 5, W)
                if region is None:
                    crests = crest_all_round(self._orders, cosine, sine, beat[rows])
                else:
                    crests = crest_where_read(self._orders, cosine, sine, region.read(*at))
                value[rows], angle[rows] = crests
        return value, angle

    def crests(self, points: Ints, instants: Ints) -> tuple[Floats, Floats]:
        """Return what `largest_over_angle` does, at points that are read all round.

        Each value is the same to the last bit whichever other pairs are evaluated with it.
        """
        return steady_crests(self._orders, *self._waves_apart(points, instants))

    def highest_harmonic_at(self, points: Ints, instants: Ints) -> Floats:
        """The largest von Mises stress (J,), Pa, of the highest harmonic alone, at pairs of points
        and instants (J,). It does not depend on the other pairs, as in `crests`.
        """
        if not self._waves:
            return np.zeros(len(points))
        cosine, sine = (np.array(x[:, :, -1:]) for x in self._waves_apart(points, instants))
        return one_wave(self._n[-1:], cosine, sine)[0]

    def _waves_apart(self, points: Ints, instants: Ints) -> tuple[Floats, Floats]:
        """Return the factors of `_pair_waves` for all harmonics, each pair summed independently of
        the others.
        """
        five, starts = self._five[points], [wave.start for wave in self._waves]
        summed = (
            np.add.reduceat(five * x[instants][:, None], starts, axis=2)
            for x in (self._first, self._second)
        )
        # In C order, so that later sums run along memory however many pairs there are.
        a, b = (np.ascontiguousarray(x) for x in summed)
        cosine, sine = a.copy(), b.copy()
        cosine[:, SIN], sine[:, SIN] = -b[:, SIN], a[:, SIN]
        return cosine, sine

    def _samples(self, points: Ints, instants: Ints, waves: Sequence[slice], degree: int) -> Floats:
        """Von Mises squared (J, A), Pa^2, of some harmonics together at equally spaced angles."""
        n = self._n[[wave.start for wave in waves]]
        return sampled(n, *self._pair_waves(points, instants, waves), degree)

    def _pair_waves(
        self, points: Ints, instants: Ints, waves: Sequence[slice]
    ) -> tuple[Floats, Floats]:
        """The factors (J, 5, W) of cos n theta, and of sin n theta, in the five numbers.

        points, instants: (J,) each, which make J pairs.
        waves: W harmonics.
        """
        cosine, sine = (np.empty((len(points), 5, len(waves))) for _ in range(2))
        one, i = np.unique(points, return_inverse=True)
        now, t = np.unique(instants, return_inverse=True)
        for w, wave in enumerate(waves):
            five = np.ascontiguousarray(self._five[one, :, wave])
            a, b = ((five @ x[now, wave].T)[i, :, t] for x in (self._first, self._second))
            # As in `_of_harmonic`: the sine parts lag by a quarter wave.
            cosine[:, COS, w], cosine[:, SIN, w] = a[:, COS], -b[:, SIN]
            sine[:, COS, w], sine[:, SIN, w] = b[:, COS], a[:, SIN]
        return cosine, sine

    def envelope(self, points: Ints, angles: Floats, read: Mask | None = None) -> Floats:
        """The largest von Mises stress (J, A), Pa, over all instants, to seven digits.

        points: (J,) numbers.
        angles: (A,) rad.
        read: (A, J, T) whether the stress counts; always by default. The result is -1 where it
        never does.
        """
        batch = max(1, CACHED_PAIR_BATCH // max(self.count, 1))
        parts = (slice(k, k + batch) for k in range(0, len(points), batch))
        out = [
            self._squares_over_time(points[part], angles, None if read is None else read[:, part])
            for part in parts
        ]
        square = np.concatenate([np.zeros((0, len(angles))), *out])
        return np.where(square < 0.0, -1.0, np.sqrt(np.maximum(square, 0.0)))

    def _squares_over_time(self, points: Ints, angles: Floats, read: Mask | None) -> Floats:
        """The largest von Mises stress squared (J, A), Pa^2, over all instants.

        The five numbers of each harmonic are found once and then combined at each angle.
        """
        turns = np.outer(angles, self._orders)
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
                factors = np.concatenate(signed, axis=1)
                parts.append((factors.astype(np.float32), np.stack(amounts).astype(np.float32)))
        out = np.empty((len(points), len(angles)))
        for k in range(0, len(angles), CACHED_ANGLE_BATCH):
            here = slice(k, k + CACHED_ANGLE_BATCH)
            total = np.zeros((len(angles[here]), len(points) * self.count), dtype=np.float32)
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
        """The stress (J, A, 6), Pa, at an instant: rr, tt, zz, tz, rz, rt.

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
        turns = np.outer(angles, self._orders)
        c, s = np.cos(turns), np.sin(turns)
        out = np.empty((len(angles), len(points), 6))
        for some, factors in ((COSINE_COMPONENTS, (c, s)), (~COSINE_COMPONENTS, (s, -c))):
            parts = np.ascontiguousarray(summed[..., some])
            out[..., some] = np.tensordot(np.stack(factors, axis=1), parts, axes=2)
        return out.swapaxes(0, 1)

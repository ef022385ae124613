"""The largest von Mises stress round the axis, by superposing unit fields of several harmonics.

At a point of the section the stress is the sum over n of P_n cos n theta + Q_n sin n theta. With
one harmonic alone, von Mises squared is a quadratic form of (cos n theta, sin n theta) with entries
A = P.P, B = P.Q, C = Q.Q (in von Mises' metric), so that its maximum is closed:

    (A + C) / 2 + sqrt(((A - C) / 2)^2 + B^2)

With several, von Mises being a seminorm, the sum of these maxima is a bound from above; only points
whose bound exceeds what has been found elsewhere are sampled; von Mises squared is a trigonometric
polynomial, so samples give its highest crest (fea.crest).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fea.crest import highest_crest
from fea.meridian_fields import MeridianFields
from fea.pin_loads import Floats, PinLoads
from fea.stress import VON_MISES, von_mises

Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

SAMPLES = 64  # round the axis, at least
SAMPLES_PER_WAVE = 5  # of von Mises squared
FIRST = 8  # points, or pairs of points and instants, that are sampled to begin with
CHUNK = 4096  # points sampled at once
EVEN = np.array([1.0, 1.0, 1.0, 0.0, 1.0, 0.0])  # components that go as cos psi
ODD = 1.0 - EVEN
_SIZES, _AXES = np.linalg.eigh(VON_MISES)
ROOT = (_AXES * np.sqrt(np.maximum(_SIZES, 0.0))).T[1:]  # (5, 6): ROOT^T ROOT is VON_MISES


@dataclass(frozen=True)
class Top:
    """The largest von Mises stress (Pa), at a point (its number), an instant and an angle (rad)."""

    value: float
    point: int
    instant: int
    angle: float


@dataclass(frozen=True)
class Wave:
    """One harmonic of a case: stress (S, 6, K) Pa per unit load, coefficients (T, K) by phase."""

    n: int
    stress: Floats
    first: Floats
    second: Floats

    @cached_property
    def bound(self) -> Floats:
        """Largest von Mises stress of this harmonic alone, (S, T) Pa."""
        A, B, C = self.forms
        if self.n == 0:
            return np.sqrt(np.maximum(A, 0.0))
        return np.sqrt(np.maximum((A + C) / 2.0 + np.hypot((A - C) / 2.0, B), 0.0))

    @cached_property
    def forms(self) -> tuple[Floats, Floats, Floats]:
        """A, B, C, (S, T) each."""
        count = self.stress.shape[2]
        even, odd = (self.stress * part[:, None] for part in (EVEN, ODD))
        G, H = (np.einsum("sik,ij,sjl->skl", x, VON_MISES, x, optimize=True) for x in (even, odd))
        G, H = (x.reshape(len(x), count * count) for x in (G, H))
        a, b = self.first, self.second
        aa, ab, bb = (
            (x[:, :, None] * y[:, None, :]).reshape(-1, count * count).T
            for x, y in ((a, a), (a, b), (b, b))
        )
        return G @ aa + H @ bb, G @ ab - H @ ab, G @ bb + H @ aa

    @cached_property
    def _metric(self) -> tuple[Floats, Floats]:
        """Even and odd parts of unit stresses (S, 5, K): squares sum to von Mises squared."""
        even, odd = (ROOT @ (self.stress * part[:, None]) for part in (EVEN, ODD))
        return even, odd

    def measured(self, points: Ints, angle: float) -> Floats:
        """At points (J,) and an angle five numbers (J, 5, T) whose squares sum to von Mises
        squared, and which add up over the waves.
        """
        even, odd = (x[points].reshape(-1, x.shape[2]) for x in self._metric)
        c, s = np.cos(self.n * angle), np.sin(self.n * angle)
        found = even @ (c * self.first + s * self.second).T
        found += odd @ (s * self.first - c * self.second).T
        return np.asarray(found.reshape(len(points), 5, -1))

    def parts(self, points: Ints, instants: Ints) -> tuple[Floats, Floats]:
        """P and Q, (J, 6) each, at pairs of points and instants (J,)."""
        s = self.stress[points]
        a = np.einsum("jik,jk->ji", s, self.first[instants])
        b = np.einsum("jik,jk->ji", s, self.second[instants])
        return EVEN * a - ODD * b, EVEN * b + ODD * a


class Circumference:
    """A case on the section's points."""

    def __init__(self, fields: MeridianFields, loads: PinLoads) -> None:
        acting = loads.coefficients()
        missing = set(acting) - set(fields.loads)
        if missing:
            raise ValueError(f"case {loads.case}: no unit fields for {sorted(missing)}")
        self.count = len(loads)
        self.points = len(fields.points)
        self.waves = []
        for n in sorted({load.n for load in acting}):
            here = [load for load in acting if load.n == n]
            stress = fields.stress[:, :, [fields.loads.index(load) for load in here]]
            by_phase = np.stack([acting[load] for load in here], axis=1)  # (T, K, 2)
            self.waves.append(Wave(n, stress, by_phase[..., 0], by_phase[..., 1]))

    @cached_property
    def bound(self) -> Floats:
        """At least the largest von Mises stress round the axis, (S, T) Pa; exactly it where only
        one harmonic acts.
        """
        if not self.waves:
            return np.zeros((self.points, self.count))
        return np.asarray(sum(wave.bound for wave in self.waves))

    def largest(self, among: Mask) -> tuple[Floats, Ints, Floats]:
        """Over the points of a mask (S,), at every instant: maximum (T,) Pa, point, angle."""
        rows = np.flatnonzero(among)
        bound = self.bound[rows]
        every = np.arange(self.count)
        if len(self.waves) < 2:
            at = bound.argmax(axis=0)
            _, angle = self.round(rows[at], every)
            return bound[at, every], rows[at], angle
        first = np.argpartition(-bound, min(FIRST, len(rows) - 1), axis=0)[:FIRST]
        i, t = first.ravel(), np.tile(every, len(first))
        value, angle = self.round(rows[i], t)
        best = np.zeros(self.count)
        np.maximum.at(best, t, value)
        more = np.argwhere(bound > best)
        value_more, angle_more = self.round(rows[more[:, 0]], more[:, 1])
        value, angle = np.concatenate([value, value_more]), np.concatenate([angle, angle_more])
        i, t = np.concatenate([i, more[:, 0]]), np.concatenate([t, more[:, 1]])
        order = np.lexsort((-value, t))
        top = order[np.searchsorted(t[order], every)]
        return value[top], rows[i[top]], angle[top]

    def top(self, among: Mask) -> Top:
        """Over the points of a mask (S,) and all instants.

        Pairs of points and instants are sampled in the order of their bounds until the next bound
        is below what was found.
        """
        rows = np.flatnonzero(among)
        bound = self.bound[rows].ravel()
        best = Top(0.0, int(rows[0]) if len(rows) else 0, 0, 0.0)
        batch = 1 if len(self.waves) < 2 else FIRST
        while len(bound):
            pairs = np.argpartition(-bound, min(batch, len(bound) - 1))[:batch]
            row, instant = np.divmod(pairs, self.count)
            value, angle = self.round(rows[row], instant)
            k = int(value.argmax())
            if value[k] > best.value:
                best = Top(float(value[k]), int(rows[row[k]]), int(instant[k]), float(angle[k]))
            bound[pairs] = -1.0
            if len(self.waves) < 2 or bound.max() <= best.value:
                break
            batch *= 4
        return best

    def round(self, points: Ints, instants: Ints) -> tuple[Floats, Floats]:
        """Largest von Mises stress (J,) Pa round the axis at pairs of points and instants, and the
        angle (rad) where it is.
        """
        found = [
            self._polished(points[k : k + CHUNK], instants[k : k + CHUNK])
            for k in range(0, len(points), CHUNK)
        ]
        if not found:
            return np.zeros(0), np.zeros(0)
        return np.concatenate([v for v, _ in found]), np.concatenate([a for _, a in found])

    def _polished(self, points: Ints, instants: Ints) -> tuple[Floats, Floats]:
        parts = [(wave.n, *wave.parts(points, instants)) for wave in self.waves]
        if not parts:
            return np.zeros(len(points)), np.zeros(len(points))
        if len(parts) == 1:
            return _closed(*parts[0])

        def at(angles: Floats) -> Floats:
            return von_mises(np.asarray(sum(_wave(n, P, Q, angles) for n, P, Q in parts)))

        degree = 2 * parts[-1][0]  # of von Mises squared
        count = max(SAMPLES, SAMPLES_PER_WAVE * degree)
        even = np.tile(np.arange(count) * 2.0 * np.pi / count, (len(points), 1))
        angle = highest_crest(at(even) ** 2, degree)
        return at(angle[:, None])[:, 0], angle

    def squares(self, points: Ints, angle: float) -> Floats:
        """Von Mises squared (J, T) at points (J,) at an angle (rad) and every instant, Pa^2."""
        if len(self.waves) == 1:
            A, B, C = (form[points] for form in self.waves[0].forms)
            c, s = np.cos(self.waves[0].n * angle), np.sin(self.waves[0].n * angle)
            return np.asarray(c * c * A + 2.0 * c * s * B + s * s * C)
        found = np.zeros((len(points), 5, self.count))
        for wave in self.waves:
            found += wave.measured(points, angle)
        return np.asarray(np.square(found).sum(axis=1))

    def stress(self, points: Ints, instants: Ints, angle: Floats) -> Floats:
        """Stress (J, 6) in Pa at pairs of points and instants and angles (J,): rr, tt, zz, tz, rz,
        rt.
        """
        out = np.zeros((len(points), 6))
        for wave in self.waves:
            out += _wave(wave.n, *wave.parts(points, instants), angle[:, None])[:, 0]
        return out


def _wave(n: int, P: Floats, Q: Floats, angles: Floats) -> Floats:
    """(J, A, 6) at angles (J, A)."""
    c, s = np.cos(n * angles), np.sin(n * angles)
    return np.asarray(c[..., None] * P[:, None] + s[..., None] * Q[:, None])


def _closed(n: int, P: Floats, Q: Floats) -> tuple[Floats, Floats]:
    if n == 0:
        return von_mises(P), np.zeros(len(P))
    A, B, C = (np.einsum("ji,ik,jk->j", x, VON_MISES, y) for x, y in ((P, P), (P, Q), (Q, Q)))
    largest = (A + C) / 2.0 + np.hypot((A - C) / 2.0, B)
    return np.sqrt(np.maximum(largest, 0.0)), 0.5 * np.arctan2(2.0 * B, A - C) / n

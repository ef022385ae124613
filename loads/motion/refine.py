"""Quantities between the samples of a motion, by polynomials on a sufficient number of instants.

The time is cut at its corners (where something may jump) into spans and these into panels of nine
equidistant instants. A panel's polynomial must predict the eight instants halfway between, and the
samples inside, to the tolerance; else the panel is halved. Once it does, its two halves, of nine
instants each, are 2^9 times as accurate as that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from pinbase.arrays import Floats

PANEL_DEGREE = 8
INTERPOLATION_TOLERANCE = 1e-6  # of the largest magnitude of a quantity, or of those in its group
MIN_PANELS = 16  # at least, of all the time before any is halved
# Of a span: so far inside its corners it is evaluated, to see one side of a jump only.
CORNER_INSET = 1e-6
# Of the whole time: corners this close are one; of a maximum: so is an end's value.
CORNER_MERGE_TOLERANCE = 1e-9
MAXIMUM_TOLERANCE = 1e-12  # of a maximum: what is no larger than by this is not larger
MAX_PANEL_HALVINGS = 24  # halvings of a panel
# Of the largest of all quantities: one below it need not be resolved as finely.
MIN_RESOLVED_SHARE = 1e-6
# Points in which a largest value is looked for, in a panel, then between two of those.
SEARCH_POINTS = 33

At = Callable[[Floats], Floats]

_PANEL_NODES = np.linspace(-1.0, 1.0, PANEL_DEGREE + 1)
_CHEBYSHEV_FIT = np.linalg.inv(np.polynomial.chebyshev.chebvander(_PANEL_NODES, PANEL_DEGREE))


def _weights(x: Floats) -> Floats:
    """(N, nodes) of the values at the nodes in the polynomial at x (N,) of [-1, 1]."""
    return np.asarray(np.polynomial.chebyshev.chebvander(x, PANEL_DEGREE) @ _CHEBYSHEV_FIT)


@dataclass(frozen=True)
class _Panels:
    """P panels: the first and the last of their instants (P,), and values (P, nodes, K) there.
    rough: (P,) whether the polynomial overshoots, so that nodes alone say how large values are.
    """

    low: Floats
    high: Floats
    values: Floats
    rough: np.ndarray

    @staticmethod
    def times(low: Floats, high: Floats, x: Floats) -> Floats:
        """(P, N) of x (N,) of [-1, 1]."""
        return np.asarray(0.5 * ((high + low)[:, None] + (high - low)[:, None] * x))

    def __getitem__(self, chosen: np.ndarray) -> _Panels:
        parts = (self.low, self.high, self.values, self.rough)
        return _Panels(*(part[chosen] for part in parts))

    def at(self, which: np.ndarray, times: Floats) -> Floats:
        """Values (T, K) of the polynomials of panels `which` (T,) at times (T,)."""
        low, high = self.low[which], self.high[which]
        weights = _weights((2.0 * times - low - high) / (high - low))
        found = np.empty((len(times), self.values.shape[2]))
        order = np.argsort(which, kind="stable")
        cuts = np.flatnonzero(np.diff(which[order])) + 1
        for here in np.split(order, cuts) if len(order) else ():
            nodes, rough = self.values[which[here[0]]], self.rough[which[here[0]]]
            values = weights[here] @ nodes
            found[here] = np.clip(values, nodes.min(axis=0), nodes.max(axis=0)) if rough else values
        return found

    def halves(self, between: Floats) -> _Panels:
        """Twice as many, from the values (P, nodes - 1, K) halfway between the nodes."""
        count, nodes, quantities = self.values.shape
        both = np.empty((count, 2 * nodes - 1, quantities))
        both[:, ::2], both[:, 1::2] = self.values, between
        middle = 0.5 * (self.low + self.high)
        return _Panels(
            np.stack([self.low, middle], axis=1).ravel(),
            np.stack([middle, self.high], axis=1).ravel(),
            np.stack([both[:, :nodes], both[:, nodes - 1 :]], axis=1).reshape(
                -1, nodes, quantities
            ),
            np.repeat(self.rough, 2),
        )


@dataclass(frozen=True)
class Resolved:
    """K quantities over a time: polynomials between instants, which include the samples.

    times: (N,) s, rising. values: (N, K). unresolved: (J, 2) s, where the polynomials are not as
    accurate as requested. ends: (P + 1,) s, between which each panel's polynomial holds; at a
    corner it is the limit from its own side.
    """

    times: Floats
    values: Floats
    unresolved: Floats
    ends: Floats
    panels: _Panels

    @property
    def nodes(self) -> Floats:
        """(N,) s, rising: the instants of all panels, between which little happens."""
        return np.unique(_Panels.times(self.panels.low, self.panels.high, _PANEL_NODES))

    def quantities(self, chosen: slice) -> Resolved:
        """Some of the quantities."""
        panels = replace(self.panels, values=self.panels.values[:, :, chosen])
        return replace(self, values=self.values[:, chosen], panels=panels)

    def interpolate(self, times: Floats) -> Floats:
        """(T, K) at times (T,) s; at a corner from the side before."""
        which = np.searchsorted(self.ends, times, side="left") - 1
        return self.panels.at(np.clip(which, 0, len(self.panels.low) - 1), times)

    def mean(self, of: Callable[[Floats], Floats] = lambda values: values) -> Floats:
        """(M,) mean over the time of what `of` makes (T, M) of values (T, K)."""
        last = self.ends[-1:]
        return np.asarray(self.integral(last, of)[0] / (last - self.ends[0]))

    def integral(self, times: Floats, of: Callable[[Floats], Floats]) -> Floats:
        """(T, M) from the first time to `times` (T,) s, of what `of` makes (N, M) of values."""
        x, weight = np.polynomial.legendre.leggauss(2 * PANEL_DEGREE)

        def between(panel: np.ndarray, low: Floats, high: Floats) -> Floats:
            at = _Panels.times(low, high, x)
            found = of(self.panels.at(np.repeat(panel, len(x)), at.ravel()))
            parts = found.reshape(len(panel), len(x), -1) * weight[:, None]
            return np.asarray(0.5 * (high - low)[:, None] * parts.sum(axis=1))

        whole = np.cumsum(
            between(np.arange(len(self.ends) - 1), self.ends[:-1], self.ends[1:]), axis=0
        )
        k = np.clip(np.searchsorted(self.ends, times) - 1, 0, len(self.ends) - 2)
        before = np.concatenate([np.zeros_like(whole[:1]), whole])[k]
        return np.asarray(before + between(k, self.ends[k], times))

    def largest(self, of: Callable[[Floats], Floats] = np.abs) -> tuple[Floats, Floats]:
        """The largest of what `of` makes (T, M) of values (T, K), and its times, (M,) each; of
        equally large ones that at an end.
        """
        low, high = self.ends[:-1], self.ends[1:]
        x = np.linspace(-1.0, 1.0, SEARCH_POINTS)
        times = _Panels.times(low, high, x)
        found = of(self._inside(times))
        top = found.argmax(axis=0)
        best, when = found[top, np.arange(len(top))], times.ravel()[top]
        panel, point = np.divmod(top, SEARCH_POINTS)
        beyond = (point == SEARCH_POINTS - 1).astype(int) - (
            point == 0
        )  # at an end: it may be past that
        for each in (panel, np.clip(panel + beyond, 0, len(low) - 1)):
            best, when = self._near(of, best, when, each)
        for k in (-1, 0):
            same = found[k] >= best - CORNER_MERGE_TOLERANCE * np.abs(best)
            best, when = np.where(same, found[k], best), np.where(same, self.ends[k], when)
        return best, when

    def _near(
        self, of: Callable[[Floats], Floats], best: Floats, when: Floats, panel: np.ndarray
    ) -> tuple[Floats, Floats]:
        """The largest values (M,) and their times near those known, each in a panel (M,)."""
        low, high = self.ends[:-1][panel], self.ends[1:][panel]
        x, rows = np.linspace(-1.0, 1.0, SEARCH_POINTS), np.arange(len(panel))
        at, width = np.clip(when, low, high), (high - low) / (SEARCH_POINTS - 1)
        while np.any(width > 1e-9 * (self.ends[-1] - self.ends[0])):
            here = _Panels.times(np.maximum(at - width, low), np.minimum(at + width, high), x)
            near = of(self.panels.at(np.repeat(panel, SEARCH_POINTS), here.ravel()))
            near = near.reshape(len(panel), SEARCH_POINTS, -1)[rows, :, rows]
            k = near.argmax(axis=1)
            better = near[rows, k] > best + MAXIMUM_TOLERANCE * np.abs(best)
            best = np.where(better, near[rows, k], best)
            at, when = (np.where(better, here[rows, k], t) for t in (at, when))
            width = width / (0.25 * (SEARCH_POINTS - 1))
        return best, when

    def _inside(self, times: Floats) -> Floats:
        """Values (P N, K) at times (P, N) of each panel's own polynomial."""
        return self.panels.at(np.repeat(np.arange(len(times)), times.shape[1]), times.ravel())


def resolved(
    times: Floats,
    at: At,
    corners: Floats | tuple[float, ...] = (),
    most: int = 4096,
    groups: Sequence[int] | None = None,
    known: Floats | None = None,
) -> Resolved:
    """Quantities at `times` (T,) s, increasing, and at as many instants in between as necessary.

    at: values (T, K) at times (T,) in any order. corners: where values or their derivatives may
    jump, s. groups: (K,) numbers of those whose tolerance is a part of the largest magnitude of
    all in the group, by default each quantity is alone. most: evaluations after the first round;
    what they do not resolve is in `unresolved`. known: values (T, K) at `times`, if they are.
    """
    ends = _spans(times, corners)
    low, high = _first(ends)
    samples, values = times, at(times) if known is None else known
    first = _Panels.times(low, high, _PANEL_NODES).ravel()
    solved = [(samples, values), (first, at(first))]
    large = np.zeros(values.shape[1])
    for _, found in solved:
        large = np.maximum(large, np.abs(found).max(axis=0, initial=0.0))
    active = _Panels(
        low,
        high,
        solved[1][1].reshape(len(low), PANEL_DEGREE + 1, -1),
        np.zeros(len(low), dtype=bool),
    )
    done, left = list[_Panels](), list[_Panels]()
    middle = 0.5 * (_PANEL_NODES[1:] + _PANEL_NODES[:-1])
    halfway, used = _weights(middle), 0
    for depth in range(MAX_PANEL_HALVINGS + 1):
        between = _Panels.times(active.low, active.high, middle)
        if used and used + between.size > most:
            left.append(active)
            break
        fresh = at(between.ravel())
        used += between.size
        solved.append((between.ravel(), fresh))
        large = np.maximum(large, np.abs(fresh).max(axis=0, initial=0.0))
        scale = _scale(large, groups)
        fresh = fresh.reshape(len(between), PANEL_DEGREE, -1)
        off = _largest(np.abs(halfway @ active.values - fresh) / scale)
        np.maximum.at(off, *_off_at(active, samples, values, scale))
        good = off <= INTERPOLATION_TOLERANCE
        done.append(active[good].halves(fresh[good]))
        active = active[~good].halves(fresh[~good])
        if not len(active.low):
            break
        if depth == MAX_PANEL_HALVINGS:
            left.append(active)
    return _gathered(solved, done, left, ends)


def _spans(times: Floats, corners: Floats | tuple[float, ...]) -> Floats:
    """(S + 1,) ends of the spans: the first and the last time, and the corners between."""
    first, last = float(times[0]), float(times[-1])
    apart = CORNER_MERGE_TOLERANCE * (last - first)
    inside = [c for c in sorted(corners) if first + apart < c < last - apart]
    kept = [first]
    for c in inside:
        if c > kept[-1] + apart:
            kept.append(float(c))
    return np.array([*kept, last])


def _first(ends: Floats) -> tuple[Floats, Floats]:
    """Low and high ends of the first panels. They differ in width, so that equal steps in all of
    them are never the period of what repeats itself.
    """
    count = max(1, -(-MIN_PANELS // (len(ends) - 1)))
    width = 1.0 + 0.5 * np.mod(np.arange(count) * 0.6180339887, 1.0)
    parts = np.concatenate([[0.0], np.cumsum(width)]) / width.sum()
    inset = CORNER_INSET * np.diff(ends)
    first, last = ends[:-1] + inset, ends[1:] - inset
    cuts = first[:, None] + (last - first)[:, None] * parts
    return cuts[:, :-1].ravel(), cuts[:, 1:].ravel()


def _largest(off: Floats) -> Floats:
    """(P,) of (P, N, K); none where there are no quantities."""
    return np.asarray(off.max(axis=(1, 2), initial=0.0))


def _scale(large: Floats, groups: Sequence[int] | None) -> Floats:
    """(K,) what the tolerance is a part of, from the largest magnitudes (K,); one where everything
    is zero.
    """
    if groups is not None:
        of_group = np.zeros(max(groups, default=-1) + 1)
        np.maximum.at(of_group, list(groups), large)
        large = of_group[list(groups)]
    large = np.maximum(large, MIN_RESOLVED_SHARE * large.max(initial=0.0))
    return np.where(large > 0.0, large, 1.0)


def _off_at(
    panels: _Panels, times: Floats, values: Floats, scale: Floats
) -> tuple[np.ndarray, Floats]:
    """Panel and error of the polynomial, over the scale, at every sample inside a panel."""
    which = np.searchsorted(panels.low, times, side="right") - 1
    inside = (which >= 0) & (times < panels.high[which])
    which = which[inside]
    off = panels.at(which, times[inside])
    off -= values[inside]
    off /= scale
    return which, np.abs(off, out=off).max(axis=1, initial=0.0)


def _gathered(
    known: list[tuple[Floats, Floats]], done: list[_Panels], left: list[_Panels], ends: Floats
) -> Resolved:
    times, first = np.unique(np.concatenate([t for t, _ in known]), return_index=True)
    parts = done + [replace(p, rough=np.ones(len(p.low), dtype=bool)) for p in left]
    low, high, values, rough = (
        np.concatenate([getattr(p, field.name) for p in parts]) for field in fields(_Panels)
    )
    panels = _Panels(low, high, values, rough)[np.argsort(low, kind="stable")]
    cuts = np.concatenate([ends[:1], 0.5 * (panels.high[:-1] + panels.low[1:]), ends[-1:]])
    for end in ends[1:-1]:  # exactly at a corner, however its two sides were rounded
        cuts[np.abs(cuts - end).argmin()] = end
    unresolved = [np.stack([p.low, p.high], axis=1) for p in left]
    return Resolved(
        times=times,
        values=np.concatenate([v for _, v in known])[first],
        unresolved=_joined(np.concatenate(unresolved)) if left else np.empty((0, 2)),
        ends=cuts,
        panels=panels,
    )


def _joined(intervals: Floats) -> Floats:
    """Intervals (J, 2), rising, with those that touch made one."""
    intervals = intervals[np.argsort(intervals[:, 0], kind="stable")]
    starts = np.concatenate([[True], intervals[1:, 0] > intervals[:-1, 1]])
    return np.stack([intervals[starts, 0], intervals[np.append(starts[1:], True), 1]], axis=1)

"""Quantities between the samples of a motion, by piecewise polynomials, refined adaptively.

Time is divided at its corners (where something may jump) into spans, and each span into panels of
nine equidistant instants. The polynomial of a panel must predict the values at the eight instants
halfway between, and at the samples inside, to the tolerance; otherwise the panel is halved. For a
panel that passes, the result uses its two halves, of nine instants each, which are 2^9 times as
accurate.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from pinbase.arrays import Floats

PANEL_DEGREE = 8
# Relative to the largest magnitude of a quantity, or of all quantities of its group.
INTERPOLATION_TOLERANCE = 1e-6
MIN_PANELS = 16  # panels over the whole time before the first halving
SAMPLE_BLOCK = 8192  # samples whose errors are in memory together
# Relative to a span: its end instants lie this far inside its corners, on one side of any jump.
CORNER_INSET = 1e-6
# Relative to the whole time: corners this close are merged. Relative to a maximum: a value at the
# first or last time that is this close to the maximum is taken for the maximum.
CORNER_MERGE_TOLERANCE = 1e-9
MAXIMUM_TOLERANCE = 1e-12  # relative increase that counts as a larger maximum
MAX_PANEL_HALVINGS = 24
# Relative to the largest of all quantities: a smaller quantity has the tolerance of this size.
MIN_RESOLVED_SHARE = 1e-6
BISECTION_STEPS = 60  # enough for the last digit of a time
SEARCH_POINTS = 33  # points of a search for a maximum, over a panel, then around the best point

At = Callable[[Floats], Floats]

_PANEL_NODES = np.linspace(-1.0, 1.0, PANEL_DEGREE + 1)
_CHEBYSHEV_FIT = np.linalg.inv(np.polynomial.chebyshev.chebvander(_PANEL_NODES, PANEL_DEGREE))


def _weights(x: Floats) -> Floats:
    """Weights (N, nodes) of the nodal values in a panel's polynomial at x (N,) in [-1, 1]."""
    return np.asarray(np.polynomial.chebyshev.chebvander(x, PANEL_DEGREE) @ _CHEBYSHEV_FIT)


@dataclass(frozen=True)
class _Panels:
    """P panels with the values of K quantities.

    low, high: (P,) first and last instants of each panel, s.
    values: (P, nodes, K) values at equidistant instants.
    rough: (P,) whether the polynomial may overshoot, and is limited to the range of its nodes.
    """

    low: Floats
    high: Floats
    values: Floats
    rough: np.ndarray

    @staticmethod
    def times(low: Floats, high: Floats, x: Floats) -> Floats:
        """Times (P, N) s in panels from low to high (P,) s, at x (N,) in [-1, 1]."""
        return np.asarray(0.5 * ((high + low)[:, None] + (high - low)[:, None] * x))

    def __getitem__(self, chosen: np.ndarray) -> _Panels:
        arrays = (self.low, self.high, self.values, self.rough)
        return _Panels(*(array[chosen] for array in arrays))

    def at(self, which: np.ndarray, times: Floats) -> Floats:
        """Values (T, K) of the polynomials of panels `which` (T,) at times (T,) s."""
        low, high = self.low[which], self.high[which]
        weights = _weights((2.0 * times - low - high) / (high - low))
        out = np.empty((len(times), self.values.shape[2]))
        order = np.argsort(which, kind="stable")
        cuts = np.flatnonzero(np.diff(which[order])) + 1
        for rows in np.split(order, cuts) if len(order) else ():
            nodes, rough = self.values[which[rows[0]]], self.rough[which[rows[0]]]
            values = weights[rows] @ nodes
            out[rows] = np.clip(values, nodes.min(axis=0), nodes.max(axis=0)) if rough else values
        return out

    def halves(self, between: Floats) -> _Panels:
        """Both halves of all panels, from the values (P, nodes - 1, K) between the nodes."""
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
    """K quantities over a time, as piecewise polynomials.

    times, values: (N,) s, increasing, and (N, K): all instants evaluated, including the samples.
    unresolved: (J, 2) s, intervals in which the polynomials are less accurate than required.
    ends: (P + 1,) s, times between which each panel's polynomial holds; at a corner each of two
    panels has the limit from its side.
    """

    times: Floats
    values: Floats
    unresolved: Floats
    ends: Floats
    panels: _Panels

    @property
    def nodes(self) -> Floats:
        """Instants of all panels, (N,) s, increasing; the quantities change little in between."""
        return np.unique(_Panels.times(self.panels.low, self.panels.high, _PANEL_NODES))

    def quantities(self, chosen: slice) -> Resolved:
        """The result for the chosen quantities only."""
        panels = replace(self.panels, values=self.panels.values[:, :, chosen])
        return replace(self, values=self.values[:, chosen], panels=panels)

    def interpolate(self, times: Floats) -> Floats:
        """Values (T, K) at times (T,) s; at a corner, the values just before it."""
        which = np.searchsorted(self.ends, times, side="left") - 1
        return self.panels.at(np.clip(which, 0, len(self.panels.low) - 1), times)

    def crossings(self, column: int, level: float = 0.0) -> Floats:
        """Times (N,) s at which the quantity in a column passes a level, by bisection."""
        deviation = self.values[:, column] - level
        turns = np.flatnonzero(deviation[:-1] * deviation[1:] < 0.0)
        low, high, sign = self.times[turns], self.times[turns + 1], np.sign(deviation[turns])
        for _ in range(BISECTION_STEPS if len(turns) else 0):
            middle = 0.5 * (low + high)
            same = np.sign(self.interpolate(middle)[:, column] - level) == sign
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.asarray(0.5 * (low + high))

    def mean(self, of: Callable[[Floats], Floats] = lambda values: values) -> Floats:
        """Mean over time, (M,), of a function. of: from values (T, K) to (T, M)."""
        last = self.ends[-1:]
        return np.asarray(self.integral(last, of)[0] / (last - self.ends[0]))

    def integral(self, times: Floats, of: Callable[[Floats], Floats]) -> Floats:
        """Integral from the first time to `times` (T,) s, (T, M), by Gauss quadrature in panels.

        of: function to be integrated, from values (N, K) to (N, M).
        """
        x, weight = np.polynomial.legendre.leggauss(2 * PANEL_DEGREE)

        def between(panel: np.ndarray, low: Floats, high: Floats) -> Floats:
            at = _Panels.times(low, high, x)
            integrand = of(self.panels.at(np.repeat(panel, len(x)), at.ravel()))
            weighted = integrand.reshape(len(panel), len(x), -1) * weight[:, None]
            return np.asarray(0.5 * (high - low)[:, None] * weighted.sum(axis=1))

        whole = np.cumsum(
            between(np.arange(len(self.ends) - 1), self.ends[:-1], self.ends[1:]), axis=0
        )
        k = np.clip(np.searchsorted(self.ends, times) - 1, 0, len(self.ends) - 2)
        before = np.concatenate([np.zeros_like(whole[:1]), whole])[k]
        return np.asarray(before + between(k, self.ends[k], times))

    def largest(self, of: Callable[[Floats], Floats] = np.abs) -> tuple[Floats, Floats]:
        """Largest values over time and their times, (M,) each.

        Of equal values, one at the first or last time is preferred.
        of: function to be maximised, from values (T, K) to (T, M).
        """
        low, high = self.ends[:-1], self.ends[1:]
        x = np.linspace(-1.0, 1.0, SEARCH_POINTS)
        times = _Panels.times(low, high, x)
        values = of(self._inside(times))
        top = values.argmax(axis=0)
        best, when = values[top, np.arange(len(top))], times.ravel()[top]
        # Refine around the largest point; if it is at the end of a panel, also in the next panel.
        panel, point = np.divmod(top, SEARCH_POINTS)
        neighbour = (point == SEARCH_POINTS - 1).astype(int) - (point == 0)
        for searched in (panel, np.clip(panel + neighbour, 0, len(low) - 1)):
            best, when = self._near(of, best, when, searched)
        for k in (-1, 0):
            same = values[k] >= best - CORNER_MERGE_TOLERANCE * np.abs(best)
            best, when = np.where(same, values[k], best), np.where(same, self.ends[k], when)
        return best, when

    def _near(
        self, of: Callable[[Floats], Floats], best: Floats, when: Floats, panel: np.ndarray
    ) -> tuple[Floats, Floats]:
        """Largest values and their times, (M,) each, by refinement around known points.

        best, when: (M,) known values and their times, s. panel: (M,) panel of each search.
        """
        low, high = self.ends[:-1][panel], self.ends[1:][panel]
        x, rows = np.linspace(-1.0, 1.0, SEARCH_POINTS), np.arange(len(panel))
        at, width = np.clip(when, low, high), (high - low) / (SEARCH_POINTS - 1)
        while np.any(width > 1e-9 * (self.ends[-1] - self.ends[0])):
            times = _Panels.times(np.maximum(at - width, low), np.minimum(at + width, high), x)
            near = of(self.panels.at(np.repeat(panel, SEARCH_POINTS), times.ravel()))
            near = near.reshape(len(panel), SEARCH_POINTS, -1)[rows, :, rows]
            k = near.argmax(axis=1)
            better = near[rows, k] > best + MAXIMUM_TOLERANCE * np.abs(best)
            best = np.where(better, near[rows, k], best)
            at, when = (np.where(better, times[rows, k], t) for t in (at, when))
            width = width / (0.25 * (SEARCH_POINTS - 1))  # two intervals on either side
        return best, when

    def _inside(self, times: Floats) -> Floats:
        """Values (P N, K) at times (P, N) s, each row of times by the polynomial of its panel."""
        return self.panels.at(np.repeat(np.arange(len(times)), times.shape[1]), times.ravel())


def resolved(
    times: Floats,
    at: At,
    corners: Floats | tuple[float, ...] = (),
    max_evaluations: int = 4096,
    groups: Sequence[int] | None = None,
    known: Floats | None = None,
) -> Resolved:
    """K quantities at `times` (T,) s, increasing, and at as many instants between as necessary.

    at: function that returns the values (T, K) at times (T,) s, in any order.
    corners: times at which values or their derivatives may jump, s.
    max_evaluations: largest number of instants evaluated halfway between nodes, unless the first
    round alone takes more; intervals that then remain are `unresolved`.
    groups: (K,) number of each quantity's group. The tolerance is relative to the largest magnitude
    in the group; by default each quantity is a group of its own.
    known: (T, K) values at `times`, if already known.
    """
    ends = _spans(times, corners)
    low, high = _first_panels(ends)
    samples, values = times, at(times) if known is None else known
    first = _Panels.times(low, high, _PANEL_NODES).ravel()
    solved = [(samples, values), (first, at(first))]
    largest = np.zeros(values.shape[1])
    for _, known_values in solved:
        highest, lowest = (f(known_values, axis=0, initial=0.0) for f in (np.max, np.min))
        largest = np.maximum(largest, np.maximum(highest, -lowest))
    active = _Panels(
        low,
        high,
        solved[1][1].reshape(len(low), PANEL_DEGREE + 1, -1),
        np.zeros(len(low), dtype=bool),
    )
    done, unresolved = list[_Panels](), list[_Panels]()
    middle = 0.5 * (_PANEL_NODES[1:] + _PANEL_NODES[:-1])
    weights, used = _weights(middle), 0
    # In each round, evaluate all active panels halfway between their nodes. Panels whose polynomial
    # predicted the values are done; the others are halved.
    for depth in range(MAX_PANEL_HALVINGS + 1):
        between = _Panels.times(active.low, active.high, middle)
        if used and used + between.size > max_evaluations:
            unresolved.append(active)
            break
        new = at(between.ravel())
        used += between.size
        solved.append((between.ravel(), new))
        largest = np.maximum(largest, np.abs(new).max(axis=0, initial=0.0))
        scale = _scale(largest, groups)
        new = new.reshape(len(between), PANEL_DEGREE, -1)
        error = _largest(np.abs(weights @ active.values - new) / scale)
        np.maximum.at(error, *_sample_errors(active, samples, values, scale))
        good = error <= INTERPOLATION_TOLERANCE
        done.append(active[good].halves(new[good]))
        active = active[~good].halves(new[~good])
        if not len(active.low):
            break
        if depth == MAX_PANEL_HALVINGS:
            unresolved.append(active)
    return _gathered(solved, done, unresolved, ends)


def _spans(times: Floats, corners: Floats | tuple[float, ...]) -> Floats:
    """Ends of the spans, (S + 1,) s: the first and the last time, and the corners between."""
    first, last = float(times[0]), float(times[-1])
    min_distance = CORNER_MERGE_TOLERANCE * (last - first)
    inside = [c for c in sorted(corners) if first + min_distance < c < last - min_distance]
    ends = [first]
    for c in inside:
        if c > ends[-1] + min_distance:
            ends.append(float(c))
    return np.array([*ends, last])


def _first_panels(ends: Floats) -> tuple[Floats, Floats]:
    """Low and high ends of the first panels, (P,) s each.

    Panels differ in width. Otherwise their instants could coincide with the period of a periodic
    quantity, which would look constant.
    """
    count = max(1, -(-MIN_PANELS // (len(ends) - 1)))
    width = 1.0 + 0.5 * np.mod(np.arange(count) * 0.6180339887, 1.0)
    fractions = np.concatenate([[0.0], np.cumsum(width)]) / width.sum()
    inset = CORNER_INSET * np.diff(ends)
    first, last = ends[:-1] + inset, ends[1:] - inset
    cuts = first[:, None] + (last - first)[:, None] * fractions
    return cuts[:, :-1].ravel(), cuts[:, 1:].ravel()


def _largest(errors: Floats) -> Floats:
    """Largest error of each panel, (P,), from (P, N, K); zero without quantities."""
    return np.asarray(errors.max(axis=(1, 2), initial=0.0))


def _scale(largest: Floats, groups: Sequence[int] | None) -> Floats:
    """Magnitudes (K,) to which the tolerance is relative; 1 where everything is zero.

    largest: (K,) largest magnitude of each quantity.
    """
    if groups is not None:
        group_largest = np.zeros(max(groups, default=-1) + 1)
        np.maximum.at(group_largest, list(groups), largest)
        largest = group_largest[list(groups)]
    largest = np.maximum(largest, MIN_RESOLVED_SHARE * largest.max(initial=0.0))
    return np.where(largest > 0.0, largest, 1.0)


def _sample_errors(
    panels: _Panels, times: Floats, values: Floats, scale: Floats
) -> tuple[np.ndarray, Floats]:
    """The panel of every sample inside a panel, and its polynomial's error over the scale there."""
    which = np.searchsorted(panels.low, times, side="right") - 1
    inside = (which >= 0) & (times < panels.high[which])
    which, rows = which[inside], np.flatnonzero(inside)
    out = np.empty(len(rows))
    for k in range(0, len(rows), SAMPLE_BLOCK):
        part = slice(k, k + SAMPLE_BLOCK)
        error = panels.at(which[part], times[rows[part]])
        error -= values[rows[part]]
        error /= scale
        out[part] = np.abs(error, out=error).max(axis=1, initial=0.0)
    return which, out


def _gathered(
    known: list[tuple[Floats, Floats]], done: list[_Panels], unresolved: list[_Panels], ends: Floats
) -> Resolved:
    """The result of the refinement.

    known: times and values of all evaluations. done: resolved panels.
    unresolved: panels that are not resolved and become `rough`. ends: ends of the spans, s.
    """
    times, first = np.unique(np.concatenate([t for t, _ in known]), return_index=True)
    parts = done + [replace(p, rough=np.ones(len(p.low), dtype=bool)) for p in unresolved]
    low, high, values, rough = (
        np.concatenate([getattr(p, field.name) for p in parts]) for field in fields(_Panels)
    )
    panels = _Panels(low, high, values, rough)[np.argsort(low, kind="stable")]
    cuts = np.concatenate([ends[:1], 0.5 * (panels.high[:-1] + panels.low[1:]), ends[-1:]])
    for end in ends[1:-1]:  # put the cut exactly at the corner, in spite of round-off
        cuts[np.abs(cuts - end).argmin()] = end
    intervals = [np.stack([p.low, p.high], axis=1) for p in unresolved]
    return Resolved(
        times=times,
        values=np.concatenate([v for _, v in known])[first],
        unresolved=_joined(np.concatenate(intervals)) if unresolved else np.empty((0, 2)),
        ends=cuts,
        panels=panels,
    )


def _joined(intervals: Floats) -> Floats:
    """Increasing intervals (J, 2), in which intervals that touch are joined."""
    intervals = intervals[np.argsort(intervals[:, 0], kind="stable")]
    starts = np.concatenate([[True], intervals[1:, 0] > intervals[:-1, 1]])
    return np.stack([intervals[starts, 0], intervals[np.append(starts[1:], True), 1]], axis=1)

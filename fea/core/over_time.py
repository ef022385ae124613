"""The largest stress over a motion, including the times between the given instants.

Stress is linear in the amounts of unit loads, and the von Mises stress is a norm. Between two
instants it therefore exceeds the larger of the two values by no more than the von Mises stress of
the deviation of the amounts from their chord. Unit fields give this bound for all intervals at
once. Instants are added where the stress may exceed the maximum, until the possible excess is
small; then around the governing instant, until the maximum no longer rises.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fea.core.pin_loads import LoadAmounts, PinLoads, chord_deviation
from fea.core.solution import StressMaxima
from geometry.shape.chords import needed
from pinbase.arrays import Floats, Ints

Between = Callable[[Floats], PinLoads]  # a motion's loads at any times (T,) s

# Chosen by judgement; `python -m benchmarks instants` shows the error of evenly spaced instants.
TIME_ERROR_SHARE = 0.05  # fraction of the tolerance that the error between instants may use
MAX_INSTANTS = 4096  # of a case, after which no more are added
# Largest deviation from a chord over that at its middle: 1 for a parabola, more for skewed curves.
CHORD_FACTOR = 1.25
MIN_INTERVAL = 1e-5  # of the whole time: a shorter interval contains a jump or nothing
CREST_POINTS = 9  # samples in the interval about the maximum, which shrinks to a quarter each time
CREST_TOLERANCE = 1e-12  # relative gain that does not count, since a crest is flat
CREST_REPEATS = 2  # passes without gain after which the search ends


def rise_between(answer: StressMaxima, loads: PinLoads, between: Between) -> float:
    """The possible rise of the maximum between instants above that at the instants, Pa."""
    if len(loads) < 2:
        return 0.0
    largest = answer.largest(loads)[0]
    reached = _reached(answer, loads, _chord_deviation(loads, between), largest)[1]
    return max(0.0, float(reached.max(initial=0.0)) - largest)


def _reached(
    answer: StressMaxima, loads: PinLoads, deviation: LoadAmounts, largest: float
) -> tuple[Ints, Floats]:
    """The numbers (I,) of the intervals in which the stress may exceed `largest`, and the stress
    (I,), Pa, that they may reach.

    deviation: of the loads from their chords, in each interval.
    largest: largest stress at the instants, Pa.
    """
    # A first bound, the same for all intervals, rules out most of them without a search in each.
    rise = CHORD_FACTOR * answer.largest(deviation)[0]
    at = answer.maxima(loads, max(0.0, largest - rise))
    ends = np.maximum(at[1:], at[:-1])
    near = np.flatnonzero(ends + rise > largest)
    if not len(near):  # as for loads that do not deviate from their chords
        return near, np.zeros(0)
    return near, ends[near] + CHORD_FACTOR * answer.maxima(deviation.at(near))


def _chord_deviation(loads: PinLoads, between: Between) -> LoadAmounts:
    """The deviation of the loads in the middle of each interval from their chord.

    Where loads jump (friction that reverses), the interval is short and its loads count as on the
    chord.
    """
    times = _times(loads)
    middle = between(0.5 * (times[1:] + times[:-1]))
    long = np.diff(times) > MIN_INTERVAL * np.ptp(times)
    deviation = chord_deviation(loads, middle)
    acting = {unit: both * long[:, None] for unit, both in deviation.acting.items()}
    return replace(deviation, acting=acting)


def through_time(
    answer: StressMaxima, loads: PinLoads, between: Between, tolerance: float
) -> PinLoads:
    """The loads with instants added until the rise of the maximum between instants is small.

    tolerance: relative, of the maximum; the rise may be up to TIME_ERROR_SHARE of it.
    """
    while len(loads) < MAX_INSTANTS:
        largest = answer.largest(loads)[0]
        near, reached = _reached(answer, loads, _chord_deviation(loads, between), largest)
        worst = near[reached > (1.0 + TIME_ERROR_SHARE * tolerance) * largest]
        if not len(worst):
            break
        times = _times(loads)
        loads = loads.merged(between(0.5 * (times[worst] + times[worst + 1])))
    return with_crest(answer, loads, between)


def over_time(
    answer: StressMaxima, loads: PinLoads, between: Between | None, tolerance: float
) -> tuple[PinLoads, float]:
    """Return the loads with all instants that matter, and the possible rise of the maximum between
    these, Pa.

    Without a motion the loads are returned as they are.
    """
    if between is None or len(loads) < 2:
        return loads, 0.0
    loads = through_time(answer, loads, between, tolerance)
    return loads, rise_between(answer, loads, between)


def changed(change: Callable[[PinLoads], PinLoads], between: Between, times: Floats) -> PinLoads:
    """The loads of a motion at times (T,) s, with a change applied to them."""
    return change(between(times))


def with_crest(answer: StressMaxima, loads: PinLoads, between: Between) -> PinLoads:
    """The loads with the instant of the maximum added if it lies between the given instants."""
    times = _times(loads)
    value, k = answer.largest(loads)
    low, high = times[max(k - 1, 0)], times[min(k + 1, len(times) - 1)]
    best, passes_without_gain = loads.at(np.array([k])), 0
    # Sample the interval about the maximum and shrink it to the neighbours of the best sample.
    while passes_without_gain < CREST_REPEATS:
        near = np.linspace(low, high, CREST_POINTS)
        here = between(near)
        top, i = answer.largest(here)
        passes_without_gain += top <= value * (1.0 + CREST_TOLERANCE)
        if top > value:
            value, best = top, here.at(np.array([i]))
        low, high = near[max(i - 1, 0)], near[min(i + 1, CREST_POINTS - 1)]
    return loads.merged(best)


def knots(loads: PinLoads, tolerance: float, min_intervals: int) -> Ints:
    """The numbers of the instants between which the loads at all other instants lie near the chord.

    tolerance: largest deviation from the chord, relative to the largest load.
    min_intervals: least number of intervals.
    """
    times, count = _times(loads), len(loads)
    vectors = [
        x.reshape(count, -1) / (np.abs(x).max(initial=0.0) or 1.0)
        for x in (loads.forces, loads.moments, loads.body)
    ]
    values = np.concatenate(vectors, axis=1)
    knot = np.zeros(count, dtype=bool)
    knot[np.linspace(0, count - 1, min(count, min_intervals + 1)).round().astype(np.int64)] = True
    return np.flatnonzero(needed(times, values, np.full_like(values, tolerance), knot))


def _times(loads: PinLoads) -> Floats:
    assert loads.times is not None
    return loads.times

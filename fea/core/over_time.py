"""The largest stress over a motion, not only over the instants at which its loads are known.

Stress is linear in the amounts of unit loads and von Mises stress is a norm. So between two
instants it exceeds the larger of both by no more than the von Mises stress of what the amounts
differ from their chord there: a bound that unit fields give at once for all intervals. Instants are
added where it may exceed the maximum, until it does so by little; about the one that governs, until
the maximum stands.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fea.core.pin_loads import LoadAmounts, PinLoads, chord_deviation
from fea.core.solution import StressField
from geometry.shape.chords import needed
from pinbase.arrays import Floats, Ints

Between = Callable[[Floats], PinLoads]  # a motion's loads at any times (T,) s

TIME_ERROR_SHARE = 0.05  # of the tolerance: what the time may add to the error
MAX_INSTANTS = 4096  # instants
CHORD_FACTOR = 1.25  # what differs from a chord most, over that in the middle of it
MIN_INTERVAL = 1e-5  # of the whole time: in a shorter interval there is a jump or nothing
CREST_POINTS = 9  # in the interval about the maximum, which becomes a quarter each time
CREST_TOLERANCE = 1e-12  # relative: so little more is nothing, a crest being flat
CREST_REPEATS = 2  # times that nothing was gained


def rise_between(answer: StressField, loads: PinLoads, between: Between) -> float:
    """By how much the maximum between instants may exceed that at instants, Pa."""
    if len(loads) < 2:
        return 0.0
    largest = answer.largest(loads)[0]
    reached = _reached(answer, loads, _chord_deviation(loads, between), largest)[1]
    return max(0.0, float(reached.max(initial=0.0)) - largest)


def _reached(
    answer: StressField, loads: PinLoads, off: LoadAmounts, largest: float
) -> tuple[Ints, Floats]:
    """Intervals in which the largest at instants, Pa, may be exceeded, and what they may reach."""
    rise = CHORD_FACTOR * answer.largest(off)[0]
    at = answer.maxima(loads, max(0.0, largest - rise))
    ends = np.maximum(at[1:], at[:-1])
    near = np.flatnonzero(ends + rise > largest)
    return near, ends[near] + CHORD_FACTOR * answer.maxima(off.at(near))


def _chord_deviation(loads: PinLoads, between: Between) -> LoadAmounts:
    """What the loads amid each two instants differ from their chord. Where they jump (friction that
    reverses), what lies between is on the chord.
    """
    times = _times(loads)
    middle = between(0.5 * (times[1:] + times[:-1]))
    long = np.diff(times) > MIN_INTERVAL * np.ptp(times)
    off = chord_deviation(loads, middle)
    return replace(off, acting={u: both * long[:, None] for u, both in off.acting.items()})


def through_time(
    answer: StressField, loads: PinLoads, between: Between, tolerance: float
) -> PinLoads:
    """The loads with more instants, so many that what is between them exceeds the maximum by little
    compared with a `tolerance`, relative; the governing one among them.
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


def with_crest(answer: StressField, loads: PinLoads, between: Between) -> PinLoads:
    """The loads with the instant at which the maximum is, if it is higher there."""
    times = _times(loads)
    value, k = answer.largest(loads)
    low, high = times[max(k - 1, 0)], times[min(k + 1, len(times) - 1)]
    best, stands = loads.at(np.array([k])), 0
    while stands < CREST_REPEATS:
        near = np.linspace(low, high, CREST_POINTS)
        here = between(near)
        top, i = answer.largest(here)
        stands += top <= value * (1.0 + CREST_TOLERANCE)
        if top > value:
            value, best = top, here.at(np.array([i]))
        low, high = near[max(i - 1, 0)], near[min(i + 1, CREST_POINTS - 1)]
    return loads.merged(best)


def knots(loads: PinLoads, straight: float, fewest: int) -> Ints:
    """Instants, by their numbers, between which loads at the others are off their chord by at most
    so much of the largest one; so many intervals at least.
    """
    times, count = _times(loads), len(loads)
    vectors = [
        x.reshape(count, -1) / (np.abs(x).max(initial=0.0) or 1.0)
        for x in (loads.forces, loads.moments, loads.body)
    ]
    values = np.concatenate(vectors, axis=1)
    kept = np.zeros(count, dtype=bool)
    kept[np.linspace(0, count - 1, min(count, fewest + 1)).round().astype(np.int64)] = True
    return np.flatnonzero(needed(times, values, np.full_like(values, straight), kept))


def _times(loads: PinLoads) -> Floats:
    assert loads.times is not None
    return loads.times

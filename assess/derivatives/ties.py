"""Other places and times at which stress is as large as the maximum, as far as is known."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from assess.derivatives.records import SolvedCase
from fea.core.pin_loads import PinLoads
from fea.core.solution import StressField
from fea.core.zone import Zone
from fea.harmonic.evaluate import HarmonicField, high_places
from fea.harmonic.superposition import Circumference, Crest


def competing_places(
    around: Circumference,
    zones: Iterable[Zone],
    top: Crest,
    error: float,
) -> tuple[tuple[float, float], ...]:
    """(r, z), m, at the governing instant, well apart; error: of the maximum, relative."""
    fields = around.fields
    return high_places(around, fields.points, fields.outside(zones), top, 1.0 - error)[1:]


def competing_times(solved: SolvedCase, maximum: float) -> tuple[float, ...]:
    """Of crests in time other than the governing one, s, each at its highest."""
    return crests(HarmonicField(solved.solution, solved.zones), solved, maximum)


def crests(
    answer: StressField,
    solved: SolvedCase,
    maximum: float,
    felt: Callable[[PinLoads], PinLoads] = lambda loads: loads,
) -> tuple[float, ...]:
    """The same of any answer; felt: what it notices of loads."""
    every, times = solved.history, solved.loads.times
    if every is None or every.times is None or times is None:
        return ()
    least, now, at = (1.0 - solved.error) * maximum, float(times[0]), every.times
    maxima = answer.maxima(felt(every), least)
    high = np.flatnonzero(maxima > least)
    runs = np.split(high, np.flatnonzero(np.diff(high) > 1) + 1)
    return tuple(
        float(at[crest[maxima[crest].argmax()]])
        for crest in runs
        if len(crest) and not at[crest[0]] <= now <= at[crest[-1]]
    )

"""Other places and times at which the stress equals the maximum within its error."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from assess.derivatives.records import SolvedCase
from fea.core.pin_loads import PinLoads
from fea.core.solution import StressMaxima
from fea.core.zone import Zone
from fea.harmonic.evaluate import high_places
from fea.harmonic.field import HarmonicField
from fea.harmonic.superposition import Circumference, Crest


def competing_places(
    around: Circumference, zones: Iterable[Zone], top: Crest, error: float
) -> tuple[tuple[float, float], ...]:
    """Return well separated places (r, z), m, whose stress at the governing instant is nearly the
    maximum, without the place of the maximum itself.

    error: the relative error of the maximum.
    """
    fields = around.fields
    return high_places(around, fields.points, fields.outside(zones), top, 1.0 - error)[1:]


def competing_times(solved: SolvedCase, maximum: float) -> tuple[float, ...]:
    """Return the times, s, of other peaks over time that nearly reach the governing one."""
    return crests(HarmonicField(solved.solution, solved.zones), solved, maximum)


def crests(
    answer: StressMaxima,
    solved: SolvedCase,
    maximum: float,
    acting_part: Callable[[PinLoads], PinLoads] = lambda loads: loads,
) -> tuple[float, ...]:
    """Return the times, s, of other peaks of a field's maximum over time that are nearly as high as
    the governing one.

    acting_part: a function that returns the part of the loads which acts on the field.
    """
    every, times = solved.history, solved.loads.times
    if every is None or every.times is None or times is None:
        return ()
    least, now, at = (1.0 - solved.error) * maximum, float(times[0]), every.times
    maxima = answer.maxima(acting_part(every), least)
    high = np.flatnonzero(maxima > least)
    runs = np.split(high, np.flatnonzero(np.diff(high) > 1) + 1)
    return tuple(
        float(at[crest[maxima[crest].argmax()]])
        for crest in runs
        if len(crest) and not at[crest[0]] <= now <= at[crest[-1]]
    )

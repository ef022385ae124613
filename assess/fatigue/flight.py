"""The stress sequence of one unit of the spectrum (for example a flight), and its cycles.

Every load case begins and ends at zero load: the ground-air-ground cycle. A static case is
therefore a pulse 0, peak, 0, and a motion begins and ends with a step. The cases of a unit follow
each other in the order of the spectrum, and rainflow counting closes cycles across cases. A case
that occurs less than once per unit occurs once in several units. The sequence is repeated, and
cycles are counted in the last of several passes.

Source of the counting: four-point rainflow, ASTM E1049-85 (2017), by pyLife.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import accumulate, chain, pairwise
from math import floor, lcm

import numpy as np

from pinbase.arrays import Floats, Ints
from pinbase.errors import ArgumentError

MAX_REPEAT_UNITS = 1000  # largest number of units until the spectrum repeats itself
MAX_SEQUENCE_CASES = 10_000  # largest number of cases until then
OCCURRENCE_TOLERANCE = 1e-9  # relative difference of an occurrence from its fraction
RAINFLOW_PASSES = 3  # passes through the sequence; only the last is counted


@dataclass(frozen=True)
class Flight:
    """The order of load cases until the spectrum repeats itself.

    order: the numbers of the cases.
    units: how many units the order covers.
    ends: the position in `order` where each unit ends; by default the order is one block.
    """

    order: tuple[int, ...]
    units: int
    ends: tuple[int, ...] = field(default=(), compare=False)

    @property
    def each(self) -> Iterator[tuple[int, ...]]:
        """The cases of each unit, unit by unit."""
        ends = self.ends or (len(self.order),)
        return (self.order[a:b] for a, b in pairwise((0, *ends)))

    def sequence(self, cases: Sequence[Floats]) -> Floats:
        """Return the values of all cases, concatenated in their order."""
        return np.concatenate([cases[k] for k in self.order])


@dataclass(frozen=True)
class Cycles:
    """The cycles of a sequence.

    amplitude, mean: (C,) Pa.
    first, last: (C,) positions of the two ends of each cycle in the sequence repeated
    RAINFLOW_PASSES times.
    """

    amplitude: Floats
    mean: Floats
    first: Ints
    last: Ints


def flight(occurrences: Sequence[float]) -> Flight:
    """Return the order of load cases with given occurrences per unit.

    Raises: ArgumentError if the occurrences do not repeat within 1000 units (`not-a-fraction`), or
    if the sequence is too long (`too-many-occurrences`).
    """
    exact = [Fraction(n).limit_denominator(MAX_REPEAT_UNITS) for n in occurrences]
    units = lcm(*(n.denominator for n in exact))
    off = any(
        abs(float(n) - m) > OCCURRENCE_TOLERANCE * m
        for n, m in zip(exact, occurrences, strict=True)
    )
    if off or units > MAX_REPEAT_UNITS:
        raise ArgumentError(
            f"the spectrum must repeat itself after at most {MAX_REPEAT_UNITS:,} units: give whole "
            "numbers and fractions such as 0.5, 0.05 or 0.001",
            "not-a-fraction",
        )
    if sum(exact) * units > MAX_SEQUENCE_CASES:
        raise ArgumentError(
            f"the spectrum has more than {MAX_SEQUENCE_CASES:,} cases until it repeats itself",
            "too-many-occurrences",
        )
    # Spread each case evenly: unit u gets the whole numbers between u n and (u + 1) n.
    units_of_cases = [
        tuple(
            case
            for case, n in enumerate(exact)
            for _ in range(floor((unit + 1) * n) - floor(unit * n))
        )
        for unit in range(units)
    ]
    return Flight(
        tuple(chain.from_iterable(units_of_cases)),
        units,
        tuple(accumulate(map(len, units_of_cases))),
    )


def turning_points(values: Floats) -> Ints:
    """Return the positions of the first, the last and all turning points of a history (T,)."""
    rows = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    slope = np.sign(np.diff(values[rows]))
    inner = rows[1:-1][slope[1:] != slope[:-1]]
    return np.unique([0, *inner.tolist(), len(values) - 1])


def case_by_case(course: Floats) -> tuple[Floats, Ints]:
    """Return the turning points of a case's history (T,), which starts from zero and returns to it,
    and their positions in the history with a zero added before and after it.

    The values omit the final zero; the positions include it.
    """
    whole = np.concatenate([[0.0], course, [0.0]])
    turns = turning_points(whole)
    return whole[turns[:-1]], turns


def rainflow(sequence: Floats) -> Cycles:
    """Return the cycles of a sequence (T,) that begins at zero and repeats itself."""
    from pylife.stress.rainflow import FourPointDetector, FullRecorder

    recorder = FullRecorder()
    detector, ends = FourPointDetector(recorder=recorder), [0]
    for _ in range(RAINFLOW_PASSES):
        detector.process(sequence)
        ends.append(len(recorder.values_from))
    here = slice(*ends[-2:])
    a, b = (np.asarray(x[here], dtype=float) for x in (recorder.values_from, recorder.values_to))
    first, last = (
        np.asarray(x[here], dtype=np.int64) for x in (recorder.index_from, recorder.index_to)
    )
    return Cycles(0.5 * np.abs(a - b), 0.5 * (a + b), first, last)

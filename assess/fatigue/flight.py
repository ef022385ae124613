"""The sequence of stress of a unit of the spectrum (a flight, say), and its cycles.

Every case begins and ends at zero load: the ground-air-ground cycle. So a static case is a pulse
0, peak, 0, and a motion begins and ends with a step. Cases of a unit follow each other in the order
of the spectrum, and rainflow counting closes cycles across them; one that occurs less than once in
a unit does so in every so many of them. The sequence is repeated, and cycles are counted in the
last of several passes.

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

MAX_REPEAT_UNITS = 1000  # units until the spectrum repeats itself
MAX_SEQUENCE_CASES = 10_000
OCCURRENCE_TOLERANCE = 1e-9  # relative, of an occurrence from its fraction
RAINFLOW_PASSES = 3  # passes through the sequence, of which the last is counted


@dataclass(frozen=True)
class Flight:
    """The order of cases until the spectrum repeats itself.

    order: their numbers.
    units: how many units these are.
    ends: of each unit in the order; by default there is one.
    """

    order: tuple[int, ...]
    units: int
    ends: tuple[int, ...] = field(default=(), compare=False)

    @property
    def each(self) -> Iterator[tuple[int, ...]]:
        """The cases of one unit after the other."""
        ends = self.ends or (len(self.order),)
        return (self.order[a:b] for a, b in pairwise((0, *ends)))

    def sequence(self, cases: Sequence[Floats]) -> Floats:
        """The values of all cases in their order, joined."""
        return np.concatenate([cases[k] for k in self.order])


@dataclass(frozen=True)
class Cycles:
    """The cycles of a sequence.

    amplitude, mean: (C,) Pa.
    first, last: (C,) places, in the sequence repeated RAINFLOW_PASSES times, between which each
    cycle is.
    """

    amplitude: Floats
    mean: Floats
    first: Ints
    last: Ints


def flight(occurrences: Sequence[float]) -> Flight:
    """The order of cases with these occurrences per unit.

    Raises: ArgumentError where occurrences are no fractions of 1000 or fewer units
    (`not-a-fraction`), or the sequence is too long (`too-many-occurrences`).
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
    """Numbers of the first, the last and all turning points of a history (T,)."""
    rows = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    slope = np.sign(np.diff(values[rows]))
    inner = rows[1:-1][slope[1:] != slope[:-1]]
    return np.unique([0, *inner.tolist(), len(values) - 1])


def case_by_case(course: Floats) -> tuple[Floats, Ints]:
    """The turning points of a case's history (T,), which starts from zero and returns to it.

    The last zero is left out. Also their places in the history with a zero before and after it.
    """
    whole = np.concatenate([[0.0], course, [0.0]])
    turns = turning_points(whole)
    return whole[turns[:-1]], turns


def rainflow(sequence: Floats) -> Cycles:
    """The cycles of a sequence (T,) that begins at zero and repeats itself."""
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

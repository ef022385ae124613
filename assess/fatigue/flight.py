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

MAX_REPEAT_UNITS = 1000  # at most so many until the spectrum repeats itself
MAX_SEQUENCE_CASES = 10_000  # cases in the sequence
OCCURRENCE_TOLERANCE = 1e-9
RAINFLOW_PASSES = 3


@dataclass(frozen=True)
class Flight:
    """Numbers of the cases in their order until the spectrum repeats itself, and how many units
    these are. ends: of each unit in that order; by default they are one.
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
        """Of what there is of every case, one after the other."""
        return np.concatenate([cases[k] for k in self.order])


@dataclass(frozen=True)
class Cycles:
    """Amplitudes and means (C,) Pa; first, last: (C,) places of the sequence, repeated
    RAINFLOW_PASSES times, between which each cycle is.
    """

    amplitude: Floats
    mean: Floats
    first: Ints
    last: Ints


def flight(occurrences: Sequence[float]) -> Flight:
    """The order of cases that occur so often per unit.

    Raises: ArgumentError where these are no fractions of 1000 or fewer units (`not-a-fraction`), or
    the sequence is too long (`too-many-occurrences`).
    """
    exact = [Fraction(n).limit_denominator(MAX_REPEAT_UNITS) for n in occurrences]
    units = lcm(*(n.denominator for n in exact))
    off = any(
        abs(float(n) - m) > OCCURRENCE_TOLERANCE * m
        for n, m in zip(exact, occurrences, strict=True)
    )
    if off or units > MAX_REPEAT_UNITS:
        raise ArgumentError(
            f"the spectrum must repeat itself after at most {MAX_REPEAT_UNITS:,} units: give "
            f"whole numbers "
            "and fractions such as 0.5, 0.05 or 0.001",
            "not-a-fraction",
        )
    if sum(exact) * units > MAX_SEQUENCE_CASES:
        raise ArgumentError(
            f"the spectrum has more than {MAX_SEQUENCE_CASES:,} cases until it repeats itself",
            "too-many-occurrences",
        )
    each = [
        tuple(
            case
            for case, n in enumerate(exact)
            for _ in range(floor((unit + 1) * n) - floor(unit * n))
        )
        for unit in range(units)
    ]
    return Flight(tuple(chain.from_iterable(each)), units, tuple(accumulate(map(len, each))))


def turning_points(values: Floats) -> Ints:
    """Numbers of the first, the last and all turning points of a course (T,)."""
    rows = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    slope = np.sign(np.diff(values[rows]))
    inner = rows[1:-1][slope[1:] != slope[:-1]]
    return np.unique([0, *inner.tolist(), len(values) - 1])


def case_by_case(course: Floats) -> tuple[Floats, Ints]:
    """Turning points of a case's course (T,), from zero and back to it without the last zero; and
    the numbers at which they are in the course with a zero before and after it.
    """
    whole = np.concatenate([[0.0], course, [0.0]])
    turns = turning_points(whole)
    return whole[turns[:-1]], turns


def rainflow(sequence: Floats) -> Cycles:
    """Cycles of a sequence (T,) that begins at zero and repeats itself."""
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

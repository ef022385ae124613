"""Batches of designs, each with a second of work or more, for processes on this machine or others.

A batch is solved as a whole. The results of a design do not depend on its batch, or on where and
when the batch is solved. Designs with the same shape are in the same batch as far as possible, so
that their pins are meshed once.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from loads import noted_files
from pinstress.explore.sweep.evaluate import STRENGTH_KEYS, DesignRow, Evaluator
from pinstress.explore.sweep.laws import Floats
from pinstress.explore.sweep.number import Number
from pinstress.study.reading.file import Study, parse_study

TARGET_BATCH_SECONDS = 2.0  # work in a batch
# Time to hand out a batch to one of many processes and to read its rows
BATCH_OVERHEAD_SECONDS = 0.008
MAX_BATCH_DESIGNS = 5000

_SOLVER_LOCK = threading.Lock()  # workers of a user's cluster may have several threads

Rows = list[list[DesignRow]]


@dataclass(frozen=True)
class DesignProblem:
    """All data that a process needs to solve designs of a study, as text.

    The text is small, and does not depend on the versions of the libraries that transmit it.

    files: hash of the sent contents of the files that the study names; empty if the files are read
    from this machine.
    """

    path: Path
    text: str
    located: bool
    numbers: tuple[Number, ...]
    pins: tuple[str, ...] | None = None
    cases: tuple[str, ...] | None = None
    files: str = ""

    @classmethod
    def of(
        cls,
        study: Study,
        numbers: Sequence[Number],
        pins: Sequence[str] | None = None,
        cases: Sequence[str] | None = None,
    ) -> DesignProblem:
        """Return the problem of a study, with an absolute path of the study."""
        some, those = (None if x is None else tuple(x) for x in (pins, cases))
        path = study.path.absolute()
        return cls(path, study.text, study.located, tuple(numbers), some, those)


@dataclass(frozen=True)
class Batch:
    """A batch of B designs: their numbers, counted from 0, and values (B, p) in SI."""

    designs: tuple[int, ...]
    values: tuple[tuple[float, ...], ...]

    def halves(self) -> tuple[Batch, Batch]:
        """Return both halves of a batch of more than one design."""
        k = len(self.designs) // 2
        return (
            Batch(self.designs[:k], self.values[:k]),
            Batch(self.designs[k:], self.values[k:]),
        )


@dataclass(frozen=True)
class SolvedBatch:
    """The rows of a batch's designs, and the time that they took, s."""

    batch: Batch
    rows: Rows
    seconds: float


@contextmanager
def one_solver() -> Iterator[None]:
    """Let only one thread of this process solve at a time, with one thread per numeric library."""
    from threadpoolctl import threadpool_limits

    with _SOLVER_LOCK, threadpool_limits(1):
        yield


def solve_batch(problem: DesignProblem, batch: Batch) -> SolvedBatch:
    """Solve the designs of a batch."""
    with one_solver():
        start = time.perf_counter()
        evaluator = evaluator_of(problem)
        rows = evaluator.rows_of(batch.values)
        return SolvedBatch(batch, rows, time.perf_counter() - start)


@lru_cache(1)
def evaluator_of(problem: DesignProblem) -> Evaluator:
    """Return the evaluator of this process, which remembers what it solved."""
    with noted_files() as files:
        study = parse_study(problem.path, problem.text, problem.located)
        evaluator = Evaluator(study, problem.numbers, problem.pins, problem.cases)
    evaluator.files = tuple(sorted(files))
    return evaluator


def ordered(numbers: Sequence[Number], values: Floats) -> list[int]:
    """Return the numbers of designs (N, p) in an order in which equal shapes follow each other."""
    shape = [values[:, k] for k, number in enumerate(numbers) if shapes(number)]
    keys = [np.arange(len(values)), *reversed(shape)]
    return [int(i) for i in np.lexsort(keys)]


def shapes(number: Number) -> bool:
    """Whether another value of a number needs new meshes or solutions of pins; strengths need
    neither.
    """
    table, last = number.path[0], number.path[-1]
    return table == "pin" or (table == "material" and last not in STRENGTH_KEYS)


def aim_of(at_once: int) -> float:
    """Return the target duration of a batch, s, if `at_once` batches are solved at a time.

    Batches are handed out one after the other, and each process must get its next batch before it
    has solved the last one.
    """
    return max(TARGET_BATCH_SECONDS, BATCH_OVERHEAD_SECONDS * at_once)


class Batches:
    """The batches of the remaining designs; their size follows from the duration of earlier ones.

    at_once: number of batches that are solved at a time.
    """

    def __init__(self, numbers: Sequence[Number], values: Floats, done: set[int], at_once: int):
        self._values = values
        self._left = [i for i in ordered(numbers, values) if i not in done]
        self._left.reverse()
        self.at_once = at_once
        self._seconds, self._count = 0.0, 0

    def __iter__(self) -> Iterator[Batch]:
        while self._left:
            yield self.next()

    @property
    def left(self) -> int:
        """The number of designs that are in no batch yet."""
        return len(self._left)

    def learn(self, done: SolvedBatch) -> None:
        """Record the duration of a batch."""
        self._seconds += done.seconds
        self._count += len(done.batch.designs)

    @property
    def each(self) -> float | None:
        """The time per design, s; None while unknown."""
        return self._seconds / self._count if self._count else None

    def next(self) -> Batch:
        """Return the next batch.

        Batches are single designs until the duration of a design is known. The last batches are so
        small that all processes end at about the same time.
        """
        size = 1
        if self.each is not None:
            size = min(math.ceil(aim_of(self.at_once) / max(self.each, 1e-9)), MAX_BATCH_DESIGNS)
            size = max(1, min(size, -(-len(self._left) // (2 * self.at_once))))
        taken = [self._left.pop() for _ in range(min(size, len(self._left)))]
        rows = tuple(tuple(float(x) for x in self._values[i]) for i in taken)
        return Batch(tuple(taken), rows)

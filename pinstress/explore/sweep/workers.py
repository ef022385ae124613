"""Processes of this machine that solve batches: this process, or several others over pipes, without
a network.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from pinbase.processes.pool import ProcessDied, Tell, preload, served
from pinbase.processes.threads import hold_threads
from pinstress.explore.sweep.batches import Batch, Batches, DesignProblem, SolvedBatch, solve_batch
from pinstress.explore.sweep.evaluate import rows_without_maximum

WORKER_MODULES = "gmsh", "pymetis", "cvxopt.cholmod"  # that solving imports on demand

PROCESS_DIED = "process-died"  # the code of the reason

Keep = Callable[[SolvedBatch], None]
Lost = Callable[[Batch], SolvedBatch]


class BatchQueue:
    """The queue of batches to be solved, which also handles batches whose process died.

    Such a batch is halved until the design that caused it is known. This design is then solved
    while nothing else runs, since its process may have died because another one needed memory. If
    its process dies again, the design is given up.

    keep: called with each batch as it ends, in any order.
    lost: a function that returns the rows of a design that was given up.
    """

    def __init__(self, batches: Batches, keep: Keep, lost: Lost) -> None:
        self._batches, self._keep, self._lost = batches, keep, lost
        self._again: list[Batch] = []
        self._suspects: list[Batch] = []
        self._alone: set[tuple[int, ...]] = set()
        self._in_work = 0

    def spread_over(self, workers: int) -> None:
        """Adapt the size of further batches to a number of workers."""
        self._batches.at_once = workers

    def take(self) -> Batch | None:
        """Return the next batch to be solved; None if there is none at present, also while a design
        must wait until it can be solved alone.
        """
        if self._again:
            batch = self._again.pop()
        elif self._batches.left:
            batch = self._batches.next()
        elif self._suspects and not self._in_work:
            batch = self._suspects.pop()
            self._alone.add(batch.designs)
        else:
            return None
        self._in_work += 1
        return batch

    def done(self, done: SolvedBatch) -> None:
        """Keep a solved batch."""
        self._in_work -= 1
        self._batches.learn(done)
        self._keep(done)

    def died(self, batch: Batch) -> None:
        """Record that the process of a batch ended by itself."""
        self._in_work -= 1
        if len(batch.designs) > 1:
            self._again += batch.halves()
        elif batch.designs in self._alone:
            self._keep(self._lost(batch))
        else:
            self._suspects.append(batch)


def solve_here(problem: DesignProblem, batches: Batches, keep: Keep) -> None:
    """Solve batches in this process, one after the other."""
    for batch in batches:
        done = solve_batch(problem, batch)
        batches.learn(done)
        keep(done)


def solve_side_by_side(
    problem: DesignProblem, work: BatchQueue, jobs: int, tick: Callable[[], None] = lambda: None
) -> None:
    """Solve batches in `jobs` parallel processes of this machine, which reuse their own meshes.

    tick: called several times per second.
    """
    hold_threads()
    preload(*WORKER_MODULES)

    def take() -> tuple[str, Batch] | None:
        batch = work.take()
        return None if batch is None else (f"designs {min(batch.designs) + 1} ...", batch)

    def give(batch: Batch, outcome: SolvedBatch | ProcessDied) -> None:
        if isinstance(outcome, ProcessDied):
            work.died(batch)
        else:
            work.done(outcome)

    served(partial(_solve, problem), take, give, jobs, lambda _: tick())


def _solve(problem: DesignProblem, batch: Batch, _: Tell) -> SolvedBatch:
    return solve_batch(problem, batch)


def failed_rows(table: tuple[tuple[str, str], ...], batch: Batch) -> SolvedBatch:
    """Return the rows of designs whose process died.

    table: pin and case of each row.
    """
    reason = "the process that solved it ended by itself, out of memory or by a crash"
    rows = rows_without_maximum(table, reason, PROCESS_DIED)
    return SolvedBatch(batch, [rows for _ in batch.designs], 0.0)

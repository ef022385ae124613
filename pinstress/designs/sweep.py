"""A sweep from a study with [vary] to the table of its designs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Protocol

from pinstress.designs.batches import Batches, DesignProblem, Done, evaluator_of
from pinstress.designs.correlations import correlations_of
from pinstress.designs.laws import Floats
from pinstress.designs.parameters import Parameter, parameters_of
from pinstress.designs.sample import designs_of
from pinstress.designs.table import assembled, table_of
from pinstress.designs.workers import failed_rows, local, processes_of, remote, solve_here, solve_on
from pinstress.processes.pool import cores
from pinstress.study.choices import require_count
from pinstress.study.file import Study

if TYPE_CHECKING:
    import pyarrow as pa
    from distributed import Client

Report = Callable[[int, int], None]


class Store(Protocol):
    """Where batches are kept."""

    def write(self, table: pa.Table) -> None:
        """Keep one."""
        ...

    def read(self, schema: pa.Schema) -> list[pa.Table]:
        """All that are kept."""
        ...


class Kept:
    """Batches in memory."""

    def __init__(self) -> None:
        self._tables: list[pa.Table] = []

    def write(self, table: pa.Table) -> None:
        """As that of Store."""
        self._tables.append(table)

    def read(self, schema: pa.Schema) -> list[pa.Table]:
        """As that of Store."""
        return self._tables


@dataclass(frozen=True)
class Sweep:
    """What is swept: parameters, and the designs' values (N, p) in SI."""

    study: Study
    parameters: tuple[Parameter, ...]
    values: Floats
    problem: DesignProblem


def planned(
    study: Study, pins: Sequence[str] | None = None, cases: Sequence[str] | None = None
) -> Sweep:
    """The designs of a study with [vary]; the study itself is read and found usable.

    Raises: InputError.
    """
    parameters = parameters_of(study)
    correlations = correlations_of(study, parameters)
    assert study.table.vary is not None
    values = designs_of(study.table.vary, parameters, correlations)
    problem = DesignProblem.of(study, [p.number for p in parameters], pins, cases)
    evaluator_of(problem)
    return Sweep(study, parameters, values, problem)


def solved(
    sweep: Sweep,
    store: Store,
    jobs: int | None = None,
    scheduler: str | None = None,
    report: Report = lambda _, __: None,
) -> pa.Table:
    """The table of all designs, of which those in the store are not solved again. jobs: processes
    on this machine, by default as many as there are cores; scheduler: address of a cluster of dask
    instead. report: called with the number of designs that are solved, and of all.

    Raises: InputError.
    """
    require_count("jobs", jobs)
    empty = table_of(sweep.study, sweep.parameters, [])
    done = {i - 1 for part in store.read(empty.schema) for i in part["design"].unique().to_pylist()}
    total, count = len(sweep.values), len(done)
    report(count, total)

    def keep(found: Done) -> None:
        nonlocal count
        each = zip(found.batch.designs, found.batch.values, found.rows, strict=True)
        rising = sorted(each, key=lambda design: design[0])
        store.write(
            table_of(sweep.study, sweep.parameters, [(i + 1, v, rows) for i, v, rows in rising])
        )
        count += len(rising)
        report(count, total)

    most = min(jobs or cores(), max(total - count, 1))
    numbers = sweep.problem.numbers
    if scheduler is None and most == 1:
        solve_here(sweep.problem, Batches(numbers, sweep.values, done, 1), keep)
    elif count < total:
        cluster: AbstractContextManager[Client]
        cluster = local(most) if scheduler is None else remote(scheduler)
        table = evaluator_of(sweep.problem).table
        with cluster as client:
            batches = Batches(numbers, sweep.values, done, processes_of(client))
            solve_on(client, sweep.problem, batches, keep, partial(failed_rows, table))
    return assembled(store.read(empty.schema))


def sweep(
    study: Study,
    *,
    pins: Iterable[str] | None = None,
    cases: Iterable[str] | None = None,
    jobs: int | None = 1,
    scheduler: str | None = None,
) -> pa.Table:
    """Solve the designs of a study's [vary]; a table with a row for each design, pin and case, as
    designs.parquet has it (docs/sweep.md).

    pins, cases: names; all by default. jobs: number of processes (None: number of cores); with
    more than one, a script must be guarded by `if __name__ == "__main__":`. scheduler: address of a
    scheduler of dask instead.

    Raises: InputError for bad input. A design that fails is a row with its reason.
    """
    names = [None if x is None else list(x) for x in (pins, cases)]
    return solved(planned(study, *names), Kept(), jobs, scheduler)

"""A sweep from a study with [vary] to the table of its designs."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from pinbase.processes.pool import cores
from pinstress.explore.sweep.batches import Batches, DesignProblem, SolvedBatch, evaluator_of
from pinstress.explore.sweep.connection import ClusterConnection, connection_to
from pinstress.explore.sweep.correlations import correlations_of
from pinstress.explore.sweep.laws import Floats
from pinstress.explore.sweep.parameters import Parameter, parameters_of
from pinstress.explore.sweep.possible import require_balance
from pinstress.explore.sweep.sample import designs_of
from pinstress.explore.sweep.table import assembled, table_of
from pinstress.explore.sweep.workers import BatchQueue, failed_rows, solve_here, solve_side_by_side
from pinstress.study.reading.choices import require_count
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs, require_unchanged

if TYPE_CHECKING:
    import pyarrow as pa

Report = Callable[[int, int], None]

log = logging.getLogger(__name__)


class Store(Protocol):
    """The interface of a store of solved batches."""

    @property
    def count(self) -> int:
        """Return the number of batches."""
        ...

    def write(self, table: pa.Table) -> None:
        """Keep a batch."""
        ...

    def read(self, schema: pa.Schema) -> list[pa.Table]:
        """Return all batches that are kept."""
        ...


class MemoryStore:
    """Batches in memory."""

    def __init__(self) -> None:
        self._tables: list[pa.Table] = []

    @property
    def count(self) -> int:
        """Return the number of batches."""
        return len(self._tables)

    def write(self, table: pa.Table) -> None:
        """Keep a batch."""
        self._tables.append(table)

    def read(self, schema: pa.Schema) -> list[pa.Table]:
        """Return all batches that are kept."""
        return self._tables


@dataclass(frozen=True)
class Sweep:
    """A planned sweep: the parameters, and the values (N, p) of the designs in SI.

    inputs: the values of the study and the content of its files (pinstress.study.reading.inputs).
    """

    study: Study
    parameters: tuple[Parameter, ...]
    values: Floats
    problem: DesignProblem
    inputs: dict[str, str]


def planned(
    study: Study, pins: Sequence[str] | None = None, cases: Sequence[str] | None = None
) -> Sweep:
    """Plan the designs of a study with [vary], and check that the study can be run.

    Raises: InputError.
    """
    before, parameters = inputs(study), parameters_of(study)
    correlations = correlations_of(study, parameters)
    assert study.table.vary is not None
    values = designs_of(study.table.vary, parameters, correlations)
    problem = DesignProblem.of(study, [p.number for p in parameters], pins, cases)
    require_balance(study, evaluator_of(problem), values)
    return Sweep(study, parameters, values, problem, before)


def solved(
    sweep: Sweep,
    store: Store,
    jobs: int | None = None,
    connection: ClusterConnection | None = None,
    report: Report = lambda _, __: None,
    tell: Callable[[str], None] = log.warning,
) -> pa.Table:
    """Return the table of all designs; those in the store are not solved again.

    jobs: processes on this machine, by default as many as there are cores.
    connection: connection to a Dask cluster that solves them instead.
    report: called with the number of solved designs and the number of all designs.
    tell: called with warnings about a cluster.

    Raises: InputError.
    """
    require_count("jobs", jobs)
    done = set[int]()
    if store.count:
        schema = table_of(sweep.study, sweep.parameters, []).schema
        done = {i - 1 for part in store.read(schema) for i in part["design"].unique().to_pylist()}
    total, count = len(sweep.values), len(done)
    report(count, total)

    def keep(batch: SolvedBatch) -> None:
        nonlocal count
        if connection is None:  # a cluster was sent the files
            require_unchanged(sweep.study, sweep.inputs)
        designs = zip(batch.batch.designs, batch.batch.values, batch.rows, strict=True)
        rising = sorted(designs, key=lambda design: design[0])
        store.write(
            table_of(sweep.study, sweep.parameters, [(i + 1, v, rows) for i, v, rows in rising])
        )
        count += len(rising)
        report(count, total)

    # Made here also for forked processes, before Arrow starts threads.
    evaluator = evaluator_of(sweep.problem)

    def batches(at_once: int) -> Batches:
        return Batches(sweep.problem.numbers, sweep.values, done, at_once)

    def work(at_once: int) -> BatchQueue:
        return BatchQueue(batches(at_once), keep, partial(failed_rows, evaluator.table))

    most = min(jobs or cores(), total - count)
    if connection is not None and count < total:
        # dask takes a second to import
        from pinstress.explore.sweep.scheduler import cluster_at, solve_on

        with cluster_at(connection, tell) as cluster:
            solve_on(cluster, sweep.problem, evaluator.files, work(cluster.workers))
    elif most > 1:
        solve_side_by_side(sweep.problem, work(most), most, lambda: report(count, total))
    else:
        solve_here(sweep.problem, batches(1), keep)
    return assembled(store.read(table_of(sweep.study, sweep.parameters, []).schema))


def sweep(
    study: Study,
    *,
    pins: Iterable[str] | None = None,
    cases: Iterable[str] | None = None,
    jobs: int | None = 1,
    scheduler: str | None = None,
    tls: Path | str | None = None,
    insecure: bool = False,
) -> pa.Table:
    """Solve the designs of a study's [vary], and return a table with a row for each design, pin and
    case, as in designs.parquet (docs/sweep.md).

    pins, cases: names; all by default.
    jobs: number of processes (None: number of cores).
    scheduler: address of a Dask scheduler whose workers solve the designs instead.
    tls: folder with the keys of that cluster, which `pinstress cluster-keys` writes.
    insecure: whether the connection to a scheduler beyond this machine may be unencrypted.

    Raises: InputError for bad input. A design that fails is a row with its reason.
    """
    connection = connection_to(scheduler, tls, insecure, None if jobs == 1 else jobs)
    names = [None if x is None else list(x) for x in (pins, cases)]
    return solved(planned(study, *names), MemoryStore(), jobs, connection)

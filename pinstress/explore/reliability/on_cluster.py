"""Designs of a reliability study solved on a cluster, and kept until the study is complete."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

from pinbase.processes.interrupts import Unfinished
from pinstress.analysis.cache import Cache
from pinstress.explore.sweep.batches import Batches, DesignProblem, Rows, SolvedBatch, evaluator_of
from pinstress.explore.sweep.cluster import Cluster
from pinstress.explore.sweep.evaluate import DesignRow
from pinstress.explore.sweep.laws import Floats
from pinstress.explore.sweep.scheduler import contents_of, hash_of, solve_on
from pinstress.explore.sweep.workers import BatchQueue, failed_rows
from pinstress.study.reading.errors import InputError

KEPT = "Designs that are solved are kept in the cache: the same command reuses them"


@dataclass(frozen=True)
class KeptRows:
    """The rows of solved designs. designs: their numbers, from 0, within one request."""

    designs: tuple[int, ...]
    rows: tuple[tuple[DesignRow, ...], ...]


def design_rows(
    cluster: Cluster,
    problem: DesignProblem,
    cache: Cache | None,
    values: Floats,
    report: Callable[[int], None],
) -> Rows:
    """Solve designs on a cluster and return their rows, in the order of the designs.

    cache: provides designs that were solved before and stores new ones; None to store none.
    values: (n, p) values of the problem's numbers, SI.
    report: called with the number of designs solved so far.

    Raises: InputError if the connection to the cluster is lost.
    """
    evaluator = evaluator_of(problem)
    rows: dict[int, list[DesignRow]] = {}

    def keep(done: SolvedBatch) -> None:
        rows.update(zip(done.batch.designs, done.rows, strict=True))
        report(len(rows))

    with _kept(cache, problem, values, rows):
        report(len(rows))
        batches = Batches(problem.numbers, values, set(rows), cluster.workers)
        work = BatchQueue(batches, keep, partial(failed_rows, evaluator.table))
        if batches.left:
            solve_on(cluster, problem, evaluator.files, work)
    return [rows[i] for i in range(len(values))]


@contextmanager
def _kept(
    cache: Cache | None, problem: DesignProblem, values: Floats, rows: dict[int, list[DesignRow]]
) -> Iterator[None]:
    """Add the cached rows of the designs to `rows`; when the block ends, cache all of `rows`."""
    if cache is None:
        yield
        return
    contents = contents_of(evaluator_of(problem).files)
    numbers = [number.key for number in problem.numbers]
    asked = problem.text, problem.located, numbers, problem.pins, problem.cases, hash_of(contents)
    key = cache.key((asked, values))
    before = cache.read(key, KeptRows) or KeptRows((), ())
    rows.update(zip(before.designs, map(list, before.rows), strict=True))
    try:
        yield
    except InputError as error:
        raise InputError(f"{error}\n{KEPT}", code=error.code) from None
    except KeyboardInterrupt:
        raise Unfinished(f"{KEPT[0].lower()}{KEPT[1:]}") from None
    finally:
        if len(rows) > len(before.designs):
            cache.write(key, KeptRows(tuple(rows), tuple(map(tuple, rows.values()))))
            cache.trim()

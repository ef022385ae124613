"""The overhead of a cluster: thousands of cheap designs solved by this process, and by the workers
of an encrypted cluster on this machine.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from benchmarks.timing import table
from pinstress import Study, shipped_studies, study_from
from pinstress.explore.sweep.connection import ClusterConnection
from pinstress.explore.sweep.sweep import MemoryStore, planned, solved
from tests.support.programs.dask_cluster import dask_cluster

FORCES, STRENGTHS = 50, 100  # every pair is a design
DESIGNS = FORCES * STRENGTHS
WORKERS, ROUNDS = 2, 3
MAX_OVERHEAD = 5.0  # allowed, ms for each design
VARY = """
[vary]
sample = "grid"
[vary.parameters]
"case.landing.forces.B[2]" = {{ normal = ["{mean} lbf", "100 lbf"], steps = {forces} }}
"material.AISI 4340.yield_strength" = {{ normal = ["225 ksi", "5 ksi"], steps = {strengths} }}
"""


def cluster() -> str:
    """Return the table: this process and the cluster alternate, each round with other designs."""
    rows = []
    with tempfile.TemporaryDirectory() as folder, dask_cluster(Path(folder) / "c") as started:
        processes = [started.scheduler, *(started.worker() for _ in range(WORKERS))]
        started.wait_until(f"len(workers) == {WORKERS}")
        numbers = [process.pid for process in processes]
        for number in range(1, ROUNDS + 1):
            study = _study(number)
            alone = _spent(partial(_swept, study), [])
            there = _spent(partial(_swept, study, started.connection), numbers)
            more = [1e3 * (b - a) / DESIGNS for a, b in zip(alone, there, strict=True)]
            rows.append((number, *alone, *there, *more))
    head = (
        "round", "s by this process", "processor time, s", "s by the cluster", "processor time, s",
        "ms more a design", "of processor time",
    )  # fmt: skip
    return (
        f"{DESIGNS:,} designs of one pin, {FORCES} forces by {STRENGTHS} strengths, by this "
        f"process, and by {WORKERS} workers with TLS on the same machine; processor time of the "
        "cluster is that of scheduler, workers and this process. In the first round the workers "
        f"import all that solving needs. Allowed are {MAX_OVERHEAD:g} ms more a design:\n\n"
        + table(head, rows)
    )


def _study(number: int) -> Study:
    """Return the study of a round; no force occurs in another round."""
    text = shipped_studies()["one_pin"].read_text(encoding="utf-8")
    mean = -980 - number
    return study_from(text + VARY.format(mean=mean, forces=FORCES, strengths=STRENGTHS))


def _swept(study: Study, connection: ClusterConnection | None = None) -> None:
    solved(planned(study), MemoryStore(), 1, connection)


def _spent(work: Callable[[], None], others: list[int]) -> tuple[float, float]:
    """Return the wall time of `work`, and the processor time of this and of other processes, s."""
    import psutil

    processes = [psutil.Process(), *map(psutil.Process, others)]

    def used() -> float:
        return sum(sum(process.cpu_times()[:2]) for process in processes)

    start, before = time.perf_counter(), used()
    work()
    return time.perf_counter() - start, used() - before

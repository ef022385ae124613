"""Sweeps of one pin: time and memory by the number of designs, two processes compared with one, and
a thousand processes by simulation.
"""

from __future__ import annotations

import heapq
import os
import statistics
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

import numpy as np

from benchmarks.timing import Floats, power, table
from pinstress import Study, shipped_studies, study_from
from pinstress.explore.sweep.batches import Batch, Batches, SolvedBatch, aim_of
from pinstress.explore.sweep.sweep import MemoryStore, Sweep, planned, solved
from pinstress.explore.sweep.workers import BatchQueue, failed_rows, solve_side_by_side

FORCES = 5_000  # designs of one shape, each with another force and strength
COUNTS = 250, 500, 1_000  # designs of other shapes
STRENGTHS = 100, 200, 400  # for each of 50 loads of one shape
JOBS = 2
MANY = 150  # designs for the comparison of kinds of sweeps
ROUNDS, COMPARED = 3, 100  # rounds and designs for the comparison of one process with two
TASKS = 500  # empty tasks, with which the scheduler is measured
WORKERS = 1_000  # simulated
EACH = 30  # batches for each simulated worker
LENGTHS = 0.5, 1.0, 2.0, 5.0, 10.0, 30.0  # s of work in a batch
GOOD = 0.85  # required efficiency
BUSY = 0.5  # load of a core above which wall times are not meaningful

SHAPE = '"pin.B.profile[2].diameter" = {{ from = "1.5 in", to = "3 in", steps = {} }}'
SCATTER = """
"case.landing.forces.B[1]" = { normal = ["0 lbf", "100 lbf"] }
"case.landing.forces.B[2]" = { normal = ["-988 lbf", "100 lbf"] }
"material.AISI 4340.yield_strength" = { normal = ["225 ksi", "5 ksi"] }
"""
REST = """
"case.landing.forces.B[2]" = {{ normal = ["-988 lbf", "100 lbf"], steps = 50 }}
"material.AISI 4340.yield_strength" = {{ normal = ["225 ksi", "5 ksi"], steps = {} }}
"""


def sweep() -> str:
    """Return the tables."""
    load = os.getloadavg()[0]
    return "\n\n".join(
        [
            _load(load),
            f"The pin of studies/one_pin.toml by {JOBS} processes on this machine, their start "
            "and memory included. A Sobol sequence of a diameter, a force and a strength: every "
            "design has another shape, meshed three times.",
            _growth({count: _study(count) for count in COUNTS}),
            "One shape, 50 forces and many strengths:",
            _growth({50 * count: _study(0, 1, count) for count in STRENGTHS}),
            _kinds(),
            _efficiency(),
            _simulated(),
        ]
    )


def _load(load: float) -> str:
    cores = len(os.sched_getaffinity(0))
    text = f"Load at the start: {load:.2f} on {cores} cores."
    if load > BUSY * cores:
        text += (
            " **A shared machine**: other work took part of it, so times of the wall and the "
            "efficiency of two processes say nothing of this program; processor times do, roughly."
        )
    return text


def _growth(studies: dict[int, Study]) -> str:
    """Return the table of times and memory by number of designs."""
    grown = {count: _measured(study, JOBS) for count, study in studies.items()}
    rows = [(f"{n:,}", m.seconds, m.cpu, 1e3 * m.cpu / n, m.most) for n, m in grown.items()]
    counts = np.array(list(grown), float)
    exponent = power(counts, np.array([m.cpu for m in grown.values()]))
    head = ("designs", "s", "processor time, s", "ms of it a design", "memory, MB")
    text = f"Processor time grows with the power {exponent:.2f} of the number of designs."
    return f"{table(head, rows)}\n\n{text}"


def _study(count: int, shapes: int = 0, strengths: int = 40) -> Study:
    """Return a Sobol sequence of diameter, force and strength, or with `shapes` a grid of this many
    diameters.
    """
    text = shipped_studies()["one_pin"].read_text(encoding="utf-8")
    how = 'sample = "grid"' if shapes else f'sample = "sobol"\ncount = {count}'
    varied = f"{SHAPE.format(shapes or 1)}{REST.format(strengths)}"
    return study_from(f"{text}\n[vary]\n{how}\n[vary.parameters]\n{varied}")


@dataclass
class Memory:
    """The peak of the memory of this process and its children together, MB, and their processor
    time, s.
    """

    most: float = 0.0
    cpu: float = 0.0


@dataclass(frozen=True)
class Measured:
    """A sweep: wall time and processor time of all its processes, s, and their memory, MB."""

    seconds: float
    cpu: float
    most: float


@contextmanager
def _watched() -> Iterator[Memory]:
    import psutil

    found, done, us = Memory(), threading.Event(), psutil.Process()
    before = sum(us.cpu_times()[:2])

    def watch() -> None:
        while not done.wait(0.25):
            total = cpu = 0.0
            for each in (us, *us.children(recursive=True)):
                try:
                    total += each.memory_full_info().pss / 2**20
                    cpu += sum(each.cpu_times()[:2])
                except psutil.Error:  # it has ended
                    continue
            found.most, found.cpu = max(found.most, total), max(found.cpu, cpu - before)

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    try:
        yield found
    finally:
        done.set()
        thread.join()


def _measured(study: Study, jobs: int) -> Measured:
    with _watched() as used:
        start = time.perf_counter()
        solved(planned(study), MemoryStore(), jobs)
        spent = time.perf_counter() - start
    return Measured(spent, used.cpu, used.most)


def _kinds() -> str:
    """Return the table of kinds of sweeps that are faster than distinct shapes."""
    rows = []
    for name, study in (
        ("every shape another", _study(MANY)),
        ('the same, goal = "decide"', _asking(_study(MANY), 'goal = "decide"')),
        ("a grid of 5 diameters, 50 forces, 40 strengths", _study(0, 5)),
        ("one shape, other forces and strengths", _forces(FORCES)),
    ):
        designs = len(planned(study).values)
        found = _measured(study, JOBS)
        rows.append((name, f"{designs:,}", found.seconds, found.cpu, 1e3 * found.cpu / designs))
    head = ("designs", "number", "s", "processor time, s", "ms of it a design")
    return "What is the same in several designs is not solved again:\n\n" + table(head, rows)


def _forces(count: int) -> Study:
    """Return a Sobol sequence of forces and strengths of one shape; all designs differ."""
    text = shipped_studies()["one_pin"].read_text(encoding="utf-8")
    head = f'sample = "sobol"\ncount = {count}'
    return study_from(f"{text}\n[vary]\n{head}\n[vary.parameters]{SCATTER}")


def _asking(study: Study, key: str) -> Study:
    return study_from(study.text.replace("[analysis]", f"[analysis]\n{key}"))


def _solved_by(jobs: int, plan: Sweep, some: range) -> tuple[float, list[SolvedBatch]]:
    """Return the wall time of some designs, s, and their batches."""
    found: list[SolvedBatch] = []
    others = set(range(len(plan.values))) - set(some)
    batches = Batches(plan.problem.numbers, plan.values, others, jobs)
    start = time.perf_counter()
    work = BatchQueue(batches, found.append, partial(failed_rows, ()))
    solve_side_by_side(plan.problem, work, jobs)
    return time.perf_counter() - start, found


def _processor_time() -> float:
    """Return the processor time of this process and its children, also of those that have
    ended, s.
    """
    import psutil

    us = psutil.Process()
    return sum(sum(each.cpu_times()[:4]) for each in (us, *us.children(recursive=True)))


def _efficiency() -> str:
    """Return the table of the efficiency of two processes.

    One process and two solve other designs of the same sweep alternately, so that the load by other
    work is the same for both.
    """
    plan = planned(_study(COMPARED * (ROUNDS + 1)))
    rounds = [range(k * COMPARED, (k + 1) * COMPARED) for k in range(ROUNDS + 1)]
    times, batches = [], list[SolvedBatch]()
    for some in rounds:  # the first round only loads the imports
        spent: list[float] = []
        for jobs in (1, 2):
            before = _processor_time()
            seconds, found = _solved_by(jobs, plan, some)
            spent += [seconds, _processor_time() - before]
        batches += found
        times.append(spent)
    times = times[1:]
    good = [one / (2.0 * two) for one, _, two, _ in times]
    middle, more = statistics.median(good), statistics.median(b / a for _, a, _, b in times)
    rows = [(k, *x, f"{y:.0%}") for k, (x, y) in enumerate(zip(times, good, strict=True), 1)]
    head = ("round", "s by one", "processor time, s", "s by two", "processor time, s", "efficiency")
    return (
        f"{COMPARED} designs of other shapes, the same by one process and by two in turn, with "
        f"their start; the median of the efficiencies is {middle:.0%}, and two "
        f"processes take {more:.2f} times the processor time of one ({len(batches)} batches, the "
        f"median {statistics.median(b.seconds for b in batches):.2f} s):\n\n{table(head, rows)}"
    )


def _nothing(problem: object, batch: Batch) -> SolvedBatch:
    return SolvedBatch(batch, [], 0.0)


def _overhead(plan: Sweep) -> tuple[float, float]:
    """Return the processor times of an empty task, s: of this process with a dask scheduler, and of
    the processes that solve.
    """
    import psutil
    from distributed import Client, LocalCluster

    us, found = psutil.Process(), (0.0, 0.0)
    with (
        LocalCluster(JOBS, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as ours,
        Client(ours) as client,
    ):
        for count in (10 * JOBS, TASKS):
            here, all_ = sum(us.cpu_times()[:2]), _processor_time()
            batch = Batch((0,), ((0.0,) * len(plan.problem.numbers),))
            tasks = [client.submit(_nothing, plan.problem, batch, pure=False) for _ in range(count)]
            client.gather(tasks)
            own = sum(us.cpu_times()[:2]) - here
            found = own / count, (_processor_time() - all_ - own) / count
    return found


def _simulated() -> str:
    plan = planned(_study(COMPARED))
    overhead, theirs = _overhead(plan)
    _, batches = _solved_by(JOBS, plan, range(COMPARED))
    relative = np.array([b.seconds / len(b.batch.designs) for b in batches])
    relative /= relative.mean()
    aim = aim_of(WORKERS)
    rows = [(x, _simulate(x, relative, overhead)) for x in sorted({*LENGTHS, aim})]
    good = next((f"{length:g} s" for length, found in rows if found >= GOOD), "more")
    shown = [(length, f"{found:.0%}") for length, found in rows]
    return (
        f"A task that does nothing takes {1e3 * overhead:.2f} ms of processor time of the "
        f"scheduler and of the process that submits it, and {1e3 * theirs:.2f} ms of the one that "
        f"solves it ({TASKS:,} tasks by {JOBS} processes). With the first, one task after the "
        f"other, and with batches that differ as the measured ones do, {WORKERS:,} simulated "
        f"processes with {EACH} batches each would have the efficiencies below: batches must have "
        f"{good} of work for {GOOD:.0%}. For so many a batch has {aim:g} s "
        "(pinstress/explore/sweep/batches.py: aim_of):\n\n"
        + table(("s of work in a batch", "efficiency"), shown)
    )


def _simulate(length: float, relative: Floats, overhead: float) -> float:
    """Return the share of the time in which processes work.

    A scheduler hands out one batch after the other; each process has one batch that it solves and
    one that waits.
    """
    draw = np.random.default_rng(1)
    work = length * draw.choice(relative, WORKERS * EACH)
    free = [0.0] * WORKERS  # the times at which the processes become free
    heapq.heapify(free)
    scheduler = 0.0
    for seconds in work.tolist():
        scheduler += overhead
        heapq.heappush(free, max(heapq.heappop(free), scheduler) + seconds)
    return float(work.sum()) / (WORKERS * max(free))

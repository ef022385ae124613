"""Sweeps of one pin: time and memory against the number of designs, two processes against one, and
a thousand by simulation.
"""

from __future__ import annotations

import heapq
import math
import statistics
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from benchmarks.timing import Floats, power, table
from pinstress import Study, shipped_studies, study_from
from pinstress.designs.batches import Batch, Batches, Done
from pinstress.designs.sweep import Kept, Sweep, planned, solved
from pinstress.designs.workers import failed_rows, local, solve_on

COUNTS = 250, 500, 1_000
JOBS = 2
MANY = 500  # designs by which kinds of sweeps are compared
COMPARED = 200  # designs by which one process and two are compared
TASKS = 500  # that do nothing, by which the scheduler is measured
WORKERS = 1_000
EACH = 30  # batches for each worker of the simulation
LENGTHS = 0.5, 1.0, 2.0, 5.0, 10.0, 30.0  # s of work in a batch
GOOD = 0.85  # efficiency

SHAPE = '"pin.B.profile[2].diameter" = {{ from = "1.5 in", to = "3 in", steps = {} }}'
REST = """
"case.landing.forces.B[2]" = { normal = ["-988 lbf", "100 lbf"], steps = 50 }
"material.AISI 4340.yield_strength" = { normal = ["225 ksi", "5 ksi"], steps = 40 }
"""


def sweep() -> str:
    """The tables."""
    grown = [_measured(_study(count), JOBS) for count in COUNTS]
    rows = [
        (f"{count:,}", m.seconds, m.cpu, 1e3 * m.cpu / count, m.most)
        for count, m in zip(COUNTS, grown, strict=True)
    ]
    seconds = np.array([m.cpu for m in grown])
    exponent = power(np.array(COUNTS, float), seconds) if len(COUNTS) > 1 else math.nan
    head = ("designs", "s", "processor time, s", "ms of it a design", "memory, MB")
    return "\n\n".join(
        [
            f"The pin of studies/one_pin.toml by {JOBS} processes on this machine, their start "
            "and memory included. A Sobol sequence of a diameter, a force and a strength: every "
            "design has another shape, meshed three times. Processor time grows with the power "
            f"{exponent:.2f} of the number of designs:",
            table(head, rows),
            _kinds(),
            _efficiency(),
            _simulated(),
        ]
    )


def _study(count: int, shapes: int = 0) -> Study:
    """A Sobol sequence of all three, or with `shapes` a grid of so many diameters."""
    text = shipped_studies()["one_pin"].read_text(encoding="utf-8")
    how = 'sample = "grid"' if shapes else f'sample = "sobol"\ncount = {count}'
    vary = f"[vary]\n{how}\n[vary.parameters]\n{SHAPE.format(shapes or 1)}{REST}"
    return study_from(f"{text}\n{vary}")


@dataclass
class Memory:
    """The most memory (MB) that this process and its children had together, and their processor
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
        solved(planned(study), Kept(), jobs)
        spent = time.perf_counter() - start
    return Measured(spent, used.cpu, used.most)


def _kinds() -> str:
    """What makes a sweep quicker than distinct shapes."""
    rows = []
    for name, study in (
        ("every shape another", _study(MANY)),
        ('the same, goal = "decide"', _decided(_study(MANY))),
        ("a grid of 1 diameter, 50 forces, 40 strengths", _study(0, 1)),
        ("a grid of 5 diameters, 50 forces, 40 strengths", _study(0, 5)),
    ):
        designs = len(planned(study).values)
        found = _measured(study, JOBS)
        rows.append((name, f"{designs:,}", found.seconds, found.cpu, 1e3 * found.cpu / designs))
    head = ("designs", "number", "s", "processor time, s", "ms of it a design")
    return "What is the same in several designs is not solved again:\n\n" + table(head, rows)


def _decided(study: Study) -> Study:
    text = study.text.replace("[analysis]", '[analysis]\ngoal = "decide"')
    return study_from(text)


def _on_cluster(plan: Sweep, jobs: int) -> tuple[float, list[Done]]:
    """Wall time without the start of the processes, s, and the batches."""
    found: list[Done] = []
    numbers = plan.problem.numbers
    with local(jobs) as client:
        warm = Batches(numbers, plan.values[: 4 * jobs], set(), jobs)
        solve_on(client, plan.problem, warm, lambda _: None, partial(failed_rows, ()))
        start = time.perf_counter()
        batches = Batches(numbers, plan.values, set(range(4 * jobs)), jobs)
        solve_on(client, plan.problem, batches, found.append, partial(failed_rows, ()))
        return time.perf_counter() - start, found


def _efficiency() -> str:
    plan = planned(_study(COMPARED))
    (one, _), (two, batches) = (_on_cluster(plan, jobs) for jobs in (1, 2))
    long = [b.seconds for b in batches]
    return (
        f"{COMPARED} designs of other shapes, without the start of the processes: by one process "
        f"in {one:.1f} s, by two in {two:.1f} s, an efficiency of {one / (2.0 * two):.0%} "
        f"({len(long)} batches, the median {statistics.median(long):.2f} s)."
    )


def _nothing(problem: object, batch: Batch) -> Done:
    return Done(batch, [], 0.0)


def _overhead(plan: Sweep) -> float:
    """Seconds of the scheduler and of this process for a task that does nothing."""
    values = np.zeros((TASKS, len(plan.problem.numbers)))
    with local(JOBS) as client:
        batches = _Single(plan.problem.numbers, values, set(), JOBS)
        start = time.perf_counter()
        lost = partial(failed_rows, ())
        solve_on(client, plan.problem, batches, lambda _: None, lost, _nothing)
        return (time.perf_counter() - start) / TASKS


class _Single(Batches):
    def learn(self, done: Done) -> None:
        """Nothing: a design a batch."""


def _simulated() -> str:
    plan = planned(_study(COMPARED))
    overhead = _overhead(plan)
    _, batches = _on_cluster(replace(plan, values=plan.values[:200]), JOBS)
    relative = np.array([b.seconds / len(b.batch.designs) for b in batches])
    relative /= relative.mean()
    rows = [(length, _simulate(length, relative, overhead)) for length in LENGTHS]
    good = next((f"{length:g} s" for length, found in rows if found >= GOOD), "more")
    shown = [(length, f"{found:.0%}") for length, found in rows]
    return (
        f"A task that does nothing takes {1e3 * overhead:.2f} ms of the scheduler and of the "
        f"process that submits it ({TASKS:,} tasks by {JOBS} processes). With that, one task "
        f"after the other, and with batches that differ as the measured ones do, {WORKERS:,} "
        f"simulated processes with {EACH} batches each would have the efficiencies below: batches "
        f"must have {good} of work for {GOOD:.0%} (`AIM` in pinstress/designs/batches.py):\n\n"
        + table(("s of work in a batch", "efficiency"), shown)
    )


def _simulate(length: float, relative: Floats, overhead: float) -> float:
    """The share of all time in which processes work. A scheduler hands out one batch after the
    other, each process has one that is solved and one that waits.
    """
    draw = np.random.default_rng(1)
    work = length * draw.choice(relative, WORKERS * EACH)
    free = [0.0] * WORKERS  # when a process has ended what it was given
    heapq.heapify(free)
    scheduler = 0.0
    for seconds in work.tolist():
        scheduler += overhead
        heapq.heappush(free, max(heapq.heappop(free), scheduler) + seconds)
    return float(work.sum()) / (WORKERS * max(free))

"""Pins sized on the user's own cluster, each by one of its workers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from loads import noted_files
from pinbase.processes.pool import ProcessDied, Progress
from pinstress.analysis.plan import Plan, prepare
from pinstress.explore.size.size_pin import SizingGoal, SizingResult, size_pin
from pinstress.explore.sweep.batches import one_solver
from pinstress.explore.sweep.cluster import Cluster
from pinstress.explore.sweep.scheduler import solve_on
from pinstress.study.reading.file import parse_study

Done = Callable[[int, SizingResult | ProcessDied], None]

WORKER_DIED = ProcessDied("the worker that sized it ended by itself, out of memory or by a crash")


@dataclass(frozen=True)
class PinProblem:
    """All that a worker needs to size pins of a study, as text where it can be.

    files: hash of the contents that were sent of the files that the study names; empty where they
    are read as they lie here.
    """

    path: Path
    text: str
    located: bool
    goal: SizingGoal
    pins: tuple[str, ...]
    cases: tuple[str, ...]
    files: str = ""

    @property
    def planned(self) -> tuple[Path, str, bool, tuple[str, ...], tuple[str, ...], str]:
        """All on which the plan depends."""
        return self.path, self.text, self.located, self.pins, self.cases, self.files

    @classmethod
    def of(cls, plan: Plan, goal: SizingGoal) -> PinProblem:
        """Return the problem of a plan's pins, whose files are named by absolute paths."""
        study = plan.study
        place = study.path.absolute(), study.text, study.located
        return cls(*place, goal, plan.pins, tuple(plan.loads))


@dataclass(frozen=True)
class PinTask:
    """A pin to be sized, by its number among those that are.

    scales: of the pins so far, by name.
    """

    number: int
    pin: str
    scales: tuple[tuple[str, float], ...]


class PinQueue:
    """The pins that are to be sized (pinstress.explore.sweep.scheduler.WorkQueue)."""

    def __init__(self, pins: Sequence[PinTask], done: Done, progress: Progress) -> None:
        self._left, self._done, self._progress = list(reversed(pins)), done, progress
        self._running: dict[int, str] = {}
        self._count = len(pins)

    def spread_over(self, workers: int) -> None:
        """A pin is not divided."""

    def take(self) -> PinTask | None:
        """Return the next pin; None without one."""
        if not self._left:
            return None
        task = self._left.pop()
        self._running[task.number] = task.pin
        self._tell()
        return task

    def done(self, done: tuple[int, SizingResult]) -> None:
        """Keep the size of a pin."""
        self._end(*done)

    def died(self, item: PinTask) -> None:
        """Give up a pin."""
        self._end(item.number, WORKER_DIED)

    def _end(self, number: int, result: SizingResult | ProcessDied) -> None:
        del self._running[number]
        self._done(number, result)
        self._tell()

    def _tell(self) -> None:
        left = len(self._left) + len(self._running)
        names = ", ".join(self._running.values())
        self._progress(f"on the cluster: {names}", 1.0 - left / self._count)


def size_on(
    cluster: Cluster,
    problem: PinProblem,
    pins: Sequence[str],
    scales: Mapping[str, float],
    done: Done,
    progress: Progress,
) -> None:
    """Size pins on a cluster.

    scales: of the pins so far, by name. done: called with the number of each pin and its size.

    Raises: InputError where the cluster is lost.
    """
    with noted_files() as files:
        _plan.__wrapped__(*problem.planned)
    known = tuple(scales.items())
    work = PinQueue([PinTask(k, pin, known) for k, pin in enumerate(pins)], done, progress)
    solve_on(cluster, problem, tuple(sorted(files)), work, size_there)


def size_there(problem: PinProblem, task: PinTask) -> tuple[int, SizingResult]:
    """Size a pin in a worker, and return it with its number."""
    with one_solver():
        plan = _plan(*problem.planned)
        return task.number, size_pin(plan, task.pin, problem.goal, dict(task.scales))


@lru_cache(1)
def _plan(
    path: Path, text: str, located: bool, pins: tuple[str, ...], cases: tuple[str, ...], _: str
) -> Plan:
    """Return the plan of this process; the last argument tells contents of files apart."""
    return prepare(parse_study(path, text, located), pins=pins, cases=cases)

"""Pins sized on an existing cluster, each by one worker."""

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
class ClusterSizing:
    """All data that a worker needs to size pins of a study, as text where possible.

    files: hash of the sent contents of the files that the study names; empty if the files are read
    from this machine.
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
        """All data on which the plan depends."""
        return self.path, self.text, self.located, self.pins, self.cases, self.files

    @classmethod
    def of(cls, plan: Plan, goal: SizingGoal) -> ClusterSizing:
        """Return the problem of a plan's pins, with an absolute path of the study."""
        study = plan.study
        place = study.path.absolute(), study.text, study.located
        return cls(*place, goal, plan.pins, tuple(plan.loads))


@dataclass(frozen=True)
class PinTask:
    """A pin to be sized. number: its number among the pins to be sized.

    scales: the scales of the pins so far, by name.
    """

    number: int
    pin: str
    scales: tuple[tuple[str, float], ...]


class PinQueue:
    """The queue of pins to be sized, a pinstress.explore.sweep.scheduler.WorkQueue."""

    def __init__(self, pins: Sequence[PinTask], done: Done, progress: Progress) -> None:
        self._left, self._done, self._progress = list(reversed(pins)), done, progress
        self._running: dict[int, str] = {}
        self._count = len(pins)

    def spread_over(self, workers: int) -> None:
        """Do nothing, because a pin cannot be divided."""

    def take(self) -> PinTask | None:
        """Return the next pin; None if there is none."""
        if not self._left:
            return None
        task = self._left.pop()
        self._running[task.number] = task.pin
        self._tell()
        return task

    def done(self, done: tuple[int, SizingResult]) -> None:
        """Keep the result of a pin."""
        self._end(*done)

    def died(self, item: PinTask) -> None:
        """Give up a pin whose worker died."""
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
    problem: ClusterSizing,
    pins: Sequence[str],
    scales: Mapping[str, float],
    done: Done,
    progress: Progress,
) -> None:
    """Size pins on a cluster.

    scales: the scales of the pins so far, by name. done: called with the number of each pin and its
    result.

    Raises: InputError if the connection to the cluster is lost.
    """
    with noted_files() as files:
        _plan.__wrapped__(*problem.planned)
    known = tuple(scales.items())
    work = PinQueue([PinTask(k, pin, known) for k, pin in enumerate(pins)], done, progress)
    solve_on(cluster, problem, tuple(sorted(files)), work, size_there)


def size_there(problem: ClusterSizing, task: PinTask) -> tuple[int, SizingResult]:
    """Size a pin in a worker, and return its number and result."""
    with one_solver():
        plan = _plan(*problem.planned)
        return task.number, size_pin(plan, task.pin, problem.goal, dict(task.scales))


@lru_cache(1)
def _plan(
    path: Path, text: str, located: bool, pins: tuple[str, ...], cases: tuple[str, ...], _: str
) -> Plan:
    """Return the plan of this process; the last argument, a hash, only distinguishes the contents
    of files.
    """
    return prepare(parse_study(path, text, located), pins=pins, cases=cases)

"""One rung of the ladder of models in a process of its own: its time, and the memory it takes."""

from __future__ import annotations

import gc
import math
import os
import re
import statistics
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from fea.core.mesh_result import MeshMaximum
from fea.solve.single_mesh import Problem, Rung, result_on
from pinbase.processes.apart import Failed, guarded
from pinbase.processes.pool import Job, Tell
from pinstress.explore.chart.single_joint import JointProblem, JointRung, joint_result_on

MIN_MEASURED_MEMORY = 0.1  # MB: less cannot be distinguished from the libraries' own


@dataclass(frozen=True)
class MeasureLimits:
    """seconds: of a process in all. memory: of a process above its libraries, MB."""

    seconds: float = 120.0
    memory: float = 4000.0


@dataclass(frozen=True)
class Measured:
    """result: what the mesh says, None where it `failed`, for that reason. seconds: the median of
    the runs, each from the mesh to the maximum over the motion, without the start of the
    interpreter and imports. memory: the largest during the first run above the process with its
    libraries loaded, MB; bare: that process, MB. over: it failed because it passed a limit, as
    finer meshes would.
    """

    result: MeshMaximum | None
    seconds: float = 0.0
    memory: float = 0.0
    bare: float = 0.0
    failed: str = ""
    over: bool = False


@dataclass(frozen=True)
class MeasureJob:
    """A rung of its problem to be climbed, with mesh results `before` (fea.solve.single_mesh), so
    many times. reference: whatever time it takes.
    """

    problem: Problem | JointProblem
    rung: Rung | JointRung
    before: tuple[MeshMaximum, ...] = ()
    runs: int = 1
    reference: bool = False


Measure = Callable[[MeasureJob], Measured]


def measure(job: MeasureJob, limits: MeasureLimits) -> Measured:
    """Climb a rung in its own process, a new Python, which is ended when it passes a limit."""
    seconds = math.inf if job.reference else limits.seconds
    start, passed = time.monotonic(), ""

    def watch(pid: int, told: str) -> str:
        nonlocal passed
        if time.monotonic() - start > seconds:
            passed = f"exceeded the limit of {seconds:g} s"
        elif told.isdecimal() and memory(pid, "VmRSS") > int(told) + limits.memory:
            passed = f"exceeded the limit of {limits.memory:g} MB"
        return passed

    (made,) = guarded([Job("mesh", partial(climb, job))], anew=True, watch=watch)
    return (
        Measured(None, failed=made.reason, over=bool(passed)) if isinstance(made, Failed) else made
    )


def memory(pid: int | str, what: str) -> float:
    """Of a process, MB: "VmRSS", what it holds now, or "VmHWM", the most it ever held."""
    try:
        found = re.search(rf"{what}:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())
    except OSError:  # it has ended
        found = None
    return float(found[1]) / 1024.0 if found else 0.0


def climb(job: MeasureJob, tell: Tell) -> Measured:
    """Climb a rung here and now; for a process that does nothing else. tell: called with its memory
    before, MB.
    """
    os.setsid()  # so that programs that it runs are ended with it
    with suppress(ImportError):  # none of their time and memory is the model's
        import gmsh  # noqa: F401
        import pymetis  # noqa: F401
        from cvxopt import cholmod  # noqa: F401
    gc.collect()
    bare, spent, peak = memory("self", "VmRSS"), [], 0.0
    tell(f"{bare:.0f}")
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")  # forgets what imports took for a moment
    for run in range(job.runs):
        start = time.perf_counter()
        found = _result(job)
        spent.append(time.perf_counter() - start)
        if run == 0:
            import resource  # Linux has it

            others = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
            result, peak = found, memory("self", "VmHWM") + others
    return Measured(result, statistics.median(spent), max(peak - bare, MIN_MEASURED_MEMORY), bare)


def _result(job: MeasureJob) -> MeshMaximum:
    if isinstance(job.problem, JointProblem):
        assert isinstance(job.rung, JointRung)
        return joint_result_on(job.problem, job.rung, job.before)
    assert isinstance(job.rung, Rung)
    return result_on(job.problem, job.rung, job.before)

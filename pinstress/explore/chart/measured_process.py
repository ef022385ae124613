"""Solving one mesh of a model in a process of its own, to measure its time and memory."""

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
from fea.solve.single_mesh import ModelMesh, Problem, result_on
from pinbase.processes.apart import Failed, guarded
from pinbase.processes.pool import Job, Tell
from pinstress.explore.chart.single_joint import JointProblem, JointRung, joint_result_on

MIN_MEASURED_MEMORY = 0.1  # MB: less cannot be distinguished from the libraries' own


@dataclass(frozen=True)
class MeasureLimits:
    """The limits on a measurement.

    seconds: total time of a process, s.
    memory: memory of a process in addition to its libraries, MB.
    """

    seconds: float = 120.0
    memory: float = 4000.0


@dataclass(frozen=True)
class Measured:
    """A measured solution.

    result: maximum on the mesh; None if the solution failed, for the reason `failed`.
    seconds: the median time of the runs, s, from the mesh to the maximum over the motion, without
    the start of the interpreter and imports.
    memory: the largest memory during the first run, in addition to `bare`, MB.
    bare: memory of the process with its libraries loaded, MB.
    over: whether the solution failed because it exceeded a limit; finer meshes would, too.
    """

    result: MeshMaximum | None
    seconds: float = 0.0
    memory: float = 0.0
    bare: float = 0.0
    failed: str = ""
    over: bool = False


@dataclass(frozen=True)
class MeasureJob:
    """A mesh of a model to be solved `runs` times.

    before: results on coarser meshes (fea.solve.single_mesh).
    reference: whether the time is not limited.
    """

    problem: Problem | JointProblem
    rung: ModelMesh | JointRung
    before: tuple[MeshMaximum, ...] = ()
    runs: int = 1
    reference: bool = False


Measure = Callable[[MeasureJob], Measured]


def measure(job: MeasureJob, limits: MeasureLimits) -> Measured:
    """Solve a mesh in a new Python process, which is ended when it exceeds a limit."""
    seconds = math.inf if job.reference else limits.seconds
    start, passed = time.monotonic(), ""

    def watch(pid: int, report: str) -> str:
        nonlocal passed
        if time.monotonic() - start > seconds:
            passed = f"exceeded the limit of {seconds:g} s"
        elif report.isdecimal() and memory(pid, "VmRSS") > int(report) + limits.memory:
            passed = f"exceeded the limit of {limits.memory:g} MB"
        return passed

    (outcome,) = guarded([Job("mesh", partial(climb, job))], anew=True, watch=watch)
    return (
        Measured(None, failed=outcome.reason, over=bool(passed))
        if isinstance(outcome, Failed)
        else outcome
    )


def memory(pid: int | str, what: str) -> float:
    """Return the memory of a process, MB.

    what: "VmRSS" for the present memory, "VmHWM" for the largest so far.
    """
    try:
        match = re.search(rf"{what}:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())
    except OSError:  # it has ended
        match = None
    return float(match[1]) / 1024.0 if match else 0.0


def climb(job: MeasureJob, tell: Tell) -> Measured:
    """Solve a mesh in this process, which must do nothing else.

    tell: called with the memory of the process before the solution, MB.
    """
    os.setsid()  # so that programs started by this process are ended with it
    with suppress(ImportError):  # imported here, because their time and memory must not count
        import gmsh  # noqa: F401
        import pymetis  # noqa: F401
        from cvxopt import cholmod  # noqa: F401
    gc.collect()
    bare, spent, peak = memory("self", "VmRSS"), [], 0.0
    tell(f"{bare:.0f}")
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")  # resets the peak, which imports raised
    for run in range(job.runs):
        start = time.perf_counter()
        maximum = _result(job)
        spent.append(time.perf_counter() - start)
        if run == 0:
            import resource  # Linux has it

            others = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
            result, peak = maximum, memory("self", "VmHWM") + others
    return Measured(result, statistics.median(spent), max(peak - bare, MIN_MEASURED_MEMORY), bare)


def _result(job: MeasureJob) -> MeshMaximum:
    if isinstance(job.problem, JointProblem):
        assert isinstance(job.rung, JointRung)
        return joint_result_on(job.problem, job.rung, job.before)
    assert isinstance(job.rung, ModelMesh)
    return result_on(job.problem, job.rung, job.before)

"""One rung of the ladder of models in a process of its own: its time, and the memory it takes."""

from __future__ import annotations

import gc
import math
import os
import pickle
import re
import signal
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from assess.opinion.calculix import CalculixError
from fea.core.mesh_result import MeshMaximum
from fea.solve.single_mesh import Problem, Rung, result_on
from pinbase.processes.current_folder import trusting_python
from pinstress.explore.chart.single_joint import JointProblem, JointRung, joint_result_on

MEMORY_POLL_INTERVAL = 0.02  # s between two readings
CHILD_CODE = (
    "import sys; from pinstress.explore.chart.measured_process import serve; serve(sys.argv[1])"
)
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
    """Climb a rung in its own process, which is ended when it passes a limit."""
    if job.reference:
        limits = replace(limits, seconds=math.inf)
    with tempfile.TemporaryDirectory(prefix="pinstress-") as folder:
        place = Path(folder)
        (place / "job").write_bytes(pickle.dumps(job))
        command, environment = trusting_python(CHILD_CODE, folder)
        with (place / "messages").open("wb") as messages:
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=messages,
                stderr=messages,
                env=environment,
                start_new_session=True,  # an interrupt is for us; we end it
            )
        try:
            passed = _watch(process, limits, place)
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)  # with the programs that it runs
            process.wait()
        if passed:
            return Measured(None, failed=passed, over=True)
        with suppress(OSError, EOFError):
            found: Measured = pickle.loads((place / "result").read_bytes())
            return found
        printed = (place / "messages").read_text(errors="replace").strip().splitlines()
        last = f" ({printed[-1]})" if printed else ""
        return Measured(None, failed=f"its process ended with status {process.returncode}{last}")


def _watch(process: subprocess.Popen[bytes], limits: MeasureLimits, place: Path) -> str:
    """Wait for a process; what limit it passed, if any."""
    start = time.monotonic()
    while process.poll() is None:
        if time.monotonic() - start > limits.seconds:
            return f"exceeded the limit of {limits.seconds:g} s"
        if (place / "bare").exists() and memory(process.pid, "VmRSS") > limits.memory + float(
            (place / "bare").read_text() or 0.0
        ):
            return f"exceeded the limit of {limits.memory:g} MB"
        time.sleep(MEMORY_POLL_INTERVAL)
    return ""


def memory(pid: int | str, what: str) -> float:
    """Of a process, MB: "VmRSS", what it holds now, or "VmHWM", the most it ever held."""
    try:
        found = re.search(rf"{what}:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())
    except OSError:  # it has ended
        found = None
    return float(found[1]) / 1024.0 if found else 0.0


def climb(job: MeasureJob) -> Measured:
    """Climb a rung here and now; for a process that does nothing else."""
    with suppress(ImportError):  # none of their time and memory is the model's
        import gmsh  # noqa: F401
        import pymetis  # noqa: F401
        from cvxopt import cholmod  # noqa: F401
    gc.collect()
    bare, spent, peak = memory("self", "VmRSS"), [], 0.0
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


def serve(folder: str) -> None:
    """What the process does: a job read from a folder, the result left there."""
    place = Path(folder)
    job = pickle.loads((place / "job").read_bytes())
    (place / "bare").write_text(str(memory("self", "VmRSS")))
    try:
        found = climb(job)
    except MemoryError:
        found = Measured(None, failed="out of memory")
    except (
        ArithmeticError,
        CalculixError,
        ValueError,
    ) as error:  # MeshError, SolveError; what cannot be asked
        found = Measured(None, failed=str(error))
    (place / "result").write_bytes(pickle.dumps(found))

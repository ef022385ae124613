"""CalculiX and our own solver, each in its own process, and what CalculiX writes."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

COMMAND = "ccx"
THREADS = 2
JOB = "job"
FRD_TO_OURS = [0, 1, 2, 4, 5, 3]  # xx, yy, zz, xy, yz, zx there; xx, yy, zz, yz, xz, xy here

# Linux counts the largest memory of a child from before it starts its program, when it still has
# its parent's: so the parent must be small. Ends stderr with seconds of wall time and of processor
# time, and kB.
PROBE = """
import resource, subprocess, sys, time
start = time.perf_counter()
status = subprocess.run(sys.argv[1:]).returncode
spent = time.perf_counter() - start
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(f"\\n{spent} {used.ru_utime + used.ru_stime} {used.ru_maxrss}", file=sys.stderr)
sys.exit(status)
"""


class RunError(RuntimeError):
    """A process failed; the message has the end of what it printed."""


@dataclass(frozen=True)
class Process:
    """A finished process. seconds: wall time; processor: time on all cores, s; megabytes: its
    largest memory.
    """

    output: str
    seconds: float
    processor: float
    megabytes: float


def process(arguments: list[str], folder: Path) -> Process:
    """Run a command in a folder, on two threads.

    Raises: RunError when its status is not 0.
    """
    done = subprocess.run(
        [sys.executable, "-I", "-c", PROBE, *arguments],
        cwd=folder,
        env=os.environ | {"OMP_NUM_THREADS": str(THREADS)},
        capture_output=True,
        text=True,
    )
    if done.returncode:
        said = (done.stdout + done.stderr).strip()[-1000:]
        raise RunError(f"{arguments[0]} ended with status {done.returncode}:\n{said}")
    spent, processor, memory = map(float, done.stderr.split()[-3:])
    return Process(done.stdout, spent, processor, memory / 1024.0)


@dataclass(frozen=True)
class Solved:
    """What CalculiX found: displacement (N, 3), m; stress (N, 6), Pa, extrapolated to the nodes and
    averaged there: xx, yy, zz, yz, xz, xy. own_seconds: the time that it prints.
    """

    displacement: Floats
    stress: Floats
    process: Process
    own_seconds: float


def run(folder: Path) -> Solved:
    """Run CalculiX on the deck JOB.inp in a folder.

    Raises: RunError when it fails; CalculiX's own status is 0 after many of its errors.
    """
    done = process([COMMAND, "-i", JOB], folder)
    time = re.search(r"Total CalculiX Time:\s*(\S+)", done.output)
    if "*ERROR" in done.output or time is None:
        raise RunError(f"{COMMAND} failed:\n{done.output.strip()[-1000:]}")
    return Solved(
        displacements(folder / f"{JOB}.dat"),
        stresses(folder / f"{JOB}.frd"),
        done,
        float(time[1]),
    )


def displacements(dat: Path) -> Floats:
    """Displacements (N, 3) of all nodes from a .dat file, which has 7 digits (.frd has 6)."""
    lines = dat.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if "displacements" in line) + 2
    return np.loadtxt(lines[first:], usecols=(1, 2, 3), ndmin=2)


def stresses(frd: Path) -> Floats:
    """Stresses (N, 6) at all nodes from a .frd file."""
    lines = frd.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith(" -4  STRESS"))
    rows = []
    for line in lines[first + 1 :]:
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):  # then the node in 10 columns and six numbers of 12
            rows.append([float(line[i : i + 12]) for i in range(13, 85, 12)])
    return np.array(rows)[:, FRD_TO_OURS]

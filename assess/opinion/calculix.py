"""CalculiX, another finite-element program: run it on a deck, read its results."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geometry import CodedError
from pinbase.arrays import Floats

CALCULIX_COMMAND = "ccx"
JOB_NAME = "job"
INSTALL_HINT = "on Debian and Ubuntu: sudo apt-get install --no-install-recommends calculix-ccx"
FRD_TO_VOIGT = [
    0,
    1,
    2,
    4,
    5,
    3,
]  # from CalculiX's xx, yy, zz, xy, yz, zx to xx, yy, zz, yz, xz, xy


class CalculixError(CodedError, RuntimeError):
    """The error that CalculiX failed; the message has the relevant part of its output."""


@dataclass(frozen=True)
class CalculixSolution:
    """The results of CalculiX.

    displacement: (N, 3) m. stress: (N, 6) Pa, extrapolated to the nodes and averaged there: xx, yy,
    zz, yz, xz, xy.
    """

    displacement: Floats
    stress: Floats


def installed() -> bool:
    """Whether CalculiX is installed."""
    return shutil.which(CALCULIX_COMMAND) is not None


def run(folder: Path) -> str:
    """Run CalculiX on the deck JOB_NAME.inp in a folder and return its output.

    Raises: CalculixError if it cannot be run or ends with an error status.
    """
    done = attempt(folder)
    if done.returncode:
        raise CalculixError(
            f"{CALCULIX_COMMAND} ended with status {done.returncode}: "
            f"{end(done.stdout + done.stderr)}",
            "failed",
        )
    return done.stdout


def attempt(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run CalculiX as `run` does, on a job that may fail.

    Raises: CalculixError if it cannot run.
    """
    threads = {"OMP_NUM_THREADS": str(os.cpu_count() or 1)}
    try:
        return subprocess.run(
            [CALCULIX_COMMAND, "-i", JOB_NAME],
            cwd=folder,
            env=threads | os.environ,
            capture_output=True,
            text=True,
            errors="replace",
        )
    except OSError as error:
        raise CalculixError(
            f"{CALCULIX_COMMAND} cannot be run ({error.strerror}); {INSTALL_HINT}", "not-installed"
        ) from None


def solved(folder: Path, printed: str) -> CalculixSolution:
    """Return the results of a run, given its printed output.

    Raises: CalculixError if the run failed. The exit status is not enough, because CalculiX ends
    with status 0 after many of its errors.
    """
    seconds_of(printed)
    try:
        results = CalculixSolution(
            displacements(folder / f"{JOB_NAME}.dat"), stresses(folder / f"{JOB_NAME}.frd")
        )
    except (OSError, ValueError, IndexError, StopIteration) as error:
        raise CalculixError(
            f"{CALCULIX_COMMAND} wrote no readable results ({error})", "unreadable-results"
        ) from None
    if not (np.isfinite(results.displacement).all() and np.isfinite(results.stress).all()):
        raise CalculixError(f"the results of {CALCULIX_COMMAND} are not finite", "not-finite")
    return results


def seconds_of(printed: str) -> float:
    """Return the run time that CalculiX reports, s.

    Raises: CalculixError if the output reports an error or no run time.
    """
    time = re.search(r"Total CalculiX Time:\s*(\S+)", printed)
    if "*ERROR" in printed or time is None:
        raise CalculixError(f"{CALCULIX_COMMAND} failed: {end(printed)}", "failed")
    return float(time[1])


def end(printed: str) -> str:
    """Return the output of a program on one line: 500 characters from its first error on, or its
    last 500 characters.
    """
    words = " ".join(printed.split())
    first = words.find("*ERROR")
    return words[first:][:500] if first >= 0 else words[-500:]


def displacements(dat: Path) -> Floats:
    """Return the displacements (N, 3) of all nodes from a .dat file, which has 7 digits (a .frd
    file has 6).
    """
    lines = dat.read_text("ascii", "replace").splitlines()
    first = next(i for i, line in enumerate(lines) if "displacements" in line) + 2
    return np.loadtxt(lines[first:], usecols=(1, 2, 3), ndmin=2)


def stresses(frd: Path) -> Floats:
    """Return the stresses (N, 6) at all nodes from a .frd file."""
    lines = frd.read_text("ascii", "replace").splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith(" -4  STRESS"))
    rows = []
    for line in lines[first + 1 :]:
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):  # then the node in 10 columns and six numbers of 12
            rows.append([float(line[i : i + 12]) for i in range(13, 85, 12)])
    return np.array(rows)[:, FRD_TO_VOIGT]

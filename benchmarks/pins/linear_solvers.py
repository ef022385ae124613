"""Linear solvers on the solid model's matrix: time and memory of factorising and of two solves.

Every point is measured in a process of its own, which reads the matrix from a file; the memory is
that above the matrix. A point beyond the limits is shown with the reason.
"""

from __future__ import annotations

import json
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from benchmarks.timing import power, table
from fea.core.linear_solver import Solve
from pinbase.arrays import Floats
from reports.format.numbers import engineering

Ints = NDArray[np.int64]
Point = tuple[float, float] | str  # s and MB, or the reason of a failure

ACROSS = (6.3, 8.0, 11.0, 18.0)  # elements over the shaft
SECONDS, GIGABYTES, ABREAST = 120.0, 12.0, 2
PATIENCE = SECONDS + 10.0  # includes the start of a process and the reading of the matrix
OVER = f"over {SECONDS:.0f} s"
NAMES = {
    "cholmod": "CHOLMOD, nested dissection",
    "multigrid": "smoothed aggregation + CG",
    "superlu": "SuperLU, minimum degree",
    "pardiso": "PARDISO (MKL)",
}
_RIGHT_HAND_SIDES = 2


def linear_solvers() -> str:
    """Return the table of times and memories by unknowns, and of the powers with which
    they grow.
    """
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(ABREAST) as pool:
        files = [Path(folder) / f"{across:g}.npz" for across in ACROSS]
        counts = list(pool.map(_matrix_file, ACROSS, files))
        found = dict(zip(NAMES, pool.map(partial(_row, counts, files), NAMES), strict=True))
    return "\n\n".join(
        (
            f"Factoring and {_RIGHT_HAND_SIDES} right-hand sides, s (MB above the matrix); "
            f"limits {SECONDS:.0f} s and {GIGABYTES:.0f} GB; cases expected to take half as much "
            f"again from the two before are not run; {ABREAST} at a time, one thread each:",
            table(
                ("unknowns", *(f"{n:,}" for n in counts), "time ~", "memory ~"),
                [
                    (NAMES[name], *map(_cell, row), *_growth(counts, row))
                    for name, row in found.items()
                ],
            ),
        )
    )


def _matrix_file(across: float, file: Path) -> int:
    """Write a matrix; return its number of unknowns."""
    return int(_child("matrix", str(across), str(file))["unknowns"])


def _row(counts: list[int], files: list[Path], name: str) -> list[Point]:
    """Return the points of one solver, from the smallest matrix to the largest."""
    row: list[Point] = []
    for file in files:
        row.append(OVER if _hopeless(counts, row) else _point(name, file))
    return row


def _hopeless(counts: list[int], row: list[Point]) -> bool:
    """Return whether a smaller matrix was over the limit, or the last two points predict half as
    much again.
    """
    if OVER in row:
        return True
    if len(row) < 2 or any(isinstance(point, str) for point in row):
        return False
    n, seconds, _ = np.array([(n, *p) for n, p in zip(counts, row, strict=False)]).T
    step = np.log(counts[len(row)] / n[-1]) / np.log(n[-1] / n[-2])
    return float(seconds[-1] * (seconds[-1] / seconds[-2]) ** step) > 1.5 * SECONDS


def _cell(point: Point) -> str:
    return point if isinstance(point, str) else f"{engineering(point[0], 2)} ({point[1]:.0f})"


def _growth(counts: list[int], row: list[Point]) -> tuple[str, str]:
    done = [(n, *p) for n, p in zip(counts, row, strict=True) if not isinstance(p, str)]
    if len(done) < 2:
        return "", ""
    n, seconds, memory = np.array(done).T
    return f"n^{power(n, seconds):.2f}", f"n^{power(n, memory):.2f}"


def _point(name: str, file: Path) -> Point:
    try:
        found = _child("solve", name, str(file))
    except subprocess.TimeoutExpired:
        return OVER
    except subprocess.CalledProcessError as error:
        last = error.stderr.strip().splitlines()[-1:] or [f"status {error.returncode}"]
        missing = re.search(r"No module named '(\w+)'", last[0])
        return f"{missing[1]} not installed" if missing else last[0][:60]
    return found["seconds"], found["megabytes"]


def _child(*arguments: str) -> dict[str, float]:
    command = [sys.executable, "-m", "benchmarks.pins.linear_solvers", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=PATIENCE)
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found


def _matrix(across: float, file: Path) -> dict[str, float]:
    """Write the matrix of a cantilever with a fillet, and the nodes of its unknowns; return the
    number of unknowns.
    """
    from benchmarks.runs.speed import PIN, STEEL
    from fea.solid.assembly import Discretisation
    from fea.solid.boundary import clamped_nodes
    from geometry.mesh.solid_mesh import MeshSize, solid_mesh

    space = Discretisation(solid_mesh(PIN, MeshSize(across, arc=1.5)).mesh)
    fixed = (3 * clamped_nodes(space, ("start",))[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(space.unknowns), fixed)
    K = space.stiffness(STEEL)[free][:, free]
    np.savez(file, data=K.data, indices=K.indices, indptr=K.indptr, free=free, nodes=space.nodes)
    return {"unknowns": len(free)}


def _solve(name: str, file: Path) -> dict[str, float]:
    resource.setrlimit(resource.RLIMIT_AS, (int(GIGABYTES * 2**30),) * 2)
    resource.setrlimit(resource.RLIMIT_CPU, (int(2 * SECONDS),) * 2)
    with np.load(file) as stored:
        K = sp.csr_matrix((stored["data"], stored["indices"], stored["indptr"]))
        free, nodes = stored["free"], stored["nodes"]
    b = np.random.default_rng(0).standard_normal((len(free), _RIGHT_HAND_SIDES))
    factor = SOLVERS[name](K, free, nodes)
    before = _memory("VmRSS")
    Path("/proc/self/clear_refs").write_text("5")  # resets the peak memory
    start = time.perf_counter()
    x = factor()(b)
    spent = time.perf_counter() - start
    largest = _memory("VmHWM")
    residual = np.linalg.norm(K @ x - b) / np.linalg.norm(b)
    if not residual < 1e-6:
        raise ArithmeticError(f"residual {residual:.0e}")
    return {"seconds": spent, "megabytes": largest - before}


def _memory(key: str) -> float:
    """Return the memory of this process, MB, from Linux's status file."""
    status = Path("/proc/self/status").read_text()
    return float(re.findall(rf"{key}:\s*(\d+)", status)[0]) / 1024.0


Make = Callable[[sp.csr_matrix, Ints, Floats], Callable[[], Solve]]


def _cholmod(K: sp.csr_matrix, free: Ints, nodes: Floats) -> Callable[[], Solve]:
    import cvxopt.cholmod  # noqa: F401, so that imports are not timed
    import pymetis  # noqa: F401

    from fea.core.linear_solver import factorize

    return lambda: factorize(K, free // 3)


def _superlu(K: sp.csr_matrix, free: Ints, nodes: Floats) -> Callable[[], Solve]:
    from fea.core.linear_solver import _superlu

    return lambda: _superlu(K)


def _pardiso(K: sp.csr_matrix, free: Ints, nodes: Floats) -> Callable[[], Solve]:
    from pypardiso import PyPardisoSolver

    def factor() -> Solve:
        solver = PyPardisoSolver(mtype=2)
        upper = sp.triu(K, format="csr")
        return lambda b: np.asarray(solver.solve(upper, np.asfortranarray(b)))

    return factor


def _multigrid(K: sp.csr_matrix, free: Ints, nodes: Floats) -> Callable[[], Solve]:
    import pyamg

    from fea.solid.model import rigid_modes

    motions = rigid_modes(nodes - nodes.mean(axis=0))[free]

    def factor() -> Solve:
        levels = pyamg.smoothed_aggregation_solver(K.tobsr((3, 3)), B=motions)

        def solve(b: Floats) -> Floats:
            columns = [levels.solve(column, tol=1e-8, accel="cg", maxiter=300) for column in b.T]
            return np.stack(columns, axis=1)

        return solve

    return factor


SOLVERS: dict[str, Make] = {
    "cholmod": _cholmod,
    "superlu": _superlu,
    "pardiso": _pardiso,
    "multigrid": _multigrid,
}

if __name__ == "__main__":
    what, name, path = sys.argv[1:]
    found = _matrix(float(name), Path(path)) if what == "matrix" else _solve(name, Path(path))
    print(json.dumps(found))

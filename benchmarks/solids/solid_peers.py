"""Code shared by the comparisons of the solid model with other programs: meshes, our side, tables
of ratios.
"""

from __future__ import annotations

import pickle
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from skfem import MeshTet2

from benchmarks import ROOT
from benchmarks.processes import THREADS, Process, process
from benchmarks.solids.calculix_ours import PIN, Ours
from benchmarks.timing import table
from geometry.mesh.solid_mesh import MeshSize, solid_mesh

COARSE = MeshSize(across=3.8, arc=1.9)
FINER = (0.83, 1.4, 2.05)  # about 2e4, 6e4 and 1.5e5 unknowns
SOLVE = """
from pathlib import Path
from benchmarks.solids.calculix_ours import main
main(Path({!r}), Path({!r}))
"""


@dataclass(frozen=True)
class Cost:
    """The cost of both programs on a mesh, each ours and theirs.

    seconds: wall time from the bare mesh, s.
    processor, megabytes: processor time on all cores, s, and memory, MB, of the whole processes.
    """

    unknowns: int
    seconds: tuple[float, float]
    processor: tuple[float, float]
    megabytes: tuple[float, float]


def cost(unknowns: int, seconds: tuple[float, float], ours: Process, theirs: Process) -> Cost:
    """Return the cost of two processes."""
    return Cost(
        unknowns,
        seconds,
        (ours.processor, theirs.processor),
        (ours.megabytes, theirs.megabytes),
    )


@contextmanager
def bare_mesh(factor: float) -> Iterator[tuple[MeshTet2, Path]]:
    """Yield a mesh without cached results, and a folder with the mesh as file `mesh`."""
    mesh = solid_mesh(PIN, COARSE.finer(factor)).mesh
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "mesh").write_bytes(pickle.dumps(mesh))  # before any use, which caches results
        yield mesh, folder


def solved_by_us(folder: Path) -> tuple[Ours, Process]:
    """Return our solution on the file `mesh`, computed in its own process.

    Raises: RunError.
    """
    given, found = folder / "mesh", folder / "ours"
    ours = process([sys.executable, "-c", SOLVE.format(str(given), str(found))], ROOT)
    return pickle.loads(found.read_bytes()), ours


def ratios(name: str, costs: list[Cost]) -> str:
    """Return the table of time and memory, and a sentence on where ours takes more."""
    head = ["unknowns"]
    for what in ("time, s", "all cores, s", "memory, MB"):
        head += [f"{what}: ours", name, "ours / theirs"]
    rows, lost = [], []
    for c in costs:
        row: list[object] = [c.unknowns]
        for what, (ours, theirs) in (
            ("time", c.seconds),
            ("time on all cores", c.processor),
            ("memory", c.megabytes),
        ):
            digits = 0 if what == "memory" else 1
            row += [f"{ours:.{digits}f}", f"{theirs:.{digits}f}", f"{ours / theirs:.2f}"]
            if ours > theirs:
                lost.append(f"{what} at {c.unknowns} unknowns ({ours / theirs:.2f})")
        rows.append(tuple(row))
    told = f"Where ours takes more: {'; '.join(lost)}." if lost else "Ours takes less everywhere."
    return f"{table(tuple(head), rows)}\n\n{told} Both may use {THREADS} threads."

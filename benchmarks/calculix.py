"""The solid model beside CalculiX (C3D10, SPOOLES) on the same meshes, nodal forces and supports.

Both integrate with the same four points, so displacements agree but for the digits that CalculiX
prints. Its stresses at the nodes are averages of extrapolated values; ours are then corrected on
the surface to carry the known traction.
"""

from __future__ import annotations

import pickle
import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.calculix_deck import write_deck
from benchmarks.calculix_ours import FILLET, PIN, STEEL, Floats, Ints, Loaded, Ours
from benchmarks.calculix_run import COMMAND, JOB, Process, Solved, process, run
from benchmarks.timing import table
from fea.tensor import von_mises
from geometry.solid_mesh import MeshSize, solid_mesh

MISSING = "CalculiX is not installed (no ccx): apt-get install calculix-ccx"
ROOT = Path(__file__).parent.parent
COARSE = MeshSize(across=3.8, arc=1.9)
SOLVE = """
from pathlib import Path
from benchmarks.calculix_ours import main
main(Path({!r}), Path({!r}))
"""
FINER = (1.0, 1.65, 2.24)  # about 30,000, 90,000 and 190,000 unknowns


@dataclass(frozen=True)
class Pair:
    """Both solutions on one mesh; fillet: its nodes."""

    fillet: Ints
    ours: Ours
    process: Process
    theirs: Solved

    @property
    def unknowns(self) -> int:
        """Displacement components, held ones included."""
        return self.ours.displacement.size

    @property
    def difference(self) -> float:
        """Largest difference of displacements, relative to the largest displacement."""
        mine, other = self.ours.displacement, self.theirs.displacement
        return float(np.abs(mine - other).max() / np.abs(mine).max())

    def peak(self, stress: Floats) -> float:
        """Largest von Mises stress (Pa) of a stress (N, 6) at the nodes of the fillet."""
        return float(von_mises(stress[self.fillet]).max())


def calculix() -> str:
    """Agreement, time and memory of both on three meshes of a shoulder fillet in bending."""
    if shutil.which(COMMAND) is None:
        return MISSING
    pairs = [pair(COARSE.finer(factor)) for factor in FINER]
    return "\n\n".join(
        (
            "Largest difference of displacements, relative to the largest; peaks of von Mises "
            "stress at the fillet, MPa:",
            table(AGREEMENT, map(_agreement, pairs)),
            "Ours from the bare mesh on; CalculiX's whole run, of which reading and writing are a "
            "small part. The ratio is CalculiX's run to ours with stresses:",
            table(TIME, map(_time, pairs)),
            "Whole processes, ours with Python's start and its libraries: time on all cores (which "
            "other work on the machine disturbs less) and largest memory:",
            table(WHOLE, map(_whole, pairs)),
        )
    )


AGREEMENT = ("unknowns", "displacements", "our peak", "ours, averaged only", "CalculiX's peak")
TIME = ("unknowns", "assembly + solve, s", "with stresses, s", "CalculiX, s", "its clock", "ratio")
WHOLE = ("unknowns", "ours, s", "CalculiX, s", "ratio", "ours, MB", "CalculiX, MB", "ratio")


def _agreement(p: Pair) -> tuple[object, ...]:
    stresses = (p.ours.stress, p.ours.averaged, p.theirs.stress)
    return p.unknowns, p.difference, *(f"{p.peak(s) / 1e6:.5g}" for s in stresses)


def _time(p: Pair) -> tuple[object, ...]:
    ours, theirs = p.ours, p.theirs
    ratio = theirs.process.seconds / ours.to_stress
    run_and_clock = theirs.process.seconds, theirs.own_seconds
    return p.unknowns, ours.to_displacement, ours.to_stress, *run_and_clock, ratio


def _whole(p: Pair) -> tuple[object, ...]:
    ours, theirs = p.process, p.theirs.process
    return (
        p.unknowns,
        ours.processor,
        theirs.processor,
        theirs.processor / ours.processor,
        round(ours.megabytes),
        round(theirs.megabytes),
        theirs.megabytes / ours.megabytes,
    )


def pair(size: MeshSize) -> Pair:
    """Both solutions on a mesh of the given size, one after the other.

    Raises: RunError when a process fails.
    """
    mesh = solid_mesh(PIN, size).mesh
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        given, found = folder / "mesh", folder / "ours"
        given.write_bytes(pickle.dumps(mesh))  # before Loaded, which leaves results in the mesh
        pin = Loaded(mesh)
        space, boundary = pin.space, pin.boundary
        deck = folder / f"{JOB}.inp"
        write_deck(deck, space.nodes, space.elements, STEEL, pin.held, pin.forces)
        on_fillet = np.isin(boundary.facets, mesh.boundaries[FILLET])
        ours = process([sys.executable, "-c", SOLVE.format(str(given), str(found))], ROOT)
        return Pair(
            np.unique(boundary.corners[on_fillet]),
            pickle.loads(found.read_bytes()),
            ours,
            run(folder),
        )

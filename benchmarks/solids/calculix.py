"""The solid model and CalculiX (C3D10, SPOOLES) on the same meshes, with the same nodal forces and
supports.

Both integrate with the same four points, so that displacements agree to the digits that CalculiX
prints. CalculiX's stresses at the nodes are averages of extrapolated values; ours are then
corrected on the surface so that they satisfy the known traction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from assess.opinion.calculix import (
    CALCULIX_COMMAND,
    INSTALL_HINT,
    JOB_NAME,
    CalculixSolution,
    installed,
    solved,
)
from assess.opinion.calculix_deck import write_deck
from benchmarks.processes import Process, process
from benchmarks.solids.calculix_ours import FILLET, STEEL, Floats, Ints, Loaded, Ours
from benchmarks.solids.section_beside import beside
from benchmarks.solids.solid_peers import FINER, bare_mesh, cost, ratios, solved_by_us
from benchmarks.timing import table
from fea.core.voigt import von_mises

MISSING = f"CalculiX is not installed (no {CALCULIX_COMMAND}); {INSTALL_HINT}"
AGREEMENT = ("unknowns", "displacements", "our peak", "ours, averaged only", "CalculiX's peak")


@dataclass(frozen=True)
class Pair:
    """Both solutions on one mesh. fillet: the nodes of the fillet."""

    fillet: Ints
    ours: Ours
    process: Process
    theirs: CalculixSolution
    their_process: Process

    @property
    def unknowns(self) -> int:
        """The number of displacement components, held ones included."""
        return self.ours.displacement.size

    @property
    def difference(self) -> float:
        """The largest difference of displacements, relative to the largest displacement."""
        mine, other = self.ours.displacement, self.theirs.displacement
        return float(np.abs(mine - other).max() / np.abs(mine).max())

    def peak(self, stress: Floats) -> float:
        """Return the largest von Mises stress, Pa, of a stress (N, 6) at the nodes of the
        fillet.
        """
        return float(von_mises(stress[self.fillet]).max())


def calculix() -> str:
    """Return agreement, time and memory of both on three meshes of a shoulder fillet in bending."""
    if not installed():
        return MISSING
    pairs = [pair(factor) for factor in FINER]
    costs = [
        cost(
            p.unknowns,
            (p.ours.to_stress, p.their_process.seconds),
            p.process,
            p.their_process,
        )
        for p in pairs
    ]
    return "\n\n".join(
        (
            "Largest difference of displacements, relative to the largest; peaks of von Mises "
            "stress at the fillet, MPa:",
            table(AGREEMENT, map(_agreement, pairs)),
            "Time is wall time, ours from the bare mesh to the stresses, CalculiX's of its whole "
            "run, of which reading and writing are a small part; the other columns are of whole "
            "processes, ours with Python's start and its libraries:",
            ratios("CalculiX", costs),
            "The same peak by the harmonic model; times of solids are without meshing. The last "
            "column is relative to its first mesh that is at least as accurate:",
            beside([row for p in pairs for row in _errors(p)]),
        )
    )


def _errors(p: Pair) -> list[tuple[str, int, float, float]]:
    return [
        ("our solid", p.unknowns, p.peak(p.ours.stress), p.ours.to_stress),
        ("CalculiX", p.unknowns, p.peak(p.theirs.stress), p.their_process.seconds),
    ]


def _agreement(p: Pair) -> tuple[object, ...]:
    stresses = (p.ours.stress, p.ours.averaged, p.theirs.stress)
    return p.unknowns, p.difference, *(f"{p.peak(s) / 1e6:.5g}" for s in stresses)


def pair(factor: float) -> Pair:
    """Return both solutions, computed one after the other, on a mesh `factor` times finer than the
    coarse one.

    Raises: RunError if a process fails, CalculixError if CalculiX does.
    """
    with bare_mesh(factor) as (mesh, folder):
        pin = Loaded(mesh)
        space, boundary = pin.space, pin.boundary
        fixed = (3 * pin.held[:, None] + np.arange(3)).ravel()
        write_deck(
            folder / f"{JOB_NAME}.inp", space.nodes, space.elements, STEEL, fixed, pin.forces
        )
        on_fillet = np.isin(boundary.facets, mesh.boundaries[FILLET])
        ours, process_of_ours = solved_by_us(folder)
        theirs = process([CALCULIX_COMMAND, "-i", JOB_NAME], folder)
        return Pair(
            np.unique(boundary.corners[on_fillet]),
            ours,
            process_of_ours,
            solved(folder, theirs.output),
            theirs,
        )

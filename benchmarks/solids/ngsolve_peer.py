"""The solid model compared with NGSolve (C++, sparse Cholesky) on the same meshes, with the same
forces and supports.

NGSolve solves our curved ten-node tetrahedra and integrates with the same rule, so that
displacements and energy agree to round-off.
"""

from __future__ import annotations

import importlib.util
import pickle
import sys

import numpy as np

from benchmarks import ROOT
from benchmarks.processes import THREADS, Process, process
from benchmarks.solids.calculix_ours import STEEL, Loaded, Ours
from benchmarks.solids.ngsolve_side import Found, Given
from benchmarks.solids.solid_peers import FINER, bare_mesh, cost, ratios, solved_by_us
from benchmarks.timing import table

MISSING = (
    "NGSolve is not installed: .venv/bin/pip install --require-hashes -r requirements-bench.lock"
)
SOLVE = """
from pathlib import Path
from benchmarks.solids.ngsolve_side import main
main(Path({!r}), Path({!r}), {})
"""
MESHES = (*FINER[:2], 1.75)  # on the third mesh of CalculiX, NGSolve would take a minute
AGREEMENT = ("unknowns", "displacements", "energy, ours, J", "energy, difference")


def ngsolve() -> str:
    """Return agreement, time and memory of both on three meshes of a shoulder fillet in bending."""
    if importlib.util.find_spec("ngsolve") is None:
        return MISSING
    agreement, costs, version = [], [], ""
    for factor in MESHES:
        given, ours, mine, theirs, other = pair(factor)
        agreement.append(_agreement(given, ours, theirs))
        seconds = (ours.to_displacement, theirs.seconds)
        costs.append(cost(ours.displacement.size, seconds, mine, other))
        version = theirs.version
    return "\n\n".join(
        (
            f"NGSolve {version}. Largest difference of displacements, relative to the largest, and "
            "of the strain energy, relative to ours:",
            table(AGREEMENT, agreement),
            "Time is wall time of assembly, factorisation and one solution, from the bare mesh in "
            "either program's form on; the other columns are of whole processes, both with "
            "Python's start, ours with stresses:",
            ratios("NGSolve", costs),
        )
    )


def _agreement(given: Given, ours: Ours, theirs: Found) -> tuple[object, ...]:
    u, v = ours.displacement, theirs.displacement
    energy = [0.5 * float((w * given.forces).sum()) for w in (u, v)]
    apart = float(np.abs(u - v).max() / np.abs(u).max())
    return u.size, f"{apart:.1e}", f"{energy[0]:.6g}", f"{energy[1] / energy[0] - 1.0:.1e}"


def pair(factor: float) -> tuple[Given, Ours, Process, Found, Process]:
    """Return both solutions, computed one after the other, on a mesh `factor` times finer than the
    coarse one.

    Raises: RunError if a process fails.
    """
    with bare_mesh(factor) as (mesh, folder):
        pin = Loaded(mesh)
        given = Given(pin.space.nodes, pin.space.elements, pin.held, pin.forces, STEEL.lame)
        ours, mine = solved_by_us(folder)
        asked, found = folder / "given", folder / "theirs"
        asked.write_bytes(pickle.dumps(given))
        other = process([sys.executable, "-c", SOLVE.format(str(asked), str(found), THREADS)], ROOT)
        return given, ours, mine, pickle.loads(found.read_bytes()), other

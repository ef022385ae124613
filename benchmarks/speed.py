"""How long things take, as ratios within one run wherever two ways can be compared."""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from skfem import Basis, ElementTetP2, ElementVector
from skfem.models.elasticity import lame_parameters, linear_elasticity

from benchmarks.timing import seconds, table
from fea import linear
from fea.elasticity import Discretisation
from fea.material import Material
from fea.surface import held_nodes
from geometry import Pin, Segment
from geometry.solid_mesh import MeshSize, solid_mesh
from loads import motion_reactions, move
from pinstress import build, load_study

STUDY = Path(__file__).parent.parent / "studies" / "grenier2008.toml"
STEEL = Material("steel", 2.0e11, 0.3)
PIN = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02, connection="B")), fillet=0.003)


def motion() -> str:
    """Positions to reactions of the landing gear, by number of instants."""
    study = load_study(STUDY)
    linkage, law = build.linkage(study), build.drive(study)
    rows = []
    for n in (21, 201, 2001):
        times = np.linspace(0.0, law.duration, n)
        moved = move(linkage, law, times)
        rows.append(
            (
                n,
                seconds(lambda t=times: move(linkage, law, t)),  # type: ignore[misc]
                seconds(lambda m=moved: motion_reactions("retract", m)),  # type: ignore[misc]
            )
        )
    return table(("instants", "motion, s", "reactions, s"), rows)


def assembly() -> str:
    """Our stiffness matrix beside scikit-fem's forms, same basis and quadrature."""
    rows = []
    for across in (3.0, 6.0):
        space = Discretisation(solid_mesh(PIN, MeshSize(across)).mesh)
        basis = Basis(space.mesh, ElementVector(ElementTetP2()), intorder=2)
        form = linear_elasticity(*lame_parameters(STEEL.youngs_modulus, STEEL.poisson_ratio))
        ours = seconds(lambda s=space: s.stiffness(STEEL))  # type: ignore[misc]
        theirs = seconds(lambda b=basis: form.assemble(b), 1)  # type: ignore[misc]
        rows.append((space.unknowns, ours, theirs, theirs / ours))
    return table(("unknowns", "ours, s", "scikit-fem's form, s", "ratio"), rows)


def solvers() -> str:
    """CHOLMOD with METIS beside SuperLU: factor and solve two right-hand sides."""
    rows = []
    for across in (2.0, 4.0):
        space = Discretisation(solid_mesh(PIN, MeshSize(across, arc=1.5)).mesh)
        K = space.stiffness(STEEL)
        held = held_nodes(space, ("start",))
        fixed = (3 * held[:, None] + np.arange(3)).ravel()
        free = np.setdiff1d(np.arange(space.unknowns), fixed)
        A = K[free][:, free]
        b = np.random.default_rng(0).standard_normal((len(free), 2))

        def cholmod(A: Any = A, free: Any = free, b: Any = b) -> object:
            return linear._cholmod(A, free // 3)(b)

        def superlu(A: Any = A, b: Any = b) -> object:
            return linear._superlu(A)(b)

        one, two = seconds(cholmod, 2), seconds(superlu, 1)
        rows.append((len(free), one, two, two / one))
    return table(("unknowns", "CHOLMOD, s", "SuperLU, s", "ratio"), rows)


def demo() -> str:
    """The main job without pictures, in its own process: time and peak memory; and `check`."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, arguments in (
            ("check", ["check", str(STUDY)]),
            ("run --no-pictures", ["run", str(STUDY), "--no-pictures", "--out", f"{folder}/out"]),
            ("run", ["run", str(STUDY), "--out", f"{folder}/out"]),
        ):
            start = time.perf_counter()
            done = subprocess.run(
                [sys.executable, "-m", "pinstress", *arguments], capture_output=True
            )
            spent = time.perf_counter() - start
            peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
            rows.append((name, done.returncode, spent, peak))
    return table(("command", "exit status", "s", "peak so far, MB"), rows)

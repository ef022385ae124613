"""Times of the program, as ratios within one run wherever two methods can be compared."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from typing import Any

import numpy as np
from skfem import Basis, ElementTetP2, ElementVector, MeshTet2
from skfem.models.elasticity import lame_parameters, linear_elasticity

from benchmarks import ROOT
from benchmarks.timing import seconds, table
from fea.core.material import Material
from fea.solid.assembly import Discretisation
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from loads import motion_reactions, move
from pinstress import load_study
from pinstress.study.model.mechanism.drives import laws, span
from pinstress.study.model.mechanism.linkage import linkage

STUDY = ROOT / "studies" / "grenier2008.toml"
STEEL = Material("steel", 2.0e11, 0.3)
PIN = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02, connection="B")), fillet=0.003)


def motion() -> str:
    """Return the times from positions to reactions of the landing gear, by number of instants."""
    study = load_study(STUDY)
    mechanism, courses = linkage(study), laws(study)
    rows = []
    for n in (21, 201, 2001):
        times = np.linspace(0.0, span(study), n)
        moved = move(mechanism, courses, times)
        rows.append(
            (
                n,
                seconds(lambda t=times: move(mechanism, courses, t)),  # type: ignore[misc]
                seconds(lambda m=moved: motion_reactions("retract", m)),  # type: ignore[misc]
            )
        )
    return table(("instants", "motion, s", "reactions, s"), rows)


def assembly() -> str:
    """Return the time of our stiffness matrix compared with scikit-fem's form, each from the bare
    mesh, basis included.

    scikit-fem's form is assembled with our quadrature (4 points) and with the one that scikit-fem
    chooses for these elements (11).
    """
    rows = []
    for across in (6.0, 10.0):
        mesh = solid_mesh(PIN, MeshSize(across)).mesh

        def ours(mesh: Any = mesh) -> object:
            return Discretisation(mesh).stiffness(STEEL)

        one = seconds(ours)
        same = seconds(lambda m=mesh: _form(m, 2), 1)  # type: ignore[misc]
        own = seconds(lambda m=mesh: _form(m, None), 1)  # type: ignore[misc]
        rows.append((3 * mesh.doflocs.shape[1], one, same, same / one, own, own / one))
    head = ("unknowns", "ours, s", "scikit-fem, 4 points, s", "ratio", "as it comes, s", "ratio")
    return table(head, rows)


def _form(mesh: MeshTet2, order: int | None) -> object:
    form = linear_elasticity(*lame_parameters(STEEL.youngs_modulus, STEEL.poisson_ratio))
    return form.assemble(Basis(mesh, ElementVector(ElementTetP2()), intorder=order))


# The probed code ends stderr with its processor time, children included, s, and the memory of the
# largest process, kB.
PROBE = """
import os, re, resource, sys
{work}
own = int(re.search(r"VmHWM:\\s+(\\d+)", open("/proc/self/status").read())[1])
most = max(own, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
print(sum(os.times()[:4]), most, file=sys.stderr)
sys.exit(status)
"""
COMMAND = """
from pinstress.cli.commands import run_command_line
status = run_command_line(sys.argv[1:])
"""
COMPUTING = """
from pinstress import load_study
from pinstress.analysis.plan import prepare
from pinstress.analysis.results import solve
solve(prepare(load_study(sys.argv[1])), jobs=None)
status = 0
"""


def demo() -> str:
    """Return the table of the main job and of `check`: time, memory of the largest process, and the
    main job over its computation alone.
    """
    with tempfile.TemporaryDirectory() as folder:
        run = ["run", str(STUDY), "--no-cache", "--out", f"{folder}/out"]
        rows = [
            ("check", *_probed(COMMAND, "check", str(STUDY))),
            ("computing alone", *_probed(COMPUTING, str(STUDY))),
            ("run", *_probed(COMMAND, *run)),
            ("run --plots", *_probed(COMMAND, *run, "--plots")),
        ]
    head = ("command", "exit status", "s", "processor, s", "largest process, MB")
    alone, whole = rows[1], rows[2]
    return (
        f"{table(head, rows)}\n\nOver computing alone, `run` with its report takes "
        f"{whole[2] / alone[2]:.2f} times the time and {whole[3] / alone[3]:.2f} times the "
        "processor time."
    )


def _probed(work: str, *arguments: str) -> tuple[int, float, float, float]:
    """Return exit status, wall time, s, processor time, s, and memory of the largest
    process, MB.
    """
    start = time.perf_counter()
    code = PROBE.format(work=work)
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True)
    spent = time.perf_counter() - start
    processor, most = map(float, done.stderr.split()[-2:])
    return done.returncode, spent, processor, most / 1024.0

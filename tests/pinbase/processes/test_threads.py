"""Several analyses in one process: gmsh has one state for all threads of it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from geometry.mesh.gmsh_session import gmsh_model
from tests.conftest import ROOT

TWO_KINDS = """
import threading
import pinstress

found = {}

def run(name, model, times):
    study = pinstress.load_study("studies/one_pin.toml")
    for _ in range(times):
        results = pinstress.run(study, model=model, tolerance=0.5)
        found.setdefault(name, set()).add(round(results.pins[0].max_von_mises, 6))

work = [(0, "solid", 1), (1, "solid", 1), (2, "harmonic", 2), (3, "harmonic", 2)]
threads = [threading.Thread(target=run, args=each) for each in work]
for each in threads:
    each.start()
for each in threads:
    each.join()
print([len(found[i]) for i in range(4)], found[0] == found[1], found[2] == found[3])
"""

# gmsh and METIS both draw from rand() of the C library.
MESH_AND_ORDER = """
import threading
import numpy as np
import scipy.sparse as sp
from fea.core.linear_solver import factorize
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh

pin = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02)), fillet=0.004)
n = 40
line = sp.diags_array([2.2 * np.ones(n), -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1])
K = sp.csr_matrix(sp.kronsum(line, line))
done, meshes = threading.Event(), set()

def order():
    while not done.is_set():
        factorize(K, np.arange(n * n))

def mesh():
    for _ in range(8):
        meshes.add(solid_mesh(pin, MeshSize(across=2.5)).mesh.doflocs.tobytes())
    done.set()

threads = [threading.Thread(target=each) for each in (order, mesh)]
for each in threads:
    each.start()
for each in threads:
    each.join()
print(len(meshes))
"""

SIGNALS = """
import signal, threading
from geometry.mesh.gmsh_session import gmsh_model

def mesh():
    with gmsh_model("box") as gmsh:
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)

heard = []
for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGFPE):
    signal.signal(each, lambda number, _: heard.append(signal.Signals(number).name))
for _ in range(2):
    thread = threading.Thread(target=mesh)
    thread.start()
    thread.join()
mesh()
for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGFPE):
    signal.raise_signal(each)
print(*heard)
"""


HELD = """
import threading
import pinstress
import pinstress.analysis.results
from threadpoolctl import threadpool_info, threadpool_limits
from pinbase.processes.threads import one_thread

def most():
    return max(lib["num_threads"] for lib in threadpool_info())

study = pinstress.load_study("studies/one_pin.toml")
plan = pinstress.prepare(study)
with threadpool_limits(3):
    seen = set()
    at_once = pinstress.analysis.results.solve_tasks

    def spied(*args, **options):
        seen.add(most())
        return at_once(*args, **options)

    pinstress.analysis.results.solve_tasks = spied
    results = pinstress.solve(plan)
    print(seen, most(), results.pins[0].max_von_mises)

    entered, left = threading.Event(), threading.Event()

    def other():
        with one_thread():
            entered.set()
            left.wait()

    thread = threading.Thread(target=other)
    with one_thread():
        thread.start()
        entered.wait()
    print(most())  # while the other thread is inside
    left.set()
    thread.join()
    print(most())
    try:
        with one_thread():
            raise ValueError
    except ValueError:
        print(most())
"""


def python(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, timeout=600
    )


@pytest.mark.long
@pytest.mark.slow
def test_analyses_in_several_threads_do_not_disturb_each_other() -> None:
    done = python(TWO_KINDS)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "[1, 1, 1, 1] True True\n"


@pytest.mark.slow
def test_numeric_libraries_have_one_thread_during_an_analysis_and_theirs_afterwards(
    tmp_path: Path,
) -> None:
    """With the command's numbers to the last bit."""
    done = python(HELD)
    assert (done.returncode, done.stderr) == (0, "")
    first, *rest = done.stdout.splitlines()
    seen, after, stress = first.rsplit(" ", 2)
    assert (seen, after, rest) == ("{1}", "3", ["3", "3", "3"])
    command = ["pinstress", "run", "studies/one_pin.toml", "--out", str(tmp_path / "out")]
    run = [sys.executable, "-m", *command, "--vtk", "none", "--quiet"]
    subprocess.run(run, cwd=ROOT, check=True, capture_output=True, timeout=600)
    found = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert float(stress) == found["pins"][0]["max_von_mises"]


def test_a_mesh_is_the_same_while_another_thread_orders_unknowns() -> None:
    done = python(MESH_AND_ORDER)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "1\n"


def test_gmsh_in_a_thread_leaves_the_handling_of_signals_as_it_was() -> None:
    done = python(SIGNALS)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "SIGINT SIGTERM SIGHUP SIGFPE\n"


def test_a_model_within_a_model_is_a_mistake_of_ours() -> None:
    """The inner session would end the outer one."""
    with gmsh_model("outer") as gmsh:
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        with pytest.raises(RuntimeError, match="inside another"), gmsh_model("inner"):
            raise AssertionError("must not get here")
        gmsh.model.occ.synchronize()
        assert len(gmsh.model.getEntities(3)) == 1

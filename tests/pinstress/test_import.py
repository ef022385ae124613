"""What `import pinstress` does: nothing but make a name known."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from pinbase.platform import portable
from tests.conftest import ROOT
from tests.support.programs.command_line import QUICK

IMPORT = """
import locale, os, signal, sys, threading, warnings

def surroundings():
    handlers = {each: signal.getsignal(each) for each in signal.valid_signals()}
    return (
        handlers, os.getcwd(), dict(os.environ), list(warnings.filters), list(sys.path),
        locale.setlocale(locale.LC_ALL), threading.active_count(), sys.excepthook, sys.stdout,
        sys.stderr, sys.displayhook, os.umask(os.umask(0o22)) or None,
    )

before, modules = surroundings(), set(sys.modules)
import pinstress
assert surroundings() == before
print(*sorted({name.partition(".")[0] for name in set(sys.modules) - modules}))
dir(pinstress)
"""


def test_importing_loads_nothing_heavy_and_changes_nothing() -> None:
    done = subprocess.run(
        [sys.executable, "-c", IMPORT], cwd=ROOT, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    loaded = set(done.stdout.split())
    assert "pinstress" in loaded
    assert loaded <= {"pinstress"} | sys.stdlib_module_names


def loaded_by(*arguments: str) -> set[str]:
    """The modules that a command imports."""
    code = (
        "import sys; from pinstress.cli.commands import run_command_line\n"
        "assert run_command_line(sys.argv[1:]) == 0\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        cwd=ROOT, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return set(done.stderr.split())


SOLVE = {"scipy", "skfem", "gmsh", "meshio", "cvxopt", "pymetis"}
DRAW = {"matplotlib", "vl_convert", "pyvista", "vtk", "rich", "reports"}


def test_help_loads_no_numeric_library() -> None:
    assert not loaded_by("--help") & (SOLVE | DRAW | {"numpy", "pydantic", "importlib.metadata"})


def test_check_loads_nothing_that_solves_or_draws() -> None:
    loaded = loaded_by("check", "studies/grenier2008.toml")
    assert "numpy" in loaded
    assert not loaded & (SOLVE | DRAW | {"pint", "jinja2"})


SOLVERS = SOLVE | {"fea.solve.solve", "fea.harmonic.evaluate", "assess.derivatives.derivatives"}
# Notes what each process has imported: a pin may be solved in a child.
NOTED = """
import os, sys
from multiprocessing import util
from pathlib import Path
from pinstress.cli.commands import run_command_line

folder = Path(sys.argv[1])

def note():
    (folder / str(os.getpid())).write_text(" ".join(sys.modules))

# A child has no finalizers of its parent; what it leaves is run before it ends.
util.register_after_fork(note, lambda _: util.Finalize(None, note, exitpriority=0))
status = run_command_line(sys.argv[2:])
note()
sys.exit(status)
"""


def loaded_by_run(folder: Path, *options: str) -> set[str]:
    """The modules that `run` of a quick study and its processes import, with a cache of its own."""
    notes, study = folder / "notes", folder / "study.toml"
    notes.mkdir(exist_ok=True)
    study.write_text(QUICK)
    for old in notes.iterdir():
        old.unlink()
    run = ["run", str(study), "--out", str(folder / "out"), *options]
    done = subprocess.run(
        [sys.executable, "-c", NOTED, str(notes), *run], cwd=ROOT, capture_output=True, text=True,
        timeout=300, env={**os.environ, "PINSTRESS_CACHE": str(folder / "cache")},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    processes = [note.read_text().split() for note in notes.iterdir()]
    assert (len(processes) > 1) == ("2" in options)
    return {name for modules in processes for name in modules}


MODELS_OF_OTHERS = {
    "meshio", "scipy.interpolate", "matplotlib", "pandas", "pyarrow",
    "tomlkit", "pyvista", "assess.plastic.solve", "assess.fatigue.assess",
    "assess.derivatives.in_lugs", "fea.solid.evaluate", "fea.cut.evaluate",
    "fea.support.contact.held", "fea.support.foundation.held",
}  # fmt: skip


# A process that is started anew, as without forks, leaves no note.
@pytest.mark.parametrize(
    "jobs", ["1"] if portable() else ["1", pytest.param("2", marks=pytest.mark.slow)]
)
def test_a_plain_pin_loads_no_model_of_others_and_from_the_cache_none(
    tmp_path: Path, jobs: str
) -> None:
    first = loaded_by_run(tmp_path, "--jobs", jobs)
    assert {"gmsh", "skfem", "scipy.sparse", "fea.solve.solve", "fea.harmonic.evaluate"} <= first
    assert not first & MODELS_OF_OTHERS
    again = loaded_by_run(tmp_path, "--jobs", jobs)
    assert not again & SOLVERS
    assert "fea.core.peak" in again
    assert (tmp_path / "out" / "vtk" / "B_landing.vtu").is_file()

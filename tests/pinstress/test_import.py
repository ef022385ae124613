"""What `import pinstress` does: nothing but make a name known."""

from __future__ import annotations

import subprocess
import sys

from tests.conftest import ROOT

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
    assert not loaded & (SOLVE | DRAW | {"pint"})

"""Sessions of gmsh, quiet and deterministic, with one model at a time."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from pinbase.errors import CodedError
from pinbase.platform import portable
from pinbase.processes.interrupts import blocked

# gmsh has one state for all threads of a process. So has the C library's rand(), which gmsh uses:
# any other code that draws from it must also take this lock, or meshes would differ between runs.
GMSH_LOCK = threading.RLock()

_open = False


SIGNAL_NAMES = "SIGFPE", "SIGHUP", "SIGINT", "SIGPIPE", "SIGSEGV", "SIGTERM"
SIGNALS = tuple(getattr(signal, name) for name in SIGNAL_NAMES if hasattr(signal, name))
SIGACTION_BYTES = 256  # bytes; more than any C library's struct sigaction has


class MeshError(CodedError, ArithmeticError):
    """No valid mesh could be generated; the message says what was tried and what may help."""


@contextmanager
def gmsh_model(name: str) -> Iterator[Any]:
    """The gmsh module with an empty model for the pin `name`, finalised at the end of the block.

    Other threads wait until the end of the block.

    Raises: MeshError for every failure of gmsh or OpenCASCADE; RuntimeError inside another session
    of the same thread, which would end together with this one.
    """
    import gmsh

    global _open
    with GMSH_LOCK:
        if _open:
            raise RuntimeError(
                f"gmsh session {name!r} was opened inside another one; close that first"
            )
        with blocked(), signals_kept():  # gmsh briefly installs the system's default handlers
            gmsh.initialize(readConfigFiles=False, interruptible=False)
        _open = True
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("General.NumThreads", 1)  # same mesh on any machine
            gmsh.model.add(name)
            yield gmsh
        except Exception as error:
            if type(error) is not Exception:  # gmsh raises Exception itself
                raise
            raise MeshError(
                f"pin {name}: gmsh could not build or mesh the shape (its message: "
                f"{str(error).rstrip('.')}); look for a dimension that is very small compared with "
                "its neighbours, or surfaces that just touch",
                failure(str(error)),
            ) from None
        finally:
            _open = False
            gmsh.finalize()


def failure(message: str, otherwise: str = "gmsh-failed") -> str:
    """The code for an error of gmsh, from its message. otherwise: code for an unknown message."""
    return "out-of-memory" if "bad_alloc" in message else otherwise


def formula_size(gmsh: Any, formula: str) -> int:
    """Tag of a size field by a formula of x, y, z and other fields."""
    size = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(size, "F", formula)
    return int(size)


def set_size(gmsh: Any, fields: list[int]) -> None:
    """Set the element size to the minimum of fields, without gmsh's other criteria."""
    field = gmsh.model.mesh.field
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", fields)
    if fields:
        field.setAsBackgroundMesh(least)
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints", "MeshSizeFromCurvature"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)


@contextmanager
def silence() -> Iterator[None]:
    """Suppress standard output, on which OpenCASCADE reports its reading of a file."""
    sys.stdout.flush()
    stdout, null = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 1)
        yield
    finally:
        os.dup2(stdout, 1)
        os.close(stdout)
        os.close(null)


@contextmanager
def signals_kept() -> Iterator[None]:
    """Restore the handlers of signals at the end of the block."""
    with _by_python() if portable() else _by_sigaction():
        yield


@contextmanager
def _by_sigaction() -> Iterator[None]:
    """Restore handlers in any thread, including those unknown to Python (faulthandler's)."""
    libc = ctypes.CDLL(None)
    kept = {each: ctypes.create_string_buffer(SIGACTION_BYTES) for each in SIGNALS}
    for each, handler in kept.items():
        libc.sigaction(each, None, handler)
    try:
        yield
    finally:
        for each, handler in kept.items():
            libc.sigaction(each, handler, None)


@contextmanager
def _by_python() -> Iterator[None]:
    """Restore handlers in the main thread, the only thread in which Python can set them."""
    kept = {each: signal.getsignal(each) for each in SIGNALS}
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            for each, handler in kept.items():
                if handler is not None:
                    signal.signal(each, handler)

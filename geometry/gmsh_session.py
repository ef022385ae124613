"""gmsh, quiet and deterministic: one model at a time."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def gmsh_model(name: str) -> Iterator[Any]:
    """The gmsh module with an empty model; finalised on the way out."""
    import gmsh

    with _signals_kept():
        gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)  # same mesh on any machine
        gmsh.model.add(name)
        yield gmsh
    finally:
        gmsh.finalize()


@contextmanager
def _signals_kept() -> Iterator[None]:
    """gmsh takes the handlers of some signals away, so that they would end the process at once."""
    taken = (signal.SIGHUP, signal.SIGINT, signal.SIGPIPE, signal.SIGTERM)
    kept = {each: signal.getsignal(each) for each in taken}
    yield
    if threading.current_thread() is threading.main_thread():  # only it may set them
        for each, handler in kept.items():
            if handler is not None:  # not set from Python
                signal.signal(each, handler)


def set_size(gmsh: Any, fields: list[int]) -> None:
    """Element size as the least of fields, and by nothing else."""
    field = gmsh.model.mesh.field
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", fields)
    if fields:
        field.setAsBackgroundMesh(least)
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints", "MeshSizeFromCurvature"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)


@contextmanager
def silence() -> Iterator[None]:
    """Nothing on standard output, to which OpenCASCADE writes what it makes of a file."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)

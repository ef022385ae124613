"""gmsh, quiet and deterministic: one model at a time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def gmsh_model(name: str) -> Iterator[Any]:
    """The gmsh module with an empty model; finalised on the way out."""
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)  # same mesh on any machine
        gmsh.model.add(name)
        yield gmsh
    finally:
        gmsh.finalize()

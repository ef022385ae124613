"""Keep Python from importing or running anything from the user's current folder.

A `pyvista.py` in a study's folder is not the library. But Python puts the current folder first in
the import path with `-m` and `-c`, and so does an empty entry of PYTHONPATH, as in
`PYTHONPATH=$PYTHONPATH:/some/where`. An empty entry of PATH does the same for programs.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import chdir, contextmanager

from pinbase.platform import portable

PROCESSES_FOLDER = os.path.dirname(os.path.abspath(__file__))
IMPORT_FOLDER = os.path.dirname(os.path.dirname(PROCESSES_FOLDER))  # contains the package pinbase


def trusted_path() -> list[str]:
    """Return the import path of this process without the current folder.

    The current folder stays if pinstress itself is imported from it (a checkout).
    """
    return [
        p for p in sys.path if os.path.isabs(p) and (_same(p, IMPORT_FOLDER) or not _same(p, "."))
    ]


def leave_out_current_folder() -> None:
    """Stop importing modules and finding programs in the current folder."""
    sys.path[:] = trusted_path()
    entries = os.environ.get("PATH", os.defpath).split(os.pathsep)
    os.environ["PATH"] = os.pathsep.join(p for p in entries if os.path.isabs(p))


@contextmanager
def elsewhere() -> Iterator[None]:
    """Make the folder of this module the current folder inside the block.

    Otherwise an import of matplotlib would read settings from a `matplotlibrc` in the current
    folder. The process must have no other threads.
    """
    if portable():
        with chdir(PROCESSES_FOLDER):
            yield
        return
    here = os.open(".", os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.chdir(PROCESSES_FOLDER)
        yield
    finally:
        os.fchdir(here)
        os.close(here)


def _same(one: str, other: str) -> bool:
    try:
        return os.path.samefile(one, other)
    except OSError:  # one of them does not exist
        return False

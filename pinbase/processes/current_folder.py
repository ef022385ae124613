"""Nothing is imported or run from the folder that the user is in: a `pyvista.py` in a study's
folder is no library of ours. Python itself puts that folder first with `-m` and `-c`, and so does
an empty entry of PYTHONPATH, as in `PYTHONPATH=$PYTHONPATH:/some/where`; one of PATH does it for
programs.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import chdir, contextmanager

from pinbase.platform import portable

PROCESSES_FOLDER = os.path.dirname(os.path.abspath(__file__))
IMPORT_FOLDER = os.path.dirname(os.path.dirname(PROCESSES_FOLDER))  # that we are imported from


def trusted_path() -> list[str]:
    """Where this process imports from, less the current folder, unless that is where pinstress is
    imported from: a checkout.
    """
    return [
        p for p in sys.path if os.path.isabs(p) and (_same(p, IMPORT_FOLDER) or not _same(p, "."))
    ]


def leave_out_current_folder() -> None:
    """Import nothing from the current folder from now on, and find no programs there."""
    sys.path[:] = trusted_path()
    entries = os.environ.get("PATH", os.defpath).split(os.pathsep)
    os.environ["PATH"] = os.pathsep.join(p for p in entries if os.path.isabs(p))


@contextmanager
def elsewhere() -> Iterator[None]:
    """In our own folder meanwhile: matplotlib, when it is imported, takes its settings from a
    `matplotlibrc` in the current one. For a process without other threads.
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
    except OSError:  # it is not there
        return False

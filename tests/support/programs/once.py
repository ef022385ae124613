"""Files that several workers of a test run need and one of them makes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest

Shipped = Callable[[str], Path]  # the results of a shipped study by its name
PATIENCE = 900.0  # s of waiting for the worker that fills the folder


def once(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """Return a folder that is filled once in a test run, by the worker that asks first; others wait
    for it.

    factory: of temporary folders, which the workers of pytest-xdist have side by side
    name: of the folder; workers that give the same name get the same folder
    make: fills the folder, which exists

    Raises: RuntimeError where `make` has failed in another worker; in the worker that calls it,
    what `make` raises.
    """
    base = factory.getbasetemp()
    common = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    folder, done, failed = (common / f"once-{name}{end}" for end in ("", ".done", ".failed"))
    try:
        folder.mkdir()
    except FileExistsError:
        deadline = time.monotonic() + PATIENCE
        while not done.exists():
            if failed.exists() or time.monotonic() > deadline:
                raise RuntimeError(f"{name} was not made by the worker that began it") from None
            time.sleep(0.05)
        return folder
    try:
        make(folder)
    except BaseException:
        failed.touch()
        raise
    done.touch()
    return folder

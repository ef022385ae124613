"""Processes started anew, which every system has, instead of forked ones."""

from __future__ import annotations

import multiprocessing
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.process import BaseProcess
from types import ModuleType
from typing import Any

from pinbase.processes.current_folder import trusted_path


def spawned(target: Callable[..., None], *args: Any) -> BaseProcess:
    """A new Python that calls `target`, a function of a module, with arguments that pickle."""
    process = multiprocessing.get_context("spawn").Process(target=target, args=args)
    with _without_main(), _trusting():
        process.start()
    return process


@contextmanager
def _without_main() -> Iterator[None]:
    """No main module meanwhile: the new process would run the user's script once more, up to where
    it starts processes. Nothing of ours is in it.
    """
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


@contextmanager
def _trusting() -> Iterator[None]:
    """An environment in which a new Python imports nothing from the current folder."""
    wanted = {"PYTHONSAFEPATH": "1", "PYTHONPATH": os.pathsep.join(trusted_path())}
    before = {name: os.environ.get(name) for name in wanted}
    os.environ.update(wanted)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value

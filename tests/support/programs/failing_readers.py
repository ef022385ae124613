"""Ways in which reading a file may fail to end, to be run in separate processes."""

from __future__ import annotations

import os
import threading

import numpy as np

from geometry.imported.body_file import BodyFile


def crash(_: BodyFile) -> None:
    os.abort()


def spin(_: BodyFile) -> None:
    while True:
        pass


def sleep(_: BodyFile) -> None:
    threading.Event().wait()


def swallow(_: BodyFile) -> int:
    return np.ones(10**8).size

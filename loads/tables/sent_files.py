"""Files whose contents were sent from another computer.

They are read instead of the files at the same paths on this computer, which may differ.
"""

from __future__ import annotations

import errno
import hashlib
import os
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from pathlib import Path

_sent: ContextVar[Mapping[str, bytes] | None] = ContextVar("_sent", default=None)
_noted: ContextVar[set[Path] | None] = ContextVar("_noted", default=None)


@contextmanager
def noted_files() -> Iterator[set[Path]]:
    """Collect the paths of the files that this thread reads inside the `with` block."""
    paths = set[Path]()
    token = _noted.set(paths)
    try:
        yield paths
    finally:
        _noted.reset(token)


@contextmanager
def sent_files(contents: Mapping[str, bytes]) -> Iterator[None]:
    """Let this thread read only these files inside the `with` block. contents: by path."""
    token = _sent.set(contents)
    try:
        yield
    finally:
        _sent.reset(token)


def content_sent(path: Path) -> bytes | None:
    """The content that was sent for a file; None where files are read from this computer.

    Raises: FileNotFoundError for a file that was not sent.
    """
    noting, contents = _noted.get(), _sent.get()
    if noting is not None:
        noting.add(path)
    if contents is None or path.is_relative_to(_copies()):
        return None
    if str(path) not in contents:
        raise FileNotFoundError(errno.ENOENT, "it was not sent with the study", str(path))
    return contents[str(path)]


def stamp(path: Path) -> str:
    """A text that changes when a file's content changes; empty where there is no file."""
    try:
        content = content_sent(path)
        if content is not None:
            return hashlib.sha256(content).hexdigest()
        if not os.path.isfile(path):
            return ""
        # A copy that keeps its time, or a second write within a tick of the clock, changes others.
        about = path.stat()
        return f"{about.st_mtime_ns} {about.st_ctime_ns} {about.st_size} {about.st_ino}"
    except FileNotFoundError:
        return ""


def on_disk(path: Path) -> Path:
    """A path at which other libraries can read a file: its own, or a copy's if it was sent."""
    try:
        content = content_sent(path)
    except FileNotFoundError:  # the reader will report it
        return path
    return path if content is None else _copy(path.name, content)


@lru_cache(1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    """The folder of copies, removed when the process ends."""
    return tempfile.TemporaryDirectory(prefix="pinstress-sent-")


def _copies() -> Path:
    return Path(_folder().name)


@lru_cache(16)
def _copy(name: str, content: bytes) -> Path:
    """Path of a copy of content that was sent."""
    path = _copies() / hashlib.sha256(content).hexdigest() / name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(content)
    return path

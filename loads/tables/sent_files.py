"""Files whose contents were sent from another computer, read instead of those that lie at the same
paths here, which may have other contents.
"""

from __future__ import annotations

import errno
import hashlib
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
    """The paths of the files that are read meanwhile in this thread."""
    found = set[Path]()
    token = _noted.set(found)
    try:
        yield found
    finally:
        _noted.reset(token)


@contextmanager
def sent_files(contents: Mapping[str, bytes]) -> Iterator[None]:
    """Meanwhile, in this thread, files have these contents by their paths; there are no others."""
    token = _sent.set(contents)
    try:
        yield
    finally:
        _sent.reset(token)


def content_sent(path: Path) -> bytes | None:
    """What was sent as the content of a file; None where files are read as they lie here.

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
    """What changes when a file's content does; empty where there is no file."""
    try:
        content = content_sent(path)
        if content is not None:
            return hashlib.sha256(content).hexdigest()
        return str(path.stat().st_mtime_ns) if path.is_file() else ""
    except FileNotFoundError:
        return ""


def on_disk(path: Path) -> Path:
    """Where other libraries can read a file: `path` itself, or a copy of what was sent."""
    try:
        content = content_sent(path)
    except FileNotFoundError:  # which whoever reads it reports
        return path
    return path if content is None else _copy(path.name, content)


@lru_cache(1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="pinstress-sent-")


def _copies() -> Path:
    return Path(_folder().name)


@lru_cache(16)
def _copy(name: str, content: bytes) -> Path:
    path = _copies() / hashlib.sha256(content).hexdigest() / name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(content)
    return path

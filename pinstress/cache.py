"""What was solved before, found again by the content of what was asked: a folder of files, each
named by the SHA-256 of everything its answer depends on.

A file is the hash of its name and its content, and the content (pinstress.packing). One that is
damaged, renamed or of another type is as good as none, and so is a folder that cannot be written.
"""

from __future__ import annotations

import hashlib
import logging
import os
import re
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

from pinstress.gather import PACKAGES
from pinstress.packing import pack, unpack

T = TypeVar("T")

VARIABLE = "PINSTRESS_CACHE"  # the folder; empty or OFF: none
OFF = "off"
LIMIT = 10**9  # bytes of all files; the longest unused go first
ROOMS = ("fea", "geometry", "pinstress", "reports")  # that have a hand in an answer
DRAWN_BY = ("matplotlib", "pyvista", "vtk")
KEY, PARTIAL = re.compile(r"[0-9a-f]{64}"), ".partial"
OURS = re.compile(rf"{KEY.pattern}(\w+{re.escape(PARTIAL)})?")

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Cache:
    """A folder, for answers of one `program` (by the hash of its versions and source)."""

    folder: Path
    program: str
    limit: int = LIMIT

    def key(self, asked: object) -> str:
        """The name of the answer to what is asked (of what pinstress.packing takes)."""
        return hashlib.sha256(self.program.encode() + pack(asked)).hexdigest()

    def read(self, key: str, kind: type[T]) -> T | None:
        """What was written, a `kind`; None when there is nothing that can be trusted."""
        path = self._path(key)
        try:
            if not path.is_file():
                return None
            seal, content = _split(path.read_bytes())
            if seal != _seal(key, content):
                raise ValueError("damaged")
            value = unpack(kind, content)
            with suppress(OSError):  # of a folder that can only be read
                os.utime(path)  # used now
        except Exception as error:  # whatever is wrong with it, it is solved anew
            log.debug("%s is not used: %s", path, error)
            return None
        return value

    def write(self, key: str, value: object) -> None:
        """Keep an answer, if that is possible; its file is complete or absent."""
        path = self._path(key)
        try:
            content = pack(value)
            if len(content) > self.limit:
                return
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            descriptor, partial = tempfile.mkstemp(PARTIAL, key, self.folder)
            try:
                with open(descriptor, "wb") as file:
                    file.write(_seal(key, content) + content)
                os.replace(partial, path)
            except BaseException:
                Path(partial).unlink(missing_ok=True)
                raise
        except (OSError, MemoryError) as error:
            log.debug("%s is not written: %s", path, error)

    def trim(self) -> None:
        """Remove what was longest not used until all is within the limit; partial files too, which
        killed runs leave, and nothing that has another name than ours.
        """
        found, room = [], self.limit
        with suppress(OSError):  # it is not there, or not ours
            for entry in os.scandir(self.folder):
                if OURS.fullmatch(entry.name):
                    with suppress(FileNotFoundError):  # another run was quicker
                        seen = entry.stat(follow_symlinks=False)
                        found.append((seen.st_mtime_ns, seen.st_size, entry.path))
            for _, size, path in sorted(found, reverse=True):
                room -= size
                if room < 0:
                    Path(path).unlink(missing_ok=True)

    def _path(self, key: str) -> Path:
        if not KEY.fullmatch(key):
            raise ValueError(f"{key!r:.100} is not the name of an entry")
        return self.folder / key


def user_cache() -> Cache | None:
    """The user's: in the folder that PINSTRESS_CACHE names, else where the system keeps caches
    (XDG_CACHE_HOME). None when it is switched off or there is no such place.
    """
    named = os.environ.get(VARIABLE)
    if named is not None and named.strip().lower() in ("", OFF):
        return None
    try:
        folder = Path(named).expanduser() if named else _usual()
        return Cache(folder.absolute(), program())
    except (OSError, RuntimeError, ImportError) as error:  # no home, say
        log.debug("no cache: %s", error)
        return None


def _usual() -> Path:
    from platformdirs import user_cache_path

    return user_cache_path("pinstress", appauthor=False)


def program() -> str:
    """Hash of what answers depend on besides what is asked: versions, and the source itself, so
    that whoever changes a formula does not meet the answers of the old one.
    """
    versions = PACKAGES + DRAWN_BY
    found = hashlib.sha256(repr([(name, version(name)) for name in versions]).encode())
    root = Path(__file__).parent.parent
    for room in ROOMS:
        for path in sorted((root / room).glob("*.py")):
            found.update(path.name.encode() + hashlib.sha256(path.read_bytes()).digest())
    return found.hexdigest()


def _seal(key: str, content: bytes) -> bytes:
    return hashlib.sha256(key.encode() + content).digest()


def _split(data: bytes) -> tuple[bytes, bytes]:
    size = hashlib.sha256().digest_size
    return data[:size], data[size:]

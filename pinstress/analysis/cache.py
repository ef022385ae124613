"""Cache of earlier solutions in a folder of files, each named by the SHA-256 of everything on which
its content depends.

A file consists of a signature line, the hash of its own name and content, and the content
(pinbase.records). A file that is damaged, renamed or of another type counts as missing, and so does
a folder that cannot be written. Other programs name files by hashes, too, so only files that begin
with the signature are ever removed.
"""

from __future__ import annotations

import hashlib
import logging
import os
import re
import stat
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Protocol, TypeVar

from pinbase.platform import portable
from pinbase.records import pack, unpack

T = TypeVar("T")

CACHE_VARIABLE = "PINSTRESS_CACHE"  # the folder; empty or CACHE_OFF: no cache
CACHE_OFF = "off"
MAX_CACHE_SIZE = 10**9  # bytes of all files; the least recently used are removed first
# Packages of this program whose source affects a result.
SOURCE_PACKAGES = ("assess", "fea", "geometry", "loads", "pinbase", "pinstress", "reports")
# Distributions whose versions affect a result.
REQUIRED_PACKAGES = (
    "pinstress",
    "numpy",
    "scipy",
    "scikit-fem",
    "gmsh",
    "meshio",
    "cvxopt",
    "pymetis",
)
FILE_SIGNATURE = b"pinstress\n"
KEY_PATTERN, PARTIAL_SUFFIX = re.compile(r"[0-9a-f]{64}"), ".partial"
CACHE_FILE_PATTERN = re.compile(rf"{KEY_PATTERN.pattern}(\w+{re.escape(PARTIAL_SUFFIX)})?")

log = logging.getLogger(__name__)


class OutcomeStore(Protocol):
    """A store of solved pins, each under the content of all it depends on."""

    def key(self, inputs: object) -> str: ...
    def read(self, key: str, kind: type[T]) -> T | None: ...
    def write(self, key: str, value: object) -> None: ...


@dataclass(frozen=True)
class Cache:
    """A folder of results of one `program` (identified by the hash of its versions and source)."""

    folder: Path
    program: str
    limit: int = MAX_CACHE_SIZE

    def key(self, inputs: object) -> str:
        """Return the name under which the result for these inputs is stored (pinbase.records packs
        them).
        """
        return hashlib.sha256(self.program.encode() + pack(inputs)).hexdigest()

    def read(self, key: str, kind: type[T]) -> T | None:
        """Return the stored result as a `kind`, or None if there is no intact one."""
        path = self._path(key)
        try:
            if not path.is_file():
                return None
            seal, content = _split(path.read_bytes())
            if seal != _seal(key, content):
                raise ValueError("damaged")
            value = unpack(kind, content)
            with suppress(OSError):  # the folder may be read-only
                os.utime(path)  # the time of last use
        except Exception as error:  # whatever is wrong with the file, the pin is solved again
            log.debug("%s is not used: %s", path, error)
            return None
        return value

    def has(self, key: str) -> bool:
        """Return whether there is a result of this name, which may turn out to be damaged."""
        return os.path.isfile(self._path(key))  # also False in a folder that may not be searched

    def write(self, key: str, value: object) -> None:
        """Store a result if possible; its file is complete or absent."""
        path = self._path(key)
        try:
            content = pack(value)
            if len(content) > self.limit:
                return
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            descriptor, partial = tempfile.mkstemp(PARTIAL_SUFFIX, key, self.folder)
            try:
                with open(descriptor, "wb") as file:
                    file.write(FILE_SIGNATURE + _seal(key, content) + content)
                os.replace(partial, path)
            except BaseException:
                Path(partial).unlink(missing_ok=True)
                raise
        except (OSError, MemoryError) as error:
            log.debug("%s is not written: %s", path, error)

    def trim(self) -> None:
        """Remove the least recently used files until the rest is within the limit.

        Partial files, which killed runs leave, count too; files of other programs are kept.
        """
        files, room = [], self.limit
        with suppress(OSError):  # the folder is missing or not accessible
            for entry in os.scandir(self.folder):
                if CACHE_FILE_PATTERN.fullmatch(entry.name) and _ours(entry.path):
                    with suppress(FileNotFoundError):  # another run has just removed the file
                        seen = entry.stat(follow_symlinks=False)
                        files.append((seen.st_mtime_ns, seen.st_size, entry.path))
            for _, size, path in sorted(files, reverse=True):
                room -= size
                if room < 0:
                    Path(path).unlink(missing_ok=True)

    def _path(self, key: str) -> Path:
        if not KEY_PATTERN.fullmatch(key):
            raise ValueError(f"{key!r:.100} is not the name of an entry")
        return self.folder / key


def user_cache() -> Cache | None:
    """Return the user's cache, or None if it is switched off or there is no folder for it.

    The folder is the one that PINSTRESS_CACHE names, or else one in the system's folder of caches
    (XDG_CACHE_HOME).
    """
    named = os.environ.get(CACHE_VARIABLE)
    if named is not None and named.strip().lower() in ("", CACHE_OFF):
        return None
    try:
        folder = Path(named).expanduser() if named else _usual()
        return Cache(folder.absolute(), program())
    except (OSError, RuntimeError, ImportError) as error:  # the user has no home folder, say
        log.debug("no cache: %s", error)
        return None


def _usual() -> Path:
    from platformdirs import user_cache_path

    return user_cache_path("pinstress", appauthor=False)


def program() -> str:
    """Return the hash of versions and source, on which results depend in addition to the task.

    The source is included so that a changed formula never reuses results of the old one.
    """
    made_by = [(name, _version(name)) for name in REQUIRED_PACKAGES], portable()
    digest = hashlib.sha256(repr(made_by).encode())
    root = Path(__file__).parents[2]
    for room in SOURCE_PACKAGES:
        for path in sorted((root / room).rglob("*.py")):
            name = path.relative_to(root).as_posix()
            digest.update(name.encode() + hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def _version(name: str) -> str | None:
    """Return the version of a package, or None if it is not installed: pymetis does not exist for
    every system.
    """
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _seal(key: str, content: bytes) -> bytes:
    return hashlib.sha256(key.encode() + content).digest()


def _split(data: bytes) -> tuple[bytes, bytes]:
    if not data.startswith(FILE_SIGNATURE):
        raise ValueError("not ours")
    end = len(FILE_SIGNATURE) + hashlib.sha256().digest_size
    return data[len(FILE_SIGNATURE) : end], data[end:]


def _ours(path: str) -> bool:
    """Return whether this program wrote a file, by its first line or by the suffix of partial
    files.
    """
    if path.endswith(PARTIAL_SUFFIX):
        return True
    try:
        if not stat.S_ISREG(os.lstat(path).st_mode):  # a link, a folder
            return False
        with open(path, "rb") as file:
            begin = file.read(len(FILE_SIGNATURE))
    except OSError:  # gone
        return False
    return begin == FILE_SIGNATURE

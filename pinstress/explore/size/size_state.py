"""The finished part of a `size` command, kept in a folder so that the command can be resumed.

The folder is next to the new study. It has the sized pins, or the searches for the lightest pins.
The writer locks the folder; the lock is released however the writer ends.
"""

from __future__ import annotations

import hashlib
import os
import zipfile
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from pinbase.files import partial_file, replace_file
from pinbase.processes.folder_lock import Release, lock
from pinbase.records import pack, unpack
from pinstress.analysis.cache import program
from pinstress.explore.size.search_log import FinishedSearch
from pinstress.explore.size.size_pin import SizingResult
from pinstress.study.reading.errors import InputError, cannot_write
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs

STATE_SUFFIX = ".unfinished"
PINS_FILE = "pins"  # in the folder
# The errors of a damaged file; RuntimeError if it claims to be encrypted or packed differently
DAMAGED = (OSError, ValueError, KeyError, EOFError, RuntimeError, zipfile.BadZipFile)

T = TypeVar("T")


@dataclass(frozen=True)
class FinishedPins:
    """The finished pins. identity: a hash of all data on which they depend."""

    identity: str
    done: tuple[SizingResult, ...]


@dataclass(frozen=True)
class FinishedSearches:
    """The finished searches; identity: as in FinishedPins."""

    identity: str
    done: tuple[FinishedSearch, ...]


def identity(study: Study, goal: object, pins: Iterable[str]) -> str:
    """Return a hash of all data on which the sizes of pins depend."""
    asked = study.text, inputs(study), goal, sorted(pins), program()
    return hashlib.sha256(repr(asked).encode()).hexdigest()


class SizeState(Generic[T]):
    """The folder of a `size` command that has not ended.

    target: the file of the new study.
    identity: the hash of this command's data.
    kind: the record of its finished part, FinishedPins or FinishedSearches.
    """

    def __init__(self, target: Path, identity: str, kind: type[Any]) -> None:
        self._kind = kind
        self.path = target.with_name(target.name + STATE_SUFFIX)
        self._pins = self.path / PINS_FILE
        self._target, self._identity = target, identity
        self._release: Release | None = None

    @property
    def exists(self) -> bool:
        """Whether a `size` has begun there; an empty folder is left by one killed before that."""
        try:
            written = {*os.listdir(self.path)} - {partial_file(self._pins).name}
            return self.path.is_symlink() or bool(written)
        except (NotADirectoryError, PermissionError):
            return True
        except OSError:  # it is not there, or its name is too long
            return False

    def begin(self) -> None:
        """Create and lock the folder, with nothing finished.

        Raises: InputError if there is an unfinished `size` already, or the folder cannot be
        written.
        """
        try:
            with suppress(FileExistsError):
                self.path.mkdir()
            self._lock()
            unfinished = self.exists
        except NotADirectoryError:  # a link, or a file
            unfinished = True
        except OSError as error:
            raise self._cannot_write(error) from None
        if unfinished:
            raise InputError(
                f"{self._target} has a size that did not end: resume it with --resume, or delete "
                f"{self.path.name} and {self._target.name} to start again",
                code="unfinished-size",
            )
        try:
            self.write(())
        except InputError:
            self.end()
            raise

    def read(self) -> tuple[T, ...]:
        """Lock the folder and return the finished part.

        Raises: InputError if there is nothing to resume, if the folder is damaged or belongs to
        another `size`, or if one is still running.
        """
        if not self.exists:
            raise InputError(
                f"--resume: there is no size of {self._target} to resume; leave out --resume",
                code="nothing-to-resume",
            )
        try:
            self._lock()
            finished = unpack(self._kind, self._pins.read_bytes())
        except DAMAGED:
            raise InputError(
                f"--resume: {self.path} is damaged; delete it and {self._target.name} to start "
                "again",
                code="damaged-state",
            ) from None
        if finished.identity != self._identity:
            raise InputError(
                f"--resume: the size of {self._target} is of another study, factor, step or pins, "
                "or of another version of pinstress; resume with those, or choose another file",
                code="other-size",
            )
        done: tuple[T, ...] = finished.done
        return done

    def _lock(self) -> None:
        """Lock the folder until `close`.

        Raises: InputError while another `size` is writing; OSError.
        """
        if self._release is not None:
            return
        try:
            self._release = lock(self.path)
        except BlockingIOError:
            raise InputError(
                f"another size is writing {self._target}; wait for it or choose another file with "
                "--out",
                code="locked",
            ) from None

    def write(self, done: tuple[T, ...]) -> None:
        """Replace the finished part; the file is complete at any time.

        Raises: InputError if the file cannot be written.
        """
        content = pack(self._kind(self._identity, done))
        try:
            replace_file(self._pins, content)
        except OSError as error:
            raise self._cannot_write(error) from None

    def _cannot_write(self, error: OSError) -> InputError:
        """Return the error that names the user's file, since the user has not named the folder."""
        refused = cannot_write(self._target, error)
        text = f"{refused}; pins that are done would be kept beside it, in {self.path.name}"
        return InputError(text, code=refused.code)

    def end(self) -> None:
        """Remove the folder."""
        self._pins.unlink(missing_ok=True)
        with suppress(FileNotFoundError):
            self.path.rmdir()

    def close(self) -> None:
        """Release the folder."""
        if self._release is not None:
            self._release()
            self._release = None

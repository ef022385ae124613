"""The pins that a size has finished, in a file beside the new study, so that it can be resumed."""

from __future__ import annotations

import hashlib
import os
import zipfile
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from pinbase.records import pack, unpack
from pinstress.analysis.cache import program
from pinstress.explore.size.size_pin import SizingGoal, SizingResult
from pinstress.study.reading.errors import InputError, cannot_write
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs

STATE_SUFFIX = ".unfinished"
DAMAGED = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile)


@dataclass(frozen=True)
class FinishedPins:
    """Finished pins.

    identity: a hash of all on which they depend.
    """

    identity: str
    pins: tuple[SizingResult, ...]


def identity(study: Study, goal: SizingGoal, pins: Iterable[str]) -> str:
    """Return a hash of all on which the sizes of pins depend."""
    asked = study.text, inputs(study), goal, sorted(pins), program()
    return hashlib.sha256(repr(asked).encode()).hexdigest()


class SizeState:
    """The file of a size that has not ended.

    target: the new study.
    identity: of the size.
    """

    def __init__(self, target: Path, identity: str) -> None:
        self.path = target.with_name(target.name + STATE_SUFFIX)
        self._target, self._identity = target, identity

    @property
    def exists(self) -> bool:
        """Whether there is such a file; a name that is too long has none."""
        with suppress(OSError):
            return self.path.exists()
        return False

    def begin(self) -> None:
        """Create the file, without a pin.

        Raises: InputError where there is one already, or it cannot be written.
        """
        try:
            self.path.open("xb").close()
        except FileExistsError:
            raise InputError(
                f"{self._target} has a size that did not end: resume it with --resume, or delete "
                f"{self.path.name} and {self._target.name} to start again",
                code="unfinished-size",
            ) from None
        except OSError as error:
            raise cannot_write(self._both, error) from None
        try:
            self.write(())
        except InputError:
            self.end()
            raise

    def read(self) -> tuple[SizingResult, ...]:
        """Return the finished pins.

        Raises: InputError where there is nothing to resume, or another size.
        """
        if not self.path.is_file():
            raise InputError(
                f"--resume: there is no size of {self._target} to resume; leave out --resume",
                code="nothing-to-resume",
            )
        try:
            finished = unpack(FinishedPins, self.path.read_bytes())
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
        return finished.pins

    def write(self, pins: tuple[SizingResult, ...]) -> None:
        """Replace the finished pins; the file is complete at any time.

        Raises: InputError where it cannot be written.
        """
        replace_file(self.path, pack(FinishedPins(self._identity, pins)), self._both)

    @property
    def _both(self) -> str:
        """The user's file and this one, for messages: nobody has named this one."""
        return f"{self._target}, and {self.path.name} while its pins are sized"

    def end(self) -> None:
        """Remove the file."""
        self.path.unlink(missing_ok=True)


def replace_file(path: Path, content: bytes, name: str = "") -> None:
    """Write a file in one step.

    name: of it in messages, its path by default.

    Raises: InputError where it cannot be written.
    """
    partial = path.with_name(f".{path.name}.partial")
    try:
        partial.write_bytes(content)
        os.replace(partial, path)
    except OSError as error:
        with suppress(OSError):  # as of a name that is too long
            partial.unlink(missing_ok=True)
        raise cannot_write(name or path, error) from None

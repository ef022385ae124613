"""Output folders that are either complete or absent: written beside, then moved in place."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pinstress.errors import InputError

MARK = "results.json"  # a folder with it is ours to replace


def require_replaceable(directory: Path, mark: str = MARK) -> None:
    """Raises: InputError when writing to `directory` would destroy something that is not ours."""
    if directory.is_dir() and any(directory.iterdir()) and not (directory / mark).is_file():
        raise InputError(
            f"--out: {directory} holds files that are not results of pinstress to replace (it has "
            f"no {mark}); name an empty or new folder"
        )
    if directory.exists() and not directory.is_dir():
        raise InputError(f"--out: {directory} is a file; name a folder")


@contextmanager
def replacing(directory: Path, mark: str = MARK) -> Iterator[Path]:
    """A folder to write into that becomes `directory` when the block ends without an error; one
    that is there already is replaced if it holds a file `mark`.

    Raises: InputError when the folder cannot be made.
    """
    require_replaceable(directory, mark)
    directory = directory.resolve()
    made = [p for p in directory.parents if not p.exists()]
    try:
        directory.parent.mkdir(parents=True, exist_ok=True)
        staging = Path(tempfile.mkdtemp(prefix=f".{directory.name}.", dir=directory.parent))
    except OSError as error:
        raise InputError(f"--out: cannot write to {directory.parent} ({error.strerror})") from None
    try:
        yield staging
        umask = os.umask(0)
        os.umask(umask)
        staging.chmod(0o777 & ~umask)  # mkdtemp keeps it to its owner
        _swap(staging, directory)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        for parent in made:
            with suppress(OSError):  # it holds the results
                parent.rmdir()


def _swap(staging: Path, directory: Path) -> None:
    if not directory.exists():
        staging.rename(directory)
        return
    earlier = Path(tempfile.mkdtemp(prefix=f".{directory.name}.old.", dir=directory.parent))
    directory.rename(earlier / "folder")
    try:
        staging.rename(directory)
    except OSError:
        (earlier / "folder").rename(directory)
        raise
    finally:
        shutil.rmtree(earlier, ignore_errors=True)

"""Output folders that are either complete or absent: written next to the target, then exchanged, in
one step where the system has one.

The folder being written, `.NAME.partial`, is locked by its writer; the lock is released however the
writer ends. An unlocked `.partial` folder was left by a killed run and is removed. Only files that
pinstress wrote are removed (pinstress.cli.manifest), and no link is followed except the one that
the user names with --out.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pinbase.platform import portable
from pinbase.processes import interrupts
from pinbase.processes.folder_lock import Release, lock
from pinstress.cli import manifest
from pinstress.study.reading.errors import InputError, cannot_write_out

RESULTS_JSON = "results.json"  # written by `run` and by `loads`
RENAME_EXCHANGE, AT_FDCWD = 2, -100  # of Linux's renameat2
NO_EXCHANGE_ERRORS = (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP)  # some network file systems


def require_replaceable(
    directory: Path, mark: str = RESULTS_JSON, also: Callable[[str], bool] = lambda _: False
) -> None:
    """Check that `directory` can be replaced.

    mark: a file that every results folder of this command contains.
    also: whether an entry is from pinstress although the manifest does not list it.

    Raises: InputError if replacing would destroy other files, or results of another command.
    """
    try:
        if directory.exists() and not directory.is_dir():
            raise InputError(f"--out: {directory} is a file; give a folder", code="not-a-folder")
        contents = manifest.entries(directory) if directory.exists() else set()
        known = manifest.listed(directory)
        ours = manifest.ours(directory) is not None if contents else True
    except OSError as error:  # the folder cannot be read, or its name is too long
        raise InputError(f"--out: {directory}: {error.strerror}", code="cannot-read") from None
    if ours and contents <= manifest.OWN_FILES:  # the other files were deleted or never written
        return
    if contents and mark not in contents:
        raise InputError(
            f"--out: {directory} contains files that are not results of this command (it has no "
            f"{mark}, but {_some(contents)}); choose an empty or new folder",
            code="not-ours",
        )
    if contents and known is None:
        raise InputError(
            f"--out: {directory} contains {_some(contents)}, but no list of what pinstress wrote "
            f"({manifest.MANIFEST_FILE}): it was written by another program or an earlier version, "
            "or copied without that file; choose another folder, or delete this one",
            code="not-ours",
        )
    if strange := {name for name in contents - (known or set()) if not also(name)}:
        raise InputError(
            f"--out: {directory} contains {_some(strange)}, which pinstress did not write and "
            "would delete; move them elsewhere or choose another folder",
            code="not-ours",
        )


@contextmanager
def replacing(directory: Path, mark: str = RESULTS_JSON) -> Iterator[Path]:
    """Yield a folder to write into that becomes `directory` when the block ends without an error.

    An existing folder is replaced if it contains `mark` and only files that pinstress wrote.

    Raises: InputError if the folder cannot be created or written, or another run is writing it.
    """
    directory = resolved(directory)
    partial, earlier = (directory.parent / f".{directory.name}.{x}" for x in ("partial", "earlier"))
    new_parents = [p for p in directory.parents if not p.exists()]
    release: Release | None = None
    try:
        try:
            directory.parent.mkdir(parents=True, exist_ok=True)
            with interrupts.deferred():  # until the new folder is known to be ours
                release = _claim(partial, directory)
            _recover(earlier, directory)
        except OSError as error:
            named = directory if error.errno == errno.ENAMETOOLONG else directory.parent
            raise cannot_write_out(named, error) from None
        require_replaceable(directory, mark)
        try:
            yield partial
            manifest.complete(partial)
        except OSError as error:  # a full disk
            if not _is_inside(error, partial):
                raise
            raise cannot_write_out(directory, error) from error
        require_replaceable(directory, mark)  # files may have been added during the run
        try:
            with interrupts.deferred():  # systems without an exchange need two steps
                _replace(partial, directory, earlier)
                interrupts.state_left(f"{directory} is written")
        except OSError as error:
            raise InputError(
                f"--out: cannot replace {directory} ({error.strerror}); close programs that have "
                "one of its files open, or choose another folder",
                code="cannot-write",
            ) from error
    finally:
        if release is not None:
            _clear(partial)
            release()
        for parent in new_parents:
            with suppress(OSError):  # the folder contains the results
                parent.rmdir()


def resolved(directory: Path) -> Path:
    """Return the user's path with links resolved.

    Raises: InputError.
    """
    try:
        return directory.resolve()
    except FileNotFoundError:  # raised only if the current folder no longer exists
        raise InputError(
            f"--out: {directory} would lie in the current folder, which no longer exists; change "
            "to another folder",
            code="no-current-folder",
        ) from None
    except (OSError, RuntimeError):  # RuntimeError in Python up to 3.12
        raise InputError(
            f"--out: {directory} is a link that leads back to itself", code="circular-link"
        ) from None


def _some(names: set[str]) -> str:
    """Return the names of the first few entries, top level first."""
    names = names - {manifest.MANIFEST_FILE} or names
    first = sorted(names, key=lambda name: (name.count("/") - name.endswith("/"), name))
    more = f" and {len(first) - 3} more" if len(first) > 3 else ""
    return ", ".join(first[:3]) + more


def _claim(partial: Path, directory: Path) -> Release:
    """Create and lock an empty folder `partial`, and return the function that releases it."""
    while True:
        with suppress(FileExistsError):
            partial.mkdir()
        try:
            release = lock(partial)
        except FileNotFoundError:  # the other run has just ended
            continue
        except NotADirectoryError:  # a file, or a link to anything
            raise _in_the_way(partial) from None
        except BlockingIOError:
            raise InputError(
                f"--out: another run is writing {directory}; wait for it or choose another folder",
                code="locked",
            ) from None
        try:
            _empty(partial)  # a run that was killed may have left files
            manifest.begin(partial)
        except BaseException:
            with suppress(OSError):  # the folder contains files of others
                partial.rmdir()
            release()
            raise
        return release


def _empty(partial: Path) -> None:
    """Remove the files that a killed run left.

    Raises: InputError if anything else is there.
    """
    manifest.remove(partial, manifest.ours(partial) or set())
    if left := manifest.entries(partial):
        raise _in_the_way(partial / min(left))


def _clear(folder: Path) -> None:
    """Remove the files that pinstress wrote from a folder, and the folder if it is then empty."""
    if folder.is_dir() and not folder.is_symlink():
        with suppress(OSError):  # the folder contains other files
            manifest.remove(folder, manifest.ours(folder) or set())
            folder.rmdir()


def _in_the_way(path: Path) -> InputError:
    return InputError(
        f"--out: {path} exists and was not written by pinstress; move it or choose another folder",
        code="not-ours",
    )


def _recover(earlier: Path, directory: Path) -> None:
    """Recover from a run that was killed between the two steps of `_replace`."""
    if earlier.is_symlink() or (earlier.exists() and not earlier.is_dir()):
        raise _in_the_way(earlier)
    if not earlier.exists():
        return
    if not directory.exists() and manifest.ours(earlier) is not None:
        earlier.rename(directory)
        return
    _clear(earlier)
    if earlier.exists():
        raise _in_the_way(earlier)


def _exchange(one: Path, other: Path) -> bool:
    """Exchange two existing folders in one step; return whether that was possible.

    Raises: OSError.
    """
    if portable():
        return False
    import ctypes

    libc = ctypes.CDLL(None, use_errno=True)
    paths = AT_FDCWD, os.fsencode(one), AT_FDCWD, os.fsencode(other)
    if libc.renameat2(*paths, RENAME_EXCHANGE) == 0:
        return True
    if ctypes.get_errno() not in NO_EXCHANGE_ERRORS:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()), str(other))
    return False


def _replace(partial: Path, directory: Path, earlier: Path) -> None:
    """Swap `partial` and `directory`; afterwards the old content is at `partial` or removed."""
    if not directory.exists():
        partial.rename(directory)
        return
    if _exchange(partial, directory):
        return
    directory.rename(earlier)
    try:
        partial.rename(directory)
    except OSError:
        earlier.rename(directory)
        raise
    _clear(earlier)


def _is_inside(error: OSError, folder: Path) -> bool:
    """Return whether an error is from writing into `folder`; an error of a full disk always
    counts.
    """
    if error.errno in (errno.ENOSPC, errno.EFBIG, errno.EDQUOT):
        return True
    name = error.filename
    return isinstance(name, str | os.PathLike) and folder in Path(name).parents

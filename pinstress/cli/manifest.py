"""The manifest of an output folder, `.pinstress.json`: the list of the files that pinstress wrote.

Only listed files are ever removed. Links are not followed; a link counts as a file of its folder.
"""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path, PurePosixPath
from typing import Any

from reports.folder.inside import PARTIAL_SUFFIX as SUFFIX
from reports.folder.inside import read_inside, write_inside

MANIFEST_FILE = ".pinstress.json"
# Files of the manifest itself; a process that is killed while writing it leaves the second
OWN_FILES = frozenset({MANIFEST_FILE, f"{MANIFEST_FILE}{SUFFIX}"})
MANIFEST_SCHEMA = "pinstress-output/1"
MAX_MANIFEST_SIZE = 10_000_000  # bytes


def begin(folder: Path) -> None:
    """Mark a folder as being written: everything in it is from this run."""
    _write(folder, set())


def complete(folder: Path) -> None:
    """Write the manifest of all files in a folder."""
    _write(folder, entries(folder))


def add(folder: Path, names: list[str]) -> None:
    """Add entries to the manifest of a folder, before they are written."""
    _write(folder, (listed(folder) or set()) | set(names))


def drop(folder: Path, names: list[str]) -> None:
    """Remove entries that no longer exist from the manifest of a folder."""
    _write(folder, (listed(folder) or set()) - set(names))


def partial_names(names: Iterable[str]) -> list[str]:
    """Return the names that files have while reports.folder.inside writes them."""
    return [name + SUFFIX for name in names]


def ours(folder: Path) -> set[str] | None:
    """Return the entries that may be removed from a folder: the listed files, or everything if its
    writer was killed while writing. None if the folder is not empty and has no manifest.
    """
    contents, known = entries(folder), listed(folder)
    if (known and known <= OWN_FILES) or contents <= OWN_FILES - {MANIFEST_FILE}:
        return contents
    return known


def listed(folder: Path) -> set[str] | None:
    """Return the files that pinstress wrote into a folder, with those of the manifest itself; None
    without a manifest.
    """
    try:
        content: Any = json.loads(read_inside(folder, MANIFEST_FILE, MAX_MANIFEST_SIZE))
        if content["schema"] != MANIFEST_SCHEMA:
            return None
        names = {str(name) for name in content["files"]}
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    of_list = {name for name in OWN_FILES if os.path.lexists(folder / name)}
    return of_list | {n for n in names if _is_below(n)}


def _is_below(name: str) -> bool:
    """Return whether a name refers to something inside the folder."""
    try:
        os.fsencode(name)
    except UnicodeEncodeError:
        return False
    return ".." not in PurePosixPath(name).parts and name[:1] != "/" and "\0" not in name


def entries(folder: Path) -> set[str]:
    """Return all entries of a folder, relative to it; names of folders end with a slash, and links
    count as files.
    """
    names = set()
    for at, folders, files in os.walk(folder, onerror=_raise):
        for name in folders + files:
            path = Path(at, name)
            ending = "/" if name in folders and not path.is_symlink() else ""
            names.add(path.relative_to(folder).as_posix() + ending)
    return names


def first_link(folder: Path) -> str | None:
    """Return an entry that is neither a regular file nor a folder, through which other files could
    be read or written; None if there is none.
    """
    for name in sorted(entries(folder)):
        mode = (folder / name).lstat().st_mode
        if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
            return name
    return None


def remove(folder: Path, names: set[str]) -> None:
    """Remove these entries of a folder."""
    for name in sorted(names, key=len, reverse=True):  # contents before their folder
        path = folder / name
        if any(p.is_symlink() for p in path.parents if folder in p.parents):
            continue  # the entry is outside this folder
        with suppress(OSError):  # already removed, or a folder that is not empty
            path.rmdir() if name.endswith("/") else path.unlink()


def _write(folder: Path, names: set[str]) -> None:
    listing = {"schema": MANIFEST_SCHEMA, "files": sorted(names - OWN_FILES)}
    text = json.dumps(listing, indent=1, ensure_ascii=False) + "\n"
    write_inside(folder, MANIFEST_FILE, text.encode())


def _raise(error: OSError) -> None:
    raise error

"""The versions on which numbers depend, reported by a Python in which pinstress may be missing.

The text of this module is sent to other computers and run there, so it imports only the standard
library.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Iterator, Sequence
from importlib import metadata, util
from pathlib import Path

# The packages whose source determines numbers and outcomes
OWN_PACKAGES = "pinstress", "pinbase", "loads", "geometry", "fea", "assess", "reports"
MISSING_VERSION = "missing"
SOURCE_HASH_DIGITS = 8


def versions(packages: Sequence[str]) -> dict[str, str]:
    """Return the versions of Python, of this program with the start of the hash of its source, and
    of packages; MISSING_VERSION for a package that is not installed.

    "code for" names the variant of the code that the program uses on this system
    (pinbase.platform); results of the two variants differ in their last digits.
    """
    portable = sys.platform != "linux" or os.environ.get("PINSTRESS_PORTABLE") == "1"
    known = {
        "Python": f"{sys.version_info.major}.{sys.version_info.minor}",
        "code for": "all systems" if portable else "Linux",
        "pinstress": _ours(),
    }
    return known | {name: _version(name) for name in packages}


def _ours() -> str:
    digest = hashlib.sha256()
    for name in OWN_PACKAGES:
        spec = util.find_spec(name)
        if spec is None or not spec.submodule_search_locations:
            return MISSING_VERSION
        for path, content in _sources(Path(next(iter(spec.submodule_search_locations)))):
            digest.update(f"{name}/{path} {len(content)}\n".encode() + content)
    return f"{_version('pinstress')}, source {digest.hexdigest()[:SOURCE_HASH_DIGITS]}"


def _sources(root: Path) -> Iterator[tuple[str, bytes]]:
    paths = {path.relative_to(root).as_posix(): path for path in root.rglob("*.py")}
    return ((name, paths[name].read_bytes().replace(b"\r\n", b"\n")) for name in sorted(paths))


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return MISSING_VERSION

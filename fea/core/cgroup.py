"""What memory the control groups of this process leave it: a container, a batch job, a service.

The kernel ends a process that passes the limit of any group it is in, however much is free on the
machine, and /proc/meminfo does not know of groups.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

MB = 2.0**20
UNLIMITED = 2**62  # bytes


@dataclass(frozen=True)
class _Version:
    """How a version of control groups calls things. limits: any of them may be set."""

    mounted: str
    limits: tuple[str, ...]
    used: str
    reclaimable: str  # page cache that the kernel drops when memory gets short


_SECOND = _Version("", ("memory.max", "memory.high"), "memory.current", "inactive_file")
_FIRST = _Version(
    "memory", ("memory.limit_in_bytes",), "memory.usage_in_bytes", "total_inactive_file"
)


def free_in_groups(root: Path = Path("/")) -> float:
    """MB that this process may still take before it passes the limit of a control group; infinite
    where there is no limit. root: of the file system, for tests.
    """
    return min((_free(folder, version) for folder, version in _groups(root)), default=float("inf"))


def _groups(root: Path) -> Iterator[tuple[Path, _Version]]:
    """The folders of the groups that this process is in, each group's parents too.

    In a container the path may be the host's, and the container's own group may stand at the top of
    what is mounted: the walk up from a path that is not there ends at the top as well.
    """
    for line in _read(root / "proc" / "self" / "cgroup").splitlines():
        number, _, rest = line.partition(":")
        controllers, _, path = rest.partition(":")
        if number == "0" and not controllers:
            version = _SECOND
        elif "memory" in controllers.split(","):
            version = _FIRST
        else:
            continue
        parts = [p for p in PurePosixPath(path).parts if p not in ("/", "..")]
        top = root / "sys" / "fs" / "cgroup" / version.mounted
        for depth in range(len(parts), -1, -1):
            yield top.joinpath(*parts[:depth]), version


def _free(folder: Path, version: _Version) -> float:
    limits = [_number(_read(folder / name)) for name in version.limits]
    limit = min((n for n in limits if n is not None), default=None)
    used = _number(_read(folder / version.used))
    if limit is None or used is None:
        return float("inf")
    found = re.search(rf"^{version.reclaimable} (\d+)$", _read(folder / "memory.stat"), re.M)
    kept = used - (int(found[1]) if found else 0)
    return max(0.0, limit - kept) / MB


def _read(path: Path) -> str:
    try:
        return path.read_text()
    except OSError:  # no such group here, or no such limit
        return ""


def _number(text: str) -> int | None:
    """Bytes; None for what is not there, for "max" and for what the first version says instead."""
    value = int(text) if text.strip().isdecimal() else UNLIMITED
    return value if value < UNLIMITED else None

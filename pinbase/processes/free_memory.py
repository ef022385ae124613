"""The memory that is available to a process.

The kernel ends a process that exceeds the limit of any of its control groups (a container, a batch
job, a service), however much memory is free on the machine. /proc/meminfo does not show these
limits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from pinbase.platform import portable

MB = 2.0**20
UNLIMITED_BYTES = 2**62  # bytes: a group without a limit reports this number or more
ASSUMED_FREE_MB = 4096.0  # MB that are assumed free where the system does not report it


def free_memory(root: Path = Path("/")) -> float:
    """Memory available to new processes, MB, within the limits of control groups.

    It is ASSUMED_FREE_MB where the system does not report it.
    root: root of the file system, for tests.
    """
    if portable():
        return ASSUMED_FREE_MB
    try:
        available = re.search(r"MemAvailable:\s+(\d+)", (root / "proc" / "meminfo").read_text())
    except OSError:
        available = None
    return min(float(available[1]) / 1024.0 if available else ASSUMED_FREE_MB, free_in_groups(root))


@dataclass(frozen=True)
class _Version:
    """The file names of one version of control groups. limits: files, of which any may be set."""

    mounted: str
    limits: tuple[str, ...]
    used: str
    reclaimable: str  # page cache that the kernel drops when memory runs short


_CGROUP_V2 = _Version("", ("memory.max", "memory.high"), "memory.current", "inactive_file")
_CGROUP_V1 = _Version(
    "memory", ("memory.limit_in_bytes",), "memory.usage_in_bytes", "total_inactive_file"
)


def free_in_groups(root: Path = Path("/")) -> float:
    """Memory, MB, that this process may still take within the limits of its control groups.

    It is infinite where there is no limit.
    root: root of the file system, for tests.
    """
    return min((_free(folder, version) for folder, version in _groups(root)), default=float("inf"))


def _groups(root: Path) -> Iterator[tuple[Path, _Version]]:
    """The folders of the groups of this process, including the parents of each group.

    In a container the path may be the host's, while the container's own group is at the top of the
    mounted tree. The walk up from a path that does not exist also ends at the top.
    """
    for line in _read(root / "proc" / "self" / "cgroup").splitlines():
        number, _, rest = line.partition(":")
        controllers, _, path = rest.partition(":")
        if number == "0" and not controllers:
            version = _CGROUP_V2
        elif "memory" in controllers.split(","):
            version = _CGROUP_V1
        else:
            continue
        parts = [p for p in PurePosixPath(path).parts if p not in ("/", "..")]
        top = root / "sys" / "fs" / "cgroup" / version.mounted
        for depth in range(len(parts), -1, -1):
            yield top.joinpath(*parts[:depth]), version


def _free(folder: Path, version: _Version) -> float:
    """Memory, MB, that a group may still take; infinite without a limit."""
    limits = [_number(_read(folder / name)) for name in version.limits]
    limit = min((n for n in limits if n is not None), default=None)
    used = _number(_read(folder / version.used))
    if limit is None or used is None:
        return float("inf")
    reclaimable = re.search(rf"^{version.reclaimable} (\d+)$", _read(folder / "memory.stat"), re.M)
    resident = used - (int(reclaimable[1]) if reclaimable else 0)
    return max(0.0, limit - resident) / MB


def _read(path: Path) -> str:
    try:
        return path.read_text()
    except OSError:  # no such group here, or no such limit
        return ""


def _number(text: str) -> int | None:
    """Number of bytes; None for a missing file, for "max", and for version 1's number for it."""
    value = int(text) if text.strip().isdecimal() else UNLIMITED_BYTES
    return value if value < UNLIMITED_BYTES else None

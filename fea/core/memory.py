"""An estimate of the memory that a model needs, and the memory available.

The kernel ends a process that passes the limit of any control group it is in (a container, a batch
job, a service), however much is free on the machine, and /proc/meminfo does not know of groups.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from fea.core.linear_solver import SolveError, has_cholmod, has_metis
from pinbase.platform import portable

# Measured, including all unit loads of a pin (docs/benchmarks.md, benchmarks.pins.linear_solvers):
# 61,000 unknowns 0.37 GB, 115,000 0.79, 128,000 0.96, 415,000 5.05.
MB_PER_UNKNOWN = 8e-3  # MB, while factors are sparse
MIN_DENSE_UNKNOWNS = 130_000.0  # unknowns; from here on it grows with their number to the 4/3
# That is with CHOLMOD and METIS. Of 18,000 and 54,000 unknowns a factor takes with one of them 1.1
# to 1.5 times as much; with neither 1.6 and 2.2 times, and more the larger it is.
FILL_WITH_ONE_LIBRARY, FILL_WITH_NO_LIBRARY, FILL_GROWTH_UNKNOWNS = 1.5, 1.6, 25_000.0
# Of a section, in MB: 54,000 unknowns and 10 unit loads took 0.22 GB, 216,000 and 10 0.93, 25,000
# and 294 1.14.
SECTION_MB_PER_UNKNOWN, SECTION_MB_PER_LOAD = 2.8e-3, 1.5e-4  # per unknown; and per unit load
# Of a local solid (fea.cut.two_level), in MB: under 6 unit loads 52,000 unknowns took 0.43 GB
# and 256,000 1.4, with 0.13 of them for the program.
LOCAL_MB_PER_UNKNOWN, LOCAL_MB_PER_LOAD = 5e-3, 1.5e-4  # per unknown; and per unit load
MEMORY_SHARE = 0.8  # of the free memory
MB = 2.0**20
UNLIMITED_BYTES = 2**62  # bytes: what groups without a limit say
ASSUMED_FREE_MB = 4096.0  # MB that are free where the system does not say


def solid_memory(unknowns: float) -> float:
    """Peak memory, MB, of a solid with that many unknowns: mesh, factor and stresses."""
    best = float(MB_PER_UNKNOWN * unknowns * max(1.0, unknowns / MIN_DENSE_UNKNOWNS) ** (1.0 / 3.0))
    if has_cholmod() and has_metis():
        return best
    if has_cholmod() or has_metis():
        return FILL_WITH_ONE_LIBRARY * best
    return FILL_WITH_NO_LIBRARY * best * math.sqrt(max(1.0, unknowns / FILL_GROWTH_UNKNOWNS))


def section_memory(unknowns: float, loads: int) -> float:
    """Memory, MB, of a section with that many unknowns and unit loads."""
    return unknowns * (SECTION_MB_PER_UNKNOWN + SECTION_MB_PER_LOAD * loads)


def local_memory(unknowns: float, loads: int) -> float:
    """Memory, MB, of a local solid with that many unknowns and unit loads."""
    return unknowns * (LOCAL_MB_PER_UNKNOWN + LOCAL_MB_PER_LOAD * loads)


def free_memory(root: Path = Path("/")) -> float:
    """Memory available to new processes, MB, within the limits of control groups.

    It is ASSUMED_FREE_MB where the system does not report it.
    root: of the file system, for tests.
    """
    if portable():
        return ASSUMED_FREE_MB
    try:
        available = re.search(r"MemAvailable:\s+(\d+)", (root / "proc" / "meminfo").read_text())
    except OSError:
        available = None
    return min(float(available[1]) / 1024.0 if available else ASSUMED_FREE_MB, free_in_groups(root))


def allowed_memory(limit: float | None) -> float:
    """Memory that may be used, MB: the limit if there is one, else most of the free memory."""
    return MEMORY_SHARE * free_memory() if limit is None else limit


def too_much(
    unknowns: float, limit: float | None, section_loads: int = 0, local_loads: int = 0
) -> str:
    """The memory that a model needs and the memory allowed, as text; empty if that is enough.

    unknowns: of a solid, or of a section or local solid with that many unit loads.
    limit: MB.
    """
    allowed = allowed_memory(limit)
    if section_loads:
        need = section_memory(unknowns, section_loads)
    elif local_loads:
        need = local_memory(unknowns, local_loads)
    else:
        need = solid_memory(unknowns)
    if need <= allowed:
        return ""
    return (
        f"{unknowns:,.0f} unknowns would need about {need / 1024.0:.2g} GB of memory, "
        f"and {allowed / 1024.0:.2g} GB are allowed (--memory-limit)"
    )


def require_memory(name: str, unknowns: int, limit: float | None) -> None:
    """Check that a solid needs no more memory than is allowed. limit: MB.

    Raises: SolveError.
    """
    if excess := too_much(unknowns, limit):
        raise SolveError(
            f"pin {name}: {excess}: close other programs, allow more, increase --tolerance, give a "
            "coarser mesh if it comes from a file, or model the critical part on its own",
            "memory-limit",
        )


@dataclass(frozen=True)
class _Version:
    """The file names of one version of control groups. limits: any of them may be set."""

    mounted: str
    limits: tuple[str, ...]
    used: str
    reclaimable: str  # page cache that the kernel drops when memory gets short


_CGROUP_V2 = _Version("", ("memory.max", "memory.high"), "memory.current", "inactive_file")
_CGROUP_V1 = _Version(
    "memory", ("memory.limit_in_bytes",), "memory.usage_in_bytes", "total_inactive_file"
)


def free_in_groups(root: Path = Path("/")) -> float:
    """Memory, MB, that this process may still take within the limits of its control groups.

    It is infinite where there is no limit.
    root: of the file system, for tests.
    """
    return min((_free(folder, version) for folder, version in _groups(root)), default=float("inf"))


def _groups(root: Path) -> Iterator[tuple[Path, _Version]]:
    """The folders of the groups that this process is in, each group's parents too.

    In a container the path may be the host's, and the container's own group may be at the top of
    what is mounted: the walk up from a path that does not exist ends at the top as well.
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
    """Bytes; None for a missing file, "max" and the number by which version 1 says the same."""
    value = int(text) if text.strip().isdecimal() else UNLIMITED_BYTES
    return value if value < UNLIMITED_BYTES else None

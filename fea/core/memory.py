"""An estimate of the memory that a model needs, and the memory available."""

from __future__ import annotations

import math
import re
from pathlib import Path

from fea.core.cgroup import free_in_groups
from fea.core.linear_solver import SolveError, has_cholmod, has_metis
from geometry.system import bare

# Measured, including all unit loads of a pin (docs/benchmarks.md, benchmarks.linear_solvers):
# 61,000 unknowns 0.37 GB, 115,000 0.79, 128,000 0.96, 415,000 5.05.
PER_UNKNOWN = 8e-3  # MB, while factors are sparse
DENSE = 130_000.0  # unknowns; from here on it grows with their number to the 4/3
# That is with CHOLMOD and METIS. Of 18,000 and 54,000 unknowns a factor takes with one of them 1.1
# to 1.5 times as much; with neither 1.6 and 2.2 times, and more the larger it is.
WITH_ONE, WITH_NEITHER, FILLS = 1.5, 1.6, 25_000.0
# Of a section, in MB: 54,000 unknowns and 10 unit loads took 0.22 GB, 216,000 and 10 0.93, 25,000
# and 294 1.14.
SECTION, SECTION_LOAD = 2.8e-3, 1.5e-4  # per unknown; and per unit load
SHARE = 0.8  # of the free memory
ASSUMED = 4096.0  # MB that are free where the system does not say


def solid_memory(unknowns: float) -> float:
    """Largest memory of a solid of so many unknowns, MB: mesh, factor and stresses."""
    best = float(PER_UNKNOWN * unknowns * max(1.0, unknowns / DENSE) ** (1.0 / 3.0))
    if has_cholmod() and has_metis():
        return best
    if has_cholmod() or has_metis():
        return WITH_ONE * best
    return WITH_NEITHER * best * math.sqrt(max(1.0, unknowns / FILLS))


def section_memory(unknowns: float, loads: int) -> float:
    """Memory of a section of so many unknowns and unit loads, MB."""
    return unknowns * (SECTION + SECTION_LOAD * loads)


def free_memory(root: Path = Path("/")) -> float:
    """Memory available to new processes, MB, within the limits of control groups; ASSUMED where the
    system does not report it. root: of the file system, for tests.
    """
    if bare():
        return ASSUMED
    try:
        found = re.search(r"MemAvailable:\s+(\d+)", (root / "proc" / "meminfo").read_text())
    except OSError:
        found = None
    return min(float(found[1]) / 1024.0 if found else ASSUMED, free_in_groups(root))


def allowed_memory(limit: float | None) -> float:
    """MB: the limit, or most of the free memory."""
    return SHARE * free_memory() if limit is None else limit


def too_much(unknowns: float, limit: float | None, section_loads: int = 0) -> str:
    """The memory that a solid, or a section under unit loads, needs and the memory allowed, as
    text; empty if that is enough.
    """
    allowed = allowed_memory(limit)
    need = section_memory(unknowns, section_loads) if section_loads else solid_memory(unknowns)
    if need <= allowed:
        return ""
    return (
        f"{unknowns:,.0f} unknowns would need about {need / 1024.0:.2g} GB of memory, "
        f"and {allowed / 1024.0:.2g} GB are allowed (--memory-limit)"
    )


def require_memory(name: str, unknowns: int, limit: float | None) -> None:
    """Raises: SolveError when a solid would need more memory than is allowed."""
    if excess := too_much(unknowns, limit):
        raise SolveError(
            f"pin {name}: {excess}: close other programs, allow more, increase --tolerance, give a "
            "coarser mesh if it comes from a file, or model the critical part on its own",
            "memory-limit",
        )

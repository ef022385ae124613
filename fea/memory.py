"""What memory the solid model takes, before it takes it; and what there is."""

from __future__ import annotations

import re
from pathlib import Path

from fea.linear import SolveError

# Measured, all unit loads of a pin included (docs/benchmarks.md, benchmarks.linear_solvers):
# 61,000 unknowns 0.37 GB, 115,000 0.79, 128,000 0.96, 415,000 5.05.
PER_UNKNOWN = 8e-3  # MB, while factors are sparse
DENSE = 130_000.0  # unknowns; from here on it grows with their number to the 4/3
SHARE = 0.8  # of the free memory


def solid_memory(unknowns: float) -> float:
    """MB that a solid of so many unknowns takes at most, mesh, factor and stresses."""
    return float(PER_UNKNOWN * unknowns * max(1.0, unknowns / DENSE) ** (1.0 / 3.0))


def free_memory() -> float:
    """MB that new processes may take; infinite where the kernel does not say."""
    try:
        found = re.search(r"MemAvailable:\s+(\d+)", Path("/proc/meminfo").read_text())
    except OSError:
        found = None
    return float(found[1]) / 1024.0 if found else float("inf")


def allowed_memory(limit: float | None) -> float:
    """MB: the limit, or most of what is free."""
    return SHARE * free_memory() if limit is None else limit


def require_memory(name: str, unknowns: int, limit: float | None) -> None:
    """Raises: SolveError when a solid would take more memory than is allowed."""
    allowed, need = allowed_memory(limit), solid_memory(unknowns)
    if need > allowed:
        raise SolveError(
            f"pin {name}: {unknowns:,} unknowns would take about {need / 1024.0:.2g} GB of memory, "
            f"and {allowed / 1024.0:.2g} GB are allowed: close other programs, set --memory-limit, "
            "or model the part that matters by itself"
        )

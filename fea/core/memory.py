"""The estimated memory that a model needs, and the memory that is allowed."""

from __future__ import annotations

import math

from fea.core.linear_solver import SolveError, has_cholmod, has_metis
from pinbase.processes.free_memory import free_memory

# Measured, including all unit loads of a pin (docs/benchmarks.md, benchmarks.pins.linear_solvers):
# 61,000 unknowns 0.37 GB, 115,000 0.79, 128,000 0.96, 415,000 5.05.
MB_PER_UNKNOWN = 8e-3  # MB, while factors are sparse
# Number of unknowns from which on memory grows with their number to the power 4/3.
MIN_DENSE_UNKNOWNS = 130_000.0
# These values are for CHOLMOD and METIS. With only one of them, a factor of 18,000 and 54,000
# unknowns takes 1.1 to 1.5 times as much; with neither 1.6 and 2.2 times, and more for more
# unknowns.
FILL_WITH_ONE_LIBRARY, FILL_WITH_NO_LIBRARY, FILL_GROWTH_UNKNOWNS = 1.5, 1.6, 25_000.0
# Memory of a section, measured: 54,000 unknowns with 10 unit loads took 0.22 GB, 216,000 with 10
# 0.93 GB, and 25,000 with 294 1.14 GB.
SECTION_MB_PER_UNKNOWN, SECTION_MB_PER_LOAD = 2.8e-3, 1.5e-4  # per unknown; and per unit load
# Memory of a local solid (fea.cut.two_level), measured with 6 unit loads: 52,000 unknowns took 0.43
# GB and 256,000 1.4 GB, of which the program takes 0.13 GB.
LOCAL_MB_PER_UNKNOWN, LOCAL_MB_PER_LOAD = 5e-3, 1.5e-4  # per unknown; and per unit load
MEMORY_SHARE = 0.8  # of the free memory


def solid_memory(unknowns: float) -> float:
    """The peak memory of a solid, MB: mesh, factor and stresses."""
    best = float(MB_PER_UNKNOWN * unknowns * max(1.0, unknowns / MIN_DENSE_UNKNOWNS) ** (1.0 / 3.0))
    if has_cholmod() and has_metis():
        return best
    if has_cholmod() or has_metis():
        return FILL_WITH_ONE_LIBRARY * best
    return FILL_WITH_NO_LIBRARY * best * math.sqrt(max(1.0, unknowns / FILL_GROWTH_UNKNOWNS))


def section_memory(unknowns: float, loads: int) -> float:
    """The memory of a section with a number of unknowns and of unit loads, MB."""
    return unknowns * (SECTION_MB_PER_UNKNOWN + SECTION_MB_PER_LOAD * loads)


def local_memory(unknowns: float, loads: int) -> float:
    """The memory of a local solid with a number of unknowns and of unit loads, MB."""
    return unknowns * (LOCAL_MB_PER_UNKNOWN + LOCAL_MB_PER_LOAD * loads)


def allowed_memory(limit: float | None) -> float:
    """The memory that may be used, MB: the limit if there is one, else most of the free memory."""
    return MEMORY_SHARE * free_memory() if limit is None else limit


def _needed(unknowns: float, section_loads: int, local_loads: int) -> float:
    """The memory of a model, MB: of a section or local solid if a number of its unit loads is
    given, otherwise of a solid.
    """
    if section_loads:
        return section_memory(unknowns, section_loads)
    return local_memory(unknowns, local_loads) if local_loads else solid_memory(unknowns)


def most_unknowns(limit: float | None, local_loads: int = 0) -> float:
    """The largest number of unknowns for which the allowed memory is enough.

    limit: of memory, MB.
    local_loads: number of unit loads of a local solid; 0 for a solid.
    """
    allowed, low, high = allowed_memory(limit), 1.0, 1e12
    while high > 1.001 * low:
        middle = math.sqrt(low * high)
        fits = _needed(middle, 0, local_loads) <= allowed
        low, high = (middle, high) if fits else (low, middle)
    return low


def too_much(
    unknowns: float, limit: float | None, section_loads: int = 0, local_loads: int = 0
) -> str:
    """The memory that a model needs and the memory allowed, as text; empty if that is enough.

    limit: of memory, MB.
    section_loads, local_loads: number of unit loads of a section or of a local solid; both 0 for a
    solid.
    """
    need, allowed = _needed(unknowns, section_loads, local_loads), allowed_memory(limit)
    if need <= allowed:
        return ""
    return (
        f"{unknowns:,.0f} unknowns would need about {need / 1024.0:.2g} GB of memory, "
        f"and {allowed / 1024.0:.2g} GB are allowed (--memory-limit)"
    )


def require_memory(name: str, unknowns: int, limit: float | None) -> None:
    """Check that a solid needs no more memory than is allowed. limit: of memory, MB.

    Raises: SolveError.
    """
    if excess := too_much(unknowns, limit):
        raise SolveError(
            f"pin {name}: {excess}: close other programs, allow more, increase --tolerance, give a "
            "coarser mesh if it comes from a file, or model the critical part on its own",
            "memory-limit",
        )

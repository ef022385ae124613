"""An estimate of the memory that a model needs, beside the memory allowed."""

from __future__ import annotations

import math

from fea.core.linear_solver import SolveError, has_cholmod, has_metis
from pinbase.processes.free_memory import free_memory

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


def allowed_memory(limit: float | None) -> float:
    """Memory that may be used, MB: the limit if there is one, else most of the free memory."""
    return MEMORY_SHARE * free_memory() if limit is None else limit


def _needed(unknowns: float, section_loads: int, local_loads: int) -> float:
    """Memory, MB: of a solid, or of a section or local solid with that many unit loads."""
    if section_loads:
        return section_memory(unknowns, section_loads)
    return local_memory(unknowns, local_loads) if local_loads else solid_memory(unknowns)


def most_unknowns(limit: float | None, local_loads: int = 0) -> float:
    """The number of unknowns for which the memory is allowed: of a solid, or of a local solid with
    so many unit loads.

    limit: MB.
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

    unknowns: of a solid, or of a section or local solid with that many unit loads.
    limit: MB.
    """
    need, allowed = _needed(unknowns, section_loads, local_loads), allowed_memory(limit)
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

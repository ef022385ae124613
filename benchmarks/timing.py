"""Times as the least of a few runs, and tables in Markdown."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def seconds(work: Callable[[], object], runs: int = 3) -> float:
    """Least wall time of a few runs, s."""
    best = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return best


def table(head: tuple[str, ...], rows: Iterable[tuple[object, ...]]) -> str:
    """A Markdown table."""
    lines = [head, tuple("---" for _ in head), *rows]
    return "\n".join("| " + " | ".join(_text(c) for c in line) + " |" for line in lines)


def _text(cell: object) -> str:
    return f"{cell:.3g}" if isinstance(cell, float) else str(cell)


def power(size: Floats, cost: Floats) -> float:
    """The power of the size with which a cost grows, by least squares of the logarithms."""
    return float(np.polyfit(np.log(size), np.log(cost), 1)[0])

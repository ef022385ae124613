"""Times as the least of a few runs, and tables in Markdown."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def seconds(work: Callable[[], object], runs: int = 3) -> float:
    """Return the least wall time of a few runs, s."""
    best = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return best


def table(head: tuple[str, ...], rows: Iterable[tuple[object, ...]]) -> str:
    """Return a Markdown table; columns of numbers are aligned to the right."""
    body = [[_text(c) for c in row] for row in rows]
    columns = zip(*body, strict=True) if body else [()] * len(head)
    rule = ["---:" if any(c) and all(map(_numeric, c)) else "---" for c in columns]
    return "\n".join("| " + " | ".join(line) + " |" for line in [head, rule, *body])


def _text(cell: object) -> str:
    return f"{cell:.3g}" if isinstance(cell, float) else str(cell)


def _numeric(cell: str) -> bool:
    return not cell or bool(re.fullmatch(r"[-+−]?\d[\d.,]*(e[-+]?\d+)?%?|nan|-", cell))


def power(size: Floats, cost: Floats) -> float:
    """Return the power of the size with which a cost grows, by least squares of the logarithms."""
    return float(np.polyfit(np.log(size), np.log(cost), 1)[0])

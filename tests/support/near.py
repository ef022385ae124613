"""`pytest.approx` for numbers in SI, which may be small."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

PLAIN = pytest.approx
ROUND_OFF = 1e-12  # pytest's own absolute tolerance


def scaled(
    expected: Any, rel: float | None = None, abs: float | None = None, nan_ok: bool = False
) -> Any:
    """`pytest.approx` with an absolute tolerance that is never more than ROUND_OFF of the largest
    number expected.

    pytest adds its 1e-12 to any relative tolerance. So a flexibility of 1e-13 m/Pa was near any
    other, and its tests could not fail.
    """
    if abs is None and (size := _largest(expected)) < 1.0:
        abs = ROUND_OFF * size
        rel = 1e-6 if rel is None else rel  # pytest has none beside an absolute one
    return PLAIN(expected, rel=rel, abs=abs, nan_ok=nan_ok)


def _largest(expected: Any) -> float:
    """The largest finite size of the numbers expected; 1 where all are zero or some are none."""
    numbers = list(expected.values()) if isinstance(expected, Mapping) else expected
    try:
        sizes = np.abs(np.asarray(numbers, dtype=complex))
    except (TypeError, ValueError):
        return 1.0
    sizes = sizes[np.isfinite(sizes)]
    return float(sizes.max(initial=0.0)) or 1.0

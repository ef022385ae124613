"""Sobol indices of the safety factors, which show what drives the risk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm, sobol_indices
from scipy.stats import t as student

from reports.data.reliability import Spread

Array = NDArray[np.float64]

SCRAMBLED_SETS = 8  # independently scrambled sets, whose scatter gives the confidence intervals


def base_samples(samples: int) -> int:
    """Return the size of each set, a power of two; 0 if there are too few samples."""
    size = samples // SCRAMBLED_SETS
    return 2 ** (size.bit_length() - 1) if size >= 2 else 0


def indices(
    factors: Callable[[Array], Array], size: int, base: int, seed: int, confidence: float
) -> list[list[tuple[Spread, Spread]]] | None:
    """Return the first-order and total index of each output and each variable; None if any output
    is not finite.

    factors: a function from designs (n, d) to outputs (n, s).
    size: number d of independent standard normal variables.
    base: size of each scrambled set.
    """
    standard: Any = norm()
    first, total = [], []
    for k in range(SCRAMBLED_SETS):
        lost = False

        def outputs(x: Array) -> Array:
            nonlocal lost
            values = factors(np.ascontiguousarray(x.T)).T
            lost = lost or not np.isfinite(values).all()
            return np.where(np.isfinite(values), values, 0.0)

        rng = np.random.default_rng([seed, 2, k])
        with np.errstate(invalid="ignore", divide="ignore"):  # for an output that does not vary
            estimate = sobol_indices(func=outputs, n=base, dists=[standard] * size, rng=rng)
        if lost:
            return None
        first.append(np.atleast_2d(estimate.first_order))
        total.append(np.atleast_2d(estimate.total_order))
    both = [_bounded(np.stack(values), confidence) for values in (first, total)]
    return [[(a, b) for a, b in zip(*rows, strict=True)] for rows in zip(*both, strict=True)]


def _bounded(values: Array, confidence: float) -> list[list[Spread]]:
    """Return the mean and confidence interval of values (sets, s, d)."""
    mean = values.mean(axis=0)
    deviate = float(student.ppf(0.5 + 0.5 * confidence, SCRAMBLED_SETS - 1))
    half = deviate * values.std(axis=0, ddof=1) / np.sqrt(SCRAMBLED_SETS)
    return [
        [Spread(float(m), float(m - h), float(m + h)) for m, h in zip(*rows, strict=True)]
        for rows in zip(mean, half, strict=True)
    ]

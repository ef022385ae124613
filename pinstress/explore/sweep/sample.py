"""The designs of a sweep: values of the parameters, reproducible by a seed."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from pinstress.explore.sweep.correlations import root_of
from pinstress.explore.sweep.laws import Floats, Uniform
from pinstress.explore.sweep.parameters import Parameter
from pinstress.study.schema.vary import VaryTable

# Smallest distance of a probability from 0 and 1, where a normal law is infinite
MIN_PROBABILITY = 2.0**-53


def designs_of(
    vary: VaryTable, parameters: Sequence[Parameter], correlations: Floats | None = None
) -> Floats:
    """Return values (N, p) in SI, a row for each design.

    correlations: (p, p) correlation matrix of the normal variables; None if independent.
    """
    if vary.sample == "grid":
        axes = np.meshgrid(*map(_on_grid, parameters), indexing="ij")
        return np.stack([axis.ravel() for axis in axes], axis=1)
    u = np.clip(_points(vary, len(parameters)), MIN_PROBABILITY, 1.0 - MIN_PROBABILITY)
    if correlations is None:
        return np.stack([p.quantile(u[:, k]) for k, p in enumerate(parameters)], axis=1)
    from scipy.special import ndtri

    correlated = np.any(correlations != np.eye(len(parameters)), axis=0)
    z = ndtri(u) @ root_of(correlations).T
    columns = [
        p.of_normal(z[:, k]) if correlated[k] else p.quantile(u[:, k])
        for k, p in enumerate(parameters)
    ]
    return np.stack(columns, axis=1)


def _on_grid(parameter: Parameter) -> Floats:
    """Return the values of a parameter on a grid: evenly spaced for a uniform law, else the medians
    of equally likely parts.
    """
    steps = parameter.steps or 1
    if isinstance(parameter.law, Uniform):
        if steps == 1:
            return np.array([parameter.law.low])
        return np.linspace(parameter.law.low, parameter.law.high, steps)
    return parameter.quantile((np.arange(steps) + 0.5) / steps)


def _points(vary: VaryTable, count: int) -> Floats:
    """Return points (N, p) of the unit cube."""
    from scipy.stats import qmc

    if vary.sample == "random":
        return np.random.default_rng(vary.seed).random((vary.count, count))
    engine = qmc.Sobol if vary.sample == "sobol" else qmc.LatinHypercube
    # SciPy warns of a count that is not a power of 2, which docs/sweep.md explains.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        points = engine(count, rng=np.random.default_rng(vary.seed)).random(vary.count)
    return np.asarray(points, np.float64)

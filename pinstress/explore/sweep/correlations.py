"""The checked correlations of parameters with normal laws."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pinstress.explore.sweep.laws import Floats, Normal
from pinstress.explore.sweep.parameters import Parameter
from pinstress.study.reading.file import Study
from pinstress.study.schema.shown import as_text, near

EIGENVALUE_ROUND_OFF = 1e-12  # size of an eigenvalue that is only round-off


def correlations_of(
    study: Study, parameters: Sequence[Parameter], sampled: bool = True
) -> Floats | None:
    """Return the correlation matrix (p, p) of the parameters' normal variables; None where all are
    independent.

    sampled: whether [vary] states which designs to sample.

    Raises: InputError for pairs that cannot be correlated, and for a matrix that is not positive
    semidefinite.
    """
    vary = study.table.vary
    if vary is None or not vary.correlations:
        return None
    if sampled and vary.sample == "grid":
        raise study.error(
            "vary.correlations: a grid has all combinations, whatever their probability; choose "
            'another sample, such as sample = "sobol"',
            code="grid-with-correlations",
        )
    keys = [p.key for p in parameters]
    matrix = np.eye(len(keys))
    for i, pair in enumerate(vary.correlations, 1):
        where = f"vary.correlations[{i}].between"
        rows = []
        for key in pair.between:
            if key not in keys:
                raise study.error(
                    f"{where}: {as_text(key)} is not in [vary.parameters]; {near(key, keys)}",
                    code="unknown-parameter",
                )
            rows.append(keys.index(key))
            law = parameters[rows[-1]].law
            if not isinstance(law, Normal) or law.cut_off:
                raise study.error(
                    f"{where}: {as_text(key)} has no normal law, or one that is cut off; only "
                    "numbers with normal laws can be correlated",
                    code="not-normal",
                )
        first, second = rows
        if first == second or matrix[first, second]:
            what = "twice the same key" if first == second else "the pair is given before"
            raise study.error(f"{where}: {what}", code="duplicate-parameter")
        matrix[first, second] = matrix[second, first] = pair.coefficient
    least = float(np.linalg.eigvalsh(matrix)[0])
    if least < -EIGENVALUE_ROUND_OFF:
        raise study.error(
            "vary.correlations: the correlation matrix is not positive semidefinite (the least "
            f"eigenvalue of their matrix is {least:.3g}, and must not be negative); if A goes with "
            "B and B with C, A must go with C",
            code="no-correlation-matrix",
        )
    return matrix


def root_of(matrix: Floats) -> Floats:
    """Return a matrix L (p, p) with L L^T = `matrix`, lower triangular unless that is singular."""
    try:
        return np.asarray(np.linalg.cholesky(matrix), np.float64)
    except np.linalg.LinAlgError:
        values, vectors = np.linalg.eigh(matrix)
        return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)), np.float64)

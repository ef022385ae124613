"""The growth of stress towards a singularity, measured on a mesh that is graded towards it.

Along the free surface the stress is A d^-s + B d^q at small distances d. The exponent s is fitted;
q is that of the next term, 0 where no other value is known. The sum of squares of relative
differences is minimised over s; A and B follow from s by linear least squares.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from pinbase.arrays import Floats

# Chosen by judgement; `python -m benchmarks corners` shows how exponents compare with theory.
MIN_FIT_POINTS = 8  # least number of points in the fit
MIN_DISTANCE_RATIO = 5.0  # least ratio of the largest to the smallest distance in the fit
MAX_FIT_ERROR = 0.05  # largest rms of relative differences: with more, stress is not a power
EXPONENT_LIMITS = (0.01, 0.95)  # limits of the fitted exponent


def growth_exponent(distance: Floats, stress: Floats, following: float = 0.0) -> float | None:
    """The exponent s of stress A d^-s + B d^q fitted to samples; None if they show no such growth.

    distance, stress: (J,) m and Pa.
    following: q.
    """
    if (
        len(distance) < MIN_FIT_POINTS
        or np.ptp(np.log(distance)) < np.log(MIN_DISTANCE_RATIO)
        or not np.all(stress > 0.0)
    ):
        return None
    # Distances over their geometric mean keep both terms of comparable size.
    d = distance / np.exp(np.log(distance).mean())

    from scipy.optimize import minimize_scalar  # takes long to import

    # The amplitudes follow from s, so the search is over s alone.
    fitted = partial(_fitted, d, stress, following)
    best = minimize_scalar(lambda s: fitted(s)[0], bounds=EXPONENT_LIMITS, method="bounded")
    square, amplitude = fitted(float(best.x))
    return float(best.x) if amplitude > 0.0 and square < MAX_FIT_ERROR**2 else None


def singular_intensity(
    distance: Floats, stress: Floats, exponent: float, following: float = 0.0
) -> float:
    """The factor A, Pa m^s, of stress A d^-s + B d^q for a known exponent s.

    distance: (J,) m.
    stress: (J,) Pa.
    exponent: s.
    following: q.
    """
    mean = float(np.exp(np.log(distance).mean()))
    return float(_fitted(distance / mean, stress, following, exponent)[1] * mean**exponent)


def _fitted(d: Floats, stress: Floats, following: float, s: float) -> tuple[float, float]:
    """The mean square of the relative error of A d^-s + B d^q fitted to stress, and A."""
    terms = np.stack([d**-s, d**following], axis=1) / stress[:, None]
    parts = np.linalg.lstsq(terms, np.ones(len(d)), rcond=None)[0]
    return float(np.mean((terms @ parts - 1.0) ** 2)), float(parts[0])

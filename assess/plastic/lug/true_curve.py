"""The true stress-strain curve of a metal from the two strengths of its tensile test."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from fea.core.material import Material
from geometry import ArgumentError

OFFSET = 0.002  # plastic strain at which the yield strength is measured
MAX_EXPONENT = 0.6  # no metal hardens more
# Plastic strains at the ends of the linear pieces. Flow begins at the first; the last exceeds any
# strain at which a lug carries its largest load.
FIRST_STRAIN, LAST_STRAIN, PIECES = 1e-4, 3.0, 60


def true_curve(material: Material) -> Material:
    """Return the material with the power law of true stress, K e^n, that its two strengths define.

    The law gives the yield strength at a plastic strain of 0.002. Its largest engineering stress,
    K n^n exp(-n) at e = n (Considere), is the ultimate strength. No value is fitted to lugs. The
    elongation at fracture is not used, because it includes the neck.

    Raises: ArgumentError if a strength is missing or no hardening exponent leads from one strength
    to the other.
    """
    low, high = material.yield_strength, material.ultimate_strength
    if low is None or high is None:
        raise ArgumentError(
            f"material {material.name} needs a yield strength and an ultimate strength for its "
            "true stress-strain curve",
            "no-strength",
        )
    exponent = hardening_exponent(low, high)
    strain = np.concatenate([[FIRST_STRAIN], np.geomspace(2.0 * FIRST_STRAIN, LAST_STRAIN, PIECES)])
    stress = low * (strain / OFFSET) ** exponent
    return Material(
        material.name,
        material.youngs_modulus,
        material.poisson_ratio,
        yield_strength=float(stress[0]),
        hardening=tuple((float(e), float(s)) for e, s in zip(strain[1:], stress[1:], strict=True)),
    )


def hardening_exponent(yield_strength: float, ultimate_strength: float) -> float:
    """Return n of K e^n from the engineering strengths: ln(Rm / Re) = n (ln(n / 0.002) - 1).

    Raises: ArgumentError if the ultimate strength is not the larger one, or if n would exceed
    MAX_EXPONENT.
    """
    ratio = math.log(ultimate_strength / yield_strength) if yield_strength > 0.0 else 0.0

    def excess(n: float) -> float:
        return n * (math.log(n / OFFSET) - 1.0) - ratio

    # The right side of the equation rises from zero at n = e times the offset.
    least = math.e * OFFSET
    if not 0.0 < ratio < excess(MAX_EXPONENT) + ratio:
        raise ArgumentError(
            f"no hardening leads from a yield strength of {yield_strength:g} Pa to an ultimate "
            f"strength of {ultimate_strength:g} Pa",
            "out-of-range",
        )
    return float(brentq(excess, least, MAX_EXPONENT))

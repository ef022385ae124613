"""The true stress-strain curve of a metal from the two strengths of its tensile test."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from fea.core.material import Material
from geometry import ArgumentError

OFFSET = 0.002  # plastic strain at which the yield strength is measured
MAX_EXPONENT = 0.6  # no metal hardens more
# Plastic strains at the ends of straight pieces: the first is where flow begins, the last is larger
# than any at which a lug carries its largest load.
FIRST_STRAIN, LAST_STRAIN, PIECES = 1e-4, 3.0, 60


def true_curve(material: Material) -> Material:
    """The material with the power law of true stress, K e^n, that its two strengths define.

    At a plastic strain of 0.002 it is the yield strength, and the largest engineering stress, at
    e = n by Considere, is the ultimate strength: K n^n exp(-n). Nothing is fitted to lugs, and the
    elongation at fracture is not used: it contains the neck.

    Raises: ArgumentError where a strength is missing or the ultimate strength is not the larger.
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
    """n of K e^n: ln(Rm / Re) = n (ln(n / 0.002) - 1), engineering strengths.

    Raises: ArgumentError for strengths of which no metal hardens.
    """
    ratio = math.log(ultimate_strength / yield_strength) if yield_strength > 0.0 else 0.0

    def excess(n: float) -> float:
        return n * (math.log(n / OFFSET) - 1.0) - ratio

    # The left side rises from zero at e times the offset.
    least = math.e * OFFSET
    if not 0.0 < ratio < excess(MAX_EXPONENT) + ratio:
        raise ArgumentError(
            f"no hardening leads from a yield strength of {yield_strength:g} Pa to an ultimate "
            f"strength of {ultimate_strength:g} Pa",
            "out-of-range",
        )
    return float(brentq(excess, least, MAX_EXPONENT))

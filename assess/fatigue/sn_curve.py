"""Stress-life (Woehler) curves, mean stress correction and linear damage accumulation.

N = N_D (S_a / S_D)^-k for the amplitude S_a at stress ratio -1. Below the knee another slope may
hold; by default amplitudes below S_D do no damage. Lives scatter lognormally with T_N = N_90 % /
N_10 %. Damage is the Palmgren-Miner sum of n / N.

The mean stress is accounted for by an equivalent amplitude at stress ratio -1:

    fkm      Haigh diagram of four segments, M and M / 3      FKM guideline (2020), 4.4.2; pyLife
    goodman  S_a / (1 - S_m / R_m), from tension only         Goodman (1899)
    swt      sqrt(S_max S_a)                                  Smith, Watson, Topper (1970)
    walker   S_max^(1 - g) S_a^g                              Walker (1970)
    none     S_a
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite
from typing import TYPE_CHECKING, Literal

import numpy as np

from assess.fatigue.quiet import quiet
from pinbase.arrays import Floats

if TYPE_CHECKING:
    import pandas

MeanStress = Literal["none", "fkm", "goodman", "swt", "walker"]

SOFTENED_KNEE_RATIO = 0.95  # ratio by which the knee is lowered to rank planes without damage


@dataclass(frozen=True)
class Life:
    """An S-N curve at one failure probability, for the fast evaluation of many cycles.

    knee: amplitude, Pa, and cycles.
    slopes: above and below the knee.
    """

    knee: tuple[float, float]
    slopes: tuple[float, float]

    def damage(self, equivalent: Floats) -> Floats:
        """Return the damage (C,) of each cycle from its equivalent amplitude (C,), Pa."""
        ratio, (above, below) = equivalent / self.knee[0], self.slopes
        low = np.minimum(ratio, 1.0) ** below if isfinite(below) else 0.0
        return np.asarray(np.where(ratio >= 1.0, ratio**above, low) / self.knee[1])

    def softer(self, equivalent: Floats) -> Floats:
        """Return the damage (C,) if the slope above the knee continued down to SOFTENED_KNEE_RATIO
        times its amplitude.
        """
        ratio, damage = equivalent / self.knee[0], self.damage(equivalent)
        near = ratio ** self.slopes[0] / self.knee[1]
        return np.asarray(np.where((ratio >= SOFTENED_KNEE_RATIO) & (ratio < 1.0), near, damage))


@dataclass(frozen=True)
class SnCurve:
    """A stress-life curve.

    knee: amplitude S_D, Pa, and cycles N_D.
    slope: k above the knee.
    slope_below: k below the knee.
    scatter: T_N, 1 for none.
    probability: the failure probability of the curve.
    rule: the mean stress correction.
    parameter: M, R_m (Pa) or g, as the rule needs.
    """

    knee: tuple[float, float]
    slope: float
    slope_below: float = inf
    scatter: float = 1.0
    probability: float = 0.5
    rule: MeanStress = "none"
    parameter: float = 0.0

    def equivalent(self, amplitude: Floats, mean: Floats) -> Floats:
        """Return the equivalent amplitudes (C,), Pa, at stress ratio -1.

        amplitude, mean: (C,) of the cycles, Pa.
        """
        top = np.maximum(amplitude + mean, 0.0)
        if self.rule == "fkm":
            from pylife.strength.meanstress import fkm_goodman

            M = self.parameter
            with quiet():
                return np.asarray(fkm_goodman(amplitude, mean, M, M / 3.0, -1.0), dtype=float)
        if self.rule == "goodman":
            left = 1.0 - np.maximum(mean, 0.0) / self.parameter
            return np.where(left > 0.0, amplitude / np.where(left > 0.0, left, 1.0), inf)
        if self.rule == "swt":
            return np.sqrt(top * amplitude)
        if self.rule == "walker":
            return np.asarray(top ** (1.0 - self.parameter) * amplitude**self.parameter)
        return amplitude

    def cycles(self, amplitude: Floats, probability: float | None = None) -> Floats:
        """Return the cycles to failure (C,); infinite below a knee without a slope.

        probability: failure probability, by default that of the curve.
        """
        import pylife.materiallaws.woehlercurve  # noqa: F401, which teaches pandas

        wanted = self.probability if probability is None else probability
        with quiet():
            return np.asarray(self._series().woehler.cycles(amplitude, wanted), dtype=float)

    def life(self, probability: float | None = None) -> Life:
        """Return the curve at a failure probability, by default its own."""
        import pylife.materiallaws.woehlercurve  # noqa: F401, which teaches pandas

        wanted = self.probability if probability is None else probability
        with quiet():
            at = self._series().woehler.transform_to_failure_probability(wanted)
        return Life((float(at.SD), float(at.ND)), (self.slope, self.slope_below))

    def damage(
        self, equivalent: Floats, counts: Floats | float = 1.0, probability: float | None = None
    ) -> float:
        """Return the damage of cycles with equivalent amplitudes (C,), Pa.

        counts: occurrences of each amplitude.
        probability: failure probability, by default that of the curve.
        """
        if not len(equivalent):
            return 0.0
        with np.errstate(divide="ignore"):  # an infinite amplitude has no life
            return float((counts / self.cycles(equivalent, probability)).sum())

    def _series(self) -> pandas.Series:
        import pandas

        stress, cycles = self.knee
        data = {"SD": stress, "ND": cycles, "k_1": self.slope, "k_2": self.slope_below}
        data |= {"TN": self.scatter, "failure_probability": self.probability}
        return pandas.Series(data)

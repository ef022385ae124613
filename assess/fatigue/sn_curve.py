"""Stress-life (Woehler) curves, mean stress and linear damage.

N = N_D (S_a / S_D)^-k for the amplitude S_a at stress ratio -1, with another slope below the knee,
by default none: amplitudes below S_D do no damage. Lives scatter lognormally, by T_N = N_90 % /
N_10 %. Damage is Palmgren and Miner's sum of n / N.

Mean stress, as the equivalent amplitude at stress ratio -1:

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

SOFTENED_KNEE_RATIO = 0.95  # of the knee's amplitude: ranks planes that do no damage


@dataclass(frozen=True)
class Life:
    """An S-N curve at one failure probability, for many cycles in little time.

    knee: amplitude, Pa, and cycles.
    slopes: above and below it.
    """

    knee: tuple[float, float]
    slopes: tuple[float, float]

    def damage(self, equivalent: Floats) -> Floats:
        """The damage (C,) of each cycle, by its equivalent amplitude (C,), Pa."""
        ratio, (above, below) = equivalent / self.knee[0], self.slopes
        low = np.minimum(ratio, 1.0) ** below if isfinite(below) else 0.0
        return np.asarray(np.where(ratio >= 1.0, ratio**above, low) / self.knee[1])

    def softer(self, equivalent: Floats) -> Floats:
        """The damage (C,) if the slope above the knee went on to SOFTENED_KNEE_RATIO of it."""
        ratio, damage = equivalent / self.knee[0], self.damage(equivalent)
        near = ratio ** self.slopes[0] / self.knee[1]
        return np.asarray(np.where((ratio >= SOFTENED_KNEE_RATIO) & (ratio < 1.0), near, damage))


@dataclass(frozen=True)
class SnCurve:
    """A stress-life curve.

    knee: amplitude S_D, Pa, and cycles N_D.
    slope: k above the knee.
    slope_below: below it.
    scatter: T_N, 1 for none.
    probability: of failure, for which the curve holds.
    rule: of mean stress.
    parameter: of the rule, M, R_m (Pa), or g.
    """

    knee: tuple[float, float]
    slope: float
    slope_below: float = inf
    scatter: float = 1.0
    probability: float = 0.5
    rule: MeanStress = "none"
    parameter: float = 0.0

    def equivalent(self, amplitude: Floats, mean: Floats) -> Floats:
        """Amplitudes (C,), Pa, at stress ratio -1, of cycles with amplitudes and means (C,), Pa."""
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
        """Cycles to failure (C,), infinite below a knee without a slope.

        probability: of failure, by default that of the curve.
        """
        import pylife.materiallaws.woehlercurve  # noqa: F401, which teaches pandas

        wanted = self.probability if probability is None else probability
        with quiet():
            return np.asarray(self._series().woehler.cycles(amplitude, wanted), dtype=float)

    def life(self, probability: float | None = None) -> Life:
        """The curve at a failure probability, by default its own."""
        import pylife.materiallaws.woehlercurve  # noqa: F401, which teaches pandas

        wanted = self.probability if probability is None else probability
        with quiet():
            at = self._series().woehler.transform_to_failure_probability(wanted)
        return Life((float(at.SD), float(at.ND)), (self.slope, self.slope_below))

    def damage(
        self, equivalent: Floats, counts: Floats | float = 1.0, probability: float | None = None
    ) -> float:
        """The damage of cycles with equivalent amplitudes (C,), Pa.

        counts: occurrences of each.
        probability: of failure, by default that of the curve.
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

"""A tabulated quantity, interpolated linearly, or by a cubic without overshoot.

The cubic is that of Fritsch and Carlson, SIAM J. Numer. Anal. 17 (1980) 238, with the weighted
harmonic mean of Fritsch and Butland as slopes: monotone where the rows are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from loads.linkage.linkage import LinkageError
from pinbase.arrays import Floats

Interpolation = Literal["linear", "monotone"]
Outside = Literal["error", "hold", "repeat"]

TABLE_END_TOLERANCE = 1e-9  # of the range: a value no farther outside a table counts as its end


@dataclass(frozen=True)
class ForceTable:
    """A table of y over x.

    x, y: (N,) rows, N >= 2, x increasing, SI units.
    outside: beyond the rows the table gives an error, the value of the nearest row ("hold"), or
    repeats itself with the range of x as its period ("repeat").
    name: name of the table, for messages.
    unit: unit of x in messages, with its SI value.

    Raises: LinkageError for fewer rows, x that does not increase, or a jump where the table
    repeats.
    """

    x: tuple[float, ...]
    y: tuple[float, ...]
    interpolation: Interpolation = "linear"
    outside: Outside = "error"
    name: str = "the table"
    unit: tuple[str, float] = ("", 1.0)

    def __post_init__(self) -> None:
        if len(self.x) < 2:
            raise LinkageError(f"{self.name} needs at least 2 rows", "too-few-rows")
        falling = np.flatnonzero(np.diff(self.x) <= 0.0)
        if len(falling):
            k = int(falling[0])
            raise LinkageError(
                f"{self.name}: the first column must increase from row to row; row {k + 2} is "
                f"{self._shown(self.x[k + 1])} after {self._shown(self.x[k])}",
                "table-not-increasing",
            )
        if self.outside == "repeat" and self.y[0] != self.y[-1]:
            raise LinkageError(
                f"{self.name}: a table that repeats must end with the value of its first row",
                "table-not-periodic",
            )

    def __call__(self, at: Floats) -> Floats:
        """Values y at x = `at` (T,). Raises: LinkageError outside the table."""
        low, high = self.x[0], self.x[-1]
        if self.outside == "repeat":
            at = low + np.mod(at - low, high - low)
        elif self.outside == "error":
            self._require_inside(at)
        at = np.clip(at, low, high)
        if self.interpolation == "linear":
            return np.interp(at, self.x, self.y)
        return np.asarray(self._cubic(at))

    def knots(self, low: float, high: float) -> Floats:
        """Values of x between `low` and `high` at which the curve has kinks: the x of its rows."""
        x = np.array(self.x)
        if self.outside == "repeat":
            period = x[-1] - x[0]
            first, last = np.floor((np.array([low, high]) - x[0]) / period)
            x = (x[:-1] + period * np.arange(first, last + 1.0)[:, None]).ravel()
        return x[(x > low) & (x < high)]

    def _require_inside(self, at: Floats) -> None:
        """Raise LinkageError where a value of x is outside the table."""
        low, high = self.x[0], self.x[-1]
        excess = np.maximum(low - at, at - high)
        k = int(excess.argmax())
        if excess[k] > TABLE_END_TOLERANCE * (high - low):
            raise LinkageError(
                f"{self.name} goes from {self._shown(low)} to {self._shown(high)}, but "
                f"{self._shown(float(at[k]))} occurs; extend it, or give outside = "
                '"hold" (its last value) or "repeat"',
                "outside-table",
            )

    def _shown(self, value: float) -> str:
        """A value of x as text, in the table's unit."""
        unit, factor = self.unit
        return f"{value / factor:.6g} {unit}".rstrip()

    @cached_property
    def _cubic(self) -> Any:
        """The monotone cubic, a SciPy PchipInterpolator."""
        from scipy.interpolate import PchipInterpolator

        x, y = np.array(self.x), np.array(self.y)
        # A table that repeats gets one row of each neighbouring period, so that the slopes agree at
        # the ends of the period.
        if self.outside == "repeat":
            period = x[-1] - x[0]
            x = np.concatenate([x[-2:-1] - period, x, x[1:2] + period])
            y = np.concatenate([y[-2:-1], y, y[1:2]])
        return PchipInterpolator(x, y)

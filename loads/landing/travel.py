"""The strut's stroke as a function of the rise of the axle relative to the aircraft."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pinbase.arrays import Floats
from pinbase.errors import ArgumentError


@dataclass(frozen=True)
class Telescopic:
    """A vertical strut, whose stroke equals the rise of the axle."""

    def at(self, rise: Floats) -> tuple[Floats, Floats, Floats]:
        """Stroke (T,) m at rises (T,) m, and its first two derivatives by the rise."""
        return rise, np.ones_like(rise), np.zeros_like(rise)

    def rise(self, stroke: float) -> float:
        """Rise of the axle at a stroke, m."""
        return stroke


TELESCOPIC = Telescopic()


@dataclass(frozen=True)
class Levered:
    """Any other leg: stroke over rise by a quintic spline through rows.

    By virtual work the force at the wheel is the force of the strut times the derivative of the
    stroke by the rise.
    rises, strokes: (N,) m, both starting at zero.

    Raises: ArgumentError where the axle does not rise.
    """

    rises: tuple[float, ...]
    strokes: tuple[float, ...]

    def __post_init__(self) -> None:
        if np.any(np.diff(self.rises) <= 0.0):
            raise ArgumentError(
                "the axle does not rise all along the stroke of the strut: check which way the "
                "strut's drive shortens, its extended position and the direction of gravity",
                "axle-does-not-rise",
            )

    @cached_property
    def _spline(self) -> Any:
        """Stroke over rise, a SciPy BSpline."""
        from scipy.interpolate import make_interp_spline

        return make_interp_spline(self.rises, self.strokes, k=5)

    def at(self, rise: Floats) -> tuple[Floats, Floats, Floats]:
        """Stroke (T,) m at rises (T,) m, and its first two derivatives by the rise."""
        return self._spline(rise), self._spline(rise, 1), self._spline(rise, 2)

    def rise(self, stroke: float) -> float:
        """Rise of the axle at a stroke within the rows, m."""
        return float(np.interp(stroke, self.strokes, self.rises))

"""Laws of motion of a drive, with exact value and first two derivatives at given times.

Values are lengths of a slider (m) or angles (rad). A drive is at rest before the first and after
the last time of its law.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy as np

from loads.linkage.linkage import LinkageError
from pinbase.arrays import Floats

Values = tuple[Floats, Floats, Floats]


class Law(Protocol):
    """A law of motion: a call with times (T,) s returns value, rate and second rate, (T,) each."""

    def __call__(self, times: Floats) -> Values: ...

    @property
    def pieces(self) -> tuple[float, ...]:
        """Times that divide the law into pieces of a single formula each, s."""
        ...

    @property
    def corners(self) -> tuple[float, ...]:
        """The `pieces` at which one of the first three derivatives may jump, s."""
        ...


@dataclass(frozen=True)
class Ramp:
    """A motion from one value to another, whose shape over time the subclasses define.

    start, end: first and last value, m or rad.
    duration: length of the motion, s.
    begin: time at which the motion begins, s.
    """

    start: float
    end: float
    duration: float
    begin: float = 0.0

    @property
    def finish(self) -> float:
        """Time at which the motion ends, s."""
        return self.begin + self.duration

    @property
    def corners(self) -> tuple[float, ...]:
        """Times at which the motion begins and ends, s."""
        return self.begin, self.finish

    pieces = corners

    def _scaled(self, times: Floats, shape: Floats, first: Floats, second: Floats) -> Values:
        """Value and derivatives of the motion from those of its dimensionless shape.

        shape: (T,), rising from 0 to 1.
        first, second: (T,), derivatives of the shape with respect to time / duration.
        """
        travel = self.end - self.start
        moving = (times >= self.begin) & (times <= self.finish)
        return (
            self.start + travel * shape,
            np.where(moving, travel / self.duration * first, 0.0),
            np.where(moving, travel / self.duration**2 * second, 0.0),
        )

    def _elapsed(self, times: Floats) -> Floats:
        """Elapsed fraction of the duration, (T,), between 0 and 1."""
        return np.clip((times - self.begin) / self.duration, 0.0, 1.0)


class CosineDrive(Ramp):
    """Half a cosine wave: at rest at both ends, where the acceleration jumps."""

    def __call__(self, times: Floats) -> Values:
        phase = np.pi * self._elapsed(times)
        return self._scaled(
            times,
            0.5 * (1.0 - np.cos(phase)),
            0.5 * np.pi * np.sin(phase),
            0.5 * np.pi**2 * np.cos(phase),
        )


class CycloidalDrive(Ramp):
    """A cycloid: speed and acceleration vanish at both ends."""

    def __call__(self, times: Floats) -> Values:
        elapsed = self._elapsed(times)
        phase = 2.0 * np.pi * elapsed
        return self._scaled(
            times,
            elapsed - np.sin(phase) / (2.0 * np.pi),
            1.0 - np.cos(phase),
            2.0 * np.pi * np.sin(phase),
        )


class ConstantDrive(Ramp):
    """Constant speed from start to end."""

    def __call__(self, times: Floats) -> Values:
        elapsed = self._elapsed(times)
        return self._scaled(times, elapsed, np.ones_like(elapsed), np.zeros_like(elapsed))


@dataclass(frozen=True)
class StateDrive:
    """The state at a single instant: value, rate and second rate are the same at all times."""

    value: float
    rate: float = 0.0
    second: float = 0.0

    pieces: ClassVar[tuple[float, ...]] = ()
    corners: ClassVar[tuple[float, ...]] = ()

    def __call__(self, times: Floats) -> Values:
        ones = np.ones_like(times)
        return self.value * ones, self.rate * ones, self.second * ones


@dataclass(frozen=True)
class TableDrive:
    """A table interpolated by polynomials of degree five.

    times: (N,) s, increasing.
    values: (N,) m or rad.
    rates, seconds: (N,) first and second derivatives, both or neither. With them every piece has
    the stated derivatives at its two rows; without them the interpolant is the quintic spline,
    whose fourth derivative is continuous.

    Raises: LinkageError for fewer rows than the polynomial needs, or times that do not increase.
    """

    times: tuple[float, ...]
    values: tuple[float, ...]
    rates: tuple[float, ...] = ()
    seconds: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        min_rows = 2 if self.rates else 6
        if len(self.times) < min_rows:
            raise LinkageError(
                f"the table has {len(self.times)} rows; a drive needs at least {min_rows}",
                "too-few-rows",
            )
        if not np.all(np.diff(self.times) > 0.0):
            raise LinkageError("the times must increase from row to row", "times-not-increasing")

    @property
    def begin(self) -> float:
        """First time of the table, s."""
        return self.times[0]

    @property
    def finish(self) -> float:
        """Last time of the table, s."""
        return self.times[-1]

    @property
    def pieces(self) -> tuple[float, ...]:
        """Times of all rows, s."""
        return self.times

    @property
    def corners(self) -> tuple[float, ...]:
        """Times of all rows, s; only the two ends for a spline, which is smooth between them."""
        return self.times if self.rates else (self.begin, self.finish)

    @cached_property
    def _polynomials(self) -> Any:
        """The interpolant, a SciPy BSpline or BPoly."""
        from scipy.interpolate import BPoly, make_interp_spline

        if not self.rates:
            return make_interp_spline(self.times, self.values, k=5)
        rows = np.stack([self.values, self.rates, self.seconds], axis=1)
        return BPoly.from_derivatives(self.times, rows)

    def __call__(self, times: Floats) -> Values:
        at = np.clip(times, self.begin, self.finish)
        moving = (times >= self.begin) & (times <= self.finish)
        polynomials = self._polynomials
        return (
            np.asarray(polynomials(at)),
            np.where(moving, polynomials.derivative(1)(at), 0.0),
            np.where(moving, polynomials.derivative(2)(at), 0.0),
        )

"""Laws of motion of a drive: value, rate and second rate at given times, exactly.

Values are lengths (m) of a slider or angles (rad). Outside its time a drive rests where it is.
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
    """Value, rate and second rate (T,) at times (T,) in s."""

    def __call__(self, times: Floats) -> Values: ...

    @property
    def pieces(self) -> tuple[float, ...]:
        """Times between which it is one formula, s."""
        ...

    @property
    def corners(self) -> tuple[float, ...]:
        """Those of them at which its first three rates may jump, s."""
        ...


@dataclass(frozen=True)
class Ramp:
    """From `start` to `end` in `duration` (s), beginning at time `begin` (s)."""

    start: float
    end: float
    duration: float
    begin: float = 0.0

    @property
    def finish(self) -> float:
        """When it is over, s."""
        return self.begin + self.duration

    @property
    def corners(self) -> tuple[float, ...]:
        """Its ends, s."""
        return self.begin, self.finish

    pieces = corners

    def _course(self, times: Floats, shape: Floats, first: Floats, second: Floats) -> Values:
        """From a shape that goes from 0 to 1 in time / duration, with its two derivatives."""
        run = self.end - self.start
        moving = (times >= self.begin) & (times <= self.finish)
        return (
            self.start + run * shape,
            np.where(moving, run / self.duration * first, 0.0),
            np.where(moving, run / self.duration**2 * second, 0.0),
        )

    def _part(self, times: Floats) -> Floats:
        return np.clip((times - self.begin) / self.duration, 0.0, 1.0)


class CosineDrive(Ramp):
    """Half a cosine: at rest at both ends, the acceleration jumps there."""

    def __call__(self, times: Floats) -> Values:
        phase = np.pi * self._part(times)
        return self._course(
            times,
            0.5 * (1.0 - np.cos(phase)),
            0.5 * np.pi * np.sin(phase),
            0.5 * np.pi**2 * np.cos(phase),
        )


class CycloidalDrive(Ramp):
    """A cycloid: speed and acceleration vanish at both ends."""

    def __call__(self, times: Floats) -> Values:
        part = self._part(times)
        phase = 2.0 * np.pi * part
        return self._course(
            times,
            part - np.sin(phase) / (2.0 * np.pi),
            1.0 - np.cos(phase),
            2.0 * np.pi * np.sin(phase),
        )


class ConstantDrive(Ramp):
    """Constant speed from start to end."""

    def __call__(self, times: Floats) -> Values:
        part = self._part(times)
        return self._course(times, part, np.ones_like(part), np.zeros_like(part))


@dataclass(frozen=True)
class StateDrive:
    """One instant: value, rate and second rate as given, whatever the time."""

    value: float
    rate: float = 0.0
    second: float = 0.0

    pieces: ClassVar[tuple[float, ...]] = ()
    corners: ClassVar[tuple[float, ...]] = ()

    def __call__(self, times: Floats) -> Values:
        one = np.ones_like(times)
        return self.value * one, self.rate * one, self.second * one


@dataclass(frozen=True)
class TableDrive:
    """A table interpolated by polynomials of degree five.

    times (N,) s, rising; values (N,); rates and seconds (N,), both or neither. With them every
    piece meets the rows' own rates; without it is the interpolating spline, smooth to the fourth
    derivative.

    Raises: LinkageError for fewer rows than the polynomial needs, or times that do not rise.
    """

    times: tuple[float, ...]
    values: tuple[float, ...]
    rates: tuple[float, ...] = ()
    seconds: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        least = 2 if self.rates else 6
        if len(self.times) < least:
            raise LinkageError(
                f"the table has {len(self.times)} rows; a drive needs at least {least}",
                "too-few-rows",
            )
        if not np.all(np.diff(self.times) > 0.0):
            raise LinkageError("the times must increase from row to row", "times-not-increasing")

    @property
    def begin(self) -> float:
        """Its first time, s."""
        return self.times[0]

    @property
    def finish(self) -> float:
        """Its last time, s."""
        return self.times[-1]

    @property
    def pieces(self) -> tuple[float, ...]:
        """Its rows, s."""
        return self.times

    @property
    def corners(self) -> tuple[float, ...]:
        """Its rows where they state rates; the spline is smooth at those between its ends, s."""
        return self.times if self.rates else (self.begin, self.finish)

    @cached_property
    def _pieces(self) -> Any:
        from scipy.interpolate import BPoly, make_interp_spline

        if not self.rates:
            return make_interp_spline(self.times, self.values, k=5)
        rows = np.stack([self.values, self.rates, self.seconds], axis=1)
        return BPoly.from_derivatives(self.times, rows)

    def __call__(self, times: Floats) -> Values:
        at = np.clip(times, self.begin, self.finish)
        moving = (times >= self.begin) & (times <= self.finish)
        pieces = self._pieces
        return (
            np.asarray(pieces(at)),
            np.where(moving, pieces.derivative(1)(at), 0.0),
            np.where(moving, pieces.derivative(2)(at), 0.0),
        )

"""The tyre: vertical force over deflection, by a power law or a table, with optional damping."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pinbase.arrays import Floats
from pinbase.errors import ArgumentError


@dataclass(frozen=True)
class PowerTyre:
    """a z^r at deflection z. coefficient a: N/m^r. exponent: r. damping: s/m, by which the force
    grows with the speed of deflection: (1 + damping z'), never pulling (Hunt & Crossley, 1975).
    """

    coefficient: float
    exponent: float = 1.0
    damping: float = 0.0
    most: float = np.inf

    def force(self, deflection: Floats) -> Floats:
        """Without damping, N; none above the ground."""
        return np.asarray(self.coefficient * np.maximum(deflection, 0.0) ** self.exponent)

    def energy(self, deflection: Floats) -> Floats:
        """J."""
        n = self.exponent + 1.0
        return np.asarray(self.coefficient * np.maximum(deflection, 0.0) ** n / n)


@dataclass(frozen=True)
class TableTyre:
    """A table from (0, 0) on, rising, with a monotone piecewise cubic between its rows (Fritsch &
    Carlson, 1980). deflections (N,) m, forces (N,) N. damping: as a PowerTyre's.

    Raises: ArgumentError.
    """

    deflections: tuple[float, ...]
    forces: tuple[float, ...]
    damping: float = 0.0

    def __post_init__(self) -> None:
        table = np.array([self.deflections, self.forces])
        if table.shape[1] < 3 or table[:, 0].any():
            raise ArgumentError(
                "a tyre's table needs at least three rows, the first of them 0, 0", "tyre-table"
            )
        for name, values in zip(("deflection", "force"), table, strict=True):
            if (wrong := np.flatnonzero(np.diff(values) <= 0.0)).size:
                row = int(wrong[0]) + 2
                raise ArgumentError(
                    f"a tyre's {name} must increase from row to row, but does not in row {row}",
                    "not-increasing",
                )

    @property
    def most(self) -> float:
        """The last deflection, m, beyond which nothing is known."""
        return self.deflections[-1]

    @cached_property
    def _curve(self) -> Any:
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.deflections, self.forces)

    @cached_property
    def _work(self) -> Any:
        return self._curve.antiderivative()

    def force(self, deflection: Floats) -> Floats:
        """Without damping, N; none above the ground, and that of the last row beyond it."""
        return np.asarray(self._curve(np.clip(deflection, 0.0, self.most)))

    def energy(self, deflection: Floats) -> Floats:
        """J."""
        return np.asarray(self._work(np.clip(deflection, 0.0, self.most)))


Tyre = PowerTyre | TableTyre


def damped(tyre: Tyre, deflection: Floats, speed: Floats) -> Floats:
    """Force (T,) N at deflections (T,) m and their rates (T,) m/s."""
    return np.asarray(tyre.force(deflection) * np.maximum(1.0 + tyre.damping * speed, 0.0))

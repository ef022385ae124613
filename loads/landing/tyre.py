"""Vertical force of a tyre over its deflection, by a power law or a table, with damping."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from pinbase.arrays import Floats
from pinbase.errors import ArgumentError


@dataclass(frozen=True)
class PowerTyre:
    """A tyre with the force a z^r at deflection z.

    coefficient: a, N/m^r.
    exponent: r.
    damping: s/m; the force is multiplied by 1 + damping z', but not by less than zero (Hunt &
    Crossley, 1975).
    max_deflection: largest deflection, m.
    """

    coefficient: float
    exponent: float = 1.0
    damping: float = 0.0
    max_deflection: float = np.inf

    def force(self, deflection: Floats) -> Floats:
        """Force without damping at deflections (T,) m, (T,) N; zero above the ground."""
        return np.asarray(self.coefficient * np.maximum(deflection, 0.0) ** self.exponent)

    def energy(self, deflection: Floats) -> Floats:
        """Energy stored at deflections (T,) m, (T,) J."""
        n = self.exponent + 1.0
        return np.asarray(self.coefficient * np.maximum(deflection, 0.0) ** n / n)


@dataclass(frozen=True)
class TableTyre:
    """A tyre with a tabulated force, by a monotone piecewise cubic (Fritsch & Carlson, 1980).

    deflections, forces: (N,) m and N, increasing from (0, 0).
    damping: as for a PowerTyre.

    Raises: ArgumentError for fewer than three rows, a first deflection or force other than zero, or
    values that do not increase.
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
            if (falling := np.flatnonzero(np.diff(values) <= 0.0)).size:
                row = int(falling[0]) + 2
                raise ArgumentError(
                    f"a tyre's {name} must increase from row to row, but does not in row {row}",
                    "not-increasing",
                )

    @property
    def max_deflection(self) -> float:
        """Last deflection of the table, m, beyond which the force is unknown."""
        return self.deflections[-1]

    @cached_property
    def _curve(self) -> Any:
        """Force over deflection, a SciPy PchipInterpolator."""
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.deflections, self.forces)

    @cached_property
    def _work(self) -> Any:
        """Stored energy over deflection, a SciPy polynomial."""
        return self._curve.antiderivative()

    def force(self, deflection: Floats) -> Floats:
        """Force without damping at deflections (T,) m, (T,) N.

        It is zero above the ground; beyond the table it is the force of the last row.
        """
        return np.asarray(self._curve(np.clip(deflection, 0.0, self.max_deflection)))

    def energy(self, deflection: Floats) -> Floats:
        """Energy stored at deflections (T,) m, (T,) J."""
        return np.asarray(self._work(np.clip(deflection, 0.0, self.max_deflection)))


Tyre = PowerTyre | TableTyre


def damped(tyre: Tyre, deflection: Floats, speed: Floats) -> Floats:
    """Force with damping, (T,) N, at deflections (T,) m and their rates (T,) m/s."""
    return np.asarray(tyre.force(deflection) * np.maximum(1.0 + tyre.damping * speed, 0.0))

"""The strain energy under any loads, from the work of unit loads on each other's displacements.

The strain energy is half of the work of the loads. A finer mesh never reduces it. The energy that a
mesh lacks is the square of its error in the energy norm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fea.core.pin_loads import Loads, Unit, UnitLoad, amounts_of
from pinbase.arrays import Floats


@dataclass(frozen=True)
class StrainEnergy:
    """The strain energy of a pin on one mesh under any loads.

    units: L unit loads with their phases.
    work: of each unit load on the displacements by each unit load, (L, L) J.
    """

    units: tuple[Unit, ...]
    work: Floats

    @classmethod
    def of_both_phases(cls, loads: Sequence[UnitLoad], work: Floats) -> StrainEnergy:
        """The energy of K unit loads whose work, (K, K) J, is the same in both phases."""
        units = tuple((load, phase) for phase in (0, 1) for load in loads)
        return cls(units, np.asarray(np.kron(np.eye(2), work), np.float64))

    def of(self, loads: Loads, instant: int = 0) -> float:
        """The energy under the loads of an instant, given by its number, J.

        Raises: ArgumentError where a part of the loads is not among the unit loads.
        """
        amounts = amounts_of(self.units, loads)[instant]
        return 0.5 * float(amounts @ self.work @ amounts)

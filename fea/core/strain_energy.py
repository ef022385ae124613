"""Strain energy under any loads, from what unit loads do on each other's displacements.

Half of the work of the loads, which a finer mesh never lessens: what a model lacks of it is the
square of its error in the energy norm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.pin_loads import Loads, UnitLoad, require_solved
from pinbase.arrays import Floats


@dataclass(frozen=True)
class StrainEnergy:
    """The strain energy of a pin on one mesh under any loads.

    units: L unit loads with their phases.
    work: (L, L) J, of each unit load on the displacements by each of them.
    """

    units: tuple[tuple[UnitLoad, int], ...]
    work: Floats

    def of(self, loads: Loads, instant: int = 0) -> float:
        """The energy under the loads of an instant, by its number, J.

        Raises: ArgumentError where a part of the loads is not among the unit loads.
        """
        acting = loads.coefficients()
        require_solved(loads.case, acting, (load for load, _ in self.units))
        amounts = np.array(
            [acting[load][instant, p] if load in acting else 0.0 for load, p in self.units]
        )
        return 0.5 * float(amounts @ self.work @ amounts)

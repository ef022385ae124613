"""The interface of a solution that is common to all models."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from fea.core.pin_loads import Loads, PinLoads
from pinbase.arrays import Floats, Ints, Mask


@dataclass(frozen=True)
class Picture:
    """A mesh with results at its N nodes at one instant.

    points: (N, 3) m.
    cells: (M, 10), in VTK's order of "tetra10", or (M, 4), "quad".
    displacement: (N, 3) m.
    stress: (N, 6) Pa: xx, yy, zz, yz, xz, xy.
    envelope: (N,), the largest von Mises stress over all instants, Pa, NaN inside the body.
    pressed: (N,), true where lugs press on the surface shown; there the envelope is that of the
    instants at which they do not, NaN if they always do. None without lugs.
    """

    points: Floats
    cells: Ints
    cell_type: str
    displacement: Floats
    stress: Floats
    envelope: Floats
    pressed: Mask | None = None


class StressField(Protocol):
    """The stress that a model has computed for a pin, for any combination of the same unit
    loads.
    """

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest von Mises stress (T,) Pa at every instant outside all singularities.

        least: where the stress does not exceed this, Pa, any value up to it may be returned.
        """
        ...

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest of these (Pa), and the number of its instant."""
        ...

    def picture(self, loads: PinLoads, instant: int) -> Picture | None:
        """The pin at one instant, with its envelope over all instants; None for a model without
        fields.
        """
        ...

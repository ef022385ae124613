"""Unit loads and their amounts, in short."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fea.core.pin_loads import PinLoads, UnitLoad
from fea.solid.model import UnitFields
from fea.solid.nodal_loads import Unit


def forces(*names: str, along: tuple[int, ...] = (0, 1)) -> tuple[Unit, ...]:
    """A force along each of these axes (x 0, y 1, z 2) on each surface."""
    one = {a: ("force", 0 if a == 2 else 1, a % 2) for a in along}
    return tuple(
        (UnitLoad(name, "force", n), phase) for name in names for _, n, phase in one.values()
    )


def moments(*names: str) -> tuple[Unit, ...]:
    """A moment about y, -x and z on each surface."""
    return tuple(
        (UnitLoad(name, "moment", n), phase)
        for name in names
        for n, phase in ((1, 0), (1, 1), (0, 1))
    )


def at(fields: UnitFields, **loads: tuple[float, ...]) -> NDArray[np.float64]:
    """Coefficients (L,) of a force and, if given, a moment by band, three components each."""
    six = np.array([[*values, *[0.0] * (6 - len(values))] for values in loads.values()])
    case = PinLoads("case", tuple(loads), six[None, :, :3], six[None, :, 3:])
    found: NDArray[np.float64] = fields.coefficients(case)[0]
    return found

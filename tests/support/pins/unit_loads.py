"""Short functions for unit loads and their amounts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fea.core.pin_loads import PinLoads, Unit, UnitLoad
from fea.solid.model import UnitFields


def forces(*names: str, along: tuple[int, ...] = (0, 1)) -> tuple[Unit, ...]:
    """Return a force along each of these axes (x 0, y 1, z 2) on each surface."""
    one = {a: ("pull", 0, 0) if a == 2 else ("force", 1, a) for a in along}
    return tuple(
        (UnitLoad(name, kind, n), phase)  # type: ignore[arg-type]
        for name in names
        for kind, n, phase in one.values()
    )


def moments(*names: str) -> tuple[Unit, ...]:
    """Return moments about y, -x and z on each surface."""
    return tuple(
        (unit, phase)
        for name in names
        for unit, phase in (
            (UnitLoad(name, "moment", 1), 0),
            (UnitLoad(name, "moment", 1), 1),
            (UnitLoad(name, "twist", 0), 1),
        )
    )


def at(fields: UnitFields, **loads: tuple[float, ...]) -> NDArray[np.float64]:
    """Return the coefficients (L,) of a force and, if given, a moment on each band, three
    components each.
    """
    six = np.array([[*values, *[0.0] * (6 - len(values))] for values in loads.values()])
    case = PinLoads("case", tuple(loads), six[None, :, :3], six[None, :, 3:])
    found: NDArray[np.float64] = fields.coefficients(case)[0]
    return found

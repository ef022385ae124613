"""Whether an unconstrained pin can be solved: the imbalance of its loads, and what reacts it.

Its bands react the imbalance (`fea.core.tractions.closing_tractions`). They always react couples,
as real hubs do. A force, or a torque about the axis, that is more than a small part of the loads
means that a support is missing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.pin_loads import PinLoads
from geometry import PinLike
from geometry.arrays import Floats

MOST = 0.1  # imbalance allowed, of the largest force or torque
NOISE = 1e-9  # of the largest load: smaller ones are zero


@dataclass(frozen=True)
class Balance:
    """The imbalance that the bands react, largest over the instants: force in N, couple (about the
    pin's middle) in N m.

    largest: the largest force in the case, N. refusal: why the pin cannot be solved, or None; code:
    of the refusal.
    """

    force: float
    couple: float
    largest: float
    refusal: str | None
    code: str = ""


def out_of_balance(pin: PinLike, loads: PinLoads, density: float | None = None) -> Balance:
    """The balance of a pin without clamps under its loads and, with a density (kg/m^3), its own
    weight and inertia.
    """
    z = np.array([pin.band(name).middle for name in loads.surfaces]) - sum(pin.ends) / 2.0
    force = loads.forces.sum(axis=1)
    couple = (np.cross(z[:, None] * [0.0, 0.0, 1.0], loads.forces) + loads.moments).sum(axis=1)
    largest = _largest(loads.forces)
    if density is not None:
        own = density * pin.volume * loads.body
        force = force + own
        largest = max(largest, _largest(own))
    torque, torques = float(np.abs(couple[:, 2]).max()), float(np.abs(loads.moments[..., 2]).max())
    least = NOISE * max(largest, _largest(loads.moments) / pin.length)
    left = max(_largest(force[:, :2]), float(np.abs(force[:, 2]).max()))
    why, code = "", ""
    if len(pin.connections) < 2:
        code = "one-band"
        why = (
            "the pin is not clamped and only one connection bears on it, so nothing reacts its load"
        )
    elif left > max(MOST * largest, least):
        code = "force-imbalance"
        why = (
            "the pin is not clamped and its loads are not in equilibrium: their resultant is "
            f"{left / largest:.2g} of the largest load (its bands react at most {MOST:g})"
        )
    elif torque > max(MOST * torques, least * pin.length):
        code = "torque-imbalance"
        why = (
            "the pin is not clamped and its loads are not in equilibrium: their torque about the "
            f"axis is {torque / torques:.2g} of the largest applied (its bands react at most "
            f"{MOST:g})"
        )
    refusal = f"{why}; name its clamped surfaces in pin.{pin.name}.clamp" if why else None
    return Balance(_largest(force), _largest(couple), largest, refusal, code)


def _largest(vectors: Floats) -> float:
    """The greatest length of vectors (..., 2 or 3)."""
    return float(np.linalg.norm(vectors, axis=-1).max(initial=0.0))

"""Whether a pin that nothing holds can be solved: what its loads leave over, and who takes it up.

Its bands take up what is left over (`fea.tractions.closing_tractions`). Couples are always theirs:
real hubs carry them. A force, or a torque about the axis, that is more than a small part of the
loads means that a support is missing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.pin_loads import Floats, PinLoads
from geometry import PinLike

MOST = 0.1  # of the largest force, or torque, that may be left over
NOISE = 1e-9  # of all loads together: what is no load at all


@dataclass(frozen=True)
class Balance:
    """What the bands take up, largest over the instants: force in N, couple (about the pin's
    middle) in N m.

    largest: the largest force in the case, N. refusal: why the pin cannot be solved so, or None.
    """

    force: float
    couple: float
    largest: float
    refusal: str | None


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
    why = None
    if len(pin.connections) < 2:
        why = (
            "nothing holds the pin, and only one connection bears on it, which cannot also be what "
            "the load is balanced by"
        )
    elif left > max(MOST * largest, least):
        why = (
            "nothing holds the pin and its loads are not in balance: their resultant is "
            f"{left / largest:.2g} of the largest load, and at most {MOST:g} is taken up by its "
            "bands"
        )
    elif torque > max(MOST * torques, least * pin.length):
        why = (
            "nothing holds the pin and its loads are not in balance: they turn it about its axis "
            f"with {torque / torques:.2g} of their largest torque"
        )
    refusal = f"{why}: name what holds it in pin.{pin.name}.clamp" if why else None
    return Balance(_largest(force), _largest(couple), largest, refusal)


def _largest(vectors: Floats) -> float:
    """The greatest length of vectors (..., 2 or 3)."""
    return float(np.linalg.norm(vectors, axis=-1).max(initial=0.0))

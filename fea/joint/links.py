"""What links ask of a pin in its lugs: one lug for each band, forces in balance with the body's."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats, PinLoads
from fea.joint.lug import Lug
from geometry import Pin

BALANCED = 1e-6  # of the largest force: what links and the body force may leave over


def fitting(pin: Pin, lugs: Sequence[Lug]) -> tuple[Lug, ...]:
    """The lugs in the order of the pin's bands.

    Raises: ValueError for a lug where no link bears, a band without one, or one no wider than it.
    """
    named = {lug.connection: lug for lug in lugs}
    if len(named) < len(lugs) or set(named) != set(pin.connections):
        raise ValueError(f"pin {pin.name} needs one lug for each of {', '.join(pin.connections)}")
    for lug in lugs:
        if lug.outer_diameter <= 2.0 * pin.band(lug.connection).radius:
            raise ValueError(f"lug {lug.connection}: it must be wider than the pin")
    return tuple(named[connection] for connection in pin.connections)


def link_forces(pin: Pin, mass: float, loads: PinLoads) -> Floats:
    """Of the links along x and y by connection, (T, B, 2) N; mass: of the pin, kg.

    Raises: SolveError where they are not in balance with the body force.
    """
    out = np.zeros((len(loads), len(pin.connections), 2))
    for b, connection in enumerate(pin.connections):
        if connection in loads.surfaces:
            out[:, b] = loads.forces[:, loads.surfaces.index(connection), :2]
    left = np.linalg.norm(out.sum(axis=1) + loads.body[:, :2] * mass, axis=1).max()
    if left > BALANCED * np.abs(out).max(initial=1e-300):
        raise SolveError(
            f"pin {pin.name}, case {loads.case}: the forces of its links have "
            f"a resultant of {left:.3g} N, which no contact reacts",
            "not-in-equilibrium",
        )
    return out

"""The loads of links on a pin in its lugs, in balance with the body force of the pin.

Each band has one lug. Lugs on segments on which no link bears belong to a fixed structure. Together
they react the resultant of the links' loads and the body force.

A link that states a moment across the axis transmits exactly this moment to the pin, since statics
of the link determines it. Its lug tilts until the pressure has this couple about the band's middle,
so that its tilt stiffness does not matter. The other lugs react the remaining couple by their tilt.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fea.core.equilibrium import MAX_IMBALANCE
from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats, PinLoads
from fea.support.lugs.lug import Lug
from geometry import Pin


def link_numbers(connections: Sequence[str], links: Sequence[str]) -> NDArray[np.int64]:
    """The number of each band's link, (B,); the structure counts as a link after the last one."""
    number = {name: k for k, name in enumerate(links)}
    return np.array([number.get(name, len(links)) for name in connections], dtype=np.int64)


def link_forces(
    pin: Pin, mass: float, loads: PinLoads, structure: bool = False, whole: bool = True
) -> Floats:
    """The forces of the links along x and y, for each connection, (T, L, 2) N.

    If a structure has some of the lugs, its force comes last and balances the others. Otherwise the
    links share a small imbalance with the body force, as from a rounded weight.
    mass: of the pin, kg.
    structure: whether a structure has some of the lugs.
    whole: false for a part of the loads, whose imbalance need not be small.

    Raises: SolveError where the imbalance of whole loads is not small.
    """
    out = np.zeros((len(loads), len(pin.connections), 2))
    for b, connection in enumerate(pin.connections):
        if connection in loads.surfaces:
            out[:, b] = loads.forces[:, loads.surfaces.index(connection), :2]
    left = out.sum(axis=1) + loads.body[:, :2] * mass
    if structure:
        return np.concatenate([out, -left[:, None]], axis=1)
    largest = np.linalg.norm(left, axis=1).max(initial=0.0)
    if whole and largest > MAX_IMBALANCE * np.linalg.norm(out, axis=2).max(initial=1e-300):
        raise SolveError(
            f"pin {pin.name}, case {loads.case}: the forces of its links have "
            f"a resultant of {largest:.3g} N, which no contact reacts: load all its links, or name "
            "a lug after a segment where none bears, which is of the structure",
            "not-in-equilibrium",
        )
    return np.asarray(out - left[:, None] / out.shape[1])


def tilting_bands(pin: Pin, loads: PinLoads) -> NDArray[np.bool_]:
    """A mask (B,) of the bands whose links state moments across the axis."""
    tilting = loads.tilting_links(pin.length)
    return np.array([name in tilting for name in pin.connections])


def link_moments(
    pins: tuple[Pin, Pin],
    lugs: Sequence[Lug],
    loads: PinLoads,
    forces: Floats,
    weight: tuple[float, float],
) -> Floats:
    """The moments about x and y that the links transmit to the pin at each band, (T, B, 2) N m,
    about the band's middle; zero for links that state none.

    Where no other lug reacts couples, the links that state moments share a small imbalance.
    pins: the pin without and with the bands of a structure.
    lugs: in the order of the bands; empty for a part of the loads, whose imbalance is not shared.
    forces: of the links (`link_forces`).
    weight: mass of the pin, kg, and z of its centre, m.

    Raises: SolveError where an imbalance that no other lug reacts is not small.
    """
    given, pin = pins
    tilting, names = tilting_bands(pin, loads), pin.connections
    out = np.zeros((len(loads), len(names), 2))
    for b in np.flatnonzero(tilting):
        out[:, b] = loads.moments[:, loads.surfaces.index(names[b]), :2]
    if not lugs or not tilting.any() or len(names) > len(given.connections) + 1:
        return out
    if any(lug.tilt > 0.0 and not free for lug, free in zip(lugs, tilting, strict=True)):
        return out
    mass, centre = weight
    z = np.array([pin.band(name).middle for name in names])
    at_bands = forces[:, link_numbers(names, given.connections)]
    first = np.einsum("b,tba->ta", z, at_bands) + centre * mass * loads.body[:, :2]
    left = out.sum(axis=1) + np.stack([-first[:, 1], first[:, 0]], axis=1)
    largest = np.linalg.norm(left, axis=1).max(initial=0.0)
    most = max(pin.length * np.linalg.norm(forces, axis=2).max(initial=0.0), np.abs(out).max())
    if largest > MAX_IMBALANCE * most:
        raise SolveError(
            f"pin {pin.name}, case {loads.case}: the forces and moments of its links leave a "
            f"couple of {largest:.3g} N m across the axis, which no lug reacts: correct them, or "
            "give the lug of a link that states no moment the stiffness of its tilt",
            "couple-not-reacted",
        )
    out[:, tilting] -= left[:, None] / np.count_nonzero(tilting)
    return out

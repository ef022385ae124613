"""Unit loads as loads per length of a beam: across it (n = 1), along it and about it (n = 0).

Between stations a load per length is w0 + w1 s + w2 s^2, s from the left station. Harmonics n >= 2
and a pressure of n = 0 have no resultant in any section, so they are zero here.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from fea.beam.round_section import Circle
from fea.core.material import Material
from fea.core.pin_loads import Loads, UnitLoad, require_solved
from fea.core.tractions import Traction, closing_tractions, density_of, tractions_of
from geometry import Pin
from pinbase.arrays import Floats


def loads_sections(load: UnitLoad) -> bool:
    """Whether a unit load has a resultant in any section."""
    return load.n < 2 and not (load.kind == "pressure" and load.n == 0)


def acting(loads: Loads) -> tuple[UnitLoad, ...]:
    """The unit loads of a case that have a resultant in a section."""
    return tuple(u for u in loads.coefficients() if loads_sections(u))


def shares(units: tuple[UnitLoad, ...], loads: Loads) -> Floats:
    """The amount (T, 2, K) of each of K unit loads, by phase; zero for those without a resultant.

    Raises: ArgumentError when a part of the loads is not among the units.
    """
    amounts = loads.coefficients()
    require_solved(loads.case, acting(loads), units)
    out = np.zeros((len(loads), 2, len(units)))
    for k, unit in enumerate(units):
        if unit in amounts and loads_sections(unit):
            out[:, :, k] = amounts[unit]
    return out


def line_loads(
    pin: Pin,
    material: Material,
    stations: Floats,
    sections: tuple[Circle, ...],
    loads: tuple[UnitLoad, ...],
    closed: bool,
) -> Floats:
    """The loads per length (C, 3, K), w0 to w2, of K unit loads between stations (C + 1,), m.

    They are N/m, or N m/m about the axis, per m and per m^2. All bands end at stations.
    closed: whether closing tractions that balance each load are added.

    Raises: SolveError for the weight of a material without density, or a balance without bands.
    """
    out = np.zeros((len(sections), 3, len(loads)))
    for k, load in enumerate(loads):
        if load.kind == "body":
            out[:, 0, k] = [density_of(material) * section.area for section in sections]
        elif loads_sections(load):
            out[..., k] = _spread(pin, stations, tractions_of(pin, load), load.n, load.phases[0])
    if closed:
        couples = np.diff(stations) @ line_couples(pin, stations, loads)
        _close(pin, stations, loads, out, couples)
    return out


def line_couples(pin: Pin, stations: Floats, loads: tuple[UnitLoad, ...]) -> Floats:
    """The couples per length (C, K), N m/m, of K unit loads between stations (C + 1,), m.

    A traction Z cos(theta) along the axis turns the pin about y by - pi Z R^2 per length.
    """
    out = np.zeros((len(stations) - 1, len(loads)))
    middles = 0.5 * (stations[1:] + stations[:-1])
    for k, load in enumerate(loads):
        if load.kind != "axial" or load.n != 1:
            continue
        for t in tractions_of(pin, load):
            band = pin.band(t.surface)
            on = (middles > band.z0) & (middles < band.z1)
            out[on, k] -= math.pi * band.radius**2 * t.mean[2]
    return out


def per_length(radius: float, amplitudes: Floats, n: int, phase: int) -> Floats:
    """The load per length (...) of tractions on a cylinder.

    radius: m.
    amplitudes: (..., 3) Pa, of the tractions.
    """
    r, t, z = np.moveaxis(amplitudes, -1, 0)
    if n == 1:  # traction along the axis is left out: it is a couple per length (line_couples)
        return np.asarray(math.pi * radius * (r - t))
    return np.asarray(2.0 * math.pi * radius * (-radius * t if phase else z))


def _spread(
    pin: Pin, stations: Floats, tractions: Iterable[Traction], n: int, phase: int
) -> Floats:
    """The load per length (C, 3), w0 to w2, of tractions on bands."""
    out = np.zeros((len(stations) - 1, 3))
    middles = 0.5 * (stations[1:] + stations[:-1])
    for t in tractions:
        band = pin.band(t.surface)
        on = (middles > band.z0) & (middles < band.z1)
        left = stations[:-1][on]
        slopes = t.slope + 2.0 * t.curve * (left - t.middle)[:, None]
        for k, amplitudes in enumerate((t.at(left), slopes, t.curve)):
            out[on, k] += per_length(band.radius, amplitudes, n, phase)
    return out


def resultants(stations: Floats, w: Floats) -> tuple[Floats, Floats]:
    """The force (...), N, and the moment (...), N m, about z = 0, of loads per length.

    w: (C, 3, ...), as from `line_loads`.
    """
    h = np.diff(stations).reshape(-1, *[1] * (w.ndim - 2))
    z = stations[:-1].reshape(h.shape)
    force = w[:, 0] * h + w[:, 1] * h**2 / 2.0 + w[:, 2] * h**3 / 3.0
    moment = w[:, 0] * h**2 / 2.0 + w[:, 1] * h**3 / 3.0 + w[:, 2] * h**4 / 4.0 + z * force
    return force.sum(axis=0), moment.sum(axis=0)


def _close(
    pin: Pin, stations: Floats, loads: tuple[UnitLoad, ...], w: Floats, couples: Floats
) -> None:
    """Subtract from each load, in place, the closing tractions that balance it.

    couples: (K,) N m, the additional couple of each load.
    """
    for n, phase in ((1, 0), (0, 0), (0, 1)):
        columns = [k for k, u in enumerate(loads) if u.n == n and (n or u.phases[0] == phase)]
        if not columns:
            continue
        closing = [_spread(pin, stations, c, n, phase) for c in closing_tractions(pin, n, phase)]
        basis = np.stack(closing, axis=-1)
        rows = slice(None) if n else slice(1)  # moments across count for n = 1 alone
        of_basis = np.stack(resultants(stations, basis))[rows]
        of_loads = np.stack(resultants(stations, w[..., columns]))[rows]
        if n:
            of_loads[1] += couples[columns]
        w[..., columns] -= basis @ np.linalg.solve(of_basis, of_loads)

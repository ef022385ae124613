"""Section forces of a pin under the loads of rings and its own body force."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.support.bands import Bands
from fea.support.lugs.lug import Lug
from fea.support.records import JointForces
from geometry import Pin

STATION_COUNT = 61  # along the pin, besides the ends of rings and segments


def stations(pin: Pin) -> Floats:
    """The z at which results have section forces, m."""
    return np.union1d(np.linspace(*pin.ends, STATION_COUNT), pin.stations)


def joint_forces(
    pin: Pin, mass: Floats, bands: Bands, loads: PinLoads, lugs: Sequence[Lug]
) -> JointForces:
    """The section forces at all instants, as `bending_moment` and `shear_force`.

    lugs: one for each of the bands.
    """
    z, names = stations(pin), tuple(lug.connection for lug in lugs)
    across = loads.forces[:, :, :2]
    forces = [across[:, bands.band == b].sum(axis=1) for b in range(len(names))]
    in_sections = (f(pin, mass, bands, loads, z) for f in (shear_force, bending_moment))
    shear, moment = (np.linalg.norm(x, axis=2) for x in in_sections)
    return JointForces(z, loads.times, shear, moment, names, np.stack(forces, axis=1))


def bending_moment(pin: Pin, mass: Floats, bands: Bands, loads: PinLoads, z: Floats) -> Floats:
    """The bending moment of the part of the pin before z (Z,) m, (T, Z, 2) N m.

    It is the integral of the shear along x and along y.
    mass: of the pin's segments, (S,) kg/m.
    loads: on the rings of `bands`, in their order; forces are even along a ring, moments make loads
    that are linear along it.
    """
    return _summed(pin, mass, bands, loads, z, _moments)


def shear_force(pin: Pin, mass: Floats, bands: Bands, loads: PinLoads, z: Floats) -> Floats:
    """The shear force, (T, Z, 2) N: the sum of the transverse loads on the pin before z.

    Arguments as in `bending_moment`.
    """
    return _summed(pin, mass, bands, loads, z, _forces)


Parts = tuple[Floats, Floats]  # (Z, R): of loads per length that are even, and that rise


def _summed(
    pin: Pin, mass: Floats, bands: Bands, loads: PinLoads, z: Floats,
    parts: Callable[[Floats, Floats], Parts],
) -> Floats:  # fmt: skip
    couples = np.stack([loads.moments[:, :, 1], -loads.moments[:, :, 0]], axis=2)
    mean = loads.forces[:, :, :2] / bands.length[:, None]
    slope = couples * (12.0 / bands.length**3)[:, None]
    even, rising = parts(z[:, None] - (bands.z - bands.length / 2.0), bands.length)
    rings = np.einsum("zr,tra->tza", even, mean) + np.einsum("zr,tra->tza", rising, slope)
    weight = loads.body[:, None, :2] * mass[:, None]
    ends = np.array(pin.stations)
    even, _ = parts(z[:, None] - ends[:-1], np.diff(ends))
    return np.asarray(rings + np.einsum("zs,tsa->tza", even, weight))


def _moments(way: Floats, lengths: Floats) -> Parts:
    """Moments of pieces under a unit load per length and under its unit slope.

    way: distances from their starts to z, (Z, R).
    """
    reach = np.clip(way, 0.0, lengths)  # of each piece that is before z
    even = reach * (way - reach / 2.0)
    return even, reach**2 * (way / 2.0 - reach / 3.0) - even * lengths / 2.0


def _forces(way: Floats, lengths: Floats) -> Parts:
    reach = np.clip(way, 0.0, lengths)
    return reach, reach * (reach - lengths) / 2.0


def mass_per_length(pin: Pin, density: float | None) -> Floats:
    """The mass per length of the segments, (S,) kg/m, 0 without density.

    The extra mass of fillets is spread in proportion.
    """
    area = np.array([s.mean_area for s in pin.segments])
    whole = (density or 0.0) * pin.volume
    return np.asarray(whole * area / (area @ np.diff(pin.stations)))

"""Bending moments of a pin under the loads of rings and its own body force."""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.joint.contact import Bands
from geometry import Pin


def bending_moment(pin: Pin, mass: Floats, bands: Bands, loads: PinLoads, z: Floats) -> Floats:
    """Of the part of the pin before z (Z,) m: (T, Z, 2) N m, the integral of the shear along x and
    along y.

    mass: of the pin's segments, (S,) kg/m. loads: on the rings of `bands`, in their order; forces
    are even along a ring, moments make loads that are linear along it.
    """
    mean = loads.forces[:, :, :2] / bands.length[:, None]
    couples = np.stack([loads.moments[:, :, 1], -loads.moments[:, :, 0]], axis=2)
    slope = couples * (12.0 / bands.length**3)[:, None]
    rings = _by_pieces(z, bands.z - bands.length / 2.0, bands.length, mean, slope)
    weight = loads.body[:, None, :2] * mass[:, None]
    ends = np.array(pin.stations)
    return rings + _by_pieces(z, ends[:-1], np.diff(ends), weight, np.zeros_like(weight))


def _by_pieces(z: Floats, starts: Floats, lengths: Floats, mean: Floats, slope: Floats) -> Floats:
    """Under loads per length of pieces, (T, R, 2): their mean, N/m, and slope along z, N/m^2."""
    way = z[:, None] - starts
    reach = np.clip(way, 0.0, lengths)  # of each piece that is before z
    even = reach * (way - reach / 2.0)
    rising = reach**2 * (way / 2.0 - reach / 3.0) - even * lengths / 2.0
    return np.asarray(
        np.einsum("zr,tra->tza", even, mean) + np.einsum("zr,tra->tza", rising, slope)
    )


def mass_per_length(pin: Pin, density: float | None) -> Floats:
    """Of the segments, (S,) kg/m, 0 without density; what fillets add is spread in proportion."""
    area = np.array([s.diameter**2 - s.bore**2 for s in pin.segments])
    whole = (density or 0.0) * pin.volume
    return np.asarray(whole * area / (area @ np.diff(pin.stations)))

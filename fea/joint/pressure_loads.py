"""Loads on a pin whose bands are cut into rings: pressures from contact, by harmonic."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from fea.core.pin_loads import Floats, PinLoads, UnitLoad
from fea.core.tractions import pressure_amplitude
from geometry import Pin


@dataclass(frozen=True)
class PressureLoads(PinLoads):
    """PinLoads on rings, of which `acting` has what acts: (T, 2) of every unit load, by phase.
    forces: resultants of the pressures on the rings, and the shares of forces along the axis.
    """

    acting: dict[UnitLoad, Floats] = field(default_factory=dict)

    def coefficients(self) -> dict[UnitLoad, Floats]:
        """How much of each unit load acts, (T, 2) by phase."""
        return self.acting

    def at(self, instants: NDArray[np.int64]) -> PressureLoads:
        """The loads at some of the instants, by their numbers."""
        acting = {load: amount[instants] for load, amount in self.acting.items()}
        times = None if self.times is None else self.times[instants]
        forces, moments, body = (x[instants] for x in (self.forces, self.moments, self.body))
        return replace(self, forces=forces, moments=moments, body=body, times=times, acting=acting)


def pressure_loads(
    pin: Pin, rings: tuple[str, ...], pressure: Floats, highest: int, loads: PinLoads
) -> PressureLoads:
    """Loads of pressures (T, R, M) Pa on M sectors of rings of a pin, with harmonics up to
    `highest`, and what else is in `loads`, whose surfaces are the bands that the rings cut: forces
    along the axis and torques, even over a band's rings, and the body force.
    """
    forces = np.zeros((len(pressure), len(rings), 3))
    moments = np.zeros_like(forces)
    share = ring_shares(pin, rings, loads.surfaces)
    forces[:, :, 2] = loads.forces[:, :, 2] @ share
    moments[:, :, 2] = loads.moments[:, :, 2] @ share
    others = replace(loads, surfaces=rings, forces=forces, moments=moments)
    acting = dict(PinLoads.coefficients(others))
    area = np.array([pin.band(name).area for name in rings])
    for n in range(highest + 1):
        amplitude = _amplitude(pressure, n)  # (T, R, 2)
        for r, name in enumerate(rings):
            if amplitude[:, r].any():
                unit = pressure_amplitude(n, pin.band(name))
                acting[UnitLoad(name, "pressure", n)] = amplitude[:, r] / unit
    forces[:, :, :2] = -0.5 * _amplitude(pressure, 1) * area[:, None]
    return PressureLoads(
        loads.case,
        rings,
        forces,
        moments,
        body=loads.body,
        times=loads.times,
        acting=acting,
    )


def _amplitude(pressure: Floats, n: int) -> Floats:
    """Of harmonic n of pressures (T, R, M), even on each sector: (T, R, 2), of cos and sin."""
    sectors = pressure.shape[2]
    angles = 2.0 * np.pi * np.arange(sectors) / sectors
    factor = np.sinc(n / sectors) * (2.0 if n else 1.0) / sectors
    waves = np.stack([np.cos(n * angles), np.sin(n * angles)], axis=1)
    return np.asarray(pressure @ waves * factor)


def ring_shares(pin: Pin, rings: tuple[str, ...], bands: tuple[str, ...]) -> Floats:
    """Of each band's load what each ring takes by its length, (C, R)."""
    own = np.array([[name.startswith(f"{band} ring ") for name in rings] for band in bands])
    part = own * np.array([pin.band(name).length for name in rings])
    return np.asarray(part / part.sum(axis=1, keepdims=True))

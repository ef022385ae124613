"""Forces of a shock strut by a gas or linear spring, an orifice, and friction.

The form is that of Milwitzky & Cook, NACA TR 1154 (1953). Force and stroke are positive in
compression.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.arrays import Floats
from pinbase.errors import ArgumentError, NumberInSI

MAX_DISPLACED_GAS_SHARE = 0.98  # largest share of the gas volume that a full stroke may displace


@dataclass(frozen=True)
class GasSpring:
    """A gas column, with the force A ((p + b) (v0 / (v0 - A s))^n - b) at stroke s.

    pressure: gas pressure p of the extended strut above ambient, Pa.
    volume: gas volume v0 of the extended strut, m^3.
    area: A, m^2.
    exponent: polytropic exponent n.
    ambient: ambient pressure b, Pa; b = 0 gives the form of NACA TR 1154.
    """

    pressure: float
    volume: float
    area: float
    exponent: float = 1.1
    ambient: float = 0.0

    def force(self, stroke: Floats) -> Floats:
        """Force at strokes (T,) m, (T,) N; the force at zero stroke is the preload."""
        ratio = self.volume / (self.volume - self.area * stroke)
        absolute = (self.pressure + self.ambient) * ratio**self.exponent
        return np.asarray(self.area * (absolute - self.ambient))

    def energy(self, stroke: Floats) -> Floats:
        """Energy stored from zero stroke to strokes (T,) m, (T,) J: the integral of the force."""
        log = -np.log1p(-self.area * stroke / self.volume)
        n1 = self.exponent - 1.0
        factor = log if n1 == 0.0 else np.expm1(n1 * log) / n1
        work = (self.pressure + self.ambient) * self.volume * factor
        return np.asarray(work - self.ambient * self.area * stroke)


@dataclass(frozen=True)
class LinearSpring:
    """A leaf or coil spring. stiffness: N/m. preload: N."""

    stiffness: float
    preload: float = 0.0

    def force(self, stroke: Floats) -> Floats:
        """Force at strokes (T,) m, (T,) N."""
        return self.preload + self.stiffness * stroke

    def energy(self, stroke: Floats) -> Floats:
        """Energy stored from zero stroke to strokes (T,) m, (T,) J."""
        return self.preload * stroke + 0.5 * self.stiffness * stroke**2


@dataclass(frozen=True)
class Oil:
    """An orifice, with the force rho A_h^3 / (2 (Cd A_n)^2) v |v| at closing speed v.

    density: rho, kg/m^3.
    area: hydraulic area A_h, m^2.
    orifice: area A_n, m^2.
    discharge: coefficient Cd.
    rebound: area of the orifice while the strut extends, m^2; None for the same area.

    Raises: ArgumentError for an orifice that is not smaller than the hydraulic area.
    """

    density: float
    area: float
    orifice: float
    discharge: float = 0.9
    rebound: float | None = None

    def __post_init__(self) -> None:
        if max(self.orifice, self.rebound or 0.0) >= self.area:
            raise ArgumentError(
                [
                    "an orifice of ",
                    NumberInSI(max(self.orifice, self.rebound or 0.0), "area"),
                    " is not smaller than the hydraulic area of ",
                    NumberInSI(self.area, "area"),
                ],
                "orifice-too-large",
            )

    def coefficient(self, orifice: float) -> float:
        """Force per square of the speed, N s^2/m^2. orifice: area, m^2."""
        return self.density * self.area**3 / (2.0 * (self.discharge * orifice) ** 2)

    def force(self, speed: Floats) -> Floats:
        """Force at closing speeds (T,) m/s, (T,) N."""
        closing = self.coefficient(self.orifice)
        opening = self.coefficient(self.rebound or self.orifice)
        return np.asarray(np.where(speed > 0.0, closing, opening) * speed * np.abs(speed))


@dataclass(frozen=True)
class Strut:
    """A shock strut.

    stroke: stroke at which the strut bottoms, m.
    friction: friction of its bearings and seals, N, independent of the load.

    Raises: ArgumentError for a stroke that would displace almost all the gas.
    """

    spring: GasSpring | LinearSpring
    stroke: float
    oil: Oil | None = None
    friction: float = 0.0

    def __post_init__(self) -> None:
        gas = self.spring
        if (
            isinstance(gas, GasSpring)
            and gas.area * self.stroke > MAX_DISPLACED_GAS_SHARE * gas.volume
        ):
            raise ArgumentError(
                [
                    "a stroke of ",
                    NumberInSI(self.stroke, "length"),
                    " displaces ",
                    NumberInSI(gas.area * self.stroke, "volume"),
                    " of gas, but the extended strut has ",
                    NumberInSI(gas.volume, "volume"),
                    f", of which at most {MAX_DISPLACED_GAS_SHARE:.0%} can be displaced: shorten "
                    "the stroke to at most ",
                    NumberInSI(MAX_DISPLACED_GAS_SHARE * gas.volume / gas.area, "length"),
                    ", or enlarge the volume",
                ],
                "stroke-exceeds-gas",
            )

    def oil_force(self, speed: Floats) -> Floats:
        """Force of the orifice at closing speeds (T,) m/s, (T,) N."""
        return np.zeros_like(speed) if self.oil is None else self.oil.force(speed)

"""The tractions of unit loads on the bands of a pin.

A bearing pressure p0 cos(a) on the loaded half of a band, a = theta - phi - pi for a force
along phi, has the resultant pi r L p0 / 2 = F, so p0 = 2 F / (pi r L), and the series

    p0 / pi + p0 / 2 cos a + sum over even n of (2 p0 / pi) (-1)^(n/2 + 1) / (n^2 - 1) cos n a

The remainder after harmonic N is at most (2 p0 / pi) / (2 N + 2).

A shear along or about the axis is a parabola over its band, zero at both edges, since a jump there
would make stress infinite.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from geometry import Band, PinLike
from pinbase.arrays import Floats


@dataclass(frozen=True)
class Traction:
    """The amplitudes of a traction along r, theta and z, as functions of z on a surface.

    They are `mean` + `slope` (z - middle) + `curve` (z - middle)^2, per unit of load.
    surface: name.
    middle: m.
    mean, slope, curve: (3,) each, Pa, Pa/m and Pa/m^2.
    """

    surface: str
    middle: float
    mean: Floats
    slope: Floats
    curve: Floats = field(default_factory=lambda: np.zeros(3))

    def at(self, z: Floats) -> Floats:
        """The amplitudes (..., 3), Pa, at z (...) in m."""
        s = z[..., None] - self.middle
        return np.asarray(self.mean + self.slope * s + self.curve * s**2)


ALONG_X = np.array([1.0, -1.0, 0.0])  # amplitudes of a traction of constant direction, n = 1
PRESSURE_ALONG_X = np.array([2.0, 0.0, 0.0])  # amplitudes of a pressure with the same resultant
ALONG_Z = np.array([0.0, 0.0, 1.0])
ABOUT_Z = np.array([0.0, -1.0, 0.0])  # at phase 1
INWARDS = np.array([-1.0, 0.0, 0.0])
WAY_ON_RINGS = {"axial": ALONG_Z, "around": ABOUT_Z, "pressure": INWARDS}
_NO_TRACTION = np.zeros(3)


def tractions_of(pin: PinLike, load: UnitLoad) -> tuple[Traction, ...]:
    """The tractions of a unit load on bands; none for a body load or a motion of a clamp."""
    if load.fades:
        return _fading(pin, load)
    if load.parts:
        bands = [(pin.band(name), amplitude) for name, amplitude in load.parts]
        way = WAY_ON_RINGS[load.kind]
        return tuple(Traction(b.name, b.middle, x * way, _NO_TRACTION) for b, x in bands)
    return () if load.kind in ("body", "shift", "turn") else (traction(pin, load),)


def traction(pin: PinLike, load: UnitLoad) -> Traction:
    """The traction of a unit load on one band."""
    if load.fades:
        return _fading(pin, load)[0]
    band = pin.band(load.surface)
    mean, slope = _NO_TRACTION, _NO_TRACTION
    if load.kind == "force":
        mean = (ALONG_X if load.n else ALONG_Z) / band.area
    elif load.kind in ("moment", "tilt") and load.n:
        across = ALONG_X if load.kind == "moment" else PRESSURE_ALONG_X
        slope = 12.0 * across / (band.area * band.length**2)
    elif load.kind == "moment":
        mean = ABOUT_Z / (band.area * band.radius)
    else:
        mean = pressure_amplitude(load.n, band) * INWARDS
    return Traction(load.surface, band.middle, mean, slope)


def _fading(pin: PinLike, load: UnitLoad) -> tuple[Traction, ...]:
    """The tractions of a shear that is a parabola over all rings of a band, zero at its edges."""
    rings = [pin.band(name) for name in load.surfaces]
    start, end = min(b.z0 for b in rings), max(b.z1 for b in rings)
    area = sum(b.area for b in rings)
    radius = sum(b.area * b.radius for b in rings) / area
    top = 1.5 / area * (ALONG_Z if load.kind == "pull" else ABOUT_Z / radius)
    curve = -top / (0.5 * (end - start)) ** 2
    middle = 0.5 * (start + end)
    return tuple(Traction(b.name, middle, top, _NO_TRACTION, curve) for b in rings)


def pressure_amplitude(n: int, band: Band) -> float:
    """The amplitude of harmonic n of a bearing pressure with a resultant of 1 N, Pa.

    Angles are measured from the direction of the force. The pressure acts on the opposite side (a =
    0), so that the amplitude for n = 1 is negative.
    """
    highest = 2.0 / (math.pi * band.radius * band.length)
    if n == 0:
        return highest / math.pi
    if n == 1:
        return -highest / 2.0
    return float(2.0 * highest / math.pi * (-1.0) ** (n // 2 + 1) / (n * n - 1.0))


def density_of(material: Material) -> float:
    """The density of a material, kg/m^3.

    Raises: SolveError for a material without a density.
    """
    if material.density is None:
        raise SolveError(
            f"material {material.name} has no density, which weight and inertia need", "no-density"
        )
    return material.density


def closing_tractions(
    pin: PinLike, n: int, phase: int, pressure: bool = False
) -> tuple[tuple[Traction, ...], ...]:
    """The tractions that react the imbalance of an unconstrained pin, each on all its bands.

    For n = 1 there are two: one that is constant, and one that is linear in z about the middle of
    each band, so that couples react a couple without changing the forces on the bands. For n = 0
    there is one along the axis, or one about the axis at phase 1. Of all tractions with a given
    resultant that keep the forces of the links on their bands except for the imbalance, these have
    the least mean square.
    pressure: whether to use pressures, which have no shear that jumps at a band's edge.
    """
    if not pin.connections:
        raise SolveError(
            f"pin {pin.name}: it is not clamped and no connection bears on it; add either",
            "unconstrained",
        )
    bands = [pin.band(name) for name in pin.connections]

    def everywhere(mean: Floats, slope: Floats) -> tuple[Traction, ...]:
        return tuple(Traction(b.name, b.middle, mean, slope) for b in bands)

    if n == 1:
        across = PRESSURE_ALONG_X if pressure else ALONG_X
        return everywhere(across, _NO_TRACTION), everywhere(_NO_TRACTION, across / pin.length)
    if phase == 0:
        return (everywhere(ALONG_Z, _NO_TRACTION),)
    return (tuple(Traction(b.name, 0.0, ABOUT_Z * b.radius, _NO_TRACTION) for b in bands),)

"""Section forces of a pin under the loads of rings and its own body force."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.support.bands import Bands
from fea.support.lugs.lug import Lug
from fea.support.records import JointForces
from geometry import Pin

# Forces or moments (Z, R) by loads per length that are constant and that are linear along a piece.
Parts = tuple[Floats, Floats]
STATION_COUNT = 61  # along the pin, in addition to the ends of rings and segments
SAME_FORCE = 1e-6  # relative accuracy to which contact gives the force on a lug


def stations(pin: Pin) -> Floats:
    """The z at which results have section forces, m."""
    return np.union1d(np.linspace(*pin.ends, STATION_COUNT), pin.stations)


@dataclass(frozen=True)
class LoadedJoint:
    """A pin in its lugs under the loads of a case.

    pin: with its bands cut into rings.
    lugs: one for each of the bands.
    loads: on the rings of `bands`, in their order, then on other surfaces. A force is a uniform
    load along its ring, a moment a load that is linear along its ring.
    mass: mass per length of the pin's segments, (S,) kg/m.
    """

    pin: Pin
    lugs: tuple[Lug, ...]
    bands: Bands
    loads: PinLoads
    mass: Floats

    @property
    def line_load(self) -> Floats:
        """The mean force per length of the lugs on the pin over each ring, along x and y, (T, R, 2)
        N/m.
        """
        forces = self.loads.forces[:, : len(self.bands.z), :2]
        return np.asarray(forces / self.bands.length[:, None])

    def bending_moment(self, z: Floats) -> Floats:
        """The bending moment at z (Z,) m by the loads before z, (T, Z, 2) N m.

        The two components are the integrals of the shear along x and along y.
        """
        return self._summed(z, _moments)

    def shear_force(self, z: Floats) -> Floats:
        """The shear force at z (Z,) m, (T, Z, 2) N: the sum of the transverse loads before z."""
        return self._summed(z, _forces)

    def section_forces(self) -> JointForces:
        """The section forces at all instants."""
        z, bands = stations(self.pin), self.bands
        forces = bands.sums(self.loads.forces[:, : len(bands.z), :2])
        shear, moment = (
            np.linalg.norm(x, axis=2) for x in (self.shear_force(z), self.bending_moment(z))
        )
        names = tuple(lug.connection for lug in self.lugs)
        pull, torque = map(np.abs, self.along(z))
        return JointForces(z, self.loads.times, shear, moment, names, forces, pull, torque)

    def along(self, z: Floats) -> tuple[Floats, Floats]:
        """The sums of axial loads, (T, Z) N, and of torques, (T, Z) N m, before z (Z,) m."""
        on = [self.pin.band(name) for name in self.loads.surfaces]
        middle, length = np.array([(band.middle, band.length) for band in on]).T
        part = np.clip((z[:, None] - middle) / length + 0.5, 0.0, 1.0)
        ends = np.array(self.pin.stations)
        mass = np.clip(z[:, None] - ends[:-1], 0.0, np.diff(ends)) @ self.mass
        pull = self.loads.forces[:, :, 2] @ part.T + np.outer(self.loads.body[:, 2], mass)
        return pull, self.loads.moments[:, :, 2] @ part.T

    def largest_across(self) -> Floats:
        """The largest shear force, N, and bending moment, N m, at any instant, (2,)."""
        z = stations(self.pin)
        across = self.shear_force(z), self.bending_moment(z)
        return np.array([np.linalg.norm(x, axis=2).max(initial=0.0) for x in across])

    def largest_of_lugs(self) -> Floats:
        """The largest force across the pin on each lug at any instant, (L,) N."""
        forces = np.linalg.norm(self.section_forces().forces, axis=2)
        return np.asarray(forces.max(axis=0, initial=0.0))

    def _summed(self, z: Floats, parts: Callable[[Floats, Floats], Parts]) -> Floats:
        bands, loads, ends = self.bands, self.loads, np.array(self.pin.stations)
        forces, moments = (x[:, : len(bands.z)] for x in (loads.forces, loads.moments))
        couples = np.stack([moments[:, :, 1], -moments[:, :, 0]], axis=2)
        mean = forces[:, :, :2] / bands.length[:, None]
        slope = couples * (12.0 / bands.length**3)[:, None]
        even, rising = parts(z[:, None] - (bands.z - bands.length / 2.0), bands.length)
        rings = even @ mean + rising @ slope
        weight = loads.body[:, None, :2] * self.mass[:, None]
        even, _ = parts(z[:, None] - ends[:-1], np.diff(ends))
        return np.asarray(rings + even @ weight)


def growth_across(varied: LoadedJoint, own: LoadedJoint) -> float:
    """The growth of the largest shear force or of the largest bending moment, relative to another
    joint, whichever is larger.

    own: the joint to compare with.
    """
    return float(_ratios(varied.largest_across(), own.largest_across()).max())


def growth_of_lugs(varied: LoadedJoint, own: LoadedJoint) -> tuple[tuple[str, float], ...]:
    """The growth of the largest force on each lug, relative to another joint, for the lugs whose
    force grows.

    The force on a lug can grow only where statics does not determine it.
    """
    ratios = _ratios(varied.largest_of_lugs(), own.largest_of_lugs()).tolist()
    pairs = zip(own.lugs, ratios, strict=True)
    return tuple((lug.connection, ratio) for lug, ratio in pairs if ratio > 1.0 + SAME_FORCE)


def _ratios(now: Floats, before: Floats) -> Floats:
    """The ratios of values to those before; 1 where the value before was zero."""
    return np.divide(now, before, out=np.ones_like(now), where=before > 0.0)


def _moments(way: Floats, lengths: Floats) -> Parts:
    """The moments at z of pieces under a unit load per length, and under a load of unit slope.

    way: distances from the starts of the pieces to z, (Z, R) m.
    """
    reach = np.clip(way, 0.0, lengths)  # length of each piece that lies before z
    even = reach * (way - reach / 2.0)
    return even, reach**2 * (way / 2.0 - reach / 3.0) - even * lengths / 2.0


def _forces(way: Floats, lengths: Floats) -> Parts:
    reach = np.clip(way, 0.0, lengths)
    return reach, reach * (reach - lengths) / 2.0


def mass_per_length(pin: Pin, density: float | None) -> Floats:
    """The mass per length of the segments, (S,) kg/m; zero without a density.

    The extra mass of fillets is distributed over all segments in proportion to their mass.
    """
    area = np.array([s.mean_area for s in pin.segments])
    whole = (density or 0.0) * pin.volume
    return np.asarray(whole * area / (area @ np.diff(pin.stations)))

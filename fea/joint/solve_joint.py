"""A pin in its lugs under all loads of a case: contact at every instant, then stress by pressures.

Flexibilities are found once, on a mesh of the pin and one of each lug; contact at an instant starts
from that of the one before. The pressures are loads like any other of the harmonic model, so that
stress, its error and verdict come from fea.solve_pin, of a pin that nothing clamps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.joint.contact import Bands, ContactProblem, Pressed
from fea.joint.fit import fitted
from fea.joint.flexibility import (
    half_plane,
    lug_flexibility,
    pin_flexibility,
    wavy_flexibility,
)
from fea.joint.lug import Lug
from fea.joint.pressure_loads import PressureLoads, pressure_loads
from fea.joint.rings import annulus, ring_ends, ringed, rings
from geometry import Pin

WAVES = 4  # times the sectors: harmonics in which neighbouring rings feel each other
BALANCED = 1e-6  # of the largest force: what links and the body force may leave over


@dataclass(frozen=True)
class Cells:
    """How finely contact is resolved. rings: of a band with sharp edges (fea.joint.rings); sectors:
    round it; highest: harmonic of elasticity that is computed; across: elements over the pin's
    diameter where flexibilities are found; beside: length of the rings beside the place where a
    rounded edge begins, of its radius.

    The usual ones give the moment and the stress at mid-span to 0.3 % (benchmarks/joint.py). They
    do not give the peak of pressure at rounded edges: contact reaches only a few hundredths of the
    radius into the rounding, and the peak to 3 % takes rings of a tenth of that: `beside` 0.004.
    """

    rings: int = 8
    sectors: int = 36
    highest: int = 12
    across: float = 10.0
    beside: float = 1.0 / 3.0


@dataclass(frozen=True)
class JointContact:
    """A case of a pin in its lugs. pin: its bands cut into rings; contact: by instant; loads: what
    the rings do to it.
    """

    pin: Pin
    lugs: tuple[Lug, ...]
    bands: Bands
    angles: Floats
    contact: tuple[Pressed, ...]
    loads: PressureLoads

    @property
    def line_load(self) -> Floats:
        """Force per length of the lugs on the pin at each ring, along x and y, (T, R, 2) N/m."""
        return np.asarray(self.loads.forces[:, :, :2] / self.bands.length[:, None])

    def bending_moment(self, z: Floats) -> Floats:
        """By contact and body force, of the part of the pin before z (Z,) m: (T, Z, 2) N m, the
        integral of the shear along x and along y.
        """
        low = self.bands.z - self.bands.length / 2.0
        reach = np.clip(z[:, None] - low, 0.0, self.bands.length)  # of each ring that is before z
        arm = reach * (z[:, None] - low - reach / 2.0)
        return np.asarray(np.einsum("zr,tra->tza", arm, self.line_load))

    @property
    def contact_angle(self) -> Floats:
        """Half angle of contact, (T, B) rad, at the ring of each band where it is largest."""
        sector = self.angles[1] - self.angles[0]
        cells = np.stack([(found.pressure > 0.0).sum(axis=1) for found in self.contact])
        half = 0.5 * sector * cells
        return np.stack(
            [half[:, self.bands.band == b].max(axis=1) for b in range(len(self.lugs))], axis=1
        )

    @property
    def largest_pressure(self) -> Floats:
        """By band, (T, B) Pa."""
        each = np.stack([found.pressure.max(axis=1) for found in self.contact])
        return np.stack(
            [each[:, self.bands.band == b].max(axis=1) for b in range(len(self.lugs))], axis=1
        )


class JointModel:
    """A pin in its lugs, with the flexibilities that serve all cases and clearances.

    Raises: ArgumentError for lugs that do not fit the pin; MeshError, SolveError.
    """

    def __init__(
        self, pin: Pin, material: Material, lugs: Sequence[Lug], cells: Cells = Cells()
    ) -> None:
        self.whole, self.material, self.cells = pin, material, cells
        self.lugs = fitted(pin, material, lugs)
        self.ends = {
            name: ring_ends(pin.band(name), lug.edge_radius, cells.rings, cells.beside)
            for name, lug in zip(pin.connections, self.lugs, strict=True)
        }
        self.pin = ringed(pin, self.ends)
        self.rings = tuple(name for c, ends in self.ends.items() for name in rings(c, ends))
        self.flexibility = self._flexibility()

    def _flexibility(self) -> Floats:
        """Of pin and lugs on all rings, by harmonic."""
        cells, waves = self.cells, np.arange(self.cells.highest + 1, WAVES * self.cells.sectors)
        low = pin_flexibility(self.pin, self.rings, self.material, cells.across, cells.highest)
        high = np.zeros((len(waves), *low.shape[1:]))
        first = 0
        for lug, ends in zip(self.lugs, self.ends.values(), strict=True):
            own = slice(first, first + len(ends) - 1)
            first = own.stop
            radius = self.whole.band(lug.connection).radius
            eye = annulus(self.whole, lug.connection, lug.outer_diameter, ends)
            low[:, own, own] += lug_flexibility(eye, lug, cells.across, cells.highest)
            high[:, own, own] = wavy_flexibility(lug, self.material, radius, ends, waves)
        return np.concatenate([low, high])

    def contact(self) -> ContactProblem:
        """Ready for any loads."""
        bands = [self.pin.band(name) for name in self.rings]
        z, length = (np.array(x) for x in zip(*((b.middle, b.length) for b in bands), strict=True))
        radius = np.array([b.radius for b in bands])
        counts = [len(ends) - 1 for ends in self.ends.values()]
        number = np.repeat(np.arange(len(self.lugs)), counts)
        gap = np.concatenate([lug.gap(self.ends[lug.connection]) for lug in self.lugs])
        tail = np.array(
            [
                half_plane(self.material, r) + half_plane(self.lugs[b].bearing, r)
                for r, b in zip(radius.tolist(), number.tolist(), strict=True)
            ]
        )
        tilt = [lug.tilt for lug in self.lugs]
        cut = Bands(z, length, radius, number, gap)
        return ContactProblem(cut, self.flexibility, tail, tilt, self.cells.sectors)

    def solve(self, loads: PinLoads) -> JointContact:
        """All instants of a case. loads: of links on all the lugs' bands or on some.

        Raises: SolveError where contact does not settle, or forces are not in balance.
        """
        forces = self._forces(loads)
        contact, found = self.contact(), []
        couples = self._couples(loads, contact.bands)
        last: NDArray[np.bool_] | None = None
        for t in range(len(loads)):
            pressed = contact.solve(forces[t], (couples[t, 0], couples[t, 1]), last)
            last = pressed.active
            found.append(pressed)
        pressure = np.stack([x.pressure for x in found])
        made = pressure_loads(self.pin, self.rings, pressure, self.cells.highest, loads)
        return JointContact(self.pin, self.lugs, contact.bands, contact.angles, tuple(found), made)

    def _forces(self, loads: PinLoads) -> Floats:
        """Of the links along x and y by lug, (T, B, 2) N."""
        out = np.zeros((len(loads), len(self.lugs), 2))
        for b, lug in enumerate(self.lugs):
            if lug.connection in loads.surfaces:
                out[:, b] = loads.forces[:, loads.surfaces.index(lug.connection), :2]
        body = loads.body[:, :2] * self._mass
        left = np.linalg.norm(out.sum(axis=1) + body, axis=1).max()
        if left > BALANCED * np.abs(out).max(initial=1e-300):
            raise SolveError(
                f"pin {self.whole.name}, case {loads.case}: the forces of its links have "
                f"a resultant of {left:.3g} N, which no contact reacts",
                "not-in-equilibrium",
            )
        return out

    def _couples(self, loads: PinLoads, bands: Bands) -> Floats:
        """About the middle of the bands along x and y, (T, 2) N m, of the body force."""
        middle = 0.5 * (bands.z.min() + bands.z.max())
        arm = _centre(self.whole) - middle
        x, y = (loads.body[:, :2] * self._mass).T
        return np.stack([-arm * y, arm * x], axis=1)

    @property
    def _mass(self) -> float:
        return (self.material.density or 0.0) * self.whole.volume


def _centre(pin: Pin) -> float:
    """z of the centre of volume of the cylinders, m."""
    area = np.array([s.diameter**2 - s.bore**2 for s in pin.segments])
    ends = np.array(pin.stations)
    return float(area @ np.diff(ends**2) / 2.0 / (area @ np.diff(ends)))

"""The small model of a pin in its lugs: a Timoshenko beam on elastic foundations.

Every lug is a row of springs between its bore and the pin's section, guided along the pin by the
lug, which shifts freely, so that its link's force is exact, and tilts with its stiffness. The
springs are those of frictionless contact in plane strain (plane_contact), of the pin's bore and the
lug's width; in three dimensions the neighbourhood shares a local load, which one number,
COMPLIANCE_SHARE, accounts for. All is linear: a pin is factorised once, and serves any number of
instants, directions and cases.

The springs act both ways, as a pin that fits its bore without clearance bears on one side or the
other. Clearance and the rounding of edges are left out: at a mean pressure of 100 MPa a clearance
of 0.001 of the diameter changes the largest moment by -9 to +12 % on 9 of 10 pins drawn at random,
0.003 by -18 to +25 %. Line loads have no peaks at the sharp edges of lugs. docs/benchmarks.md
compares the model with contact.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fea.beam.round_section import circle
from fea.beam.timoshenko import MOMENT, SHEAR, compliances
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.support.bands import Bands
from fea.support.contact.bending import bending_moment, mass_per_length, shear_force
from fea.support.contact.pressure_loads import ring_shares
from fea.support.foundation.plane_contact import plane_stiffness
from fea.support.foundation.supported_beam import Response, SupportedBeam, refined, respond
from fea.support.lugs.fit import fitted, on_structure
from fea.support.lugs.links import link_forces
from fea.support.lugs.lug import Lug
from fea.support.lugs.rings import graded, ring, ringed
from geometry import Pin, Segment

# Of the plane's compliance, fitted to the largest moments of 60 random pins
# (python -m benchmarks foundation).
COMPLIANCE_SHARE = 0.70

# Error of the largest bending moment, of contact without clearance over this model's, less 1: what
# 19 in 20 of 180 random pins are within (python -m benchmarks foundation).
PLAIN_MOMENT_ERROR = 0.06
# Added with two lugs: the moment is small, and depends on where in the lugs the loads act.
SINGLE_SHEAR_ERROR = 0.04
# Bore over diameter beyond which the section deforms, and the error added there.
TUBE_BORE_RATIO, TUBE_ERROR = 0.4, 0.04
# A middle lug's thickness over the diameter, and the error added with a thicker one.
LONG_LUG_RATIO, LONG_LUG_ERROR = 1.8, 0.05
THICKNESS_LIMITS = 0.3, 3.0  # limits of what was measured, over the smallest diameter
WIDTH_LIMITS = 1.6, 4.0  # of the lug, over the diameter
BORE_LIMITS = 0.0, 0.7  # over the diameter
MODULUS_RATIO_LIMITS = 1.0 / 3.0, 3.0  # of the lug, over the pin's
COUPLE_TOLERANCE = 1e-6  # of the largest force and the length: a couple below it is none
LIMIT_ROUND_OFF = 1e-9

Ints = NDArray[np.int64]
Stiffness = Callable[[Segment, Material, Lug], float]


def foundation_stiffness(segment: Segment, material: Material, lug: Lug) -> float:
    """The stiffness of the foundation of a pin's segment in a lug, N/m^2: force per length over
    deflection.
    """
    radii = segment.bore / 2.0, segment.diameter / 2.0
    return (
        plane_stiffness(radii, material, lug.outer_diameter / 2.0, lug.material) / COMPLIANCE_SHARE
    )


@dataclass(frozen=True)
class JointFoundation:
    """A case of a pin on foundations.

    pin: with its bands cut into rings.
    loads: of the rings on it, forces and, where the line load varies along a ring, moments.
    mass: of its segments, kg/m.
    """

    pin: Pin
    lugs: tuple[Lug, ...]
    bands: Bands
    loads: PinLoads
    mass: Floats

    @property
    def line_load(self) -> Floats:
        """The force per length of the lugs on the pin along x and y, the mean over each ring, (T,
        R, 2) N/m.

        Where its sign is not that of the link's force the other side of the bore carries.
        """
        return np.asarray(self.loads.forces[:, :, :2] / self.bands.length[:, None])

    def bending_moment(self, z: Floats) -> Floats:
        """The bending moment by the foundations and the body force of the part before z (Z,) m, (T,
        Z, 2) N m.

        It is the integral of the shear along x and along y.
        """
        return bending_moment(self.pin, self.mass, self.bands, self.loads, z)

    def shear_force(self, z: Floats) -> Floats:
        """The sum of the transverse loads before z (Z,) m, (T, Z, 2) N."""
        return shear_force(self.pin, self.mass, self.bands, self.loads, z)

    def along(self, z: Floats) -> tuple[Floats, Floats]:
        """The axial force (T, Z) N and the torque (T, Z) N m before z (Z,) m."""
        part = np.clip((z[:, None] - self.bands.z) / self.bands.length + 0.5, 0.0, 1.0)
        ends = np.array(self.pin.stations)
        mass = np.clip(z[:, None] - ends[:-1], 0.0, np.diff(ends)) @ self.mass
        pull = self.loads.forces[:, :, 2] @ part.T + np.outer(self.loads.body[:, 2], mass)
        return pull, self.loads.moments[:, :, 2] @ part.T


class FoundationModel:
    """A pin in its lugs as a beam, factorised for all cases.

    rings: of each band, into which loads are cut; their resultants do not depend on the number.
    stiffness: the function for the stiffness of foundations.
    Lugs named after segments on which no link bears are those of a structure, which is fixed.

    Raises: ValueError for a lug where nothing has its name, or a band without one.
    """

    def __init__(
        self,
        pin: Pin,
        material: Material,
        lugs: Sequence[Lug],
        rings: int = 8,
        stiffness: Stiffness = foundation_stiffness,
    ) -> None:
        self.given, self.material = pin, material
        self.whole = pin = on_structure(pin, lugs)
        self.lugs = fitted(pin, material, lugs)
        self.structure = [name not in self.given.connections for name in pin.connections]
        self.pin = ringed(
            pin, {name: graded(pin.band(name).length, rings) for name in pin.connections}
        )
        self.rings = tuple(ring(lug.connection, i) for lug in self.lugs for i in range(rings))
        self.bands = _bands(self.pin, self.rings, rings)
        self.mass = mass_per_length(self.pin, material.density)
        segments = [pin.segments[pin.labels.index(lug.connection)] for lug in self.lugs]
        soft = [stiffness(s, material, lug) for s, lug in zip(segments, self.lugs, strict=True)]
        self._unit = self._of_rings(np.array(soft))

    def solve(self, loads: PinLoads, whole: bool = True) -> JointFoundation:
        """Solve all instants of a case.

        loads: of links on all the lugs' bands or on some.
        whole: false for a part of loads, which need not be in balance.

        Raises: SolveError where forces are not in balance, no lug reacts a couple, or links exert
        moments across the axis.
        """
        link_force = link_forces(self.given, self._weight, loads, any(self.structure), whole)
        on = np.zeros((len(loads), len(self.lugs), 2))
        on[:, np.logical_not(self.structure)] = link_force[:, : len(self.given.connections)]
        acting = np.concatenate([on, loads.body[:, None, :2]], axis=1)
        force = np.einsum("rp,tpa->tra", self._unit.force, acting)
        moment = np.einsum("rp,tpa->tra", self._unit.moment, acting)
        if whole:
            self._require_couples(loads.case, moment, force, link_force)
        pull = loads.body[:, 2] * self._weight
        forces = np.dstack([force, self._along(loads, loads.forces[:, :, 2], pull)])
        torque = self._along(loads, loads.moments[:, :, 2], 0.0 * pull)
        about = np.dstack([-moment[..., 1], moment[..., 0], torque])
        ring_loads = replace(
            loads, surfaces=self.rings, forces=forces, moments=about, distribution="cosine"
        )
        return JointFoundation(self.pin, self.lugs, self.bands, ring_loads, self.mass)

    def with_clearances(self, lugs: Sequence[Lug]) -> FoundationModel:
        """The same model with lugs of other clearance, which changes the error alone.

        lugs: in the order of the bands.
        """
        other = copy.copy(self)
        other.lugs = tuple(lugs)
        return other

    @property
    def _weight(self) -> float:
        """Mass of the pin, kg."""
        return float(self.mass @ np.diff(self.pin.stations))

    def _along(self, loads: PinLoads, amounts: Floats, body: Floats) -> Floats:
        """The axial forces or torques (T, C) of the links as those of the rings, (T, R), even along
        a band.

        A structure reacts, evenly, the remainder of these and of the body's (T,).
        """
        out = amounts @ ring_shares(self.pin, self.rings, loads.surfaces)
        react = self.bands.length * np.array(self.structure)[self.bands.band]
        if react.any():
            out = out - np.outer(amounts.sum(axis=1) + body, react / react.sum())
        return np.asarray(out)

    def _of_rings(self, stiffness: Floats) -> Response:
        """The response of the rings to unit loads of the lugs."""
        beam, number = self._beam(stiffness)
        still = np.flatnonzero(self.structure).tolist() or [0]
        response = respond(beam, self.bands.middles, [lug.tilt for lug in self.lugs], still)
        belongs = (number == np.arange(len(self.rings))[:, None]).astype(float)
        middles = 0.5 * (beam.stations[1:] + beam.stations[:-1])
        arms = belongs * (middles - self.bands.z[:, None])
        return Response(belongs @ response.force, belongs @ response.moment + arms @ response.force)

    def _beam(self, stiffness: Floats) -> tuple[SupportedBeam, Ints]:
        """The pieces of the beam, and the number of the ring that each is in, -1 outside."""
        bands, pin = self.bands, self.pin
        low, high = bands.z - bands.length / 2.0, bands.z + bands.length / 2.0
        z = np.sort([*pin.stations, *low, *high])
        z = z[np.r_[True, np.diff(z) > 1e-12 * pin.length]]
        soft = np.array([compliances(circle(s), self.material) for s in pin.segments])

        def ring_at(z: Floats) -> Ints:
            middle = 0.5 * (z[1:, None] + z[:-1, None])
            inside = (low < middle) & (middle < high)
            return np.where(inside.any(axis=1), inside.argmax(axis=1), -1)

        def foundation(number: Ints) -> Floats:
            return np.where(number < 0, 0.0, stiffness[bands.band[number]])

        z = refined(z, np.full(len(z) - 1, soft[:, MOMENT].max()), foundation(ring_at(z)))
        number = ring_at(z)
        at = np.searchsorted(pin.stations[1:-1], 0.5 * (z[1:] + z[:-1]), side="right")
        lug = np.where(number < 0, -1, bands.band[number])
        parts = soft[at, MOMENT], soft[at, SHEAR], foundation(number), self.mass[at], lug
        return SupportedBeam(z, *parts), number

    def _require_couples(
        self, case: str, moment: Floats, force: Floats, link_force: Floats
    ) -> None:
        """Check that no couple is left on a lug that is free to tilt.

        Raises: SolveError where one is.
        """
        bands = self.bands
        arm = (bands.z - bands.middles[bands.band])[:, None]
        least = COUPLE_TOLERANCE * self.pin.length * np.abs(link_force).max(initial=0.0)
        for b, lug in enumerate(self.lugs):
            on_band = bands.band == b
            left = np.abs((moment + arm * force)[:, on_band].sum(axis=1)).max(initial=0.0)
            if lug.tilt == 0.0 and left > least:
                raise SolveError(
                    f"pin {self.whole.name}, case {case}: its links leave a couple of {left:.3g} "
                    "N m, which no lug reacts",
                    "couple-not-reacted",
                )


def moment_error(pin: Pin, material: Material, lugs: Sequence[Lug]) -> float:
    """The relative error of the largest bending moment of FoundationModel.

    It is the difference from frictionless contact without clearance; inf outside of what was
    measured.

    Raises: ValueError as FoundationModel.
    """
    pin = on_structure(pin, lugs)
    every = fitted(pin, material, lugs)
    bands = [pin.band(lug.connection) for lug in every]
    stiff = [lug.material.youngs_modulus / material.youngs_modulus for lug in every]
    thick = [band.length / pin.smallest_diameter for band in bands]
    wide = [lug.outer_diameter / 2.0 / b.radius for lug, b in zip(every, bands, strict=True)]
    bore = max(s.bore / s.diameter for s in pin.segments)
    measured = (
        (thick, THICKNESS_LIMITS),
        (wide, WIDTH_LIMITS),
        ([bore], BORE_LIMITS),
        (stiff, MODULUS_RATIO_LIMITS),
    )
    inside = all(_within(values, limits) for values, limits in measured)
    if len(every) < 2 or not inside:
        return math.inf
    error = PLAIN_MOMENT_ERROR + (SINGLE_SHEAR_ERROR if len(every) == 2 else 0.0)
    error += TUBE_ERROR if bore > TUBE_BORE_RATIO else 0.0
    return error + (LONG_LUG_ERROR if max(thick[1:-1], default=0.0) > LONG_LUG_RATIO else 0.0)


def _within(values: Sequence[float], limits: tuple[float, float]) -> bool:
    low, high = limits
    return all(low * (1.0 - LIMIT_ROUND_OFF) <= x <= high * (1.0 + LIMIT_ROUND_OFF) for x in values)


def _bands(pin: Pin, rings: Sequence[str], rings_per_band: int) -> Bands:
    cut = [pin.band(name) for name in rings]
    z, length, radius = np.array([(b.middle, b.length, b.radius) for b in cut]).T
    number = np.arange(len(cut)) // rings_per_band
    return Bands(z, length, radius, number, np.zeros(len(cut)))

"""The small model of a pin in its lugs: a Timoshenko beam on elastic foundations.

Each lug is a row of springs between its bore and the sections of the pin. The lug shifts freely, so
that its link's force is exact, and tilts with its stiffness. The spring stiffness is that of
frictionless contact in plane strain (plane_contact), and depends on the pin's bore and the lug's
width. In three dimensions the neighbourhood shares a local load; the factor COMPLIANCE_SHARE
accounts for this. The model is linear: a pin is factorised once for any number of instants,
directions and cases.

The springs act in both directions, since a pin that fits its bore without clearance bears on one
side or the other. Clearance and the rounding of edges are left out. At a mean pressure of 100 MPa,
a clearance of 0.001 of the diameter changes the largest moment by -9 to +12 % on 9 of 10 random
pins, one of 0.003 by -18 to +25 %. Line loads have no peaks at the sharp edges of lugs.
docs/benchmarks.md compares the model with contact.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fea.beam.round_section import circle
from fea.beam.timoshenko import MOMENT, SHEAR, compliances
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.support.bands import Bands
from fea.support.contact.bending import LoadedJoint, mass_per_length
from fea.support.contact.pressure_loads import others_along
from fea.support.foundation.plane_contact import plane_stiffness
from fea.support.foundation.supported_beam import Response, SupportedBeam, refined, respond
from fea.support.lugs.fit import fitted, on_structure
from fea.support.lugs.links import link_forces, link_moments, tilting_bands
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from geometry.shape.rings import graded, ring, ringed

# Factor on the compliance of plane contact, fitted to the largest moments of 60 random pins
# (python -m benchmarks foundation).
COMPLIANCE_SHARE = 0.70

# Relative error of the largest bending moment (of contact without clearance over that of this
# model, less 1), which covers 19 in 20 of 180 random pins (python -m benchmarks foundation).
PLAIN_MOMENT_ERROR = 0.06
# Error added with two lugs: the moment is small, and depends on where in the lugs the loads act.
SINGLE_SHEAR_ERROR = 0.04
# Bore over diameter above which the section deforms, and the error added there.
TUBE_BORE_RATIO, TUBE_ERROR = 0.4, 0.04
# Thickness of a middle lug over the diameter, and the error added with a thicker lug.
LONG_LUG_RATIO, LONG_LUG_ERROR = 1.8, 0.05
# Limits of the pins on which the error was measured:
THICKNESS_LIMITS = 0.3, 3.0  # thickness of the lugs, over the smallest diameter of the pin
WIDTH_LIMITS = 1.6, 4.0  # outer diameter of the lug, over the diameter of the band
BORE_LIMITS = 0.0, 0.7  # bore of the pin, over its diameter
MODULUS_RATIO_LIMITS = 1.0 / 3.0, 3.0  # modulus of the lug, over that of the pin
# Fraction of the largest force times the length (or of the largest couple) below which a couple is
# zero.
COUPLE_TOLERANCE = 1e-6
LIMIT_ROUND_OFF = 1e-9

Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]
Stiffness = Callable[[Segment, Material, Lug], float]


def foundation_stiffness(segment: Segment, material: Material, lug: Lug) -> float:
    """The stiffness of the foundation of a pin's segment in a lug, N/m^2: the force per length over
    the deflection.
    """
    radii = segment.bore / 2.0, segment.diameter / 2.0
    return (
        plane_stiffness(radii, material, lug.outer_diameter / 2.0, lug.material) / COMPLIANCE_SHARE
    )


class JointFoundation(LoadedJoint):
    """A pin on foundations under the loads of a case.

    The loads are forces on the rings, and moments where the line load varies along a ring, then
    axial forces on other surfaces. Where a line load has the opposite sign of the link's force, the
    other side of the bore carries it.
    """


class FoundationModel:
    """A pin in its lugs as a beam, factorised for all cases.

    Lugs named after segments on which no link bears belong to a fixed structure.
    rings: number of rings into which the loads on each band are cut; their resultants do not depend
    on it.
    stiffness: function for the stiffness of foundations.

    Raises: ArgumentError for a lug without a band, a band without a lug, or a lug that does not fit
    (fea.support.lugs.fit.fitted).
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
        self._stiffness = np.array(soft)
        self._responses: dict[bytes, Response] = {}

    def solve(self, loads: PinLoads, whole: bool = True) -> JointFoundation:
        """Return the joint at all instants of a case.

        loads: of the links, on all bands or on some of them.
        whole: false for a part of the loads, which need not be in balance.

        Raises: SolveError where forces are not in balance, or no lug reacts a couple.
        """
        unit = self._of_rings(tilting_bands(self.whole, loads))
        link_force = link_forces(self.given, self._weight, loads, any(self.structure), whole)
        on = np.zeros((len(loads), len(self.lugs), 2))
        on[:, np.logical_not(self.structure)] = link_force[:, : len(self.given.connections)]
        link_moment = self._link_moments(loads, link_force, whole)
        couples = np.stack([link_moment[..., 1], -link_moment[..., 0]], axis=2)
        acting = np.concatenate([on, loads.body[:, None, :2], couples], axis=1)
        force = np.einsum("rp,tpa->tra", unit.force, acting)
        moment = np.einsum("rp,tpa->tra", unit.moment, acting)
        if whole:
            self._require_couples(loads, moment, force, couples, link_force)
        along, rings = others_along(self.pin, self.rings, loads), len(self.rings)
        forces, about = along.forces.copy(), along.moments.copy()
        forces[:, :rings, :2] = force
        about[:, :rings, :2] = np.stack([-moment[..., 1], moment[..., 0]], axis=2)
        pull = loads.forces[:, :, 2].sum(axis=1) + loads.body[:, 2] * self._weight
        forces[:, :rings, 2] -= self._reacted(pull)
        about[:, :rings, 2] -= self._reacted(loads.moments[:, :, 2].sum(axis=1))
        ring_loads = replace(
            loads,
            surfaces=along.surfaces,
            forces=forces,
            moments=about,
            distribution="cosine",
            always=along.always,
            bands=along.bands,
        )
        return JointFoundation(self.pin, self.lugs, self.bands, ring_loads, self.mass)

    def with_clearances(self, lugs: Sequence[Lug]) -> FoundationModel:
        """The same model with lugs of other clearance, which affects only the error.

        lugs: in the order of the bands.
        """
        other = copy.copy(self)
        other.lugs = tuple(lugs)
        return other

    @property
    def _weight(self) -> float:
        """The mass of the pin, kg."""
        return float(self.mass @ np.diff(self.pin.stations))

    def _reacted(self, amounts: Floats) -> Floats:
        """The axial forces or torques on the rings, (T, R), that a structure reacts, distributed
        uniformly along its bands; zero without a structure.

        amounts: the sums, (T,).
        """
        react = self.bands.length * np.array(self.structure)[self.bands.band]
        return np.outer(amounts, react / (react.sum() or 1.0))

    def _link_moments(self, loads: PinLoads, link_force: Floats, whole: bool) -> Floats:
        """The moments about x and y that links transmit to the pin at each lug, (T, B, 2) N m.

        For a part of the loads they are the stated moments, without a share of the imbalance.
        """
        ends, masses = np.array(self.pin.stations), self.mass * np.diff(self.pin.stations)
        centre = float(masses @ (ends[1:] + ends[:-1])) / 2.0 / (self._weight or 1.0)
        weight, lugs = (self._weight, centre), self.lugs if whole else ()
        return link_moments((self.given, self.whole), lugs, loads, link_force, weight)

    def _of_rings(self, free: Mask) -> Response:
        """The response of the rings to the unit loads, kept for later loads.

        free: mask (B,) of the lugs that are free to tilt.
        """
        key = free.tobytes()
        if key not in self._responses:
            self._responses[key] = self._respond(free)
        return self._responses[key]

    def _respond(self, free: Mask) -> Response:
        beam, number = self._beam(self._stiffness)
        fixed = np.flatnonzero(self.structure).tolist() or [0]
        tilt = [0.0 if f else lug.tilt for f, lug in zip(free, self.lugs, strict=True)]
        response = respond(beam, self.bands.middles, tilt, fixed)
        belongs = (number == np.arange(len(self.rings))[:, None]).astype(float)
        middles = 0.5 * (beam.stations[1:] + beam.stations[:-1])
        arms = belongs * (middles - self.bands.z[:, None])
        return Response(belongs @ response.force, belongs @ response.moment + arms @ response.force)

    def _beam(self, stiffness: Floats) -> tuple[SupportedBeam, Ints]:
        """The beam, and the number of the ring that holds each of its pieces, -1 outside of rings.

        stiffness: of the foundation in each lug, (B,) N/m^2.
        """
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
        self, loads: PinLoads, moment: Floats, force: Floats, couples: Floats, link_force: Floats
    ) -> None:
        """Check that each lug that is free to tilt has only the couple that its link states.

        moment, force: on the rings, (T, R, 2). couples: stated by the links, (T, B, 2) N m.

        Raises: SolveError where another couple remains.
        """
        bands = self.bands
        arm = (bands.z - bands.middles[bands.band])[:, None]
        turning = self.pin.length * np.abs(link_force).max(initial=0.0)
        least = COUPLE_TOLERANCE * np.abs(couples).max(initial=turning)
        free = tilting_bands(self.whole, loads) | [lug.tilt == 0.0 for lug in self.lugs]
        for b in np.flatnonzero(free):
            on_band = bands.band == b
            of_lug = (moment + arm * force)[:, on_band].sum(axis=1) - couples[:, b]
            left = np.abs(of_lug).max(initial=0.0)
            if left > least:
                raise SolveError(
                    f"pin {self.whole.name}, case {loads.case}: its links leave a couple of "
                    f"{left:.3g} N m, which no lug reacts",
                    "couple-not-reacted",
                )


def moment_error(pin: Pin, material: Material, lugs: Sequence[Lug]) -> float:
    """The relative error of the largest bending moment of FoundationModel.

    It is the difference from frictionless contact without clearance; inf outside the limits of the
    measurements.

    Raises: ArgumentError as FoundationModel.
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

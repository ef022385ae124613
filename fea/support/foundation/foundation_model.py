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
Mask = NDArray[np.bool_]
Stiffness = Callable[[Segment, Material, Lug], float]


def foundation_stiffness(segment: Segment, material: Material, lug: Lug) -> float:
    """The stiffness of the foundation of a pin's segment in a lug, N/m^2: force per length over
    deflection.
    """
    radii = segment.bore / 2.0, segment.diameter / 2.0
    return (
        plane_stiffness(radii, material, lug.outer_diameter / 2.0, lug.material) / COMPLIANCE_SHARE
    )


class JointFoundation(LoadedJoint):
    """A case of a pin on foundations.

    Its loads are of the rings, forces and, where the line load varies along a ring, moments; then
    the axial forces on other surfaces. Where the sign of a line load is not that of the link's
    force the other side of the bore carries.
    """


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
        self._stiffness = np.array(soft)
        self._responses: dict[bytes, Response] = {}

    def solve(self, loads: PinLoads, whole: bool = True) -> JointFoundation:
        """Solve all instants of a case.

        loads: of links on all the lugs' bands or on some.
        whole: false for a part of loads, which need not be in balance.

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

    def _reacted(self, amounts: Floats) -> Floats:
        """The axial forces or torques (T,) as those of the rings, (T, R), that a structure reacts,
        even along its bands; zero without one.
        """
        react = self.bands.length * np.array(self.structure)[self.bands.band]
        return np.outer(amounts, react / (react.sum() or 1.0))

    def _link_moments(self, loads: PinLoads, link_force: Floats, whole: bool) -> Floats:
        """The moments about x and y that links bring to the pin at each lug, (T, B, 2) N m; of a
        part of loads just what it states.
        """
        ends, masses = np.array(self.pin.stations), self.mass * np.diff(self.pin.stations)
        centre = float(masses @ (ends[1:] + ends[:-1])) / 2.0 / (self._weight or 1.0)
        weight, lugs = (self._weight, centre), self.lugs if whole else ()
        return link_moments((self.given, self.whole), lugs, loads, link_force, weight)

    def _of_rings(self, free: Mask) -> Response:
        """The response of the rings to unit loads of the lugs, of which some (B,) are free to
        tilt, kept for further loads.
        """
        key = free.tobytes()
        if key not in self._responses:
            self._responses[key] = self._respond(free)
        return self._responses[key]

    def _respond(self, free: Mask) -> Response:
        beam, number = self._beam(self._stiffness)
        still = np.flatnonzero(self.structure).tolist() or [0]
        tilt = [0.0 if f else lug.tilt for f, lug in zip(free, self.lugs, strict=True)]
        response = respond(beam, self.bands.middles, tilt, still)
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
        self, loads: PinLoads, moment: Floats, force: Floats, couples: Floats, link_force: Floats
    ) -> None:
        """Check that no couple is left on a lug that is free to tilt but what its link states.

        Raises: SolveError where one is.
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

"""The contact of a pin in its lugs at all instants of a case, and the pressures as loads.

Flexibilities are computed once, on a mesh of the pin and one mesh of each lug. Contact at an
instant starts from the most similar instant that has been solved. The harmonic model takes the
pressures like any other loads, so that stress, its error and the verdict come from fea.solve.solve
for an unclamped pin.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from fea.core.equilibrium import centre_of_volume
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.pressed import PressedArcs, Rings
from fea.harmonic.first_mesh import FirstMesh
from fea.singular.lug_edge import lug_edge_exponent
from fea.support.bands import Bands
from fea.support.contact.bending import mass_per_length
from fea.support.contact.contact import ContactProblem
from fea.support.contact.contact_state import ContactState
from fea.support.contact.flexibility import (
    RingBody,
    half_plane,
    lug_rings,
    pin_rings,
    wavy_flexibility,
)
from fea.support.contact.instants import JointLoads, contact_at_instants
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.pressure_loads import (
    MODE_TOLERANCE,
    PressureLoads,
    PressureModes,
    amplitudes,
    pressure_modes,
)
from fea.support.contact.resolution import USUAL, Resolution
from fea.support.contact.seen_cuts import SeenCuts, seen_cuts
from fea.support.lugs.changes import softened
from fea.support.lugs.fit import fitted, on_structure
from fea.support.lugs.links import link_forces, link_moments, link_numbers, tilting_bands
from fea.support.lugs.lug import Bushing, Lug
from geometry import CutPin, Pin
from geometry.shape.rings import annulus, beside_fillets, ring_ends, ringed, rings
from pinbase.arrays import Ints, Mask
from pinbase.memo import Memo

LUG_SIZE_DIGITS = 12  # digits to which lugs of the same size agree
# Harmonics, as a multiple of the sectors, below which the rings of a lug are coupled; from there on
# each ring is a half-plane (tail).
COUPLED_HARMONICS_PER_SECTOR = 4
FlexibilityKey = tuple[float, Material, Bushing | None, bytes, Material]


class ContactModel:
    """A pin in its lugs, with the flexibilities that serve all cases and clearances.

    first: first mesh for stress; None where nothing is solved on that mesh again.
    on_pin, on_lugs: meshes of the flexibilities; equal lugs share one mesh.
    memo: flexibilities and meshes, shared with other models.
    cuts: cuts of the pin as contact sees them; None for a pin without cuts.

    Raises: ArgumentError for lugs that do not fit the pin; MeshError, SolveError.
    """

    def __init__(
        self,
        pin: Pin,
        material: Material,
        lugs: Sequence[Lug],
        cells: Resolution = USUAL,
        memo: Memo | None = None,
    ) -> None:
        self.first: FirstMesh | None = FirstMesh(memo)
        self.cuts: SeenCuts | None = None
        self.cells, self._memo = cells, memo or Memo()
        self._shape(pin, material, lugs)
        self.on_pin, self.of_pin = self._pin_flexibility()
        self.of_lugs = np.zeros_like(self.of_pin)
        self.wavy = np.zeros((2, len(self.high), *self.of_pin.shape[1:]))  # of the pin, of the lugs
        self.on_lugs: dict[FlexibilityKey, RingBody] = {}
        for key, equal in self.equal_lugs().items():
            (_, lug, ends), *_ = equal
            self.on_lugs[key], low, wavy = self._lug_flexibility(lug, ends)
            for rows, *_ in equal:
                self.of_lugs[:, rows, rows], self.wavy[:, :, rows, rows] = low, wavy

    def seeing(self, cut: CutPin) -> ContactModel:
        """The model whose contact sees the cuts of the pin.

        Raises: MeshError, SolveError.
        """
        other, whole = copy.copy(self), replace(cut, profile=self.whole)
        other.__dict__.pop("contact", None)

        def make() -> SeenCuts:
            return seen_cuts(whole, self.pin, self.rings, self.material, self.cells.highest)

        key = "cuts", whole, self.pin, self.rings, elastic(self.material)
        other.cuts = self._memo.get((*key, self.cells.highest), make)
        return other

    def _pin_flexibility(self) -> tuple[RingBody, Floats]:
        """The rings of the pin on a mesh and their flexibility, solved once for each shape."""

        def make() -> tuple[RingBody, Floats]:
            body = pin_rings(self.pin, self.rings, self.material, self.cells.across)
            return body, body.flexibility(self.cells.highest)

        key = "pin", self.pin, self.rings, elastic(self.material)
        return self._memo.get((*key, self.cells.across, self.cells.highest), make)

    def _lug_flexibility(self, lug: Lug, ends: Floats) -> tuple[RingBody, Floats, Floats]:
        """The rings of a lug on a mesh, their flexibility, and that for short waves (`wavy_of`)."""

        def make() -> tuple[RingBody, Floats, Floats]:
            body = lug_rings(self.eye(lug, ends), lug, self.cells.across)
            return body, body.flexibility(self.cells.highest), self.wavy_of(lug, ends)

        radius, bushing = self.whole.band(lug.connection).radius, lug.bushing
        size = radius, lug.outer_diameter, bushing and bushing.thickness, ends.tobytes()
        made_of = tuple(map(elastic, (self.material, lug.material, lug.bearing)))
        key = "lug", lug.connection, size, made_of
        return self._memo.get((*key, self.cells), make)

    def _shape(self, pin: Pin, material: Material, lugs: Sequence[Lug]) -> None:
        cells, before = self.cells, self.__dict__.get("_cut")
        self.given, self.material = pin, material
        self.whole = pin = on_structure(pin, lugs)
        self.lugs = fitted(pin, material, lugs)
        self.ends = {
            name: ring_ends(
                pin.band(name),
                lug.edge_radius,
                cells.rings,
                cells.beside,
                beside_fillets(pin, pin.band(name)),
            )
            for name, lug in zip(pin.connections, self.lugs, strict=True)
        }
        cut = pin, {name: ends.tolist() for name, ends in self.ends.items()}
        if before != cut:
            self._cut, self.pin = cut, ringed(pin, self.ends)
        self.rings = tuple(name for c, ends in self.ends.items() for name in rings(c, ends))

    def without_meshes(self) -> ContactModel:
        """The model ready for contact, without meshes, which only derivatives and shapes need."""
        other = copy.copy(self)
        other._memo = Memo()
        for meshes in ("on_pin", "on_lugs", "first"):
            del other.__dict__[meshes]
        return other.varied(other.lugs)

    def reshaped(self, pin: Pin, material: Material, lugs: Sequence[Lug]) -> ContactModel:
        """The model of another pin in other lugs on the same resolution of cells, with the
        flexibilities of this one.

        Raises: ArgumentError for lugs that do not fit the pin.
        """
        other = copy.copy(self)
        for known in ("contact", "flexibility", "bands", "on_shaft"):
            other.__dict__.pop(known, None)
        other._shape(pin, material, lugs)
        return other

    def ring_count(self, of_band: int) -> int:
        """The approximate number of all rings, if a band with sharp edges had `of_band` rings."""
        return len(self.rings) * of_band // self.cells.rings

    @property
    def high(self) -> Ints:
        """The harmonics beyond `highest`, through which only rings of the same lug are coupled."""
        return np.arange(self.cells.highest + 1, COUPLED_HARMONICS_PER_SECTOR * self.cells.sectors)

    def eye(self, lug: Lug, ends: Floats) -> Pin:
        """The eye of a lug, with its rings."""
        return annulus(self.whole, lug.connection, lug.outer_diameter, ends)

    def wavy_of(self, lug: Lug, ends: Floats) -> Floats:
        """The flexibility of pin and lug for short waves, on the lug's rings."""
        radius = self.whole.band(lug.connection).radius
        return wavy_flexibility(lug, self.material, radius, ends, self.high)

    def flexibility_key(self, lug: Lug, ends: Floats) -> FlexibilityKey:
        """The properties that decide a lug's flexibility, and that of the pin for short waves."""
        bore = 2.0 * self.whole.band(lug.connection).radius
        size = np.round(np.append(ends, bore) / lug.outer_diameter, LUG_SIZE_DIGITS)
        return lug.outer_diameter, lug.material, lug.bushing, size.tobytes(), self.material

    def equal_lugs(self) -> dict[FlexibilityKey, list[tuple[slice, Lug, Floats]]]:
        """The lugs grouped by equal flexibility, in the form of `by_lug`."""
        groups: dict[FlexibilityKey, list[tuple[slice, Lug, Floats]]] = {}
        for rows, lug, ends in self.by_lug():
            groups.setdefault(self.flexibility_key(lug, ends), []).append((rows, lug, ends))
        return groups

    def by_lug(self) -> Iterator[tuple[slice, Lug, Floats]]:
        """Yield for each lug the numbers of its rings, the lug, and the rings' ends in it, m."""
        first = 0
        for lug, ends in zip(self.lugs, self.ends.values(), strict=True):
            rows = slice(first, first + len(ends) - 1)
            yield rows, lug, ends
            first = rows.stop

    @cached_property
    def flexibility(self) -> Floats:
        """The flexibility of pin and lugs on all rings, by harmonic, m/Pa.

        Beyond `highest` pin and lugs count as half-spaces, which couple only the rings of one lug.
        """
        return np.concatenate([self.of_pin + self.of_lugs, self.wavy.sum(axis=0)])

    def varied(self, lugs: tuple[Lug, ...], softness: Sequence[float] = ()) -> ContactModel:
        """The model of the same pin in lugs of other clearance, edge radius and tilt, with the
        flexibilities of this model.

        softness: factor on the compliance of each lug.
        """
        softness = softness or (1.0,) * len(lugs)
        other = copy.copy(self)
        for known in ("contact", "flexibility", "bands", "on_shaft"):
            other.__dict__.pop(known, None)
        other.lugs = tuple(softened(*both) for both in zip(lugs, softness, strict=True))
        if set(softness) == {1.0}:
            tilts = [lug.tilt for lug in lugs]
            other.__dict__["flexibility"] = self.flexibility
            other.__dict__["contact"] = self.contact.changed(other.gap, tilts)
            return other
        soft = np.repeat(softness, self._rings_of_each)
        other.of_lugs = self.of_lugs * soft
        other.wavy = np.stack([self.wavy[0], self.wavy[1] * soft])
        return other

    @property
    def _rings_of_each(self) -> list[int]:
        """The number of rings of each lug."""
        return [len(ends) - 1 for ends in self.ends.values()]

    @cached_property
    def contact(self) -> ContactProblem:
        """The contact problem, ready for any loads."""
        return self.problem(self.bands, self.flexibility, self.tail, self.cells.sectors)

    def problem(
        self,
        bands: Bands,
        flexibility: Floats,
        tail: Floats,
        sectors: int,
        groups: Floats | None = None,
    ) -> ContactProblem:
        """The contact problem on the cells of some rings, with the cuts of the pin.

        bands: the rings (C,).
        flexibility, tail, sectors: as in ContactProblem.
        groups: (R, C), 1 where a ring of the model belongs to one of these rings; by default they
        are the same rings.
        """
        tilt = [lug.tilt for lug in self.lugs]
        if self.cuts is None:
            return ContactProblem(bands, flexibility, tail, tilt, sectors)
        groups = np.eye(len(self.rings)) if groups is None else groups
        added, removed = self.cuts.added(bands, sectors, groups), self.cuts.removed(bands, sectors)
        return ContactProblem(bands, flexibility, tail, tilt, sectors, added, removed)

    @cached_property
    def bands(self) -> Bands:
        """The rings of all bands."""
        bands = [self.pin.band(name) for name in self.rings]
        z, length = (np.array(x) for x in zip(*((b.middle, b.length) for b in bands), strict=True))
        radius = np.array([b.radius for b in bands])
        number = np.repeat(np.arange(len(self.lugs)), self._rings_of_each)
        links = link_numbers(self.whole.connections, self.given.connections)
        return Bands(z, length, radius, number, self.gap, links)

    @property
    def gap(self) -> Floats:
        """The radial gap by clearance and edge rounding, for each ring, (R,) m."""
        return np.concatenate([lug.gap(self.ends[lug.connection]) for lug in self.lugs])

    @property
    def tail(self) -> Floats:
        """The product n u_n / p_n of pin and lug together for high harmonics, (R,) m/Pa."""
        by_lug = []
        for _, lug, ends in self.by_lug():
            r = self.whole.band(lug.connection).radius
            both = half_plane(self.material, r) + half_plane(lug.bearing, r)
            by_lug.append(np.full(len(ends) - 1, both))
        return np.concatenate(by_lug)

    def solve(self, loads: PinLoads) -> JointContact:
        """Return the contact at all instants of a case.

        loads: of the links, on all bands or on some of them.

        Raises: SolveError where contact does not settle, or the loads are not in balance.
        """
        states = self.pressed(loads)
        waves = self.waves(states)
        patterns = self.patterns([(waves, MODE_TOLERANCE)])
        return self.joined(states, patterns.loads(waves, loads, self.arcs(states)))

    def waves(self, states: Sequence[ContactState]) -> Floats:
        """The harmonics of the pressures at some instants, (N + 1, T, R, 2) Pa, cos and sin."""
        return np.stack([amplitudes(x.pressure, self.cells.highest, x.angle) for x in states], 1)

    def patterns(
        self, parts: Sequence[tuple[Floats, float]], known: PressureModes | None = None
    ) -> PressureModes:
        """The patterns that reproduce harmonics of pressures (pressure_loads.pressure_modes).

        parts: harmonics (N + 1, T, R, 2) Pa, each with the fraction that is negligible.
        known: existing patterns, which come first.
        """
        return pressure_modes(self.pin, self.rings, parts, known)

    @cached_property
    def on_shaft(self) -> Rings:
        """The positions of the rings on the pin."""
        bands, edge, exponent = self.bands, [], []
        for _, lug, ends in self.by_lug():
            middle, length = 0.5 * (ends[1:] + ends[:-1]), ends[-1]
            edge.append(np.minimum(middle, length - middle) < lug.edge_radius)
            exponent.append(np.full(len(middle), lug_edge_exponent(self.material, lug.bearing)))
        half = 0.5 * bands.length
        return Rings(
            bands.z - half, bands.z + half, bands.radius, bands.band,
            np.concatenate(edge), np.concatenate(exponent),
        )  # fmt: skip

    def arcs(self, states: Sequence[ContactState]) -> PressedArcs:
        """The arcs under pressure at some instants."""
        cells, angles = [x.pressure > 0.0 for x in states], [x.angle for x in states]
        return PressedArcs.of(self.on_shaft, cells, angles)

    def joined(self, states: Sequence[ContactState], loads: PressureLoads) -> JointContact:
        """The contact at the instants of some loads, together with the loads."""
        contact, mass = self.contact, mass_per_length(self.pin, self.material.density)
        cut, angles = contact.bands, contact.angles
        return JointContact(self.pin, self.lugs, cut, loads, mass, angles, tuple(states))

    def pressed(
        self, loads: PinLoads, problem: ContactProblem | None = None, start: Mask | None = None
    ) -> list[ContactState]:
        """The contact at each instant of the loads.

        The cells turn with the largest force of a link, so that loads that differ by a rotation
        share one solution; on a pin with cuts the cells do not turn. Each solution starts from that
        under the most similar loads. Without any initial gap, proportional loads also share one
        solution.
        problem: contact problem on other cells than this model's.
        start: guess of the cells in contact at the first instant.

        Raises: SolveError as `solve`.
        """
        contact, cuts = self.freed(loads, problem), self.cuts
        acting = self.acting(loads, contact.bands)
        angles = acting.directions if cuts is None else [cuts.angle] * len(acting.forces)
        return contact_at_instants(contact, acting, angles, self.pin.length, start)

    def freed(self, loads: PinLoads, problem: ContactProblem | None = None) -> ContactProblem:
        """The contact problem in which the lugs of links that state moments are free to tilt.

        problem: contact problem on other cells than this model's.
        """
        return (problem or self.contact).freed(tilting_bands(self.whole, loads))

    @property
    def on_structure(self) -> bool:
        """Whether some of the lugs belong to a structure."""
        return len(self.lugs) > len(self.given.connections)

    def acting(self, loads: PinLoads, bands: Bands | None = None) -> JointLoads:
        """The loads on the pin: forces and moments of the links, those of the structure last, and
        couples of the body force.

        bands: rings of the contact problem, about whose middle the couples act; by default this
        model's.

        Raises: SolveError where the forces or moments are out of balance and no lug reacts the
        remainder.
        """
        mass = (self.material.density or 0.0) * self.whole.volume
        centre, pins = centre_of_volume(self.whole), (self.given, self.whole)
        forces = link_forces(self.given, mass, loads, self.on_structure)
        moments = link_moments(pins, self.lugs, loads, forces, (mass, centre))
        arm, (x, y) = centre - (bands or self.bands).middle, (loads.body[:, :2] * mass).T
        return JointLoads(forces, np.stack([-arm * y, arm * x], axis=1), moments)


def elastic(material: Material) -> tuple[float, float]:
    """The properties of a material on which flexibilities depend: E, Pa, and Poisson's ratio."""
    return material.youngs_modulus, material.poisson_ratio

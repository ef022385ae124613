"""The contact of a pin with a lug in its plane, with the flexibility of the lug's outline.

The flexibility of the pin is that of a round section, exact for each harmonic. That of the lug
comes from its finite elements. Higher harmonics have the flexibility of a half-plane, for both.
Contact is frictionless, as in fea.support.contact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fea.core.material import Material
from fea.lug.plane_fields import HARMONICS, PlaneFields
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from fea.support.contact.flexibility import half_plane
from fea.support.contact.pressure_loads import waves_of_sectors
from fea.support.foundation.plane_contact import pin_harmonics
from pinbase.arrays import Floats


def in_plane_stress(material: Material) -> Material:
    """The material that behaves in plane strain as the given one does in plane stress."""
    E, nu = material.youngs_modulus, material.poisson_ratio
    return Material(
        material.name, E * (1.0 + 2.0 * nu) / (1.0 + nu) ** 2, nu / (1.0 + nu), material.density
    )


@dataclass(frozen=True)
class PlaneContact:
    """A pin's section in a lug.

    fields: of the lug.
    modulus: Young's modulus of the lug, Pa.
    bearing: the material on which the pin bears.
    pin: the material of the pin.
    inner, radius: of the pin's bore, 0 if solid, and of its surface, m.
    clearance: of the diameters, m; of a bushing's bore when it is in the lug. The change of the
    shape of that bore by a misfit is not included.
    sectors: their number.
    """

    fields: PlaneFields
    modulus: float
    bearing: Material
    pin: Material
    inner: float
    radius: float
    clearance: float
    sectors: int

    @cached_property
    def problem(self) -> ContactProblem:
        """The contact problem of a band of 1 m length."""
        r = self.radius
        pin, bearing = in_plane_stress(self.pin), in_plane_stress(self.bearing)
        tail = np.array([half_plane(pin, r) + half_plane(bearing, r)])
        flexible = pin_harmonics(self.inner, r, pin)[: HARMONICS + 1, None, None]
        one = np.ones(1)
        gap = np.array([0.5 * self.clearance])
        bands = Bands(np.zeros(1), one, np.array([r]), np.zeros(1, dtype=np.int64), gap)
        of_lug = sector_flexibility(self.fields, r, self.modulus, self.sectors)
        return ContactProblem(bands, flexible, tail, (math.inf,), self.sectors, of_lug)

    @cached_property
    def waves(self) -> Floats:
        """The amounts (M, 2 H + 1) of the unit loads for a unit pressure on each sector."""
        return unit_waves(self.sectors, HARMONICS).T

    def pressures(self, forces: Floats) -> Floats:
        """The pressures (T, M), Pa, on the sectors.

        forces: (T, 2) N/m, of the pin on the lug, along the shank and across it.

        Raises: SolveError where contact does not converge.
        """
        out, start = [], None
        for force in forces:
            state = self.problem.solve(-force[None], start=start)
            start = state.active if state.pressure.any() else None
            out.append(state.pressure[0])
        return np.array(out).reshape(len(forces), self.sectors)


def unit_waves(sectors: int, highest: int) -> Floats:
    """The harmonics (2 highest + 1, M), cosines then sines, of unit pressures on M sectors."""
    both = waves_of_sectors(sectors, highest)  # (highest + 1, M, 2)
    return np.concatenate([both[:, :, 0], both[1:, :, 1]])


def sector_flexibility(fields: PlaneFields, radius: float, modulus: float, sectors: int) -> Floats:
    """The mean outward displacement of a lug's sectors under forces on them, (M, M) m/N.

    fields: of the lug.
    radius: of the wall on which the forces act, m.
    modulus: Young's modulus of the lug, Pa.
    """
    n = np.arange(HARMONICS + 1)
    turns = np.outer(2.0 * np.pi * np.arange(sectors) / sectors, n)
    mean = np.sinc(n / sectors)
    at = np.hstack([np.cos(turns) * mean, (np.sin(turns) * mean)[:, 1:]])
    unit = radius / modulus
    area = 2.0 * np.pi * radius / sectors
    both = unit / area * at @ fields.flexibility @ unit_waves(sectors, HARMONICS)
    return np.asarray(0.5 * (both + both.T))  # symmetric but for round-off

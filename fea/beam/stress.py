"""The stresses of a stepped beam at points of its surface, of its axis or bore, and of its notches.

As in all models they are given at points in the meridian plane, as amplitudes of the stress of unit
loads. With psi = n theta - p pi / 2, p the phase, the components rr, tt, zz, rz vary as cos psi and
tz, rt as sin psi. So a shear V along x that causes s_xz = tau on the axis is rz = tau and tz = -tau
there. A torque (n = 0, p = 1, where sin psi = -1) is tz = -T r / J.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.beam.round_section import Circle, Radius
from fea.beam.stress_concentration import Notch, notches
from fea.beam.timoshenko import AXIAL, MOMENT, SHEAR, TORQUE, InternalForces, stepped_beam
from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from fea.core.strain_energy import StrainEnergy
from geometry import Pin
from pinbase.arrays import Floats

ZZ, TZ, RZ = 2, 3, 4


@dataclass(frozen=True)
class BeamStress:
    """The stress amplitudes of K unit loads at points of a beam.

    The last points are those of the `notches`, in order; they have the stress times the factors of
    the notch, or the nominal stress if there is no factor.

    notches: those whose thinner shaft lies outside the clamps.
    points: (S, 2) r, z in m.
    stress: (S, 6, K) Pa per unit of load, order rr, tt, zz, tz, rz, rt.
    """

    pin: Pin
    material: Material
    forces: InternalForces
    notches: tuple[Notch, ...]
    points: Floats
    stress: Floats

    @property
    def energy(self) -> StrainEnergy:
        """The strain energy of the beam under these loads, without the effect of notches."""
        return StrainEnergy.of_both_phases(self.forces.loads, self.forces.work(self.material))


def beam_stress(
    pin: Pin, material: Material, loads: tuple[UnitLoad, ...], clamps: tuple[str, ...] = ()
) -> BeamStress:
    """The stresses of unit loads on a pin that is clamped, or balanced (fea.beam.timoshenko).

    clamps: names of its clamped surfaces.

    Raises: as `stepped_beam`.
    """
    forces = stepped_beam(pin, material, loads, clamps)
    cells, z = forces.samples
    inside = forces.inside(cells, z)
    sections = [forces.sections[c] for c in cells]
    nu = material.poisson_ratio
    points, stress = [], []
    # Surface, then axis or bore, at all sampled sections; notches follow, one point each.
    for radius in ("outer", "inner"):
        r = np.array([getattr(s, radius) for s in sections])
        points.append(np.stack([r, z], axis=1))
        per_force = [section_stress(s, a, nu) for s, a in zip(sections, r, strict=True)]
        stress.append(np.einsum("siq,sqk->sik", per_force, inside))
    notch_cells = [(n, c) for n in notches(pin) if (c := _thin_cell(pin, forces, n)) is not None]
    for notch, c in notch_cells:
        section = forces.sections[c]
        nominal = notch_stress(notch, section, nu)
        here = forces.inside(np.array([c]), np.array([notch.z]))
        points.append(np.array([[section.outer, notch.z]]))
        stress.append(np.einsum("iq,sqk->sik", nominal, here))
    return BeamStress(
        pin,
        material,
        forces,
        tuple(n for n, _ in notch_cells),
        np.concatenate(points),
        np.concatenate(stress),
    )


def section_stress(section: Circle, r: Radius, nu: float) -> Floats:
    """The stress amplitudes (..., 6, 4), Pa, at r (...), m, per unit of V, M, N, T."""
    out = np.zeros((*np.shape(r), 6, 4))
    out[..., RZ, SHEAR], out[..., TZ, SHEAR] = section.flexure(r, nu)
    out[..., ZZ, MOMENT] = -r / section.inertia
    out[..., ZZ, AXIAL] = 1.0 / section.area
    out[..., TZ, TORQUE] = -r / section.polar
    return out


def notch_stress(notch: Notch, section: Circle, nu: float) -> Floats:
    """The stress amplitudes (6, 4), Pa, at the surface of the thinner shaft, times the notch's
    factors.
    """
    out = section_stress(section, section.outer, nu)
    out[ZZ, MOMENT] *= notch.bending or 1.0
    out[ZZ, AXIAL] *= notch.tension or 1.0
    out[TZ, TORQUE] *= notch.torsion or 1.0
    return out


def _thin_cell(pin: Pin, forces: InternalForces, notch: Notch) -> int | None:
    """The cell of the thinner shaft that contains a notch or ends there; None within a clamp."""
    middle = 0.5 * (pin.stations[notch.on] + pin.stations[notch.on + 1])
    inwards = notch.z + 1e-9 * (middle - notch.z)
    c = int(np.searchsorted(forces.stations, inwards)) - 1
    return c if c in forces.free else None

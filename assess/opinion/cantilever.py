"""A cantilever pin's axial stress from the harmonic model, compared with beam theory.

Along the surface line in tension, with the load on the band's surface, and with the same load on a
thin bore along the axis, which imitates the line load of the theory.

The theory is a stepped beam clamped at z = 0, which is statically determinate: no material enters.
The stress at the surface is M r / I. Source: any text on the mechanics of materials.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from assess.opinion.michell import axis_load_term, constant_stress, surface_load_term
from assess.opinion.records import BeamCheck
from fea.beam.timoshenko import MOMENT, SHEAR, stepped_beam
from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.harmonic.model import HarmonicModel
from geometry import Pin
from geometry.mesh.section_mesh import SectionSize, Spot, meridian_mesh
from pinbase.arrays import Floats

ELEMENTS_ACROSS_WALL = 20.0  # elements over the thinnest wall, which the bore leaves
EDGE_ELEMENT_SIZE = 0.01  # element at the root's edge and the load's, of the radius
_UNIT_MATERIAL = Material("any", 1.0, 0.0)


@dataclass(frozen=True)
class BeamForces:
    """Along z (m): shear (N), moment (N m) and axial stress (Pa) on the side that is in tension."""

    z: Floats
    shear: Floats
    moment: Floats
    stress: Floats


def cantilever(pin: Pin, forces: dict[str, float], z: Floats) -> BeamForces:
    """The beam at z (Z,) in m; transverse forces (N) in one plane by band, each uniform over it."""
    units = tuple(UnitLoad(name, "force", 1) for name in forces)
    beam = stepped_beam(pin, _UNIT_MATERIAL, units, ("start",))
    inside = beam.at(z) @ np.array(list(forces.values()))
    section = [beam.sections[c] for c in np.searchsorted(beam.stations[1:-1], z, side="right")]
    per_moment = np.array([s.outer / s.inertia for s in section])
    moment = inside[:, MOMENT]
    return BeamForces(z, inside[:, SHEAR], moment, moment * per_moment)


def beam_check(
    pin: Pin, material: Material, loads: PinLoads, bore: float, points: int = 101
) -> BeamCheck:
    """Compare a pin clamped at its start under transverse forces on one band, at the instant of the
    largest.

    bore: diameter (m) of the thin bore on which the load also acts.

    Raises: MeshError, SolveError.
    """
    (name,) = loads.surfaces
    band, nu = pin.band(name), material.poisson_ratio
    force = float(np.linalg.norm(loads.forces[:, 0, :2], axis=1).max())
    beam = cantilever(pin, {name: force}, np.linspace(0.0, band.z1, points))
    w = force / band.length
    bored = pin.with_bore(name, bore)
    return BeamCheck(
        pin=pin.name,
        case=loads.case,
        connection=name,
        force=force,
        diameter=2.0 * band.radius,
        axis_bore=bore,
        band=(band.z0, band.z1),
        z=beam.z,
        shear=beam.shear,
        moment=beam.moment,
        beam_axial_stress=beam.stress,
        fea_axial_stress=force * tension(pin, material, name, band.radius, beam.z),
        fea_axial_stress_axis_load=(
            force * tension(bored, material, f"bore {name}", band.radius, beam.z)
        ),
        expected_offset=-constant_stress(surface_load_term(nu), w, band.radius),
        expected_offset_axis_load=-constant_stress(axis_load_term(nu), w, band.radius),
    )


def tension(pin: Pin, material: Material, loaded: str, radius: float, z: Floats) -> Floats:
    """Axial stress (Z,) in Pa at z (m) on the side in tension of a shaft of `radius` (m) clamped at
    its start, for one newton across on the surface `loaded`.

    Raises: MeshError, SolveError.
    """
    rims = ((radius, 0.0), (radius, float(z.max())))
    spots = [Spot(r, at, EDGE_ELEMENT_SIZE * radius, 0.2 * radius) for r, at in rims]
    mesh = meridian_mesh(pin, SectionSize(ELEMENTS_ACROSS_WALL, 8.0, 0.2), spots)
    load = UnitLoad(loaded, "force", 1)
    fields = HarmonicModel(pin, mesh, material, ("start",)).solve((load,))
    skin = fields.points[: fields.skin]
    on = np.flatnonzero(np.isclose(skin[:, 0], radius, rtol=1e-9) & (skin[:, 1] <= z.max()))
    on = on[np.argsort(skin[on, 1], kind="stable")]
    return np.asarray(-np.interp(z, skin[on, 1], fields.stress[on, 2, 0]))

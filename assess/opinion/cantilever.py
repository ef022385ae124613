"""The axial stress of a cantilever pin from the harmonic model, compared with beam theory.

The stress is compared along the surface line in tension: with the load on the band's surface, and
with the same load on a thin bore along the axis, which imitates the line load of the theory.

The theory is a stepped beam clamped at z = 0. It is statically determinate, so the material has no
effect.
The stress at the surface is M r / I. Source: any text on the mechanics of materials.

Michell's constant term in the axial stress of a round bar under a uniform transverse load:
beam theory is not exact while a load acts along the bar. For a solid circle of radius a under w
per length along +x, moment M and shear V = -dM/dz, the stress away from the ends is, exactly,

    s_zz = -M x / I + w f(x, y),   shears s_xz, s_yz = V times Saint-Venant's flexure shears t,

and s_xx, s_yy, s_xy are the same in every section. Five conditions leave one f, odd in x:
in the plane, equilibrium under the body force -w t and the load on the boundary; compatibility of
the plane strains, to which f adds by Poisson's ratio; from d^2 M / dz^2 = w and the flexure shears,
the second derivatives by x and y of the constant part of e_zz; int f dA = 0; int x f dA = 0,
because equilibrium makes M the moment of s_zz.

Load (a), a traction w / (2 pi a) of constant direction all round (n: Poisson's ratio):

    f = (2 + n) / (6 (1 + n)) x (3 r^2 - 2 a^2) / (pi a^4)

Load (b), w on the axis. It differs from (a) by a load without resultant, hence by plane strain:
Kelvin's line force, and a linear part that frees the surface of traction and the section of moment:

    f_b - f = n / (2 (1 - n)) x (2 r^2 - a^2) / (pi a^2 r^2)

On the surface f = k (x / a) / (pi a), with the k below: where a cantilever is in tension (-x), the
stress is k w / (pi a) below the beam's, and so is the compression opposite. On a bore of radius b
instead of the axis, k is larger: for n = 0.3 by 1.7 % at b = a / 20 and 6.8 % at a / 10.

Sources: J. H. Michell, Quart. J. Math. 32 (1901) 28; A. E. H. Love, A Treatise on the Mathematical
Theory of Elasticity, ch. XVI, for the method; f for these two loads is worked out here and checked
in tests/assess/opinion/test_distributed_load.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

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
    """The results of a beam along z, m: shear, N, moment, N m, and axial stress on the tension
    side, Pa.
    """

    z: Floats
    shear: Floats
    moment: Floats
    stress: Floats


def cantilever(pin: Pin, forces: dict[str, float], z: Floats) -> BeamForces:
    """Return the results of a beam clamped at its start.

    forces: transverse forces, N, in one plane, by band; each is uniform over its band. z: (Z,) m.
    """
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
    """Compare a pin, clamped at its start under transverse forces on one band, with beam theory.

    The comparison is made at the instant of the largest force.
    bore: diameter, m, of the thin bore on which the load also acts.

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
    """Return the axial stress (Z,), Pa, at z, m, on the tension side of a shaft clamped at its
    start.

    The load is a transverse force of 1 N on the surface `loaded`.
    radius: of the shaft, m.

    Raises: MeshError, SolveError.
    """
    rims = ((radius, 0.0), (radius, float(z.max())))
    spots = [Spot(r, at, EDGE_ELEMENT_SIZE * radius, 0.2 * radius) for r, at in rims]
    mesh = meridian_mesh(pin, SectionSize(ELEMENTS_ACROSS_WALL, 8.0, 0.2), spots)
    load = UnitLoad(loaded, "force", 1)
    fields = HarmonicModel(pin, mesh, material, ("start",)).solve((load,))
    skin = fields.points[: fields.skin]
    on = np.flatnonzero(np.isclose(skin[:, 0], radius, rtol=1e-9))
    on = on[np.argsort(skin[on, 1], kind="stable")]
    return np.asarray(-np.interp(z, skin[on, 1], fields.stress[on, 2, 0]))


def surface_load_term(nu: float) -> float:
    """Return Michell's k (dimensionless) at Poisson's ratio `nu` for load (a): a uniform traction
    on the surface.

    Source: as the module.
    """
    return (2.0 + nu) / (6.0 * (1.0 + nu))


def axis_load_term(nu: float) -> float:
    """Return Michell's k (dimensionless) at Poisson's ratio `nu` for load (b): a line load on the
    axis.

    Source: as the module.
    """
    return (1.0 + nu + nu**2) / (3.0 * (1.0 - nu**2))


def constant_stress(k: float, load: float, radius: float) -> float:
    """Return the amount, Pa, by which the axial stress in tension is below the beam's.

    k: Michell's term.
    load: N/m.
    radius: m.

    Source: as the module.
    """
    return k * load / (math.pi * radius)

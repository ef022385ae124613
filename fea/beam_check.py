"""A cantilever pin's axial stress from the solid, beside beam theory.

Along the surface line in tension, with the load on the band's surface, and with the same load on a
thin bore along the axis, which imitates the line load of the theory.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.beam import BeamForces, cantilever
from fea.distributed_load import axis_load_term, constant_stress, surface_load_term
from fea.material import Material
from fea.pin_loads import UnitLoad
from fea.solid import SolidModel, UnitFields
from geometry import Pin
from geometry.solid_mesh import MeshSize, solid_mesh

Floats = NDArray[np.float64]

WINDOW = (0.3, 0.8)  # of the loaded length: away from the root and from the load's end


@dataclass(frozen=True)
class Difference:
    """Of the solid's stress from the beam's, as parts of the beam's peak: rms and largest within
    the window, largest anywhere and its z (m).
    """

    rms: float
    largest: float
    largest_anywhere: float
    largest_at: float


@dataclass(frozen=True)
class BeamCheck:
    """Axial stresses (Pa) along z (m), from the root to the end of the load; force (N).

    surface_term, axis_term: by how much (Pa) exact elasticity lies below beam theory while the load
    acts, away from the ends, for the load on the surface and on the axis (fea.distributed_load).
    """

    force: float
    beam: BeamForces
    surface_load: Floats
    axis_load: Floats
    surface_term: float
    axis_term: float

    def difference(self, stress: Floats) -> Difference:
        """How far `stress` is from the beam's."""
        z, beam = self.beam.z, self.beam.stress
        error = (stress - beam) / beam.max()
        loaded = z[-1]
        inside = (z >= WINDOW[0] * loaded) & (z <= WINDOW[1] * loaded)
        worst = int(np.abs(error).argmax())
        return Difference(
            rms=float(np.sqrt(np.mean(error[inside] ** 2))),
            largest=float(np.abs(error[inside]).max()),
            largest_anywhere=float(abs(error[worst])),
            largest_at=float(z[worst]),
        )


def beam_check(
    pin: Pin,
    material: Material,
    band: str,
    force: tuple[float, float],
    fields: UnitFields,
    bore: float,
    points: int = 101,
) -> BeamCheck:
    """Compare a pin clamped at its start under a transverse force (N) on one band.

    fields: the pin's unit fields, which include the band's x and y. bore: diameter (m) of the thin
    bore on which the load also acts.
    """
    size = float(np.hypot(*force))
    away = float(np.arctan2(-force[1], -force[0]))  # the side in tension
    beam = cantilever(pin, {band: size}, np.linspace(0.0, pin.band(band).z1, points))
    bored = pin.with_bore(band, bore)
    mesh = solid_mesh(bored, MeshSize(across=6.0), (0.0, pin.band(band).z1))
    name = f"bore {band}"
    both = tuple((UnitLoad(name, "force", 1), phase) for phase in (0, 1))
    on_axis = SolidModel(bored, mesh, material, ("start",)).solve(both)
    c = [force[p] if load == UnitLoad(band, "force", 1) else 0.0 for load, p in fields.loads]
    w, nu = size / pin.band(band).length, material.poisson_ratio
    return BeamCheck(
        force=size,
        surface_term=constant_stress(surface_load_term(nu), w, pin.band(band).radius),
        axis_term=constant_stress(axis_load_term(nu), w, pin.band(band).radius),
        beam=beam,
        surface_load=axial_stress(fields, np.array(c), pin.band(band).radius, away, beam.z),
        axis_load=axial_stress(on_axis, np.array(force), pin.band(band).radius, away, beam.z),
    )


def axial_stress(fields: UnitFields, c: Floats, radius: float, angle: float, z: Floats) -> Floats:
    """Axial stress (Z,) in Pa at z (m) on the surface line at `angle` (rad) of a cylinder of
    `radius` (m), under unit loads c (L,): linear between the nodes of the unrolled surface.
    """
    from scipy.interpolate import LinearNDInterpolator

    nodes = fields.surface.nodes
    x = fields.space.nodes[nodes]
    r = np.hypot(x[:, 0], x[:, 1])
    turn = np.angle(np.exp(1j * (np.arctan2(x[:, 1], x[:, 0]) - angle)))
    near = (np.abs(r - radius) < 1e-6 * radius) & (np.abs(turn) < 0.8)
    stress = fields.stress[nodes[near], 2] @ c
    line = LinearNDInterpolator(np.stack([radius * turn[near], x[near, 2]], axis=1), stress)
    rims = x[near, 2].min(), x[near, 2].max()
    inside = np.clip(z, rims[0] + 1e-6 * radius, rims[1] - 1e-6 * radius)  # within the hull
    return np.asarray(line(np.zeros_like(z), inside))

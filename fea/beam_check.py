"""A cantilever pin's axial stress from the harmonic model, beside beam theory.

Along the surface line in tension, with the load on the band's surface, and with the same load on a
thin bore along the axis, which imitates the line load of the theory.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.beam import BeamForces, cantilever
from fea.distributed_load import axis_load_term, constant_stress, surface_load_term
from fea.harmonic import HarmonicModel
from fea.material import Material
from fea.pin_loads import UnitLoad
from geometry import Pin
from geometry.meridian_mesh import SectionSize, Spot, meridian_mesh

Floats = NDArray[np.float64]

ACROSS = 20.0  # elements over the thinnest wall, which the bore leaves
CLOSE = 0.01  # element at the root's edge and the load's, of the radius
WINDOW = (0.3, 0.8)  # of the loaded length: away from the root and from the load's end


@dataclass(frozen=True)
class Difference:
    """Of elasticity's stress from the beam's, as parts of the beam's peak: rms and largest within
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
    bore: float,
    points: int = 101,
) -> BeamCheck:
    """Compare a pin clamped at its start under a transverse force (N) on one band.

    bore: diameter (m) of the thin bore on which the load also acts.

    Raises: MeshError, SolveError.
    """
    size = float(np.hypot(*force))
    beam = cantilever(pin, {band: size}, np.linspace(0.0, pin.band(band).z1, points))
    radius = pin.band(band).radius
    w, nu = size / pin.band(band).length, material.poisson_ratio
    bored = pin.with_bore(band, bore)
    return BeamCheck(
        force=size,
        surface_term=constant_stress(surface_load_term(nu), w, radius),
        axis_term=constant_stress(axis_load_term(nu), w, radius),
        beam=beam,
        surface_load=size * tension(pin, material, band, radius, beam.z),
        axis_load=size * tension(bored, material, f"bore {band}", radius, beam.z),
    )


def tension(pin: Pin, material: Material, loaded: str, radius: float, z: Floats) -> Floats:
    """Axial stress (Z,) in Pa at z (m) on the side in tension of a shaft of `radius` (m) held at
    its start, for one newton across on the surface `loaded`.

    Raises: MeshError, SolveError.
    """
    rims = ((radius, 0.0), (radius, float(z.max())))
    spots = [Spot(r, at, CLOSE * radius, 0.2 * radius) for r, at in rims]
    mesh = meridian_mesh(pin, SectionSize(ACROSS, 8.0, 0.2), spots)
    load = UnitLoad(loaded, "force", 1)
    fields = HarmonicModel(pin, mesh, material, ("start",)).solve((load,))
    skin = fields.points[: fields.skin]
    on = np.flatnonzero(np.isclose(skin[:, 0], radius, rtol=1e-9) & (skin[:, 1] <= z.max()))
    on = on[np.argsort(skin[on, 1], kind="stable")]
    return np.asarray(-np.interp(z, skin[on, 1], fields.stress[on, 2, 0]))

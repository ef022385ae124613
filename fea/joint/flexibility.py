"""How far rings move, on the average round them, under uniform pressures on rings, by harmonic.

A pressure p cos n theta on a ring moves the mean of u_r over each ring by C_n p cos n theta. By the
theorem of Betti C_n times the rings' lengths is symmetric; it is made exactly so. Rigid motions are
left open: the pin's by a support that is statically determinate, which balanced pressures do not
feel; the lug's by a reaction on its outer surface, of constant direction and linear along z, and
by measuring from the mean motion of that surface in the same weight, so that it is guided.

Beyond the last harmonic each ring has the half-plane's answer, u_n = 2 (1 - nu^2) R p_n / (E n).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.core.tractions import ALONG_X, Traction
from fea.harmonic.assembly import around
from fea.harmonic.model import HarmonicModel, rigid_motions
from geometry import Pin
from geometry.mesh.section_mesh import SectionSize, meridian_mesh

NONE = np.zeros(3)
OUTWARDS = np.array([1.0, 0.0, 0.0])


def pin_flexibility(
    pin: Pin, rings: Sequence[str], material: Material, across: float, highest: int
) -> Floats:
    """C_n (highest + 1, R, R), m/Pa, inwards under pressure, of rings of a pin.

    across: elements over the diameter. Raises: MeshError, SolveError.
    """
    model = HarmonicModel(pin, meridian_mesh(pin, SectionSize(across)), material, (), pivot=0.5)
    return _flexibility(model, rings, -OUTWARDS, highest, guided=False)


def lug_flexibility(lug: Pin, material: Material, across: float, highest: int) -> Floats:
    """The same of the rings of a lug's bore, outwards under pressure."""
    model = HarmonicModel(lug, meridian_mesh(lug, SectionSize(across)), material, (), pivot=0.5)
    rings = [f"bore {name}" for name in lug.connections]
    return _flexibility(model, rings, OUTWARDS, highest, guided=True)


def half_plane(material: Material, radius: float) -> float:
    """n u_n / p_n of one body for high harmonics n, m/Pa."""
    E, nu = material.youngs_modulus, material.poisson_ratio
    return 2.0 * (1.0 - nu * nu) * radius / E


def _flexibility(
    model: HarmonicModel, rings: Sequence[str], pushed: Floats, highest: int, guided: bool
) -> Floats:
    bands = [model.pin.band(name) for name in rings]
    area = np.array([b.radius * b.length for b in bands])
    parts = [(Traction(name, 0.0, pushed, NONE),) for name in rings]
    out = []
    for n in range(highest + 1):
        forces = model.forces(n, parts)
        if guided and n == 1:
            forces = _reacted(model, forces)
        work = forces.T @ model.displace(n, forces) / around(n)
        out.append(0.5 * (work + work.T) / area[:, None])
    return np.stack(out)


def _reacted(model: HarmonicModel, forces: Floats) -> Floats:
    """With the reaction on the lug's outer surface, of constant direction."""
    pin = model.pin
    middle = 0.5 * pin.length
    bands = [pin.band(name) for name in pin.connections]
    reactions = [
        tuple(Traction(b.name, middle, ALONG_X, NONE) for b in bands),
        tuple(Traction(b.name, middle, NONE, ALONG_X) for b in bands),
    ]
    against = model.forces(1, reactions)
    modes = rigid_motions(model.space.nodes, 1)
    return np.asarray(forces - against @ np.linalg.solve(modes.T @ against, modes.T @ forces))

"""Our side of the comparison with CalculiX: the pin, its load, and our solution, timed."""

from __future__ import annotations

import pickle
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from skfem import MeshTet2

from fea.core.linear_solver import factorize
from fea.core.material import Material
from fea.core.pin_loads import Unit, UnitLoad
from fea.solid.assembly import Discretisation
from fea.solid.boundary import SurfaceMesh, clamped_nodes, surface
from fea.solid.nodal_loads import nodal_loads
from fea.solid.stress_recovery import nodal_stress, with_known_traction
from geometry import Pin, Segment

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

INCH = 0.0254
BAND, CLAMP, FILLET = "B", "start", "fillet 1"
PIN = Pin(
    "P",
    (
        Segment(2.0 * INCH, 3.0 * INCH),
        Segment(2.0 * INCH, 2.0 * INCH),
        Segment(1.0 * INCH, 2.0 * INCH, connection=BAND),
    ),
    fillet=0.125 * INCH,
)
STEEL = Material("steel", 2.0e11, 0.3)
FORCE = 1.0e4  # N, along y
ALONG_Y: tuple[Unit, ...] = ((UnitLoad(BAND, "force", 1), 1),)


class Loaded:
    """The pin clamped at its start face and loaded on its band.

    held: nodes that do not move.
    traction: (F, 6, 3, 1) on all facets of the boundary, Pa.
    forces: (N, 3), N.
    """

    def __init__(self, mesh: MeshTet2) -> None:
        self.space = Discretisation(mesh)
        self.boundary: SurfaceMesh = surface(self.space)
        self.held: Ints = clamped_nodes(self.space, (CLAMP,))
        loads = nodal_loads(PIN, STEEL, self.space, self.boundary, ALONG_Y)
        self.traction: Floats = FORCE * loads.traction
        self.forces: Floats = FORCE * loads.forces[..., 0]


@dataclass(frozen=True)
class Ours:
    """Our solution.

    displacement: (N, 3), m.
    stress, averaged: (N, 6), Pa, with the known tractions, and averaged only.
    to_displacement, to_stress: wall time from the bare mesh, s.
    """

    displacement: Floats
    stress: Floats
    averaged: Floats
    to_displacement: float
    to_stress: float


def solve(mesh: MeshTet2) -> Ours:
    """Return the solution by the steps of SolidModel.solve, timed.

    Raises: SolveError if the solution is not accurate.
    """
    start = time.perf_counter()
    pin = Loaded(mesh)
    fixed = (3 * pin.held[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(pin.space.unknowns), fixed)
    K = pin.space.stiffness(STEEL)
    u = np.zeros(pin.space.unknowns)
    u[free] = factorize(K[free][:, free], free // 3)(pin.forces.ravel()[free])
    solved = time.perf_counter()
    displacement = u.reshape(-1, 3, 1)
    averaged = nodal_stress(pin.space, STEEL, displacement)
    clamped = np.isin(pin.boundary.facets, mesh.boundaries[CLAMP])
    stress = with_known_traction(averaged, pin.boundary, pin.traction, clamped)
    done = time.perf_counter()
    return Ours(
        displacement[..., 0], stress[..., 0], averaged[..., 0], solved - start, done - start
    )


def main(mesh: Path, result: Path) -> None:
    """Solve on a pickled mesh and pickle the result."""
    result.write_bytes(pickle.dumps(solve(pickle.loads(mesh.read_bytes()))))

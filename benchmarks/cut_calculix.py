"""A pin with cuts as a whole in CalculiX: C3D10 on our own meshes of the solid model."""

from __future__ import annotations

import resource
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.random_pins import STEEL
from fea.checks import calculix
from fea.checks.calculix_deck import write_deck
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from fea.solid.evaluate import solid_solution
from geometry import CutPin
from geometry.mesh.solid_mesh import MeshSize


@dataclass(frozen=True)
class Other:
    """Unknowns, the largest von Mises stress outside of singularities, Pa, and processor time of
    the other program, s.
    """

    unknowns: int
    maximum: float
    seconds: float


def in_calculix(pin: CutPin, clamps: tuple[str, ...], loads: PinLoads, finer: float) -> Other:
    """On a mesh so many times finer than the first one of the solid model.

    Raises: CalculixError.
    """
    size = MeshSize().finer(finer)
    solution = solid_solution(pin, STEEL, clamps, (loads,), (), size, 0.1)
    fields, space = solution.fields, solution.fields.space
    forces = fields.forces @ fields.coefficients(loads)[0]
    with tempfile.TemporaryDirectory(prefix="pinstress-ccx-") as name:
        folder = Path(name)
        deck = folder / f"{calculix.JOB}.inp"
        write_deck(deck, space.nodes, space.elements, STEEL, fields.fixed, forces)
        before = _children()
        found = calculix.solved(folder, calculix.run(folder))
        spent = _children() - before
    nodes = fields.surface.nodes
    stress = von_mises(found.stress[nodes])[solution.outside[: len(nodes)]]
    return Other(space.unknowns, float(stress.max()), spent)


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return float(np.sum([used.ru_utime, used.ru_stime]))

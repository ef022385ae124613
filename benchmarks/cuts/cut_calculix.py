"""A pin with cuts solved as a whole by CalculiX: C3D10 on our own meshes."""

from __future__ import annotations

import resource
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from assess.opinion import calculix
from assess.opinion.calculix_deck import write_deck
from benchmarks.random_pins import STEEL
from fea.core.model import MeshProblem
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from fea.cut.local_solution import CUT_LOW_STRESS_POWER, LOCAL_MESH_RATIO
from fea.solid.assembly import Discretisation
from fea.solid.boundary import surface
from fea.solid.evaluate import solid_solution
from fea.solid.model import SolidModel, acting
from fea.solid.nodal_loads import nodal_loads, with_closing_tractions
from geometry import CutPin
from geometry.mesh.cut_piece import Piece, Spots, piece_mesh
from geometry.mesh.solid_mesh import MeshSize
from pinbase.arrays import Floats, Ints


@dataclass(frozen=True)
class Other:
    """A result of the other program.

    unknowns: their number.
    maximum: the largest von Mises stress outside singularities, Pa.
    seconds: processor time, s. meshing: that of its mesh, s, if measured.
    """

    unknowns: int
    maximum: float
    seconds: float
    meshing: float = 0.0


def in_calculix(pin: CutPin, clamps: tuple[str, ...], loads: PinLoads, finer: float) -> Other:
    """Return CalculiX's result on a mesh `finer` times finer than the first mesh of the solid
    model.

    Raises: CalculixError.
    """
    size = MeshSize().finer(finer)
    solution = solid_solution(MeshProblem(pin, STEEL, clamps, (loads,)), size)
    fields, space = solution.fields, solution.fields.space
    forces = fields.forces @ fields.coefficients(loads)[0]
    nodes = fields.surface.nodes
    return _solved(space, fields.fixed, forces, nodes[solution.outside[: len(nodes)]])


def in_calculix_locally(
    pin: CutPin, loads: PinLoads, level: int, spots: Spots, steps: int = 1
) -> Other:
    """Return CalculiX's result for a pin without clamps, on a mesh graded like those of local
    solids.

    The mesh is fine at the edges of cuts, finer at the spots (x, y, z), m, and coarse elsewhere.
    steps: the number of steps with the same loads, to measure their time; the maximum of several is
    0.
    Raises: CalculixError.
    """
    piece = Piece(pin.profile, 0.0, pin.profile.length, 0.0, pin.cuts, (), (False, False))
    start = time.process_time()
    mesh = piece_mesh(
        piece, LOCAL_MESH_RATIO ** (level * CUT_LOW_STRESS_POWER), spots, LOCAL_MESH_RATIO**level
    )
    spent = time.process_time() - start
    model, units = SolidModel(pin, mesh, STEEL, ()), acting((loads,))
    boundary, c = surface(model.space), loads.coefficients()
    found = nodal_loads(pin, STEEL, model.space, boundary, units)
    pressing = np.array([not load.shears for load, _ in units])
    found = with_closing_tractions(pin, model.space, boundary, found, pressing)
    forces = found.forces @ np.array([c[load][0, phase] for load, phase in units])
    solved = _solved(model.space, model.fixed, forces, boundary.nodes, steps)
    return replace(solved, meshing=spent)


def _solved(
    space: Discretisation, fixed: Ints, forces: Floats, read: Ints, steps: int = 1
) -> Other:
    with tempfile.TemporaryDirectory(prefix="pinstress-ccx-") as name:
        folder = Path(name)
        deck = folder / f"{calculix.JOB_NAME}.inp"
        write_deck(deck, space.nodes, space.elements, STEEL, fixed, forces)
        if steps > 1:
            text = deck.read_text(encoding="ascii")
            again = text[text.index("*STEP") :].replace("*CLOAD", "*CLOAD, OP=NEW")
            deck.write_text(text + (steps - 1) * again, encoding="ascii")
        before = _children()
        printed = calculix.run(folder)
        spent = _children() - before
        if steps > 1:
            return Other(space.unknowns, 0.0, spent)
        found = calculix.solved(folder, printed)
    return Other(space.unknowns, float(von_mises(found.stress[read]).max()), spent)


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return float(np.sum([used.ru_utime, used.ru_stime]))

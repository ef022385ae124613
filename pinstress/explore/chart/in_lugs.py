"""The mesh sequences of a chart of a pin in its lugs: contact on several sets of cells and meshes,
the beam on foundations and, if requested, CalculiX.
"""

from __future__ import annotations

import math

from assess.opinion.calculix_in_lugs import HALF_MODEL_MESHES
from assess.opinion.calculix_joint_mesh import Fineness
from fea.core.linear_solver import SolveError
from fea.core.mesh_history import MeshHistory
from fea.core.peak import Maximum
from fea.support.contact.cell_error import unresolved
from fea.support.contact.resolution import MAX_CELLS, Resolution
from fea.support.records import JointResult
from geometry.shape.rings import ring_ends
from pinstress.explore.chart.mesh_sequences import Climb
from pinstress.explore.chart.single_joint import JointProblem, JointRung

CHART_RESOLUTIONS = (
    Resolution(4, 18, 6),
    Resolution(),
    Resolution(12, 48, 16),
    Resolution(16, 64, 20),
)
CONTACT_LEVELS = (-2, 0, 1, 2)
REFERENCE_LEVELS = (2, 3, 4)
CALCULIX_MESHES = (*HALF_MODEL_MESHES, Fineness(sectors=32, layers=3, eye=2))


def rings_of(problem: JointProblem, cells: Resolution) -> int:
    """Return the number of rings of contact cells in all bands."""
    bands = [(problem.pin.band(lug.connection), lug.edge_radius) for lug in problem.lugs]
    ends = [ring_ends(band, radius, cells.rings, cells.beside) for band, radius in bands]
    return sum(len(x) - 1 for x in ends)


def sets_of(problem: JointProblem) -> list[Resolution]:
    """Return the sets of contact cells that are not too many to solve, at least two; the last is
    for the reference.
    """
    few = [x for x in CHART_RESOLUTIONS if rings_of(problem, x) * x.sectors <= MAX_CELLS]
    return few if len(few) > 1 else list(CHART_RESOLUTIONS[:2])


def contact_rung(cells: Resolution, level: int) -> JointRung:
    """Return a rung of the contact model, named after its cells."""
    return JointRung("contact", f"{cells.rings} × {cells.sectors} cells a lug", level, cells)


def chosen_in_lugs(problem: JointProblem, peak: Maximum, joint: JointResult) -> JointRung:
    """Return the rung of the chart that is nearest to the one on which a run ends."""
    if joint.model == "foundation":
        return JointRung("foundation", "Timoshenko beam")
    rings = sum(len(band.line_load) for band in joint.bands)
    cells = min(CHART_RESOLUTIONS, key=lambda cells: abs(rings_of(problem, cells) - rings))
    return contact_rung(cells, len(peak.history) - 1)


def climb_in_lugs(climb: Climb, chosen: JointRung, calculix: bool) -> None:
    """Solve all models, the cheapest first."""
    assert isinstance(climb.problem, JointProblem)
    climb.to(JointRung("foundation", "Timoshenko beam"))
    for cells in sets_of(climb.problem)[:-1]:
        last = max(CONTACT_LEVELS[-1], chosen.level if cells == chosen.cells else 0)
        for level in (*CONTACT_LEVELS, *range(CONTACT_LEVELS[-1] + 1, last + 1)):
            climb.to(contact_rung(cells, level))
            climb.drop_repeated()
    for fineness in CALCULIX_MESHES if calculix else ():
        if climb.to(JointRung("calculix", "hexahedra (C3D20R)", fineness=fineness)).over:
            return


def contact_reference(climb: Climb) -> tuple[JointRung, MeshHistory, float]:
    """Solve contact on the finest cells and on finer meshes, as the reference.

    Return the last mesh, the mesh history, and the relative part of its error due to the cells.

    Raises: SolveError if the reference cannot be solved.
    """
    assert isinstance(climb.problem, JointProblem)
    coarser, cells = sets_of(climb.problem)[-2:]
    results = []
    for level in REFERENCE_LEVELS:
        measured = climb.to(contact_rung(cells, level), keep=False)
        if measured.result is None:
            raise SolveError(
                f"the reference, contact on mesh {level + 1}: {measured.failed}",
                code="no-reference",
            )
        results.append(measured.result)
    below = [m.result for r, m in climb.done if r == contact_rung(coarser, REFERENCE_LEVELS[0])]
    error = math.inf
    if below and below[0]:  # convergence with the cells is at least of first order
        step = abs(results[0].maximum / below[0].maximum - 1.0)
        error = step / (cells.rings / coarser.rings - 1.0)
        error = max(error, unresolved(cells.highest * climb.problem.half_angle))
    rung = contact_rung(cells, REFERENCE_LEVELS[-1])
    return rung, climb.seen("harmonic", tuple(results), REFERENCE_LEVELS[0]), error

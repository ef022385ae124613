"""A second opinion on a pin: CalculiX solves the same problem as our solid model, for comparison.

Both programs get the same nodes, elements, material, supports and nodal forces, so that only the
programs differ: assembly, solver and stress recovery, in which both extrapolate from the same four
points of an element and average at the nodes. Displacements and stresses must agree to the digits
that CalculiX prints; differences beyond the limits in `opinions` are not round-off.

This comparison does not show whether the mesh is fine enough. The largest stress is therefore also
compared with the answer of the chosen model, which comes from other meshes or another model.

A pin without clamps is supported as in our own model: six displacement components, well apart from
each other, are zero in both programs. The loads are in balance, so these supports carry no force
and only fix the rigid motion.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from assess.opinion import calculix
from assess.opinion.calculix_deck import write_deck
from assess.opinion.opinions import Opinion
from fea.core.material import Material
from fea.core.model import MeshProblem
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from fea.singular.singularities import singularities_of
from fea.solid.evaluate import solid_solution
from fea.solid.field import SolidSolution
from fea.solid.stress_recovery import nodal_stress
from geometry import PinLike
from geometry.mesh.solid_mesh import MeshSize
from pinbase.arrays import Floats, Ints


def second_opinions(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    peaks: tuple[Maximum, ...],
    distance: float,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[Opinion, ...]:
    """Return the opinions on a pin's load cases, each at the governing instant of its peak.

    They are computed on the first mesh of the solid model. Cases with the verdict "rigid" are left
    out.
    distance: as in fea.solve.solve.Asked.

    Raises: MeshError, SolveError from our own model; a failure of CalculiX is stored in the
    opinion.
    """
    instants = {p.case: p for p in peaks if p.verdict != "rigid"}
    live = tuple(case for case in cases if case.case in instants)
    if not live:
        return ()
    solution = first_solid_solution(pin, material, clamps, live, distance)
    out = []
    for case in live:
        progress(f"pin {pin.name}, {case.case}, CalculiX")
        peak = instants[case.case]
        answer = Opinion(pin.name, case.case, peak.max_von_mises, peak.own_error)
        assert peak.governing is not None
        c = solution.fields.coefficients(peak.governing)[0]
        try:
            out.append(_compared(answer, material, solution, c))
        except calculix.CalculixError as error:
            out.append(replace(answer, failure=str(error)))
    return tuple(out)


def first_solid_solution(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    distance: float,
) -> SolidSolution:
    """Return the solution of a pin's cases on the first mesh of the solid model; arguments as
    `second_opinions`.

    Raises: MeshError, SolveError.
    """
    constrained = tuple(pin.surface(name) for name in clamps)
    singularities = singularities_of(pin, material, constrained, cases, distance)
    problem = MeshProblem(pin, material, constrained, cases, singularities, distance=distance)
    return solid_solution(problem, MeshSize())


def _compared(
    answer: Opinion, material: Material, solution: SolidSolution, loads: Floats
) -> Opinion:
    """Compare both programs under one combination (L,) of the unit loads.

    Raises: CalculixError.
    """
    fields, space = solution.fields, solution.fields.space
    forces = fields.forces @ loads
    with tempfile.TemporaryDirectory(prefix="pinstress-ccx-") as name:
        folder = Path(name)
        deck = folder / f"{calculix.JOB_NAME}.inp"
        write_deck(deck, space.nodes, space.elements, material, fields.fixed, forces)
        results = calculix.solved(folder, calculix.run(folder))
    u = fields.displacement @ loads
    if results.displacement.shape != u.shape or len(results.stress) != len(u):
        raise calculix.CalculixError(
            f"{calculix.CALCULIX_COMMAND} did not write results for all {len(u)} nodes",
            "missing-nodes",
        )
    ours = von_mises(nodal_stress(space, material, u[..., None])[..., 0])
    theirs = von_mises(results.stress)
    outside = compared_nodes(solution)
    return replace(
        answer,
        unknowns=space.unknowns,
        displacement=_difference(u, results.displacement),
        stress=_difference(ours, theirs),
        ours=float(ours[outside].max()),
        theirs=float(theirs[outside].max()),
    )


def compared_nodes(solution: SolidSolution) -> Ints:
    """Return the numbers of the nodes at which maxima are compared.

    For a body of revolution these are all nodes outside the excluded zones, including nodes inside
    the body, where all models search and where a singularity may end. For any other body they are
    the surface nodes outside the zones.
    """
    fields = solution.fields
    if not fields.revolved:
        return fields.surface.nodes[solution.outside]
    x = fields.space.nodes
    r, z = np.hypot(x[:, 0], x[:, 1]), x[:, 2]
    inside = [np.hypot(r - p.r, z - p.z) <= p.radius for p in solution.singularities]
    return np.flatnonzero(~np.any(inside, axis=0)) if inside else np.arange(len(x))


def _difference(ours: Floats, theirs: Floats) -> float:
    largest = float(np.abs(ours).max())
    apart = float(np.abs(ours - theirs).max())
    return apart / largest if largest else apart

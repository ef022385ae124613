"""The limit load of an elastic-plastic body: its bounds on one mesh and on a sequence of meshes.

On a mesh the last state in equilibrium is a stress field that exceeds yield at no quadrature point.
Its load factor is not a lower bound by itself. Equilibrium holds only for whole elements. The
freedom that remains (transverse normal stresses that change sign within an element) lets the
longitudinal stress exceed yield by 1 to 3 %, and the factor exceed the exact one, as with any
displacement field, which is too stiff. A finer mesh hardly reduces this: the excess is 0.35 and
0.43 % in bending on the first two meshes. The lower bound is therefore the factor minus its change
from the coarser to the finer mesh, minus EQUILIBRIUM_ALLOWANCE: twice the largest excess over 17
closed forms, rounded up (docs/past-yield.md). The last increment of displacement, taken as a
mechanism, gives the upper bound (assess.plastic.mechanism).

Source: W. F. Chen, D. J. Han, Plasticity for Structural Engineers (1988), chapter 8, for the
theorems. The elastic displacements, taken as a mechanism, bound the factor in the same way and set
the size of the load steps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from assess.plastic.body import FlowingBody
from assess.plastic.budget import Budget
from assess.plastic.mechanism import RefinedElements, UpperBound, upper_bound, work_of_flow
from assess.plastic.path import EquilibriumPath, State
from assess.plastic.records import LoadCurve
from fea.core.linear_solver import SolveError
from pinbase.arrays import Floats

# Load steps: the work at which equilibrium is sought, relative to that of the elastic body at its
# bound. Fine where the body begins to flow, coarse beyond; chosen by judgement.
WORK_RATIOS = (0.25, 0.4, 0.55, 0.7, 0.85, 1.0, 1.3, 1.7, 2.2, 3.0, 4.0, 6.0, 9.0, 13.0, 20.0)
# Allowance on the factor, since equilibrium holds only for whole elements: twice the largest excess
# over 17 closed forms, 0.43 % (docs/past-yield.md, `python -m benchmarks limit_load`), rounded up.
EQUILIBRIUM_ALLOWANCE = 0.01
# End of the load path; chosen by judgement.
STEP_GROWTH_TOLERANCE = 2e-3  # largest relative growth of the factor in the last step
MAX_FLOW_WORK_RATIO = 1.02  # largest ratio of the bound of the last increment to the factor
MIN_FLOW_WORK_RATIO = 0.97  # smallest ratio of factor to that bound where Newton's method fails
ROUND_OFF = 1e-9  # relative to the largest displacement: a smaller permanent one is zero


@dataclass(frozen=True)
class MeshBracket:
    """The limit load on one mesh.

    reached: the largest load factor in equilibrium, which is not a bound by itself.
    above: the upper bound.
    curve: load factors and displacements.
    steps, iterations: the numbers of load steps and of Newton iterations.
    last: the last state in equilibrium.
    """

    unknowns: int
    reached: float
    above: UpperBound
    curve: LoadCurve
    steps: int
    iterations: int
    last: State

    def permanent_at(self, factor: float) -> float:
        """Return the permanent part of the largest displacement (m) after a load factor."""
        rising = np.maximum.accumulate(self.curve.factor)
        return float(np.interp(factor, rising, self.curve.permanent))


def limit_on_mesh(
    body: FlowingBody, forces: Floats, finer: RefinedElements, budget: Budget | None = None
) -> MeshBracket:
    """Return the limit load of a body on its mesh.

    forces: (U,) N.
    finer: the same elements with more quadrature points, for the work of the mechanism.

    Raises: SolveError when equilibrium is not found before the factor settles; OutOfTimeError.
    """
    path = EquilibriumPath(body, forces, budget)
    first = work_of_flow(body, finer.elements, path.elastic)
    states, flow_factor = [path.start()], np.inf
    try:
        # Follow the load path step by step. `flow_factor` is the upper bound that the step's
        # increment gives as a mechanism; the factor has settled when it nearly reaches this bound.
        for state in path.steps(np.array(WORK_RATIOS) * first):
            states.append(state)
            flow_work = work_of_flow(body, finer.elements, state.unknowns - states[-2].unknowns)
            flow_factor = flow_work / (state.work - states[-2].work)
            if _settled(states[-2], state, flow_factor):
                break
    except SolveError:
        # Newton's method fails where the tangent stiffness nearly vanishes; the last state is
        # accepted if it is near the upper bound.
        if not states[-1].factor > MIN_FLOW_WORK_RATIO * flow_factor:
            raise
    before, last = states[-2:]
    increment = last.unknowns - before.unknowns
    return MeshBracket(
        unknowns=body.size,
        reached=max(s.factor for s in states),
        above=upper_bound(body, forces, finer, increment, last.flow.stress),
        curve=_curve(body, path, states),
        steps=len(states) - 1,
        iterations=sum(len(s.residuals) for s in states),
        last=last,
    )


def _settled(before: State, now: State, flow_factor: float) -> bool:
    """Whether the factor has stopped growing and the last step is nearly a mechanism."""
    if before.factor <= 0.0:
        return False
    return (
        now.factor / before.factor < 1.0 + STEP_GROWTH_TOLERANCE
        and flow_factor < MAX_FLOW_WORK_RATIO * now.factor
    )


def _curve(body: FlowingBody, path: EquilibriumPath, states: list[State]) -> LoadCurve:
    """Return the load factors, the largest displacements, and their permanent parts after elastic
    unloading.
    """

    def largest(unknowns: Floats) -> float:
        return float(np.linalg.norm(body.displacement(unknowns), axis=1).max())

    def permanent(state: State) -> float:
        """Return the displacement that remains after unloading; 0 if it is only round-off."""
        remains = largest(state.unknowns - state.factor * path.elastic)
        return remains if remains > ROUND_OFF * largest(state.unknowns) else 0.0

    return LoadCurve(
        np.array([s.factor for s in states]),
        np.array([largest(s.unknowns) for s in states]),
        np.array([permanent(s) for s in states]),
    )


def bracket(meshes: list[MeshBracket]) -> tuple[float, float]:
    """Return the lower and upper bound of the load factor from the last two meshes, of which the
    first is coarser.
    """
    coarse, fine = meshes[-2:]
    doubt = abs(coarse.reached - fine.reached) + EQUILIBRIUM_ALLOWANCE * fine.reached
    return fine.reached - doubt, max(fine.above.factor, fine.reached)

"""The limit load of a flowing body: its bounds on a mesh, and those of a sequence of meshes.

On a mesh the last state in equilibrium is a stress field that yields at no quadrature point more
than it can. Its load factor is no lower bound by itself: equilibrium is of whole elements, and what
that leaves free (normal stresses across, which change sign within an element) lets the stress along
exceed yield by 1 to 3 %, and the factor be above the exact one, as for any field of displacements
that is too stiff. No finer mesh takes that away soon: 0.35 and 0.43 % in bending on the first two.
So the lower bound is the factor less what it changed from the coarser to the finer mesh, and less
EQUILIBRIUM_ALLOWANCE: twice the largest excess over 17 closed forms, rounded up
(docs/past-yield.md). The increment of displacement, as a mechanism, gives the upper bound
(assess.plastic.mechanism).

Source: W. F. Chen, D. J. Han, Plasticity for Structural Engineers (1988), chapter 8, for the
theorems; what elastic displacements give bounds the factor in the same way and sets the steps.
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

# Works at which equilibrium is sought, over that of the elastic body at its bound.
# Fine where the body begins to flow, coarse beyond; chosen by judgement.
WORK_RATIOS = (0.25, 0.4, 0.55, 0.7, 0.85, 1.0, 1.3, 1.7, 2.2, 3.0, 4.0, 6.0, 9.0, 13.0, 20.0)
# Of the factor, for equilibrium of whole elements alone: twice the largest excess over 17 closed
# forms, 0.43 % (docs/past-yield.md, `python -m benchmarks limit_load`), rounded up.
EQUILIBRIUM_ALLOWANCE = 0.01
# When the path ends; chosen by judgement.
STEP_GROWTH_TOLERANCE = 2e-3  # relative growth of the factor in the last step, at most
MAX_FLOW_WORK_RATIO = 1.02  # work of flow over that of the loads in that step, at most
MIN_FLOW_WORK_RATIO = 0.97  # factor over work of flow, at least, where Newton's method fails
ROUND_OFF = 1e-9  # of the largest displacement: a permanent one below it is none


@dataclass(frozen=True)
class MeshBracket:
    """The limit load on one mesh.

    reached: the largest load factor in equilibrium, no bound by itself.
    above: the upper bound.
    curve: load factors and displacements.
    steps, iterations: that it took.
    last: the last state.
    """

    unknowns: int
    reached: float
    above: UpperBound
    curve: LoadCurve
    steps: int
    iterations: int
    last: State

    def permanent_at(self, factor: float) -> float:
        """The permanent part of the largest displacement (m) after a load factor."""
        rising = np.maximum.accumulate(self.curve.factor)
        return float(np.interp(factor, rising, self.curve.permanent))


def limit_on_mesh(
    body: FlowingBody, forces: Floats, finer: RefinedElements, budget: Budget | None = None
) -> MeshBracket:
    """The limit load of a body under forces (U,), N.

    finer: the same elements with more quadrature points, for the mechanism's work.

    Raises: SolveError when equilibrium is not found before the factor settles; OutOfTimeError.
    """
    path = EquilibriumPath(body, forces, budget)
    first = work_of_flow(body, finer.elements, path.elastic)
    states, flow_factor = [path.start()], np.inf
    try:
        # Follow the path step by step; `flow_factor` is the upper bound by the step's increment as
        # a mechanism, so the factor has settled when it nearly reaches that.
        for state in path.steps(np.array(WORK_RATIOS) * first):
            states.append(state)
            flow_work = work_of_flow(body, finer.elements, state.unknowns - states[-2].unknowns)
            flow_factor = flow_work / (state.work - states[-2].work)
            if _settled(states[-2], state, flow_factor):
                break
    except SolveError:
        # Newton's method fails where hardly anything resists any more: accepted near the upper
        # bound.
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
    """Whether the factor has stopped growing and its step is nearly a mechanism."""
    if before.factor <= 0.0:
        return False
    return (
        now.factor / before.factor < 1.0 + STEP_GROWTH_TOLERANCE
        and flow_factor < MAX_FLOW_WORK_RATIO * now.factor
    )


def _curve(body: FlowingBody, path: EquilibriumPath, states: list[State]) -> LoadCurve:
    """Load factors, largest displacements, and their permanent parts after elastic unloading."""

    def largest(unknowns: Floats) -> float:
        return float(np.linalg.norm(body.displacement(unknowns), axis=1).max())

    def permanent(state: State) -> float:
        """The displacement that remains, without round-off where a state is elastic throughout."""
        remains = largest(state.unknowns - state.factor * path.elastic)
        return remains if remains > ROUND_OFF * largest(state.unknowns) else 0.0

    return LoadCurve(
        np.array([s.factor for s in states]),
        np.array([largest(s.unknowns) for s in states]),
        np.array([permanent(s) for s in states]),
    )


def bracket(meshes: list[MeshBracket]) -> tuple[float, float]:
    """The lower and the upper bound of the load factor from two meshes, the coarser first."""
    coarse, fine = meshes[-2:]
    doubt = abs(coarse.reached - fine.reached) + EQUILIBRIUM_ALLOWANCE * fine.reached
    return fine.reached - doubt, max(fine.above.factor, fine.reached)

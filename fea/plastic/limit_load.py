"""The limit load of a flowing body: its bounds on a mesh, and those of a sequence of meshes.

On a mesh the last state in equilibrium is a stress field that yields nowhere more than it can, so
its load factor would be a lower bound if equilibrium were exact; elements have it on average alone.
The increment of displacement there, as a mechanism, gives the upper bound: the work of flow over
the power of the loads. It would be exact for a field without change of volume; elements have that
at their quadrature points alone, so the work is integrated on a finer rule, and the volume that
changes is reported. What both lack is left to the meshes: from the coarser to the finer one the
factor falls, and once that difference is taken off the lower bound.

Source: W. F. Chen, D. J. Han, Plasticity for Structural Engineers (1988), chapter 8, for the
theorems; what elastic displacements give bounds the factor in the same way and sets the steps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.linear_solver import SolveError
from fea.plastic.body import Elements, FlowingBody
from fea.plastic.path import EquilibriumPath, State
from fea.plastic.records import LoadCurve
from geometry.arrays import Floats

# Works at which equilibrium is sought, over that of the elastic body at its bound.
WORKS = (0.25, 0.4, 0.55, 0.7, 0.85, 1.0, 1.3, 1.7, 2.2, 3.0, 4.0, 6.0, 9.0, 13.0, 20.0)
SETTLED = 2e-3  # growth of the factor in a step that ends it
APART = 1.02  # the bounds of a mesh, at most, then
UNSETTLED = 0.97  # the same, where Newton's method fails before


@dataclass(frozen=True)
class OnMesh:
    """lower, upper: bounds of the load factor on one mesh. volume: change of volume over the
    equivalent strain of the mechanism. steps, iterations: that it took. last: the last state.
    """

    unknowns: int
    lower: float
    upper: float
    volume: float
    curve: LoadCurve
    steps: int
    iterations: int
    last: State

    def permanent_at(self, factor: float) -> float:
        """What is left of the largest displacement (m) after a load factor, between the steps
        straight.
        """
        rising = np.maximum.accumulate(self.curve.factor)
        return float(np.interp(factor, rising, self.curve.permanent))


def limit_on_mesh(body: FlowingBody, forces: Floats, fine: Elements) -> OnMesh:
    """The limit load of a body under forces (U,) N; `fine`: the same elements with more points.

    Raises: SolveError when equilibrium is not found before the factor settles.
    """
    path = EquilibriumPath(body, forces)
    first, _ = _work_of_flow(body, fine, path.elastic)
    states, upper, volume = [path.start()], np.inf, 0.0
    try:
        for state in path.steps(np.array(WORKS) * first):
            states.append(state)
            upper, volume = _mechanism(body, fine, states[-2], state)
            if _settled(states[-2], state, upper):
                break
    except SolveError:
        if not states[-1].factor > UNSETTLED * upper:
            raise
    return OnMesh(
        unknowns=body.size,
        lower=max(s.factor for s in states),
        upper=upper,
        volume=volume,
        curve=_curve(body, path, states),
        steps=len(states) - 1,
        iterations=sum(len(s.residuals) for s in states),
        last=states[-1],
    )


def _mechanism(body: FlowingBody, fine: Elements, before: State, now: State) -> tuple[float, float]:
    """Upper bound by the increment of a step, and its change of volume."""
    work, part = _work_of_flow(body, fine, now.unknowns - before.unknowns)
    return work / (now.work - before.work), part


def _settled(before: State, now: State, upper: float) -> bool:
    if before.factor <= 0.0:
        return False
    return now.factor / before.factor < 1.0 + SETTLED and upper < APART * now.factor


def _work_of_flow(body: FlowingBody, fine: Elements, unknowns: Floats) -> tuple[float, float]:
    """Of a mechanism (U,), J, and its change of volume over its equivalent strain."""
    strain = fine.strain(body.displacement(unknowns))
    each = body.rule.dissipation(strain) * fine.weights
    changed = np.abs(strain[..., :3].sum(-1)) * fine.weights
    work = float(each.sum())
    return work, float(changed.sum()) * body.rule.strongest / work


def _curve(body: FlowingBody, path: EquilibriumPath, states: list[State]) -> LoadCurve:
    def largest(unknowns: Floats) -> float:
        return float(np.linalg.norm(body.displacement(unknowns), axis=1).max())

    return LoadCurve(
        np.array([s.factor for s in states]),
        np.array([largest(s.unknowns) for s in states]),
        np.array([largest(s.unknowns - s.factor * path.elastic) for s in states]),
    )


def bracket(meshes: list[OnMesh]) -> tuple[float, float]:
    """Lower and upper bound from two meshes, the coarser first."""
    coarse, fine = meshes[-2:]
    change = abs(coarse.lower - fine.lower)
    return fine.lower - change, max(fine.upper, fine.lower)

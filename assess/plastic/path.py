"""Equilibrium of an elastic-plastic body along its load path.

The path continues beyond the point where the loads can no longer grow. The loads are a factor times
given forces f. Each step prescribes the work c = f u instead of the factor, which then is an
unknown. The equations of a step are those of the minimum of a convex function (the incremental
energy) on a plane. Newton's method with a line search finds it.

Source: J. C. Simo, T. J. R. Hughes, Computational Inelasticity (1998), section 4.3, for the
incremental energy; J.-L. Batoz, G. Dhatt, Int. J. Num. Meth. Eng. 14 (1979) 1262, for the two
solutions per iteration.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from assess.plastic.body import FlowingBody
from assess.plastic.budget import Budget
from assess.plastic.flow import Flow
from fea.core.linear_solver import Analysis, SolveError
from pinbase.arrays import Floats

RESIDUAL_TOLERANCE = 1e-6  # residual relative to the loads
MAX_NEWTON_ITERATIONS = 40  # in one step
# Largest remaining slope after a line search, relative to the initial one; chosen by judgement.
MAX_SLOPE_SHARE = 0.8
MAX_STEP_HALVINGS = 6


@dataclass(frozen=True)
class State:
    """A state in equilibrium.

    factor: the load factor.
    unknowns: (U,) m.
    work: the work of the loads at a load factor of 1, J.
    flow: the state of the quadrature points.
    residuals: the residual of each iteration, relative to the loads.
    """

    factor: float
    unknowns: Floats
    work: float
    flow: Flow
    residuals: tuple[float, ...] = ()


class EquilibriumPath:
    """The equilibrium of a body along its load path, by prescribed work.

    forces: (U,) N.
    budget: checked before every iteration.

    Raises: SolveError for a body that is not constrained, here and in the steps.
    """

    def __init__(self, body: FlowingBody, forces: Floats, budget: Budget | None = None) -> None:
        self.body, self.load, self.budget = body, forces, budget or Budget()
        stiff = body.stiffness(body.at_rest().tangent)
        self._analysis = Analysis(stiff, body.ties.first // 3)
        self.elastic = self._analysis.factorize(stiff)(forces)
        self.compliance = float(forces @ self.elastic)

    def start(self) -> State:
        """Return the state without loads."""
        return State(0.0, np.zeros(self.body.size), 0.0, self.body.at_rest())

    def steps(self, works: Floats) -> Iterator[State]:
        """Yield the states at increasing works (J). A step that Newton's method cannot solve is
        halved.

        Raises: SolveError if the smallest fraction of a step cannot be solved either.
        """
        before, now = None, self.start()
        for work in works:
            while now.work < work * (1.0 - 1e-12):
                before, now = now, self._reach(now, before, work)
            yield now

    def _reach(self, now: State, before: State | None, work: float) -> State:
        """Return the state at a work (J), or after the first halved step that can be solved."""
        for _ in range(MAX_STEP_HALVINGS):
            try:
                return self.step(now, before, work)
            except SolveError as error:
                failed, work = error, (now.work + work) / 2.0
        raise failed

    def step(self, now: State, before: State | None, work: float) -> State:
        """Return the state at a work (J).

        now: the current state. before: the state before it, for the predictor; None at the start.

        Raises: SolveError; OutOfTimeError.
        """
        # Predictor: along the elastic response in the first step, then along the last increment.
        guess = (work - now.work) * (
            self.elastic / self.compliance
            if before is None
            else (now.unknowns - before.unknowns) / (now.work - before.work)
        )
        u, factor, residuals = now.unknowns + guess, now.factor, []
        flow = self.body.flow(u, now.flow)
        size = float(np.linalg.norm(self.load))
        for _ in range(MAX_NEWTON_ITERATIONS):
            self.budget.require()
            inner = self.body.forces(flow.stress)
            solve = self._analysis.factorize(self.body.stiffness(flow.tangent))
            # Corrector: two solutions with one factorisation, for the residual and for the loads;
            # the factor follows from the prescribed work f u.
            a, b = solve(np.stack([-inner, self.load], axis=1)).T
            factor = (work - self.load @ (u + a)) / (self.load @ b)
            residual = float(np.linalg.norm(factor * self.load - inner)) / size
            residuals.append(residual / max(abs(float(factor)), 1e-300))
            if residuals[-1] < RESIDUAL_TOLERANCE:
                return State(float(factor), u, work, flow, tuple(residuals))
            u, flow = self._search(u, a + factor * b, now.flow)
        raise SolveError(
            f"the equilibrium of the flowing pin was not found: after {MAX_NEWTON_ITERATIONS} "
            f"iterations {residuals[-1]:.1e} of the loads is unbalanced",
            "no-convergence",
        )

    def _search(self, u: Floats, along: Floats, before: Flow) -> tuple[Floats, Flow]:
        """Return the point along a direction where the incremental energy is nearly smallest, and
        the state of flow there.

        The energy is convex, so its slope along the direction, the unbalanced force times the
        direction, increases. The full step is taken if the slope is still negative there. Otherwise
        regula falsi brackets the root; each step moves by at least a tenth of the bracket.
        """
        flow = self.body.flow(u + along, before)
        high, at_high = 1.0, self._slope(flow, along)
        # The energy still falls at the full step, or is smallest there: take the full step.
        if at_high <= 0.0:
            return u + along, flow
        low, at_low, at = 0.0, self._slope(self.body.flow(u, before), along), 1.0
        most = MAX_SLOPE_SHARE * abs(at_low)
        for _ in range(MAX_STEP_HALVINGS):
            if abs(at_high) <= most or at_low >= 0.0:
                break
            # Regula falsi on the slope, at least a tenth of the bracket away from the lower end.
            at = low + max((high - low) * at_low / (at_low - at_high), 0.1 * (high - low))
            flow = self.body.flow(u + at * along, before)
            middle = self._slope(flow, along)
            if abs(middle) <= most:
                break
            if middle > 0.0:
                high, at_high = at, middle
            else:
                low, at_low = at, middle
        return u + at * along, flow

    def _slope(self, flow: Flow, along: Floats) -> float:
        """Return the slope of the incremental energy along a direction, J."""
        return float(self.body.forces(flow.stress) @ along)

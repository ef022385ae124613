"""Limit analysis in plane strain as a cone program, solved by an interior-point method.

The unknowns are the stresses at points (p + q and p - q along x and y, and t in shear) and the
amounts c of the loads:

    maximise g c   with   P p + Q q + T t + C c = 0,   sqrt(q^2 + t^2) <= 1,   c >= 0.

The rows are equations of equilibrium: of the stress itself in a lower bound, of its virtual work in
an upper bound (assess.plastic.lug.bounds). Their Lagrange multipliers are velocities, so that a
solution brackets its optimum: g c is below it, the work of flow is above it.

The method is a primal-dual one with the scaling of Nesterov and Todd and the corrector of Mehrotra.
The mean stress p is not in a cone. A small compliance of p in the linear systems makes them
positive definite, as for a nearly incompressible body; iterative refinement removes its effect.

Source: L. Vandenberghe, The CVXOPT linear and quadratic cone program solvers (2010), sections 5 to
7; A. Makrodimopoulos, C. M. Martin, Int. J. Num. Meth. Eng. 66 (2006) 604, for limit analysis.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import scipy.sparse as sp

from assess.plastic.lug.cones import Scaling, divided, longest_step, product
from assess.plastic.lug.schur import SchurComplement
from fea.core.linear_solver import Analysis, SolveError
from pinbase.arrays import Floats

MAX_ITERATIONS = 80  # 12 to 20 are usual
GAP_TOLERANCE = 1e-4  # relative gap between the two bounds of the optimum
MAX_GAP = 2e-3  # largest accepted relative gap where round-off ends the iterations earlier
MIN_STEP = 1e-4  # relative to a full Newton step: a smaller step is round-off
STEP_SHARE = 0.98  # fraction of the step to the boundary of the cones that is taken
# Compliance of the mean stress in the linear systems, relative to the smallest compliance in shear
# at each point. Chosen by judgement: a smaller value is worse conditioned, a larger one takes more
# steps of refinement.
MEAN_COMPLIANCE = 1e-4
REFINEMENTS = 4  # steps of iterative refinement of a linear solution

Residuals = tuple[Floats, Floats, Floats, Floats]  # as of `_Solver.residuals`


@dataclass(frozen=True)
class ConeProgram:
    """The data of a program with N points, L loads and R rows; the shear strength is 1.

    mean, difference, shear: P, Q, T (R, N). loads: C (R, L). gain: g (L,).
    """

    mean: sp.csr_matrix
    difference: sp.csr_matrix
    shear: sp.csr_matrix
    loads: sp.csr_matrix
    gain: Floats


@dataclass(frozen=True)
class ConeSolution:
    """The optimum of a program.

    lower, upper: bounds of the optimal value, from the stresses and from the velocities; both allow
    for the work of the residuals.
    stress: p, q, t (3, N). loads: c (L,). velocity: the multipliers of the rows (R,).
    flow: (N,) work of flow at each point.
    """

    lower: float
    upper: float
    stress: Floats
    loads: Floats
    velocity: Floats
    flow: Floats
    iterations: int


@dataclass
class _Iterate:
    """The values of an iterate, or their change.

    x: stresses p, q, t and loads, (3 N + L,). y: velocities (R,). s: (1, q, t), (3, N), in the
    cones. z: work of flow and strain rates, (3, N), in the cones. z_load: velocities of separation
    from the pressing body, (L,).
    """

    x: Floats
    y: Floats
    s: Floats
    z: Floats
    z_load: Floats


def solve_cone_program(program: ConeProgram) -> ConeSolution:
    """Return the optimum of a program.

    Raises: SolveError if the method does not converge.
    """
    solver = _Solver(program)
    now, n = solver.start(), solver.points
    lower, upper, iterations = -np.inf, np.inf, 0
    while iterations < MAX_ITERATIONS:
        residuals = solver.residuals(now)
        # Round-off may spoil the last iterates: the bounds with the smallest gap count.
        below, above = solver.bounds(now, residuals)
        if above - below < upper - lower:
            lower, upper = below, above
        if upper - lower <= GAP_TOLERANCE * abs(upper):
            break
        if not solver.advance(now, residuals):
            break
        iterations += 1
    if not upper - lower <= MAX_GAP * abs(upper):
        raise SolveError(
            f"the limit load was not found: after {iterations} iterations its bounds are "
            f"{lower:.6g} and {upper:.6g}",
            "no-convergence",
        )
    stress, loads = now.x[: 3 * n].reshape(3, n), now.x[3 * n :]
    return ConeSolution(lower, upper, stress, loads, now.y, now.z[0], iterations)


class _Solver:
    """The interior-point method for one program."""

    def __init__(self, program: ConeProgram) -> None:
        self.gain = program.gain
        columns = program.mean, program.difference, program.shear, program.loads
        self.matrix = sp.csr_matrix(sp.hstack(columns))
        self.transposed = sp.csr_matrix(self.matrix.T)
        self.points, self.loads = program.mean.shape[1], len(program.gain)
        self.schur = SchurComplement(columns)
        self.analysis = Analysis(self.schur.matrix(np.ones(self.schur.size)))

    def start(self) -> _Iterate:
        """Return the first iterate: zero stress, unit loads."""
        centre = np.zeros((3, self.points))
        centre[0] = 1.0
        scale = float(np.abs(self.gain).mean())
        x = np.concatenate([np.zeros(3 * self.points), np.ones(self.loads)])
        rows, many = self.matrix.shape[0], np.full(self.loads, scale)
        return _Iterate(x, np.zeros(rows), centre, scale * centre, many)

    def residuals(self, now: _Iterate) -> Residuals:
        """Return the residuals of the rows (R,), of the volume change (N,), of the strain rates
        (2, N) and of the velocities of the loads (L,).
        """
        n, back = self.points, self.transposed @ now.y
        shear = back[n : 3 * n].reshape(2, n) - now.z[1:]
        gain = back[3 * n :] - now.z_load - self.gain
        return self.matrix @ now.x, back[:n], shear, gain

    def bounds(self, now: _Iterate, residuals: Residuals) -> tuple[float, float]:
        """Return the lower and the upper bound of the optimal value.

        The lower bound is the value of the stresses, less the work of the row residuals on the
        velocities. The upper bound is the work of flow, plus the work of the stresses on the other
        residuals.
        """
        unbalanced, *missed = residuals
        left = float(np.abs(np.concatenate([m.ravel() for m in missed]) * now.x).sum())
        value = float(self.gain @ now.x[3 * self.points :] - np.abs(unbalanced * now.y).sum())
        return value, float(now.z[0].sum()) + left

    def advance(self, now: _Iterate, residuals: Residuals) -> bool:
        """Advance by one step: the predictor shows how far the gap can be closed, the corrector
        closes it. Return False if round-off makes the step too short.
        """
        newton = _Newton(self, now, residuals)
        cone, load = newton.cone, newton.load
        square, load_square = product(cone, cone), load**2
        mean = (square[0].sum() + load_square.sum()) / (self.points + self.loads)
        predicted = newton.change(-square, -load_square, 1.0)
        centring = (1.0 - min(1.0, self.longest(now, predicted))) ** 3
        scaling = newton.scaling
        second = product(scaling.inverse_times(predicted.s), scaling.times(predicted.z))
        target = -square - second
        target[0] += centring * mean
        load_second = predicted.x[3 * self.points :] * predicted.z_load
        load_target = -load_square - load_second + centring * mean
        change = newton.change(target, load_target, 1.0 - centring)
        length = min(1.0, STEP_SHARE * self.longest(now, change))
        if not length > MIN_STEP:
            return False
        for part in fields(now):
            value = getattr(now, part.name) + length * getattr(change, part.name)
            setattr(now, part.name, value)
        return True

    def longest(self, now: _Iterate, change: _Iterate) -> float:
        """Return the longest step that stays in the cones and keeps the loads positive."""
        first = 3 * self.points
        steps = [longest_step(now.s, change.s), longest_step(now.z, change.z)]
        for v, d in ((now.x[first:], change.x[first:]), (now.z_load, change.z_load)):
            steps.append(float((-v / np.minimum(d, -1e-300)).min(initial=np.inf)))
        return min(steps)


class _Newton:
    """The Newton equations at an iterate, for any target of complementarity.

    With the scaled blocks H of the stresses and loads, the equations are H dx + A'dy = r, A dx = e.
    """

    def __init__(self, solver: _Solver, now: _Iterate, residuals: Residuals) -> None:
        self.solver, self.residuals = solver, residuals
        self.scaling = Scaling(now.s, now.z)
        loads = now.x[3 * solver.points :]
        self.cone = self.scaling.times(now.z)
        self.load = np.sqrt(loads * now.z_load)
        self._load_scale = np.sqrt(loads / now.z_load)
        self._inner = self.scaling.inverse_square()
        self._compliances = self._blocks()
        self._factor = solver.analysis.factorize(
            solver.schur.matrix(self._compliances), check=False
        )

    def change(self, target: Floats, load_target: Floats, part: float) -> _Iterate:
        """Return the change that leads to a target of complementarity and removes a part of the
        residuals.

        target: (3, N) for the cones. load_target: (L,) for the loads. part: 0 to 1.
        """
        n, scale = self.solver.points, self._load_scale
        unbalanced, volume, shear, gain = self.residuals
        towards = self.scaling.times(divided(self.cone, target))
        load_towards = scale * load_target / self.load
        right = np.concatenate(
            [
                -part * volume,
                *(self._stiff(towards)[1:] - part * shear),
                load_towards / scale**2 - part * gain,
            ]
        )
        x, y = self._solution(right, -part * unbalanced)
        ds = np.concatenate([np.zeros((1, n)), x[n : 3 * n].reshape(2, n)])
        dz_load = (load_towards - x[3 * n :]) / scale**2
        return _Iterate(x, y, ds, self._stiff(towards - ds), dz_load)

    def _solution(self, right: Floats, rows: Floats) -> tuple[Floats, Floats]:
        """Return x and y, by iterative refinement of the system with a compliant mean stress."""
        matrix, transposed = self.solver.matrix, self.solver.transposed
        n = self.solver.points
        x, y = np.zeros(len(right)), np.zeros(len(rows))
        for _ in range(1 + REFINEMENTS):
            strained = np.concatenate([np.zeros((1, n)), x[n : 3 * n].reshape(2, n)])
            stiff = [np.zeros(n), *self._stiff(strained)[1:], x[3 * n :] / self._load_scale**2]
            r = right - np.concatenate(stiff) - transposed @ y
            e = rows - matrix @ x
            dy = self._factor(matrix @ self._compliant(r) - e)
            x, y = x + self._compliant(r - transposed @ dy), y + dy
        return x, y

    def _stiff(self, v: Floats) -> Floats:
        """Return W^-2 v."""
        return np.asarray(np.einsum("ijn,jn->in", self._inner, v))

    def _compliant(self, v: Floats) -> Floats:
        """Return the inverse of H, with the compliance of the mean stress, times v."""
        n = self.solver.points
        p, qq, qt, _, tt = self._compliances[: 5 * n].reshape(5, n)
        mean, q, t = v[: 3 * n].reshape(3, n)
        loads = self._compliances[5 * n :] * v[3 * n :]
        return np.concatenate([p * mean, qq * q + qt * t, qt * q + tt * t, loads])

    def _blocks(self) -> Floats:
        """Return the entries of the inverse of H, in the order of `SchurComplement`."""
        # For q and t, H is (1 + 2 w w') / size^2.
        w, square = self.scaling.w[1:], self.scaling.size**2
        less = 2.0 * square / (1.0 + 2.0 * (w**2).sum(axis=0))
        across = -less * w[0] * w[1]
        return np.concatenate(
            [
                square / MEAN_COMPLIANCE,
                square - less * w[0] ** 2,
                across,
                across,
                square - less * w[1] ** 2,
                self._load_scale**2,
            ]
        )

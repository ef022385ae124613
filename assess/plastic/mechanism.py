"""Upper bounds of the limit load by mechanisms, and the work that their change of volume costs.

The work of flow over the power of the loads bounds the load factor from above for every field of
displacements without change of volume. Elements have that on average alone. What is left of it
works against the mean stress p of the limit state, so with that

    factor <= (integral of s_y e + p div u) / power of the loads

holds for any field; e is the equivalent strain. The mean stress is that of the last state, taken as
known up to half of its range over an element: p div u is charged, and that half of |div u| as well.
Two mechanisms are tried, and the lower bound counts: the increment itself, and the one next to it
(least squares of the change of shape) whose change of volume is penalised.

Source: W. F. Chen, D. J. Han, Plasticity for Structural Engineers (1988), chapter 8.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from assess.plastic.body import Elements, FlowingBody
from assess.plastic.flow import DEVIATOR
from fea.core.linear_solver import Analysis
from pinbase.arrays import Floats

VOLUME_PENALTY = 10.0  # of the change of volume over that of shape; chosen by judgement


@dataclass(frozen=True)
class RefinedElements:
    """The elements of a body with more quadrature points, F of them.

    reading: (F, Q) takes values at the body's own quadrature points to these.
    """

    elements: Elements
    reading: Floats


@dataclass(frozen=True)
class UpperBound:
    """An upper bound of the load factor.

    volume: change of volume over the equivalent strain, on average.
    charge: what that adds to the factor.
    """

    factor: float
    volume: float
    charge: float


def upper_bound(
    body: FlowingBody, forces: Floats, finer: RefinedElements, mechanism: Floats, stress: Floats
) -> UpperBound:
    """The upper bound by a mechanism (U,), m, or by the one next to it with less change of volume.

    forces: (U,) N.
    stress: (M, Q, 6) Pa of the last state.
    """
    mean = stress[..., :3].mean(-1)
    pressure = mean @ finer.reading.T, np.ptp(mean, axis=1, keepdims=True) / 2.0
    bounds = (
        _bound(body, forces, finer.elements, u, pressure)
        for u in (mechanism, isochoric(body, forces, finer.elements, mechanism))
    )
    return min(bounds, key=lambda bound: bound.factor)


def isochoric(body: FlowingBody, forces: Floats, fine: Elements, mechanism: Floats) -> Floats:
    """The mechanism (U,), m, next to another, of the same power, with less change of volume."""
    every = fine.gradients.reshape(*fine.weights.shape, -1)
    penalty = VOLUME_PENALTY * fine.weights[..., None] * every
    shape = body.stiffness(np.broadcast_to(2.0 * DEVIATOR, (*body.elements.weights.shape, 6, 6)))
    stiff = shape + body.assembled(penalty.swapaxes(1, 2) @ every)
    changed = fine.volume_change(body.displacement(mechanism))
    against = body.gathered((changed[:, None] @ penalty)[:, 0])
    # Minimise the change of shape plus the penalised change of volume under the constraint that the
    # power of the loads is kept: `push` is the response to the loads, its amount the multiplier.
    solve = Analysis(stiff, body.ties.first // 3).factorize(stiff)
    back, push = solve(np.stack([-against, forces], axis=1)).T
    return np.asarray(mechanism + back - push * (forces @ back) / (forces @ push))


def work_of_flow(body: FlowingBody, fine: Elements, mechanism: Floats) -> float:
    """The work of flow, J, of a mechanism (U,), m, without its change of volume."""
    strain = fine.strain(body.displacement(mechanism))
    return float((body.rule.dissipation(strain) * fine.weights).sum())


def _bound(
    body: FlowingBody,
    forces: Floats,
    fine: Elements,
    mechanism: Floats,
    pressure: tuple[Floats, Floats],
) -> UpperBound:
    """The upper bound by one mechanism (U,), m.

    pressure: mean stress (M, F), Pa, and by how much that may be wrong, (M, 1).
    """
    power = float(forces @ mechanism)
    work = work_of_flow(body, fine, mechanism)
    changed = fine.volume_change(body.displacement(mechanism)) * fine.weights
    known, doubt = pressure
    charge = float((known * changed + doubt * np.abs(changed)).sum())
    volume = float(np.abs(changed).sum()) * body.rule.strongest / work
    return UpperBound((work + charge) / power, volume, charge / power)

"""Upper bounds of the limit load by mechanisms, with the work of their volume change.

For every displacement field without volume change, the work of flow over the power of the loads is
an upper bound of the load factor. Elements satisfy this constraint only on average. The remaining
volume change works against the mean stress p of the limit state, so that for any field

    factor <= (integral of s_y e + p div u) / power of the loads

where e is the equivalent strain. The mean stress is that of the last state, with an uncertainty of
half its range over an element: both p div u and this uncertainty times |div u| are charged. Two
mechanisms are tried, and the smaller bound counts: the increment itself, and the nearest mechanism
(by least squares of the shape change) with a penalty on its volume change.

Source: W. F. Chen, D. J. Han, Plasticity for Structural Engineers (1988), chapter 8.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from assess.plastic.body import Elements, FlowingBody
from assess.plastic.flow import DEVIATOR
from fea.core.linear_solver import Analysis
from pinbase.arrays import Floats

VOLUME_PENALTY = 10.0  # weight of the volume change over the shape change; chosen by judgement


@dataclass(frozen=True)
class RefinedElements:
    """The elements of a body with F quadrature points each, more than the body's own Q.

    reading: (F, Q) matrix that extrapolates values at the body's own quadrature points to these.
    """

    elements: Elements
    reading: Floats


@dataclass(frozen=True)
class UpperBound:
    """An upper bound of the load factor.

    volume: mean volume change relative to the equivalent strain.
    charge: the amount that the volume change adds to the factor.
    """

    factor: float
    volume: float
    charge: float


def upper_bound(
    body: FlowingBody, forces: Floats, finer: RefinedElements, mechanism: Floats, stress: Floats
) -> UpperBound:
    """Return the smaller upper bound of two mechanisms: a given one, and its neighbour with less
    volume change.

    forces: (U,) N.
    mechanism: (U,) m.
    stress: (M, Q, 6) of the last state, Pa.
    """
    mean = stress[..., :3].mean(-1)
    pressure = mean @ finer.reading.T, np.ptp(mean, axis=1, keepdims=True) / 2.0
    bounds = (
        _bound(body, forces, finer.elements, u, pressure)
        for u in (mechanism, isochoric(body, forces, finer.elements, mechanism))
    )
    return min(bounds, key=lambda bound: bound.factor)


def isochoric(body: FlowingBody, forces: Floats, fine: Elements, mechanism: Floats) -> Floats:
    """Return the mechanism (U,), m, that is nearest to a given one of the same power, with less
    volume change.
    """
    every = fine.gradients.reshape(*fine.weights.shape, -1)
    penalty = VOLUME_PENALTY * fine.weights[..., None] * every
    shape = body.stiffness(np.broadcast_to(2.0 * DEVIATOR, (*body.elements.weights.shape, 6, 6)))
    stiff = shape + body.assembled(penalty.swapaxes(1, 2) @ every)
    changed = fine.volume_change(body.displacement(mechanism))
    against = body.gathered((changed[:, None] @ penalty)[:, 0])
    # Minimise the shape change plus the penalised volume change, subject to unchanged power of the
    # loads: `push` is the response to the loads, and its amount is the Lagrange multiplier.
    solve = Analysis(stiff, body.ties.first // 3).factorize(stiff)
    back, push = solve(np.stack([-against, forces], axis=1)).T
    return np.asarray(mechanism + back - push * (forces @ back) / (forces @ push))


def work_of_flow(body: FlowingBody, fine: Elements, mechanism: Floats) -> float:
    """Return the work of flow, J, of a mechanism (U,), m, without the work of volume change."""
    strain = fine.strain(body.displacement(mechanism))
    return float((body.rule.dissipation(strain) * fine.weights).sum())


def _bound(
    body: FlowingBody,
    forces: Floats,
    fine: Elements,
    mechanism: Floats,
    pressure: tuple[Floats, Floats],
) -> UpperBound:
    """Return the upper bound by one mechanism (U,), m.

    pressure: mean stress (M, F), Pa, and its uncertainty (M, 1), Pa.
    """
    power = float(forces @ mechanism)
    work = work_of_flow(body, fine, mechanism)
    changed = fine.volume_change(body.displacement(mechanism)) * fine.weights
    known, doubt = pressure
    charge = float((known * changed + doubt * np.abs(changed)).sum())
    volume = float(np.abs(changed).sum()) * body.rule.strongest / work
    return UpperBound((work + charge) / power, volume, charge / power)

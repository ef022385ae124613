"""Positions along a drive: continuation that cannot jump branches, then Newton at all instants."""

from __future__ import annotations

import numpy as np

from loads.constraints import Constraints
from loads.linkage import Floats, UnreachableError

NEWTON_TOLERANCE = (
    1e-10  # last correction, of the length scale: Newton is quadratic, so the error is far less
)
LARGEST_TURN = 0.15  # rad (or length scales) that a step of the continuation may move an item
CONTRACTION = 0.25  # each Newton correction must be at most this part of the one before
WORST_CONDITION = 1e10


class _Lost(Exception):
    """Newton did not converge at once from the predicted position."""


def least_squares(J: Floats, b: Floats) -> Floats:
    """Solutions (T, columns) of J x = b, J (T, rows, columns) of full column rank.

    Redundant rows are consistent, so the least-squares solution solves them all.
    """
    Q, R = np.linalg.qr(J)
    return np.linalg.solve(R, np.swapaxes(Q, 1, 2) @ b[..., None])[..., 0]


def positions(system: Constraints, lengths: Floats) -> Floats:
    """States (T, items + ground, 3) at the given lengths (T,) of the driven slider, m.

    A path is followed from the drawn position over the range of lengths, in steps so small that
    Newton contracts from the first iteration on: another branch is never in reach. Each instant
    then starts from the cubic through the path's nodes and is polished by Newton, all at once.

    Raises: UnreachableError with the last length that can be reached.
    """
    drawn = system.linkage.driven_slider.drawn_length
    start = system.drawn()[None]
    nodes = [(drawn, start[0], _rate(system, start)[0])]
    for end in (float(lengths.min()), float(lengths.max())):
        if (end - drawn) * (1.0 if end >= drawn else -1.0) > 0.0:
            nodes += _follow(system, start, drawn, end)
    nodes.sort(key=lambda node: node[0])
    guess = _hermite(nodes, lengths)
    try:
        return _newton(system, guess, lengths, np.inf)
    except _Lost:
        raise _unreachable(system, float(nodes[-1][0]), float(lengths.max())) from None


def _rate(system: Constraints, q: Floats) -> Floats:
    """Derivative of the state by the driven length, (T, items + ground, 3)."""
    b = np.zeros((len(q), system.rows))
    b[:, -1] = 1.0
    return system.spread(least_squares(system.jacobian(q), b))


def _follow(
    system: Constraints, q: Floats, length: float, end: float
) -> list[tuple[float, Floats, Floats]]:
    """Nodes (length, state, rate) from `length` to `end`."""
    nodes = []
    smallest = 1e-9 * abs(end - length)
    step = end - length
    scale = np.array([system.linkage.length_scale] * 2 + [1.0])
    while length != end:
        condition = np.linalg.cond(system.jacobian(q)[0])
        if condition > WORST_CONDITION:
            raise _unreachable(system, length, end)
        rate = _rate(system, q)
        limit = LARGEST_TURN / max(float(np.abs(rate / scale).max()), 1e-300)
        step = float(np.clip(step, -limit, limit))
        if abs(step) >= abs(end - length):
            step = end - length
        try:
            q = _newton(system, q + step * rate, np.array([length + step]), abs(step) / limit)
        except _Lost:
            step /= 2.0
            if abs(step) < smallest:
                raise _unreachable(system, length, end) from None
            continue
        length = end if step == end - length else length + step
        nodes.append((length, q[0], _rate(system, q)[0]))
        step *= 2.0
    return nodes


def _newton(system: Constraints, q: Floats, lengths: Floats, reach: float) -> Floats:
    """Newton from `q`; the first correction must stay below a tenth of `reach` steps of
    LARGEST_TURN, and every next one contract.
    """
    scale = system.linkage.length_scale
    before = 0.1 * reach * LARGEST_TURN * scale / CONTRACTION
    for _ in range(12):
        with np.errstate(all="ignore"):
            try:
                x = least_squares(system.jacobian(q), -system.residual(q, lengths))
            except np.linalg.LinAlgError:
                raise _Lost from None
        size = float(np.abs(x).max())
        if not np.isfinite(size):
            raise _Lost
        q = q + system.spread(x)
        if size <= NEWTON_TOLERANCE * scale:
            if np.abs(system.residual(q, lengths)).max() > 1e-11 * scale:
                raise _Lost  # the least-squares point of equations that contradict each other
            return q
        if size > CONTRACTION * before and size > 1e-9 * scale:
            raise _Lost
        before = size
    raise _Lost


def _hermite(nodes: list[tuple[float, Floats, Floats]], lengths: Floats) -> Floats:
    """Cubic Hermite interpolation of the states at `lengths`."""
    x = np.array([n[0] for n in nodes])
    if len(x) == 1:
        return np.repeat(nodes[0][1][None], len(lengths), axis=0)
    values, rates = (np.stack([n[i] for n in nodes]) for i in (1, 2))
    k = np.clip(np.searchsorted(x, lengths) - 1, 0, len(x) - 2)
    h = (x[k + 1] - x[k])[:, None, None]
    s = ((lengths - x[k]) / (x[k + 1] - x[k]))[:, None, None]
    return np.asarray(
        (1 + 2 * s) * (1 - s) ** 2 * values[k]
        + s * (1 - s) ** 2 * h * rates[k]
        + s**2 * (3 - 2 * s) * values[k + 1]
        - s**2 * (1 - s) * h * rates[k + 1]
    )


def _unreachable(system: Constraints, reached: float, wanted: float) -> UnreachableError:
    slider = system.linkage.driven_slider
    return UnreachableError(slider.name, slider.drawn_length, reached, wanted)

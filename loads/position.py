"""Positions along drives: continuation that cannot jump branches, then Newton at all instants."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from loads.factors import Factors
from loads.impasse import Impasse, impasse
from loads.linkage import Floats
from loads.loops import Ints, Loops

NEWTON_TOLERANCE = 1e-10  # last correction, of the length scale: the error is its square
CLOSURE = 1e-11  # largest gap of a closed loop, of the length scale
LARGEST_TURN = 0.25  # rad (or length scales) that a step of the continuation may move a coordinate
CONTRACTION = 0.25  # each Newton correction must be at most this part of the one before
WEAKEST = 1e-10  # pivot, of the largest: below it rank is lost
MOST_WAYPOINTS = 129  # when several drives move together


_COURSE = ("q", "rate", "bend")


class _Lost(Exception):
    """Newton did not converge at once from the predicted position."""


class _Open(Exception):
    """The equations contradict each other: the best coordinates leave loops open."""

    def __init__(self, q: Floats) -> None:
        self.q = q
        super().__init__()


@dataclass(frozen=True)
class _Node:
    """A point of the path: part of the way, coordinates, their first and second rate per part."""

    part: float
    q: Floats
    rate: Floats
    bend: Floats


def positions(loops: Loops, drives: Floats) -> Floats:
    """Coordinates (T, n) at the drives' values (T, D), m or rad.

    The path is followed from the drawn position to the first instant and on, in steps so small
    that Newton contracts from the first iteration on: another branch is never in reach. Every
    instant then starts from the quintic through the path's nodes and is polished by Newton, all at
    once.

    Raises: Impasse where the linkage cannot follow.
    """
    path = _Path(loops)
    q = np.zeros(loops.columns)
    nodes = path.follow(q, loops.drawn_drives, drives[0])
    out = np.empty((len(drives), loops.columns))
    out[0] = nodes[-1].q
    for a, b in pairwise(_waypoints(drives)):
        nodes = path.follow(out[a], drives[a], drives[b])
        out[a + 1 : b + 1] = _guess(loops, nodes, drives[a + 1 : b + 1], drives[a], drives[b])
    try:
        return _newton(loops, out, drives)
    except (_Lost, _Open):
        last = _last_good(loops, out, drives)
        raise impasse(loops, out[last], drives[last], drives[-1]) from None


def _waypoints(drives: Floats) -> Ints:
    """Instants between which the drives go straight: their turning points, when there is one."""
    count = len(drives)
    if drives.shape[1] > 1:
        return np.unique(np.linspace(0, count - 1, min(count, MOST_WAYPOINTS)).astype(np.int64))
    step = np.sign(np.diff(drives[:, 0]))
    moving = np.flatnonzero(step)
    turns = moving[1:][np.diff(step[moving]) != 0]
    return np.unique(np.concatenate([[0], turns, [count - 1]])).astype(np.int64)


class _Path:
    """Continuation along straight lines in the drives' values."""

    def __init__(self, loops: Loops) -> None:
        self.loops = loops

    def follow(self, q: Floats, start: Floats, end: Floats) -> list[_Node]:
        """Nodes from q, at the drives' values `start`, to `end`."""
        loops = self.loops
        run = end - start
        part, step, factors = 0.0, 1.0, self._factors(q)
        nodes = [self._node(0.0, q, factors, run)]
        while part < 1.0 and run.any():
            here = nodes[-1]
            fastest = float(np.abs(here.rate * loops.scale).max()) / loops.linkage.length_scale
            limit = LARGEST_TURN / max(fastest, 1e-300)
            step = min(step, limit, 1.0 - part)
            there = start + (part + step) * run
            try:
                ahead = here.q + step * here.rate + 0.5 * step**2 * here.bend
                q = _step(loops, ahead, there, step / limit)
            except (_Lost, _Open) as problem:
                step /= 2.0
                if step < 1e-9:
                    at = start + part * run
                    opened = problem.q if isinstance(problem, _Open) else None
                    raise impasse(loops, here.q, at, end, opened) from None
                continue
            J = loops.jacobian(loops.pose(q[None]))
            if factors.turn_to(J)[0] < 0.0:
                raise self._crossed(here, q, start, run, part + step, end)
            factors = Factors(J)
            if factors.weakest[0] < WEAKEST:
                raise impasse(loops, q, there, end)
            part = 1.0 if step >= 1.0 - part else part + step
            nodes.append(self._node(part, q, factors, run))
            step *= 2.0
        return nodes

    def _factors(self, q: Floats) -> Factors:
        return Factors(self.loops.jacobian(self.loops.pose(q[None])))

    def _node(self, part: float, q: Floats, factors: Factors, run: Floats) -> _Node:
        loops = self.loops
        rate = factors.solve(loops.drive_side(run[None])) / loops.scale
        bend = factors.solve(loops.bend_side(loops.pose(q[None]), rate)) / loops.scale
        return _Node(part, q, rate[0], bend[0])

    def _crossed(
        self, here: _Node, q: Floats, start: Floats, run: Floats, part: float, end: Floats
    ) -> Impasse:
        """The place between two nodes where rank was lost and another path crosses, by halving."""
        low, high = here.part, part
        at, factors = here.q, self._factors(here.q)
        for _ in range(40):
            middle = 0.5 * (low + high)
            weight = (middle - here.part) / (part - here.part)
            guess = (1.0 - weight) * here.q + weight * q
            try:
                between = _newton(self.loops, guess[None], (start + middle * run)[None])
            except (_Lost, _Open):
                low, at = middle, guess  # Newton fails between two good nodes: it is here
                break
            J = self.loops.jacobian(self.loops.pose(between))
            if factors.turn_to(J)[0] < 0.0:
                high = middle
            else:
                low, at = middle, between[0]
        return impasse(self.loops, at, start + low * run, end)


def _step(loops: Loops, q: Floats, drives: Floats, reach: float) -> Floats:
    """One step's Newton: the first correction must stay below a tenth of `reach` steps of
    LARGEST_TURN, so that no other branch can be what it finds.
    """
    first = 0.1 * reach * LARGEST_TURN * loops.linkage.length_scale
    return np.asarray(_newton(loops, q[None], drives[None], first)[0])


def _newton(loops: Loops, q: Floats, drives: Floats, first: float = np.inf) -> Floats:
    """Newton from q (T, n); every correction must be a part of the one before, the first below
    `first` (m). Factors are kept while corrections fall fast.
    """
    scale = loops.linkage.length_scale
    before, factors = first / CONTRACTION, None
    for _ in range(12):
        pose = loops.pose(q)
        gap = loops.residual(q, pose, drives)
        with np.errstate(all="ignore"):
            try:
                if factors is None:
                    factors = Factors(loops.jacobian(pose))
                x = factors.solve(-gap)
            except np.linalg.LinAlgError:
                raise _Lost from None
        size = float(np.abs(x).max())
        if not np.isfinite(size):
            raise _Lost
        q = q + x / loops.scale
        if size <= NEWTON_TOLERANCE * scale:
            if np.abs(loops.residual(q, loops.pose(q), drives)).max() > CLOSURE * scale:
                raise _Open(q[-1])
            return q
        if size > CONTRACTION * before and size > 1e-9 * scale:
            raise _Lost
        if size > 1e-2 * scale:
            factors = None
        before = size
    raise _Lost


def _guess(loops: Loops, nodes: list[_Node], drives: Floats, start: Floats, end: Floats) -> Floats:
    """Coordinates near the path of `nodes` for drives (T, D): Hermite's quintic along it, and the
    rate of the nearest node across it.
    """
    weight = np.array([loops.drive_scale(k) ** 2 for k in range(drives.shape[1])])
    run = end - start
    length = float(weight @ run**2)
    if length == 0.0 or len(nodes) < 2:
        return np.repeat(nodes[-1].q[None], len(drives), axis=0)
    part = np.clip((drives - start) @ (weight * run) / length, 0.0, 1.0)
    x = np.array([n.part for n in nodes])
    values, rates, bends = (np.stack([getattr(n, c) for n in nodes]) for c in _COURSE)
    k = np.clip(np.searchsorted(x, part) - 1, 0, len(x) - 2)
    h = (x[k + 1] - x[k])[:, None]
    s = (part - x[k])[:, None] / h
    t, cube = 1.0 - s, s**3
    along = (
        t**3 * (1.0 + 3.0 * s + 6.0 * s**2) * values[k]
        + t**3 * s * (1.0 + 3.0 * s) * h * rates[k]
        + 0.5 * t**3 * s**2 * h**2 * bends[k]
        + cube * (1.0 + 3.0 * t + 6.0 * t**2) * values[k + 1]
        - cube * t * (1.0 + 3.0 * t) * h * rates[k + 1]
        + 0.5 * cube * t**2 * h**2 * bends[k + 1]
    )
    if drives.shape[1] == 1:
        return np.asarray(along)
    factors = Factors(loops.jacobian(loops.pose(values[k])))
    off = loops.drive_side(drives - (start + part[:, None] * run))
    return np.asarray(along + factors.solve(off) / loops.scale)


def _last_good(loops: Loops, guess: Floats, drives: Floats) -> int:
    """The last instant before the first at which Newton fails by itself."""
    for t in range(len(drives)):
        try:
            _newton(loops, guess[t : t + 1], drives[t : t + 1])
        except (_Lost, _Open):
            return max(t - 1, 0)
    return len(drives) - 1

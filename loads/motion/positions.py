"""Positions along drives: continuation that cannot jump branches, then Newton at all instants."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from loads.motion.least_squares import Factors
from loads.motion.loop_equations import Loops
from loads.motion.singular_positions import MotionBlocked, impasse
from pinbase.arrays import Floats

NEWTON_TOLERANCE = 1e-10  # last correction, of the length scale: the error is its square
CLOSURE_TOLERANCE = 1e-11  # largest gap of a closed loop, of the length scale
MAX_STEP_TURN = 0.25  # rad (or length scales) that a step of the continuation may move a coordinate
MAX_CONTRACTION_RATIO = 0.25  # each Newton correction must be at most this part of the one before
MIN_PIVOT_RATIO = 1e-10  # pivot, of the largest: below it rank is lost
# Rad (or length scales) by which a step may leave the drives' straight line.
MAX_LINE_DEVIATION = 0.02

Drives = Callable[[Floats], Floats]
_COURSE_KEYS = ("start", "run", "q", "rate", "bend")


class _Lost(Exception):
    """Newton did not converge at once from the predicted position."""


class _Open(Exception):
    """The equations contradict each other: the best coordinates leave loops open."""

    def __init__(self, q: Floats) -> None:
        self.q = q
        super().__init__()


@dataclass(frozen=True)
class _Step:
    """One step of a path: times (s), coordinates q (2, n) at its ends, with their first and second
    rates per part of the way, as the drives go straight from `start` by `run` (D,).
    """

    begin: float
    end: float
    start: Floats
    run: Floats
    q: Floats
    rate: Floats
    bend: Floats


class Path:
    """Coordinates along the drives' course in time, followed from the drawn position.

    Steps are so small that Newton contracts from the first iteration on and that the drives go
    nearly straight: another branch is never in reach, and which instants are requested afterwards
    does not matter.
    """

    def __init__(self, loops: Loops, drives: Drives, grid: Floats) -> None:
        """drives: their values (T, D) at times (T,). grid: (G,) s, rising, from the first time to
        the last, so dense that nothing the drives do is between.

        Raises: Impasse where the linkage cannot follow.
        """
        self.loops, self.drives = loops, drives
        drawn, first = loops.drawn_drives, drives(grid[:1])[0]
        way = self._follow(
            np.zeros(loops.columns),
            lambda parts: drawn + parts[:, None] * (first - drawn),
            np.array([0.0, 1.0]),
        )
        steps = self._follow(way[-1].q[1], drives, grid)
        self._ends = np.array([step.end for step in steps])
        self._course = [np.stack([getattr(step, key) for step in steps]) for key in _COURSE_KEYS]
        self.nodes = np.append([step.begin for step in steps], self._ends[-1])  # s

    def at(self, times: Floats) -> Floats:
        """Coordinates (T, n): the quintic along the path, polished by Newton at all times at once.

        Raises: Impasse where the linkage cannot follow.
        """
        values = self.drives(times)
        guess = self._guess(times, values)
        try:
            near = 0.1 * MAX_STEP_TURN * self._length
            parts = self.loops.parts(len(times))
            return np.concatenate([_newton(self.loops, guess[k], values[k], near) for k in parts])
        except (_Lost, _Open):
            order = np.argsort(times, kind="stable")
            last = order[_last_good(self.loops, guess[order], values[order])]
            raise impasse(self.loops, guess[last], values[last], values[order[-1]]) from None

    @property
    def _length(self) -> float:
        return self.loops.linkage.length_scale

    def _follow(self, q: Floats, drives: Drives, grid: Floats) -> list[_Step]:
        loops, last = self.loops, float(grid[-1])
        marks, factors = drives(grid), self._factors(q)
        now, here, step, steps = float(grid[0]), marks[0], last - float(grid[0]), list[_Step]()
        least = 1e-9 * step
        while now < last or not steps:
            end = last if step >= last - now else now + step
            there = drives(np.array([end]))[0]
            between = marks[(grid > now) & (grid < end)]
            try:
                q1 = self._next(q, factors, here, there, between)
            except (_Lost, _Open) as problem:
                step = (end - now) / 2.0
                if step < least:
                    opened = problem.q if isinstance(problem, _Open) else None
                    wanted = self._furthest(here, marks[grid > now])
                    raise impasse(loops, q, here, wanted, opened) from None
                continue
            pose = loops.pose(q1[None])
            if factors.turn_to(loops.jacobian(pose))[0] < 0.0:
                raise self._crossed((now, end), q, q1, drives, marks[grid > now])
            beyond = loops.factors(pose)
            if beyond.weakest[0] < MIN_PIVOT_RATIO:
                raise impasse(loops, q1, there, self._furthest(here, marks[grid > now]))
            steps.append(self._step(now, end, here, there - here, (q, q1), (factors, beyond)))
            fastest = float(np.abs(steps[-1].rate[1] * loops.scale).max()) / self._length
            step = (end - now) * min(2.0, 0.98 * MAX_STEP_TURN / max(fastest, 1e-300))
            now, here, q, factors = end, there, q1, beyond
        return steps

    def _next(
        self, q: Floats, factors: Factors, here: Floats, there: Floats, between: Floats
    ) -> Floats:
        """Coordinates (n,) at the drives' values `there`, which pass `between` (M, D).

        Raises: _Lost when the step is too large.
        """
        loops, run = self.loops, there - here
        if not run.any() and not (between - here).any():
            return q
        rate = factors.solve(loops.drive_side(run[None])) / loops.scale
        moved = float(np.abs(rate * loops.scale).max()) / self._length
        if not moved <= MAX_STEP_TURN or not self._straight(factors, between - here, run):
            raise _Lost
        if not run.any():
            return q
        bend = factors.solve(loops.bend_side(loops.pose(q[None]), rate)) / loops.scale
        ahead = q + (rate + 0.5 * bend)[0]
        return np.asarray(_newton(loops, ahead[None], there[None], 0.1 * moved * self._length)[0])

    def _straight(self, factors: Factors, passed: Floats, run: Floats) -> bool:
        """Whether drives that pass (M, D), from where they are, do not leave the line to `run`."""
        off = passed - _part(self.loops, passed, run)[:, None] * run
        size = np.abs(factors.solve(self.loops.drive_side(off))).max(initial=0.0)
        return bool(size <= MAX_LINE_DEVIATION * self._length)

    def _step(
        self,
        begin: float,
        end: float,
        start: Floats,
        run: Floats,
        q: tuple[Floats, Floats],
        factors: tuple[Factors, Factors],
    ) -> _Step:
        loops = self.loops
        side = loops.drive_side(run[None])
        rate = np.concatenate([f.solve(side) for f in factors]) / loops.scale
        both = np.stack(q)
        bends = loops.bend_side(loops.pose(both), rate)
        bend = np.concatenate([f.solve(bends[k : k + 1]) for k, f in enumerate(factors)])
        return _Step(begin, end, start, run, both, rate, bend / loops.scale)

    def _factors(self, q: Floats) -> Factors:
        return self.loops.factors(self.loops.pose(q[None]))

    @staticmethod
    def _furthest(here: Floats, ahead: Floats) -> Floats:
        """Of the drives' values ahead (M, D) those furthest from `here`: what was wanted."""
        return np.asarray(ahead[int(np.abs(ahead - here).max(axis=1).argmax())])

    def _crossed(
        self, times: tuple[float, float], q: Floats, q1: Floats, drives: Drives, ahead: Floats
    ) -> MotionBlocked:
        """Where between two instants rank was lost and another path crosses, by halving."""
        (low, high), (begin, end) = times, times
        at, factors = q, self._factors(q)
        for _ in range(40):
            middle = 0.5 * (low + high)
            weight = (middle - begin) / (end - begin)
            guess = (1.0 - weight) * q + weight * q1
            try:
                between = _newton(self.loops, guess[None], drives(np.array([middle])))
            except (_Lost, _Open):
                low, at = middle, guess  # Newton fails between two good nodes: it is here
                break
            J = self.loops.jacobian(self.loops.pose(between))
            if factors.turn_to(J)[0] < 0.0:
                high = middle
            else:
                low, at = middle, between[0]
        reached = drives(np.array([low]))[0]
        return impasse(self.loops, at, reached, self._furthest(reached, ahead))

    def _guess(self, times: Floats, values: Floats) -> Floats:
        """Coordinates near the path for drives (T, D): Hermite's quintic along each step, and the
        rate of the step's start across it.
        """
        loops = self.loops
        k = np.searchsorted(self._ends[:-1], times)
        start, run, q, rate, bend = (values[k] for values in self._course)
        s = _part(loops, values - start, run)
        along = _quintic(s[:, None], q, rate, bend)
        off = values - start - s[:, None] * run
        if not off.any():
            return along
        across = [
            loops.factors(loops.pose(q[k, 0])).solve(loops.drive_side(off[k]))
            for k in loops.parts(len(q))
        ]
        return np.asarray(along + np.concatenate(across) / loops.scale)


def _part(loops: Loops, passed: Floats, run: Floats) -> Floats:
    """(T,) which part of the way `run` (D,) or (T, D) drives have gone that are at (T, D)."""
    weight = np.array([loops.drive_scale(k) ** 2 for k in range(passed.shape[1])])
    length = np.sum(weight * run**2, axis=-1)
    gone = np.sum(weight * run * passed, axis=-1)
    return np.asarray(np.clip(gone / np.where(length > 0.0, length, 1.0), 0.0, 1.0))


def _quintic(s: Floats, q: Floats, rate: Floats, bend: Floats) -> Floats:
    """(T, n) at parts s (T, 1) of the way, from values and rates (T, 2, n) at its ends."""
    t = 1.0 - s
    return np.asarray(
        t**3 * (1.0 + 3.0 * s + 6.0 * s**2) * q[:, 0]
        + t**3 * s * (1.0 + 3.0 * s) * rate[:, 0]
        + 0.5 * t**3 * s**2 * bend[:, 0]
        + s**3 * (1.0 + 3.0 * t + 6.0 * t**2) * q[:, 1]
        - s**3 * t * (1.0 + 3.0 * t) * rate[:, 1]
        + 0.5 * s**3 * t**2 * bend[:, 1]
    )


def _newton(loops: Loops, q: Floats, drives: Floats, first: float = np.inf) -> Floats:
    """Newton from q (T, n); every correction must be a part of the one before, the first below
    `first` (m). Factors are kept while corrections fall fast.
    """
    scale = loops.linkage.length_scale
    before, factors = first / MAX_CONTRACTION_RATIO, None
    for _ in range(12):
        pose = loops.pose(q)
        gap = loops.residual(q, pose, drives)
        with np.errstate(all="ignore"):
            try:
                if factors is None:
                    factors = loops.factors(pose)
                x = factors.solve(-gap)
            except np.linalg.LinAlgError:
                raise _Lost from None
        size = float(np.abs(x).max())
        if not np.isfinite(size):
            raise _Lost
        q = q + x / loops.scale
        if size <= NEWTON_TOLERANCE * scale:
            if np.abs(loops.residual(q, loops.pose(q), drives)).max() > CLOSURE_TOLERANCE * scale:
                raise _Open(q[-1])
            return q
        if size > MAX_CONTRACTION_RATIO * before and size > 1e-9 * scale:
            raise _Lost
        if size > 1e-2 * scale:
            factors = None
        before = size
    raise _Lost


def _last_good(loops: Loops, guess: Floats, drives: Floats) -> int:
    """The last instant before the first at which Newton fails by itself."""
    for t in range(len(drives)):
        try:
            _newton(loops, guess[t : t + 1], drives[t : t + 1])
        except (_Lost, _Open):
            return max(t - 1, 0)
    return len(drives) - 1

"""Positions under given drives, by continuation that cannot jump branches and Newton's method."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from loads.motion.equations import Equations, drive_side
from loads.motion.least_squares import Factors
from loads.motion.singular_positions import MotionBlocked, motion_blocked
from pinbase.arrays import Floats

NEWTON_TOLERANCE = 1e-10  # last correction, over the length scale; the error is its square
CLOSURE_TOLERANCE = 1e-11  # largest gap of a closed loop, over the length scale
OPEN_STEPS = 64  # steps of the drives in the search for the widest gap of a loop that stays open
MAX_STEP_TURN = 0.25  # rad (or length scales) that a coordinate may move in a continuation step
MAX_CONTRACTION_RATIO = 0.25  # largest ratio of a Newton correction to the one before
MIN_PIVOT_RATIO = 1e-10  # ratio of smallest to largest pivot, below which rank is lost
# rad (or length scales) by which a coordinate may deviate because the drives leave a straight line.
MAX_LINE_DEVIATION = 0.02

Drives = Callable[[Floats], Floats]
_COURSE_KEYS = ("start", "run", "q", "rate", "bend")


class _Lost(Exception):
    """Newton's method did not converge at once from the predicted position."""


class _Open(Exception):
    """The equations contradict each other: loops stay open at the best coordinates, q (n,)."""

    def __init__(self, q: Floats) -> None:
        self.q = q
        super().__init__()


@dataclass(frozen=True)
class _Step:
    """One step of a path, along which the drives are nearly on a straight line.

    begin, end: times, s.
    start, run: (D,) values of the drives at the start of the step, and their change in the step.
    q, rate, bend: (2, n) coordinates at both ends of the step, and their first and second
    derivatives with respect to the fraction of `run`.
    """

    begin: float
    end: float
    start: Floats
    run: Floats
    q: Floats
    rate: Floats
    bend: Floats


class Path:
    """The coordinates as functions of time, followed from the drawn position.

    Steps are so small that Newton's method contracts from the first iteration on, and that the
    drives are nearly on a straight line. So the solution cannot jump to another branch, and the
    result at an instant does not depend on which other instants are requested.
    """

    def __init__(self, loops: Equations, drives: Drives, grid: Floats) -> None:
        """Follow the drives from the drawing to their first values, then through time.

        drives: function that returns the values (T, D) of the drives at times (T,) s.
        grid: (G,) s, increasing, from the first time to the last, dense enough to show every motion
        of the drives.

        Raises: MotionBlocked where the linkage cannot follow.
        """
        self.loops, self.drives = loops, drives
        drawn, first = loops.drawn_drives, drives(grid[:1])[0]
        approach = self._follow(
            np.zeros(loops.columns),
            lambda fraction: drawn + fraction[:, None] * (first - drawn),
            np.array([0.0, 1.0]),
        )
        steps = self._follow(approach[-1].q[1], drives, grid)
        self._ends = np.array([step.end for step in steps])
        self._course = [np.stack([getattr(step, key) for step in steps]) for key in _COURSE_KEYS]
        self.nodes = np.append([step.begin for step in steps], self._ends[-1])  # s

    def at(self, times: Floats) -> Floats:
        """Coordinates (T, n) at times (T,) s.

        The quintic of each step gives an estimate, which Newton's method corrects, in batches.

        Raises: MotionBlocked where the linkage cannot follow.
        """
        values = self.drives(times)
        near = 0.1 * MAX_STEP_TURN * self._length
        try:
            return np.concatenate(
                [
                    _newton(self.loops, self._guess(times[k], values[k]), values[k], near)
                    for k in self.loops.parts(len(times))
                ]
            )
        except (_Lost, _Open):
            guess = self._guess(times, values)
            order = np.argsort(times, kind="stable")
            last = order[_last_good(self.loops, guess[order], values[order])]
            raise motion_blocked(self.loops, guess[last], values[last], values[order[-1]]) from None

    @property
    def _length(self) -> float:
        """Length scale of the linkage, m."""
        return float(self.loops.linkage.length_scale)

    def _follow(self, q: Floats, drives: Drives, grid: Floats) -> list[_Step]:
        """The steps from coordinates q (n,) at the grid's first time to its last.

        Raises: MotionBlocked.
        """
        loops, last = self.loops, float(grid[-1])
        marks, factors = drives(grid), self._factors(q)
        time, start, step, steps = float(grid[0]), marks[0], last - float(grid[0]), list[_Step]()
        min_step = 1e-9 * step
        while time < last or not steps:
            end = last if step >= last - time else time + step
            target = drives(np.array([end]))[0]
            between = marks[(grid > time) & (grid < end)]
            # Halve the step until the prediction is good enough. If even the smallest step fails,
            # the linkage cannot follow.
            try:
                q1 = self._next(q, factors, start, target, between)
            except (_Lost, _Open) as problem:
                step = (end - time) / 2.0
                if step < min_step:
                    wanted = self._furthest(start, marks[grid > time])
                    opened = None
                    if isinstance(problem, _Open):
                        opened = _widest(loops, problem.q, start, wanted)
                    raise motion_blocked(loops, q, start, wanted, opened) from None
                continue
            # A change of sign of the determinant shows that the step passed a singular position.
            pose = loops.pose(q1[None])
            if factors.orientation(loops.jacobian(pose))[0] < 0.0:
                raise self._crossed((time, end), q, q1, drives, marks[grid > time])
            factors1 = loops.factors(pose)
            if factors1.weakest[0] < MIN_PIVOT_RATIO:
                raise motion_blocked(loops, q1, target, self._furthest(start, marks[grid > time]))
            steps.append(self._step(time, end, start, target - start, (q, q1), (factors, factors1)))
            # The next step moves the fastest coordinate by almost MAX_STEP_TURN, at most doubling.
            fastest = float(np.abs(steps[-1].rate[1] * loops.scale).max()) / self._length
            step = (end - time) * min(2.0, 0.98 * MAX_STEP_TURN / max(fastest, 1e-300))
            time, start, q, factors = end, target, q1, factors1
        return steps

    def _next(
        self, q: Floats, factors: Factors, start: Floats, target: Floats, between: Floats
    ) -> Floats:
        """Coordinates (n,) at the end of a step from coordinates q (n,).

        factors: factors of the equations at q.
        start, target: (D,) values of the drives at both ends of the step.
        between: (M, D) values of the drives at grid times within the step.

        Raises: _Lost when the step is too large; _Open where loops stay open.
        """
        loops, run = self.loops, target - start
        if not run.any() and not (between - start).any():
            return q
        rate = factors.solve(drive_side(loops, run[None])) / loops.scale
        moved = float(np.abs(rate * loops.scale).max()) / self._length
        if not moved <= MAX_STEP_TURN or not self._straight(factors, between - start, run):
            raise _Lost
        if not run.any():
            return q
        # Second-order prediction; the first Newton correction must be small against the step.
        bend = factors.solve(loops.bend_side(loops.pose(q[None]), rate)) / loops.scale
        predicted = q + (rate + 0.5 * bend)[0]
        max_correction = 0.1 * moved * self._length
        return np.asarray(_newton(loops, predicted[None], target[None], max_correction)[0])

    def _straight(self, factors: Factors, passed: Floats, run: Floats) -> bool:
        """Whether the drives stay near the straight line of a step.

        factors: factors of the equations at the start of the step.
        passed: (M, D) values of the drives within the step, relative to those at its start.
        run: (D,) change of the drives in the step.
        """
        deviation = passed - _fraction(self.loops, passed, run)[:, None] * run
        size = np.abs(factors.solve(drive_side(self.loops, deviation))).max(initial=0.0)
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
        """The step with the derivatives of the coordinates.

        q, factors: coordinates and factors of the equations at both ends of the step.
        """
        loops = self.loops
        side = drive_side(loops, run[None])
        rate = np.concatenate([f.solve(side) for f in factors]) / loops.scale
        both = np.stack(q)
        bends = loops.bend_side(loops.pose(both), rate)
        bend = np.concatenate([f.solve(bends[k : k + 1]) for k, f in enumerate(factors)])
        return _Step(begin, end, start, run, both, rate, bend / loops.scale)

    def _factors(self, q: Floats) -> Factors:
        """Factors of the equations at coordinates q (n,)."""
        return self.loops.factors(self.loops.pose(q[None]))

    @staticmethod
    def _furthest(start: Floats, ahead: Floats) -> Floats:
        """The row of the drives' values `ahead` (M, D) that is farthest from `start` (D,)."""
        return np.asarray(ahead[int(np.abs(ahead - start).max(axis=1, initial=0.0).argmax())])

    def _crossed(
        self, times: tuple[float, float], q: Floats, q1: Floats, drives: Drives, ahead: Floats
    ) -> MotionBlocked:
        """The error at the singular position between two instants, located by bisection.

        times: both ends of the step, s. q, q1: (n,) coordinates at these times.
        ahead: (M, D) values of the drives at later times.
        """
        (low, high), (begin, end) = times, times
        at, factors = q, self._factors(q)
        for _ in range(40):
            middle = 0.5 * (low + high)
            weight = (middle - begin) / (end - begin)
            guess = (1.0 - weight) * q + weight * q1
            try:
                between = _newton(self.loops, guess[None], drives(np.array([middle])))
            except (_Lost, _Open):
                low, at = middle, guess  # both ends are regular, so the singular position is here
                break
            J = self.loops.jacobian(self.loops.pose(between))
            if factors.orientation(J)[0] < 0.0:
                high = middle
            else:
                low, at = middle, between[0]
        reached = drives(np.array([low]))[0]
        return motion_blocked(self.loops, at, reached, self._furthest(reached, ahead))

    def _guess(self, times: Floats, values: Floats) -> Floats:
        """Estimated coordinates (T, n) at times (T,) s, with the drives at `values` (T, D).

        The Hermite quintic gives the motion along the straight line of a step. The drives'
        deviation from this line is added linearly, by the derivatives at the step's start.
        """
        loops = self.loops
        k = np.searchsorted(self._ends[:-1], times)
        start, run, q, rate, bend = (values[k] for values in self._course)
        s = _fraction(loops, values - start, run)
        along = _quintic(s[:, None], q, rate, bend)
        deviation = values - start - s[:, None] * run
        if not deviation.any():
            return along
        across = [
            loops.factors(loops.pose(q[k, 0])).solve(drive_side(loops, deviation[k]))
            for k in loops.parts(len(q))
        ]
        return np.asarray(along + np.concatenate(across) / loops.scale)


def _fraction(loops: Equations, passed: Floats, run: Floats) -> Floats:
    """Fraction of a step, (T,) between 0 and 1, by projection of the drives on its line.

    passed: (T, D) values of the drives relative to the step's start.
    run: (D,) or (T, D) their change in the step.
    """
    weight = loops.drive_scale**2
    length = np.sum(weight * run**2, axis=-1)
    projection = np.sum(weight * run * passed, axis=-1)
    return np.asarray(np.clip(projection / np.where(length > 0.0, length, 1.0), 0.0, 1.0))


def _quintic(s: Floats, q: Floats, rate: Floats, bend: Floats) -> Floats:
    """Hermite quintic (T, n) at fractions s (T, 1) of a step.

    q, rate, bend: (T, 2, n) values and first two derivatives at both ends.
    """
    t = 1.0 - s
    return np.asarray(
        t**3 * (1.0 + 3.0 * s + 6.0 * s**2) * q[:, 0]
        + t**3 * s * (1.0 + 3.0 * s) * rate[:, 0]
        + 0.5 * t**3 * s**2 * bend[:, 0]
        + s**3 * (1.0 + 3.0 * t + 6.0 * t**2) * q[:, 1]
        - s**3 * t * (1.0 + 3.0 * t) * rate[:, 1]
        + 0.5 * s**3 * t**2 * bend[:, 1]
    )


def _widest(loops: Equations, q: Floats, reached: Floats, wanted: Floats) -> Floats:
    """Coordinates (n,) with the widest gap of the loops on a straight way of the drives.

    The way is followed as far as Newton's method converges to least-squares solutions.

    q: (n,) coordinates near `reached`.
    reached, wanted: (D,) values of the drives at both ends of the way, m or rad.
    """
    widest, largest = q, 0.0
    for part in np.linspace(0.0, 1.0, OPEN_STEPS + 1)[1:]:
        drives = (reached + part * (wanted - reached))[None]
        try:
            q = _newton(loops, q[None], drives, closure=np.inf)[0]
        except _Lost:
            break
        gap = float(np.abs(loops.residual(q[None], loops.pose(q[None]), drives)).max())
        if gap > largest:
            widest, largest = q, gap
    return widest


def _newton(
    loops: Equations,
    q: Floats,
    drives: Floats,
    first: float = np.inf,
    closure: float = CLOSURE_TOLERANCE,
) -> Floats:
    """Coordinates (T, n) that satisfy the equations, by Newton's method from q (T, n).

    Every correction must be at most MAX_CONTRACTION_RATIO of the previous one.
    drives: (T, D) values of the drives.
    first: largest allowed first correction, m.
    closure: largest allowed gap of a loop, over the length scale.

    Raises: _Lost without such contraction; _Open where the equations contradict each other.
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
            if np.abs(loops.residual(q, loops.pose(q), drives)).max() > closure * scale:
                raise _Open(q[-1])
            return q
        if size > MAX_CONTRACTION_RATIO * before and size > 1e-9 * scale:
            raise _Lost
        if size > 1e-2 * scale:  # after a smaller correction the old factors are good enough
            factors = None
        before = size
    raise _Lost


def _last_good(loops: Equations, guess: Floats, drives: Floats) -> int:
    """Index of the last instant before the first at which Newton's method fails on its own."""
    for t in range(len(drives)):
        try:
            _newton(loops, guess[t : t + 1], drives[t : t + 1])
        except (_Lost, _Open):
            return max(t - 1, 0)
    return len(drives) - 1

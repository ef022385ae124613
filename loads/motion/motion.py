"""Motion of a linkage, with exact positions, velocities and accelerations at every instant."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Generic, Self, TypeVar

import numpy as np

from loads.linkage.drives import Law, StateDrive, Values
from loads.linkage.linkage import Linkage, LinkageError
from loads.linkage.parts import Connection, Joint, Point, Slider, Turn
from loads.motion.as_drawn import RANK_TOLERANCE
from loads.motion.complex_points import Points, Pose, number, pairs
from loads.motion.equations import Equations, drive_side
from loads.motion.least_squares import Factors
from loads.motion.mobility import Mobility, require_determined
from loads.motion.planar_equations import PlanarEquations
from loads.motion.positions import Path
from loads.motion.singular_positions import motion_blocked
from pinbase.arrays import Complex, Floats

# Instants at which a course evaluates its drives, in addition to the `pieces` of their laws.
DRIVE_GRID_POINTS = 257
# Relative to the fastest coordinate of the course: the path of a slower point has no direction.
MIN_POINT_SPEED = 1e-9
MAX_DENSE_COORDINATES = 30  # largest system whose condition number comes from singular values
CORNER_TIME_TOLERANCE = 1e-12  # of the whole time: an instant this close to a corner is at it

# Positions (m), velocities and accelerations, (T, N) complex each
PointMotion = tuple[Complex, Complex, Complex]
M = TypeVar("M")
E = TypeVar("E", bound=Equations)


@dataclass(frozen=True)
class Instants(Generic[E]):
    """The motion of a linkage, in the plane or in space, at T instants.

    mobility: mobility of the linkage as drawn.
    times: (T,) s.
    drives, speeds, rates: (T, D) values of the drives (m or rad) and their first two derivatives.
    q, v, a: (T, n) coordinates and their first two derivatives.
    pace: largest rate of any coordinate along the whole course, m/s (angles times length scale).
    """

    equations: E
    mobility: Mobility
    times: Floats
    drives: Floats
    speeds: Floats
    rates: Floats
    q: Floats
    v: Floats
    a: Floats
    pace: float

    def __len__(self) -> int:
        return len(self.times)

    def __getitem__(self, part: slice) -> Self:
        """The same motion at some of its instants."""
        arrays = ("times", "drives", "speeds", "rates", "q", "v", "a")
        return replace(self, **{key: getattr(self, key)[part] for key in arrays})

    @property
    def parts(self) -> Iterator[Self]:
        """The same motion in batches of instants whose matrices take little memory."""
        slices = self.equations.parts(len(self))
        return (self[part] if len(slices) > 1 else self for part in slices)


@dataclass(frozen=True)
class Motion(Instants[PlanarEquations]):
    """The motion of a planar linkage at T instants; coordinates are in rad, then in m."""

    @property
    def loops(self) -> PlanarEquations:
        """The loop and drive equations."""
        return self.equations

    @cached_property
    def factors(self) -> Factors:
        """Orthogonal factors of the Jacobian at all instants; to be used on one of the `parts`."""
        return self.loops.factors(self.pose)

    def solve(self, side: Floats) -> Floats:
        """Rates of the coordinates, (T, n), from right-hand sides (T, rows) of the equations."""
        slices = self.loops.parts(len(self))
        rates = [m.factors.solve(side[k]) for m, k in zip(self.parts, slices, strict=True)]
        return np.concatenate(rates) / self.loops.scale

    @property
    def linkage(self) -> Linkage:
        """The linkage that moves."""
        return self.loops.linkage

    @cached_property
    def pose(self) -> Pose:
        """The position of the linkage at every instant."""
        return self.loops.pose(self.q)

    def follow(self, points: Points) -> PointMotion:
        """Positions (m), velocities and accelerations of points, (T, N) complex each."""
        (history,) = self.follow_each([points])
        return history

    def follow_each(self, several: Iterable[Points]) -> Iterator[PointMotion]:
        """Positions, velocities and accelerations of several sets of points, as by `follow`.

        The results are the same to the last bit as those of each set alone.
        """
        loops, pose = self.loops, self.pose
        places, speeds = loops.places(pose), loops.speeds(pose, self.v)
        rates, curvatures = loops.speeds(pose, self.a), loops.curvatures(pose, self.v)
        for points in several:
            yield (
                places.of(points), speeds.of(points), rates.of(points) + curvatures.of(points)
            )  # fmt: skip

    @cached_property
    def centres(self) -> PointMotion:
        """Positions (m), velocities and accelerations of centres of mass, (T, items) complex."""
        return self.follow(self.loops.centres)

    def point(self, item: str, drawn: Point) -> tuple[Floats, Floats, Floats]:
        """Position (m), velocity and acceleration of an item's point, (T, 2) each.

        drawn: the point as drawn, m.
        """
        (history,) = self._points([(item, drawn)])
        return history

    def _points(
        self, several: Iterable[tuple[str, Point]]
    ) -> Iterator[tuple[Floats, Floats, Floats]]:
        """Position, velocity and acceleration of several points (item, place as drawn)."""
        loops, index = self.loops, self.linkage.index
        points = (loops.points(np.array([index[i]]), np.array([number(p)])) for i, p in several)
        for place, velocity, acceleration in self.follow_each(points):
            yield pairs(place[:, 0]), pairs(velocity[:, 0]), pairs(acceleration[:, 0])

    def curvature(self, item: str, drawn: Point) -> Floats:
        """Curvature of the path of an item's point, (T,) 1/m, positive for a turn to the left.

        It is NaN where the point is at rest.
        """
        _, v, a = self.point(item, drawn)
        speed = np.linalg.norm(v, axis=1)
        speed = np.where(speed > MIN_POINT_SPEED * self.pace, speed, np.nan)
        return np.asarray((v[:, 0] * a[:, 1] - v[:, 1] * a[:, 0]) / speed**3)

    def joint(self, name: str) -> tuple[Floats, Floats, Floats]:
        """Position (m), velocity and acceleration of the pin of joint `name`, (T, 2) each."""
        joint = self.linkage.joint(name)
        return self.point(self.linkage.carrier(joint), joint.at)

    def joints(self) -> Iterator[tuple[Floats, Floats, Floats]]:
        """Position, velocity and acceleration of the pins of all joints, in their order."""
        return self._points((self.linkage.carrier(j), j.at) for j in self.linkage.joints)

    def coordinate(self, of: Slider | Turn) -> tuple[Floats, Floats, Floats]:
        """Length (m) of a slider or angle (rad) of a turn, with its rates, (T,) each."""
        row = self.loops.along(of) * self.loops.scale / self.loops.unit(of)
        return of.drawn + self.q @ row, self.v @ row, self.a @ row

    def turning(self, joint: Joint, connection: Connection) -> Floats:
        """Angular velocity of a connection's body relative to its pin's carrier, (T,) rad/s."""
        carrier = self.linkage.carrier(joint)
        return self.angular_velocity(connection.body) - self.angular_velocity(carrier)

    @property
    def rubbing(self) -> Floats:
        """Speeds (T, N) m/s of sliders and pins with friction; of pins times the length scale."""
        first = self.loops.frames - 1
        slides = [first + k for k, s in enumerate(self.linkage.sliders) if s.friction]
        turns = [
            self.turning(j, c)[:, None] * self.linkage.length_scale
            for j, c in self.linkage.connections
            if c.friction
        ]
        return np.concatenate([self.v[:, slides], *turns], axis=1)

    def _angular(self, coordinates: Floats, item: str) -> Floats:
        """The column of an item's angle, (T,), in coordinates or rates (T, n); 0 on the ground."""
        f = self.loops.frame[self.linkage.index[item]]
        return coordinates[:, f - 1] if f else np.zeros(len(coordinates))

    def angle(self, item: str) -> Floats:
        """Rotation of an item from the drawn position, (T,) rad."""
        return self._angular(self.q, item)

    def angular_velocity(self, item: str) -> Floats:
        """Angular velocity of an item, (T,) rad/s."""
        return self._angular(self.v, item)

    def angular_acceleration(self, item: str) -> Floats:
        """Angular acceleration of an item, (T,) rad/s^2."""
        return self._angular(self.a, item)

    @cached_property
    def masses(self) -> Floats:
        """Masses of all items, (items,) kg."""
        return np.array([item.mass for item in self.linkage.items])

    @cached_property
    def inertias(self) -> Floats:
        """Moments of inertia of all items, (items,) kg m^2; 0 for a particle."""
        return np.array([item.inertia or 0.0 for item in self.linkage.items])

    @cached_property
    def spin(self) -> Floats:
        """Angular velocities of all items, (T, items) rad/s."""
        return np.stack([self.angular_velocity(i.name) for i in self.linkage.items], axis=1)

    @cached_property
    def spin_rate(self) -> Floats:
        """Angular accelerations of all items, (T, items) rad/s^2."""
        return np.stack([self.angular_acceleration(i.name) for i in self.linkage.items], axis=1)

    @cached_property
    def condition(self) -> Floats:
        """Condition number of the loop and drive equations, (T,)."""
        return np.concatenate([_condition(part) for part in self.parts])


def side_by_side(histories: Sequence[Values], count: int) -> Values:
    """N histories of a value and its first two derivatives, (T,) each, as three arrays (T, N).

    histories: one for each value; a structure has none. count: number T of instants.
    """
    none = np.zeros((count, 0))
    values, speeds, rates = (np.stack([h[k] for h in histories], axis=1) if histories else none
                             for k in range(3))  # fmt: skip
    return values, speeds, rates


def _condition(part: Motion) -> Floats:
    """Condition numbers of a batch of instants, (T,).

    Small systems use singular values. For large systems singular values would take longer than the
    motion itself, so they are used only where the power method does not converge.
    """
    condition = np.full(len(part), np.nan)
    if part.loops.columns > MAX_DENSE_COORDINATES:
        condition = part.loops.factors(part.pose).condition()
    unknown = np.flatnonzero(np.isnan(condition))
    condition[unknown] = np.linalg.cond(part.loops.jacobian(part.pose[unknown]))
    return condition


class Followed(ABC, Generic[M]):
    """A motion under one law per drive, from a first to a last time (s), in the plane or in space.

    Its path is followed once; the motion at an instant does not depend on which others are
    requested. Velocities and accelerations follow from the differentiated equations, not from
    differences.
    """

    def __init__(
        self, equations: Equations, laws: Sequence[Law], first: float, last: float
    ) -> None:
        """Follow the path of the linkage under the laws.

        Raises: LinkageError for too many or too few laws; MotionBlocked when the linkage cannot
        follow them.
        """
        driven = equations.linkage.driven
        if len(laws) != len(driven):
            raise LinkageError(
                f"{len(driven)} drives need as many laws, not {len(laws)}", "laws-mismatch"
            )
        self.equations, self.laws = equations, tuple(laws)
        self.first, self.last = first, last
        self.corners = self._inside(t for law in laws for t in law.corners)
        grid = np.unique(
            [
                *np.linspace(first, last, DRIVE_GRID_POINTS),
                *self._inside(t for x in laws for t in x.pieces),
            ]
        )
        self.path = Path(equations, self._drives, grid)
        # The drives may be at rest at all nodes of a short path, so the pace is also taken at the
        # instants at which each drive is fastest.
        fastest = grid[np.abs(self._values(grid)[1]).argmax(axis=0)]
        rates = self._coordinates(np.union1d(self.path.nodes, fastest))[4]
        self.pace = float(np.abs(rates * equations.scale).max(initial=0.0))

    @abstractmethod
    def at(self, times: Floats) -> M:
        """The motion at times (T,) s, in any order. Raises: MotionBlocked."""

    def _inside(self, times: Iterable[float]) -> Floats:
        """The times (s) that are inside the course, unique and increasing."""
        return np.unique([t for t in times if self.first < t < self.last])

    def _drives(self, times: Floats) -> Floats:
        """Values of the drives at times (T,) s, (T, D) m or rad."""
        return self._values(times)[0]

    def _values(self, times: Floats) -> tuple[Floats, Floats, Floats]:
        """Values of the drives and their first two derivatives at times (T,) s, (T, D) each.

        At a corner, where one drive may end and another begin, they are the values just before it.
        """
        if len(self.laws) > 1 and len(self.corners):
            close = CORNER_TIME_TOLERANCE * (self.last - self.first)
            k = np.clip(np.searchsorted(self.corners, times - close), 0, len(self.corners) - 1)
            times = np.where(np.abs(times - self.corners[k]) <= close, times - 3.0 * close, times)
        return side_by_side([law(times) for law in self.laws], len(times))

    def _coordinates(self, times: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Drives (T, D) and coordinates (T, n) at times (T,) s, each with its two derivatives.

        Raises: MotionBlocked.
        """
        equations = self.equations
        drives, speeds, rates = self._values(times)
        q = self.path.at(times)
        v, a, weakest = np.empty_like(q), np.empty_like(q), np.empty(len(q))
        # J v = rates of the drives; J a = second rates of the drives, less the part quadratic in v.
        for part in equations.parts(len(q)):
            pose = equations.pose(q[part])
            factors = equations.factors(pose)
            weakest[part] = factors.weakest
            if weakest[part].min(initial=1.0) < RANK_TOLERANCE:
                continue
            v[part] = factors.solve(drive_side(equations, speeds[part])) / equations.scale
            side = drive_side(equations, rates[part]) + equations.bend_side(pose, v[part])
            a[part] = factors.solve(side) / equations.scale
        weak = int(weakest.argmin())
        if weakest[weak] < RANK_TOLERANCE:
            raise motion_blocked(equations, q[weak], drives[weak], drives[int(times.argmax())])
        return drives, speeds, rates, q, v, a


class Course(Followed[Motion]):
    """The motion of a planar linkage under one law per drive, from a first to a last time (s).

    Raises: LinkageError when the drives do not determine the position; MotionBlocked when the
    linkage cannot follow them.
    """

    def __init__(self, linkage: Linkage, laws: Sequence[Law], first: float, last: float) -> None:
        self.mobility, self.loops = require_determined(linkage), PlanarEquations(linkage)
        super().__init__(self.loops, laws, first, last)

    def at(self, times: Floats) -> Motion:
        """The motion at times (T,) s, in any order. Raises: MotionBlocked."""
        return Motion(self.loops, self.mobility, times, *self._coordinates(times), self.pace)


def move(linkage: Linkage, laws: Sequence[Law], times: Floats) -> Motion:
    """The motion under one law per drive at `times` (T,) s, followed from the earliest time.

    Raises: LinkageError when the drives do not determine the position; MotionBlocked when the
    linkage cannot follow them.
    """
    return Course(linkage, laws, float(times.min()), float(times.max())).at(times)


def at_rest(linkage: Linkage, drives: Sequence[float]) -> Motion:
    """The linkage at rest, as a motion of one instant. drives: values of the drives, m or rad."""
    return move(linkage, [StateDrive(value) for value in drives], np.zeros(1))

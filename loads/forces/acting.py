"""Forces that the motion determines, on the bodies of a linkage."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from loads.forces.curve import ForceTable
from loads.forces.measures import Distance, Measure, Position
from loads.linkage.linkage import LinkageError, Point, Slider, Turn
from loads.motion.loop_equations import cross, number
from loads.motion.motion import Motion
from pinbase.arrays import Complex, Floats

SWITCH_TIME_TOLERANCE = 1e-12  # relative: an instant this close to a switch is at it
MIN_POINT_DISTANCE = 1e-12  # of the length scale: points this close have no line between them


@dataclass(frozen=True)
class Push:
    """Force (T,) N in world axes on an item's point (m, as drawn), and couple (T,) N m on it."""

    item: str
    at: Point
    force: Complex
    couple: Floats


@dataclass(frozen=True)
class Kinks:
    """Values of a measure, or (rate) of its rate, at which a force is not smooth: the knots of a
    curve.
    """

    measure: Measure
    curve: ForceTable
    rate: bool = False


class Load(Protocol):
    """Something that acts on a linkage."""

    def pushes(self, motion: Motion) -> Iterator[Push]:
        """What it does at every instant."""
        ...

    @property
    def kinks(self) -> tuple[Kinks, ...]:
        """Where it is not smooth."""
        ...

    @property
    def switches(self) -> tuple[float, ...]:
        """Times at which it jumps, s."""
        ...


@dataclass(frozen=True)
class Varying:
    """A factor by a table of a measure."""

    measure: Measure
    curve: ForceTable

    def __call__(self, motion: Motion) -> Floats:
        """(T,)."""
        return self.curve(self.measure(motion)[0])


@dataclass(frozen=True)
class Applied:
    """A force (N) on a body's point (m, as drawn) and a couple (N m) on the body.

    follows: the force turns with the body (given in axes as drawn); otherwise in world axes.
    times: a factor of both, by default constant. begin, end: it acts only between, s.
    """

    body: str
    at: Point
    force: Point = (0.0, 0.0)
    couple: float = 0.0
    follows: bool = False
    times: Varying | None = None
    begin: float = -math.inf
    end: float = math.inf

    def along(self, motion: Motion) -> Complex:
        """The force in world axes at every instant, (T,) N."""
        force = self._size(motion) * number(self.force)
        turned = np.exp(1j * motion.angle(self.body)) if self.follows else 1.0
        return np.asarray(force * turned)

    def pushes(self, motion: Motion) -> Iterator[Push]:
        """What it does at every instant; at a switch what it did before."""
        yield Push(self.body, self.at, self.along(motion), self.couple * self._size(motion))

    @property
    def kinks(self) -> tuple[Kinks, ...]:
        """The rows of its table."""
        return () if self.times is None else (Kinks(self.times.measure, self.times.curve),)

    @property
    def switches(self) -> tuple[float, ...]:
        """Its begin and end, s."""
        return tuple(t for t in (self.begin, self.end) if math.isfinite(t))

    def _size(self, motion: Motion) -> Floats:
        t = motion.times
        on = np.ones(len(motion), dtype=bool)
        if self.switches:
            on = (t > self.begin + SWITCH_TIME_TOLERANCE * abs(self.begin)) & (
                t <= self.end + SWITCH_TIME_TOLERANCE * abs(self.end)
            )
        factor = np.zeros(len(motion))
        if self.times is None:
            factor[on] = 1.0
        elif on.any():  # its table need not cover the time in which it does not act
            factor[on] = self.times.curve(self.times.measure(motion)[0][on])
        return factor


@dataclass(frozen=True)
class ForceLaw:
    """Force (couple) that a spring and damper exert to increase their length (angle) x:

        preload - stiffness (x - reference) - damping x' + table(x) + damper(x')

    in SI.
    """

    preload: float = 0.0
    stiffness: float = 0.0
    reference: float = 0.0
    damping: float = 0.0
    table: ForceTable | None = None
    damper: ForceTable | None = None

    def __call__(self, x: Floats, rate: Floats) -> Floats:
        """(T,) N or N m. Raises: LinkageError outside a table."""
        out = self.preload - self.stiffness * (x - self.reference) - self.damping * rate
        if self.table is not None:
            out = out + self.table(x)
        return out if self.damper is None else out + self.damper(rate)

    def kinks(self, measure: Measure) -> tuple[Kinks, ...]:
        """The rows of its tables."""
        found = ((self.table, False), (self.damper, True))
        return tuple(Kinks(measure, curve, rate) for curve, rate in found if curve is not None)


@dataclass(frozen=True)
class Spring:
    """Between two points, along a slider, or between two bodies that turn: pushes them apart (turns
    the second against the first) with the force (couple) of its law.
    """

    name: str
    between: Distance | Position
    law: ForceLaw

    @property
    def kinks(self) -> tuple[Kinks, ...]:
        """The rows of its tables."""
        return self.law.kinks(self.between)

    @property
    def switches(self) -> tuple[float, ...]:
        """None."""
        return ()

    def force(self, motion: Motion) -> Floats:
        """(T,) N or N m, positive where it increases its length or angle."""
        return self.law(*self.between(motion))

    def pushes(self, motion: Motion) -> Iterator[Push]:
        """On both its ends."""
        force, none = self.force(motion), np.zeros(len(motion))
        match self.between:
            case Distance(items, points):
                line, _ = self.between.line(motion)
                if np.abs(line).min() <= MIN_POINT_DISTANCE * motion.linkage.length_scale:
                    raise LinkageError(
                        f"spring {self.name}: its two points coincide, so its force has no "
                        "direction",
                        "no-direction",
                        ("spring", self.name),
                    )
                along: Complex = force * line / np.abs(line)
                yield Push(items[1], points[1], along, none)
                yield Push(items[0], points[0], -along, none)
            case Position(Turn() as turn):
                yield Push(turn.body, (0.0, 0.0), none.astype(complex), force)
                yield Push(turn.base, (0.0, 0.0), none.astype(complex), -force)
            case Position(Slider() as slider):
                k = motion.linkage.sliders.index(slider)
                along = np.asarray(force * motion.pose.axis[:, k])
                line, _ = Distance((slider.base, slider.moving), (slider.start, slider.end)).line(
                    motion
                )
                yield Push(slider.moving, slider.end, along, none)
                yield Push(slider.base, slider.start, -along, -cross(line, along))


def balance(motion: Motion, loads: tuple[Load, ...]) -> Iterator[tuple[int, Complex, Floats]]:
    """Of every push its item's number, its force (T,) N and its couple (T,) N m about the item's
    centre; those on the ground are left out.
    """
    centres, _, _ = motion.centres
    for load in loads:
        for push in load.pushes(motion):
            i = motion.linkage.index[push.item]
            if i == len(motion.linkage.items):
                continue
            at, _, _ = motion.point(push.item, push.at)
            arm = at[:, 0] + 1j * at[:, 1] - centres[:, i]
            yield i, push.force, cross(arm, push.force) + push.couple


def power(motion: Motion, loads: tuple[Load, ...]) -> Floats:
    """(T,) W that the loads put in."""
    out = np.zeros(len(motion))
    for load in loads:
        for push in load.pushes(motion):
            _, velocity, _ = motion.point(push.item, push.at)
            out += velocity[:, 0] * push.force.real + velocity[:, 1] * push.force.imag
            out += push.couple * motion.angular_velocity(push.item)
    return out

"""Applied forces, springs and dampers on the bodies of a linkage, as determined by its motion."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, Protocol, TypeVar

import numpy as np

from loads.forces.corners import Unsmooth, Varying
from loads.forces.curve import ForceTable
from loads.forces.measures import Distance, Measure, Position
from loads.linkage.linkage import LinkageError
from loads.linkage.parts import Point, Slider, Turn
from loads.motion.complex_points import cross, number
from loads.motion.motion import Instants, Motion
from loads.motion.planar_equations import is_particle
from pinbase.arrays import Complex, Floats, Mask

SWITCH_TIME_TOLERANCE = 1e-12  # relative: an instant this close to a switch coincides with it
MIN_POINT_DISTANCE = 1e-12  # of the length scale: points this close define no line of action
MAX_PARTICLE_ARM = 1e-4  # of the length scale: a force with an arm this small acts at the particle

Timed = TypeVar("Timed", bound=Instants[Any])


@dataclass(frozen=True)
class Push:
    """The action of a load on one item over time.

    item: name of the item.
    at: point of the item at which the force acts, as drawn, m.
    force: (T,) N, complex, world axes.
    couple: (T,) N m.
    """

    item: str
    at: Point
    force: Complex
    couple: Floats


class Load(Unsmooth[Varying[Motion]], Protocol):
    """A load on a linkage, known at every instant of a motion."""

    def pushes(self, motion: Motion) -> Iterator[Push]:
        """The actions of the load on each item at every instant."""
        ...


def acts(times: Floats, begin: float, end: float) -> Mask:
    """Mask (T,) of the times (T,) s at which a load acts; at a switch, the state just before it."""
    on = np.ones(len(times), dtype=bool)
    if math.isfinite(begin):
        on &= times > begin + SWITCH_TIME_TOLERANCE * abs(begin)
    if math.isfinite(end):
        on &= times <= end + SWITCH_TIME_TOLERANCE * abs(end)
    return on


@dataclass(frozen=True, kw_only=True)
class Switched(Generic[Timed]):
    """A load that acts between two times, and whose size a table can change.

    times: table of the factor of the load; None for a factor of 1. It need not cover times at which
    the load does not act.
    begin, end: times between which the load acts, s.
    """

    times: Varying[Timed] | None = None
    begin: float = -math.inf
    end: float = math.inf

    @property
    def kinks(self) -> tuple[Varying[Timed], ...]:
        """The rows of the factor's table."""
        return () if self.times is None else (self.times,)

    @property
    def switches(self) -> tuple[float, ...]:
        """Times at which the load begins and ends, s."""
        return tuple(t for t in (self.begin, self.end) if math.isfinite(t))

    def size(self, motion: Timed) -> Floats:
        """Factor of the load at every instant, (T,); at a switch, the factor just before it."""
        on, out = acts(motion.times, self.begin, self.end), np.zeros(len(motion))
        if self.times is None:
            out[on] = 1.0
        elif on.any():
            out[on] = self.times.curve(self.times.measure(motion)[0][on])
        return out


@dataclass(frozen=True)
class Applied(Switched[Motion]):
    """A force on a point of a body and a couple on the body.

    at: the point, as drawn, m.
    force, couple: N and N m.
    follows: whether the force turns with the body (it is then stated as drawn); otherwise its
    direction is fixed in world axes.
    """

    body: str
    at: Point
    force: Point = (0.0, 0.0)
    couple: float = 0.0
    follows: bool = False

    def along(self, motion: Motion) -> Complex:
        """The force in world axes at every instant, (T,) N."""
        force = self.size(motion) * number(self.force)
        rotation = np.exp(1j * motion.angle(self.body)) if self.follows else 1.0
        return np.asarray(force * rotation)

    def pushes(self, motion: Motion) -> Iterator[Push]:
        """The force and couple at every instant; at a switch, their values just before it."""
        yield Push(self.body, self.at, self.along(motion), self.couple * self.size(motion))


@dataclass(frozen=True)
class ForceLaw:
    """The force (couple) by which a spring and damper push their ends apart at length (angle) x:

        preload - stiffness (x - reference) - damping x' + table(x) + damper(x')

    All quantities are in SI units.
    """

    preload: float = 0.0
    stiffness: float = 0.0
    reference: float = 0.0
    damping: float = 0.0
    table: ForceTable | None = None
    damper: ForceTable | None = None

    def __call__(self, x: Floats, rate: Floats) -> Floats:
        """The force at x (T,) m and x' = rate (T,) m/s, N; or the couple at x rad, N m.

        Raises: LinkageError outside a table.
        """
        out = self.preload - self.stiffness * (x - self.reference) - self.damping * rate
        if self.table is not None:
            out = out + self.table(x)
        return out if self.damper is None else out + self.damper(rate)

    def kinks(self, measure: Measure[Timed]) -> tuple[Varying[Timed], ...]:
        """The rows of the tables, as values of `measure`."""
        tables = ((self.table, False), (self.damper, True))
        return tuple(Varying(measure, curve, rate) for curve, rate in tables if curve is not None)


@dataclass(frozen=True)
class Spring:
    """A spring and damper between two points, along a slider, or between two bodies that turn.

    A positive force (couple) of its law pushes the points apart (turns the body relative to its
    base in the positive sense).
    """

    name: str
    between: Distance | Position
    law: ForceLaw
    switches: ClassVar[tuple[float, ...]] = ()  # it always acts

    @property
    def kinks(self) -> tuple[Varying[Motion], ...]:
        """The rows of the law's tables."""
        return self.law.kinks(self.between)

    def force(self, motion: Motion) -> Floats:
        """Force (N) or couple (N m), (T,), positive where it increases the length or angle."""
        return self.law(*self.between(motion))

    def pushes(self, motion: Motion) -> Iterator[Push]:
        """The spring's actions on its two ends at every instant.

        Raises: LinkageError where its two points coincide.
        """
        force, zero = self.force(motion), np.zeros(len(motion))
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
                yield Push(items[1], points[1], along, zero)
                yield Push(items[0], points[0], -along, zero)
            case Position(Turn() as turn):
                yield Push(turn.body, (0.0, 0.0), zero.astype(complex), force)
                yield Push(turn.base, (0.0, 0.0), zero.astype(complex), -force)
            case Position(Slider() as slider):
                # The slider's two points need not lie on a common line of action, so the base also
                # takes the couple of the two forces.
                k = motion.linkage.sliders.index(slider)
                along = np.asarray(force * motion.pose.axis[:, k])
                line, _ = Distance((slider.base, slider.moving), (slider.start, slider.end)).line(
                    motion
                )
                yield Push(slider.moving, slider.end, along, zero)
                yield Push(slider.base, slider.start, -along, -cross(line, along))


def balance(motion: Motion, loads: tuple[Load, ...]) -> Iterator[tuple[int, Complex, Floats]]:
    """Actions of the loads as (number of the item, force, couple), without those on the ground.

    Forces are (T,) N, complex; couples, about the item's centre of mass, (T,) N m.

    Raises: LinkageError for a moment about a particle.
    """
    centres, _, _ = motion.centres
    for load in loads:
        for push in load.pushes(motion):
            i = motion.linkage.index[push.item]
            if i == len(motion.linkage.items):
                continue
            at, _, _ = motion.point(push.item, push.at)
            arm = at[:, 0] + 1j * at[:, 1] - centres[:, i]
            _require_carried(motion, push, arm)
            yield i, push.force, cross(arm, push.force) + push.couple


def _require_carried(motion: Motion, push: Push, arm: Complex) -> None:
    """Raise LinkageError for a moment about a particle.

    arm: (T,) m, complex, from the particle's centre to the point of the force.
    """
    linkage = motion.linkage
    most = MAX_PARTICLE_ARM * linkage.length_scale * np.abs(push.force).max()
    aside = np.abs(cross(arm, push.force)).max() > most
    if (aside or push.couple.any()) and is_particle(linkage, push.item):
        raise LinkageError(
            f"body {push.item}: a load has a moment about its centre, but without inertia the body "
            "is a particle, which carries none: load the body that does, give its inertia, or let "
            "the force act at its centre",
            "particle",
            ("body", push.item),
        )


def power(motion: Motion, loads: tuple[Load, ...]) -> Floats:
    """Power of the loads on the linkage, (T,) W."""
    out = np.zeros(len(motion))
    for load in loads:
        for push in load.pushes(motion):
            _, velocity, _ = motion.point(push.item, push.at)
            out += velocity[:, 0] * push.force.real + velocity[:, 1] * push.force.imag
            out += push.couple * motion.angular_velocity(push.item)
    return out

"""A drop as loads on a mechanism, in axes that fall with the aircraft.

The strut's drive follows the stroke; the ground pushes on the axle; and the aircraft's deceleration
acts on every mass in addition to gravity (d'Alembert).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from loads.forces.acting import Applied
from loads.forces.power_balance import energy
from loads.landing.landing import Landing
from loads.landing.travel import Levered
from loads.linkage.drives import ConstantDrive, Law, StateDrive, Values
from loads.linkage.linkage import Linkage
from loads.linkage.parts import Point
from loads.motion.complex_points import number
from loads.motion.motion import Course, Motion
from pinbase.arrays import Complex, Floats
from pinbase.errors import ArgumentError

STROKE_POINTS = 65  # strokes at which the rise of the axle is computed
DRIVE_DURATION = 1.0  # s, in which the leg passes through all these strokes


@dataclass(frozen=True)
class Touchdown:
    """The axle and the strut of a leg in its mechanism.

    body, joint: names of the body and the joint of the axle.
    up, aft: unit vectors.
    strut: number of the strut's drive; None for a rigid leg.
    extended: values of all drives with the strut extended, m or rad.
    """

    body: str
    joint: str
    up: Point
    aft: Point
    strut: int | None
    extended: tuple[float, ...]


def axes(linkage: Linkage, forward: str) -> tuple[Point, Point]:
    """Unit vectors up, against gravity, and aft.

    forward: "left" or "right", the side of `up` on which the aircraft's nose is.

    Raises: ArgumentError without gravity.
    """
    size = float(np.hypot(*linkage.gravity))
    if size == 0.0:
        raise ArgumentError(
            "a drop needs gravity, which says where up is: give mechanism.gravity", "no-gravity"
        )
    up = (-linkage.gravity[0] / size, -linkage.gravity[1] / size)
    side = 1.0 if forward == "left" else -1.0
    return up, (side * up[1], -side * up[0])


def travel(linkage: Linkage, place: Touchdown, stroke: float) -> Levered:
    """The stroke of a strut as a function of the rise of its axle. stroke: largest stroke, m.

    Raises: LinkageError where the linkage cannot follow the strut; ArgumentError where the axle
    does not rise.
    """
    strokes, motion = _closing(linkage, place, stroke)
    at, _, _ = motion.joint(place.joint)
    rises = (at - at[0]) @ np.array(place.up)
    return Levered(tuple(rises.tolist()), tuple(strokes.tolist()))


def effective_mass(linkage: Linkage, place: Touchdown, stroke: float) -> float:
    """Effective mass of the leg at its axle, kg.

    It is the mass at the axle with the kinetic energy T of all bodies and pins while the strut
    closes and the aircraft is at rest: 2 T / (rate of rise)^2. As this changes along the stroke,
    the mean over the rise is taken.
    stroke: largest stroke, m.

    Raises: LinkageError where the linkage cannot follow the strut.
    """
    _, motion = _closing(linkage, place, stroke)
    at, rate, _ = motion.joint(place.joint)
    up = np.array(place.up)
    rises, rates = (at - at[0]) @ up, rate @ up
    mass = 2.0 * energy(motion).kinetic / rates**2
    return float(np.trapezoid(mass, rises) / rises[-1])


def _closing(linkage: Linkage, place: Touchdown, stroke: float) -> tuple[Floats, Motion]:
    """Strokes (STROKE_POINTS,) m from zero to `stroke`, and the leg's motion at constant speed."""
    strokes = np.linspace(0.0, stroke, STROKE_POINTS)
    assert place.strut is not None
    laws: list[Law] = [StateDrive(value) for value in place.extended]
    start = place.extended[place.strut]
    laws[place.strut] = ConstantDrive(start, start - stroke, DRIVE_DURATION)
    return strokes, Course(linkage, laws, 0.0, DRIVE_DURATION).at(DRIVE_DURATION * strokes / stroke)


def at_deflection(landing: Landing, place: Touchdown, time: float, part: float) -> tuple[Law, ...]:
    """Laws that hold the leg at a fraction `part` of its stroke at a time (s) of a drop."""
    values = (float(law(np.array([time]))[0][0]) for law in laws(landing, place))
    return tuple(
        StateDrive(extended + part * (value - extended))
        for extended, value in zip(place.extended, values, strict=True)
    )


@dataclass(frozen=True)
class StrokeDrive:
    """The length of a strut's slider during a drop. extended: length at touch-down, m."""

    landing: Landing
    extended: float

    @property
    def corners(self) -> tuple[float, ...]:
        """Times at which the drop changes its mode, s."""
        return self.landing.corners

    pieces = corners

    def __call__(self, times: Floats) -> Values:
        h = self.landing.at(times)
        s, lever, bend = self.landing.drop.travel.at(h.rise)
        rise_acceleration = h.forces.sprung - h.forces.unsprung
        second = lever * rise_acceleration + bend * h.rise_rate**2
        return self.extended - s, -lever * h.rise_rate, -second


@dataclass(frozen=True)
class AppliedOverTime(Applied):
    """A load of a drop on a mechanism, in world axes.

    mass: mass of a body on which the aircraft's deceleration acts, kg; None if the load is the
    force of the ground on the axle.
    """

    landing: Landing | None = None
    place: Touchdown | None = None
    mass: float | None = None

    def along(self, motion: Motion) -> Complex:
        """The force in world axes at every instant, (T,) N."""
        assert self.landing is not None
        assert self.place is not None
        f = self.landing.at(motion.times).forces
        up, aft = number(self.place.up), number(self.place.aft)
        if self.mass is not None:
            return np.asarray(self.mass * f.sprung * up)
        return np.asarray(f.vertical * up + f.on_leg * aft)


def laws(landing: Landing, place: Touchdown) -> tuple[Law, ...]:
    """The laws of all drives of the mechanism during a drop: only the strut moves."""
    drives: list[Law] = [StateDrive(value) for value in place.extended]
    if place.strut is not None:
        drives[place.strut] = StrokeDrive(landing, place.extended[place.strut])
    return tuple(drives)


def pushes(linkage: Linkage, landing: Landing, place: Touchdown) -> tuple[Applied, ...]:
    """All loads of a drop on the mechanism: ground force, and deceleration of every mass."""
    load = partial(AppliedOverTime, landing=landing, place=place)
    masses = [load(i.name, i.centre, mass=i.mass) for i in linkage.items if i.mass]
    return (load(place.body, linkage.joint(place.joint).at), *masses)


def fall(motion: Motion, applied: Iterable[object]) -> Floats:
    """The acceleration of the axes in which a motion under loads is described, (T, 2) m/s^2.

    It is the acceleration of the aircraft in a drop, otherwise zero.
    """
    for load in applied:
        if isinstance(load, AppliedOverTime) and load.mass is not None:
            assert load.landing is not None
            assert load.place is not None
            down = load.landing.at(motion.times).forces.sprung
            return np.outer(down, np.negative(load.place.up))
    return np.zeros((len(motion.times), 2))

"""Four-bar linkages (recognition, Grashof's class, crossed or open), and the closed form of a lever
that a slider turns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.linkage.linkage import Linkage
from loads.linkage.parts import GROUND, Point
from pinbase.arrays import Floats

CHANGE_POINT_TOLERANCE = 1e-9  # of the perimeter: shortest + longest then equal the other two


@dataclass(frozen=True)
class FourBar:
    """A four-bar linkage.

    lengths: lengths of the ground, the driven link, the coupler and the follower, m.
    bodies: names of the driven link, the coupler and the follower.
    joints: names of the joints in order along the ring (fixed, moving, moving, fixed).
    crossed: whether two opposite sides intersect as drawn.
    """

    lengths: tuple[float, float, float, float]
    bodies: tuple[str, str, str]
    joints: tuple[str, str, str, str]
    crossed: bool

    @property
    def kind(self) -> str:
        """Grashof's class. Source: Norton, Design of Machinery, sec. 2.13."""
        perimeter = sum(self.lengths)
        shortest, longest = min(self.lengths), max(self.lengths)
        excess = 2.0 * (shortest + longest) - perimeter
        if abs(excess) <= CHANGE_POINT_TOLERANCE * perimeter:
            return "change point"
        if excess > 0.0:
            return "triple-rocker (not Grashof)"
        kinds = ("double-crank", "crank-rocker", "double-rocker", "rocker-crank")
        return f"{kinds[self.lengths.index(shortest)]} (Grashof)"


def four_bar(linkage: Linkage) -> FourBar | None:
    """The linkage as a four-bar, or None.

    A linkage is a four-bar if three bodies and the ground form a ring of four pins, and the angle
    of a body pinned to the ground is driven.
    """
    bodies = [b.name for b in linkage.bodies if b.inertia is not None]
    if any(b.welded for b in linkage.bodies):
        return None
    if len(bodies) != 3 or linkage.sliders or len(linkage.joints) != 4 or len(linkage.turns) != 1:
        return None
    ring = {name: [j.name for j in linkage.joints_on(name)] for name in (*bodies, GROUND)}
    if any(len(joints) != 2 for joints in ring.values()):
        return None
    driven = linkage.turns[0].body
    fixed = ring[GROUND]
    if driven not in bodies or not set(ring[driven]) & set(fixed):
        return None
    o2 = next(j for j in ring[driven] if j in fixed)
    a = next(j for j in ring[driven] if j != o2)
    coupler = next((b for b in bodies if b != driven and a in ring[b]), None)
    if coupler is None:
        return None
    b = next(j for j in ring[coupler] if j != a)
    follower = next(x for x in bodies if x not in (driven, coupler))
    o4 = next(j for j in fixed if j != o2)
    if set(ring[follower]) != {b, o4}:
        return None
    joints = (o2, a, b, o4)
    at = [linkage.joint(name).at for name in joints]
    lengths = (
        _distance(at[0], at[3]),
        _distance(at[0], at[1]),
        _distance(at[1], at[2]),
        _distance(at[2], at[3]),
    )
    return FourBar(lengths, (driven, coupler, follower), joints, _crossed(at))


def _distance(a: Point, b: Point) -> float:
    return float(np.hypot(a[0] - b[0], a[1] - b[1]))


def _crossed(at: list[Point]) -> bool:
    """Whether two opposite sides of the ring of four joints at `at` intersect.

    In a Grashof linkage the two links adjacent to the shortest intersect (Norton, Design of
    Machinery, sec. 4.5). The mirror image of a crossed linkage is also crossed.
    """
    o2, a, b, o4 = at
    return _intersect(o2, a, b, o4) or _intersect(a, b, o4, o2)


def _intersect(p: Point, q: Point, r: Point, s: Point) -> bool:
    """Whether the segments p-q and r-s intersect within both."""
    apart = _side(p, q, r) * _side(p, q, s), _side(r, s, p) * _side(r, s, q)
    return max(apart) < 0.0


def _side(p: Point, q: Point, at: Point) -> float:
    """Twice the area of the triangle p, q, at; positive where `at` is left of p to q."""
    return (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0])


@dataclass(frozen=True)
class Lever:
    """A lever on a fixed pivot, turned by a slider by the law of cosines.

    base: distance from the slider's fixed end to the pivot, m.
    arm: distance from the pivot to the slider's moving end, m.
    """

    base: float
    arm: float

    def turn(self, length: Floats, speed: Floats, rate: Floats) -> tuple[Floats, Floats, Floats]:
        """Angle at the pivot (rad) and its first two rates, (T,) each.

        They follow from length^2 = base^2 + arm^2 - 2 base arm cos(angle), differentiated twice.
        length, speed, rate: (T,) length of the slider and its two rates, m, m/s and m/s^2.
        """
        k = self.base * self.arm
        angle = np.arccos((self.base**2 + self.arm**2 - length**2) / (2.0 * k))
        sine, cosine = np.sin(angle), np.cos(angle)
        first = length * speed / (k * sine)
        second = (speed**2 + length * rate - k * cosine * first**2) / (k * sine)
        return angle, first, second

    def point(
        self, radius: float, length: Floats, speed: Floats, rate: Floats
    ) -> tuple[Floats, Floats]:
        """Speed (m/s) and acceleration (m/s^2) of a point, magnitudes, (T,) each.

        radius: distance of the point from the pivot, m.
        length, speed, rate: as for `turn`.
        """
        _, first, second = self.turn(length, speed, rate)
        return radius * np.abs(first), radius * np.hypot(second, first**2)

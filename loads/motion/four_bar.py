"""Four-bar linkages: their recognition, class after Grashof, and branch of assembly."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from loads.linkage.linkage import Linkage
from loads.linkage.parts import GROUND, Point

CHANGE_POINT_TOLERANCE = 1e-9  # of the perimeter: shortest + longest equal the other two


@dataclass(frozen=True)
class FourBar:
    """A four-bar linkage.

    lengths: of the ground, the driven link, the coupler and the follower, m.
    bodies: the driven link, the coupler and the follower.
    joints: in order along the ring (fixed, moving, moving, fixed).
    branch: whether it is assembled open or crossed.
    """

    lengths: tuple[float, float, float, float]
    bodies: tuple[str, str, str]
    joints: tuple[str, str, str, str]
    branch: Literal["open", "crossed"]

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

    It is one if three bodies and the ground form a ring of four pins and a body at the ground is
    driven by its angle.
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
    return FourBar(lengths, (driven, coupler, follower), joints, _branch(at))


def _distance(a: Point, b: Point) -> float:
    return float(np.hypot(a[0] - b[0], a[1] - b[1]))


def _branch(at: list[Point]) -> Literal["open", "crossed"]:
    """The branch in which the four joints at `at` are assembled.

    It is open when, with the ground pointing right, the coupler's end lies left of the line from
    the crank's end to the follower's pivot (Norton, sec. 4.5); a turn of the crank keeps it there.
    """
    (_, a, b, o4) = at
    left = (o4[0] - a[0]) * (b[1] - a[1]) - (o4[1] - a[1]) * (b[0] - a[0]) > 0.0
    return "open" if left else "crossed"

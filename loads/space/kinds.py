"""The kinds of joints in space, and the motions that each prevents.

Every kind combines three elementary conditions between a base and a moving body (Haug, Computer
Aided Kinematics and Dynamics, 1989, ch. 9). Their points coincide; or the two points keep no
distance along a direction of the base; or a direction of one body stays perpendicular to a
direction of the other. A new kind is one more row of KINDS.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Kind = Literal[
    "revolute",
    "spherical",
    "universal",
    "cylindrical",
    "prismatic",
    "planar",
    "fixed",
    "point-on-line",
]

# Directions of a joint: its axis w; u and v, which form a right-handed frame u, v, w with it; and
# the second axis of a universal joint.
Direction = Literal["u", "v", "w", "second"]


@dataclass(frozen=True)
class Conditions:
    """The conditions of one kind of joint.

    meets: whether the two points coincide.
    along: directions of the base along which the points have no distance, unless `meets`.
    square: pairs of a direction of the base and one of the moving body that stay perpendicular.
    axes: number of directions that the joint needs: 0, 1 or 2.
    angle, travel: whether the joint has an angle about, or a travel along, its axis.
    """

    meets: bool = False
    along: tuple[Direction, ...] = ()
    square: tuple[tuple[Direction, Direction], ...] = ()
    axes: int = 0
    angle: bool = False
    travel: bool = False

    @property
    def count(self) -> int:
        """Number of equations."""
        return 3 * self.meets + len(self.along) + len(self.square)


_PARALLEL: tuple[tuple[Direction, Direction], ...] = (("u", "w"), ("v", "w"))
_LOCKED: tuple[tuple[Direction, Direction], ...] = (("u", "v"), ("v", "w"), ("w", "u"))

KINDS: dict[Kind, Conditions] = {
    "revolute": Conditions(meets=True, square=_PARALLEL, axes=1, angle=True),
    "spherical": Conditions(meets=True),
    "universal": Conditions(meets=True, square=(("w", "second"),), axes=2),
    "cylindrical": Conditions(along=("u", "v"), square=_PARALLEL, axes=1, angle=True, travel=True),
    "prismatic": Conditions(along=("u", "v"), square=_LOCKED, axes=1, travel=True),
    "planar": Conditions(along=("w",), square=_PARALLEL, axes=1),
    "fixed": Conditions(meets=True, square=_LOCKED),
    "point-on-line": Conditions(along=("u", "v"), axes=1),
}

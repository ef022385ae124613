"""Positions in which a linkage cannot follow its drives: dead points, change points, open loops.

In such a position the loop equations lose rank. The right null vector shows which bodies can still
move while the drives are locked; the left one shows which forces are unbounded. If the drive's
force is among these, the position is a dead point, past which the drive cannot go; otherwise it is
a change point, at which two branches cross.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from loads.linkage.linkage import LinkageError
from loads.motion.equations import Equations
from pinbase.arrays import Floats

Kind = Literal["dead point", "change point", "open"]
KIND_CODES: dict[Kind, str] = {
    "dead point": "dead-point",
    "change point": "change-point",
    "open": "does-not-close",
}
# Relative to the fastest body: near a dead point, a slower body counts as at rest.
SNAP_SPEED_RATIO = 1e-2
AS_DRAWN = 1e-3  # fraction of the way of a drive, up to which the linkage counts as not moved
MAX_LISTED_NAMES = 6  # largest number of names in a list in a message
Show = Callable[[float, bool], str]


def in_si(value: float, slides: bool) -> str:
    """A drive's value as text, in m (`slides`) or degrees. value: m or rad."""
    return f"{value:.6g} m" if slides else f"{np.degrees(value):.6g} deg"


def _listed(names: tuple[str, ...]) -> str:
    """The names as text; if there are many, the first names and the number of the others."""
    if len(names) <= MAX_LISTED_NAMES:
        return ", ".join(names)
    return (
        f"{', '.join(names[: MAX_LISTED_NAMES - 1])} and {len(names) - MAX_LISTED_NAMES + 1} more"
    )


class MotionBlocked(LinkageError):
    """The linkage cannot follow its drives.

    kind: kind of the position that blocks the motion.
    reached, wanted: (D,) values of the drives, m or rad.
    bodies: names of the bodies that can move there with the drives locked.
    connections: names of the connections whose forces are unbounded there; for loops that stay
    open, of the members that do not meet.
    gap: largest distance by which these members miss each other, m; 0 where only teeth do not meet.
    """

    def __init__(
        self,
        equations: Equations,
        kind: Kind,
        reached: Floats,
        wanted: Floats,
        bodies: tuple[str, ...],
        connections: tuple[str, ...],
        gap: float = 0.0,
    ) -> None:
        self.kind, self.gap = kind, gap
        self.driven, self.closing_conditions = (
            equations.linkage.driven,
            equations.closing_conditions,
        )
        self.along_lengths, self.drawn = equations.along_lengths, equations.drawn_drives
        self.reached, self.wanted = reached, wanted
        self.bodies, self.connections = bodies, connections
        super().__init__(self.message(), KIND_CODES[kind])

    def message(self, show: Show = in_si) -> str:
        """The message: what is wrong and what to do.

        show: formats a drive's value; its second argument tells lengths (true) from angles.
        """

        def at(values: Floats) -> str:
            named = zip(self.driven, values, self.along_lengths, strict=True)
            return ", ".join(f"{name} = {show(float(v), s)}" for name, v, s in named)

        bodies, connections = _listed(self.bodies), _listed(self.connections)
        if self.kind == "open":
            apart = f" (at best {show(self.gap, True)} apart)" if self.gap else ""
            what = "".join(f" or {decides}" for decides, _ in self.closing_conditions)
            where = "".join(f" and {described}" for _, described in self.closing_conditions)
            moved = np.abs(self.reached - self.drawn) > AS_DRAWN * np.abs(self.wanted - self.drawn)
            beyond = f"does not close beyond {at(self.reached)}"
            if not moved.any():
                beyond = f"closes only as drawn, at {at(self.drawn)}"
            return (
                f"the linkage {beyond} (requested: "
                f"{at(self.wanted)}): {connections} do not meet{apart}, because the lengths of its "
                f"redundant links{what} are inconsistent; check the coordinates of the joints"
                f"{where}"
            )
        unbounded = f"the forces at {connections} are unbounded"
        if self.kind == "change point":
            return (
                f"change point at {at(self.reached)}: there {bodies} can move either way with the "
                f"drive locked, and {unbounded}; keep the drive on one side of it, or add the link "
                "that guides them"
            )
        return (
            f"dead point at {at(self.reached)} (requested: {at(self.wanted)}; as drawn: "
            f"{at(self.drawn)}): the linkage cannot be driven further, {bodies} would snap "
            f"through, and {unbounded}; stop the drive before it, drive another body, or check the "
            "coordinates of the joints"
        )


def motion_blocked(
    equations: Equations, q: Floats, reached: Floats, wanted: Floats, opened: Floats | None = None
) -> MotionBlocked:
    """The error of a motion that is blocked near coordinates q (n,).

    reached, wanted: (D,) values of the drives, m or rad.
    opened: (n,) coordinates at which loops stay open, if open loops block the motion.
    """
    if opened is not None:
        names, gap = equations.apart(opened, reached)
        return MotionBlocked(equations, "open", reached, wanted, (), names, gap)
    pose = equations.pose(q[None])
    left, _, right = np.linalg.svd(equations.jacobian(pose)[0])
    last = equations.columns - 1
    force, motion = left[:, last], right[last]
    drives = len(reached)
    # At a dead point the drive force is unbounded too; at a change point it is not.
    unbounded = float(np.abs(force[len(force) - drives :]).max(initial=0.0)) > 1e-3
    kind: Kind = "dead point" if unbounded else "change point"
    return MotionBlocked(
        equations,
        kind,
        reached,
        wanted,
        equations.moving(pose, motion[None] / equations.scale, SNAP_SPEED_RATIO),
        equations.stressed(pose, force[:, None]),
    )

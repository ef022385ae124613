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

from loads.linkage.linkage import Linkage, LinkageError, Slider
from loads.motion.loop_equations import Loops
from loads.motion.mobility import moving_bodies, stressed_connections
from pinbase.arrays import Floats

Kind = Literal["dead point", "change point", "open"]
KIND_CODES: dict[Kind, str] = {
    "dead point": "dead-point",
    "change point": "change-point",
    "open": "does-not-close",
}
SNAP_SPEED_RATIO = 1e-2  # of the fastest body: near a dead point, a slower one counts as at rest
MAX_LISTED_NAMES = 6  # in a message
Show = Callable[[float, bool], str]


def in_si(value: float, slides: bool) -> str:
    """A drive's value as text, in m (`slides`) or degrees. value: m or rad."""
    return f"{value:.6g} m" if slides else f"{np.degrees(value):.6g} deg"


def _listed(names: tuple[str, ...]) -> str:
    """The names as text; of many, the first ones and the number of the others."""
    if len(names) <= MAX_LISTED_NAMES:
        return ", ".join(names)
    return (
        f"{', '.join(names[: MAX_LISTED_NAMES - 1])} and {len(names) - MAX_LISTED_NAMES + 1} more"
    )


class MotionBlocked(LinkageError):
    """The linkage cannot follow its drives.

    kind: of the position that prevents it.
    reached, wanted: (D,) values of the drives, m or rad.
    bodies: that can move there with the drives locked.
    connections: whose forces are unbounded there; for loops that stay open, those that do not meet.
    gap: the largest distance by which these miss each other, m; 0 where only teeth do.
    """

    def __init__(
        self,
        linkage: Linkage,
        kind: Kind,
        reached: Floats,
        wanted: Floats,
        bodies: tuple[str, ...],
        connections: tuple[str, ...],
        gap: float = 0.0,
    ) -> None:
        self.linkage, self.kind, self.gap = linkage, kind, gap
        self.reached, self.wanted = reached, wanted
        self.bodies, self.connections = bodies, connections
        super().__init__(self.message(), KIND_CODES[kind])

    def message(self, show: Show = in_si) -> str:
        """The message: what is wrong and what to do. show: formats a drive's value."""
        slides = [isinstance(d, Slider) for d in self.linkage.drives]

        def at(values: Floats) -> str:
            named = zip(self.linkage.driven, values, slides, strict=True)
            return ", ".join(f"{name} = {show(float(v), s)}" for name, v, s in named)

        bodies, connections = _listed(self.bodies), _listed(self.connections)
        if self.kind == "open":
            toothed = bool(self.linkage.teeth)
            apart = f" (at best {show(self.gap, True)} apart)" if self.gap else ""
            return (
                f"the linkage does not close beyond {at(self.reached)} (requested: "
                f"{at(self.wanted)}): {connections} do not meet{apart}, because the lengths of its "
                f"redundant links{' or the ratios of its gears' * toothed} are inconsistent; check "
                f"the coordinates of the joints{' and the gears' * toothed}"
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
            f"{at(np.array([d.drawn for d in self.linkage.drives]))}): the linkage cannot be "
            f"driven further, {bodies} would snap through, and {unbounded}; stop the drive before "
            "it, drive another body, or check the coordinates of the joints"
        )


def motion_blocked(
    loops: Loops, q: Floats, reached: Floats, wanted: Floats, opened: Floats | None = None
) -> MotionBlocked:
    """The error of a motion that is blocked near coordinates q (n,).

    reached, wanted: (D,) values of the drives, m or rad.
    opened: (n,) coordinates at which loops stay open, if that is what blocks it.
    """
    if opened is not None:
        pose = loops.pose(opened[None])
        lag = loops.residual(opened[None], pose, reached[None])[0, 2 * len(loops.closing) :]
        teeth = loops.linkage.teeth
        apart = np.abs(loops.place(pose, loops.gaps)[0])
        gap = np.abs([*apart, *lag[: len(teeth)]])
        members = [
            loops.linkage.sliders[k].name if slides else loops.linkage.connections[k][1].name
            for slides, k in loops.closing
        ]
        members += [t.name for t in teeth]
        names = tuple(n for n, g in zip(members, gap, strict=True) if g > 0.1 * gap.max())
        largest = float(apart.max(initial=0.0))
        return MotionBlocked(loops.linkage, "open", reached, wanted, (), names, largest)
    pose = loops.pose(q[None])
    left, _, right = np.linalg.svd(loops.jacobian(pose)[0])
    last = loops.columns - 1
    force, motion = left[:, last], right[last]
    drives = len(loops.linkage.driven)
    # At a dead point the drive force is unbounded too; at a change point it is not.
    unbounded = float(np.abs(force[len(force) - drives :]).max(initial=0.0)) > 1e-3
    kind: Kind = "dead point" if unbounded else "change point"
    return MotionBlocked(
        loops.linkage,
        kind,
        reached,
        wanted,
        moving_bodies(loops, pose, motion[None] / loops.scale, SNAP_SPEED_RATIO),
        stressed_connections(loops, pose, force[:, None]),
    )

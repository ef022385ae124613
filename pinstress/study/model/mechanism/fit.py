"""Joints moved within the tolerance of a drawing, so that redundant links close (`fit_within`)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from loads import Linkage, LinkageError
from loads.motion.least_movement import Draw, LeastMovement, least_movement
from pinstress.study.model.mechanism.joint_layout import Point
from pinstress.study.schema.mechanism import MechanismTable

MAX_OFFERED_RATIO = 0.05  # of a movement to the linkage's size; a larger one is not a tolerance
MAX_LISTED_JOINTS = 8
NEGLIGIBLE_RATIO = 1e-3  # of a movement to the largest one; smaller ones are listed as zero
Show = Callable[[float], str]


@dataclass(frozen=True)
class Fitting:
    """A linkage as drawn, and a function that draws it with its joints at other positions.

    reach: least and largest value of every drive, in SI units.
    """

    linkage: Linkage
    reach: tuple[tuple[float, float], ...]
    draw: Draw = field(compare=False)

    @property
    def at(self) -> Mapping[str, Point]:
        """The positions of the joints as drawn, m."""
        return {joint.name: joint.at for joint in self.linkage.joints}

    def fitted(self, within: float | None, show: Show) -> Linkage:
        """Return the linkage with its joints moved so that its loops close in motion.

        within: the largest movement of a joint, m; None leaves the linkage as drawn.

        Raises: LinkageError if a joint would have to be moved farther.
        """
        if within is None:
            return self.linkage
        movement = least(self)
        if movement is None:
            raise LinkageError(
                "no small movement of the joints was found by which the loops close in motion; "
                "check the coordinates of the joints, or remove fit_within",
                "does-not-close",
                ("fit_within",),
            )
        if movement.largest > within:
            raise LinkageError(
                f"the loops close in motion if the joints move by up to {show(movement.largest)}, "
                f"more than fit_within = {show(within)}: {_listed(movement, show)}; check the "
                "coordinates of the joints, or increase fit_within",
                "does-not-close",
                ("fit_within",),
            )
        if not movement.largest:
            return self.linkage
        places = {n: (x + movement.moves[n][0], y + movement.moves[n][1])
                  for n, (x, y) in self.at.items()}  # fmt: skip
        return self.draw(places)

    def note(self, show: Show) -> tuple[str, ...]:
        """Return a sentence on the joints that are moved; empty if no joint is."""
        movement = least(self)
        if movement is None or not movement.largest:
            return ()
        return (
            f"Joints are moved so that {' and '.join(movement.members)}, which miss each other by "
            f"up to {show(movement.gap)} in motion, meet (fit_within): {_listed(movement, show)}.",
        )

    def offer(self, show: Show, unit: float) -> str:
        """Return by how much the loops miss, and the movement that would close them; empty if they
        close, or no small movement closes them.

        unit: of lengths, m.
        """
        try:
            movement = least(self)
        except LinkageError:
            return ""
        largest = 0.0 if movement is None else movement.largest
        if movement is None or not 0.0 < largest <= MAX_OFFERED_RATIO * self.linkage.length_scale:
            return ""
        step = 10.0 ** (math.floor(math.log10(largest / unit)) - 1)
        enough = math.ceil(1.0001 * largest / unit / step) * step
        return (
            f". In motion {' and '.join(movement.members)} miss each other by up to "
            f"{show(movement.gap)}; they meet if the joints move by up to {show(largest)}: "
            f"fit_within = {enough:.6g} in [mechanism]"
        )


def reach(mechanism: MechanismTable, linkage: Linkage) -> tuple[tuple[float, float], ...]:
    """Return the least and largest value of every drive, as drawn and at its ends, in SI units."""
    ends = []
    for table, drawn in zip(mechanism.drive, linkage.drives, strict=True):
        values = [x for x in (drawn.drawn, table.start, table.end) if x is not None]
        ends.append((min(values), max(values)))
    return tuple(ends)


@lru_cache(maxsize=16)
def least(fitting: Fitting) -> LeastMovement | None:
    """Return the least movement of the joints by which the loops close, or None if none is
    found.
    """
    ends = np.array(fitting.reach).reshape(-1, 2)
    return least_movement(fitting.draw, fitting.at, (ends[:, 0], ends[:, 1]))


def _listed(movement: LeastMovement, show: Show) -> str:
    """Return the joints and their movements, the largest first."""
    least_shown = NEGLIGIBLE_RATIO * movement.largest
    sizes = {name: math.hypot(*move) for name, move in movement.moves.items()}
    names = sorted((n for n in sizes if sizes[n] > least_shown), key=lambda n: -sizes[n])
    shown = []
    for name in names[:MAX_LISTED_JOINTS]:
        x, y = (show(v if abs(v) > least_shown else 0.0) for v in movement.moves[name])
        shown.append(f"{name} by ({x}, {y})")
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")

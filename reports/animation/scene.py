"""The picture of a linkage in an animation at each frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from reports.animation.frames import PICTURE_WIDTH, Viewport
from reports.data.results import Floats, LinkageMotion, ReactionTable
from reports.format.drawing.svg_labels import label_offsets

MAX_ARROW_LENGTH = 120.0  # arrow
APPLIED_GAP = 9.0  # between the tip of an applied load and its point, at which a joint may be
LABELLED_LENGTH_FACTOR = 1.2  # of an applied load's arrow with the room for its size
BODY_COLOUR_COUNT = 10  # in animation.css
JOINT_LETTER_WIDTH, JOINT_LINE_HEIGHT, JOINT_LABEL_GAP = 7.6, 15.0, 13.0  # of joints' names
MAX_NAME_LETTERS = 14  # of a name on the picture
# Of a slider's shortest and longest length: its cylinder
CYLINDER_SHARE_OF_SHORTEST, CYLINDER_SHARE_OF_LONGEST = 0.85, 0.3
RAIL_OVERHANG = 30.0  # that a rail goes on past the block


@dataclass(frozen=True)
class Slide:
    """A slider, drawn as cylinder and rod (`cylinder` long) or as a block on a fixed `rail`.

    ends: (F, 2, 2), its two ends in every frame. base, moving: the colours of its bodies.
    """

    name: str
    ends: Floats
    cylinder: float
    rail: Floats | None
    angle: float
    base: str
    moving: str

    @property
    def barrel(self) -> Floats:
        """The ends (2, 2) of the cylinder at the first frame."""
        a, b = self.ends[0]
        length = float(np.linalg.norm(b - a))
        part = min(self.cylinder / length, 1.0) if length else 0.0
        return np.stack([a, a + part * (b - a)])

    @property
    def run(self) -> float:
        """The length of the rail."""
        return 0.0 if self.rail is None else float(np.linalg.norm(self.rail[1] - self.rail[0]))


@dataclass(frozen=True)
class Scene:
    """The contents of the picture in F frames, with positions in its own unit, y downwards."""

    motion: LinkageMotion
    instants: NDArray[np.int64]
    table: ReactionTable | None

    @cached_property
    def points(self) -> Floats:
        """The points (N, 2) that must be visible, in the study's unit."""
        motion = self.motion
        single = [b for b, joints in enumerate(motion.links) if len(joints) < 2]
        parts = [motion.joint_position, motion.centre[:, single], *motion.slides.values()]
        parts += [p.position for p in motion.paths.values()]
        box = np.array([[-1.0, -1.0], [1.0, 1.0]])
        parts += [c.ends[:, :1] + c.radius * box if c.round else c.ends for c in motion.pitch]
        return np.concatenate([p.reshape(-1, 2) for p in parts])

    @cached_property
    def size(self) -> float:
        """The size of the linkage, in the study's unit."""
        return float(np.ptp(self.points, axis=0).max()) or 1.0

    @cached_property
    def view(self) -> Viewport:
        # With square-root arrows, which are the longer ones.
        size = np.linalg.norm(self.forces, axis=2, keepdims=True)
        longer = np.sqrt(self.largest / np.where(size > 0.0, size, np.inf))
        arrows = MAX_ARROW_LENGTH * longer * self.forces / (self.largest or 1.0)
        tails = self.motion.joint_position[self.instants][:, self.tails]
        # An applied load ends at its point.
        for load in self.motion.applied:
            size = load.sizes[self.instants, None]
            longer = np.sqrt(self.largest / np.where(size > 0.0, size, np.inf))
            away = -(MAX_ARROW_LENGTH * longer * load.force[self.instants]) / self.largest
            tails = np.concatenate([tails, load.position[self.instants, None]], axis=1)
            arrows = np.concatenate([arrows, away[:, None] * LABELLED_LENGTH_FACTOR], axis=1)
        corners = np.stack([self.points.min(axis=0), self.points.max(axis=0)])
        return Viewport.of(corners, tails.reshape(-1, 2), arrows.reshape(-1, 2))

    @cached_property
    def forces(self) -> Floats:
        """The forces (F, C, 2) on the pins, in the plane of the linkage."""
        if self.table is None:
            return np.zeros((len(self.instants), 0, 2))
        return self.table.forces[self.instants, :, :2]

    @cached_property
    def tails(self) -> list[int]:
        """The index of the joint of each connection of the table."""
        if self.table is None:
            return []
        return [self.motion.joints.index(joint) for _, _, joint in self.motion.connections]

    @cached_property
    def largest(self) -> float:
        """The largest force of all connections, applied loads and instants."""
        sizes = [load.sizes for load in self.motion.applied]
        sizes += [] if self.table is None else [self.table.magnitudes]
        return max((float(np.max(x, initial=0.0)) for x in sizes), default=0.0)

    @cached_property
    def applied(self) -> list[tuple[Floats, Floats]]:
        """The points (F, 2) and the forces (F, 2), y upwards, of the applied loads."""
        loads, at = self.motion.applied, self.instants
        return [(self.view(load.position[at]), load.force[at]) for load in loads]

    @cached_property
    def joints(self) -> Floats:
        """The positions (F, J, 2) of the joints."""
        return self.view(self.motion.joint_position[self.instants])

    @cached_property
    def centres(self) -> Floats:
        """The positions (F, B, 2) of the centres of mass of the bodies."""
        return self.view(self.motion.centre[self.instants])

    @cached_property
    def members(self) -> list[list[int]]:
        """The indices of the joints of each body."""
        index = {name: j for j, name in enumerate(self.motion.joints)}
        return [[index[name] for name in link] for link in self.motion.links]

    def shape(self, body: str) -> Floats:
        """Return the positions (joints, 2) of the joints of a body at the first frame."""
        return self.joints[0, self.members[self.motion.bodies.index(body)]]

    def track(self, joint: str) -> Floats:
        """Return the positions (F, 2) of a joint."""
        return self.joints[:, self.motion.joints.index(joint)]

    @cached_property
    def curves(self) -> dict[str, Floats]:
        """The paths (F, 2) of the named points."""
        return {name: self.view(p.position[self.instants]) for name, p in self.motion.paths.items()}

    @cached_property
    def pitch(self) -> list[tuple[str, Floats, float]]:
        """The colour, the ends (F, 2, 2) and the radius (or 0) of every pitch circle or line."""
        return [
            (
                self.colour(c.body),
                self.view(c.ends[self.instants]),
                c.round * c.radius * self.view.scale,
            )
            for c in self.motion.pitch
        ]

    def named_between(self, body: str) -> list[int] | None:
        """Return the two joints of a body between which its name is farthest from any joint.

        None where the name is too long.
        """
        members = self.members[self.motion.bodies.index(body)]
        at = self.joints[0]

        def clear(pair: Sequence[int]) -> float:
            middle = 0.5 * (at[pair[0]] + at[pair[1]])
            return float(np.linalg.norm(at[members] - middle, axis=1).min())

        pairs = [list(pair) for pair in combinations(members, 2)]
        best = max(pairs, key=clear, default=None)
        return best if best and 2.0 * clear(best) > JOINT_LETTER_WIDTH * len(body) else None

    def colour(self, body: str) -> str:
        """Return the colour class of a body; what is not a body of the linkage is ground."""
        if body not in self.motion.bodies:
            return "ground"
        return f"b{self.motion.bodies.index(body) % BODY_COLOUR_COUNT}"

    @cached_property
    def slides(self) -> list[Slide]:
        return [self._slide(name, ends) for name, ends in self.motion.slides.items()]

    def _slide(self, name: str, all_ends: Floats) -> Slide:
        owners = [self._owner(all_ends[:, k]) for k in range(2)]
        ends = self.view(all_ends[self.instants])
        along = ends[:, 1] - ends[:, 0]
        length = np.linalg.norm(along, axis=1)
        longest = float(length.max())
        cylinder = max(
            CYLINDER_SHARE_OF_SHORTEST * float(length.min()), CYLINDER_SHARE_OF_LONGEST * longest
        )
        straight = along[int(np.argmax(length))] / (longest or 1.0)
        still = len(ends) > 1 and np.ptp(ends[:, 0], axis=0).max() < 0.01
        across = along[:, 0] * straight[1] - along[:, 1] * straight[0]
        rail = None
        if still and np.abs(across).max() < 0.01:
            run = along @ straight
            reach = np.array([run.min() - RAIL_OVERHANG, run.max() + RAIL_OVERHANG])
            rail = ends[0, 0] + reach[:, None] * straight
        angle = float(np.degrees(np.arctan2(straight[1], straight[0])))
        return Slide(name, ends, cylinder, rail, angle, *owners)

    def _owner(self, end: Floats) -> str:
        """Return the colour of the body whose only joint is at this end of a slider."""
        for b, members in enumerate(self.members):
            if len(members) == 1:
                off = self.motion.joint_position[:, members[0]] - end
                if np.abs(off).max() < 1e-6 * self.size:
                    return self.colour(self.motion.bodies[b])
        return "ground" if np.ptp(end, axis=0).max() < 1e-6 * self.size else "plain"

    @cached_property
    def names(self) -> Floats:
        """The offsets (J, 2) from each joint to the middle of its name."""
        wide = [JOINT_LETTER_WIDTH * len(clipped(name)) + 4.0 for name in self.motion.joints]
        few = np.unique(np.linspace(0, len(self.instants) - 1, 12).round().astype(int))
        pairs = [
            (a, b)
            for members in self.members
            for a, b in zip(members, members[1:] + members[:1], strict=True)
            if a != b
        ]
        lines = [self.joints[few][:, list(pair)] for pair in pairs]
        lines += [slide.ends[few] for slide in self.slides]
        inked = np.stack(lines, axis=1) if lines else np.zeros((len(few), 0, 2, 2))
        sizes = np.column_stack([wide, np.full(len(wide), JOINT_LINE_HEIGHT)])
        picture = (PICTURE_WIDTH, self.view.height)
        return label_offsets(self.joints[few], sizes, inked, JOINT_LABEL_GAP, picture)


def clipped(name: str) -> str:
    """Return a name that is short enough for the picture."""
    return name if len(name) <= MAX_NAME_LETTERS else name[: MAX_NAME_LETTERS - 1] + "…"

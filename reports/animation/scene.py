"""The picture of a linkage in each frame of an animation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats
from reports.animation.frames import PICTURE_WIDTH, Viewport
from reports.data.mechanics import ReactionTable
from reports.data.skeleton import Skeleton
from reports.format.drawing.projection import PLANE, Projection, isometric, three_views
from reports.format.drawing.svg_labels import label_offsets
from reports.format.drawing.zigzag import zigzag

MAX_ARROW_LENGTH, MAX_SPACE_ARROW_LENGTH = 120.0, 80.0  # shorter in space, to save room
APPLIED_GAP = 9.0  # between the tip of an applied load and its point, where a joint may be
LABELLED_LENGTH_FACTOR = 1.2  # arrow of an applied load with its label, over the arrow alone
AXIS_REACH, PIN_REACH = 34.0, 20.0  # half lengths of the axis of a joint and of its pin
BODY_COLOUR_COUNT = 10  # in animation.css
JOINT_LETTER_WIDTH, JOINT_LINE_HEIGHT, JOINT_LABEL_GAP = 7.6, 15.0, 13.0  # of the names of joints
MAX_NAME_LETTERS = 14  # longer names are clipped on the picture
# Length of the cylinder of a slider over its shortest and its longest length
CYLINDER_SHARE_OF_SHORTEST, CYLINDER_SHARE_OF_LONGEST = 0.85, 0.3
SPRING_HALF_WIDTH = 7.0  # also in animation.js
RAIL_OVERHANG = 30.0  # of a rail beyond the extreme positions of the block


@dataclass(frozen=True)
class Slide:
    """A slider, drawn as cylinder (`cylinder` long) and rod, or as a block on a fixed `rail`.

    ends: (F, 2, 2), its two ends in every frame.
    base, moving: the colours of its bodies.
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
    """The contents of the picture in F frames; positions are in picture units, y downwards.

    instants: the instant of each frame.
    table: the forces at the connections of the linkage; None if not known.
    """

    skeleton: Skeleton
    instants: NDArray[np.int64]
    table: ReactionTable | None

    @cached_property
    def points(self) -> Floats:
        """The points (N, 3) that must be visible, in the study's unit."""
        skeleton = self.skeleton
        single = [b for b, joints in enumerate(skeleton.links) if len(joints) < 2]
        parts = [skeleton.position, skeleton.centre[:, single], *skeleton.slides.values()]
        parts += [*skeleton.springs.values(), *skeleton.paths.values()]
        box = np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]])
        parts += [c.ends[:, :1] + c.radius * box if c.round else c.ends for c in skeleton.pitch]
        return np.concatenate([p.reshape(-1, 3) for p in parts])

    @cached_property
    def size(self) -> float:
        """The size of the linkage, in the study's unit."""
        return float(np.ptp(self.points, axis=0).max()) or 1.0

    @cached_property
    def projection(self) -> Projection:
        """The initial view of the picture."""
        return PLANE if self.skeleton.flat else isometric(self.skeleton.up)

    def seen(self, points: Floats) -> Floats:
        """Return the positions (..., 2) of points (..., 3) on the picture in its initial view."""
        return self.view(self.projection(points))

    @cached_property
    def middle(self) -> Floats:
        """The point (3,) about which the picture of a linkage in space turns."""
        return np.asarray(0.5 * (self.points.min(axis=0) + self.points.max(axis=0)))

    def placed(self, points: Floats) -> Floats:
        """Return points (..., 3) as the script needs them: on the picture (..., 2), or for a
        linkage in space relative to the middle (..., 3), in picture units.
        """
        if self.skeleton.flat:
            return self.seen(points)
        return np.asarray(self.view.scale * (points - self.middle))

    @cached_property
    def view(self) -> Viewport:
        # Room for arrows on a square-root scale, which are the longer ones.
        size = np.linalg.norm(self.forces, axis=2, keepdims=True)
        longer = np.sqrt(self.largest / np.where(size > 0.0, size, np.inf))
        arrows = self.longest * longer * self.forces / (self.largest or 1.0)
        tails = self.skeleton.position[self.instants][:, self.tails]
        # The arrow of an applied load ends at its point.
        for load in self.skeleton.applied:
            size = load.sizes[self.instants, None]
            longer = np.sqrt(self.largest / np.where(size > 0.0, size, np.inf))
            away = -(self.longest * longer * load.force[self.instants]) / self.largest
            tails = np.concatenate([tails, load.position[self.instants, None]], axis=1)
            arrows = np.concatenate([arrows, away[:, None] * LABELLED_LENGTH_FACTOR], axis=1)
        for couple in self.skeleton.couples:
            part = np.sqrt(couple.sizes[self.instants, None] / self.largest_couple)
            unit = couple.couple[self.instants] / np.maximum(
                couple.sizes[self.instants, None], 1e-300
            )
            tails = np.concatenate([tails, couple.position[self.instants, None]], axis=1)
            away = -self.longest * LABELLED_LENGTH_FACTOR * part * unit
            arrows = np.concatenate([arrows, away[:, None]], axis=1)
        tails, arrows = tails.reshape(-1, 3), arrows.reshape(-1, 3)
        if not self.skeleton.flat:
            views = (self.projection, *three_views(self.skeleton.up))
            return Viewport.turning(self.points, tails, arrows, views)
        corners = np.stack([self.points.min(axis=0), self.points.max(axis=0)])
        return Viewport.of(PLANE(corners), PLANE(tails), PLANE(arrows))

    @cached_property
    def forces(self) -> Floats:
        """The forces (F, C, 3) on the pins; for a planar linkage without the component across its
        plane.
        """
        if self.table is None:
            return np.zeros((len(self.instants), 0, 3))
        forces = self.table.forces[self.instants]
        return forces * [1.0, 1.0, 0.0] if self.skeleton.flat else forces

    @property
    def longest(self) -> float:
        """The length of the arrow of the largest force."""
        return MAX_ARROW_LENGTH if self.skeleton.flat else MAX_SPACE_ARROW_LENGTH

    @cached_property
    def tails(self) -> list[int]:
        """The index of the joint of each connection of the table."""
        if self.table is None:
            return []
        return [self.skeleton.joints.index(joint) for _, _, joint in self.skeleton.connections]

    @cached_property
    def largest(self) -> float:
        """The largest force of all connections, applied loads and instants."""
        sizes = [load.sizes for load in self.skeleton.applied]
        sizes += [] if self.table is None else [self.table.magnitudes]
        return max((float(np.max(x, initial=0.0)) for x in sizes), default=0.0)

    @cached_property
    def applied(self) -> list[tuple[Floats, Floats]]:
        """The points and the forces, each (F, 3), of the applied loads."""
        loads, at = self.skeleton.applied, self.instants
        return [(load.position[at], load.force[at]) for load in loads]

    @cached_property
    def levers(self) -> list[int | None]:
        """The index of the joint to which each applied load is connected, at the first frame; None
        without one.
        """
        first = self.instants[0]
        return [self.skeleton.lever(load, first) for load in self.skeleton.applied]

    @cached_property
    def couples(self) -> list[tuple[Floats, Floats]]:
        """The points and the couples, each (F, 3), of the applied couples."""
        loads, at = self.skeleton.couples, self.instants
        return [(load.position[at], load.couple[at]) for load in loads]

    @cached_property
    def largest_couple(self) -> float:
        """The largest applied couple of all instants."""
        return max((float(load.sizes.max()) for load in self.skeleton.couples), default=0.0)

    @cached_property
    def joints(self) -> Floats:
        """The positions (F, J, 2) of the joints."""
        return self.seen(self.skeleton.position[self.instants])

    @cached_property
    def centres(self) -> Floats:
        """The positions (F, B, 2) of the centres of mass of the bodies."""
        return self.seen(self.skeleton.centre[self.instants])

    @cached_property
    def members(self) -> list[list[int]]:
        """The indices of the joints of each body."""
        index = {name: j for j, name in enumerate(self.skeleton.joints)}
        return [[index[name] for name in link] for link in self.skeleton.links]

    def shape(self, body: str) -> Floats:
        """Return the positions (N, 2) of the joints of a body at the first frame, followed by its
        centre of mass if the body is drawn up to it.
        """
        b = self.skeleton.bodies.index(body)
        stem = self.centres[0, [b]] if body in self.skeleton.stems else np.zeros((0, 2))
        return np.concatenate([self.joints[0, self.members[b]], stem])

    def track(self, joint: str) -> Floats:
        """Return the positions (F, 2) of a joint."""
        return self.joints[:, self.skeleton.joints.index(joint)]

    @cached_property
    def curves(self) -> dict[str, Floats]:
        """The paths (F, 2) of the named points."""
        return {name: self.seen(path[self.instants]) for name, path in self.skeleton.paths.items()}

    @cached_property
    def pitch(self) -> list[tuple[str, Floats, float]]:
        """The colour, the ends (F, 2, 2) and the radius of every pitch curve; the radius of a line
        is 0.
        """
        return [
            (
                self.colour(c.body),
                self.seen(c.ends[self.instants]),
                c.round * c.radius * self.view.scale,
            )
            for c in self.skeleton.pitch
        ]

    def named_between(self, body: str) -> list[int] | None:
        """Return the two joints of a body between which its name is farthest from any joint; None
        where the name is too long.
        """
        members = self.members[self.skeleton.bodies.index(body)]
        at = self.joints[0]

        def clear(pair: Sequence[int]) -> float:
            middle = 0.5 * (at[pair[0]] + at[pair[1]])
            return float(np.linalg.norm(at[members] - middle, axis=1).min())

        pairs = [list(pair) for pair in combinations(members, 2)]
        best = max(pairs, key=clear, default=None)
        return best if best and 2.0 * clear(best) > JOINT_LETTER_WIDTH * len(body) else None

    def colour(self, body: str) -> str:
        """Return the colour class of a body; "ground" for anything that is not a body of the
        linkage.
        """
        if body not in self.skeleton.bodies:
            return "ground"
        return f"b{self.skeleton.bodies.index(body) % BODY_COLOUR_COUNT}"

    @cached_property
    def springs(self) -> dict[str, Floats]:
        """The ends (F, 2, 2) of every spring between two points."""
        return {n: self.seen(ends[self.instants]) for n, ends in self.skeleton.springs.items()}

    @property
    def zigzags(self) -> dict[str, Floats]:
        """The corners (N, 2) of these springs at the first frame."""
        return {n: zigzag(ends[0], SPRING_HALF_WIDTH) for n, ends in self.springs.items()}

    @cached_property
    def slides(self) -> list[Slide]:
        return [self._slide(name, ends) for name, ends in self.skeleton.slides.items()]

    def _slide(self, name: str, all_ends: Floats) -> Slide:
        owners = [self._owner(all_ends[:, k]) for k in range(2)]
        ends = self.seen(all_ends[self.instants])
        along = ends[:, 1] - ends[:, 0]
        true = self.placed(all_ends[self.instants])
        length = np.linalg.norm(true[:, 1] - true[:, 0], axis=1)
        longest = float(length.max())
        cylinder = max(
            CYLINDER_SHARE_OF_SHORTEST * float(length.min()), CYLINDER_SHARE_OF_LONGEST * longest
        )
        straight = along[int(np.argmax(length))] / (longest or 1.0)
        still = self.skeleton.flat and len(ends) > 1 and np.ptp(ends[:, 0], axis=0).max() < 0.01
        across = along[:, 0] * straight[1] - along[:, 1] * straight[0]
        rail = None
        if still and np.abs(across).max() < 0.01:
            run = along @ straight
            reach = np.array([run.min() - RAIL_OVERHANG, run.max() + RAIL_OVERHANG])
            rail = ends[0, 0] + reach[:, None] * straight
        angle = float(np.degrees(np.arctan2(straight[1], straight[0])))
        return Slide(name, ends, cylinder, rail, angle, *owners)

    def _owner(self, end: Floats) -> str:
        """Return the colour of the body whose only joint is at this end of a slider.

        A fixed end without such a body has the colour of the ground.
        """
        for b, members in enumerate(self.members):
            if len(members) == 1:
                off = self.skeleton.position[:, members[0]] - end
                if np.abs(off).max() < 1e-6 * self.size:
                    return self.colour(self.skeleton.bodies[b])
        return "ground" if np.ptp(end, axis=0).max() < 1e-6 * self.size else "plain"

    @cached_property
    def names(self) -> Floats:
        """The offsets (J, 2) from each joint to the middle of its name."""
        few = np.unique(np.linspace(0, len(self.instants) - 1, 12).round().astype(int))
        pairs = [
            (a, b)
            for members in self.members
            for a, b in zip(members, members[1:] + members[:1], strict=True)
            if a != b
        ]
        lines = [self.joints[few][:, list(pair)] for pair in pairs]
        lines += [slide.ends[few] for slide in self.slides]
        lines += [ends[few] for ends in self.springs.values()]
        inked = np.stack(lines, axis=1) if lines else np.zeros((len(few), 0, 2, 2))
        picture = (PICTURE_WIDTH, self.view.height)
        return label_offsets(self.joints[few], self.name_sizes, inked, JOINT_LABEL_GAP, picture)

    @cached_property
    def name_sizes(self) -> Floats:
        """The width and the height (J, 2) of the name of each joint."""
        wide = [JOINT_LETTER_WIDTH * len(clipped(name)) + 4.0 for name in self.skeleton.joints]
        return np.column_stack([wide, np.full(len(wide), JOINT_LINE_HEIGHT)])

    @property
    def axes(self) -> str:
        """The names of the axes of the picture, "xy" or "xyz"."""
        return "xy" if self.skeleton.flat else "xyz"


def clipped(name: str) -> str:
    """Return a name, shortened to fit the picture."""
    return name if len(name) <= MAX_NAME_LETTERS else name[: MAX_NAME_LETTERS - 1] + "…"

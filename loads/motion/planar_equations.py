"""The equations of a planar linkage, with the names of members that move, carry load or gape."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from loads.linkage.linkage import Linkage
from loads.linkage.parts import GROUND, Slider
from loads.motion.complex_points import Pose
from loads.motion.equations import CLOSING_GEARS, MIN_PARTICIPATION
from loads.motion.joint_forces import connection_members, slider_members
from loads.motion.loop_equations import Loops
from pinbase.arrays import Floats


class PlanarEquations(Loops):
    """The loop and drive equations of a planar linkage, as `Equations`."""

    @property
    def along_lengths(self) -> tuple[bool, ...]:
        """Whether each drive moves along a length; otherwise it turns an angle."""
        return tuple(isinstance(d, Slider) for d in self.linkage.drives)

    @property
    def closing_conditions(self) -> tuple[tuple[str, str], ...]:
        """Pairs (condition, input to check): what redundant links need to close besides lengths."""
        return CLOSING_GEARS * bool(self.linkage.teeth)

    @cached_property
    def kutzbach(self) -> int:
        """Degrees of freedom by Kutzbach: 3 (links - 1) - 2 (pins and sliders) - pairs of teeth.

        A pin at which k links meet counts k - 1 times. Particles do not count. Welded bodies are
        one link.
        """
        linkage = self.linkage
        names = [b.name for b in linkage.bodies if not is_particle(linkage, b.name)] + [GROUND]
        link = {name: linkage.rigid[name][0] for name in names}
        pins = 0
        for joint in linkage.joints:
            meeting = (*(c.body for c in joint.connections), joint.fixed_in or "")
            pins += max(len({link[name] for name in meeting if name in link}) - 1, 0)
        links = len({*link.values()})
        return 3 * (links - 1) - 2 * (pins + len(linkage.sliders)) - len(linkage.teeth)

    def moving(
        self, pose: Pose, rates: Floats, least: float = MIN_PARTICIPATION
    ) -> tuple[str, ...]:
        """Names of the bodies that move in any of k motions.

        pose: pose of a single instant. rates: (k, n) rates of the coordinates.
        least: speed above which a body moves, relative to the fastest body.
        """
        if not len(rates):
            return ()
        linkage, angles = self.linkage, self.frames - 1
        slopes = self.partials(pose, self.centres)[0]
        speed = np.abs(rates @ slopes)[:, : len(linkage.bodies)]
        for i, body in enumerate(linkage.bodies):
            f = self.frame[i]
            if f and body.inertia is not None and f <= angles:
                speed[:, i] += linkage.length_scale * np.abs(rates[:, f - 1])
        largest = speed.max(axis=0)
        named = zip(linkage.bodies, largest, strict=True)
        return tuple(b.name for b, v in named if v > least * largest.max())

    def advice(self, pose: Pose, rates: Floats) -> str:
        """No advice (""): in the plane any connections or drives, as many as needed, would do."""
        return ""

    def stressed(self, pose: Pose, multipliers: Floats) -> tuple[str, ...]:
        """Names of the connections and teeth that carry any of k self-equilibrated sets of forces.

        Sliders are named only where no connection or teeth carry any.
        pose: pose of a single instant. multipliers: (rows, k), unit vectors.
        """
        closing = self.closing_forces(pose, multipliers.T)
        if not closing.size:
            return ()
        no_forces = np.zeros((len(closing), len(self.linkage.items)), dtype=complex)
        pins, sliders = (
            m.forces(no_forces, closing) for m in (connection_members(self), slider_members(self))
        )
        size = np.abs(np.hstack([pins, closing[:, len(self.closing) :]])).max(axis=0)
        names = [name for name, _ in self.linkage.forces]
        if size.max() <= MIN_PARTICIPATION:
            size, names = np.abs(sliders).max(axis=0), [s.name for s in self.linkage.sliders]
        return tuple(
            n for n, f in zip(names, size, strict=True) if f > MIN_PARTICIPATION * size.max()
        )

    def apart(self, q: Floats, drives: Floats) -> tuple[tuple[str, ...], float]:
        """Names of the members that do not meet at coordinates q (n,), and the largest gap, m.

        drives: (D,) values of the drives, m or rad. Teeth out of step are named, but have no gap.
        """
        pose = self.pose(q[None])
        teeth = self.linkage.teeth
        lag = self.residual(q[None], pose, drives[None])[0, 2 * len(self.closing) :]
        apart = np.abs(self.place(pose, self.gaps)[0])
        gap = np.abs([*apart, *lag[: len(teeth)]])
        members = [
            self.linkage.sliders[k].name if slides else self.linkage.connections[k][1].name
            for slides, k in self.closing
        ]
        members += [t.name for t in teeth]
        names = tuple(n for n, g in zip(members, gap, strict=True) if g > 0.1 * gap.max())
        return names, float(apart.max(initial=0.0))


def is_particle(linkage: Linkage, name: str) -> bool:
    """Whether a body is a particle: it has no inertia and is not part of a slider."""
    body = next(b for b in linkage.bodies if b.name == name)
    slides = any(name in (s.base, s.moving) for s in linkage.sliders)
    return body.inertia is None and not slides

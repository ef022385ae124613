"""The skeleton of a linkage in space: the parts of a motion that drawings and animations show."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from pinbase.dimensions import Floats, Lengths, Moments, Times
from reports.data.motion import AppliedForce, LinkageMotion, PitchCurve

Vector = tuple[float, float, float]
MIN_LEVER = 1e-6  # of the linkage's size; a smaller distance from load to joint is round-off


@dataclass(frozen=True)
class AppliedCouple:
    """A couple that a case applies to a body, in world axes.

    position: the point (T, 3) at which the couple is drawn.
    couple: (T, 3).
    """

    body: str
    position: Lengths
    couple: Moments

    @cached_property
    def sizes(self) -> Floats:
        """The magnitudes (T,) of the couple."""
        return np.asarray(np.linalg.norm(self.couple, axis=1))


@dataclass(frozen=True)
class Skeleton:
    """The bodies, joints and loads of a linkage at T instants (one, without time, at rest).

    links: for each of B bodies the joints on it, in drawing order.
    centre: (T, B, 3), of mass.
    stems: bodies that are drawn from their only joint to their centre of mass.
    joints: J names. ground: joints that are fixed. position: (T, J, 3).
    axes: (T, J, 3), unit vectors along the pins; zero where a joint has no axis.
    slides: by slider, its two ends (T, 2, 3). springs: by spring between two points, likewise.
    connections: (name, body, joint) in the order of the case's ReactionTable.
    paths: of named points, (T, 3). applied, couples: the case's loads, (T, 3).
    aside: the loads across the plane of a planar linkage.
    pitch: curves of gears and racks, (T, 2, 3), in the x-y plane.
    up: the vertical of the drawings, along one of the axes.
    flat: whether everything lies in the x-y plane, which is then the plane of the drawings.
    """

    case: str
    time: Times | None
    bodies: tuple[str, ...]
    links: tuple[tuple[str, ...], ...]
    centre: Lengths
    joints: tuple[str, ...]
    ground: tuple[str, ...]
    position: Lengths
    axes: Floats
    connections: tuple[tuple[str, str, str], ...]
    stems: tuple[str, ...] = ()
    slides: dict[str, Lengths] = field(default_factory=dict)
    springs: dict[str, Lengths] = field(default_factory=dict)
    paths: dict[str, Lengths] = field(default_factory=dict)
    applied: tuple[AppliedForce, ...] = ()
    couples: tuple[AppliedCouple, ...] = ()
    aside: tuple[AppliedForce, ...] = ()
    pitch: tuple[PitchCurve, ...] = ()
    up: Vector = (0.0, 0.0, 1.0)
    flat: bool = False

    @property
    def loads(self) -> tuple[AppliedForce | AppliedCouple, ...]:
        """The forces, then the couples."""
        return (*self.forces, *self.couples)

    @property
    def forces(self) -> tuple[AppliedForce, ...]:
        """The forces; those across the plane come last."""
        return (*self.applied, *self.aside)

    def lever(self, load: AppliedForce, k: int) -> int | None:
        """Return the index of the joint on the loaded body that is nearest to a force at instant k,
        to which the force is drawn connected.

        The result is None for a force at a joint, and for a force on a floating pin, which is not
        drawn as a body.
        """
        on_body = self.links[self.bodies.index(load.body)] if load.body in self.bodies else ()
        joints, places = [self.joints.index(name) for name in on_body], self.position[k]
        acting = load.position[min(k, len(load.position) - 1)]
        away = {j: float(np.linalg.norm(places[j] - acting)) for j in joints}
        nearest = min(away, key=away.__getitem__, default=None)
        if nearest is None or away[nearest] <= MIN_LEVER * np.ptp(places, axis=0).max():
            return None
        return nearest


def planar_skeleton(motion: LinkageMotion) -> Skeleton:
    """Return the skeleton of a planar linkage, which lies at z = 0 with its pins along z."""
    axes = np.zeros((*motion.joint_position.shape[:2], 3))
    axes[..., 2] = 1.0
    return Skeleton(
        case=motion.case,
        time=motion.time,
        bodies=motion.bodies,
        links=motion.links,
        centre=_lifted(motion.centre),
        joints=motion.joints,
        ground=motion.ground,
        position=_lifted(motion.joint_position),
        axes=axes,
        connections=motion.connections,
        slides={name: _lifted(ends) for name, ends in motion.slides.items()},
        springs={name: _lifted(ends) for name, ends in motion.springs.items()},
        paths={name: _lifted(path.position) for name, path in motion.paths.items()},
        applied=tuple(
            replace(load, position=_lifted(load.position), force=_lifted(load.force))
            for load in motion.applied
        ),
        aside=tuple(replace(load, position=_lifted(load.position)) for load in motion.aside),
        pitch=tuple(replace(curve, ends=_lifted(curve.ends)) for curve in motion.pitch),
        up=(0.0, 1.0, 0.0),
        flat=True,
    )


def _lifted(points: Floats) -> Floats:
    """Return points (..., 2) of the plane as points (..., 3) of space."""
    return np.concatenate([points, np.zeros((*points.shape[:-1], 1))], axis=-1)

"""Applied forces, springs and dampers on the bodies of a linkage in space."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from loads.forces.acting import ForceLaw, Switched
from loads.forces.corners import Unsmooth, Varying
from loads.space.linkage import Vector
from loads.space.motion import SpaceMotion
from pinbase.arrays import Floats


@dataclass(frozen=True)
class SpacePush:
    """The action of a load on one body over time, world axes.

    at: point of the body at which the force acts, as drawn, m.
    force: (T, 3) N. couple: (T, 3) N m.
    """

    body: str
    at: Vector
    force: Floats
    couple: Floats


class SpaceLoad(Unsmooth[Varying[SpaceMotion]], Protocol):
    """A load on a linkage in space, known at every instant of a motion."""

    def pushes(self, motion: SpaceMotion) -> Iterator[SpacePush]:
        """The actions of the load on bodies at every instant."""
        ...

    def along_measured(self, motion: SpaceMotion) -> Iterator[tuple[str, Floats]]:
        """Pairs (measured coordinate, force (N) or couple (N m) of the load along it, (T,))."""
        ...


@dataclass(frozen=True)
class Coordinate:
    """A measured coordinate, on which a force can depend."""

    name: str

    def __call__(self, motion: SpaceMotion) -> tuple[Floats, Floats]:
        """Values and rates."""
        value, rate, _ = motion.coordinate(self.name)
        return value, rate


@dataclass(frozen=True)
class SpaceForce(Switched[SpaceMotion]):
    """A force on a point of a body and a couple on the body.

    at: the point, as drawn, m.
    force, couple: N and N m.
    follows: whether both turn with the body (they are then stated as drawn); otherwise their
    directions are fixed in world axes.
    """

    body: str
    at: Vector
    force: Vector = (0.0, 0.0, 0.0)
    couple: Vector = (0.0, 0.0, 0.0)
    follows: bool = False

    def pushes(self, motion: SpaceMotion) -> Iterator[SpacePush]:
        """The force and couple at every instant; at a switch, their values just before it."""
        size = self.size(motion)
        force, couple = (size[:, None] * np.array(v) for v in (self.force, self.couple))
        if self.follows:
            turn = motion.rotation(self.body)
            force, couple = ((turn @ v[..., None])[..., 0] for v in (force, couple))
        yield SpacePush(self.body, self.at, force, couple)

    def along_measured(self, motion: SpaceMotion) -> Iterator[tuple[str, Floats]]:
        """An empty iterator: the force acts on a body."""
        return iter(())


@dataclass(frozen=True)
class SpaceSpring:
    """A spring and damper along a measured coordinate: between two points, along or about a joint.

    A positive force (couple) of its law pushes towards a larger value of the coordinate.
    """

    name: str
    measured: str
    law: ForceLaw
    switches: ClassVar[tuple[float, ...]] = ()  # it always acts

    def pushes(self, motion: SpaceMotion) -> Iterator[SpacePush]:
        """An empty iterator: the force acts along a measured coordinate."""
        return iter(())

    def along_measured(self, motion: SpaceMotion) -> Iterator[tuple[str, Floats]]:
        """The measured coordinate, and the force (N) or couple (N m) along it, (T,)."""
        value, rate, _ = motion.coordinate(self.measured)
        yield self.measured, self.law(value, rate)

    @property
    def kinks(self) -> tuple[Varying[SpaceMotion], ...]:
        """The rows of the law's tables."""
        return self.law.kinks(Coordinate(self.measured))


def power(motion: SpaceMotion, loads: tuple[SpaceLoad, ...]) -> Floats:
    """Power of the loads on the linkage, (T,) W."""
    out = np.zeros(len(motion))
    for load in loads:
        for push in load.pushes(motion):
            _, velocity, _ = motion.point(push.body, push.at)
            out += np.einsum("ti,ti->t", velocity, push.force)
            out += np.einsum("ti,ti->t", motion.spin(push.body), push.couple)
        for name, force in load.along_measured(motion):
            out += force * motion.coordinate(name)[1]
    return out

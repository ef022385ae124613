"""Motion of a linkage: exact positions, velocities, accelerations and energies at every instant."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from loads.constraints import Constraints, constraints, rotated, turned
from loads.linkage import GROUND, Floats, Linkage, Point
from loads.mobility import require_determined
from loads.position import least_squares, positions

Law = Callable[[Floats], tuple[Floats, Floats, Floats]]


@dataclass(frozen=True)
class Motion:
    """States of all items: q, v, a are (T, items + ground, 3) in m, rad, s and world axes.

    times (T,) s. length, speed, rate (T,): the driven slider's length (m, m/s, m/s^2).
    """

    system: Constraints
    times: Floats
    length: Floats
    speed: Floats
    rate: Floats
    q: Floats
    v: Floats
    a: Floats

    @property
    def linkage(self) -> Linkage:
        """The linkage that moves."""
        return self.system.linkage

    def point(self, item: str, drawn: Point) -> tuple[Floats, Floats, Floats]:
        """Position, velocity, acceleration (T, 2) of the item's point at `drawn` (m, as drawn)."""
        i = self.linkage.index[item]
        centre = (0.0, 0.0) if item == GROUND else self.linkage.items[i].centre
        arm = rotated(self.q[:, i, 2], np.subtract(drawn, centre)[None])
        w, alpha = self.v[:, i, 2, None], self.a[:, i, 2, None]
        return (
            self.q[:, i, :2] + arm,
            self.v[:, i, :2] + w * turned(arm),
            self.a[:, i, :2] + alpha * turned(arm) - w**2 * arm,
        )

    def joint(self, name: str) -> tuple[Floats, Floats, Floats]:
        """Position, velocity, acceleration (T, 2) of the pin of joint `name`."""
        joint = next(j for j in self.linkage.joints if j.name == name)
        return self.point(self.linkage.carrier(joint), joint.at)

    def angle(self, item: str) -> Floats:
        """Rotation of an item from the drawn position, (T,), rad."""
        return self.q[:, self.linkage.index[item], 2]


def move(linkage: Linkage, law: Law, times: Floats) -> Motion:
    """The motion under a drive law at `times` (T,) s.

    Velocities and accelerations follow from the differentiated constraint equations, not from
    differences. Raises: LinkageError when the linkage is not determined or cannot close.
    """
    require_determined(linkage)
    system = constraints(linkage)
    length, speed, rate = law(times)
    q = positions(system, length)
    J = system.jacobian(q)
    b = np.zeros((len(times), system.rows))
    b[:, -1] = speed
    v = system.spread(least_squares(J, b))
    b = -system.acceleration_terms(q, v)
    b[:, -1] += rate
    a = system.spread(least_squares(J, b))
    return Motion(system, times, length, speed, rate, q, v, a)


def at_rest(linkage: Linkage, length: float) -> Motion:
    """The linkage held with its driven slider at `length` (m): one instant without motion."""
    zero = np.zeros(1)
    return move(linkage, lambda t: (np.full(1, length), zero, zero), zero)


@dataclass(frozen=True)
class Energy:
    """Kinetic and potential energy (T,) in J, and the rates of both from v and a (T,) in W."""

    kinetic: Floats
    potential: Floats
    kinetic_rate: Floats
    potential_rate: Floats


def energy(motion: Motion) -> Energy:
    """Energies of all items and their exact rates."""
    items = motion.linkage.items
    m = np.array([item.mass for item in items])
    inertia = np.array([item.inertia or 0.0 for item in items])
    q, v, a = (state[:, : len(items)] for state in (motion.q, motion.v, motion.a))
    weight = m[:, None] * np.array(motion.linkage.gravity)
    return Energy(
        kinetic=0.5 * (np.sum(v[..., :2] ** 2, axis=2) @ m + v[..., 2] ** 2 @ inertia),
        potential=-np.einsum("tik,ik->t", q[..., :2], weight),
        kinetic_rate=np.sum(v[..., :2] * a[..., :2], axis=2) @ m + (v * a)[..., 2] @ inertia,
        potential_rate=-np.einsum("tik,ik->t", v[..., :2], weight),
    )

"""Forces of the ground on a wheel, as fractions of a reference load."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from loads.landing.requirements import GroundRule

Vector = tuple[float, float, float]
Side = Literal["left", "right", "inboard", "outboard"]
AXLE, CONTACT = "axle", "ground contact"


@dataclass(frozen=True)
class WheelForce:
    """A component of the force of the ground on a wheel.

    component: "vertical", "drag" or "side".
    factor: ratio of the component to the reference load, not negative.
    reference: reference load, N.
    towards: direction of the component in words.
    direction: unit vector, world axes.
    place: point of action, AXLE or CONTACT.
    arm: vector from the axle to the point of action, m, world axes.
    """

    component: str
    factor: float
    reference: float
    towards: str
    direction: Vector
    place: str = AXLE
    arm: Vector = (0.0, 0.0, 0.0)

    @property
    def force(self) -> Vector:
        """The force, N, world axes."""
        x, y, z = (self.factor * self.reference * part for part in self.direction)
        return x, y, z

    @property
    def couple(self) -> Vector:
        """The moment of the force about the axle, N m, world axes."""
        x, y, z = np.cross(self.arm, self.force).tolist()
        return x, y, z


@dataclass(frozen=True)
class GroundedWheel:
    """A wheel on the ground.

    up, aft: perpendicular unit vectors, world axes.
    leg: position of the leg on the aircraft: "left", "right" or "nose".
    radius: radius of the loaded tyre, m; with None all forces act at the axle.
    braked: whether the wheel cannot turn, so that drag acts at the ground contact.
    """

    up: Vector
    aft: Vector
    leg: str
    radius: float | None = None
    braked: bool = False

    def sideways(self, towards: Side) -> Vector:
        """The unit vector across the direction of travel, towards a side.

        The vector to the pilot's left is aft x up.
        """
        opposite = {"left": "right", "right": "left"}
        inboard = {"inboard": opposite.get(self.leg, ""), "outboard": self.leg}
        sign = 1.0 if inboard.get(towards, towards) == "left" else -1.0
        x, y, z = (sign * np.cross(self.aft, self.up)).tolist()
        return x, y, z

    def forces(self, rule: GroundRule, reference: float, towards: Side) -> tuple[WheelForce, ...]:
        """The nonzero components that a rule prescribes.

        reference: reference load of the rule, N.
        towards: side towards which the side load acts.
        """
        up, drag = self.up, self.aft if rule.drag >= 0.0 else _scaled(self.aft, -1.0)
        contact: tuple[str, Vector] = (AXLE, (0.0, 0.0, 0.0))
        if self.radius is not None:
            contact = CONTACT, _scaled(up, -self.radius)
        drag_place = contact if self.braked else (AXLE, (0.0, 0.0, 0.0))
        forces = (
            WheelForce("vertical", rule.vertical, reference, "up", up, *contact),
            WheelForce("drag", abs(rule.drag), reference, "aft" if rule.drag > 0.0 else "forward",
                       drag, *drag_place),
            WheelForce("side", rule.side, reference, towards, self.sideways(towards), *contact),
        )  # fmt: skip
        return tuple(force for force in forces if force.factor)


def _scaled(vector: Vector, factor: float) -> Vector:
    x, y, z = vector
    return factor * x, factor * y, factor * z

"""The parts of a planar linkage as data, such as bodies, pins, sliders, turns and teeth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

Point = tuple[float, float]
Sign = Literal["both", "positive", "negative"]
GROUND = "ground"


@dataclass(frozen=True)
class Body:
    """A rigid body in the drawn position.

    mass: kg.
    centre: centre of mass in world axes, m.
    inertia: moment of inertia about the centre of mass, kg m^2. A body without inertia (None) is a
    particle with a single connection, at `centre`, or slides on the ground.
    welded: the body, or GROUND, to which this body is welded.
    """

    name: str
    mass: float
    centre: Point
    inertia: float | None = None
    welded: str | None = None


@dataclass(frozen=True)
class Connection:
    """A body that turns on a pin; `name` labels the force between them.

    friction: radius of the friction circle, m; r mu / sqrt(1 + mu^2) for a pin of radius r.
    """

    name: str
    body: str
    friction: float = 0.0


@dataclass(frozen=True)
class Joint:
    """A pin and the bodies that turn on it.

    at: position as drawn, world axes, m.
    fixed_in: GROUND or the body of which the pin is a part; None for a floating pin.
    mass: mass of a floating pin, which is a particle, kg.
    """

    name: str
    at: Point
    connections: tuple[Connection, ...]
    fixed_in: str | None = None
    mass: float = 0.0


@dataclass(frozen=True)
class Slider:
    """A prismatic joint: `moving` slides on `base`, a body or GROUND.

    start, end: a point of the base and one of the moving body, world axes as drawn, m; the slider's
    length is the distance between them along `direction`.
    direction: by default from start to end; it turns with the base.
    friction: Coulomb's coefficient.
    bearing: distance between the two pads that carry the couple, centred on `end`, m; None where
    the couple is carried without friction.
    """

    name: str
    base: str
    moving: str
    start: Point
    end: Point
    direction: Point | None = None
    friction: float = 0.0
    bearing: float | None = None

    @property
    def axis(self) -> Point:
        """Unit vector of the sliding direction, as drawn; zero when the points coincide."""
        x, y = self.direction or (self.end[0] - self.start[0], self.end[1] - self.start[1])
        size = float(np.hypot(x, y)) or 1.0
        return x / size, y / size

    @property
    def drawn(self) -> float:
        """Length as drawn, m."""
        ex, ey = self.axis
        return (self.end[0] - self.start[0]) * ex + (self.end[1] - self.start[1]) * ey


@dataclass(frozen=True)
class Turn:
    """The angle of `body` relative to `base`, on which a drive or stop acts.

    drawn: angle as drawn, rad.
    carries: sign of the couples on the body that a stop can carry.
    """

    name: str
    body: str
    drawn: float
    base: str = GROUND
    carries: Sign = "both"


@dataclass(frozen=True)
class Gear:
    """A gear: a body with teeth around the joint at which it turns on its carrier."""

    body: str
    joint: str


@dataclass(frozen=True)
class Rack:
    """A rack: a body with teeth along the slider between it and its carrier."""

    body: str
    slider: str


@dataclass(frozen=True)
class Teeth:
    """The teeth of two bodies that mesh at a pitch point fixed in a third body, the carrier.

    at: pitch point as drawn, m.
    normal: unit vector at the pitch point as drawn, out of the first body into the second.
    pressure_angle: rad.
    """

    name: str
    sides: tuple[Gear | Rack, Gear | Rack]
    carrier: str
    at: Point
    normal: Point
    pressure_angle: float

    @property
    def bodies(self) -> tuple[str, str]:
        """The names of the two bodies that mesh."""
        return self.sides[0].body, self.sides[1].body


@dataclass(frozen=True)
class Sharing:
    """A rule by which redundant connections and teeth share their load, as springs do.

    stiffness: stiffness of each connection, in any unit.
    """

    connections: tuple[str, ...]
    stiffness: tuple[float, ...]


@dataclass(frozen=True)
class Parallel:
    """A rule by which drives in parallel divide their force; one is driven, the others follow.

    by: whether the force divides by areas under the same pressure, or by stiffness.
    shares: area or stiffness of each member, in any unit.
    """

    members: tuple[str, ...]
    shares: tuple[float, ...]
    by: Literal["areas", "stiffness"]

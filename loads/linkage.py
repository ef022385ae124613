"""A planar linkage as data: rigid bodies, the pins that join them, sliders and how they share."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Point = tuple[float, float]

GROUND = "ground"


class LinkageError(ValueError):
    """The linkage as described cannot be analysed; the message says why and what would be right."""


class UnreachableError(LinkageError):
    """The linkage does not close at a length of its driven slider; all lengths in m."""

    def __init__(self, slider: str, drawn: float, reached: float, wanted: float) -> None:
        self.slider, self.drawn, self.reached, self.wanted = slider, drawn, reached, wanted
        super().__init__(self.message())

    def message(self, unit: str = "m", factor: float = 1.0) -> str:
        """The message with lengths in a unit of `factor` m."""
        drawn, reached, wanted = (
            f"{x / factor:.6g} {unit}" for x in (self.drawn, self.reached, self.wanted)
        )
        return (
            f"the linkage cannot close with slider {self.slider} at {wanted}: it can be followed "
            f"from {drawn} (as drawn) to {reached} only; check the drive's range and the "
            "coordinates of the joints"
        )


@dataclass(frozen=True)
class Body:
    """A rigid body in the drawn position.

    mass: kg. centre: centre of mass in world axes, m. inertia: about the centre, kg m^2; a body
    without inertia is a particle at `centre` and must be held there by a single connection.
    """

    name: str
    mass: float
    centre: Point
    inertia: float | None = None


@dataclass(frozen=True)
class Connection:
    """One body's hold on a pin; `name` labels the force between them."""

    name: str
    body: str


@dataclass(frozen=True)
class Joint:
    """A pin and the bodies that turn on it.

    at: world position as drawn, m. fixed_in: GROUND or the body of which the pin is a part; None
    for a floating pin, which is then a particle of the given mass (kg).
    """

    name: str
    at: Point
    connections: tuple[Connection, ...]
    fixed_in: str | None = None
    mass: float = 0.0


@dataclass(frozen=True)
class Slider:
    """A prismatic joint: `moving` slides along the line from `start` (a point of `base`) to `end`
    (a point of `moving`), both in world axes as drawn, m. Its length is their distance.
    """

    name: str
    base: str
    moving: str
    start: Point
    end: Point

    @property
    def drawn_length(self) -> float:
        """Distance from start to end as drawn, m."""
        return float(np.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]))


@dataclass(frozen=True)
class Sharing:
    """How redundant connections share: like springs of these stiffnesses (any common unit)."""

    connections: tuple[str, ...]
    stiffness: tuple[float, ...]


@dataclass(frozen=True)
class Linkage:
    """Bodies, joints and one driven slider, in the position in which they are drawn.

    gravity: acceleration of free fall, world axes, m/s^2.
    """

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    sliders: tuple[Slider, ...]
    driven: str
    gravity: Point = (0.0, 0.0)
    sharing: tuple[Sharing, ...] = ()

    def __post_init__(self) -> None:
        _check(self)

    @cached_property
    def connections(self) -> tuple[tuple[Joint, Connection], ...]:
        """Every connection with its joint, in the order of the joints."""
        return tuple((j, c) for j in self.joints for c in j.connections)

    @cached_property
    def driven_slider(self) -> Slider:
        """The slider whose length the drive prescribes."""
        return next(s for s in self.sliders if s.name == self.driven)

    @cached_property
    def items(self) -> tuple[Body, ...]:
        """All that moves: the bodies, then each floating pin as a particle."""
        pins = (Body(_pin_item(j), j.mass, j.at) for j in self.joints if j.fixed_in is None)
        return self.bodies + tuple(pins)

    @cached_property
    def index(self) -> dict[str, int]:
        """Row of each item in a state array; the ground is the row after the last."""
        rows = {item.name: i for i, item in enumerate(self.items)}
        return rows | {GROUND: len(rows)}

    def carrier(self, joint: Joint) -> str:
        """The item of which the pin is a part: a body, the ground, or itself when it floats."""
        return _pin_item(joint) if joint.fixed_in is None else joint.fixed_in

    @cached_property
    def length_scale(self) -> float:
        """A typical distance between joints, m: turns angles into lengths of like size."""
        at = np.array([j.at for j in self.joints])
        return float(np.linalg.norm(at - at.mean(axis=0), axis=1).mean()) or 1.0


def _pin_item(joint: Joint) -> str:
    return f"pin {joint.name}"


def _check(linkage: Linkage) -> None:
    if not linkage.joints:
        raise LinkageError("the linkage has no joints")
    bodies = {b.name: b for b in linkage.bodies}
    names = [c.name for j in linkage.joints for c in j.connections]
    for what, seen in (
        ("body", [b.name for b in linkage.bodies]),
        ("joint", [j.name for j in linkage.joints]),
        ("connection", names),
        ("slider", [s.name for s in linkage.sliders]),
    ):
        twice = sorted({n for n in seen if seen.count(n) > 1})
        if twice:
            raise LinkageError(f"{what} {twice[0]!r} is named twice; names must be unique")
    for joint in linkage.joints:
        for c in joint.connections:
            if c.body not in bodies:
                raise LinkageError(f"connection {c.name}: there is no body {c.body!r}")
            if c.body == joint.fixed_in:
                raise LinkageError(
                    f"connection {c.name}: pin {joint.name} is fixed in {c.body}, so that body "
                    "cannot also turn on it"
                )
        if joint.fixed_in not in (None, GROUND, *bodies):
            raise LinkageError(f"joint {joint.name}: there is no body {joint.fixed_in!r}")
        if joint.fixed_in is None and len(joint.connections) < 2:
            raise LinkageError(f"joint {joint.name}: a floating pin needs at least two connections")
    for slider in linkage.sliders:
        for body in (slider.base, slider.moving):
            if body not in bodies:
                raise LinkageError(f"slider {slider.name}: there is no body {body!r}")
        if slider.drawn_length == 0.0:
            raise LinkageError(
                f"slider {slider.name}: its two points coincide, it has no direction"
            )
    if linkage.driven not in [s.name for s in linkage.sliders]:
        raise LinkageError(f"the drive moves slider {linkage.driven!r}, which does not exist")
    for share in linkage.sharing:
        for name in share.connections:
            if name not in names:
                raise LinkageError(f"sharing names connection {name!r}, which does not exist")
    for particle in linkage.bodies:
        if particle.inertia is None:
            held = [j for j in linkage.joints for c in j.connections if c.body == particle.name]
            if len(held) != 1 or not np.allclose(held[0].at, particle.centre, atol=1e-9):
                raise LinkageError(
                    f"body {particle.name}: without inertia it is a particle, held by one "
                    "connection at its centre; give it an inertia, or put its centre at that joint"
                )

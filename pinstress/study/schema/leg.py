"""The study file's form: the leg that folds in space, with its spinning wheel."""

from typing import Annotated, Literal

from pydantic import Field

from pinstress.study.schema.types import (
    POSITIVE,
    Acceleration,
    Angle,
    AngularAcceleration,
    AngularVelocity,
    Duration,
    Inertia,
    Length,
    Mass,
    SignedInertia,
    StrictTable,
    Velocity,
)


class FoldTable(StrictTable):
    """The fold angle: from start to end in `duration`."""

    law: Literal["cosine", "cycloidal", "constant"] = "cosine"
    """Law of motion, as in `[mechanism.drive]`."""
    start: Angle
    """At the start."""
    end: Angle
    """At the end."""
    duration: Duration
    """Time from start to end."""


class SpeedTable(StrictTable):
    """The aircraft's speed along y' at the start and its rate."""

    start: Velocity
    """At the start."""
    rate: Acceleration = 0.0
    """Constant rate of change."""


class YawTable(StrictTable):
    """The yaw rate about z' at the start, and its rate."""

    start: AngularVelocity
    """At the start."""
    rate: AngularAcceleration = 0.0
    """Constant rate of change."""


class SpinTable(StrictTable):
    """The wheel's spin."""

    start: AngularVelocity
    """At the start."""
    end: AngularVelocity
    """At the end; it changes linearly in between."""


class SpatialLegTable(StrictTable):
    """A leg on the hinge B of an aircraft that drives on a slope and yaws;
    `loads.forces.spatial_leg` defines the axes and symbols.
    """

    connection: str = "B"
    """Name of the connection between the leg and the pin at B."""
    l1: Length
    """Distance of the hinge B from the aircraft's point A along x' (to the right)."""
    l2: Length
    """Distance of B from A along z' (up from the slope)."""
    l3: Annotated[Length, POSITIVE]
    """Distance of the wheel's centre C from B along -z''' (down the leg)."""
    l4: Length
    """Distance of C from B along -x''' (inboard)."""
    leg_mass: Mass
    """Mass of the leg without the wheel; its centre D is at 3/4 of `l3` and 1/4 of `l4` from B."""
    wheel_mass: Mass
    """Mass of the wheel with tyre and brake."""
    leg_inertia: Annotated[list[SignedInertia], Field(min_length=3, max_length=6)]
    """Moments of inertia of the leg about D in leg axes: xx, yy, zz[, xy, xz, yz]."""
    wheel_inertia: tuple[Inertia, Inertia]
    """Moments of inertia of the wheel about its axle and across it."""
    slope: Angle = 0.0
    """Slope of the ground, about x'."""
    gravity: Annotated[
        Acceleration, POSITIVE, Field(json_schema_extra={"default": "9.80665 m/s^2"})
    ] = 9.80665
    """Gravity, vertically downwards."""
    speed: SpeedTable
    """The aircraft's speed along y'."""
    yaw: YawTable
    """The aircraft's yaw rate about z'."""
    fold: FoldTable
    """The leg's angle beta about y''."""
    spin: SpinTable
    """The wheel's spin, positive when rolling forwards."""
    course: Literal["straight", "yaw"] = "straight"
    """Whether the path of A is straight, as in the publication, or turns with the yaw."""

"""The study file's form: the leg that folds in space, with its spinning wheel."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from pinstress.quantities import (
    Acceleration,
    Angle,
    AngularAcceleration,
    AngularVelocity,
    Duration,
    Inertia,
    Length,
    Mass,
    SignedInertia,
    Table,
    Velocity,
    positive,
)


class FoldTable(Table):
    """The fold angle: from start to end in `duration`."""

    law: Literal["cosine", "cycloidal", "constant"] = "cosine"
    start: Angle
    end: Angle
    duration: Duration


class SpeedTable(Table):
    """The aircraft's speed along y' at the start and its rate."""

    start: Velocity
    rate: Acceleration = 0.0


class YawTable(Table):
    """The yaw rate about z' at the start, and its rate."""

    start: AngularVelocity
    rate: AngularAcceleration = 0.0


class SpinTable(Table):
    """The wheel's spin at start and end; in between it changes evenly."""

    start: AngularVelocity
    end: AngularVelocity


class SpatialLegTable(Table):
    """A leg on the hinge B of an aircraft that drives on a slope and yaws; loads/spatial_leg.py
    says what everything means. connection: the name of the leg's hold on the pin at B.

    course: "straight" (the path of A does not turn with the yaw, as in the publication) or "yaw".
    """

    connection: str = "B"
    l1: Length
    l2: Length
    l3: Annotated[Length, AfterValidator(positive)]
    l4: Length
    leg_mass: Mass
    wheel_mass: Mass
    leg_inertia: Annotated[list[SignedInertia], Field(min_length=3, max_length=6)]
    wheel_inertia: tuple[Inertia, Inertia]
    slope: Angle = 0.0
    gravity: Annotated[Acceleration, AfterValidator(positive)] = 9.80665
    speed: SpeedTable
    yaw: YawTable
    fold: FoldTable
    spin: SpinTable
    course: Literal["straight", "yaw"] = "straight"

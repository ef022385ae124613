"""The study file's form: cases, what loads the pins."""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, PlainValidator, Tag, model_validator

from loads.coded import LoadsArgumentError
from pinstress.schema.types import (
    POSITIVE,
    Acceleration,
    Duration,
    Force,
    JointOrPoint,
    Mass,
    Moment,
    Number,
    StrictTable,
    Switch,
    Velocity,
    Weight,
    Whole,
)


class CaseTable(StrictTable):
    """Keys of all cases."""

    distribution: Literal["uniform", "cosine"] = "uniform"
    """Distribution of a transverse force over its band: "uniform", a traction of constant
    direction, or "cosine", a bearing pressure on the loaded half."""
    clamp: dict[str, list[str]] = {}
    """Pins that are clamped differently in this case, each with its clamped surfaces."""


class GivenCase(CaseTable):
    """Stated forces and moments on pins, or a table of them."""

    kind: Literal["given"]
    """Which kind of case."""
    forces: dict[str, Annotated[list[Force], Field(min_length=2, max_length=3)]] | None = None
    """By connection the force on the pin, in its own x, y (and z, along the axis)."""
    moments: dict[str, Annotated[list[Moment], Field(min_length=2, max_length=3)]] | None = None
    """By connection the moment on the pin about x, y (and z) through the middle of the band."""
    table: str | None = None
    """CSV in the study's folder, instead: connection,fx,fy[,fz][,mx,my,mz][,time]; with time a
    sweep.
    """

    @model_validator(mode="after")
    def _one_source(self) -> "GivenCase":
        stated = {"forces": self.forces, "moments": self.moments}
        if (self.forces is None and self.moments is None) == (self.table is None):
            raise LoadsArgumentError(
                'give either forces = { ... }, moments = { ... } or both, or table = "file.csv"',
                "give-one",
            )
        for key, given in stated.items():
            if given is not None and not given:
                raise LoadsArgumentError(f"{key} is empty; give at least one connection", "empty")
        return self


class ImpulseRange(StrictTable):
    """Values to try in place of the impulse's own: the factor of safety over all pairs."""

    impulse_time: Annotated[list[Duration], Field(min_length=1)]
    """Durations of the impulse."""
    velocity_change: Annotated[list[Annotated[Velocity, POSITIVE]], Field(min_length=1)]
    """Changes of velocity."""


class ImpulseTable(StrictTable):
    """A landing force from an impulse: mass times velocity change over time, times the peak of the
    pulse over its mean.
    """

    weight: Weight | None = None
    """Weight of the body that is stopped. Give either `weight` or `mass`."""
    gravity: Annotated[
        Acceleration, POSITIVE, Field(json_schema_extra={"default": "9.80665 m/s^2"})
    ] = 9.80665
    """Turns the weight into a mass."""
    mass: Mass | None = None
    """Mass of the body that is stopped."""
    velocity_change: Annotated[Velocity, POSITIVE]
    """Loss of velocity."""
    impulse_time: Duration
    """Duration of the impulse."""
    pulse: Literal["rectangular", "half-sine", "triangular"] = "rectangular"
    """Shape: the ratio of peak to mean is 1, pi/2 and 2."""
    direction: tuple[Number, Number]
    """Direction of the force, in world axes; any length but 0."""
    range: ImpulseRange | None = None
    """Other values to try, for one impulse per case."""

    @model_validator(mode="after")
    def _one_mass(self) -> "ImpulseTable":
        if (self.mass is None) == (self.weight is None):
            raise LoadsArgumentError("give either mass or weight (with gravity)", "give-one")
        if not any(self.direction):
            raise LoadsArgumentError("direction must not be zero", "no-direction")
        return self


class ApplyTable(StrictTable):
    """A load on a body: a force or an impulse, a couple, or both."""

    body: str
    """Name of a body of the mechanism."""
    at: JointOrPoint | None = None
    """A joint by name, or a point as drawn; absent: the body's centre of mass."""
    force: tuple[Force, Force] | None = None
    """In world axes as drawn."""
    couple: Moment = 0.0
    """Counter-clockwise."""
    follows: Switch = False
    """Whether the force turns with the body; otherwise its direction in world axes is constant."""
    impulse: ImpulseTable | None = None
    """A force estimated from an impulse, instead of `force`."""

    @model_validator(mode="after")
    def _one_force(self) -> "ApplyTable":
        if self.force is not None and self.impulse is not None:
            raise LoadsArgumentError(
                "give either force = [fx, fy] or impulse = { ... }", "give-one"
            )
        if self.force is None and self.impulse is None and not self.couple:
            raise LoadsArgumentError(
                "give force = [fx, fy], impulse = { ... } or couple", "give-one"
            )
        return self


class MechanismCase(CaseTable):
    """Keys of all cases of a mechanism."""

    apply: list[ApplyTable] = []
    """Loads on its bodies."""


class MotionCase(MechanismCase):
    """The mechanism driven from the start of its drives to the end."""

    kind: Literal["motion"]
    """Which kind of case."""
    samples: Annotated[Whole, Field(ge=2, le=100_001)] = 201
    """Instants, evenly spaced."""


def _coordinate(value: object) -> float | str:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise LoadsArgumentError('must be a number or a text like "45 deg"', "not-a-number")
    return value


# Of a drive: a length, or an angle with its unit.
Coordinate = Annotated[float | str, PlainValidator(_coordinate, json_schema_input_type=float | str)]
Coordinates = Annotated[
    Annotated[Coordinate, Tag("<one>")] | Annotated[dict[str, Coordinate], Tag("<by drive>")],
    Discriminator(lambda value: "<by drive>" if isinstance(value, dict) else "<one>"),
]


class StaticCase(MechanismCase):
    """The mechanism at rest, under gravity and applied loads."""

    kind: Literal["static"]
    """Which kind of case."""
    position: Coordinates | None = None
    """Of the drive, a length or an angle with its unit; by drive if several; absent: as drawn."""


class InstantCase(MechanismCase):
    """One instant of a motion."""

    kind: Literal["instant"]
    """Which kind of case."""
    position: Coordinates | None = None
    """Of the drive, a length or an angle with its unit; by drive if several; absent: as drawn."""
    velocity: Coordinates = 0.0
    """Of the drive, or by drive."""
    acceleration: Coordinates = 0.0
    """Of the drive, or by drive."""


class LegCase(CaseTable):
    """The leg that folds in space, over its fold."""

    kind: Literal["spatial_leg"]
    """Which kind of case."""
    samples: Annotated[Whole, Field(ge=2, le=100_001)] = 201
    """Instants, evenly spaced."""

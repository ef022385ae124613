"""The study file's form: cases, what loads the pins."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from pinstress.quantities import (
    POSITIVE,
    Acceleration,
    Duration,
    Force,
    Mass,
    Moment,
    Point,
    Table,
    Velocity,
    Weight,
)


class CaseTable(Table):
    """What all cases may say."""

    distribution: Literal["uniform", "cosine"] = "uniform"
    """How a transverse force spreads over its band: "uniform", a traction of constant direction, or
    "cosine", a bearing pressure on the half that is pushed."""
    clamp: dict[str, list[str]] = {}
    """Pins that are held otherwise in this case, and by what."""


class GivenCase(CaseTable):
    """Stated forces and moments on pins, or a table of them."""

    kind: Literal["given"]
    """Which kind of case."""
    forces: dict[str, Annotated[list[Force], Field(min_length=2, max_length=3)]] | None = None
    """By connection the force on the pin, in its own x, y (and z, along the axis)."""
    moments: dict[str, Annotated[list[Moment], Field(min_length=2, max_length=3)]] | None = None
    """By connection the moment on the pin about x, y (and z) through the middle of the band."""
    table: str | None = None
    """CSV beside the study, instead: connection,fx,fy[,fz][,mx,my,mz][,time]; with time a sweep."""

    @model_validator(mode="after")
    def _one_source(self) -> "GivenCase":
        stated = {"forces": self.forces, "moments": self.moments}
        if (self.forces is None and self.moments is None) == (self.table is None):
            raise ValueError(
                'give forces = { ... }, moments = { ... } or both, or else table = "file.csv"'
            )
        for key, given in stated.items():
            if given is not None and not given:
                raise ValueError(f"{key} names no connection")
        return self


class ImpulseRange(Table):
    """Values to try in place of the impulse's own: the factor of safety over all pairs."""

    impulse_time: Annotated[list[Duration], Field(min_length=1)]
    """Durations of the impulse."""
    velocity_change: Annotated[list[Annotated[Velocity, POSITIVE]], Field(min_length=1)]
    """Changes of velocity."""


class ImpulseTable(Table):
    """A landing force from an impulse: mass times velocity change over time, times the peak of the
    pulse over its mean.
    """

    weight: Weight | None = None
    """What is stopped, as a weight. Give either `weight` or `mass`."""
    gravity: Annotated[
        Acceleration, POSITIVE, Field(json_schema_extra={"default": "9.80665 m/s^2"})
    ] = 9.80665
    """Turns the weight into a mass."""
    mass: Mass | None = None
    """What is stopped."""
    velocity_change: Annotated[Velocity, POSITIVE]
    """The velocity that is lost."""
    impulse_time: Duration
    """In which time."""
    pulse: Literal["rectangular", "half-sine", "triangular"] = "rectangular"
    """Its shape: peak over mean is 1, pi/2 and 2."""
    direction: tuple[float, float]
    """Of the force, in world axes; any length but 0."""
    range: ImpulseRange | None = None
    """Other values to try. Of one impulse per case."""

    @model_validator(mode="after")
    def _one_mass(self) -> "ImpulseTable":
        if (self.mass is None) == (self.weight is None):
            raise ValueError("give either mass or weight (with gravity)")
        if not any(self.direction):
            raise ValueError("direction must not be zero")
        return self


class ApplyTable(Table):
    """A load on a body: a force or an impulse, a couple, or both."""

    body: str
    """Name of a body of the mechanism."""
    at: str | Point | None = None
    """A joint by name, or a point as drawn; absent: the body's centre of mass."""
    force: tuple[Force, Force] | None = None
    """In world axes as drawn."""
    couple: Moment = 0.0
    """Counter-clockwise."""
    follows: bool = False
    """Whether the force turns with the body; else it keeps the world's axes."""
    impulse: ImpulseTable | None = None
    """A force estimated from an impulse, instead of `force`."""

    @model_validator(mode="after")
    def _one_force(self) -> "ApplyTable":
        if self.force is not None and self.impulse is not None:
            raise ValueError("give either force = [fx, fy] or impulse = { ... }")
        if self.force is None and self.impulse is None and not self.couple:
            raise ValueError("give force = [fx, fy], impulse = { ... } or couple")
        return self


class MechanismCase(CaseTable):
    """What all cases of a mechanism may say."""

    apply: list[ApplyTable] = []
    """Loads on its bodies."""


class MotionCase(MechanismCase):
    """The mechanism driven from the start of its drives to the end."""

    kind: Literal["motion"]
    """Which kind of case."""
    samples: Annotated[int, Field(ge=2, le=100_001)] = 201
    """Instants, evenly spaced."""


Coordinate = float | str  # of a drive: a length, or an angle with its unit
Coordinates = Coordinate | dict[str, Coordinate]


class StaticCase(MechanismCase):
    """The mechanism held still, under gravity and applied loads."""

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
    samples: Annotated[int, Field(ge=2, le=100_001)] = 201
    """Instants, evenly spaced."""

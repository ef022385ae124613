"""The study file's form: the mechanism."""

import math
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag, field_validator, model_validator

from pinstress.quantities import (
    Acceleration,
    Angle,
    Density,
    Duration,
    Inertia,
    Length,
    Mass,
    Point,
    PositiveLength,
    Table,
    Time,
    Weight,
    not_negative,
    positive,
)


class Polar(Table):
    """A place at a distance from a joint, in a direction counter-clockwise from x."""

    origin: str
    distance: PositiveLength
    angle: Angle


class Dyad(Table):
    """A place at distances from two joints, on one side of the line from the first to the second:
    the two sides are the two branches (open and crossed) in which a four-bar can be assembled.
    """

    origins: tuple[str, str]
    distances: tuple[PositiveLength, PositiveLength]
    side: Literal["left", "right"]


def _way_of_placing(value: object) -> str:
    if isinstance(value, dict):
        return "<dyad>" if "origins" in value else "<polar>"
    return "<point>"


Place = Annotated[
    Annotated[Point, Tag("<point>")]
    | Annotated[Polar, Tag("<polar>")]
    | Annotated[Dyad, Tag("<dyad>")],
    Discriminator(_way_of_placing),
]


class JointTable(Table):
    """A pin of the mechanism as drawn, and the body on each of its connections.

    fixed_in: "ground" or a body; absent for a floating pin, whose weight is that of its profile
    unless given here.
    """

    at: Place
    connections: Annotated[dict[str, str], Field(min_length=1)]
    fixed_in: str | None = None
    weight: Weight | None = None


class BarTable(Table):
    """A uniform straight bar between two joints: round (diameter) or rectangular (section = [depth
    in the plane, width across it]). Its mass, centre and inertia follow.
    """

    joints: tuple[str, str]
    diameter: PositiveLength | None = None
    section: tuple[PositiveLength, PositiveLength] | None = None
    density: Density

    @model_validator(mode="after")
    def _one_section(self) -> "BarTable":
        if (self.diameter is None) == (self.section is None):
            raise ValueError("give either diameter or section = [depth, width]")
        return self


class BodyTable(Table):
    """A rigid body: weight, mass or a bar; its centre as drawn (midway between its joints when it
    has two); inertia about the centre (none: a particle).
    """

    weight: Weight | None = None
    mass: Mass | None = None
    bar: BarTable | None = None
    centre: Point | None = None
    inertia: Inertia | None = None

    @model_validator(mode="after")
    def _one_mass(self) -> "BodyTable":
        if sum(x is not None for x in (self.mass, self.weight, self.bar)) != 1:
            raise ValueError("give one of weight, mass or bar")
        if self.bar is not None and self.centre is not None:
            raise ValueError("a bar's centre is its middle; give mass or weight with a centre")
        return self


class SliderTable(Table):
    """One body sliding on another (or on the ground), [base, moving], from a joint or point of the
    base to one of the moving body: along the line between them, or along `direction`.

    friction: Coulomb's coefficient. bearing: distance of the pads that carry its couple.
    """

    bodies: tuple[str, str]
    joints: tuple[str | Point, str | Point]
    direction: tuple[float, float] | None = None
    friction: Annotated[float, Field(ge=0.0, le=10.0)] = 0.0
    bearing: Annotated[Length, AfterValidator(positive)] | None = None

    @field_validator("direction")
    @classmethod
    def _not_zero(cls, value: tuple[float, float] | None) -> tuple[float, float] | None:
        if value is not None and not any(value):
            raise ValueError("must not be zero")
        return value


class LawTable(Table):
    """What laws of motion share: from start to end in `duration`, beginning at `begin`, or a table
    (CSV: time,position and, for exact rates, velocity,acceleration). Without a course the drive
    only serves cases that state their instant.
    """

    name: str | None = None
    law: Literal["cosine", "cycloidal", "constant", "table"] = "cosine"
    duration: Duration | None = None
    begin: Annotated[Time, AfterValidator(not_negative)] = 0.0
    table: str | None = None

    @model_validator(mode="after")
    def _course(self) -> "LawTable":
        course = [getattr(self, key, None) for key in ("start", "end", "duration")]
        if self.law == "table":
            if self.table is None or any(v is not None for v in course):
                raise ValueError('law "table" needs table = "file.csv" and no start, end, duration')
        elif self.table is not None:
            raise ValueError(f'table is for law = "table", not {self.law!r}')
        elif len({v is None for v in course}) > 1:
            raise ValueError(f"law {self.law!r} needs start, end and duration")
        return self

    @property
    def moves(self) -> bool:
        """Whether a course is given."""
        return self.table is not None or self.duration is not None


class SliderDrive(LawTable):
    """A drive of a slider's length (hydraulic piston, screw)."""

    slider: str
    start: Length | None = None
    end: Length | None = None
    position_offset: Length = 0.0


MOST_TURNS = 1000  # each is followed in steps of 0.25 rad


class RotaryDrive(LawTable):
    """A drive of a body's angle: the direction of the line from one of its joints to another,
    counter-clockwise from x; or, for a drive between two bodies, from the line `against_line` of
    the body `against`.
    """

    body: str
    line: tuple[str, str]
    against: str = "ground"
    against_line: tuple[str, str] | None = None
    start: Angle | None = None
    end: Angle | None = None

    @model_validator(mode="after")
    def _both(self) -> "RotaryDrive":
        if (self.against == "ground") != (self.against_line is None):
            raise ValueError("against (a body) and against_line (two of its joints) go together")
        if abs((self.end or 0.0) - (self.start or 0.0)) > MOST_TURNS * 2.0 * math.pi:
            raise ValueError(f"from start to end are more than {MOST_TURNS} turns")
        return self


def _kind_of_drive(value: object) -> str:
    return "<slider>" if isinstance(value, dict) and "slider" in value else "<rotary>"


AnyDrive = Annotated[
    Annotated[SliderDrive, Tag("<slider>")] | Annotated[RotaryDrive, Tag("<rotary>")],
    Discriminator(_kind_of_drive),
]


class SharingTable(Table):
    """How redundant connections share: as springs of these stiffnesses (only ratios matter)."""

    connections: Annotated[list[str], Field(min_length=1)]
    stiffness: Annotated[list[Annotated[float, Field(gt=0.0)]], Field(min_length=1)]

    @model_validator(mode="after")
    def _same_length(self) -> "SharingTable":
        if len(self.connections) != len(self.stiffness):
            raise ValueError("give one stiffness for each connection")
        return self


class MechanismTable(Table):
    """A planar linkage in the position in which it is drawn, with one drive or several."""

    gravity: tuple[Acceleration, Acceleration] = (0.0, -9.80665)
    joint: Annotated[dict[str, JointTable], Field(min_length=1)]
    body: Annotated[dict[str, BodyTable], Field(min_length=1)]
    slider: dict[str, SliderTable] = {}
    drive: Annotated[list[AnyDrive], Field(min_length=1)]
    sharing: list[SharingTable] = []

    @field_validator("drive", mode="before")
    @classmethod
    def _one_or_several(cls, value: Any) -> Any:
        return [value] if isinstance(value, dict) else value
